//! Largest values of a run, which takes few steps, against those of the same run cut into samples of half a microsecond.

use crate::support::*;

const LOAD_N: V2 = V2::new(0.0, -1000.0);
const END_S: f64 = 8e-3;

fn laws() -> [(&'static str, ContactLaw); 3] {
    let hertz = hardening(1e10, 1.5, 1.0);
    [
        ("linear", linear(1e8, 0.7).into()),
        ("overdamped", linear(1e8, 1e-3).into()),
        ("Hertz", hertz.into()),
    ]
}

/// A mass on a damper that a load presses on the wall, let go 53 degrees beside the bottom: it swings like a pendulum, and bounces
/// on the contact as it does.
fn swinging(law: ContactLaw, friction: f64, spin: SpinParams) -> (PlantParams, Start) {
    let mut params = free_mass(law, friction);
    params.rotor.damping_n_s_m = onset_rig().rotor.damping_n_s_m;
    params.spin = spin;
    let from = V2::new(-0.8, -0.6) * 1.03 * CLEARANCE_M;
    (params, start(from, V2::zeros(), 0.0))
}

fn meters(
    (params, start): &(PlantParams, Start),
    (method, rtol): (Method, f64),
    samples: u32,
) -> Meters {
    let mut plant = build(params, start, options(method, rtol)).unwrap();
    for i in 1..=samples {
        let t = END_S * f64::from(i) / f64::from(samples);
        plant.advance(t, &load(LOAD_N), &mut |_| {}).unwrap();
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
        let held = collocation.abs() < most;
        assert!(held, "{name}, {rtol:e}: {collocation:e}");
    }
}

/// Fastest at the bottom, where no step ends.
#[test]
fn the_fastest_whirl_is_found_within_the_step() {
    for (name, law) in laws() {
        for (friction, spin) in [(0.0, SpinParams::Held), (0.3, free_spin(0.02, 0.0))] {
            let case = swinging(law, friction, spin);
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
            let case = swinging(law, friction, free_spin(inertia_kg_m2, 0.0));
            let bounds = [(1e-4, 2e-2), (1e-6, 5e-4), (1e-9, 2e-5), (1e-12, 5e-8)];
            hold(name, &case, bounds, |m| m.peak_friction_torque_n_m);
            // Friction that does not hold is none: no more than the cone at the largest force.
            let all = meters(&case, (Method::Auto, 1e-9), 1);
            let cone_n_m = friction * all.peak_contact_force_n * case.0.rotor.contact_radius_m;
            let within = all.peak_friction_torque_n_m <= cone_n_m * (1.0 + 1e-9);
            assert!(within, "{name}");
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
        for (method, worst) in METHODS.into_iter().zip(&mut worst) {
            for ((worst, found), exact) in worst.iter_mut().zip(peaks(method, 1e-6)).zip(exact) {
                *worst = worst.max((found / exact - 1.0).abs());
            }
        }
    }
    println!("{worst:?}");
    let held = worst.iter().flatten().all(|error| *error < 1e-6);
    assert!(held, "{worst:?}");
}
