//! Outcome of a sweep, read from its results.

use crate::run::columns::Kind;
use crate::run::figures::{Figures, TableLevel};
use crate::run::outcome::Outcome;
use crate::scene::policy_kind::PolicyKind;
use crate::sweep::design::Design;
use crate::sweep::error::SweepError;
use crate::sweep::influence::Influence;
use crate::sweep::map::{OutcomeMap, maps};
use crate::sweep::plan::Plan;
use crate::sweep::sample::{Row, Sample, Sampled};
use crate::sweep::store::Store;
use crate::sweep::table::RowsReader;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;

/// So many errors are listed.
const ERRORS_TOLD: usize = 3;

/// Outcome of a sweep.
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
    /// The supervisor against each other policy, run by run.
    pub pairs: Vec<PairSummary>,
    /// The policy that influences and the worst runs are of.
    pub worst_policy: String,
    /// The figure that they are of.
    pub worst_by: String,
    /// Influence of each key, the largest first: of ranks.
    pub influences: Vec<KeyInfluence>,
    /// Outcomes over pairs of keys. Programs have the results.
    #[serde(skip)]
    pub maps: Vec<OutcomeMap>,
    /// The runs with the most of that figure, the worst first.
    pub worst: Vec<WorstRun>,
}

/// Outcome of a policy.
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

/// The supervisor against another policy on the same runs.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PairSummary {
    /// The other policy.
    pub against: String,
    /// Runs with figures of both.
    pub runs: u64,
    /// Runs that the other recovers and the supervisor does not.
    pub lost: u64,
    /// Runs that the supervisor recovers and the other does not.
    pub gained: u64,
    /// Contact impulse of all these runs under the supervisor over that under the other; null where that has none.
    pub impulse_ratio: Option<f64>,
    #[serde(skip)]
    impulses_n_s: [f64; 2],
}

/// How a run ended under each policy; rows of a run stand together.
#[derive(Default)]
struct Ends {
    run: Option<u64>,
    /// Whether it recovered, and its contact impulse \[N s\].
    of_policies: Vec<Option<(bool, f64)>>,
}

impl Ends {
    /// Goes on to another run, and counts the one before.
    fn begin(&mut self, run: Option<u64>, (own, pairs): (Option<usize>, &mut [PairSummary])) {
        if self.run == run {
            return;
        }
        self.run = run;
        let ends = std::mem::take(&mut self.of_policies);
        let Some(own) = own.filter(|own| *own < ends.len()) else {
            return;
        };
        let others = (ends.iter().enumerate()).filter(|(at, _)| *at != own);
        for (pair, (_, other)) in pairs.iter_mut().zip(others) {
            let (Some(own), Some(other)) = (ends[own], other) else {
                continue;
            };
            pair.runs += 1;
            pair.lost += u64::from(other.0 && !own.0);
            pair.gained += u64::from(own.0 && !other.0);
            pair.impulses_n_s[0] += own.1;
            pair.impulses_n_s[1] += other.1;
            let [with, without] = pair.impulses_n_s;
            pair.impulse_ratio = (without > 0.0).then(|| with / without);
        }
    }
}

/// Quantiles of a figure, in SI units.
#[derive(Debug, Clone, Serialize)]
pub struct Quantiles {
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

/// Keys of the main figures.
fn main_figures() -> Vec<&'static str> {
    let main = (Figures::ALL.iter()).filter(|figure| figure.place == TableLevel::Everywhere);
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
        let mut sample = Sample::new(plan);
        let (mut worst, mut errors) = (Vec::new(), Vec::new());
        let own = (plan.policies().iter()).position(|kind| *kind == PolicyKind::Supervisor);
        let mut pairs: Vec<PairSummary> = (plan.policies().iter().enumerate())
            .filter(|(at, _)| own.is_some_and(|own| own != *at))
            .map(|(_, kind)| PairSummary {
                against: kind.name().to_owned(),
                ..PairSummary::default()
            })
            .collect();
        let mut ends = Ends::default();
        for group in reader.groups() {
            let rows = group.map_err(refused)?;
            for i in 0..rows.len() {
                let row = Row { rows: &rows, i };
                let run = row.number("run").unwrap_or_default() as u64;
                let kept = sampled.has(run);
                let name = row.text("policy").unwrap_or_default();
                let policy = (plan.policies().iter()).position(|kind| kind.name() == name);
                let Some((policy, tally)) = policy.and_then(|at| Some((at, tallies.get_mut(at)?)))
                else {
                    continue;
                };
                if kept {
                    sample.add(plan, &row, run, policy);
                }
                if let Some(error) = row.text("error") {
                    tally.failed += 1;
                    if errors.len() < ERRORS_TOLD {
                        errors.push(format!("run {run}, {name}: {error}"));
                    }
                    continue;
                }
                tally.add(&row, kept);
                ends.begin(Some(run), (own, &mut pairs));
                ends.of_policies.resize(plan.policies().len(), None);
                let recovered = row.outcome().is_some_and(Outcome::recovered);
                let impulse = row.number("contact_impulse_n_s").unwrap_or_default();
                ends.of_policies[policy] = Some((recovered, impulse));
                if plan.is_worst_policy(policy) {
                    rank(&mut worst, plan, &row, run);
                }
            }
        }
        ends.begin(None, (own, &mut pairs));
        let independent = plan.file.design == Design::MonteCarlo;
        let influences = influences(plan, &sample);
        let shown = match plan.file.maps.is_empty() {
            true => strongest(plan, &influences),
            false => plan.file.maps.clone(),
        };
        for (place, run) in worst.iter_mut().enumerate() {
            run.file = format!("worst_{}_run_{}.toml", place + 1, run.run);
        }
        let sampled_runs = sample.len() as u64;
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
            maps: maps(plan, &sample, &shown),
            pairs,
            influences,
            worst,
        })
    }
}

/// Puts a run among the worst, if it is one.
fn rank(worst: &mut Vec<WorstRun>, plan: &Plan, row: &Row<'_>, run: u64) {
    let Some(value) = (row.number(&plan.file.worst.by)).filter(|x| !x.is_nan()) else {
        return;
    };
    // Of equals the first.
    let at = worst.partition_point(|other| other.value >= value);
    let outcome = row.text("outcome").unwrap_or_default().to_owned();
    let file = String::new();
    worst.insert(
        at,
        WorstRun {
            run,
            value,
            outcome,
            file,
        },
    );
    worst.truncate(plan.file.worst.count as usize);
}

/// The largest first.
fn influences(plan: &Plan, sample: &Sample) -> Vec<KeyInfluence> {
    let policy = (0..plan.policies().len()).find(|at| plan.is_worst_policy(*at));
    let places = sample.with_outcome(policy.unwrap_or_default());
    let outcomes = policy.and_then(|at| sample.outcomes.get(at));
    let is_lost = |i: &usize| {
        let outcome = outcomes.and_then(|of| of.get(*i)).copied().flatten();
        f64::from(u8::from(outcome.is_some_and(|of| !of.recovered())))
    };
    let lost: Vec<f64> = places.iter().map(is_lost).collect();
    let (with, figure): (Vec<usize>, Vec<f64>) = (places.iter())
        .filter_map(|i| Some((*i, sample.figure.get(*i).copied().flatten()?)))
        .unzip();
    let mut all: Vec<KeyInfluence> = (plan.file.variations.iter().zip(&sample.keys))
        .map(|(variation, key)| {
            let ordered = variation.values.kind() != Kind::Text;
            let of = |places: &[usize]| places.iter().map(|i| key.values[*i]).collect::<Vec<f64>>();
            KeyInfluence {
                key: variation.key.clone(),
                lost: Influence::of(&of(&places), ordered, &lost),
                figure: Influence::of(&of(&with), ordered, &figure),
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

/// The two keys of most influence, the stronger to the right; none where fewer vary.
fn strongest(plan: &Plan, influences: &[KeyInfluence]) -> Vec<[usize; 2]> {
    let variations = &plan.file.variations;
    let places: Vec<usize> = (influences.iter())
        .filter_map(|of| variations.iter().position(|varied| varied.key == of.key))
        .collect();
    match places[..] {
        [x, y, ..] => vec![[x, y]],
        _ => Vec::new(),
    }
}

impl PairSummary {
    /// In words.
    pub fn sentence(&self) -> String {
        let ratio = self.impulse_ratio.map_or(String::new(), |ratio| {
            format!("; contact impulse {ratio:.2} of its")
        });
        let (lost, gained, against) = (self.lost, self.gained, &self.against);
        format!(
            "The supervisor against {against}, run by run: {lost} lost, {gained} gained of {}{ratio}.",
            self.runs
        )
    }
}

impl Tally {
    fn add(&mut self, row: &Row<'_>, kept: bool) {
        self.runs += 1;
        self.lost += u64::from(row.outcome().is_none_or(|outcome| !outcome.recovered()));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The supervisor second of three policies, in four runs, of which one has no figures under it.
    #[test]
    fn pairs_are_counted_run_by_run() {
        let against = |name: &str| PairSummary {
            against: name.to_owned(),
            ..PairSummary::default()
        };
        let mut pairs = [against("passive"), against("levitation")];
        let mut ends = Ends::default();
        let runs = [
            [Some((false, 4.0)), Some((true, 1.0)), Some((true, 2.0))],
            [Some((false, 2.0)), Some((false, 2.0)), Some((true, 0.0))],
            [Some((true, 9.0)), None, Some((true, 9.0))],
            [Some((true, 2.0)), Some((true, 1.0)), None],
        ];
        for (run, of) in (0..).zip(runs) {
            ends.begin(Some(run), (Some(1), &mut pairs));
            ends.of_policies = of.to_vec();
        }
        ends.begin(None, (Some(1), &mut pairs));
        let counted = |p: &PairSummary| (p.runs, p.lost, p.gained, p.impulse_ratio);
        assert_eq!(counted(&pairs[0]), (3, 0, 1, Some(4.0 / 8.0)));
        assert_eq!(counted(&pairs[1]), (2, 1, 0, Some(3.0 / 2.0)));
        assert!(
            pairs[1]
                .sentence()
                .contains("levitation, run by run: 1 lost, 0 gained of 2")
        );
    }
}
