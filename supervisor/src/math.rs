//! Arithmetic of the coefficients: total, panic-free, the same bits on every target.

use crate::scalar::Scalar;

/// Square root; 0 for negative values and NaN.
pub(crate) fn sqrt(x: f32) -> f32 {
    Scalar::sqrt(x)
}

/// The larger of two finite numbers.
pub(crate) fn max(a: f32, b: f32) -> f32 {
    Scalar::max(a, b)
}

/// The smaller of two finite numbers.
pub(crate) fn min(a: f32, b: f32) -> f32 {
    Scalar::min(a, b)
}

/// exp(−x) for x ≥ 0, to 1e-6: a Padé approximant near zero, squared back up.
pub(crate) fn exp_neg(x: f32) -> f32 {
    let x = Scalar::clamp(x, 0.0, 80.0);
    let mut small = x;
    let mut halvings = 0_u32;
    while small > 0.125 {
        small *= 0.5;
        halvings += 1;
    }
    let square = small * small / 12.0;
    let mut y = (1.0 - 0.5 * small + square) / (1.0 + 0.5 * small + square);
    for _ in 0..halvings {
        y *= y;
    }
    y
}

/// Order of the filter that estimates the speed: second in flight, first in contact.
#[derive(Clone, Copy)]
pub(crate) enum Order {
    First,
    Second,
}

/// Known variance of a critically damped fading-memory filter: speed over position noise per tick, squared.
pub(crate) const fn gain_square(p: f32, order: Order) -> f32 {
    let (fading, memory) = (1.0 - p, 1.0 + p);
    let ratio = fading / memory;
    let cube = ratio * ratio * ratio;
    match order {
        Order::First => 2.0 * cube,
        Order::Second => cube / (memory * memory) * (13.0 + 50.0 * p + 49.0 * p * p) / 2.0,
    }
}
