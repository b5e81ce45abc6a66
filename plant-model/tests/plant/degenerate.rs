//! Where a rotor in two planes is a point mass, it runs as one with a single pair in one plane does, whatever they are made of.

use crate::support::rotor::*;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Inputs, Method, Options, V2, build};

const OPTIONS: Options = Options {
    rtol: 1e-11,
    method: Method::Series,
    steps_per_sample: 200_000,
    steps: 50_000_000,
};

fn point_start(velocity: V2) -> Start {
    Start {
        position_m: V2::zeros(),
        velocity_m_s: velocity,
        spin_rad_s: 400.0,
        spin_phase_rad: 0.0,
    }
}

fn half(ring: &RingParams) -> RingParams {
    RingParams {
        mass_kg: 0.5 * ring.mass_kg,
        stiffness_n_m: 0.5 * ring.stiffness_n_m,
        damping_n_s_m: 0.5 * ring.damping_n_s_m,
    }
}

fn stators() -> [(StatorParams, StatorParams); 3] {
    let inner = RingParams {
        mass_kg: 2.0,
        stiffness_n_m: V2::new(2e7, 2.5e7),
        damping_n_s_m: V2::new(3000.0, 2500.0),
    };
    let outer = RingParams {
        mass_kg: 5.0,
        stiffness_n_m: V2::new(4e7, 3e7),
        damping_n_s_m: V2::new(1000.0, 500.0),
    };
    let halves = StatorParams::TwoMass {
        inner: half(&inner),
        outer: half(&outer),
    };
    [
        (StatorParams::Rigid, StatorParams::Rigid),
        (
            StatorParams::OneMass(inner),
            StatorParams::OneMass(half(&inner)),
        ),
        (StatorParams::TwoMass { inner, outer }, halves),
    ]
}

/// Runs both under the same forces, shared equally between the ends, and compares everything that both have.
fn alike(params: &MachineParams, one: &PlantParams, (method, worst): (Method, f64), what: &str) {
    // The pair of a point mass reads largest values off between steps.
    let peak = match one.contact.law.linear() {
        Some(_) => worst,
        None => 1e-5,
    };
    let auto = Options {
        method: Method::Auto,
        ..OPTIONS
    };
    let start = MachineStart {
        centre_velocity_m_s: V2::new(0.3, 0.0),
        spin_rad_s: 400.0,
        ..MachineStart::default()
    };
    let options = Options { method, ..OPTIONS };
    let mut rotor = Machine::new(params, &start, options).unwrap();
    assert_eq!(rotor.method(), method);
    let mut point = build(one, &point_start(V2::new(0.3, 0.0)), auto).unwrap();
    let (mut changes, mut expected) = (vec![vec![]; 2], vec![]);
    for i in 1..=100 {
        let t = 2e-4 * f64::from(i);
        let command = V2::new(-150.0 * (0.1 * f64::from(i)).cos(), 90.0);
        let load = V2::new(0.0, -98.1);
        let inputs = MachineInputs {
            commands_n: vec![0.5 * command; 2],
            loads_n: vec![load],
        };
        let mut change = |p: usize, s: &plant_model::machine::MachineSnapshot| {
            changes[p].push(s.planes().nth(p).unwrap().mode);
        };
        rotor.advance(t, &inputs, &mut change).unwrap();
        let inputs = Inputs {
            command_n: command,
            external_n: load,
        };
        point
            .advance(t, &inputs, &mut |s| expected.push(s.mode))
            .unwrap();
    }
    let (now, then) = (rotor.snapshot(), point.snapshot());
    for (p, plane) in now.planes().enumerate() {
        assert_eq!(changes[p], expected, "{what}, plane {p}");
        let near = |a: f64, b: f64, scale: f64, name: &str| {
            assert!(
                (a - b).abs() <= worst * scale,
                "{what}, plane {p}: {name} {a:e}, {b:e}"
            );
        };
        for axis in [0, 1] {
            let (a, b) = (plane.rotor.position[axis], then.position_m[axis]);
            near(a, b, CLEARANCE_M, "position");
            let (a, b) = (plane.ring.position[axis], then.inner_ring.position[axis]);
            near(a, b, CLEARANCE_M, "ring");
        }
        near(now.spin_rad_s, then.spin_rad_s, 400.0, "spin");
        near(plane.race_spin_rad_s, then.race_spin_rad_s, 400.0, "race");
        near(
            2.0 * plane.normal_force_n,
            then.normal_force_n,
            1e5,
            "normal force",
        );
        near(
            2.0 * plane.sliding_force_n,
            then.sliding_force_n,
            1e5,
            "sliding",
        );
        near(
            2.0 * plane.rolling_force_n,
            then.rolling_force_n,
            1e5,
            "rolling",
        );
        let (meters, all) = (&rotor.meters()[p], point.meters());
        assert_eq!(meters.impacts, all.impacts, "{what}");
        near(
            2.0 * meters.peak_contact_force_n,
            all.peak_contact_force_n,
            1e5 * peak / worst,
            "peak force",
        );
        near(
            meters.contact_time_s,
            all.contact_time_s,
            1.0,
            "contact time",
        );
        near(
            meters.whirl_angle_rad,
            all.whirl_angle_rad,
            1e2,
            "whirl angle",
        );
        let speeds = (meters.peak_backward_speed_m_s, all.peak_backward_speed_m_s);
        near(speeds.0, speeds.1, peak / worst, "backward speed");
    }
    let (books, all) = (rotor.audit(), point.audit());
    assert!(books.residual() < worst, "{what}: {:e}", books.residual());
    let (a, b) = (books.flows, all.flows);
    let scale = worst * all.turnover_j();
    for (name, a, b) in [
        ("supplied", a.supplied(), b.supplied()),
        ("dissipated", a.dissipated(), b.dissipated()),
        ("contact", a.contact_damping, b.contact_damping),
        ("sliding", a.sliding_friction, b.sliding_friction),
        ("control", a.control, b.control),
    ] {
        assert!((a - b).abs() <= scale, "{what}: {name} {a:e} J, {b:e} J");
    }
    let of_planes: f64 = rotor.plane_flows().iter().map(|p| p.sliding_friction).sum();
    assert!((of_planes - a.sliding_friction).abs() <= scale);
}

/// Two like ends that move together: stator of no, one and two rings, bushing and race, with and without rolling friction,
/// lag and a spin that is free. In most of these both ends roll at once.
#[test]
fn a_rotor_without_tilt_is_a_point_mass() {
    let race = |share: f64| RaceParams {
        inertia_kg_m2: share * 2e-6,
        drag_n_m_s: share * 1e-5,
        start_spin_rad_s: 50.0,
    };
    let free = SpinParams::Free {
        inertia_kg_m2: 0.05,
        drive_torque_n_m: 1.0,
    };
    for (stator, halves) in stators() {
        for case in 0..16 {
            let raced = case & 1 != 0;
            let rolling = if case & 2 != 0 { 0.01 } else { 0.0 };
            let lag_s = if case & 4 != 0 { 2e-4 } else { 0.0 };
            let spin = if case & 8 != 0 {
                free
            } else {
                SpinParams::Held
            };
            let (mut params, mut one) = (machine(), point());
            magnets(&mut params, &mut one, lag_s);
            params.loads_m = vec![0.0];
            params.spin = spin;
            for plane in &mut params.planes {
                plane.stator = halves;
                plane.race = raced.then(|| race(0.5));
                plane.friction.rolling_coefficient = rolling;
            }
            (one.spin, one.stator, one.race) = (spin, stator, raced.then(|| race(1.0)));
            one.friction.rolling_coefficient = rolling;
            // The second method goes the same way.
            for (method, worst) in [(Method::Series, 1e-10), (Method::Collocation, 1e-9)] {
                let what = format!("{}, {stator:?}, case {case:04b}", method.name());
                alike(&params, &one, (method, worst), &what);
            }
        }
    }
}

/// One that does not tilt is a point mass with one pair of coordinates, and has no others.
#[test]
fn a_rotor_that_does_not_tilt_is_a_point_mass() {
    let options = |method| Options { method, ..OPTIONS };
    for (stator, _) in stators() {
        for free in [false, true] {
            let spin = match free {
                true => SpinParams::Free {
                    inertia_kg_m2: 0.05,
                    drive_torque_n_m: 1.0,
                },
                false => SpinParams::Held,
            };
            let mut params = machine();
            params.rotor = Rotor::Rigid(RigidRotor::point(10.0));
            params.supports = vec![Support {
                position_m: 0.7,
                stiffness_n_m: V2::repeat(4e5),
                damping_n_s_m: V2::repeat(200.0),
                ..Support::default()
            }];
            params.spin = spin;
            params.planes = vec![plane(-0.3, 1.0)];
            params.planes[0].stator = stator;
            let mut one = point();
            (one.spin, one.stator) = (spin, stator);
            let start = MachineStart {
                centre_velocity_m_s: V2::new(0.3, 0.0),
                spin_rad_s: 400.0,
                ..MachineStart::default()
            };
            for (method, worst) in [(Method::Series, 1e-10), (Method::Collocation, 1e-9)] {
                let mut rotor = Machine::new(&params, &start, options(method)).unwrap();
                let mut mass = build(
                    &one,
                    &point_start(V2::new(0.3, 0.0)),
                    options(Method::Series),
                )
                .unwrap();
                for i in 1..=100 {
                    let t = 2e-4 * f64::from(i);
                    (rotor.advance(t, &MachineInputs::default(), &mut |_, _| {})).unwrap();
                    mass.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
                }
                let (now, then) = (rotor.snapshot(), mass.snapshot());
                let off = now.planes().next().unwrap().rotor.position - then.position_m;
                assert!(
                    off.norm() < worst * CLEARANCE_M,
                    "{stator:?}: {:e}",
                    off.norm()
                );
                assert!((now.spin_rad_s - then.spin_rad_s).abs() < 400.0 * worst);
                assert_eq!(rotor.meters()[0].impacts, mass.meters().impacts);
                let (a, b) = (rotor.audit(), mass.audit());
                let off_j = a.flows.sliding_friction - b.flows.sliding_friction;
                assert!(off_j.abs() < worst * b.turnover_j());
                assert!(a.residual() < worst, "{stator:?}: {:e}", a.residual());
                assert_eq!(rotor.axis().tilt, plant_model::Body::default());
            }
        }
    }
}

/// A magnet at each end, and one of both together.
fn magnets(params: &mut MachineParams, one: &mut PlantParams, lag_s: f64) {
    let magnet = |position_m: f64| MachineMagnet {
        position_m,
        force_max_n: 150.0,
        lag_s,
        lag_damping_ratio: None,
        poles: None,
    };
    params.magnets = vec![magnet(-0.1), magnet(0.1)];
    one.magnet = Some(MagnetParams {
        force_max_n: 300.0,
        lag_s,
    });
}

/// Bores out of round at both ends.
#[test]
fn bores_out_of_round_are_that_of_a_point_mass() {
    let bore = StatorParams::RigidEllipse(EllipseParams {
        ellipticity: 0.05,
        long_axis_rad: 0.4,
    });
    let (mut params, mut one) = (machine(), point());
    params.loads_m = vec![0.0];
    magnets(&mut params, &mut one, 2e-4);
    for plane in &mut params.planes {
        plane.stator = bore;
    }
    one.stator = bore;
    alike(&params, &one, (Method::Collocation, 1e-8), "out of round");
    let refused = Machine::new(&params, &MachineStart::default(), OPTIONS).unwrap_err();
    assert_eq!(refused.field, "planes[0].stator.ellipticity");
}

/// Friction that falls with speed, by both methods.
#[test]
fn friction_that_falls_with_speed_is_that_of_a_point_mass() {
    let falling = SlidingFriction::Falling {
        at_rest: 0.3,
        at_speed: 0.1,
        speed_scale_m_s: 0.4,
    };
    for (stator, halves) in stators() {
        let (mut params, mut one) = (machine(), point());
        magnets(&mut params, &mut one, 2e-4);
        params.loads_m = vec![0.0];
        for plane in &mut params.planes {
            plane.stator = halves;
            plane.friction.sliding = falling;
        }
        (one.stator, one.friction.sliding) = (stator, falling);
        let what = format!("falling friction, {stator:?}");
        for (method, worst) in [(Method::Series, 1e-10), (Method::Collocation, 1e-8)] {
            alike(&params, &one, (method, worst), &what);
        }
    }
}

/// The same of balls below the race: a law without a series at the touch.
#[test]
fn a_contact_that_hardens_is_that_of_a_point_mass() {
    for (stator, halves) in stators() {
        for damping_s_m in [0.0, 0.5] {
            let law = |share: f64| HuntCrossley {
                stiffness_n_mn: share * 3e10,
                exponent: 1.5,
                damping_s_m,
            };
            let (mut params, mut one) = (machine(), point());
            params.loads_m = vec![0.0];
            for plane in &mut params.planes {
                plane.stator = halves;
                plane.contact.law = law(0.5).into();
            }
            (one.stator, one.contact.law) = (stator, law(1.0).into());
            let what = format!("Hertz, λ = {damping_s_m}, {stator:?}");
            magnets(&mut params, &mut one, 0.0);
            alike(&params, &one, (Method::Collocation, 1e-7), &what);
            let refused = Machine::new(&params, &MachineStart::default(), OPTIONS).unwrap_err();
            assert_eq!(refused.field, "planes[0].contact.stiffness_n_mn");
        }
    }
}

/// Struck at one end with I_t = m·a·b the other end does not notice, and the struck one is a point mass of 1/(1/m + b²/I_t).
#[test]
fn struck_beyond_the_centre_of_percussion_the_other_end_rests() {
    let (a, b, speed) = (0.16, 0.125, 0.3);
    let mut params = machine();
    params.rotor = rigid(10.0 * a * b, 0.0);
    params.planes = vec![plane(-a, 1.0), plane(b, 1.0)];
    params.supports.clear();
    params.unbalances.clear();
    let rate = speed / (a + b);
    let start = MachineStart {
        centre_velocity_m_s: V2::new(rate * a, 0.0),
        tilt_rate_rad_s: V2::new(rate, 0.0),
        spin_rad_s: 400.0,
        ..MachineStart::default()
    };
    let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
    let nothing = MachineInputs::default();
    rotor.advance(0.2, &nothing, &mut |_, _| {}).unwrap();

    let mut one = point();
    one.rotor.mass_kg = 1.0 / (0.1 + b * b / (10.0 * a * b));
    (one.rotor.stiffness_n_m, one.rotor.damping_n_s_m) = (0.0, 0.0);
    one.rotor.eccentricity_m = 0.0;
    let mut end = build(&one, &point_start(V2::new(speed, 0.0)), OPTIONS).unwrap();
    end.advance(0.2, &Inputs::default(), &mut |_| {}).unwrap();

    let now = rotor.snapshot();
    let planes: Vec<_> = now.planes().collect();
    let resting = planes[0].rotor.position.norm() / CLEARANCE_M;
    assert!(resting < 1e-11, "{resting:e}");
    let off = (planes[1].rotor.position - end.snapshot().position_m).norm() / CLEARANCE_M;
    assert!(off < 1e-11, "{off:e}");
    assert_eq!(rotor.meters()[1].impacts, end.meters().impacts);
    assert!(rotor.meters()[1].impacts > 1);
}

/// Stiffer and stiffer in bending it becomes the rigid rotor, at the rate of its compliance 1/ω².
#[test]
fn a_stiff_shaft_is_a_rigid_rotor() {
    let start = MachineStart {
        centre_velocity_m_s: V2::new(0.2, 0.0),
        tilt_rate_rad_s: V2::new(0.5, -0.3),
        spin_rad_s: 400.0,
        ..MachineStart::default()
    };
    let end = |rotor: Rotor| {
        let mut params = machine();
        params.rotor = rotor;
        let mut machine = Machine::new(&params, &start, OPTIONS).unwrap();
        let nothing = MachineInputs::default();
        machine.advance(3e-3, &nothing, &mut |_, _| {}).unwrap();
        assert!(machine.meters()[0].impacts > 0);
        machine.snapshot().planes().next().unwrap().rotor.position
    };
    let stiff = end(rigid(0.2, 0.05));
    let off = |first_rad_s: f64| {
        let mut modes = bending(1, first_rad_s);
        modes[0].damping_ratio = 0.3;
        let rotor = Rotor::Modal {
            rigid: *rigid(0.2, 0.05).rigid(),
            bending: modes,
            polar_coupling_kg_m2: vec![],
            damping_n_s_m: vec![],
        };
        (end(rotor) - stiff).norm() / CLEARANCE_M
    };
    let (soft, firm, hard) = (off(2e4), off(8e4), off(3.2e5));
    for ratio in [soft / firm, firm / hard] {
        assert!(
            (12.0..22.0).contains(&ratio),
            "{soft:e}, {firm:e}, {hard:e}"
        );
    }
    assert!(hard < 1e-3, "{hard:e}");
}
