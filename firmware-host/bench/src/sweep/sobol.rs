//! A Sobol sequence with Owen's scrambling, any of its points by its number.

use crate::sweep::permutation::mixed;

/// Points that it has.
pub(crate) const SOBOL_POINTS: u64 = 1 << 16;
/// Dimensions that it has.
pub(crate) const SOBOL_DIMENSIONS: usize = 256;

/// A coordinate of a point, within 0 and 1 and neither.
pub(crate) fn coordinate(point: u64, dimension: usize, seed: u64) -> f64 {
    let share = sobol_burley::sample(point as u32, dimension as u32, mixed(seed) as u32);
    // Shares are multiples of 2⁻²⁴, 0 among them.
    f64::from(share) + 0.5 / f64::from(1 << 24)
}
