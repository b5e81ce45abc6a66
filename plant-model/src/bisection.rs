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

/// [`try_bracket`] with a condition that can always be told.
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
