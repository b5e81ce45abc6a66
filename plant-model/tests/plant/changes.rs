//! What changes of a rotor during a run: an unbalance that comes on top, friction, the drive.

use crate::support::*;
use nalgebra::Complex;

type C = Complex<f64>;

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

/// y and ẏ of ÿ = f(t, y, ẏ), by Runge and Kutta from rest.
fn runge_kutta(f: impl Fn(f64, C, C) -> C, [from, to]: [f64; 2]) -> (C, C) {
    let steps = 20_000;
    let h = (to - from) / f64::from(steps);
    let (mut y, mut w) = (C::default(), C::default());
    for i in 0..steps {
        let t = from + f64::from(i) * h;
        let k1 = f(t, y, w);
        let k2 = f(t + 0.5 * h, y + w * (0.5 * h), w + k1 * (0.5 * h));
        let k3 = f(
            t + 0.5 * h,
            y + w * (0.5 * h) + k1 * (0.25 * h * h),
            w + k2 * (0.5 * h),
        );
        let k4 = f(t + h, y + w * h + k2 * (0.5 * h * h), w + k3 * h);
        y += w * h + (k1 + k2 + k3) * (h * h / 6.0);
        w += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
    }
    (y, w)
}

/// A rotor loses a blade while it is braked. Free, the common centre of mass of rotor and blade goes straight on, which is its
/// motion in closed form; the tilt, and all of it on springs with dampers, are those of an integration of their own.
#[test]
fn a_blade_is_lost_while_the_spin_falls() {
    let (mass, transverse, polar) = (10.0, 0.2, 0.3);
    let (place, moment, angle) = (0.12, 1e-4, 0.7);
    let (spin, phase, inertia, torque) = (600.0, 0.3, 0.5, -150.0);
    let (lost_s, end_s) = (0.04, 0.07);
    let sigma = |t: f64| phase + spin * t + 0.5 * torque / inertia * t * t;
    let omega = |t: f64| spin + torque / inertia * t;
    let arm = |t: f64| C::from_polar(moment, sigma(t) + angle);
    let force = |t: f64| arm(t) * C::new(omega(t) * omega(t), -torque / inertia);
    let span = [lost_s, end_s];
    for (method, springs) in each(&METHODS, &[false, true]) {
        let mut params = machine();
        params.rotor = rigid(transverse, polar);
        params.unbalances.clear();
        if !springs {
            params.supports.clear();
        }
        for plane in &mut params.planes {
            plane.contact.clearance_m = 1e-2;
        }
        params.spin = free_spin(inertia, torque);
        let (k, d) = if springs { (4e5, 200.0) } else { (0.0, 0.0) };
        let (centre, _) = runge_kutta(|t, r, v| (force(t) - r * k - v * d) / mass, span);
        // I_t·θ̈ − i·I_p·Ω·θ̇ + k_φ·θ + d_φ·θ̇ = z·F with θ = φ + iψ.
        let tilts = |t, r: C, v: C| {
            let springs = (r * k + v * d) * (0.15 * 0.15);
            (place * force(t) + C::i() * polar * omega(t) * v - springs) / transverse
        };
        let (tilt, rate) = runge_kutta(tilts, span);
        let from = MachineStart {
            spin_phase_rad: phase,
            ..spinning(spin)
        };
        let mut rotor = rotor(&params, &from, options(method, 1e-12));
        advance(&mut rotor, lost_s);
        assert_eq!(rotor.axis().centre.position, V2::zeros());
        rotor.change(&adds(place, moment, angle)).unwrap();
        advance(&mut rotor, end_s);
        let axis = rotor.axis();
        let is = |what: &str, at: V2, wanted: C, share: f64| {
            let size = wanted.norm();
            close(what, at, V2::new(wanted.re, wanted.im), share * size);
        };
        if !springs {
            // m·r + U·e^(iσ) has no acceleration, and at the loss the rotor stood still.
            let along = C::new(1.0, omega(lost_s) * (end_s - lost_s));
            let moved = (arm(lost_s) * along - arm(end_s)) / mass;
            is("closed form", axis.centre.position, moved, 1e-11);
        }
        is("centre", axis.centre.position, centre, 1e-10);
        is("tilt", axis.tilt.position, tilt, 1e-10);
        is("rate", axis.tilt.velocity, rate, 1e-10);
        assert!((rotor.snapshot().spin_rad_s - omega(end_s)).abs() < 1e-9);
        closes("blade", rotor.audit().residual(), 1e-11);
    }
}

/// What changes before anything has moved is as if it had been so, to the last bit, through touches of both ends.
#[test]
fn a_change_at_the_start_is_a_rotor_that_was_so() {
    let change = Change {
        friction_coefficient: Some(0.1),
        drive_torque_n_m: Some(-20.0),
        ..adds(0.1, 3e-4, 1.0)
    };
    let [mut was, mut becomes] = [-20.0, 0.0].map(|torque| {
        let mut params = machine();
        params.spin = free_spin(0.06, torque);
        params
    });
    was.unbalances.extend(change.unbalance);
    for plane in &mut was.planes {
        plane.friction.sliding = constant(0.1);
    }
    let from = moving([0.3, 0.0], [0.0, 1.0], 300.0);
    let [mut was, mut becomes] =
        [&mut was, &mut becomes].map(|params| rotor(params, &from, series()));
    becomes.change(&change).unwrap();
    carry_sampled(&mut was, 0.03, 600);
    carry_sampled(&mut becomes, 0.03, 600);
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
    params.unbalances.clear();
    let from = placed(V2::new(1e-5, 0.0), 300.0);
    let (period_s, lost, back) = (5e-5, 1000, 2000);
    let change = |rotor: &mut Machine, tick: i32| {
        let angle = 0.2
            + if tick == back {
                std::f64::consts::PI
            } else {
                0.0
            };
        if tick == lost || tick == back {
            rotor.change(&adds(0.1, 1e-4, angle)).unwrap();
        }
    };
    let mut by_samples = rotor(&params, &from, series());
    for tick in 0..3000 {
        change(&mut by_samples, tick);
        advance(&mut by_samples, period_s * f64::from(tick + 1));
    }
    // As long as nothing changes in one go, which makes no matrix.
    let mut at_once = rotor(&params, &from, series());
    for tick in [lost, back, 3000] {
        advance(&mut at_once, period_s * f64::from(tick));
        change(&mut at_once, tick);
    }
    // The matrix was used.
    assert!(by_samples.work().steps < 3 * 300);
    let [a, b] = [&by_samples, &at_once].map(Machine::axis);
    let most = 5e-10 * b.centre.position.norm();
    close("centre", a.centre.position, b.centre.position, most);
    close("tilt", a.tilt.position, b.tilt.position, most);
    let [a, b] = [&by_samples, &at_once].map(Machine::audit);
    near("work", a.flows.unbalance, b.flows.unbalance, 1e-9);
    assert!(b.flows.unbalance.abs() > 1e-5);
    closes("changes", a.residual().max(b.residual()), 1e-11);
}

/// A rotor that is pressed on the wall lies where friction takes it, N = F/√(1 + μ²), and is braked by μ·N·R.
#[test]
fn friction_changes_under_the_rotor() {
    let mut params = machine();
    params.planes = vec![plane(0.0, 1.0)];
    params.unbalances.clear();
    params.gravity_m_s2 = V2::new(0.0, -30.0);
    params.spin = free_spin(0.06, 0.0);
    params.supports = [-0.15, 0.15].map(|z| held(z, 0.0, 2000.0)).to_vec();
    let from = placed(V2::new(0.0, -PLAY_M), 500.0);
    let mut rotor = rotor(&params, &from, series());
    for (mu, from_s) in [(0.3_f64, 0.0), (0.1, 2.0)] {
        if from_s > 0.0 {
            let change = Change {
                friction_coefficient: Some(mu),
                ..Change::default()
            };
            rotor.change(&change).unwrap();
        }
        let [before, after] = [1.9, 2.0].map(|settled_s| {
            advance(&mut rotor, from_s + settled_s);
            rotor.snapshot().spin_rad_s
        });
        let normal_n = 300.0 / (1.0 + mu * mu).sqrt();
        let brakes = mu * normal_n * 2.5e-3 / 0.06;
        near("braking", (before - after) / 0.1, brakes, 1e-6);
    }
    closes("braked", rotor.audit().residual(), 1e-11);
}

/// What is refused changes nothing.
#[test]
fn changes_that_cannot_be_are_refused() {
    let mut params = machine();
    params.rotor = modal(&rigid(0.2, 0.05), bending(1, 2000.0));
    let mut changed = rotor(&params, &spinning(300.0), series());
    let mut same = changed.clone();
    let friction = Change {
        friction_coefficient: Some(-0.1),
        ..Change::default()
    };
    // The speed is held.
    let torque = Change {
        drive_torque_n_m: Some(1.0),
        ..adds(0.1, 1e-5, 0.0)
    };
    for (change, field) in [
        (adds(0.3, 1e-5, 0.0), "unbalance.position_m"),
        (adds(0.1, -1e-5, 0.0), "unbalance.moment_kg_m"),
        (adds(0.1, 1e-5, f64::NAN), "unbalance.angle_rad"),
        (friction, "friction.coefficient"),
        (torque, "spin.drive_torque_n_m"),
    ] {
        assert_eq!(changed.change(&change).unwrap_err().field, field);
    }
    advance(&mut changed, 0.01);
    advance(&mut same, 0.01);
    assert_eq!(changed.snapshot(), same.snapshot());
}
