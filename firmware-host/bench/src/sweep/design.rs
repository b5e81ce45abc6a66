//! Designs: where in the unit cube of what varies each run lies.

use crate::sweep::permutation::{Permutation, mixed};
use crate::sweep::sobol::coordinate;
use crate::words::words;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

words! {
    /// How runs are spread.
    pub enum Design {
        /// Every combination of listed values, the last key fastest.
        Grid = "grid",
        /// Of each key, one value from each of as many strata as there are runs.
        LatinHypercube = "latin_hypercube",
        /// A scrambled Sobol sequence.
        Sobol = "sobol",
        /// Independent draws.
        MonteCarlo = "monte_carlo",
    }
}

impl Design {
    /// Its word.
    pub fn name(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

/// Most runs of a sweep: so many strata a key still have numbers between them.
pub(crate) const MOST_RUNS: u64 = 100_000_000;

/// The runs of a sweep by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    keys: usize,
    runs: u64,
    seed: u64,
    scheme: Scheme,
}

/// What is kept of each design.
#[derive(Debug, Clone, PartialEq)]
enum Scheme {
    /// Values of each key, and runs of each combination.
    Grid {
        levels: Vec<u64>,
        repeats: u64,
    },
    /// Strata of each key.
    LatinHypercube(Vec<Permutation>),
    Sobol,
    MonteCarlo,
}

/// A run's place and seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Of each key, the share of its distribution that lies below its value: from 0 to 1, and neither.
    pub shares: Vec<f64>,
    /// Seed of the run: what is random within it.
    pub seed: u64,
}

impl Points {
    /// A grid of keys with so many values each, every combination so many times.
    pub fn grid(levels: Vec<u64>, repeats: u64, seed: u64) -> Self {
        let combinations = levels.iter().fold(1_u64, |n, of| n.saturating_mul(*of));
        Self {
            keys: levels.len(),
            runs: combinations.saturating_mul(repeats),
            seed,
            scheme: Scheme::Grid { levels, repeats },
        }
    }

    /// One run from each of as many strata of each key as there are runs.
    pub(crate) fn latin_hypercube(runs: u64, keys: usize, seed: u64) -> Self {
        let strata = |key: usize| Permutation::new(runs, mixed(seed) ^ mixed(key as u64));
        Self {
            keys,
            runs,
            seed,
            scheme: Scheme::LatinHypercube((0..keys).map(strata).collect()),
        }
    }

    /// So many points of a Sobol sequence, at most `SOBOL_POINTS`.
    pub fn sobol(runs: u64, keys: usize, seed: u64) -> Self {
        Self {
            keys,
            runs,
            seed,
            scheme: Scheme::Sobol,
        }
    }

    /// So many independent draws.
    pub fn monte_carlo(runs: u64, keys: usize, seed: u64) -> Self {
        Self {
            keys,
            runs,
            seed,
            scheme: Scheme::MonteCarlo,
        }
    }

    /// How many there are.
    pub fn runs(&self) -> u64 {
        self.runs
    }

    /// A run, from 0.
    pub fn at(&self, run: u64) -> Point {
        let keys = self.keys;
        let shares = match &self.scheme {
            Scheme::Grid { levels, repeats } => combination(run / repeats, levels),
            Scheme::Sobol => (0..keys)
                .map(|key| coordinate(run, key, self.seed))
                .collect(),
            Scheme::MonteCarlo => {
                let mut stream = self.drawing(run);
                (0..keys).map(|_| chance(&mut stream)).collect()
            }
            Scheme::LatinHypercube(strata) => {
                let mut stream = self.drawing(run);
                (strata.iter())
                    .map(|stratum| {
                        (stratum.at(run) as f64 + chance(&mut stream)) / self.runs as f64
                    })
                    .collect()
            }
        };
        let seed = seed(&mut self.stream(run));
        Point { shares, seed }
    }

    fn stream(&self, number: u64) -> ChaCha8Rng {
        let mut stream = ChaCha8Rng::seed_from_u64(self.seed);
        stream.set_stream(number);
        stream
    }

    /// The stream of a run behind its seed.
    fn drawing(&self, run: u64) -> ChaCha8Rng {
        let mut stream = self.stream(run);
        seed(&mut stream);
        stream
    }
}

/// A seed that floats hold, too: programs that read it may have no other numbers.
fn seed(stream: &mut ChaCha8Rng) -> u64 {
    stream.next_u64() >> 11
}

/// Within 0 and 1, and neither.
fn chance(stream: &mut ChaCha8Rng) -> f64 {
    (f64::from(stream.next_u32() >> 8) + 0.5) / f64::from(1 << 24)
}

/// The middles of the parts that each key's values have of the unit interval.
fn combination(number: u64, levels: &[u64]) -> Vec<f64> {
    let mut rest = number;
    let mut shares: Vec<f64> = (levels.iter().rev())
        .map(|levels| {
            let level = rest % levels;
            rest /= levels;
            (level as f64 + 0.5) / *levels as f64
        })
        .collect();
    shares.reverse();
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many points lie in each of so many slices of a key.
    fn slices(points: &Points, key: usize, slices: u64) -> Vec<u64> {
        let mut counts = vec![0; slices as usize];
        for run in 0..points.runs() {
            let share = points.at(run).shares[key];
            assert!(share > 0.0 && share < 1.0);
            counts[(share * slices as f64) as usize] += 1;
        }
        counts
    }

    #[test]
    fn a_latin_hypercube_has_one_run_in_each_stratum_of_each_key() {
        for runs in [1, 7, 100, 1009] {
            let points = Points::latin_hypercube(runs, 4, 5);
            for key in 0..4 {
                let counts = slices(&points, key, runs);
                assert!(counts.iter().all(|count| *count == 1), "{runs}, key {key}");
            }
        }
    }

    /// And what one key has says nothing of what another has: squares of a fifth by a fifth are filled as by chance.
    #[test]
    fn keys_of_a_latin_hypercube_are_paired_by_chance() {
        let points = Points::latin_hypercube(5000, 2, 1);
        let mut squares = [0_u32; 25];
        for run in 0..5000 {
            let shares = points.at(run).shares;
            squares[(shares[0] * 5.0) as usize * 5 + (shares[1] * 5.0) as usize] += 1;
        }
        // 200 each, give or take the square root.
        let apart = squares.iter().map(|n| n.abs_diff(200)).max();
        assert!(apart < Some(60) && apart > Some(5), "{squares:?}");
    }

    /// Of 2ᵏ points one lies in each slice, and of two keys one in each of the equal boxes that halvings make.
    #[test]
    fn a_sobol_sequence_fills_boxes_evenly() {
        for seed in [0, 1, 99] {
            let points = Points::sobol(256, 12, seed);
            for key in 0..12 {
                assert!(slices(&points, key, 256).iter().all(|count| *count == 1));
            }
            // The first two keys are a net in base 2 of quality 0.
            let mut boxes = [0; 256];
            for run in 0..256 {
                let shares = points.at(run).shares;
                boxes[(shares[0] * 16.0) as usize * 16 + (shares[1] * 16.0) as usize] += 1;
            }
            assert_eq!(boxes, [1; 256]);
        }
        let first = |seed| Points::sobol(4, 1, seed).at(0).shares;
        assert_ne!(first(1), first(2));
    }

    #[test]
    fn independent_draws_are_uniform_and_of_their_run_alone() {
        let points = Points::monte_carlo(10_000, 2, 3);
        for key in 0..2 {
            let counts = slices(&points, key, 10);
            assert!(counts.iter().all(|n| n.abs_diff(1000) < 150), "{counts:?}");
        }
        let more = Points::monte_carlo(20_000, 2, 3);
        assert_eq!(points.at(77), more.at(77));
        assert_ne!(points.at(77).seed, points.at(78).seed);
    }

    #[test]
    fn a_grid_has_every_combination_with_the_last_key_fastest() {
        let points = Points::grid(vec![2, 3], 2, 0);
        assert_eq!(points.runs(), 12);
        let levels = |run| {
            let shares = points.at(run).shares;
            ((shares[0] * 2.0) as u32, (shares[1] * 3.0) as u32)
        };
        let all: Vec<_> = (0..12).map(levels).collect();
        let once = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)];
        assert_eq!(all, once.map(|at| [at, at]).concat());
        // The same place, another seed.
        assert_ne!(points.at(0).seed, points.at(1).seed);
    }
}
