//! Properties that every run of the plant has.

use crate::support::*;
use plant_model::contact::{damping_for_restitution, hunt_crossley};
use proptest::prelude::*;

/// Random plants over every combination of parts.
fn any_plant() -> impl Strategy<Value = PlantParams> {
    let shaft = (
        -3e5..1.5e6_f64,
        0.0..300.0_f64,
        prop_oneof![Just(0.0), 1e-6..3e-5_f64],
    );
    let contact = (7.0..9.5_f64, 0.05..1.0_f64);
    let friction = (
        0.0..0.5_f64,
        prop_oneof![Just(0.0), 0.0..0.05_f64],
        any::<bool>(),
    );
    let parts = (
        0..3_usize,
        any::<bool>(),
        prop_oneof![Just(0.0), 5e-5..5e-4_f64],
        (-2.0..1.0_f64).prop_map(|x| 10_f64.powf(x)),
        proptest::option::of((-4.0..0.0_f64, 0.0..5e-2_f64)),
    );
    (shaft, contact, friction, parts).prop_map(|(shaft, contact, friction, parts)| {
        let base = footnote_4();
        let [inner, outer] = two_rings();
        let (rings, free, lag_s, inertia_kg_m2, of_race) = parts;
        let mut params = PlantParams {
            rotor: RotorParams {
                stiffness_n_m: shaft.0,
                damping_n_s_m: shaft.1,
                eccentricity_m: shaft.2,
                ..base.rotor
            },
            spin: match free {
                true => free_spin(inertia_kg_m2, 3.0),
                false => SpinParams::Held,
            },
            stator: stators(inner, outer)[rings],
            contact: ContactParams {
                law: spring(10_f64.powf(contact.0), 0.0).into(),
                ..base.contact
            },
            friction: FrictionParams {
                sliding: match friction.2 {
                    true => SlidingFriction::Falling {
                        at_rest: friction.0,
                        at_speed: 0.3 * friction.0,
                        speed_scale_m_s: 2.0,
                    },
                    false => SlidingFriction::Constant {
                        coefficient: friction.0,
                    },
                },
                rolling_coefficient: friction.1,
            },
            magnet: Some(magnet_of(300.0, lag_s)),
            race: of_race.map(|(exponent, drag)| race(10_f64.powf(exponent), drag, 0.0)),
        };
        let mass = params.contact_mass_kg();
        let law = law_of(&mut params);
        law.damping_n_s_m =
            damping_for_restitution(contact.1, law.stiffness_n_m, mass).expect("in range");
        params
    })
}

/// Those without a power series as well: Hunt and Crossley's contact as deep as the linear one at 0.3 m/s, and a rigid bore
/// out of round.
fn any_plant_of_any_contact() -> impl Strategy<Value = PlantParams> {
    let hertz = proptest::option::of((1.0..3.0_f64, 0.05..1.0_f64));
    let bore = proptest::option::of((0.0..0.2_f64, -3.0..3.0_f64));
    (any_plant(), hertz, bore).prop_map(|(mut params, hertz, bore)| {
        let speed_m_s = 0.3;
        if let Some((exponent, restitution)) = hertz {
            let linear_n_m = params.contact.stiffness_n_m();
            let mass_kg = params.contact_mass_kg();
            params.contact.law = ContactLaw::HuntCrossley(hardening(
                hunt_crossley::stiffness_for_depth_of(linear_n_m, exponent, (speed_m_s, mass_kg)),
                exponent,
                hunt_crossley::damping_for_restitution(restitution, speed_m_s).expect("in range"),
            ));
        }
        if let Some((ellipticity, long_axis_rad)) = bore {
            params.race = None;
            params.stator = ellipse(ellipticity, long_axis_rad);
        }
        params
    })
}

fn any_start() -> impl Strategy<Value = Start> {
    let position = (-1.3e-4..1.3e-4_f64, -1.3e-4..1.3e-4_f64);
    let velocity = (-0.5..0.5_f64, -0.5..0.5_f64);
    (position, velocity, -1000.0..1000.0_f64).prop_map(|(p, v, spin_rad_s)| Start {
        spin_phase_rad: 0.7,
        ..start(V2::new(p.0, p.1), V2::new(v.0, v.1), spin_rad_s)
    })
}

const COMMAND_N: V2 = V2::new(120.0, -60.0);
const LOAD_N: V2 = V2::new(-150.0, 200.0);

/// Snapshots at 200 samples of 50 µs and the audit's residual; forces turned by `turn`.
fn run(
    params: &PlantParams,
    start: &Start,
    turn: fn(V2) -> V2,
    (method, rtol): (Method, f64),
) -> (Vec<Snapshot>, f64) {
    let mut plant = build(params, start, options(method, rtol)).expect("valid parameters");
    let mut snapshots = Vec::new();
    for i in 1..=200_u32 {
        let sign = if i % 40 < 20 { 1.0 } else { -1.0 };
        let inputs = Inputs {
            command_n: turn(sign * COMMAND_N),
            external_n: turn(LOAD_N),
        };
        plant
            .advance(f64::from(i) * 50e-6, &inputs, &mut |_| {})
            .expect("the run can be trusted");
        snapshots.push(plant.snapshot());
    }
    (snapshots, plant.audit().residual())
}

fn same(v: V2) -> V2 {
    v
}

fn mirrored(v: V2) -> V2 {
    V2::new(-v.x, v.y)
}

fn quarter_turn(v: V2) -> V2 {
    V2::new(-v.y, v.x)
}

/// Axes of an anisotropic stator swap in a quarter turn; the ones here are isotropic.
fn turned(start: &Start, turn: fn(V2) -> V2, spin: f64, phase: f64) -> Start {
    Start {
        position_m: turn(start.position_m),
        velocity_m_s: turn(start.velocity_m_s),
        spin_rad_s: spin * start.spin_rad_s,
        spin_phase_rad: phase,
    }
}

fn agree(
    a: &[Snapshot],
    b: &[Snapshot],
    turn: fn(V2) -> V2,
    tolerance: f64,
) -> Result<(), TestCaseError> {
    for (a, b) in a.iter().zip(b) {
        prop_assert_eq!(a.mode.in_contact(), b.mode.in_contact());
        let apart = (turn(a.position_m) - b.position_m).norm();
        prop_assert!(
            apart < tolerance * 2e-4,
            "apart by {:e} m at {} s",
            apart,
            a.t_s
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    /// x → −x with Ω → −Ω is the same motion seen in a mirror, to the bit without an unbalance (whose
    /// angle passes through sine and cosine).
    #[test]
    fn mirror(params in any_plant(), start in any_start()) {
        let mut params = params;
        params.rotor.eccentricity_m = 0.0;
        if let SpinParams::Free { drive_torque_n_m, .. } = &mut params.spin {
            *drive_torque_n_m = 0.0;
        }
        let (a, _) = run(&params, &start, same, (Method::Series, 1e-9));
        let (b, _) = run(&params, &turned(&start, mirrored, -1.0, 0.0), mirrored, (Method::Series, 1e-9));
        for (a, b) in a.iter().zip(&b) {
            prop_assert_eq!(mirrored(a.position_m), b.position_m);
            prop_assert_eq!(mirrored(a.velocity_m_s), b.velocity_m_s);
            prop_assert_eq!(a.normal_force_n, b.normal_force_n);
            prop_assert_eq!(a.spin_rad_s, -b.spin_rad_s);
        }
    }

    /// A quarter turn of everything turns the motion.
    #[test]
    fn rotation(params in any_plant(), start in any_start()) {
        let (a, _) = run(&params, &start, same, (Method::Series, 1e-11));
        let phase = start.spin_phase_rad + std::f64::consts::FRAC_PI_2;
        let (b, _) = run(&params, &turned(&start, quarter_turn, 1.0, phase), quarter_turn, (Method::Series, 1e-11));
        agree(&a, &b, quarter_turn, 1e-9)?;
    }

    /// No energy from nowhere, whatever the parts: the residual follows the tolerance.
    #[test]
    fn energy_closes(params in any_plant_of_any_contact(), start in any_start()) {
        for (method, most) in [
            (Method::Series, 0.3),
            (Method::Collocation, 1.0),
        ] {
            if method == Method::Series && !params.has_series() {
                continue;
            }
            for rtol in [1e-4, 1e-6, 1e-9] {
                let (_, residual) = run(&params, &start, same, (method, rtol));
                prop_assert!(
                    residual < most * rtol,
                    "{:?}: residual {:e} at rtol {:e}", method, residual, rtol
                );
            }
        }
    }

    /// Two methods that share nothing but the equations agree.
    #[test]
    fn methods_agree(params in any_plant(), start in any_start()) {
        let (a, _) = run(&params, &start, same, (Method::Series, 1e-11));
        let (b, _) = run(&params, &start, same, (Method::Collocation, 1e-12));
        // Impacts stretch differences a thousandfold.
        agree(&a, &b, same, 1e-8)?;
    }
}

/// What a scene lacks costs no state: four of the rotor, four a ring, the spin if it is free, its angle where an unbalance turns at
/// a free speed, two of a lag.
#[test]
fn absent_parts_have_no_state() {
    let [inner, outer] = two_rings();
    for case in 0..36 {
        let (rings, free, unbalance, magnet) = (case % 3, case / 3 % 2, case / 6 % 2, case / 12);
        let mut params = onset_rig();
        params.stator = stators(inner, outer)[rings];
        if free == 1 {
            params.spin = free_spin(0.05, 0.0);
        }
        params.rotor.eccentricity_m = 1e-6 * unbalance as f64;
        params.magnet =
            (magnet > 0).then_some(magnet_of(1.0, if magnet == 2 { 1e-4 } else { 0.0 }));
        let from = start(V2::zeros(), V2::zeros(), 1.0);
        let states = build(&params, &from, options(Method::Auto, 1e-9))
            .unwrap()
            .states();
        let expected = 4 + 4 * rings + free * (1 + unbalance) + 2 * (magnet / 2);
        assert_eq!(states, expected, "{params:?}");
    }
}

/// A touch that stops within the damper's time, from far off the centre: a force per distance has a pole close by, which the force
/// has not. The work of friction that falls with speed missed 2 tolerances, at every tolerance above a millionth.
#[test]
fn energy_closes_where_a_force_per_distance_has_a_pole() {
    let law = spring(1.7e9, 2.88e5);
    let mut params = free_mass(law, 0.0);
    params.spin = free_spin(1.0, 3.0);
    params.stator = StatorParams::OneMass(two_rings()[0]);
    params.friction = FrictionParams {
        sliding: falling(0.23, 0.07, 2.0),
        rolling_coefficient: 0.03,
    };
    params.magnet = Some(magnet_of(300.0, 0.0));
    let from = Start {
        spin_phase_rad: 0.7,
        ..start(V2::new(-4.8e-5, -1.044e-4), V2::new(-0.214, 0.392), 551.8)
    };
    for rtol in [1e-3, 1e-4, 1e-5] {
        let (_, residual) = run(&params, &from, same, (Method::Series, rtol));
        assert!(residual < 3e-3 * rtol, "{residual:e} at {rtol:e}");
    }
}
