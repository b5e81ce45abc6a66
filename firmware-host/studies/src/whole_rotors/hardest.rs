//! The hardest blow that a whole rotor comes back from, and the search for the levitation loop that takes the hardest.

use super::plants::{Blow, Loop, RotorPlant};
use crate::campaign::{Progress, run_all};
use crate::overloads::impact::STEP;
use crate::overloads::tune::{IDLE_NOISE, SENSITIVITY, shape_in};
use crate::paired::pair::run_rotor;
use firmware_bench::device::loop_shape::SampledPlant;
use firmware_bench::scene::policy_kind::PolicyKind;

/// First speed \[m/s\].
pub(super) const FIRST_M_S: f64 = 0.1;
/// Nothing is searched beyond this speed \[m/s\].
const LAST_M_S: f64 = 6.0;

/// The hardest blow \[m/s\] of a direction and seed, on a grid, all slighter ones being recovered from too; 0 if the first
/// is not, or where a run cannot be trusted.
pub(super) fn hardest_m_s(plant: &RotorPlant, blow: Blow, kind: PolicyKind, of: (f64, u64)) -> f64 {
    hardest_from_m_s((FIRST_M_S, STEP), |speed_m_s| {
        brings_back(plant, (blow, speed_m_s), kind, of)
    })
}

/// Whether a policy recovers from a blow in a direction \[rad\] with a seed.
pub(super) fn brings_back(
    plant: &RotorPlant,
    (blow, speed_m_s): (Blow, f64),
    kind: PolicyKind,
    (angle_rad, seed): (f64, u64),
) -> bool {
    let scene = plant.struck(blow, speed_m_s, angle_rad, seed);
    run_rotor(&scene, kind).is_ok_and(|run| run.recovered)
}

/// The last speed \[m/s\] that somebody comes back from, of a grid that grows by a factor from a first one, all before it being
/// come back from too; 0 if the first is not.
pub(super) fn hardest_from_m_s((first_m_s, factor): (f64, f64), back: impl Fn(f64) -> bool) -> f64 {
    let (mut last, mut speed) = (0.0, first_m_s);
    while speed < LAST_M_S && back(speed) {
        last = speed;
        speed *= factor;
    }
    last
}

/// Loops that are tried: from 12 to 140 Hz, well damped or not, by plane, or by mode with cross feedback.
fn candidates(cross: &[Option<f64>]) -> Vec<Loop> {
    let mut all = Vec::new();
    for i in 0..7 {
        for damping_ratio in [0.5, 0.8, 1.2, 2.0] {
            all.extend(cross.iter().map(|cross| Loop {
                frequency_hz: 12.0 * 1.5_f64.powi(i),
                damping_ratio,
                filter: 1.0,
                cross: *cross,
            }));
        }
    }
    all
}

/// Whether an engineer would accept it: in every plane taken alone, peak sensitivity below 3, and less than 5 % of the cap for
/// noise.
fn is_fit(plant: &RotorPlant, by: &Loop) -> bool {
    let alone = plant.levitated_by(&Loop { cross: None, ..*by });
    let scene = &alone.scene;
    scene.planes.iter().enumerate().all(|(i, plane)| {
        let sampled = SampledPlant::new(&scene.plant(i), scene.sample_rate_hz, 1);
        let found = (plane.levitation).and_then(|gains| shape_in((scene, i), &sampled, &gains));
        found.is_some_and(|(loop_shape, noise)| {
            loop_shape.peak_sensitivity < SENSITIVITY && noise < IDLE_NOISE
        })
    })
}

/// The loop that takes the hardest blows, by the product over all directions, of those that are fit; `None` where none is.
pub(super) fn tuned(
    plant: &RotorPlant,
    cross: &[Option<f64>],
    progress: &dyn Progress,
) -> Option<(Loop, f64)> {
    let fit: Vec<Loop> = (candidates(cross).into_iter())
        .filter(|by| is_fit(plant, by))
        .collect();
    let scores = run_all(&fit, progress, |by| score(&plant.levitated_by(by)));
    let all = fit.into_iter().zip(scores);
    all.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Geometric mean of the hardest blows of all directions under levitation alone \[m/s\].
pub(super) fn score(plant: &RotorPlant) -> f64 {
    let hardest =
        |blow: &Blow| hardest_m_s(plant, *blow, PolicyKind::Levitation, (0.4, 1)).max(1e-3);
    let product: f64 = Blow::ALL.iter().map(hardest).product();
    product.powf(0.25)
}
