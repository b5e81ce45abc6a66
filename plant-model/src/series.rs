//! Power series over one step. Buffers are filled again from step to step: entries beyond the order are
//! left from before, and mean nothing.

use crate::V2;

/// Highest power kept.
pub(crate) const MAX_ORDER: usize = 24;

/// Room for one power more: positions run ahead of velocities.
pub(crate) const LENGTH: usize = MAX_ORDER + 2;

/// 1/k. Divisions would set the pace of the recurrences.
pub(crate) const INVERSE: [f64; LENGTH + 1] = {
    let mut table = [f64::INFINITY; LENGTH + 1];
    let mut k = 1;
    while k < table.len() {
        table[k] = 1.0 / k as f64;
        k += 1;
    }
    table
};

/// Σ a_i·b_{n−i} from `first` to n. Two sums side by side: one alone would wait for each addition to finish before it began the next.
#[inline(always)]
fn convolve<A, B, T>(
    a: &[A; LENGTH],
    b: &[B; LENGTH],
    (first, n): (usize, usize),
    times: impl Fn(A, B) -> T,
) -> T
where
    A: Copy,
    B: Copy,
    T: Copy + Default + std::ops::Add<Output = T>,
{
    let n = n.min(LENGTH - 1);
    let (mut even, mut odd) = (T::default(), T::default());
    let mut i = first;
    while i < n {
        even = even + times(a[i], b[n - i]);
        odd = odd + times(a[i + 1], b[n - i - 1]);
        i += 2;
    }
    if i == n {
        even = even + times(a[n], b[0]);
    }
    even + odd
}

/// Coefficients of a plane vector over θ = time / step. Entry k already holds step^k.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Series(pub(crate) [V2; LENGTH]);

impl Default for Series {
    fn default() -> Self {
        Self([V2::zeros(); LENGTH])
    }
}

impl Series {
    /// Value at θ.
    #[inline]
    pub(crate) fn at(&self, theta: f64, order: usize) -> V2 {
        let mut sum = V2::zeros();
        for c in self.0[..=order].iter().rev() {
            sum = sum * theta + c;
        }
        sum
    }

    /// Value and derivative at θ.
    #[inline]
    pub(crate) fn with_slope(&self, theta: f64, order: usize) -> (V2, V2) {
        let (mut value, mut slope) = (V2::zeros(), V2::zeros());
        for c in self.0[..=order].iter().rev() {
            slope = slope * theta + value;
            value = value * theta + c;
        }
        (value, slope)
    }

    /// Values at several θ.
    #[inline(always)]
    pub(crate) fn at_all<const N: usize>(&self, theta: &[f64; N], order: usize) -> [V2; N] {
        let mut sums = [V2::zeros(); N];
        for c in self.0[..=order].iter().rev() {
            for (sum, theta) in sums.iter_mut().zip(theta) {
                *sum = *sum * *theta + c;
            }
        }
        sums
    }

    /// How far it can get from its start up to θ, x and y together: Σ |c_k|·θ^k.
    #[inline]
    pub(crate) fn reach(&self, theta: f64, order: usize) -> f64 {
        let sum = self.0[1..=order].iter().rev();
        let sum = sum.fold(V2::zeros(), |sum, c| (sum + c.abs()) * theta);
        sum.x + sum.y
    }

    /// Coefficient k of a·b.
    #[inline]
    pub(crate) fn dot_coefficient(&self, other: &Self, k: usize) -> f64 {
        let sum = convolve(&self.0, &other.0, (0, k), |a, b| a.component_mul(&b));
        sum.x + sum.y
    }

    /// Coefficient k of the product with a scalar series.
    #[inline]
    pub(crate) fn times_coefficient(&self, other: &Scalar, k: usize) -> V2 {
        convolve(&self.0, &other.0, (0, k), |a, b| a * b)
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
        convolve(&self.0, &other.0, (0, k), |a, b| a * b)
    }

    /// Values at several θ.
    #[inline(always)]
    pub(crate) fn at_all<const N: usize>(&self, theta: &[f64; N], order: usize) -> [f64; N] {
        let mut sums = [0.0; N];
        for c in self.0[..=order].iter().rev() {
            for (sum, theta) in sums.iter_mut().zip(theta) {
                *sum = *sum * theta + c;
            }
        }
        sums
    }

    /// How far it can get from its start up to θ: Σ |c_k|·θ^k.
    #[inline]
    pub(crate) fn reach(&self, theta: f64, order: usize) -> f64 {
        let sum = self.0[1..=order].iter().rev();
        sum.fold(0.0, |sum, c| (sum + c.abs()) * theta)
    }

    /// Value and derivative at θ.
    #[inline]
    pub(crate) fn with_slope(&self, theta: f64, order: usize) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for c in self.0[..=order].iter().rev() {
            slope = slope * theta + value;
            value = value * theta + c;
        }
        (value, slope)
    }

    /// Becomes a·x + b·y, up to the order.
    pub(crate) fn combine(&mut self, (a, x): (f64, &Self), (b, y): (f64, &Self), order: usize) {
        for (o, (x, y)) in self.0[..=order].iter_mut().zip(x.0.iter().zip(&y.0)) {
            *o = a * x + b * y;
        }
    }

    /// ∫ dθ from 0 to θ.
    pub(crate) fn integral(&self, theta: f64, order: usize) -> f64 {
        let mut sum = 0.0;
        for k in (0..=order).rev() {
            sum = (sum + self.0[k] * INVERSE[k + 1]) * theta;
        }
        sum
    }
}
