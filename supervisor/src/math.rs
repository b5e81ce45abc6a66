//! Arithmetic that is total, panic-free and the same bits on every target: + − × ÷, comparisons, and
//! what is built from them here.

/// Square root; 0 for zero, negative values and NaN.
///
/// The seed is micromath's (6 % off); three Newton steps on the reciprocal root bring it to a few units
/// in the last place. Only + − × are used, so every target gives the same bits; `core` has no root,
/// and libm's costs three times as many instructions where there is an FPU.
#[inline]
pub(crate) fn sqrt(x: f32) -> f32 {
    // Below this the reciprocal root's square leaves the range of f32.
    if !(x > 1e-30 && x < 1e30) {
        return if x >= 1e30 { 1e15 } else { 0.0 };
    }
    let mut y = micromath::F32(x).invsqrt().0;
    let half = 0.5 * x;
    y *= 1.5 - half * y * y;
    y *= 1.5 - half * y * y;
    y *= 1.5 - half * y * y;
    x * y
}

/// `x` held between `low` and `high` (`low` ≤ `high`); NaN becomes `low`. `f32::clamp` can panic.
#[inline]
pub(crate) fn between(x: f32, low: f32, high: f32) -> f32 {
    if x > high {
        high
    } else if x >= low {
        x
    } else {
        low
    }
}

/// The larger of two finite numbers.
#[inline]
pub(crate) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two finite numbers.
#[inline]
pub(crate) fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// A sum that keeps what rounding would take from it: a slow state would stand still without.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    pub(crate) value: f32,
    rest: f32,
}

impl Sum {
    #[inline]
    pub(crate) fn add(&mut self, x: f32) {
        self.rest += x;
        let sum = self.value + self.rest;
        self.rest -= sum - self.value;
        self.value = sum;
    }
}

/// exp(−x) for x ≥ 0, to 1e-6: a Padé approximant near zero, squared back up.
pub(crate) fn exp_neg(x: f32) -> f32 {
    let x = between(x, 0.0, 80.0);
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
