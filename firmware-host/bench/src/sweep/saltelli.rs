//! Saltelli's design and the indices that it is made for: how much of the variance of a result each key accounts for, alone
//! (first order) and with all that it does together with others (total order).
//!
//! A sample is a block of runs: A and B, drawn independently, and for each key A with that key's value of B. Estimators: first
//! order by Saltelli et al. (2010), *Variance based sensitivity analysis of model output*, Computer Physics Communications 181,
//! table 2 (b); total order by Jansen (1999), (f) there.

use crate::sweep::sobol::coordinate;
use serde::Serialize;

/// Fewer whole blocks say nothing.
const LEAST_BLOCKS: usize = 8;
/// Standard errors on either side that hold 95 %.
const NORMAL_95: f64 = 1.96;

/// Runs of a block: A, A with one key of B for each key, B.
pub fn block_runs(keys: usize) -> u64 {
    keys as u64 + 2
}

/// Whether a run is an A or a B: those are independent of each other.
pub(crate) fn is_independent(run: u64, keys: usize) -> bool {
    let member = run % block_runs(keys);
    member == 0 || member == keys as u64 + 1
}

/// Where a run lies in the unit cube, and the number that its seed follows from. All runs of a block but B share what is
/// random within a run, as if that were one more key: otherwise chance would count as influence of every key.
pub(crate) fn point(run: u64, keys: usize, seed: u64) -> (Vec<f64>, u64) {
    let (sample, member) = (run / block_runs(keys), run % block_runs(keys));
    let is_b = member == keys as u64 + 1;
    let shares = (0..keys)
        .map(|key| {
            let of_b = is_b || member == key as u64 + 1;
            coordinate(sample, if of_b { keys + key } else { key }, seed)
        })
        .collect();
    (shares, 2 * sample + u64::from(is_b))
}

/// What a key accounts for, as shares of the variance; the errors are half the width of an interval of 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SobolIndex {
    /// What would go away on average if the key were known. By chance it comes out a little below 0 where there is nothing.
    pub first_order: f64,
    /// Of the first order.
    pub first_order_error: f64,
    /// What would be left on average if all but the key were known: its part in everything.
    pub total_order: f64,
    /// Of the total order.
    pub total_order_error: f64,
}

/// Indices of each key from what the runs came to, block by block. A block with a run that came to nothing (not a number) is
/// left out. `None` where nothing varies, or too few blocks are whole; and how many are.
pub fn indices(came_to: &[f64], keys: usize) -> (Option<Vec<SobolIndex>>, u64) {
    let all = came_to.chunks_exact(block_runs(keys) as usize);
    let blocks: Vec<&[f64]> = all
        .filter(|block| block.iter().all(|y| y.is_finite()))
        .collect();
    let n = blocks.len() as f64;
    let (a, b) = (0, keys + 1);
    let mean = blocks.iter().map(|y| y[a] + y[b]).sum::<f64>() / (2.0 * n);
    let variances: Vec<f64> = (blocks.iter())
        .map(|y| ((y[a] - mean).powi(2) + (y[b] - mean).powi(2)) / 2.0)
        .collect();
    let variance = variances.iter().sum::<f64>() / n;
    let enough = blocks.len() >= LEAST_BLOCKS && variance > 0.0;
    // A ratio of two means, with the error that it has to first order.
    let ratio = |part: &dyn Fn(&[f64]) -> f64| {
        let parts: Vec<f64> = blocks.iter().map(|y| part(y)).collect();
        let share = parts.iter().sum::<f64>() / n / variance;
        let off = (parts.iter().zip(&variances))
            .map(|(part, of)| ((part - share * of) / variance).powi(2));
        (share, NORMAL_95 * off.sum::<f64>().sqrt() / n)
    };
    let of_key = |key: usize| {
        let with = key + 1;
        let (first_order, first_order_error) = ratio(&|y| (y[b] - mean) * (y[with] - y[a]));
        let (total_order, total_order_error) = ratio(&|y| (y[a] - y[with]).powi(2) / 2.0);
        SobolIndex {
            first_order,
            first_order_error,
            total_order,
            total_order_error,
        }
    };
    let indices = enough.then(|| (0..keys).map(of_key).collect());
    (indices, blocks.len() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// The function of Ishigami and Homma (1990), with the constants that its indices are commonly given for.
    fn ishigami(shares: &[f64]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|i| PI * (2.0 * shares[i] - 1.0));
        x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
    }

    /// Its indices in closed form.
    fn exact() -> [(f64, f64); 3] {
        let (a, b) = (7.0_f64, 0.1);
        let first = [(1.0 + b * PI.powi(4) / 5.0).powi(2) / 2.0, a * a / 8.0, 0.0];
        let together = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let variance = first[0] + first[1] + together;
        [0, 1, 2].map(|key| {
            let total = first[key] + if key == 1 { 0.0 } else { together };
            (first[key] / variance, total / variance)
        })
    }

    fn of(samples: u64, seed: u64, f: impl Fn(&[f64]) -> f64) -> Vec<SobolIndex> {
        let runs = samples * block_runs(3);
        let came_to: Vec<f64> = (0..runs).map(|run| f(&point(run, 3, seed).0)).collect();
        let (indices, whole) = indices(&came_to, 3);
        assert_eq!(whole, samples);
        indices.unwrap()
    }

    #[test]
    fn indices_of_a_known_function_come_out() {
        // As printed in textbooks.
        let printed = [(0.3139, 0.5576), (0.4424, 0.4424), (0.0, 0.2437)];
        for ((first, total), printed) in exact().into_iter().zip(printed) {
            assert!((first - printed.0).abs() < 5e-5 && (total - printed.1).abs() < 5e-5);
        }
        for seed in [0, 1, 2] {
            for (found, (first, total)) in of(8192, seed, ishigami).iter().zip(exact()) {
                assert!((found.first_order - first).abs() < 0.01, "{found:?}");
                assert!((found.total_order - total).abs() < 0.01, "{found:?}");
            }
        }
    }

    /// Intervals of 95 % hold the exact value in some 95 of 100 sweeps of 256 samples, and are no wider than that asks for.
    #[test]
    fn intervals_hold_what_they_say() {
        let sweeps = 200;
        let mut missed = 0;
        let (mut wide, mut off) = (0.0, 0.0);
        for seed in 0..sweeps {
            for (found, (first, total)) in of(256, seed, ishigami).iter().zip(exact()) {
                let apart = [found.first_order - first, found.total_order - total];
                let errors = [found.first_order_error, found.total_order_error];
                for (apart, error) in apart.into_iter().zip(errors) {
                    missed += u32::from(apart.abs() > error);
                    wide += error;
                    off += apart.abs();
                }
            }
        }
        let share = f64::from(missed) / (6.0 * sweeps as f64);
        assert!(share < 0.07, "{share} missed");
        assert!(
            wide < 8.0 * off,
            "{} times as wide as it is off",
            wide / off
        );
    }

    /// What is random within a run is no influence of a key, and a key that does nothing has none.
    #[test]
    fn chance_is_no_key() {
        let noisy = |run: u64| {
            let (shares, seed) = point(run, 2, 5);
            let noise = f64::from((crate::sweep::permutation::mixed(seed) >> 40) as u32)
                / f64::from(1 << 24);
            shares[0] + noise
        };
        let came_to: Vec<f64> = (0..4096 * block_runs(2)).map(noisy).collect();
        let found = indices(&came_to, 2).0.unwrap();
        // Half of the variance each.
        assert!((found[0].first_order - 0.5).abs() < 0.03, "{found:?}");
        assert!((found[0].total_order - 0.5).abs() < 0.03, "{found:?}");
        assert!(found[1].first_order.abs() < 0.03 && found[1].total_order == 0.0);
    }

    #[test]
    fn blocks_that_are_not_whole_are_left_out() {
        let mut came_to: Vec<f64> = (0..20 * block_runs(2))
            .map(|run| point(run, 2, 1).0[0])
            .collect();
        came_to[5] = f64::NAN;
        came_to[4 * 7 + 3] = f64::INFINITY;
        let (found, whole) = indices(&came_to, 2);
        assert!(whole == 18 && found.is_some());
        assert_eq!(indices(&came_to[..4 * 4], 2).0, None);
        assert_eq!(indices(&[1.0; 4 * 20], 2), (None, 20));
    }
}
