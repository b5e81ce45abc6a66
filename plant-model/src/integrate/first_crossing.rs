//! The first zero of a guard that is a polynomial: none can be missed.

use crate::series::Scalar;

/// Where a guard falls to zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ZeroCrossing {
    /// Nowhere in the step.
    Never,
    /// At this θ.
    At(f64),
    /// Not before this θ; what comes after is too close to decide in one go.
    ClearUntil(f64),
}

/// First θ in [0, `end`] at which a guard that starts positive, or at zero and rising, falls to zero. `rounding`: what it may be off
/// by as it is a difference of larger numbers.
///
/// Conservative advancement: with M an upper bound of |g̈| over a window, no root lies before that of
/// g + ġ·τ − M·τ²/2. Windows shrink and grow with the moves, so that the bound stays close.
pub(crate) fn first_crossing(
    guard: &Scalar,
    end: f64,
    order: usize,
    (normal, rounding): (bool, f64),
) -> ZeroCrossing {
    let c = &guard.0[..=order];
    let swing = c[1..]
        .iter()
        .rev()
        .fold(0.0, |sum, c| (sum + c.abs()) * end);
    // What does not move does not fall either.
    if c[0] > swing || (swing <= rounding && c[0] >= -rounding) {
        return ZeroCrossing::Never;
    }
    let bound = |window: f64| {
        let terms = c.iter().enumerate().skip(2).rev();
        terms.fold(0.0, |sum, (k, c)| {
            sum * window + (k * (k - 1)) as f64 * c.abs()
        })
    };
    // The state that the mode starts from carries the round-off of a whole step before.
    let start_tiny = (1e-12 * (c[0].abs() + swing)).max(rounding);
    let tiny = (1e-15 * (c[0].abs() + swing)).max(rounding);
    let (mut theta, mut window, mut curvature) = (0.0, end, bound(end));
    for _ in 0..200 {
        let (mut g, mut rate) = (0.0, 0.0);
        for c in c.iter().rev() {
            rate = rate * theta + g;
            g = g * theta + c;
        }
        if theta == 0.0 {
            // A force that has just jumped may have left the cone, whichever way it moves now. A
            // normal force that rises has not: the touch was found to round-off only.
            if g < -start_tiny && !(normal && rate > 0.0) {
                return ZeroCrossing::At(0.0);
            }
            if g <= start_tiny {
                g = 0.0;
            }
        }
        if g <= tiny && rate < 0.0 {
            return ZeroCrossing::At(theta);
        }
        let g = g.max(0.0);
        let root = (rate * rate + 2.0 * curvature * g).sqrt();
        let advance = if rate >= 0.0 {
            (rate + root) / curvature
        } else {
            2.0 * g / (root - rate)
        };
        if advance < 0.05 * (window - theta) {
            window = theta + 8.0 * advance.max(1e-9 * end);
            curvature = bound(window.min(end));
        }
        // At zero without slope: let it move before it is judged.
        let least = if g == 0.0 { 1e-9 * end } else { 0.0 };
        theta += advance.max(least).min(window - theta).max(least);
        if theta >= end {
            return ZeroCrossing::Never;
        }
        if theta >= window {
            window = (theta * 4.0).min(end);
            curvature = bound(window);
        }
    }
    ZeroCrossing::ClearUntil(theta)
}
