//! Power series over one step of flight. Flight is linear, so its series converges everywhere; with
//! steps short against the fastest rate the first few terms give it to the last bit.

use crate::V2;

/// Highest power kept.
pub(crate) const MAX_ORDER: usize = 22;

/// Largest product of step and fastest rate; 1^23/23! = 4e-23 is far below round-off.
pub(crate) const MAX_PHASE: f64 = 1.0;

/// Coefficients of a plane vector over θ in [0, 1], θ = time / step. Entry k already holds step^k.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Series(pub(crate) [V2; MAX_ORDER + 1]);

impl Series {
    pub(crate) fn start(value: V2) -> Self {
        let mut coefficients = [V2::zeros(); MAX_ORDER + 1];
        coefficients[0] = value;
        Self(coefficients)
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

    /// ∫ a·b dθ from 0 to θ, products beyond the kept order left out (they are below round-off).
    pub(crate) fn integral_of_dot(&self, other: &Self, theta: f64, order: usize) -> f64 {
        let mut sum = 0.0;
        let mut power = theta;
        for k in 0..=order {
            let mut c = 0.0;
            for j in 0..=k {
                c += self.0[j].dot(&other.0[k - j]);
            }
            sum += c * power / (k + 1) as f64;
            power *= theta;
        }
        sum
    }

    /// The same with a constant weight per axis: ∫ aᵀ·diag(w)·b dθ.
    pub(crate) fn integral_of_weighed_square(&self, weight: V2, theta: f64, order: usize) -> f64 {
        let mut weighed = *self;
        for c in &mut weighed.0[..=order] {
            c.component_mul_assign(&weight);
        }
        self.integral_of_dot(&weighed, theta, order)
    }
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
