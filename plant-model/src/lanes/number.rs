//! Numbers of several runs side by side.
//!
//! Plain arrays: what adds and multiplies them is compiled once for each set of instructions (`kernel.rs`), into as many vector
//! registers as that takes. Products and sums are never fused and every lane stands alone, so that a run has the same bits
//! whatever the machine and whatever runs beside it.

#![expect(
    clippy::needless_range_loop,
    reason = "a lane has its place in several arrays"
)]

use std::f64::consts::LN_2;
use std::ops::{Add, Mul, Neg, Sub};

/// Runs side by side in one step.
pub(super) const WIDTH: usize = 8;

/// One number of each.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Lanes(pub(super) [f64; WIDTH]);

impl Default for Lanes {
    fn default() -> Self {
        Self::all(0.0)
    }
}

/// Conditions, one for each run.
pub(super) type Mask = [bool; WIDTH];

impl Lanes {
    #[inline(always)]
    pub(super) fn all(value: f64) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    pub(super) fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let mut out = self;
        for x in &mut out.0 {
            *x = of(*x);
        }
        out
    }

    #[inline(always)]
    pub(super) fn with(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for i in 0..WIDTH {
            out.0[i] = of(self.0[i], other.0[i]);
        }
        out
    }

    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// The smaller one, and the other where one is no number.
    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        self.with(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        self.with(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    pub(super) fn recip(self) -> Self {
        self.map(|x| 1.0 / x)
    }

    #[inline(always)]
    pub(super) fn less(self, other: Self) -> Mask {
        let mut out = [false; WIDTH];
        for i in 0..WIDTH {
            out[i] = self.0[i] < other.0[i];
        }
        out
    }

    /// This where the mask says so, the other elsewhere.
    #[inline(always)]
    pub(super) fn or(self, mask: Mask, other: Self) -> Self {
        let mut out = other;
        for i in 0..WIDTH {
            out.0[i] = if mask[i] { self.0[i] } else { other.0[i] };
        }
        out
    }
}

macro_rules! operator {
    ($($name:ident, $method:ident, $op:tt;)*) => {$(
        impl $name for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(other, |a, b| a $op b)
            }
        }

        impl $name<f64> for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|a| a $op other)
            }
        }
    )*};
}

operator! {
    Add, add, +;
    Sub, sub, -;
    Mul, mul, *;
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

#[inline(always)]
pub(super) fn any(mask: Mask) -> bool {
    mask.iter().any(|m| *m)
}

/// x^(−1/n) to within a percent, which is enough to choose a step by; of what is no number, or infinite, something very small.
#[inline(always)]
pub(super) fn root_of_inverse(x: Lanes, n: f64) -> Lanes {
    x.map(|x| {
        // Logarithm: exponent, and a parabola through 1 and 2 over the mantissa.
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i32;
        let mantissa = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000);
        let log = f64::from(exponent - 1024) + (mantissa * (2.0 - mantissa / 3.0) - 2.0 / 3.0);
        // And back.
        let power = (-log / n).clamp(-1000.0, 1000.0);
        // Rounds to the nearest whole number, which is then in the last bits.
        const MAGIC: f64 = 6_755_399_441_055_744.0;
        let shifted = power + MAGIC;
        let whole = shifted - MAGIC;
        let part = power - whole;
        let scale = f64::from_bits((shifted.to_bits() << 52).wrapping_add(0x3ff0_0000_0000_0000));
        scale * (1.0 + part * (LN_2 + part * (0.240_227 + part * 0.055_504)))
    })
}
