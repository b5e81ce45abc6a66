//! Where a condition turns, by halving a bracket.

use std::convert::Infallible;

/// Narrows a bracket of where `below` turns from true to false until it is `narrow`, or its ends are neighbouring numbers;
/// as it is where its middle is no number, or it is none.
///
/// # Errors
/// The first of `below`.
pub(crate) fn try_bracket<E>(
    (mut low, mut high): (f64, f64),
    narrow: impl Fn(f64, f64) -> bool,
    mut below: impl FnMut(f64) -> Result<bool, E>,
) -> Result<(f64, f64), E> {
    loop {
        let middle = 0.5 * (low + high);
        if narrow(low, high) || !(middle > low && middle < high) {
            return Ok((low, high));
        }
        if below(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// [`try_bracket`] with a condition that can always be decided.
pub(crate) fn bracket_until(
    ends: (f64, f64),
    narrow: impl Fn(f64, f64) -> bool,
    below: impl Fn(f64) -> bool,
) -> (f64, f64) {
    let Ok(ends) = try_bracket(ends, narrow, |x| Ok::<_, Infallible>(below(x)));
    ends
}

/// [`bracket_until`] there is no number between its ends.
pub(crate) fn bracket(ends: (f64, f64), below: impl Fn(f64) -> bool) -> (f64, f64) {
    bracket_until(ends, |_, _| false, below)
}

/// The middle of [`bracket`]; NaN between ends that are no numbers.
pub(crate) fn bisect(ends: (f64, f64), below: impl Fn(f64) -> bool) -> f64 {
    let (low, high) = bracket(ends, below);
    0.5 * (low + high)
}

/// Highest value between two points (θ, value, slope): what rises at the first and falls at the second has one top in between.
pub(crate) fn top_between(
    of: &dyn Fn(f64) -> (f64, f64),
    (from, start, start_slope): (f64, f64, f64),
    (to, end, end_slope): (f64, f64, f64),
) -> f64 {
    let mut top = start.max(end);
    if !(start_slope > 0.0 && end_slope < 0.0) {
        return top;
    }
    // Regula falsi on the slope, with the Illinois rule. The value is flat at the top.
    let (mut low, mut high) = ((from, start_slope), (to, end_slope));
    let mut rose = None;
    for _ in 0..6 {
        let at = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let (value, slope) = of(at);
        top = top.max(value);
        // No place between the two can be higher by more.
        if slope.abs() * (high.0 - low.0) <= 1e-12 * top.abs() {
            break;
        }
        let rises = slope > 0.0;
        let again = rose == Some(rises);
        if rises {
            low = (at, slope);
            high.1 *= if again { 0.5 } else { 1.0 };
        } else {
            high = (at, slope);
            low.1 *= if again { 0.5 } else { 1.0 };
        }
        rose = Some(rises);
    }
    top
}
