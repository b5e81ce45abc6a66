//! Where a condition turns, to the last bit.

/// Narrows a bracket of where `below` turns from true to false to two neighbouring numbers; as it is where its middle is no
/// number, or it is none.
pub(crate) fn bracket((mut low, mut high): (f64, f64), below: impl Fn(f64) -> bool) -> (f64, f64) {
    loop {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            return (low, high);
        }
        if below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}
