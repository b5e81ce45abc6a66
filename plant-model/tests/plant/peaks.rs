//! Largest values of a run, which takes few steps, against those of the same run cut into samples of half a microsecond.

use crate::support::bouncing::{bouncing, bouncing_start};
use crate::support::plants::onset_rig;
use plant_model::contact::damping_for_restitution;
use plant_model::params::*;
use plant_model::{Inputs, Meters, Method, Options, V2, build};

const STIFFNESS_N_M: f64 = 1e8;
const CLEARANCE_M: f64 = 2e-4;
const LOAD_N: V2 = V2::new(0.0, -1000.0);
const END_S: f64 = 8e-3;

fn linear(restitution: f64) -> ContactLaw {
    LinearContact {
        stiffness_n_m: STIFFNESS_N_M,
        damping_n_s_m: damping_for_restitution(restitution, STIFFNESS_N_M, 10.0).unwrap(),
    }
    .into()
}

fn laws() -> [(&'static str, ContactLaw); 3] {
    let hertz = HuntCrossley {
        stiffness_n_mn: 1e10,
        exponent: 1.5,
        damping_s_m: 1.0,
    };
    [
        ("linear", linear(0.7)),
        ("overdamped", linear(1e-3)),
        ("Hertz", hertz.into()),
    ]
}

/// A free mass that a load presses on the wall, let go 53 degrees beside the bottom: it swings like a pendulum, and bounces on
/// the contact as it does.
fn swinging(law: ContactLaw, friction: f64, inertia_kg_m2: Option<f64>) -> (PlantParams, Start) {
    let mut params = onset_rig();
    params.rotor.stiffness_n_m = 0.0;
    params.contact.law = law;
    params.friction.sliding = SlidingFriction::Constant {
        coefficient: friction,
    };
    if let Some(inertia_kg_m2) = inertia_kg_m2 {
        params.spin = SpinParams::Free {
            inertia_kg_m2,
            drive_torque_n_m: 0.0,
        };
    }
    let start = Start {
        position_m: V2::new(-0.8, -0.6) * 1.03 * CLEARANCE_M,
        velocity_m_s: V2::zeros(),
        spin_rad_s: 0.0,
        spin_phase_rad: 0.0,
    };
    (params, start)
}

fn meters(
    (params, start): &(PlantParams, Start),
    (method, rtol): (Method, f64),
    samples: u32,
) -> Meters {
    let options = Options {
        method,
        rtol,
        ..Options::default()
    };
    let mut plant = build(params, start, options).unwrap();
    let inputs = Inputs {
        external_n: LOAD_N,
        ..Inputs::default()
    };
    for i in 1..=samples {
        let t = END_S * f64::from(i) / f64::from(samples);
        plant.advance(t, &inputs, &mut |_| {}).unwrap();
    }
    plant.meters()
}

/// Error of a reading at a tolerance as a share of it, by the series where there is one, and by
/// collocation.
fn errors(
    case: &(PlantParams, Start),
    rtol: f64,
    reading: fn(&Meters) -> f64,
) -> (Option<f64>, f64) {
    let series = case.0.has_series();
    let best = match series {
        true => Method::Series,
        false => Method::Collocation,
    };
    let exact = reading(&meters(case, (best, 1e-13), 16_000));
    let error = |method| reading(&meters(case, (method, rtol), 1)) / exact - 1.0;
    (
        series.then(|| error(Method::Series)),
        error(Method::Collocation),
    )
}

/// By tolerance: the series errs by no more than twice that, collocation by no more than what stands beside it.
fn hold(
    name: &str,
    case: &(PlantParams, Start),
    bounds: [(f64, f64); 4],
    reading: fn(&Meters) -> f64,
) {
    for (rtol, most) in bounds {
        let (series, collocation) = errors(case, rtol, reading);
        if let Some(error) = series {
            let held = error.abs() < 2.0 * rtol + 1e-12;
            assert!(held, "{name}, {rtol:e}: {error:e}");
        }
        assert!(
            collocation.abs() < most,
            "{name}, {rtol:e}: {collocation:e}"
        );
    }
}

/// Fastest at the bottom, where no step ends.
#[test]
fn the_fastest_whirl_is_found_within_the_step() {
    for (name, law) in laws() {
        for case in [swinging(law, 0.0, None), swinging(law, 0.3, Some(0.02))] {
            let bounds = [(1e-4, 1e-3), (1e-6, 1e-4), (1e-9, 2e-6), (1e-12, 2e-8)];
            hold(name, &case, bounds, |m| m.peak_backward_speed_m_s);
        }
    }
}

/// Rolling needs most friction at the turning points, where the wall presses least: J/(J + m·R²) of the load across. Not
/// that share of the normal force at the bottom, where none is needed.
#[test]
fn the_largest_friction_torque_is_one_that_occurs() {
    for (name, law) in laws() {
        for (friction, inertia_kg_m2) in [(0.3, 0.02), (0.3, 0.01), (0.15, 0.04)] {
            let case = swinging(law, friction, Some(inertia_kg_m2));
            let bounds = [(1e-4, 2e-2), (1e-6, 5e-4), (1e-9, 2e-5), (1e-12, 5e-8)];
            hold(name, &case, bounds, |m| m.peak_friction_torque_n_m);
            // Friction that does not hold is none: no more than the cone at the largest force.
            let all = meters(&case, (Method::Auto, 1e-9), 1);
            let cone_n_m = friction * all.peak_contact_force_n * case.0.rotor.contact_radius_m;
            assert!(
                all.peak_friction_torque_n_m <= cone_n_m * (1.0 + 1e-9),
                "{name}"
            );
        }
    }
}

/// Bounces are short, and a step takes a good part of one. Sixty draws of speed, spin and stiffness, each until it has bounced some times.
#[test]
fn peaks_of_bounces_are_read_within_the_tolerance() {
    let mut worst = [[0.0_f64; 3]; 2];
    for i in 0..60 {
        // Evenly over all magnitudes of all four: shares of irrational numbers.
        let draw = |irrational: f64, [low, high]: [f64; 2]| {
            low * (high / low).powf((f64::from(i) * irrational).fract())
        };
        let params = bouncing(draw(2.0_f64.sqrt(), [1e7, 1e10]));
        let start = Start {
            velocity_m_s: V2::new(
                draw(3.0_f64.sqrt(), [0.05, 1.0]),
                draw(5.0_f64.sqrt(), [0.01, 0.5]),
            ),
            spin_rad_s: draw(7.0_f64.sqrt(), [50.0, 2000.0]),
            ..bouncing_start()
        };
        let peaks = |method, rtol| {
            let m = meters(&(params, start), (method, rtol), 1);
            [
                m.peak_contact_force_n,
                m.peak_penetration_m,
                m.peak_backward_speed_m_s,
            ]
        };
        let exact = peaks(Method::Series, 1e-13);
        for (method, worst) in [Method::Series, Method::Collocation]
            .into_iter()
            .zip(&mut worst)
        {
            for ((worst, found), exact) in worst.iter_mut().zip(peaks(method, 1e-6)).zip(exact) {
                *worst = worst.max((found / exact - 1.0).abs());
            }
        }
    }
    println!("{worst:?}");
    assert!(
        worst.iter().flatten().all(|error| *error < 1e-6),
        "{worst:?}"
    );
}
