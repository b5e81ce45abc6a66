//! Power series over one step of flight. Flight is linear, so its series converges everywhere; with
//! steps short against the fastest rate the first few terms give it to the last bit.

use crate::V2;

/// Highest power kept.
pub(crate) const MAX_ORDER: usize = 24;

/// Room for one power more: positions run ahead of velocities.
const LENGTH: usize = MAX_ORDER + 2;

/// Gauss–Legendre rule on [0, 1]: (node, weight). Products of two series with phase p are integrated
/// with a relative error below (n!)⁴/((2n + 1)·(2n)!³)·(2p)^2n: 1e-15 for seven nodes at p = 1.
#[rustfmt::skip]
const SEVEN_NODES: [(f64, f64); 7] = [
    (0.02544604382862074, 0.06474248308443485), (0.1292344072003028, 0.13985269574463833),
    (0.2970774243113014, 0.19091502525255946), (0.5, 0.2089795918367347),
    (0.7029225756886985, 0.19091502525255946), (0.8707655927996972, 0.13985269574463833),
    (0.9745539561713793, 0.06474248308443485),
];

/// The same with five nodes: 1e-15 up to p = 0.25.
#[rustfmt::skip]
const FIVE_NODES: [(f64, f64); 5] = [
    (0.046910077030668, 0.11846344252809454), (0.23076534494715845, 0.23931433524968324),
    (0.5, 0.2844444444444444), (0.7692346550528415, 0.23931433524968324),
    (0.953089922969332, 0.11846344252809454),
];

/// Rule for products of two series with this phase.
pub(crate) fn quadrature(phase: f64) -> &'static [(f64, f64)] {
    if phase <= 0.25 {
        &FIVE_NODES
    } else {
        &SEVEN_NODES
    }
}

/// Largest product of step and fastest rate; twenty terms leave 1/21! = 2e-20, below round-off.
pub(crate) const MAX_PHASE: f64 = 1.0;

/// Σ a_i·b_{n−i} over two slices of the same length. Four sums side by side: one alone would wait for
/// each addition to finish before it began the next.
#[inline(always)]
fn convolve<A, B, T>(a: &[A], b: &[B], times: impl Fn(A, B) -> T) -> T
where
    A: Copy,
    B: Copy,
    T: Copy + Default + std::ops::Add<Output = T>,
{
    let mut sums = [T::default(); 4];
    let (front, back) = (a.chunks_exact(4), b.rchunks_exact(4));
    let (rest_a, rest_b) = (front.remainder(), back.remainder());
    for (a, b) in front.zip(back) {
        sums[0] = sums[0] + times(a[0], b[3]);
        sums[1] = sums[1] + times(a[1], b[2]);
        sums[2] = sums[2] + times(a[2], b[1]);
        sums[3] = sums[3] + times(a[3], b[0]);
    }
    for (a, b) in rest_a.iter().zip(rest_b.iter().rev()) {
        sums[0] = sums[0] + times(*a, *b);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Coefficients of a plane vector over θ = time / step. Entry k already holds step^k.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Series(pub(crate) [V2; LENGTH]);

impl Default for Series {
    fn default() -> Self {
        Self([V2::zeros(); LENGTH])
    }
}

/// A quarter turn counter-clockwise.
#[inline]
pub(crate) fn turned(v: V2) -> V2 {
    V2::new(-v.y, v.x)
}

impl Series {
    pub(crate) fn start(value: V2) -> Self {
        let mut series = Self::default();
        series.0[0] = value;
        series
    }

    /// Value at θ.
    #[inline]
    pub(crate) fn at(&self, theta: f64, order: usize) -> V2 {
        let mut sum = V2::zeros();
        for c in self.0[..=order].iter().rev() {
            sum = sum * theta + c;
        }
        sum
    }

    /// Coefficient k of a·b.
    #[inline]
    pub(crate) fn dot_coefficient(&self, other: &Self, k: usize) -> f64 {
        let sum = convolve(&self.0[..=k], &other.0[..=k], |a, b| a.component_mul(&b));
        sum.x + sum.y
    }

    /// Coefficient k of a × b.
    #[inline]
    pub(crate) fn cross_coefficient(&self, other: &Self, k: usize) -> f64 {
        let sum = convolve(&self.0[..=k], &other.0[..=k], |a, b| {
            V2::new(a.x * b.y, a.y * b.x)
        });
        sum.x - sum.y
    }

    /// Coefficient k of the product with a scalar series.
    #[inline]
    pub(crate) fn times_coefficient(&self, other: &Scalar, k: usize) -> V2 {
        convolve(&self.0[..=k], &other.0[..=k], |a, b| a * b)
    }

    /// The same without the term that holds this series' own coefficient k.
    #[inline]
    pub(crate) fn times_coefficient_below(&self, other: &Scalar, k: usize) -> V2 {
        convolve(&self.0[..k], &other.0[1..=k], |a, b| a * b)
    }

    /// ∫ a·b dθ from 0 to θ, of the whole product: its coefficients fall 2^k times more slowly than
    /// those of its factors.
    pub(crate) fn integral_of_dot(&self, other: &Self, theta: f64, order: usize) -> f64 {
        integral(theta, 2 * order, |k| {
            let (low, high) = (k.saturating_sub(order), k.min(order));
            let (a, b) = (&self.0[low..=high], &other.0[low..=high]);
            let sum = convolve(a, b, |a, b| a.component_mul(&b));
            sum.x + sum.y
        })
    }
}

/// Coefficients of a number over θ.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scalar(pub(crate) [f64; LENGTH]);

impl Default for Scalar {
    fn default() -> Self {
        Self([0.0; LENGTH])
    }
}

impl Scalar {
    /// Value at θ.
    #[inline]
    pub(crate) fn at(&self, theta: f64, order: usize) -> f64 {
        self.0[..=order]
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * theta + c)
    }

    /// Coefficient k of the product.
    #[inline]
    pub(crate) fn product_coefficient(&self, other: &Self, k: usize) -> f64 {
        convolve(&self.0[..=k], &other.0[..=k], |a, b| a * b)
    }

    /// The same without the term that holds the other series' coefficient k.
    #[inline]
    pub(crate) fn product_coefficient_below(&self, other: &Self, k: usize) -> f64 {
        convolve(&self.0[1..=k], &other.0[..k], |a, b| a * b)
    }

    /// Coefficient k of the square without the two terms that hold coefficient k itself.
    #[inline]
    pub(crate) fn inner_square_coefficient(&self, k: usize) -> f64 {
        convolve(&self.0[1..k], &self.0[1..k], |a, b| a * b)
    }

    /// a·self + b·other, up to the order.
    pub(crate) fn combined(&self, a: f64, other: &Self, b: f64, order: usize) -> Self {
        let mut out = Self::default();
        for (o, (x, y)) in out.0[..=order].iter_mut().zip(self.0.iter().zip(&other.0)) {
            *o = a * x + b * y;
        }
        out
    }

    /// ∫ dθ from 0 to θ.
    pub(crate) fn integral(&self, theta: f64, order: usize) -> f64 {
        integral(theta, order, |k| self.0[k])
    }

    /// ∫ a·b dθ from 0 to θ.
    pub(crate) fn integral_of_product(&self, other: &Self, theta: f64, order: usize) -> f64 {
        integral(theta, 2 * order, |k| {
            let (low, high) = (k.saturating_sub(order), k.min(order));
            convolve(&self.0[low..=high], &other.0[low..=high], |a, b| a * b)
        })
    }
}

/// ∫ of the series with these coefficients from 0 to θ.
fn integral(theta: f64, order: usize, coefficient: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for k in (0..=order).rev() {
        sum = (sum + coefficient(k) / (k + 1) as f64) * theta;
    }
    sum
}

/// Number of terms after which the remainder of a series with the given phase (fastest rate × step,
/// at most [`MAX_PHASE`]) is below round-off.
pub(crate) fn order_for(phase: f64) -> usize {
    let mut term = 1.0;
    for k in 1..=MAX_ORDER {
        term *= phase / k as f64;
        if term < 1e-18 {
            return k.max(3);
        }
    }
    MAX_ORDER
}
