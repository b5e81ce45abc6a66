//! The levitation loop as a baseline: `tuned`, the best that a search finds for impacts, and `stiff`.
//!
//! A loop that a commissioning engineer would accept has a peak sensitivity below 3 and spends less than
//! 5 % of the cap on sensor noise while idle. Among those the search takes the one that recovers from the
//! hardest radial impact; of equals the one with the lower peak sensitivity.

use super::contenders::levitation;
use super::impact::{FIRST_M_S, recoverable_from};
use crate::campaign::each;
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::device::loop_shape::{LoopShape, SampledPlant};
use firmware_bench::run::closed_loop::RunError;
use firmware_bench::scene::Scene;
use firmware_bench::scene::linear_loop::{LinearLoop, is_stable};
use std::f64::consts::TAU;

/// Largest peak sensitivity.
pub const SENSITIVITY: f64 = 3.0;
/// Largest root mean square force by sensor noise, as a share of the cap.
pub const IDLE_NOISE: f64 = 0.05;

/// Shape of a loop on the plant of a scene with one plane, `None` where it is unstable; the second value is the idle noise
/// force as a share of the cap.
pub fn shape(
    scene: &Scene,
    sampled: &SampledPlant,
    params: &LevitationParams,
) -> Option<(LoopShape, f64)> {
    shape_in((scene, 0), sampled, params)
}

/// The same in a plane.
pub(crate) fn shape_in(
    (scene, plane): (&Scene, usize),
    sampled: &SampledPlant,
    params: &LevitationParams,
) -> Option<(LoopShape, f64)> {
    let shape = sampled.close(params)?;
    let sensor = &scene.planes[plane].sensor;
    let quantum = sensor.quantum_m;
    let noise_m = (sensor.noise_rms_m.powi(2) + quantum * quantum / 12.0).sqrt();
    let cap = (scene.plant(plane).magnet).map_or(f64::INFINITY, |m| m.force_max_n);
    Some((shape, shape.noise_gain_n_m * noise_m / cap))
}

/// Loops that are tried on a mass: K_p = m·ω² from 2 Hz, as good as no spring, to 430 Hz, K_d = 2ζ·m·ω, a derivative filter of
/// some samples.
fn candidates(mass_kg: f64, sample_rate_hz: f64) -> Vec<LevitationParams> {
    let period_s = 1.0 / sample_rate_hz;
    let mut all = Vec::new();
    for i in -9..16 {
        let omega = TAU * 15.0 * 1.25_f64.powi(i);
        for damping_ratio in [0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0] {
            for filter in [0.0, 0.5, 1.0, 2.0, 4.0, 8.0] {
                all.push(LevitationParams {
                    proportional_n_m: mass_kg * omega * omega,
                    integral_n_m_s: 0.0,
                    derivative_n_s_m: 2.0 * damping_ratio * mass_kg * omega,
                    derivative_filter_s: filter * period_s,
                });
            }
        }
    }
    all
}

/// PD loops of all planes that a commissioning engineer would accept, each plane alone and the whole at standstill and at its
/// spin: those whose stiffness in the first plane is nearest to this, of equals those with the lowest peak sensitivity there.
/// `None` where none of those that are tried is acceptable.
pub fn acceptable_near(scene: &Scene, proportional_n_m: f64) -> Option<Vec<LevitationParams>> {
    let planes: Vec<(SampledPlant, Vec<LevitationParams>)> = (0..scene.planes.len())
        .map(|plane| {
            let plant = scene.plant(plane);
            let tried = candidates(plant.rotor.mass_kg, scene.sample_rate_hz);
            (SampledPlant::new(&plant, scene.sample_rate_hz, 1), tried)
        })
        .collect();
    let tried = planes.first().map_or(0, |(_, tried)| tried.len());
    // Of the same frequency, damping and filter in all planes.
    let mut accepted: Vec<(f64, f64, Vec<LevitationParams>)> = (0..tried)
        .filter_map(|i| {
            let mut peaks = Vec::new();
            for (plane, (sampled, tried)) in planes.iter().enumerate() {
                let (loop_shape, noise) = shape_in((scene, plane), sampled, &tried[i])?;
                is_fit(&loop_shape, noise).then_some(())?;
                peaks.push(loop_shape.peak_sensitivity);
            }
            let gains: Vec<LevitationParams> = planes.iter().map(|(_, all)| all[i]).collect();
            let first = gains.first()?.proportional_n_m;
            let off = (first / proportional_n_m).ln().abs();
            Some((off, *peaks.first()?, gains))
        })
        .collect();
    accepted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut by_nearness = accepted.into_iter().map(|(_, _, gains)| gains);
    by_nearness.find(|gains| {
        let mut held = scene.clone();
        for (plane, gains) in held.planes.iter_mut().zip(gains) {
            plane.levitation = Some(*gains);
        }
        [0.0, scene.start.spin_rad_s]
            .iter()
            .all(|spin| is_calm(&held, *spin))
    })
}

fn is_fit(loop_shape: &LoopShape, noise: f64) -> bool {
    loop_shape.peak_sensitivity < SENSITIVITY && noise < IDLE_NOISE
}

/// Whether the loop of the whole is stable and keeps to the limit of the sensitivity.
fn is_calm(scene: &Scene, spin_rad_s: f64) -> bool {
    let judged = || {
        let closed = LinearLoop::new(scene, spin_rad_s).ok()?;
        let modes = closed.modes().ok()?;
        is_stable(&modes).then_some(())?;
        let peaks = closed.sensitivity_peaks(&modes);
        Some(peaks.iter().all(|axis| axis.peak < SENSITIVITY))
    };
    judged().unwrap_or(false)
}

/// Those that keep to the limits, with their peak sensitivities.
fn accepted(
    scene: &Scene,
    sampled: &SampledPlant,
    all: Vec<LevitationParams>,
) -> Vec<(LevitationParams, f64)> {
    (all.into_iter())
        .filter_map(|params| {
            let (loop_shape, noise) = shape(scene, sampled, &params)?;
            is_fit(&loop_shape, noise).then_some((params, loop_shape.peak_sensitivity))
        })
        .collect()
}

/// The tuned loop: the best PD, or with integrators of 0.1 s or 0.03 s where one of these is better.
///
/// # Errors
/// [`RunError`] of a run that cannot be trusted.
pub fn tuned(scene: &Scene) -> Result<Option<LevitationParams>, RunError> {
    let sampled = SampledPlant::new(&scene.plant(0), scene.sample_rate_hz, 1);
    let accepted = |all| accepted(scene, &sampled, all);
    let rated = |all: Vec<(LevitationParams, f64)>| {
        let rated = each(&all, |(params, sensitivity)| {
            let make = |s: &Scene| levitation(*params, s);
            let speed = recoverable_from(scene, "tuned", &make, FIRST_M_S)?;
            Ok((speed, -*sensitivity, *params))
        });
        rated.into_iter().collect::<Result<Vec<_>, RunError>>()
    };
    let best = |all: &[(f64, f64, LevitationParams)]| {
        (all.iter().copied()).max_by(|a, b| {
            (a.0, a.1)
                .partial_cmp(&(b.0, b.1))
                .unwrap_or(std::cmp::Ordering::Equal)
        })
    };
    let mass_kg = scene.plant(0).rotor.mass_kg;
    let pd = rated(accepted(candidates(mass_kg, scene.sample_rate_hz)))?;
    let Some(first) = best(&pd) else {
        return Ok(None);
    };
    let with_integrator = [0.1, 0.03].map(|time_s| LevitationParams {
        integral_n_m_s: first.2.proportional_n_m / time_s,
        ..first.2
    });
    let pid = rated(accepted(with_integrator.to_vec()))?;
    let chosen = best(&pid).filter(|b| b.0 > first.0).unwrap_or(first);
    Ok(Some(chosen.2))
}

/// The ordinary loop: K_p ten times the stiffness of shaft and magnets, whichever sign, and among the
/// dampings and filters the one with the lowest peak sensitivity.
pub fn stiff(scene: &Scene) -> Option<LevitationParams> {
    let plant = scene.plant(0);
    let sampled = SampledPlant::new(&plant, scene.sample_rate_hz, 1);
    let (mass, period_s) = (plant.rotor.mass_kg, 1.0 / scene.sample_rate_hz);
    let proportional_n_m = 10.0 * plant.rotor.stiffness_n_m.abs();
    let omega = (proportional_n_m / mass).sqrt();
    let mut best: Option<(f64, LevitationParams)> = None;
    for damping_ratio in [0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4] {
        for filter in [0.0, 0.5, 1.0, 2.0] {
            let params = LevitationParams {
                proportional_n_m,
                integral_n_m_s: 0.0,
                derivative_n_s_m: 2.0 * damping_ratio * mass * omega,
                derivative_filter_s: filter * period_s,
            };
            if let Some((loop_shape, _)) = shape(scene, &sampled, &params)
                && best.is_none_or(|(peak, _)| loop_shape.peak_sensitivity < peak)
            {
                best = Some((loop_shape.peak_sensitivity, params));
            }
        }
    }
    best.map(|(_, params)| params)
}
