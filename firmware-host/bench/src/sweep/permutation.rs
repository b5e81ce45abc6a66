//! A permutation of 0, 1, … n − 1 that is computed for one number at a time.

/// Rounds of the network, and bits of its halves: with fewer, some orders of a few numbers come up more often than others.
const ROUNDS: usize = 8;
const LEAST_HALF_BITS: u32 = 4;

/// A seeded permutation: a Feistel network over the next power of four, 256 at least, followed until it falls below n. It keeps nothing, so
/// that n may be as large as it likes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Permutation {
    n: u64,
    half_bits: u32,
    keys: [u64; ROUNDS],
}

impl Permutation {
    /// Of n numbers, at most 2⁶²; a permutation of its own for each seed, as far as there are so many.
    pub(crate) fn new(n: u64, seed: u64) -> Self {
        let bits = u64::BITS - n.saturating_sub(1).leading_zeros();
        let mut keys = [0; ROUNDS];
        for (round, key) in keys.iter_mut().enumerate() {
            *key = mixed(seed ^ mixed(round as u64 + 1));
        }
        Self {
            n,
            half_bits: bits.div_ceil(2).max(LEAST_HALF_BITS),
            keys,
        }
    }

    /// Where `i` < n goes.
    pub(crate) fn at(&self, i: u64) -> u64 {
        let mut x = i;
        loop {
            x = self.network(x);
            // A walk along a cycle that `i` itself is on: it ends.
            if x < self.n {
                return x;
            }
        }
    }

    fn network(&self, x: u64) -> u64 {
        let mask = (1 << self.half_bits) - 1;
        let (mut left, mut right) = (x >> self.half_bits, x & mask);
        for key in self.keys {
            (left, right) = (right, left ^ (mixed(right ^ key) & mask));
        }
        left << self.half_bits | right
    }
}

/// The finaliser of SplitMix64: every bit of the result hangs on every bit of `x`.
pub(crate) fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_comes_once() {
        for n in [1, 2, 3, 4, 5, 16, 17, 1000, 4097] {
            for seed in 0..3 {
                let permutation = Permutation::new(n, seed);
                let mut all: Vec<u64> = (0..n).map(|i| permutation.at(i)).collect();
                all.sort_unstable();
                assert!(all.into_iter().eq(0..n), "{n}, {seed}");
            }
        }
    }

    /// Of 5 numbers there are 120 orders: each comes up as often as it would by chance.
    #[test]
    fn no_order_is_preferred() {
        let mut counts = std::collections::BTreeMap::new();
        let draws = 24_000;
        for seed in 0..draws {
            let permutation = Permutation::new(5, seed);
            let order: Vec<u64> = (0..5).map(|i| permutation.at(i)).collect();
            *counts.entry(order).or_insert(0_u32) += 1;
        }
        assert_eq!(counts.len(), 120);
        let expected = draws as f64 / 120.0;
        let chi_squared: f64 = (counts.values())
            .map(|count| (f64::from(*count) - expected).powi(2) / expected)
            .sum();
        // 119 degrees of freedom: 119 ± 15.4, and 4.5 of those are more than any seed may ask for.
        assert!((50.0..190.0).contains(&chi_squared), "{chi_squared}");
    }
}
