//! Fixed point: 32 bits with 22 of them fraction, saturating. Range ±512, resolution 2.4e-7; in the units of
//! the core (clearances, caps, √(m·c/F)) all that counts is between a thousandth and some tens.

use crate::number::product;
use crate::number::scalar::{Accumulator, Number, Scalar, sealed::Sealed};
use crate::number::words::Words;
use fixed::types::I10F22;

/// A fixed-point number of the supervisor, for processors without floating point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
#[repr(transparent)]
pub struct Q(I10F22);

/// Fraction bits.
const FRACTION: u32 = 22;
/// Of a rate.
const RATE_FRACTION: u32 = 30;

impl Q {
    /// From units of 2⁻²².
    #[inline]
    pub const fn from_bits(bits: i32) -> Self {
        Self(I10F22::from_bits(bits))
    }

    /// In units of 2⁻²².
    #[inline]
    pub const fn to_bits(self) -> i32 {
        self.0.to_bits()
    }

    #[inline]
    fn saturated(bits: i64) -> Self {
        Self::from_bits(product::saturated(bits))
    }

    /// Square, in units of 2⁻⁴⁴.
    #[inline]
    fn square(self) -> u64 {
        let size = self.to_bits().unsigned_abs();
        product::unsigned(size, size)
    }
}

impl core::ops::Add for Q {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl core::ops::Sub for Q {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl core::ops::Mul for Q {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::from_bits(product::narrowed::<FRACTION>(
            self.to_bits(),
            other.to_bits(),
        ))
    }
}

impl core::ops::Neg for Q {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.saturating_neg())
    }
}

/// A number normalised for roots: s = m·2^(32 − 2·half), m in [2³⁰, 2³²), and y = 2³⁰/√(m·2⁻³²).
struct Root {
    m: u32,
    half: u32,
    y: u32,
}

/// 2¹⁵/√x at the middle of each of the 48 intervals of 1/64 between ¼ and 1.
const SEEDS: [u16; 48] = {
    let mut seeds = [0; 48];
    let mut i = 0;
    while i < 48 {
        // Largest y with y²·x ≤ 2³⁰, x = (2·i + 33)/128.
        let (mut low, mut high) = (0_u64, 1 << 17);
        while low + 1 < high {
            let y = (low + high) / 2;
            if y * y * (2 * i as u64 + 33) <= 128 << 30 {
                low = y;
            } else {
                high = y;
            }
        }
        seeds[i] = low as u16;
        i += 1;
    }
    seeds
};

impl Root {
    /// For s > 0. Two of Newton's steps bring the seed's 1.5 % to 2⁻²².
    #[inline(never)]
    fn new(s: u64) -> Self {
        // By words: Cortex-M0 calls for a shift of 64 bits, and counts zeros in a loop.
        let (upper, lower) = ((s >> 32) as u32, s as u32);
        let (half, m) = if upper != 0 {
            let half = upper.leading_zeros() / 2;
            let below = (lower >> 1) >> (31 - 2 * half);
            (half, (upper << (2 * half)) | below)
        } else {
            let half = lower.leading_zeros() / 2;
            (16 + half, lower << ((2 * half) & 31))
        };
        let seed = SEEDS.get((m >> 26).wrapping_sub(16) as usize);
        let mut y = u32::from(seed.copied().unwrap_or(1 << 15)) << 15;
        let high = |a: u32, b: u32| (product::unsigned(a, b) >> 32) as u32;
        for _ in 0..2 {
            // y²·x in units of 2⁻²⁸, and y·(3 − y²·x)/2.
            let square = high(high(y, y), m);
            let left = (3_u32 << 28).wrapping_sub(square);
            y = (product::unsigned(y, left) >> 29) as u32;
        }
        Self { m, half, y }
    }
}

impl Sealed for Q {}

impl Scalar for Q {
    type Accumulator = AccumulatorQ;
    const ZERO: Self = Self::from_bits(0);
    const ONE: Self = Self::from_bits(1 << FRACTION);
    const JUST_BELOW_ONE: Self = Self::from_bits((1 << FRACTION) - 8);
    const KNOWN_ANSWERS: [u32; 2] = [0xDB83_D5BB, 0xD759_A43A];
    const NUMBER: Number = Number::Fixed;

    #[inline]
    fn from_f32(x: f32) -> Self {
        // `as` saturates, and turns NaN into 0.
        let scaled = x * (1_u32 << FRACTION) as f32;
        let half = if scaled < 0.0 { -0.5 } else { 0.5 };
        Self::from_bits((scaled + half) as i32)
    }

    fn to_f32(self) -> f32 {
        self.to_bits() as f32 / (1_u32 << FRACTION) as f32
    }

    fn represents(x: f32) -> bool {
        x > -511.0 && x < 511.0
    }

    #[inline]
    fn is_finite(self) -> bool {
        true
    }

    #[inline]
    fn products(a: Self, b: Self, c: Self, d: Self) -> Self {
        let [a, b, c, d] = [a, b, c, d].map(Self::to_bits);
        Self::from_bits(product::narrowed_sum::<FRACTION>([a, b], [c, d]))
    }

    #[inline]
    fn exceeds(x: Self, y: Self, limit: Self) -> bool {
        let [x, y, limit] = [x, y, limit].map(|v| v.to_bits().unsigned_abs());
        product::longer(x, y, limit)
    }

    #[inline]
    fn inverse_length(x: Self, y: Self) -> Self {
        let square = x.square() + y.square();
        // Shorter than 1/512: its inverse would not fit.
        if square < 1 << 26 {
            return Self::ZERO;
        }
        let root = Root::new(square);
        // y·2^(half − 40), in units of 2⁻²².
        Self::from_bits((root.y >> 18_u32.saturating_sub(root.half).min(31)) as i32)
    }

    #[inline]
    fn sqrt(self) -> Self {
        let bits = self.to_bits();
        if bits <= 0 {
            return Self::ZERO;
        }
        let root = Root::new((bits as u64) << FRACTION);
        let wide = product::unsigned(root.m, root.y);
        Self::from_bits((wide >> ((30 + root.half) & 63)) as i32)
    }

    #[inline]
    fn div(self, divisor: Self) -> Self {
        let bits = divisor.to_bits();
        if bits <= 0 {
            if bits == 0 {
                return Self::ZERO;
            }
            return (-self).div(-divisor);
        }
        // The square of the inverse root.
        let root = Root::new((bits as u64) << FRACTION);
        let inverse = product::unsigned(root.y, root.y) >> 31;
        let wide = product::mixed(self.to_bits(), inverse as u32);
        Self::saturated(wide >> (49_u32.saturating_sub(2 * root.half) & 63))
    }

    #[inline]
    fn count(ticks: u32) -> Self {
        Self::from_bits(if ticks < 511 {
            (ticks << FRACTION) as i32
        } else {
            i32::MAX
        })
    }

    #[inline]
    fn bits(self) -> u32 {
        self.to_bits() as u32
    }

    fn of_bits(bits: u32) -> Self {
        Self::from_bits(bits as i32)
    }
}

/// Sum of 64 bits, 52 of them fraction.
#[derive(Debug, Clone, Copy, Default)]
pub struct AccumulatorQ(i64);

impl Words for AccumulatorQ {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        (self.0 as u64).encode(to);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        Self(u64::decode(from) as i64)
    }
    fn word_count(&self) -> u32 {
        2
    }
}

impl Words for Q {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(self.bits());
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        Self::of_bits(u32::decode(from))
    }
}

impl Accumulator<Q> for AccumulatorQ {
    /// In units of 2⁻³⁰, within ±2.
    type Rate = i32;

    fn rate(x: f32) -> i32 {
        (x * (1_u32 << RATE_FRACTION) as f32 + 0.5) as i32
    }

    fn holds(x: f32) -> bool {
        // To 3 % at least.
        (1.5e-8..1.9).contains(&x)
    }

    #[inline]
    fn add(&mut self, x: Q, rate: i32) {
        self.0 = self.0.saturating_add(product::signed(x.to_bits(), rate));
    }

    #[inline]
    fn value(&self) -> Q {
        Q::saturated(self.0 >> RATE_FRACTION)
    }

    fn scaled(&self, factor: f32) -> Self {
        Self((self.0 as f32 * factor) as i64)
    }
}
