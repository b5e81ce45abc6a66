//! The cross-entropy method: a search without derivatives for many variables. Candidates are drawn from a
//! normal distribution, and the distribution moves to where the best of them are.

use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};

/// How hard is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Candidates of a generation.
    pub candidates: usize,
    /// The best of them, which the distribution moves to.
    pub best: usize,
    /// Generations at most.
    pub generations: usize,
    /// Standard deviation of each variable at first.
    pub spread: f64,
    /// And at least: what keeps the search from standing still.
    pub least_spread: f64,
}

/// Share of the way that the distribution's middle and width go towards the best of a generation. The width
/// goes more slowly: few of many candidates say little of it.
const MIDDLE_RATE: f64 = 0.7;
const SPREAD_RATE: f64 = 0.3;

/// Looks for the variables with the highest score, and returns them with it. `enough` ends the search early,
/// asked after each generation with the scores from the highest down. Scores are compared and not calculated
/// with: only their order matters. The same seed finds the same, on any number of threads.
///
/// # Errors
/// Those of the score.
pub fn maximise<E: Send>(
    start: &[f64],
    (effort, seed): (Effort, u64),
    score: &(dyn Fn(&[f64]) -> Result<f64, E> + Sync),
    enough: &dyn Fn(&[f64]) -> bool,
) -> Result<(f64, Vec<f64>), E> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut middle = start.to_vec();
    let mut spread = vec![effort.spread; start.len()];
    let mut found = (f64::NEG_INFINITY, start.to_vec());
    for _ in 0..effort.generations {
        // The middle of the distribution and the best so far take part as they are.
        let mut all = vec![middle.clone(), found.1.clone()];
        while all.len() < effort.candidates {
            let drawn = middle.iter().zip(&spread).map(|(m, s)| {
                let n: f64 = StandardNormal.sample(&mut random);
                m + s * n
            });
            all.push(drawn.collect());
        }
        let scores = all
            .par_iter()
            .map(|x| score(x))
            .collect::<Result<Vec<f64>, E>>()?;
        let mut rated: Vec<(f64, Vec<f64>)> = scores.into_iter().zip(all).collect();
        // Stable: equals keep the order in which they were drawn.
        rated.sort_by(|a, b| b.0.total_cmp(&a.0));
        let Some(first) = rated.first() else {
            break;
        };
        if first.0 > found.0 {
            found = first.clone();
        }
        let scores: Vec<f64> = rated.iter().map(|(score, _)| *score).collect();
        if enough(&scores) {
            break;
        }
        let best = rated.get(..effort.best).unwrap_or(&rated);
        let count = best.len() as f64;
        for (i, (m, s)) in middle.iter_mut().zip(&mut spread).enumerate() {
            let mean = best.iter().map(|(_, x)| x[i]).sum::<f64>() / count;
            let square = best.iter().map(|(_, x)| (x[i] - mean).powi(2)).sum::<f64>() / count;
            *m += MIDDLE_RATE * (mean - *m);
            *s += SPREAD_RATE * (square.sqrt() - *s);
            *s = s.max(effort.least_spread);
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EFFORT: Effort = Effort {
        candidates: 100,
        best: 10,
        generations: 200,
        spread: 1.0,
        least_spread: 1e-6,
    };

    /// The top of a stretched hill in twenty variables, from a start beside it.
    #[test]
    fn finds_the_top_of_a_hill() {
        let score = |x: &[f64]| -> Result<f64, ()> {
            let distance = |(i, x): (usize, &f64)| (1.0 + i as f64) * (x - 0.1 * i as f64).powi(2);
            Ok(-x.iter().enumerate().map(distance).sum::<f64>())
        };
        let (best, x) = maximise(&[2.0; 20], (EFFORT, 1), &score, &|_| false).unwrap();
        assert!(best > -1e-4, "{best}");
        assert!((x[10] - 1.0).abs() < 1e-2);
    }

    /// Up an endless slope, as far as the least spread carries it.
    #[test]
    fn ends_when_told_and_passes_errors_on() {
        let effort = Effort {
            least_spread: 0.5,
            ..EFFORT
        };
        let score = |x: &[f64]| if x[0] > 9.0 { Err("far") } else { Ok(x[0]) };
        let (best, _) = maximise(&[0.0], (effort, 1), &score, &|s| s[0] > 2.0).unwrap();
        assert!(best > 2.0 && best < 9.0);
        let far = maximise(&[0.0], (effort, 1), &score, &|_| false);
        assert_eq!(far, Err("far"));
    }
}
