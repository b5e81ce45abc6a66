//! Power series over one step of flight. Flight is linear, so its series converges everywhere; with
//! steps short against the fastest rate the first few terms give it to the last bit.

use crate::V2;

/// Highest power kept.
pub(crate) const MAX_ORDER: usize = 22;

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
