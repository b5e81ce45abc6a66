//! What is kept of a sweep's runs for what is said about their keys: of many runs a part drawn at random, so that memory does
//! not grow with them.

use crate::run::columns::Kind;
use crate::run::outcome::Outcome;
use crate::sweep::permutation::mixed;
use crate::sweep::plan::Plan;
use crate::sweep::table::{Cells, Rows};
use std::collections::BTreeMap;

/// Of more runs than this a part is looked at.
const MOST_SAMPLED: u64 = 1 << 16;

/// A row of results.
pub(super) struct Row<'a> {
    pub(super) rows: &'a Rows,
    pub(super) i: usize,
}

impl Row<'_> {
    pub(super) fn column(&self, name: &str) -> Option<&Cells> {
        self.rows.column(name)
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.column(name)?.number(self.i)
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        self.column(name)?.text(self.i)
    }

    /// How it ended; `None` of a row without figures.
    pub(super) fn outcome(&self) -> Option<Outcome> {
        Outcome::from_name(self.text("outcome")?)
    }
}

/// Which runs are looked at.
pub(super) struct Sampled {
    below: u64,
}

impl Sampled {
    pub(super) fn new(runs: u64) -> Self {
        let share = MOST_SAMPLED as f64 / runs as f64;
        Self {
            // What is beyond the largest number is the largest.
            below: (share * u64::MAX as f64) as u64,
        }
    }

    /// By a number of its own, so that no pattern of a grid meets one of the part.
    pub(super) fn has(&self, run: u64) -> bool {
        self.below == u64::MAX || mixed(mixed(run)) < self.below
    }
}

/// Values of a key, a run each.
pub(super) struct KeyValues {
    /// Of a list of words their places in it.
    pub(super) values: Vec<f64>,
    /// Those words.
    pub(super) words: Vec<String>,
    places: BTreeMap<String, usize>,
}

/// The runs that are looked at, in their order.
pub(super) struct Sample {
    runs: Vec<u64>,
    pub(super) keys: Vec<KeyValues>,
    /// How each ended, policy by policy; `None` of what has no figures.
    pub(super) outcomes: Vec<Vec<Option<Outcome>>>,
    /// The figure by which the worst are chosen, under the policy that they are of.
    pub(super) figure: Vec<Option<f64>>,
}

impl Sample {
    pub(super) fn new(plan: &Plan) -> Self {
        let key = |words: Vec<String>| KeyValues {
            values: Vec::new(),
            places: (words.iter().enumerate().rev())
                .map(|(place, word)| (word.clone(), place))
                .collect(),
            words,
        };
        let varied = plan.file.variations.iter();
        Self {
            runs: Vec::new(),
            keys: varied.map(|varied| key(varied.values.words())).collect(),
            outcomes: vec![Vec::new(); plan.policies().len()],
            figure: Vec::new(),
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.runs.len()
    }

    /// Puts a row to its run; the rows of a run follow each other.
    pub(super) fn add(&mut self, plan: &Plan, row: &Row<'_>, run: u64, policy: usize) {
        if self.runs.last() != Some(&run) {
            self.runs.push(run);
            for (varied, key) in plan.file.variations.iter().zip(&mut self.keys) {
                let cells = row.column(&varied.key);
                let word = cells.and_then(|cells| cells.text(row.i));
                let value = match varied.values.kind() {
                    Kind::Text => word
                        .and_then(|word| key.places.get(word))
                        .map(|at| *at as f64),
                    _ => cells.and_then(|cells| cells.number(row.i)),
                };
                key.values.push(value.unwrap_or(f64::NAN));
            }
            self.outcomes.iter_mut().for_each(|of| of.push(None));
            self.figure.push(None);
        }
        if let Some(last) = self.outcomes.get_mut(policy).and_then(|of| of.last_mut()) {
            *last = row.outcome();
        }
        if let (true, Some(last)) = (plan.is_worst_policy(policy), self.figure.last_mut()) {
            *last = row.number(&plan.file.worst.by).filter(|x| !x.is_nan());
        }
    }

    /// Places of runs that a policy has an outcome of.
    pub(super) fn with_outcome(&self, policy: usize) -> Vec<usize> {
        let outcomes = self.outcomes.get(policy).map_or(&[][..], Vec::as_slice);
        let places = outcomes.iter().enumerate();
        places
            .filter_map(|(place, outcome)| outcome.is_some().then_some(place))
            .collect()
    }
}
