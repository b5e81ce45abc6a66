//! Rotors that hardly spin: sliding and rolling friction turn round at the same speed, and round-off decides between modes.

use crate::support::plants::onset_rig;
use plant_model::contact::damping_for_restitution;
use plant_model::params::*;
use plant_model::{Inputs, Method, Mode, Options, V2, build};

/// The rig without its shaft, under its weight, at a spin that is held or nearly none; falls onto the wall, rolls and rests.
fn falls(
    law: ContactLaw,
    spin: (SpinParams, f64),
    rolling: f64,
    velocity: V2,
) -> Result<f64, String> {
    let base = onset_rig();
    let mut params = PlantParams {
        rotor: RotorParams {
            stiffness_n_m: 0.0,
            damping_n_s_m: 0.0,
            ..base.rotor
        },
        spin: spin.0,
        ..base
    };
    params.contact.law = law;
    params.friction.rolling_coefficient = rolling;
    let start = Start {
        position_m: V2::zeros(),
        velocity_m_s: velocity,
        spin_rad_s: spin.1,
        spin_phase_rad: 0.0,
    };
    let mut plant = build(&params, &start, Options::default()).map_err(|e| e.to_string())?;
    let inputs = Inputs {
        external_n: V2::new(0.0, -9.81 * params.rotor.mass_kg),
        ..Inputs::default()
    };
    for i in 1..=8000 {
        plant
            .advance(50e-6 * f64::from(i), &inputs, &mut |_| {})
            .map_err(|e| format!("{velocity:?}, {rolling}: {e}"))?;
    }
    Ok(plant.audit().residual())
}

/// Whatever the start, such a run comes to its end, and its energy adds up.
#[test]
fn a_rotor_that_hardly_spins_comes_to_rest() {
    let mass_kg = onset_rig().rotor.mass_kg;
    let linear: ContactLaw = LinearContact {
        stiffness_n_m: 1e8,
        damping_n_s_m: damping_for_restitution(0.7, 1e8, mass_kg).unwrap(),
    }
    .into();
    let free = SpinParams::Free {
        inertia_kg_m2: 0.05,
        drive_torque_n_m: 0.0,
    };
    for i in 0..30 {
        let angle = 0.7 * f64::from(i);
        let velocity = (0.02 + 0.003 * f64::from(i)) * V2::new(angle.cos(), angle.sin());
        for rolling in [0.0, 0.001, 0.025] {
            for spin in [(SpinParams::Held, 0.0), (free, 0.0), (free, 3.0)] {
                let residual = falls(linear, spin, rolling, velocity).unwrap();
                assert!(residual < 1e-9, "{residual}");
            }
        }
    }
}

/// Without spin and race the sliding speed is the whirl's: what rests slips as soon as it whirls, in one change of mode and
/// by every method. A load turns away from under the rotor until it slips, swings and rests again.
#[test]
fn without_spin_a_rotor_at_rest_begins_to_slip_and_to_whirl_at_once() {
    for turn in [1.0, -1.0] {
        for (friction, rolling) in [(0.1, 0.02), (0.02, 0.1), (0.125, 0.125)] {
            let mut params = onset_rig();
            params.rotor.stiffness_n_m = 0.0;
            params.friction = FrictionParams {
                sliding: SlidingFriction::Constant {
                    coefficient: friction,
                },
                rolling_coefficient: rolling,
            };
            let start = Start {
                position_m: V2::new(0.0, -2e-4 - 1e-6),
                velocity_m_s: V2::zeros(),
                spin_rad_s: 0.0,
                spin_phase_rad: 0.0,
            };
            let changes = |method| {
                let options = Options {
                    method,
                    ..Options::default()
                };
                let mut plant = build(&params, &start, options).unwrap();
                let mut modes = vec![plant.mode()];
                // To 30 degrees, where friction holds 7 to 14, and on there.
                for i in 0..1000_i32 {
                    let degrees = (0.3 * f64::from(i)).min(30.0);
                    let (sin, cos) = (turn * degrees.to_radians()).sin_cos();
                    let inputs = Inputs {
                        external_n: 100.0 * V2::new(sin, -cos),
                        ..Inputs::default()
                    };
                    plant
                        .advance(5e-5 * f64::from(i + 1), &inputs, &mut |now| {
                            modes.push(now.mode);
                        })
                        .unwrap();
                }
                modes
            };
            let slip = match turn > 0.0 {
                true => Mode::SlipPositive,
                false => Mode::SlipNegative,
            };
            let modes = changes(Method::Series);
            assert_eq!(modes[..2], [Mode::Seated, slip], "{friction}, {rolling}");
            assert_eq!(modes.last(), Some(&Mode::Seated), "{friction}, {rolling}");
            assert!(!modes.contains(&Mode::Roll), "{friction}, {rolling}");
            assert_eq!(changes(Method::Collocation), modes, "{friction}, {rolling}");
        }
    }
}

/// A rotor that swings off the wall may be carried on for as long as one likes: nothing moves too fast.
#[test]
fn a_long_flight_is_no_work_limit() {
    let start = Start {
        position_m: V2::new(1e-5, 0.0),
        velocity_m_s: V2::zeros(),
        spin_rad_s: 200.0,
        spin_phase_rad: 0.0,
    };
    let mut params = onset_rig();
    params.rotor.eccentricity_m = 0.0;
    let mut plant = build(&params, &start, Options::default()).unwrap();
    let rate = params.natural_frequency_rad_s().unwrap();
    let many = Options::default().steps_per_sample as f64;
    plant
        .advance(2.0 * many / rate, &Inputs::default(), &mut |_| {})
        .unwrap();
    assert_eq!(plant.snapshot().mode, Mode::Flight);
    // All of them count in the whole run.
    let few = Options {
        steps: 1000,
        ..Options::default()
    };
    let mut plant = build(&params, &start, few).unwrap();
    let error = plant.advance(2.0 * many / rate, &Inputs::default(), &mut |_| {});
    assert!(matches!(
        error,
        Err(plant_model::PlantError::WorkLimit { steps: 1000, .. })
    ));
}
