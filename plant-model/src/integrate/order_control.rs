//! To which order a power series is worth carrying on, and how far it can then be trusted.

use crate::series::MAX_ORDER;

/// Below this order the last two terms say too little about the rest.
pub(crate) const LOWEST_ORDER: usize = 6;

/// Tolerance of a step of flight from that of contact: it is linear and costs little, and may last for long. None is smaller
/// than rounding.
pub(crate) fn flight_rtol(rtol: f64) -> f64 {
    (1e-7 * rtol).max(1e-16)
}

/// The largest order that pays at a tolerance. Measured on bouncing into rolling: between these orders the time to a given
/// error is flat, below and above it rises.
pub(crate) fn highest_order(rtol: f64) -> usize {
    match rtol {
        r if r > 1e-7 => 16,
        r if r > 1e-11 => 20,
        _ => MAX_ORDER,
    }
}

/// θ up to which a series can be trusted, by the weighed squares of its highest coefficients, so many of them: they say how far the
/// rest can be left out. Where the step was far too long they have lost their digits, or overflowed.
#[inline]
pub(crate) fn trusted_theta(order: usize, last: usize, square: impl Fn(usize) -> f64) -> f64 {
    let reach = |k: usize| square(k).powf(-0.5 / k as f64);
    let least = |a: f64, b: f64| if a < b || a.is_nan() { a } else { b };
    0.9 * (order + 1 - last..order).fold(reach(order), |so_far, k| least(so_far, reach(k)))
}

/// Whether the series reaches to the end of the span, asked from order to order: its last terms there, so many of them, are
/// small, by a margin as to the distance.
pub(crate) struct OrderControl {
    /// Square of the end's θ over the margin, and its power for the next order.
    square: f64,
    power: f64,
    /// Terms in a row that are small, and how many have to be.
    small: usize,
    last: usize,
}

impl OrderControl {
    /// Terms that go on falling so leave one tolerance beyond the lowest order, less beyond a higher one.
    const MARGIN: f64 = 0.8;

    pub(crate) fn new(end_theta: f64, last: usize) -> Self {
        let square = (end_theta / Self::MARGIN).powi(2);
        Self {
            square,
            power: square.powi(LOWEST_ORDER as i32 - 1),
            small: 0,
            last,
        }
    }

    /// Takes the next order's coefficients in, by their weighed square; the first are those below
    /// [`LOWEST_ORDER`].
    pub(crate) fn with(&mut self, coefficients: f64) -> bool {
        let small = coefficients * self.power <= 1.0;
        self.power *= self.square;
        self.small = if small { self.small + 1 } else { 0 };
        self.small >= self.last
    }
}
