//! Closed loops of the catalogue, recorded.

use super::numbers::Number;
use super::tick_log::{Piece, TickLog};
use crate::campaign::each;
use crate::machines::plants::{RATES_HZ, plants};
use crate::machines::tuned_gains::stored;
use crate::overloads::catalogue::cases;
use crate::overloads::plan::CatalogueError;
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::controller::supervised;
use firmware_bench::scene::Scene;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;

/// What comes later repeats itself: no more than this is recorded of a scene \[s\].
const LONGEST_S: f64 = 0.25;
/// Of the order of scenes.
const SEED: u64 = 20;

/// Scenes of the catalogue under the supervisor: every group in turn, in each an order that is shuffled, the
/// same every time.
///
/// # Errors
/// [`CatalogueError`] if the catalogue is not valid.
fn scenes() -> Result<Vec<Scene>, CatalogueError> {
    let mut groups: BTreeMap<&str, Vec<Scene>> = BTreeMap::new();
    for rate_hz in RATES_HZ {
        for plant in plants(rate_hz)? {
            let found = stored(&plant.name, rate_hz).ok_or_else(|| CatalogueError::NotFound {
                plant: plant.name.clone(),
                rate_hz,
            })?;
            for case in cases(&plant, found.tuned) {
                let mut scene = case.scene;
                scene.duration_s = scene.duration_s.min(LONGEST_S);
                scene.planes[0].levitation = Some(found.tuned);
                groups.entry(case.group).or_default().push(scene);
            }
        }
    }
    let mut chance = ChaCha8Rng::seed_from_u64(SEED);
    let mut groups: Vec<Vec<Scene>> = groups.into_values().collect();
    for group in &mut groups {
        for last in (1..group.len()).rev() {
            group.swap(last, chance.next_u64() as usize % (last + 1));
        }
    }
    let longest = groups.iter().map(Vec::len).max().unwrap_or(0);
    let mut scenes = Vec::new();
    for _ in 0..longest {
        scenes.extend(groups.iter_mut().filter_map(Vec::pop));
    }
    Ok(scenes)
}

/// Ticks of a scene.
fn ticks_of(scene: &Scene) -> usize {
    (scene.duration_s * scene.sample_rate_hz).round().max(1.0) as usize
}

/// As many scenes as there are in so many ticks, and how many were passed over because their configuration does not
/// fit the numbers.
///
/// # Errors
/// [`CatalogueError`] if the catalogue is not valid.
pub(crate) fn closed_loops(
    number: Number,
    ticks: usize,
) -> Result<(Vec<Piece>, usize), CatalogueError> {
    let (mut left, mut left_out) = (ticks, 0);
    let chosen: Vec<Scene> = (scenes()?.into_iter())
        .filter(|scene| {
            let fits = scene.planes[0]
                .supervisor
                .is_none_or(|config| number.fits(&config));
            left_out += usize::from(!fits);
            fits
        })
        .take_while(|scene| {
            let enough = left.checked_sub(ticks_of(scene));
            left = enough.unwrap_or(0);
            enough.is_some()
        })
        .collect();
    // In the scenes' order, whatever finishes first.
    let pieces = each(&chosen, |scene| recorded(number, scene));
    Ok((pieces.into_iter().flatten().collect(), left_out))
}

/// A scene, recorded. A run that could not be trusted to its end is recorded up to there: for the supervisor its
/// samples are as good as any.
fn recorded(number: Number, scene: &Scene) -> Option<Piece> {
    let config = scene.planes[0].supervisor?;
    let log = TickLog::default();
    let policy = supervised(scene, number.recorder(&config, &log)?)?;
    let _ended = run_policy(scene, (policy, "supervisor"), Keep::Verdict, &mut |_| {});
    let ticks = log.take();
    Some(Piece { config, ticks })
}
