//! How much of what runs come to hangs on each key that varies.

use serde::Serialize;

/// Fewer runs say nothing.
const LEAST_RUNS: usize = 20;
/// More different values are put into bins, with so many runs in each at least.
const MOST_BINS: usize = 32;
const LEAST_IN_BIN: usize = 8;

/// Influence of a key on what runs come to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Influence {
    /// Spearman's correlation of ranks: 1 where a larger value always comes to more, −1 where to less, about 0 where neither.
    /// `None` for a key whose values have no order, and where nothing varies.
    pub rank_correlation: Option<f64>,
    /// Share of the variance that goes away when the value is known, as from groups of runs with the same or close values, less
    /// what such groups take away by chance: Sobol's index of first order, where keys are drawn independently. Of ranks, so
    /// that a few huge numbers do not decide. `None` where nothing varies.
    pub first_order: Option<f64>,
}

impl Influence {
    /// Of runs with a value of the key and what they come to; `values` are numbers of classes where `ordered` is false.
    pub fn of(values: &[f64], ordered: bool, came_to: &[f64]) -> Self {
        let n = values.len().min(came_to.len());
        if n < LEAST_RUNS {
            return Self {
                rank_correlation: None,
                first_order: None,
            };
        }
        let (x, y) = (ranks(&values[..n]), ranks(&came_to[..n]));
        Self {
            rank_correlation: ordered.then(|| correlation(&x, &y)).flatten(),
            first_order: first_order(&bins(&x), &y),
        }
    }
}

/// Ranks from 0, the mean of them where values are equal.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut from = 0;
    for equal in order.chunk_by(|a, b| values[*a].total_cmp(&values[*b]).is_eq()) {
        let mean = from as f64 + 0.5 * (equal.len() - 1) as f64;
        equal.iter().for_each(|i| ranks[*i] = mean);
        from += equal.len();
    }
    ranks
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    values.sum::<f64>() / n
}

fn correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    let (mean_x, mean_y) = (mean(x.iter().copied()), mean(y.iter().copied()));
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        (x.iter().zip(y))
            .map(|(x, y)| of(x - mean_x, y - mean_y))
            .sum()
    };
    let scale = (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt();
    (scale > 0.0).then(|| sum(&|x, y| x * y) / scale)
}

/// A bin of each run: that of its value where there are few, else one of as many runs as the others have.
fn bins(ranks: &[f64]) -> Vec<usize> {
    let mut distinct = ranks.to_vec();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    let most = (ranks.len() / LEAST_IN_BIN).clamp(2, MOST_BINS);
    if distinct.len() <= most {
        let place = |rank: &f64| distinct.partition_point(|d| d < rank);
        return ranks.iter().map(place).collect();
    }
    let width = ranks.len() as f64 / most as f64;
    ranks
        .iter()
        .map(|rank| ((rank / width) as usize).min(most - 1))
        .collect()
}

/// What is left of the share of variance between bins when its expectation under chance is taken away (Kelley's ε²), 0 at least.
fn first_order(bins: &[usize], y: &[f64]) -> Option<f64> {
    let mut sums = vec![(0.0, 0.0); bins.iter().max()? + 1];
    for (bin, y) in bins.iter().zip(y) {
        let (n, sum) = &mut sums[*bin];
        *n += 1.0;
        *sum += y;
    }
    let all = mean(y.iter().copied());
    let filled = sums.iter().filter(|(n, _)| *n > 0.0).count() as f64;
    let within: f64 = (bins.iter().zip(y))
        .map(|(bin, y)| {
            let (n, sum) = sums[*bin];
            (y - sum / n).powi(2)
        })
        .sum();
    let total: f64 = y.iter().map(|y| (y - all).powi(2)).sum();
    let n = y.len() as f64;
    let share = 1.0 - within / (n - filled) * (n - 1.0) / total;
    (total > 0.0 && n > filled && filled > 1.0).then(|| share.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::design::Points;

    /// Shares of keys by independent draws, a column a key.
    fn drawn(runs: u64, keys: usize) -> Vec<Vec<f64>> {
        let points = Points::monte_carlo(runs, keys, 4);
        let all: Vec<Vec<f64>> = (0..runs).map(|run| points.at(run).shares).collect();
        (0..keys)
            .map(|key| all.iter().map(|of| of[key]).collect())
            .collect()
    }

    #[test]
    fn a_key_that_decides_has_all_of_it_and_one_that_does_not_none() {
        let keys = drawn(4000, 3);
        let rising: Vec<f64> = keys[0].iter().map(|x| x.exp()).collect();
        let [own, other] = [0, 1].map(|key| Influence::of(&keys[key], true, &rising));
        assert!((own.rank_correlation.unwrap() - 1.0).abs() < 1e-12);
        assert!(own.first_order.unwrap() > 0.99, "{own:?}");
        assert!(other.rank_correlation.unwrap().abs() < 0.05);
        assert!(other.first_order.unwrap() < 0.01, "{other:?}");
        // Neither up nor down, and yet decisive.
        let valley: Vec<f64> = keys[0].iter().map(|x| (x - 0.5).powi(2)).collect();
        let own = Influence::of(&keys[0], true, &valley);
        assert!(own.rank_correlation.unwrap().abs() < 0.05);
        assert!(own.first_order.unwrap() > 0.97, "{own:?}");
    }

    /// Where three keys add up with weights 2, 1 and 0, the shares are 4/5, 1/5 and nothing; of ranks a little else.
    #[test]
    fn shares_of_a_sum_are_those_of_its_variances() {
        let keys = drawn(8000, 3);
        let sum: Vec<f64> = (0..8000).map(|i| 2.0 * keys[0][i] + keys[1][i]).collect();
        let shares =
            [0, 1, 2].map(|key| Influence::of(&keys[key], true, &sum).first_order.unwrap());
        let close = |i: usize, to: f64| (shares[i] - to).abs() < 0.03;
        assert!(
            close(0, 0.8) && close(1, 0.2) && close(2, 0.0),
            "{shares:?}"
        );
    }

    #[test]
    fn few_values_are_classes_and_few_runs_are_none() {
        let class: Vec<f64> = (0..100).map(|i| f64::from(i % 4)).collect();
        let came_to: Vec<f64> = class
            .iter()
            .map(|c| f64::from(u8::from(*c == 2.0)))
            .collect();
        let of = Influence::of(&class, false, &came_to);
        assert_eq!((of.rank_correlation, of.first_order), (None, Some(1.0)));
        let nothing = Influence::of(&class, true, &[1.0; 100]);
        assert_eq!(
            (nothing.rank_correlation, nothing.first_order),
            (None, None)
        );
        assert!(
            Influence::of(&class[..10], true, &came_to)
                .first_order
                .is_none()
        );
        assert_eq!(ranks(&[3.0, 1.0, 1.0, 7.0]), [2.0, 0.5, 0.5, 3.0]);
    }
}
