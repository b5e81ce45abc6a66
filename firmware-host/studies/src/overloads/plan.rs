//! The whole catalogue, planned and run.

use super::case::Case;
use super::catalogue::cases;
use super::contenders::Contender;
use super::promises::{Harm, against_levitation, of_results, of_sweeps};
use super::results::{ResultRow, run_case, run_own};
use super::sweeps::{SweepPoint, SweepRow, row, sweep};
use super::{contenders, reference, tune};
use crate::campaign::{Claim, Extent, Progress, Side, each};
use crate::machines::plants::{PlantCase, RATES_HZ, plants};
use crate::machines::tuned_gains::{Row, TunedGains, stored};
use firmware_bench::run::closed_loop::RunError;
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::policy_kind::PolicyKind;
use serde::{Serialize, Serializer};
use std::collections::BTreeSet;

/// Seeds of the sensor noise.
fn seeds(extent: Extent) -> u64 {
    extent.pick(1, 20)
}

/// Quick is one control rate and one cap for P1.
fn takes(extent: Extent, plant: &PlantCase) -> bool {
    let one_of_p1 = !plant.name.starts_with("P1") || plant.name == "P1 150 N";
    extent == Extent::Full || plant.rate_hz == RATES_HZ[1] && one_of_p1
}

/// Why the catalogue has no result.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueError {
    /// A plant of the catalogue is not valid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Two scenes could not be told apart.
    #[error("the title \"{title}\" is that of another scene")]
    Title { title: String },
    /// A run of a sweep cannot be trusted.
    #[error("{plant}, {policy}: {reason}")]
    Run {
        plant: String,
        policy: &'static str,
        /// Why.
        reason: RunError,
    },
    /// Nothing is kept for a plant.
    #[error("no gains are kept for {plant} at {rate_hz} Hz: search them with --search")]
    NotFound {
        plant: String,
        /// Control rate \[Hz\].
        rate_hz: f64,
    },
}

/// What came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Catalogue {
    /// What the supervisor promises.
    #[serde(serialize_with = "with_at_least")]
    pub promises: Vec<Claim>,
    pub sweeps: Vec<SweepRow>,
    /// Every scene against levitation alone.
    pub against_levitation: Vec<Harm>,
    /// Every run.
    pub results: Vec<ResultRow>,
}

/// Programs know the side of a bound of the catalogue by this key.
fn with_at_least<S: Serializer>(claims: &[Claim], to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Promise<'a> {
        name: &'a str,
        bound: f64,
        at_least: bool,
        measured: f64,
        holds: bool,
    }
    to.collect_seq(claims.iter().map(|claim| Promise {
        name: &claim.name,
        bound: claim.bound,
        at_least: claim.side == Side::AtLeast,
        measured: claim.measured,
        holds: claim.holds,
    }))
}

/// A plant at one control rate, with what is kept for it and what happens to it.
struct Site {
    plant: PlantCase,
    found: TunedGains,
    cases: Vec<Case>,
}

/// A run of the plan.
enum Job<'a> {
    Case(&'a Site, &'a Case, Contender, u64),
    Own(&'a Scene, PolicyKind, u64),
}

/// A sweep of the plan: place, contender, seed.
type SweepJob<'a> = (&'a Site, Contender, u64);

/// A sweep takes about as long as so many runs.
const SWEEP_WORTH: u64 = 40;

/// What will be run: the catalogue in an extent, and a user's own scenes with it.
pub struct Plan {
    extent: Extent,
    places: Vec<Site>,
    own: Vec<Scene>,
}

impl Plan {
    /// Sets every plant up.
    ///
    /// # Errors
    /// [`CatalogueError::Scene`], [`CatalogueError::NotFound`], [`CatalogueError::Title`].
    pub fn new(extent: Extent, own: Vec<Scene>) -> Result<Self, CatalogueError> {
        let mut places = Vec::new();
        for rate_hz in RATES_HZ {
            for plant in plants(rate_hz)?.into_iter().filter(|p| takes(extent, p)) {
                let found =
                    stored(&plant.name, rate_hz).ok_or_else(|| CatalogueError::NotFound {
                        plant: plant.name.clone(),
                        rate_hz,
                    })?;
                places.push(Site {
                    cases: cases(&plant, found.tuned),
                    plant,
                    found,
                });
            }
        }
        let of_catalogue = places.iter().flat_map(|place| &place.cases);
        let mut taken: BTreeSet<&str> = of_catalogue.map(|case| case.name.as_str()).collect();
        if let Some(twice) = own.iter().find(|scene| !taken.insert(&scene.title)) {
            let title = twice.title.clone();
            return Err(CatalogueError::Title { title });
        }
        Ok(Self {
            extent,
            places,
            own,
        })
    }

    fn seeds(&self, contender: Contender) -> std::ops::Range<u64> {
        0..if contender.measures() {
            seeds(self.extent)
        } else {
            1
        }
    }

    fn jobs(&self) -> Vec<Job<'_>> {
        let mut jobs = Vec::new();
        for place in &self.places {
            for case in &place.cases {
                for contender in case.contenders {
                    let of = |seed| Job::Case(place, case, *contender, seed);
                    jobs.extend(self.seeds(*contender).map(of));
                }
            }
        }
        for scene in &self.own {
            for kind in &scene.policies {
                let of = |seed| Job::Own(scene, *kind, seed);
                jobs.extend((0..seeds(self.extent)).map(of));
            }
        }
        jobs
    }

    fn sweep_jobs(&self) -> Vec<SweepJob<'_>> {
        let mut jobs = Vec::new();
        for place in &self.places {
            for contender in Contender::ALL {
                jobs.extend(self.seeds(contender).map(|seed| (place, contender, seed)));
            }
        }
        jobs
    }

    /// Runs it on the threads of the pool that it is called in.
    ///
    /// # Errors
    /// [`CatalogueError::Run`].
    pub fn run(&self, progress: &dyn Progress) -> Result<Catalogue, CatalogueError> {
        let pieces = self.jobs().len() as u64 + SWEEP_WORTH * self.sweep_jobs().len() as u64;
        progress.begin(pieces, "the catalogue");
        let results: Vec<ResultRow> = each(&self.jobs(), |job| {
            let row = match job {
                Job::Case(Site { plant, found, .. }, case, contender, seed) => run_case(
                    case,
                    (&plant.name, plant.rate_hz),
                    (*contender, *seed),
                    found,
                ),
                Job::Own(scene, kind, seed) => run_own(scene, *kind, *seed),
            };
            progress.add(1);
            row
        });
        let sweeps = self.sweeps(progress)?;
        // Own scenes come last, and no promise is about them.
        let (of_catalogue, own) = results.split_at(results.partition_point(|row| !row.is_own()));
        let mut harms = against_levitation(of_catalogue, Contender::Tuned.name());
        let mut promises = of_sweeps(&sweeps);
        promises.extend(of_results(of_catalogue, &harms));
        harms.extend(against_levitation(own, PolicyKind::Levitation.name()));
        Ok(Catalogue {
            promises,
            sweeps,
            against_levitation: harms,
            results,
        })
    }

    fn sweeps(&self, progress: &dyn Progress) -> Result<Vec<SweepRow>, CatalogueError> {
        let points = each(
            &self.sweep_jobs(),
            |(Site { plant, found, .. }, contender, seed)| {
                let point = sweep(plant, found, (*contender, *seed)).map_err(|reason| {
                    CatalogueError::Run {
                        plant: plant.name.clone(),
                        policy: contender.name(),
                        reason,
                    }
                });
                progress.add(SWEEP_WORTH);
                point
            },
        );
        let points = points
            .into_iter()
            .collect::<Result<Vec<SweepPoint>, CatalogueError>>()?;
        let mut rows = Vec::new();
        let mut rest = points.as_slice();
        for place in &self.places {
            for contender in Contender::ALL {
                let (own, others) = rest.split_at(self.seeds(contender).count());
                rest = others;
                rows.push(row(&place.plant, contender, own));
            }
        }
        Ok(rows)
    }
}

/// Searches the gains of the baselines and the weights of the reference anew, for every plant and rate.
///
/// # Errors
/// [`CatalogueError`].
pub fn search(progress: &dyn Progress) -> Result<Vec<Row>, CatalogueError> {
    progress.begin(
        (plants(RATES_HZ[0])?.len() * RATES_HZ.len()) as u64,
        "the search",
    );
    let mut rows = Vec::new();
    for rate_hz in RATES_HZ {
        for plant in plants(rate_hz)? {
            let scene = &plant.scene;
            let failed = |reason| CatalogueError::Run {
                plant: plant.name.clone(),
                policy: "search",
                reason,
            };
            let none = || CatalogueError::NotFound {
                plant: plant.name.clone(),
                rate_hz,
            };
            let tuned = tune::tuned(scene).map_err(failed)?.ok_or_else(none)?;
            let stiff = tune::stiff(scene).ok_or_else(none)?;
            let make = |s: &Scene| contenders::levitation(tuned, s);
            let known = super::impact::recoverable_m_s(scene, "tuned", &make).map_err(failed)?;
            let from = reference::search_from_m_s(known);
            let impact_law = reference::impact_law(scene, from).map_err(failed)?;
            let whirl_law = reference::whirl_law(scene).map_err(failed)?;
            rows.push(Row {
                plant: plant.name.clone(),
                rate_hz,
                found: TunedGains {
                    tuned,
                    stiff,
                    impact_law,
                    whirl_law: whirl_law.unwrap_or(impact_law),
                },
            });
            progress.add(1);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One plant with some of its cases, in pools of one and of two threads.
    #[test]
    fn threads_change_nothing() {
        let mut plan = Plan::new(Extent::Quick, Vec::new()).unwrap();
        plan.places.truncate(1);
        let cases = std::mem::take(&mut plan.places[0].cases);
        plan.places[0].cases = cases.into_iter().step_by(12).collect();
        let [alone, together] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let catalogue = pool.unwrap().install(|| plan.run(&())).unwrap();
            serde_json::to_string(&catalogue).unwrap()
        });
        assert!(alone == together && alone.len() > 10_000, "{alone}");
    }
}
