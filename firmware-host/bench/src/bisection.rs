//! Where a condition turns, between numbers that differ by powers of ten.

/// Narrows a bracket of where `below` turns from true to false, by its logarithm, until its ends differ by at most this share.
pub(crate) fn by_logarithm(
    (mut low, mut high): (f64, f64),
    share: f64,
    below: impl Fn(f64) -> bool,
) -> (f64, f64) {
    while high > low * (1.0 + share) {
        let middle = (low * high).sqrt();
        if below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, high)
}
