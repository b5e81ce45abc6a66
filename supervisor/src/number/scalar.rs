//! The numbers that the supervisor computes with: `f32` where there is a floating-point unit, [`crate::Q`]
//! where there is none, `f64` as the reference on the host. All operations are total and the same bits on
//! every target.
//!
//! Arithmetic of the coefficients: total, panic-free, the same bits on every target.

use crate::number::words::{Words, words_of_fields};
use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

pub(crate) mod sealed {
    /// Only this crate's scalars have been checked to be total.
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// Kinds of numbers that a core can compute with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Number {
    /// `f32`.
    Single = 0,
    /// [`crate::Q`].
    Fixed = 1,
    /// `f64`, of which a record keeps no samples.
    Double = 2,
}

/// A number of the supervisor: `f32`, `f64` or [`crate::Q`].
pub trait Scalar:
    sealed::Sealed
    + Copy
    + Default
    + PartialEq
    + PartialOrd
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Words
{
    /// A sum that a small rate still moves.
    type Accumulator: Accumulator<Self>;

    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// A few units in the last place below 1, so that rounding cannot lift a scaled force above its limit.
    const JUST_BELOW_ONE: Self;
    /// Hash of the self-test with all parts, and of the one that has use for none of those that may be left out.
    const KNOWN_ANSWERS: [u32; 2];
    /// What a record calls these numbers.
    const NUMBER: Number;

    /// The nearest number; saturating, 0 for NaN.
    fn from_f32(x: f32) -> Self;
    /// As `f32`.
    fn to_f32(self) -> f32;
    /// Whether `from_f32` keeps this coefficient well enough to compute with.
    fn represents(x: f32) -> bool;
    /// Neither NaN nor infinite.
    fn is_finite(self) -> bool;
    /// a·b + c·d.
    fn products(a: Self, b: Self, c: Self, d: Self) -> Self;
    /// Whether √(x² + y²) > limit ≥ 0; true if one of them is NaN.
    fn exceeds(x: Self, y: Self, limit: Self) -> bool;
    /// 1/√(x² + y²); 0 where that length is as good as none.
    fn inverse_length(x: Self, y: Self) -> Self;
    /// Square root; 0 for negative numbers and NaN.
    fn sqrt(self) -> Self;
    /// The quotient; saturating, something finite for a divisor of 0 where numbers have no infinity.
    fn div(self, divisor: Self) -> Self;
    /// A count of ticks; saturating.
    fn count(ticks: u32) -> Self;
    /// Its bits, for a hash and for a record; the two halves together where there are more than 32.
    fn bits(self) -> u32;
    /// The number of these bits, where there are no more than 32; else 0.
    fn of_bits(bits: u32) -> Self;

    /// Held between `low` and `high` (`low` ≤ `high`); NaN becomes `low`.
    #[inline]
    fn clamp(self, low: Self, high: Self) -> Self {
        // Not that of `f32`, which can panic.
        if self > high {
            high
        } else if self >= low {
            self
        } else {
            low
        }
    }

    /// Held between `-most` and `most` (`most` ≥ 0), with one comparison where it is; NaN becomes `-most`.
    #[inline]
    fn within(self, most: Self) -> Self {
        if self.abs() <= most {
            self
        } else if self > Self::ZERO {
            most
        } else {
            -most
        }
    }

    /// What of it is beyond a doubt of this size.
    #[inline]
    fn beyond(self, doubt: Self) -> Self {
        if self > doubt {
            self - doubt
        } else if self < -doubt {
            self + doubt
        } else {
            Self::ZERO
        }
    }

    /// The larger of two finite numbers.
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two finite numbers.
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    /// Without its sign.
    #[inline]
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
}

/// A sum of many small steps that rounding must not stop.
pub trait Accumulator<S>: Copy + Default + Debug + Words {
    /// A factor that may be smaller than what `S` resolves.
    type Rate: Copy + Debug + PartialEq;

    /// The nearest rate; saturating.
    fn rate(x: f32) -> Self::Rate;
    /// Whether a rate is within what `rate` keeps.
    fn holds(x: f32) -> bool;
    /// Adds x·rate.
    fn add(&mut self, x: S, rate: Self::Rate);
    /// The sum.
    fn value(&self) -> S;
    /// The sum times a factor.
    fn scaled(&self, factor: f32) -> Self;
}

/// Compensated sum: keeps what rounding would take from it.
#[derive(Debug, Clone, Copy, Default)]
pub struct KahanSum<S> {
    value: S,
    rest: S,
}

words_of_fields!(KahanSum<S> { value, rest });

macro_rules! floating_point {
    ($type:ident, $known_answers:expr, $number:ident, $of_bits:expr) => {
        impl Scalar for $type {
            type Accumulator = KahanSum<$type>;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const JUST_BELOW_ONE: Self = 1.0 - 4.0 * $type::EPSILON;
            const KNOWN_ANSWERS: [u32; 2] = $known_answers;
            const NUMBER: Number = Number::$number;

            #[inline]
            fn from_f32(x: f32) -> Self {
                $type::from(x)
            }
            #[inline]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline]
            fn represents(x: f32) -> bool {
                x.is_finite()
            }
            #[inline]
            fn is_finite(self) -> bool {
                self.is_finite()
            }
            #[inline]
            fn products(a: Self, b: Self, c: Self, d: Self) -> Self {
                a * b + c * d
            }
            #[inline]
            fn exceeds(x: Self, y: Self, limit: Self) -> bool {
                let within = x * x + y * y <= limit * limit;
                !within
            }
            #[inline]
            fn inverse_length(x: Self, y: Self) -> Self {
                inverse_root::$type(x * x + y * y)
            }
            #[inline]
            fn sqrt(self) -> Self {
                self * inverse_root::$type(self)
            }
            #[inline]
            fn div(self, divisor: Self) -> Self {
                self / divisor
            }
            #[inline]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline]
            fn count(ticks: u32) -> Self {
                ticks as $type
            }
            #[inline]
            fn bits(self) -> u32 {
                let bits = u64::from(self.to_bits());
                (bits ^ (bits >> 32)) as u32
            }
            #[inline]
            fn of_bits(bits: u32) -> Self {
                $of_bits(bits)
            }
        }

        impl Accumulator<$type> for KahanSum<$type> {
            type Rate = $type;

            #[inline]
            fn rate(x: f32) -> $type {
                $type::from(x)
            }
            #[inline]
            fn holds(x: f32) -> bool {
                x.is_finite()
            }
            #[inline]
            fn add(&mut self, x: $type, rate: $type) {
                self.rest += x * rate;
                let sum = self.value + self.rest;
                self.rest -= sum - self.value;
                self.value = sum;
            }
            #[inline]
            fn value(&self) -> $type {
                self.value
            }
            fn scaled(&self, factor: f32) -> Self {
                Self {
                    value: self.value * $type::from(factor),
                    rest: 0.0,
                }
            }
        }
    };
}

floating_point!(f32, [0x31BD_BC80, 0xE410_C888], Single, f32::from_bits);
floating_point!(f64, [0xAD25_0906, 0x65B4_2D98], Double, |_| 0.0);

/// Reciprocal square roots by Newton's method, from + − × only: every target gives the same bits. `core`
/// has no root, and libm's costs three times as many instructions where there is an FPU. 0 below 1e-30
/// and for NaN.
mod inverse_root {
    /// The seed is micromath's (6 % off); three steps bring it to a few units in the last place.
    #[inline]
    pub(super) fn f32(x: f32) -> f32 {
        let usable = x > 1e-30;
        if !usable {
            return 0.0;
        }
        let half = 0.5 * x;
        let mut y = micromath::F32(x).invsqrt().0;
        y *= 1.5 - half * y * y;
        y *= 1.5 - half * y * y;
        y *= 1.5 - half * y * y;
        y
    }

    /// Five steps from the same kind of seed.
    #[inline]
    pub(super) fn f64(x: f64) -> f64 {
        let usable = x > 1e-30;
        if !usable {
            return 0.0;
        }
        let half = 0.5 * x;
        let mut y = f64::from_bits(0x5FE6_EB50_C7B5_37A9 - (x.to_bits() >> 1));
        for _ in 0..5 {
            y *= 1.5 - half * y * y;
        }
        y
    }
}

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
