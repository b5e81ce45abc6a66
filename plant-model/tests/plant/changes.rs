//! What changes of a rotor during a run: an unbalance that comes on top, friction, the drive.

use crate::support::rotor::*;
use nalgebra::Complex;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Method, Options, V2};

const OPTIONS: Options = Options {
    rtol: 1e-12,
    method: Method::Series,
    steps_per_sample: 200_000,
    steps: 50_000_000,
};

fn advance(rotor: &mut Machine, to_s: f64) {
    let inputs = MachineInputs::default();
    rotor.advance(to_s, &inputs, &mut |_, _| {}).unwrap();
}

fn adds(position_m: f64, moment_kg_m: f64, angle_rad: f64) -> Change {
    Change {
        unbalance: Some(Unbalance {
            position_m,
            moment_kg_m,
            angle_rad,
        }),
        ..Change::default()
    }
}

/// A free rotor without springs that loses a blade while it is braked: the common centre of mass of rotor and blade goes straight
/// on, which is its motion in closed form, and the tilt is that of an integration of its own.
#[test]
fn a_blade_is_lost_while_the_spin_falls() {
    let (mass, transverse, polar) = (10.0, 0.2, 0.3);
    let (place, moment, angle) = (0.12, 1e-4, 0.7);
    let (spin, phase, inertia, torque) = (600.0, 0.3, 0.5, -150.0);
    let (lost_s, end_s) = (0.04, 0.07);
    let sigma = |t: f64| phase + spin * t + 0.5 * torque / inertia * t * t;
    let omega = |t: f64| spin + torque / inertia * t;
    let arm = |t: f64| Complex::from_polar(moment, sigma(t) + angle);
    // m·r + U·e^(iσ) has no acceleration, and at the loss the rotor stood still.
    let since = end_s - lost_s;
    let moved = (arm(lost_s) * Complex::new(1.0, omega(lost_s) * since) - arm(end_s)) / mass;
    // I_t·θ̈ − i·I_p·Ω·θ̇ = z·F with θ = φ + iψ, by Runge and Kutta.
    let rate = |t: f64, w: Complex<f64>| {
        let force = arm(t) * Complex::new(omega(t) * omega(t), -torque / inertia);
        (place * force + Complex::i() * polar * omega(t) * w) / transverse
    };
    let steps = 20_000;
    let h = since / f64::from(steps);
    let (mut w, mut tilt) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    for i in 0..steps {
        let t = lost_s + f64::from(i) * h;
        let k1 = rate(t, w);
        let k2 = rate(t + 0.5 * h, w + k1 * (0.5 * h));
        let k3 = rate(t + 0.5 * h, w + k2 * (0.5 * h));
        let k4 = rate(t + h, w + k3 * h);
        tilt += w * h + (k1 + k2 + k3) * (h * h / 6.0);
        w += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
    }
    let mut params = machine();
    params.rotor = rigid(transverse, polar);
    params.supports.clear();
    params.unbalances.clear();
    for plane in &mut params.planes {
        plane.contact.clearance_m = 1e-2;
    }
    params.spin = SpinParams::Free {
        inertia_kg_m2: inertia,
        drive_torque_n_m: torque,
    };
    let start = MachineStart {
        spin_rad_s: spin,
        spin_phase_rad: phase,
        ..MachineStart::default()
    };
    for method in [Method::Series, Method::Collocation] {
        let options = Options { method, ..OPTIONS };
        let mut rotor = Machine::new(&params, &start, options).unwrap();
        advance(&mut rotor, lost_s);
        assert_eq!(rotor.axis().centre.position, V2::zeros());
        rotor.change(&adds(place, moment, angle)).unwrap();
        advance(&mut rotor, end_s);
        let axis = rotor.axis();
        let off = |at: V2, wanted: Complex<f64>| {
            (at - V2::new(wanted.re, wanted.im)).norm() / wanted.norm()
        };
        let name = method.name();
        let (of_centre, of_tilt, of_rate) = (
            off(axis.centre.position, moved),
            off(axis.tilt.position, tilt),
            off(axis.tilt.velocity, w),
        );
        assert!(of_centre < 1e-11, "{name}: {of_centre:e}");
        assert!(of_tilt < 1e-10, "{name}: {of_tilt:e}");
        assert!(of_rate < 1e-10, "{name}: {of_rate:e}");
        assert!((rotor.snapshot().spin_rad_s - omega(end_s)).abs() < 1e-9);
        let residual = rotor.audit().residual();
        assert!(residual < 1e-11, "{name}: {residual:e}");
    }
}

/// What changes before anything has moved is as if it had been so, to the last bit, through touches of both ends.
#[test]
fn a_change_at_the_start_is_a_rotor_that_was_so() {
    let spin = |drive_torque_n_m| SpinParams::Free {
        inertia_kg_m2: 0.06,
        drive_torque_n_m,
    };
    let later = Unbalance {
        position_m: 0.1,
        moment_kg_m: 3e-4,
        angle_rad: 1.0,
    };
    let mut was = machine();
    was.spin = spin(-20.0);
    was.unbalances.push(later);
    let mut becomes = machine();
    becomes.spin = spin(0.0);
    for plane in &mut was.planes {
        plane.friction.sliding = SlidingFriction::Constant { coefficient: 0.1 };
    }
    let start = MachineStart {
        centre_velocity_m_s: V2::new(0.3, 0.0),
        tilt_rate_rad_s: V2::new(0.0, 1.0),
        spin_rad_s: 300.0,
        ..MachineStart::default()
    };
    let change = Change {
        eccentricity_m: None,
        unbalance: Some(later),
        friction_coefficient: Some(0.1),
        drive_torque_n_m: Some(-20.0),
    };
    let [mut was, mut becomes] =
        [was, becomes].map(|params| Machine::new(&params, &start, OPTIONS).unwrap());
    becomes.change(&change).unwrap();
    for tick in 1..=600 {
        let to_s = 5e-5 * f64::from(tick);
        advance(&mut was, to_s);
        advance(&mut becomes, to_s);
    }
    assert!(was.meters().iter().all(|meters| meters.impacts > 0));
    assert_eq!(was.meters(), becomes.meters());
    assert_eq!(was.snapshot(), becomes.snapshot());
    assert_eq!(was.audit(), becomes.audit());
}

/// Sample by sample flight goes by a matrix that knows the unbalance: after a change it knows the new one, work included. What
/// the opposite takes off again is gone.
#[test]
fn flight_by_samples_knows_of_a_change() {
    let mut params = machine();
    params.unbalances.truncate(0);
    let start = MachineStart {
        centre_m: V2::new(1e-5, 0.0),
        spin_rad_s: 300.0,
        ..MachineStart::default()
    };
    let (period_s, lost, back) = (5e-5, 1000, 2000);
    let change = |rotor: &mut Machine, tick: i32| {
        if tick == lost {
            rotor.change(&adds(0.1, 1e-4, 0.2)).unwrap();
        }
        if tick == back {
            let opposite = 0.2 + std::f64::consts::PI;
            rotor.change(&adds(0.1, 1e-4, opposite)).unwrap();
        }
    };
    let mut by_samples = Machine::new(&params, &start, OPTIONS).unwrap();
    for tick in 0..3000 {
        change(&mut by_samples, tick);
        advance(&mut by_samples, period_s * f64::from(tick + 1));
    }
    // As long as nothing changes in one go, which makes no matrix.
    let mut at_once = Machine::new(&params, &start, OPTIONS).unwrap();
    for tick in [lost, back, 3000] {
        advance(&mut at_once, period_s * f64::from(tick));
        change(&mut at_once, tick);
    }
    // The matrix was used.
    assert!(by_samples.work().steps < 3 * 300);
    let [a, b] = [&by_samples, &at_once].map(Machine::axis);
    let (apart, size) = (
        (a.centre.position - b.centre.position).norm() + (a.tilt.position - b.tilt.position).norm(),
        b.centre.position.norm(),
    );
    assert!(apart < 1e-9 * size, "{apart:e} of {size:e}");
    let works = [&by_samples, &at_once].map(|rotor| rotor.audit().flows.unbalance);
    assert!((works[0] / works[1] - 1.0).abs() < 1e-9, "{works:?}");
    assert!(works[1].abs() > 1e-5);
    for rotor in [&by_samples, &at_once] {
        assert!(rotor.audit().residual() < 1e-11);
    }
}

/// A rotor that is pressed on the wall lies where friction takes it, N = F/√(1 + μ²), and is braked by μ·N·R.
#[test]
fn friction_changes_under_the_rotor() {
    let mut params = machine();
    params.planes = vec![plane(0.0, 1.0)];
    params.supports = vec![];
    params.unbalances.clear();
    params.gravity_m_s2 = V2::new(0.0, -30.0);
    params.spin = SpinParams::Free {
        inertia_kg_m2: 0.06,
        drive_torque_n_m: 0.0,
    };
    for place in [-0.15, 0.15] {
        params.supports.push(Support {
            stiffness_n_m: V2::zeros(),
            damping_n_s_m: V2::repeat(2000.0),
            ..support(place)
        });
    }
    let start = MachineStart {
        centre_m: V2::new(0.0, -CLEARANCE_M),
        spin_rad_s: 500.0,
        ..MachineStart::default()
    };
    let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
    let braking = |rotor: &mut Machine, settled_s: f64| {
        advance(rotor, settled_s);
        let before = rotor.snapshot().spin_rad_s;
        advance(rotor, settled_s + 0.1);
        (before - rotor.snapshot().spin_rad_s) / 0.1
    };
    for (mu, from_s) in [(0.3_f64, 0.0), (0.1, 2.0)] {
        if from_s > 0.0 {
            let change = Change {
                friction_coefficient: Some(mu),
                ..Change::default()
            };
            rotor.change(&change).unwrap();
        }
        let normal_n = 300.0 / (1.0 + mu * mu).sqrt();
        let wanted = mu * normal_n * 2.5e-3 / 0.06;
        let measured = braking(&mut rotor, from_s + 1.9);
        assert!(
            (measured / wanted - 1.0).abs() < 1e-6,
            "{mu}: {measured} {wanted}"
        );
    }
    assert!(rotor.audit().residual() < 1e-11);
}

/// What is refused changes nothing.
#[test]
fn changes_that_cannot_be_are_refused() {
    let start = MachineStart {
        spin_rad_s: 300.0,
        ..MachineStart::default()
    };
    let mut params = machine();
    params.rotor = Rotor::Modal {
        rigid: *rigid(0.2, 0.05).rigid(),
        bending: bending(1, 2000.0),
        polar_coupling_kg_m2: vec![],
        damping_n_s_m: vec![],
    };
    let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
    let before = rotor.clone();
    let with_torque = |change: Change| Change {
        drive_torque_n_m: Some(1.0),
        ..change
    };
    let friction = Change {
        friction_coefficient: Some(-0.1),
        ..Change::default()
    };
    for (change, field) in [
        (adds(0.3, 1e-5, 0.0), "unbalance.position_m"),
        (adds(0.1, -1e-5, 0.0), "unbalance.moment_kg_m"),
        (adds(0.1, 1e-5, f64::NAN), "unbalance.angle_rad"),
        (friction, "friction.coefficient"),
        // The speed is held.
        (with_torque(adds(0.1, 1e-5, 0.0)), "spin.drive_torque_n_m"),
    ] {
        assert_eq!(rotor.change(&change).unwrap_err().field, field);
    }
    advance(&mut rotor, 0.01);
    let mut same = before;
    advance(&mut same, 0.01);
    assert_eq!(rotor.snapshot(), same.snapshot());
}
