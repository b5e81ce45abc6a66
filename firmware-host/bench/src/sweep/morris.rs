//! Morris's design and its elementary effects: few runs that tell keys which matter from keys which do not.
//!
//! A trajectory begins anywhere and moves one key after the other, in an order of its own, by half of the key's distribution.
//! What each move changes, over how far it went, is an elementary effect. M. D. Morris (1991), *Factorial sampling plans for
//! preliminary computational experiments*, Technometrics 33; the mean of magnitudes by Campolongo et al. (2007).

use rand_core::Rng;
use serde::Serialize;

/// How far a key moves, as a share of its distribution. With an even number of levels each has exactly one other so far away,
/// so that all are as likely.
const STEP: f64 = 0.5;
/// Fewer effects say nothing.
const LEAST_EFFECTS: usize = 4;
/// Standard errors on either side that hold 95 %.
const NORMAL_95: f64 = 1.96;

/// Runs of a trajectory.
pub fn trajectory_runs(keys: usize) -> u64 {
    keys as u64 + 1
}

/// A trajectory.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Trajectory {
    /// Where each key begins.
    begin: Vec<u64>,
    /// The keys in the order in which they move.
    order: Vec<usize>,
}

impl Trajectory {
    fn drawn(keys: usize, levels: u64, chance: &mut impl Rng) -> Self {
        // Far more numbers than levels or keys: none is likelier by more than 2⁻³².
        let mut below = |n: u64| ((u128::from(chance.next_u64()) * u128::from(n)) >> 64) as u64;
        let begin = (0..keys).map(|_| below(levels)).collect();
        let mut order: Vec<usize> = (0..keys).collect();
        for i in (1..keys).rev() {
            order.swap(i, below(i as u64 + 1) as usize);
        }
        Self { begin, order }
    }

    /// Level of a key after so many moves.
    fn level(&self, key: usize, moves: usize, levels: u64) -> u64 {
        let moved = self.order.iter().take(moves).any(|of| *of == key);
        (self.begin[key] + if moved { levels / 2 } else { 0 }) % levels
    }
}

/// Where a run of a trajectory lies in the unit cube, by the numbers of its trajectory.
pub(crate) fn point(moves: u64, keys: usize, levels: u64, chance: &mut impl Rng) -> Vec<f64> {
    let trajectory = Trajectory::drawn(keys, levels, chance);
    let level = |key| trajectory.level(key, moves as usize, levels);
    (0..keys)
        // Middles of equal parts: no end of a distribution is asked for, which may be far out.
        .map(|key| (level(key) as f64 + 0.5) / levels as f64)
        .collect()
}

/// Elementary effects of a key: changes of the result for the whole of the key's distribution, if all of it did what the half
/// did that the key moved by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MorrisEffect {
    /// Mean of their magnitudes, μ*: how much the key matters.
    pub mean_magnitude: f64,
    /// Half the width of an interval of 95 % of that mean.
    pub mean_magnitude_error: f64,
    /// Their mean, μ: the direction. Much smaller than that of magnitudes where the result rises here and falls there.
    pub mean: f64,
    /// Their standard deviation, σ: 0 where the key does the same everywhere, whatever the others are.
    pub standard_deviation: f64,
    /// How many there are.
    pub effects: u64,
}

/// Effects of each key from what the runs came to, trajectory by trajectory, and where they lie; `shares` gives the place of a
/// run. A move from or to a run that came to nothing (not a number) is left out. `None` where no result differs from another,
/// or too few moves are whole.
pub fn effects(
    came_to: &[f64],
    keys: usize,
    shares: impl Fn(u64) -> Vec<f64>,
) -> Option<Vec<MorrisEffect>> {
    let mut all: Vec<Vec<f64>> = vec![Vec::new(); keys];
    let size = trajectory_runs(keys) as usize;
    for (i, trajectory) in came_to.chunks_exact(size).enumerate() {
        let mut before = shares((i * size) as u64);
        for (moves, pair) in trajectory.windows(2).enumerate() {
            let after = shares((i * size + moves + 1) as u64);
            let moved = (0..keys).find(|key| before[*key] != after[*key]);
            let effect = (pair[1] - pair[0]) / STEP;
            if let (Some(key), true) = (moved, effect.is_finite()) {
                all[key].push(effect * (after[key] - before[key]).signum());
            }
            before = after;
        }
    }
    let varies = all.iter().flatten().any(|effect| *effect != 0.0);
    let enough = all.iter().all(|effects| effects.len() >= LEAST_EFFECTS);
    (varies && enough).then(|| all.iter().map(|effects| of(effects)).collect())
}

fn of(effects: &[f64]) -> MorrisEffect {
    let (mean, standard_deviation) = mean_and_deviation(effects.iter().copied());
    let (mean_magnitude, deviation) = mean_and_deviation(effects.iter().map(|x| x.abs()));
    MorrisEffect {
        mean_magnitude,
        mean_magnitude_error: NORMAL_95 * deviation / (effects.len() as f64).sqrt(),
        mean,
        standard_deviation,
        effects: effects.len() as u64,
    }
}

fn mean_and_deviation(values: impl ExactSizeIterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let squares: f64 = values.map(|x| (x - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_core::SeedableRng;

    const LEVELS: u64 = 4;

    fn place(run: u64, keys: usize) -> Vec<f64> {
        let trajectory = run / trajectory_runs(keys);
        let mut chance = ChaCha8Rng::seed_from_u64(3);
        chance.set_stream(trajectory);
        point(run % trajectory_runs(keys), keys, LEVELS, &mut chance)
    }

    fn of_function(trajectories: u64, keys: usize, f: impl Fn(&[f64]) -> f64) -> Vec<MorrisEffect> {
        let runs = trajectories * trajectory_runs(keys);
        let came_to: Vec<f64> = (0..runs).map(|run| f(&place(run, keys))).collect();
        effects(&came_to, keys, |run| place(run, keys)).unwrap()
    }

    /// Every move of a linear function has the same effect: its coefficient.
    #[test]
    fn effects_of_a_linear_function_are_its_coefficients() {
        let weights = [3.0, -2.0, 0.5, 0.0, 10.0];
        let linear = |x: &[f64]| x.iter().zip(weights).map(|(x, w)| w * x).sum::<f64>();
        for (found, weight) in of_function(10, 5, linear).iter().zip(weights) {
            assert!((found.mean - weight).abs() < 1e-12, "{found:?}");
            assert!((found.mean_magnitude - weight.abs()).abs() < 1e-12);
            assert!(found.standard_deviation < 1e-12 && found.mean_magnitude_error < 1e-12);
            assert_eq!(found.effects, 10);
        }
    }

    /// Of x·y the effect of x is y: a half on average, spread as the levels 1/8, 3/8, 5/8 and 7/8 are.
    #[test]
    fn keys_that_work_together_are_told_by_the_deviation() {
        let found = of_function(4000, 3, |x| x[0] * x[1]);
        let spread = (f64::from(LEVELS as u32 * LEVELS as u32 - 1) / 12.0).sqrt() / LEVELS as f64;
        for of in &found[..2] {
            assert!((of.mean - 0.5).abs() < 0.02, "{of:?}");
            assert!((of.standard_deviation - spread).abs() < 0.01, "{of:?}");
        }
        assert_eq!(
            (found[2].mean_magnitude, found[2].standard_deviation),
            (0.0, 0.0)
        );
        // Up and down alike: no direction, and yet an influence.
        let found = of_function(4000, 2, |x| (x[0] - 0.5) * (x[1] - 0.5).signum());
        assert!(found[0].mean.abs() < 0.05 && (found[0].mean_magnitude - 1.0).abs() < 1e-12);
    }

    /// One key a move, each once a trajectory, by half; and every level as likely.
    #[test]
    fn trajectories_move_each_key_once() {
        let keys = 5;
        let mut counts = vec![[0_u32; LEVELS as usize]; keys];
        let mut first = vec![0_u32; keys];
        for trajectory in 0..2000 {
            let places: Vec<Vec<f64>> = (0..trajectory_runs(keys))
                .map(|run| place(trajectory * trajectory_runs(keys) + run, keys))
                .collect();
            let mut moved: Vec<usize> = Vec::new();
            for pair in places.windows(2) {
                let there: Vec<usize> = (0..keys)
                    .filter(|key| pair[0][*key] != pair[1][*key])
                    .collect();
                assert!(there.len() == 1 && (pair[0][there[0]] - pair[1][there[0]]).abs() == STEP);
                moved.push(there[0]);
            }
            first[moved[0]] += 1;
            moved.sort_unstable();
            assert!(moved.into_iter().eq(0..keys));
            for (count, share) in counts.iter_mut().zip(&places[0]) {
                count[(share * LEVELS as f64) as usize] += 1;
            }
        }
        let even = |count: &u32, of: u32| count.abs_diff(of) < 100;
        assert!(
            counts.iter().flatten().all(|count| even(count, 500)),
            "{counts:?}"
        );
        assert!(first.iter().all(|count| even(count, 400)), "{first:?}");
    }

    #[test]
    fn moves_that_came_to_nothing_are_left_out() {
        let mut came_to: Vec<f64> = (0..10 * trajectory_runs(2))
            .map(|run| place(run, 2)[0])
            .collect();
        came_to[0] = f64::NAN;
        let found = effects(&came_to, 2, |run| place(run, 2)).unwrap();
        assert_eq!(found.iter().map(|of| of.effects).sum::<u64>(), 19);
        assert_eq!(effects(&came_to[..6], 2, |run| place(run, 2)), None);
        assert_eq!(effects(&[2.0; 30], 2, |run| place(run, 2)), None);
    }
}
