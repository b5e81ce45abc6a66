//! The reference on whole rotors, which sees the true state: its weights, searched for each blow and kept, and the hardest
//! blow that it recovers from.

use super::hardest::{hardest_from_m_s, hardest_m_s};
use super::plants::{Blow, RotorPlant};
use crate::campaign::Progress;
use crate::overloads::reference::{FINE, RANGES, START, law_of, search, search_from_m_s};
use firmware_bench::run::closed_loop::{Keep, RunError, run_reference};
use firmware_bench::run::whole_clairvoyant::{WholeClairvoyantLaw, WholeReference};
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::policy_kind::PolicyKind;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Direction of the blow \[rad\] in searches, and the seed of whom it is compared with. No rotor of the catalogue knows one
/// direction from another, and the reference sees no noise.
const TRIED: (f64, u64) = (0.4, 1);

/// Range of what is lent to the other plane, from all that the other magnet does taken off twice.
const LENT: (f64, f64) = (-2.0, 2.0);

/// What the search has found for a blow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FoundLaw {
    /// Name of the plant.
    pub plant: String,
    /// The blow, in words.
    pub blow: String,
    /// Weights that recover from the hardest one.
    pub law: WholeClairvoyantLaw,
}

/// What is kept in the project, written by `overloads --search --rotors`.
const KEPT: &str = include_str!("../../scenes/rotors/found.json");

/// All kept results; none if the file is not what it should be.
fn kept() -> &'static [FoundLaw] {
    static ROWS: LazyLock<Vec<FoundLaw>> =
        LazyLock::new(|| serde_json::from_str(KEPT).unwrap_or_default());
    &ROWS
}

/// Searches the weights for every plant and blow.
///
/// # Errors
/// A plant that is no valid scene.
pub fn search_laws(progress: &dyn Progress) -> Result<Vec<FoundLaw>, SceneError> {
    let plants = RotorPlant::all()?;
    progress.begin((plants.len() * Blow::ALL.len()) as u64, "searches");
    let mut found = Vec::new();
    for plant in &plants {
        for blow in Blow::ALL {
            let known = hardest_m_s(plant, blow, PolicyKind::Supervisor, TRIED);
            let from_m_s = search_from_m_s(known);
            let score = |weights: [f64; 6]| {
                let hardest = hardest_from_m_s((from_m_s, FINE), |speed_m_s| {
                    let scene = plant.struck(blow, speed_m_s, TRIED.0, TRIED.1);
                    recovers(&scene, whole(weights), Keep::Decision)
                });
                Ok::<f64, RunError>(hardest)
            };
            let [a, b, c, d, e] = RANGES;
            let [v, w, x, y, z] = START;
            // Nothing fails: a run that cannot be trusted is none that recovers.
            if let Ok((_, weights)) = search([a, b, c, d, e, LENT], [v, w, x, y, z, 0.0], &score) {
                found.push(FoundLaw {
                    plant: plant.name.to_owned(),
                    blow: blow.name().to_owned(),
                    law: whole(weights),
                });
            }
            progress.add(1);
        }
    }
    Ok(found)
}

fn whole([a, b, c, d, e, lent]: [f64; 6]) -> WholeClairvoyantLaw {
    WholeClairvoyantLaw {
        plane: law_of([a, b, c, d, e]),
        lent,
    }
}

/// Whether a law brings both planes back; not if its run cannot be trusted.
fn recovers(scene: &Scene, law: WholeClairvoyantLaw, keep: Keep) -> bool {
    let law = WholeReference::law(law, scene);
    law.is_some_and(|law| brings_back(scene, &law, keep))
}

fn brings_back(scene: &Scene, reference: &WholeReference, keep: Keep) -> bool {
    let run = run_reference(scene, reference, keep);
    run.is_ok_and(|planes| planes.iter().all(|figures| figures.recovered))
}

/// The hardest blow \[m/s\] that the best of the plant's laws, and of the file's loop with the true state, recovers from in
/// each scene, on a grid, all slighter ones of it being recovered from too; `None` where no law is kept.
pub(super) fn hardest_of_reference_m_s(
    plant: &RotorPlant,
    blow: Blow,
    grid: (f64, f64),
) -> Option<f64> {
    let mut laws: Vec<&FoundLaw> = kept()
        .iter()
        .filter(|row| row.plant == plant.name)
        .collect();
    if laws.is_empty() {
        return None;
    }
    // That of the blow first: it mostly settles the matter.
    laws.sort_by_key(|row| row.blow != blow.name());
    let gains: Vec<_> = (plant.scene.planes.iter())
        .filter_map(|plane| plane.levitation)
        .collect();
    let gains = <[_; 2]>::try_from(gains).ok();
    Some(hardest_from_m_s(grid, |speed_m_s| {
        let scene = plant.struck(blow, speed_m_s, TRIED.0, TRIED.1);
        let by_loops = || {
            let loops = gains.and_then(|gains| WholeReference::loops(gains, &scene));
            loops.is_some_and(|loops| brings_back(&scene, &loops, Keep::Verdict))
        };
        (laws.iter()).any(|row| recovers(&scene, row.law, Keep::Verdict)) || by_loops()
    }))
}
