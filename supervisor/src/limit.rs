//! The only place that limits forces, and the last word on them.

use crate::coeffs::Coeffs;
use crate::law::Wanted;
use crate::math::{between, max, sqrt};
use crate::signal::Limits;
use crate::vec2::Vec2;

/// Gives the capacity of one cap to braking first, then damping, then restoring.
pub(crate) fn allocate(wanted: &Wanted) -> (Vec2, Limits) {
    let mut limits = Limits::empty();
    let mut sum = Vec2::ZERO;
    for part in [wanted.braking, wanted.damping, wanted.restoring] {
        let share = largest_share(sum, part);
        if share < 1.0 {
            limits |= Limits::FORCE_CAP;
        }
        sum = sum + part * share;
    }
    (sum, limits)
}

/// Largest s in [0, 1] with |sum + s·part| ≤ 1, for |sum| ≤ 1.
fn largest_share(sum: Vec2, part: Vec2) -> f32 {
    let square = part.length_squared();
    if square <= 1e-12 {
        return 1.0;
    }
    let along = sum.dot(part);
    let room = max(1.0 - sum.length_squared(), 0.0);
    between(
        (sqrt(along * along + square * room) - along) / square,
        0.0,
        1.0,
    )
}

/// A levitation command within finite bounds \[N\], and whether it had to be changed.
pub(crate) fn levitation(command_n: [f32; 2], coeffs: &Coeffs) -> ([f32; 2], Limits) {
    let cap = coeffs.force_max_n;
    let v = Vec2::from_array(command_n);
    // Squares of huge numbers overflow to infinity, which is rightly above the cap.
    if v.is_finite() && v.length_squared() <= cap * cap {
        return (command_n, Limits::empty());
    }
    let box_limited = |x: f32| {
        if x.is_finite() {
            between(x, -cap, cap)
        } else {
            0.0
        }
    };
    let limited = Vec2::new(box_limited(v.x), box_limited(v.y));
    (
        final_force_n(limited.to_array(), coeffs).0,
        Limits::LEVITATION_CLAMPED,
    )
}

/// The last word: finite, and at most the cap long, whatever came before.
pub(crate) fn final_force_n(force_n: [f32; 2], coeffs: &Coeffs) -> ([f32; 2], Limits) {
    let cap = coeffs.force_max_n;
    let v = Vec2::from_array(force_n);
    let square = v.length_squared();
    if !square.is_finite() {
        return ([0.0; 2], Limits::NOT_FINITE);
    }
    if square <= cap * cap {
        return (force_n, Limits::empty());
    }
    // A few units in the last place below the cap, so that rounding cannot lift it above.
    let scaled = v * (cap * (1.0 - 4.0 * f32::EPSILON) / sqrt(square));
    (scaled.to_array(), Limits::FORCE_CAP)
}
