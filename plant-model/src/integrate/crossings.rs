//! Where a guard of the mode becomes negative inside a step.

use crate::system::{Evaluation, Guards};

/// Whether a guard is negative at the end, or comes near zero at any stage. The stages are rough
/// looks at the inside of the step, and cost nothing.
pub(super) fn suspicious<Y>(seen: &[Evaluation<Y>]) -> bool {
    let (Some(first), Some(last)) = (seen.first(), seen.last()) else {
        return false;
    };
    (0..first.guards.len()).any(|i| {
        let near = 0.1 * first.guards[i].abs().max(last.guards[i].abs());
        first.guards[i] < 0.0 || seen.iter().skip(1).any(|e| e.guards[i] < near)
    })
}

/// Size of each guard over the last step, against which zero is judged.
pub(super) fn guard_scales<Y>(seen: &[Evaluation<Y>]) -> Guards {
    let mut scale = [0.0; 5];
    for e in seen {
        for (s, g) in scale.iter_mut().zip(&e.guards) {
            if g.is_finite() {
                *s = g.abs().max(*s);
            }
        }
    }
    scale
}

/// Where a guard is lowest between the outer ones of three points, if it is lower in the middle and may come near zero
/// there: an event that is over before the next point.
pub(super) fn lowest_between(
    guard: usize,
    [mut a, mut b, mut c]: [(f64, f64); 3],
    guards_at: &mut impl FnMut(f64) -> Guards,
) -> Option<(f64, f64)> {
    for _ in 0..8 {
        if !(a.0 < b.0 && b.1 > 0.0 && b.1 <= a.1 && b.1 < c.1) {
            break;
        }
        // Vertex of the parabola through the three, from its middle.
        let (left, right) = ((b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0));
        let bend = (right - left) / (c.0 - a.0);
        let slope = left + bend * (b.0 - a.0);
        let at = b.0 - 0.5 * slope / bend;
        let lowest = b.1 - 0.25 * slope * slope / bend;
        let settled = (at - b.0).abs() < 1e-6 * (c.0 - a.0);
        if lowest > 0.5 * b.1 || settled || !(at > a.0 && at < c.0) {
            break;
        }
        let new = (at, guards_at(at)[guard]);
        (a, b, c) = match (new.1 < b.1, new.0 < b.0) {
            (true, true) => (a, new, b),
            (true, false) => (b, new, c),
            (false, true) => (new, b, c),
            (false, false) => (a, b, new),
        };
    }
    (b.1 < 0.0).then_some(b)
}

/// First sign change of one guard in a bracket whose high end is negative. A low end at zero (the
/// guard has just been armed there) is first moved to a point at which the guard is positive; if
/// there is none the event is at the low end itself.
pub(super) fn first_root(
    guard: usize,
    (mut low, mut at_low): (f64, f64),
    (mut high, mut at_high): (f64, f64),
    guards_at: &mut impl FnMut(f64) -> Guards,
) -> f64 {
    if at_low <= 0.0 {
        let start = low;
        let mut width = high - low;
        loop {
            width *= 0.25;
            if width < 1e-12 {
                return start;
            }
            let value = guards_at(start + width)[guard];
            if value > 0.0 {
                (low, at_low) = (start + width, value);
                break;
            }
            (high, at_high) = (start + width, value);
        }
    }
    // Regula falsi with the Illinois rule: brackets, and converges faster than bisection.
    let mut side = 0;
    for _ in 0..60 {
        let theta = (low * at_high - high * at_low) / (at_high - at_low);
        if !(theta > low && theta < high) || high - low < 1e-15 {
            break;
        }
        let value = guards_at(theta)[guard];
        if value > 0.0 {
            (low, at_low) = (theta, value);
            if side == 1 {
                at_high *= 0.5;
            }
            side = 1;
        } else {
            (high, at_high) = (theta, value);
            if side == -1 {
                at_low *= 0.5;
            }
            side = -1;
        }
        if value == 0.0 {
            break;
        }
    }
    high
}
