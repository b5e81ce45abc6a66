//! Impacts and critical speeds on all threads: each takes a share of them, several at a time; and the cells of their maps.

use crate::campaign::each;
use plant_model::analysis::impact::{
    self, Aim, Criterion, Impact, ImpactError, ImpactOutcome, Search, Tried,
};
use plant_model::params::PlantParams;

/// What one thread takes together.
const CHUNK: usize = 100;

/// [`impact::run_impacts`].
pub(crate) fn run_impacts(
    cases: &[(PlantParams, Impact)],
    criterion: &Criterion,
) -> Result<Vec<ImpactOutcome>, ImpactError> {
    let chunks: Vec<_> = cases.chunks(CHUNK).collect();
    let chunks = each(&chunks, |chunk| impact::run_impacts(chunk, criterion));
    chunks.into_iter().flatten().collect()
}

/// [`impact::critical_speeds_m_s`]; `done` is called with how many after each share.
pub(crate) fn critical_speeds_m_s(
    cases: &[(PlantParams, Aim)],
    search: &Search,
    criterion: &Criterion,
    done: impl Fn(usize) + Sync,
) -> (Vec<Result<Option<f64>, ImpactError>>, Tried) {
    let chunks: Vec<_> = cases.chunks(CHUNK).collect();
    let chunks = each(&chunks, |chunk| {
        let found = impact::critical_speeds_m_s(chunk, search, criterion);
        done(chunk.len());
        found
    });
    let mut tried = Tried::default();
    let found = chunks.into_iter().flat_map(|(found, of_chunk)| {
        tried.impacts += of_chunk.impacts;
        tried.by_lanes += of_chunk.by_lanes;
        tried.undecided += of_chunk.undecided;
        found
    });
    (found.collect(), tried)
}

/// Columns and rows of a map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Grid {
    /// The middle of a cell as a share of its axis, which has so many.
    pub(crate) fn middle(i: usize, of: usize) -> f64 {
        (i as f64 + 0.5) / of as f64
    }

    /// Places of the cells along both axes as shares, rows from the bottom, one after the other.
    pub(crate) fn places(self) -> Vec<(f64, f64)> {
        let row = |j| (0..self.columns).map(move |i| (i, j));
        let of = |(i, j)| (Self::middle(i, self.columns), Self::middle(j, self.rows));
        (0..self.rows).flat_map(row).map(of).collect()
    }

    /// What is in the cells, row by row.
    pub(crate) fn rows<T: Clone>(self, cells: &[T]) -> Vec<Vec<T>> {
        cells.chunks(self.columns).map(<[T]>::to_vec).collect()
    }
}
