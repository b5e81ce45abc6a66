//! Indices of a design that is made for them, of what the runs of one policy came to.

use crate::sweep::design::Design;
use crate::sweep::morris::{self, MorrisEffect};
use crate::sweep::plan::Plan;
use crate::sweep::saltelli::{self, SobolIndex};
use crate::sweep::sample::Row;
use serde::Serialize;

/// How much runs hang on a key, by the design's measure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Index {
    /// Of Saltelli's design.
    Sobol(SobolIndex),
    /// Of Morris's.
    Morris(MorrisEffect),
}

impl Index {
    /// What keys are ranked by: total order, or the mean magnitude of effects.
    pub fn size(&self) -> f64 {
        match self {
            Self::Sobol(of) => of.total_order,
            Self::Morris(of) => of.mean_magnitude,
        }
    }
}

/// Indices of a key.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeyIndices {
    /// Its path.
    pub key: String,
    /// On whether the rotor is lost (1) or not (0); `None` where every run or none is.
    pub lost: Option<Index>,
    /// On the figure that the worst runs are chosen by; `None` where it does not vary.
    pub figure: Option<Index>,
}

/// Indices of all keys.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indices {
    /// The design: `saltelli` or `morris`.
    pub design: Design,
    /// Runs of a block or a trajectory.
    pub block_runs: u64,
    /// Blocks or trajectories whose runs all have an outcome.
    pub whole_blocks: u64,
    /// Of all.
    pub blocks: u64,
    /// Those that also have the figure.
    pub whole_blocks_with_figure: u64,
    /// Key by key, the largest on loss first; of equal ones the largest on the figure.
    pub keys: Vec<KeyIndices>,
}

/// What the runs came to, by their numbers; not a number where they came to nothing. These designs end at some ten million
/// runs of which each takes 16 bytes here.
pub(super) struct CameTo {
    lost: Vec<f64>,
    figure: Vec<f64>,
}

impl CameTo {
    /// Room for the runs of a plan, if its design has indices.
    pub(super) fn new(plan: &Plan) -> Self {
        let runs = match plan.file.design {
            Design::Saltelli | Design::Morris => plan.runs() as usize,
            _ => 0,
        };
        Self {
            lost: vec![f64::NAN; runs],
            figure: vec![f64::NAN; runs],
        }
    }

    pub(super) fn add(&mut self, plan: &Plan, row: &Row<'_>, run: u64) {
        let places = (self.lost.get_mut(run as usize)).zip(self.figure.get_mut(run as usize));
        if let (Some((lost, figure)), Some(outcome)) = (places, row.outcome()) {
            *lost = f64::from(u8::from(!outcome.recovered()));
            *figure = row.number(&plan.file.worst.by).unwrap_or(f64::NAN);
        }
    }

    pub(super) fn indices(&self, plan: &Plan) -> Option<Indices> {
        let keys = plan.file.variations.len();
        let of = |came_to: &[f64]| -> (Option<Vec<Index>>, u64) {
            match plan.file.design {
                Design::Saltelli => {
                    let (all, whole) = saltelli::indices(came_to, keys);
                    let all = all.map(|all| all.into_iter().map(Index::Sobol).collect());
                    (all, whole)
                }
                _ => {
                    let shares = |run| plan.file.points.at(run).shares;
                    let all = morris::effects(came_to, keys, shares);
                    let trajectories = came_to.chunks_exact(morris::trajectory_runs(keys) as usize);
                    let whole = trajectories.filter(|all| all.iter().all(|y| y.is_finite()));
                    let all = all.map(|all| all.into_iter().map(Index::Morris).collect());
                    (all, whole.count() as u64)
                }
            }
        };
        if self.lost.is_empty() {
            return None;
        }
        let ((lost, whole_blocks), (figure, with_figure)) = (of(&self.lost), of(&self.figure));
        let at =
            |of: &Option<Vec<Index>>, key: usize| of.as_ref().and_then(|of| of.get(key)).copied();
        let mut all: Vec<KeyIndices> = (plan.file.variations.iter().enumerate())
            .map(|(i, varied)| KeyIndices {
                key: varied.key.clone(),
                lost: at(&lost, i),
                figure: at(&figure, i),
            })
            .collect();
        let size = |index: Option<Index>| index.map_or(0.0, |index| index.size());
        all.sort_by(|a, b| {
            let on_loss = size(b.lost).total_cmp(&size(a.lost));
            on_loss.then(size(b.figure).total_cmp(&size(a.figure)))
        });
        let block_runs = match plan.file.design {
            Design::Saltelli => saltelli::block_runs(keys),
            _ => morris::trajectory_runs(keys),
        };
        Some(Indices {
            design: plan.file.design,
            block_runs,
            whole_blocks,
            blocks: plan.runs() / block_runs,
            whole_blocks_with_figure: with_figure,
            keys: all,
        })
    }
}
