//! Where in the plane of two keys runs are lost.

use crate::report::plot::text::figures;
use crate::run::columns::Kind;
use crate::run::outcome::Outcome;
use crate::sweep::plan::Plan;
use crate::sweep::sample::Sample;
use crate::sweep::values::Values;

/// Values that are distinguished by name at most; more are put into equal parts of their range.
const MOST_NAMES: usize = 24;
/// Parts of a range at most, and runs that each cell should have.
const MOST_PARTS: usize = 16;
const RUNS_OF_A_CELL: f64 = 8.0;
/// Runs that are shown one by one at most.
const MOST_DOTS: usize = 500;

/// An axis of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAxis {
    pub key: String,
    /// What of it is where.
    pub places: Places,
}

/// Places along an axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Places {
    /// A place for each value: as it is read, and as it is in the results.
    Named(Vec<(String, f64)>),
    /// Equal parts from the least to the largest value; of its logarithm where that is evenly spread.
    Parts {
        /// The least.
        low: f64,
        /// The largest.
        high: f64,
        /// How many.
        count: usize,
        /// By ratios.
        log: bool,
    },
}

/// Runs of a cell, and how many of them were lost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counted {
    /// Runs with figures.
    pub runs: u32,
    /// Ended neither recovered nor decayed.
    pub lost: u32,
}

/// Outcomes of a policy over two keys.
#[derive(Debug, Clone, PartialEq)]
pub struct OutcomeMap {
    pub policy: &'static str,
    /// To the right.
    pub x: MapAxis,
    /// Upwards.
    pub y: MapAxis,
    /// Rows from bottom to top, cells from left to right.
    pub cells: Vec<Vec<Counted>>,
    /// Runs one by one, where they are few and both keys have a range.
    pub dots: Option<Vec<(f64, f64, Outcome)>>,
}

/// Maps of every policy over each pair of keys, given by their places.
pub(super) fn maps(plan: &Plan, sample: &Sample, pairs: &[[usize; 2]]) -> Vec<OutcomeMap> {
    let mut maps = Vec::new();
    for pair in pairs {
        let [Some(x), Some(y)] = pair.map(|key| axis(plan, sample, key)) else {
            continue;
        };
        let values = |i: usize| pair.map(|key| sample.keys[key].values[i]);
        for (policy, outcomes) in plan.policies().iter().zip(&sample.outcomes) {
            let mut cells = vec![vec![Counted::default(); x.places.count()]; y.places.count()];
            let mut dots = Vec::new();
            for (i, outcome) in outcomes.iter().enumerate() {
                let [at_x, at_y] = values(i);
                let places = (x.places.of(at_x)).zip(y.places.of(at_y));
                let (Some((column, row)), Some(outcome)) = (places, outcome) else {
                    continue;
                };
                let cell = &mut cells[row][column];
                cell.runs += 1;
                cell.lost += u32::from(!outcome.recovered());
                dots.push((at_x, at_y, *outcome));
            }
            let ranges = [&x, &y]
                .iter()
                .all(|axis| matches!(axis.places, Places::Parts { .. }));
            maps.push(OutcomeMap {
                policy: policy.name(),
                x: x.clone(),
                y: y.clone(),
                cells,
                dots: (ranges && dots.len() <= MOST_DOTS).then_some(dots),
            });
        }
    }
    maps
}

/// `None` for more words than can be distinguished, and where a key has no value at all.
fn axis(plan: &Plan, sample: &Sample, key: usize) -> Option<MapAxis> {
    let (varied, of) = (&plan.file.variations[key], &sample.keys[key]);
    let mut distinct: Vec<f64> = of
        .values
        .iter()
        .copied()
        .filter(|x| x.is_finite())
        .collect();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    let (low, high) = (*distinct.first()?, *distinct.last()?);
    let listed = matches!(varied.values, Values::Listed(_));
    // Also the levels of a design: run upon run would lie on one place.
    let several = 2 * distinct.len() <= of.values.len();
    let few = distinct.len() <= MOST_NAMES && (listed || low == high || several);
    let places = if few {
        let names = match of.words.is_empty() {
            true => named(&varied.values, &distinct),
            false => (distinct.iter())
                .map(|place| of.words.get(*place as usize).cloned().unwrap_or_default())
                .collect(),
        };
        Places::Named(names.into_iter().zip(distinct).collect())
    } else if of.words.is_empty() {
        // As many as leave each cell some runs, also beside an axis of as many parts.
        let count = (sample.len() as f64 / RUNS_OF_A_CELL).sqrt() as usize;
        Places::Parts {
            low,
            high,
            count: count.clamp(2, MOST_PARTS),
            log: matches!(varied.values, Values::LogUniform { .. }) && low > 0.0,
        }
    } else {
        return None;
    };
    let key = varied.key.clone();
    Some(MapAxis { key, places })
}

/// Truth as a word, numbers by three figures, or by six where that would make two of them one.
fn named(values: &Values, distinct: &[f64]) -> Vec<String> {
    let six = |x: &f64| {
        let rounded = format!("{x:.5e}").parse::<f64>();
        rounded.unwrap_or(*x).to_string()
    };
    let three: Vec<String> = distinct.iter().map(|x| figures(*x)).collect();
    match values.kind() {
        Kind::Truth => distinct.iter().map(|x| (*x != 0.0).to_string()).collect(),
        _ if three.windows(2).all(|pair| pair[0] != pair[1]) => three,
        _ => distinct.iter().map(six).collect(),
    }
}

impl Places {
    /// How many.
    pub fn count(&self) -> usize {
        match self {
            Self::Named(names) => names.len(),
            Self::Parts { count, .. } => *count,
        }
    }

    /// The place of a value.
    fn of(&self, value: f64) -> Option<usize> {
        match self {
            Self::Named(names) => names.iter().position(|(_, at)| *at == value),
            Self::Parts {
                low,
                high,
                count,
                log,
            } => {
                let share = match log {
                    true => (value / low).ln() / (high / low).ln(),
                    false => (value - low) / (high - low),
                };
                (share >= 0.0).then(|| ((share * *count as f64) as usize).min(count - 1))
            }
        }
    }

    /// Where a part begins; its number may be one more than there are.
    pub fn edge(&self, part: usize) -> f64 {
        match self {
            Self::Named(names) => names.get(part).map_or(f64::NAN, |(_, at)| *at),
            Self::Parts {
                low,
                high,
                count,
                log,
            } => {
                let share = part as f64 / *count as f64;
                match log {
                    true => low * (high / low).powf(share),
                    false => low + (high - low) * share,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_in_the_part_that_they_lie_in() {
        for log in [false, true] {
            let places = Places::Parts {
                low: 1.0,
                high: 16.0,
                count: 4,
                log,
            };
            assert_eq!(places.of(1.0), Some(0));
            assert_eq!(places.of(16.0), Some(3));
            assert_eq!(places.of(3.0), Some(if log { 1 } else { 0 }));
            assert_eq!((places.of(0.5), places.of(f64::NAN)), (None, None));
            for part in 0..4 {
                let inside = places.edge(part) * 1.001;
                assert_eq!(places.of(inside), Some(part));
            }
            assert!((places.edge(4) - 16.0).abs() < 1e-12);
        }
        let named = Places::Named(vec![("a".to_owned(), 0.0), ("b".to_owned(), 2.0)]);
        assert_eq!((named.of(2.0), named.of(1.0)), (Some(1), None));
    }

    #[test]
    fn numbers_are_as_short_as_tells_them_apart() {
        let values = Values::Listed(vec![toml::Value::Float(1.0)]);
        let short = named(&values, &[0.1, 0.100_000_000_01, 0.2]);
        assert_eq!(named(&values, &[0.1 + 0.2, 900.0]), ["0.3", "900"]);
        assert_eq!(named(&values, &[0.123_4, 0.123_45]), ["0.1234", "0.12345"]);
        assert_eq!(short, ["0.1", "0.1", "0.2"], "six are enough");
    }
}
