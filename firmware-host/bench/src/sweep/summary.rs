//! What a sweep came to, read from its results.

use crate::run::columns::Kind;
use crate::run::figures::{Figures, Place};
use crate::sweep::design::Design;
use crate::sweep::error::SweepError;
use crate::sweep::influence::Influence;
use crate::sweep::permutation::mixed;
use crate::sweep::plan::Plan;
use crate::sweep::store::Store;
use crate::sweep::table::{Cells, Rows, RowsReader};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;

/// Of more runs than this a part drawn at random is looked at for quantiles and influences: memory does not grow with runs.
const MOST_SAMPLED: u64 = 1 << 16;
/// So many errors are told.
const ERRORS_TOLD: usize = 3;

/// What a sweep came to.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// Title of the scene.
    pub scene: String,
    /// How runs are spread.
    pub design: Design,
    /// Number of runs, each under every policy.
    pub runs: u64,
    /// Rows without figures.
    pub failed: u64,
    /// The first of their errors, with run and policy.
    pub errors: Vec<String>,
    /// Runs that quantiles and influences are of, where not of all.
    pub sampled_runs: Option<u64>,
    /// Policy by policy.
    pub policies: Vec<PolicySummary>,
    /// The policy that influences and the worst runs are of.
    pub worst_policy: String,
    /// The figure that they are of.
    pub worst_by: String,
    /// Influence of each key, the largest first.
    pub influences: Vec<KeyInfluence>,
    /// The runs with the most of that figure, the worst first.
    pub worst: Vec<WorstRun>,
}

/// What a policy came to.
#[derive(Debug, Clone, Serialize)]
pub struct PolicySummary {
    /// Its name.
    pub policy: String,
    /// Runs with figures.
    pub runs: u64,
    /// Runs without.
    pub failed: u64,
    /// How many ended how.
    pub outcomes: BTreeMap<String, u64>,
    /// Runs that ended neither recovered nor decayed.
    pub lost: u64,
    /// With a confidence of 95 % the share that is lost is at most this: 3 over the runs (rule of three). Only where none of
    /// independently drawn runs was lost, or failed.
    pub lost_at_most: Option<f64>,
    /// Quantiles of the main figures.
    pub figures: Vec<Quantiles>,
}

/// Quantiles of a figure, in SI units.
#[derive(Debug, Clone, Serialize)]
pub struct Quantiles {
    /// Its key.
    pub key: &'static str,
    /// Runs that have it.
    pub runs: u64,
    /// Half of them have no more.
    pub median: f64,
    /// 90 % have no more.
    pub q90: f64,
    /// 99 % have no more.
    pub q99: f64,
    /// Of all runs.
    pub largest: f64,
}

/// What hangs on a key.
#[derive(Debug, Clone, Serialize)]
pub struct KeyInfluence {
    /// Its path.
    pub key: String,
    /// On whether the rotor is lost.
    pub lost: Influence,
    /// On the figure that the worst runs are chosen by.
    pub figure: Influence,
}

/// One of the worst runs.
#[derive(Debug, Clone, Serialize)]
pub struct WorstRun {
    /// Its number.
    pub run: u64,
    /// Its figure.
    pub value: f64,
    /// How it ended.
    pub outcome: String,
    /// Its scene file in the folder of the results.
    pub file: String,
}

/// What is kept of a policy while rows go by.
#[derive(Default)]
struct Tally {
    runs: u64,
    failed: u64,
    lost: u64,
    outcomes: BTreeMap<String, u64>,
    /// Of each main figure.
    samples: Vec<Vec<f64>>,
    largest: Vec<f64>,
}

/// What is kept of the policy of the worst runs.
struct Varied {
    /// Of each key, a value a run, and the texts of which they are numbers.
    values: Vec<(Vec<f64>, BTreeMap<String, usize>)>,
    lost: Vec<f64>,
    /// With the runs that have it.
    figure: Vec<Option<f64>>,
    worst: Vec<WorstRun>,
}

/// Keys of the main figures.
fn main_figures() -> Vec<&'static str> {
    let main = (Figures::ALL.iter()).filter(|figure| figure.place == Place::Everywhere);
    main.map(|figure| figure.key)
        .filter(|key| *key != "outcome")
        .collect()
}

impl Summary {
    /// Of results that are complete.
    ///
    /// # Errors
    /// [`SweepError`] where they cannot be read.
    pub fn new(plan: &Plan, store: &Store) -> Result<Self, SweepError> {
        let path = store.results();
        let file = File::open(&path).map_err(|error| SweepError::results(&path, error))?;
        let refused = |error| SweepError::results(&path, error);
        let reader = RowsReader::open(file, plan.columns()).map_err(refused)?;
        let sampled = Sampled::new(plan.runs());
        let mut tallies: Vec<Tally> = plan.policies().iter().map(|_| Tally::default()).collect();
        let mut varied = Varied::new(plan);
        let mut errors = Vec::new();
        let mut sampled_runs = 0;
        for group in reader.groups() {
            let rows = group.map_err(refused)?;
            for i in 0..rows.len() {
                let row = Row { rows: &rows, i };
                let run = row.number("run").unwrap_or_default() as u64;
                let kept = sampled.has(run);
                let policy = row.text("policy").unwrap_or_default();
                let at = plan
                    .policies()
                    .iter()
                    .position(|kind| kind.name() == policy);
                let Some(tally) = at.and_then(|at| tallies.get_mut(at)) else {
                    continue;
                };
                sampled_runs += u64::from(kept && at == Some(0));
                if let Some(error) = row.text("error") {
                    tally.failed += 1;
                    if errors.len() < ERRORS_TOLD {
                        errors.push(format!("run {run}, {policy}: {error}"));
                    }
                    continue;
                }
                tally.add(&row, kept);
                if policy == plan.worst_policy() {
                    varied.add(plan, &row, run, kept);
                }
            }
        }
        let independent = plan.file.design == Design::MonteCarlo;
        Ok(Self {
            scene: plan.title().to_owned(),
            design: plan.file.design,
            runs: plan.runs(),
            failed: tallies.iter().map(|tally| tally.failed).sum(),
            errors,
            sampled_runs: (sampled_runs < plan.runs()).then_some(sampled_runs),
            policies: (plan.policies().iter().zip(tallies))
                .map(|(kind, tally)| tally.summary(kind.name(), independent))
                .collect(),
            worst_policy: plan.worst_policy().to_owned(),
            worst_by: plan.file.worst.by.clone(),
            influences: varied.influences(plan),
            worst: varied.worst,
        })
    }
}

/// Which runs are looked at.
struct Sampled {
    below: u64,
}

impl Sampled {
    fn new(runs: u64) -> Self {
        let share = MOST_SAMPLED as f64 / runs as f64;
        Self {
            // What is beyond the largest number is the largest.
            below: (share * u64::MAX as f64) as u64,
        }
    }

    /// By a number of its own, so that no pattern of a grid meets one of the part.
    fn has(&self, run: u64) -> bool {
        self.below == u64::MAX || mixed(mixed(run)) < self.below
    }
}

struct Row<'a> {
    rows: &'a Rows,
    i: usize,
}

impl Row<'_> {
    fn column(&self, name: &str) -> Option<&Cells> {
        self.rows.column(name)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.column(name)?.number(self.i)
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.column(name)?.text(self.i)
    }

    fn is_lost(&self) -> bool {
        self.number("recovered") != Some(1.0)
    }
}

impl Tally {
    fn add(&mut self, row: &Row<'_>, kept: bool) {
        self.runs += 1;
        self.lost += u64::from(row.is_lost());
        let outcome = row.text("outcome").unwrap_or_default();
        *self.outcomes.entry(outcome.to_owned()).or_default() += 1;
        let main = main_figures();
        self.samples.resize_with(main.len(), Vec::new);
        self.largest.resize(main.len(), f64::NEG_INFINITY);
        for ((key, sample), largest) in main.iter().zip(&mut self.samples).zip(&mut self.largest) {
            if let Some(value) = row.number(key) {
                *largest = largest.max(value);
                if kept {
                    sample.push(value);
                }
            }
        }
    }

    fn summary(self, policy: &str, independent: bool) -> PolicySummary {
        let figures = main_figures()
            .into_iter()
            .zip(self.samples)
            .zip(self.largest);
        PolicySummary {
            policy: policy.to_owned(),
            runs: self.runs,
            failed: self.failed,
            lost: self.lost,
            lost_at_most: (independent && self.lost + self.failed == 0 && self.runs > 0)
                .then(|| (3.0 / self.runs as f64).min(1.0)),
            outcomes: self.outcomes,
            figures: figures
                .filter_map(|((key, sample), largest)| Quantiles::of(key, sample, largest))
                .collect(),
        }
    }
}

impl Quantiles {
    fn of(key: &'static str, mut sample: Vec<f64>, largest: f64) -> Option<Self> {
        sample.sort_by(f64::total_cmp);
        // The least value that so many do not exceed.
        let quantile = |share: f64| {
            let rank = (share * sample.len() as f64).ceil() as usize;
            sample.get(rank.saturating_sub(1)).copied()
        };
        Some(Self {
            key,
            runs: sample.len() as u64,
            median: quantile(0.5)?,
            q90: quantile(0.9)?,
            q99: quantile(0.99)?,
            largest,
        })
    }
}

impl Varied {
    fn new(plan: &Plan) -> Self {
        Self {
            values: vec![Default::default(); plan.file.variations.len()],
            lost: Vec::new(),
            figure: Vec::new(),
            worst: Vec::new(),
        }
    }

    fn add(&mut self, plan: &Plan, row: &Row<'_>, run: u64, kept: bool) {
        let worst = &plan.file.worst;
        let value = row.number(&worst.by).filter(|x| !x.is_nan());
        if let Some(value) = value {
            // Of equals the first.
            let at = self.worst.partition_point(|other| other.value >= value);
            let outcome = row.text("outcome").unwrap_or_default().to_owned();
            let file = String::new();
            self.worst.insert(
                at,
                WorstRun {
                    run,
                    value,
                    outcome,
                    file,
                },
            );
            self.worst.truncate(worst.count as usize);
        }
        if !kept {
            return;
        }
        for (variation, (values, words)) in plan.file.variations.iter().zip(&mut self.values) {
            let cells = row.column(&variation.key);
            values.push(match cells {
                Some(cells @ Cells::Text(_)) => {
                    let next = words.len();
                    *words.entry(cells.shown(row.i)).or_insert(next) as f64
                }
                cells => cells
                    .and_then(|cells| cells.number(row.i))
                    .unwrap_or(f64::NAN),
            });
        }
        self.lost.push(f64::from(u8::from(row.is_lost())));
        self.figure.push(value);
    }

    fn influences(&mut self, plan: &Plan) -> Vec<KeyInfluence> {
        for (place, run) in self.worst.iter_mut().enumerate() {
            run.file = format!("worst_{}_run_{}.toml", place + 1, run.run);
        }
        let with: Vec<usize> = (0..self.figure.len())
            .filter(|i| self.figure[*i].is_some())
            .collect();
        let figure: Vec<f64> = self.figure.iter().copied().flatten().collect();
        let mut all: Vec<KeyInfluence> = (plan.file.variations.iter().zip(&self.values))
            .map(|(variation, (values, _))| {
                let ordered = variation.values.kind() != Kind::Text;
                let of_figure: Vec<f64> = with.iter().map(|i| values[*i]).collect();
                KeyInfluence {
                    key: variation.key.clone(),
                    lost: Influence::of(values, ordered, &self.lost),
                    figure: Influence::of(&of_figure, ordered, &figure),
                }
            })
            .collect();
        let size = |of: &KeyInfluence| {
            let shares = [of.lost.first_order, of.figure.first_order];
            shares.into_iter().flatten().fold(0.0, f64::max)
        };
        all.sort_by(|a, b| size(b).total_cmp(&size(a)));
        all
    }
}
