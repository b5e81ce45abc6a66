//! To which order a power series is worth carrying on.

/// Below this order the last two terms say too little about the rest.
pub(crate) const LOWEST_ORDER: usize = 6;

/// Whether the series reaches to the end of the span, asked from order to order: its last two terms there are
/// small, by a margin as to the distance.
pub(crate) struct Enough {
    /// Square of the end's θ over the margin, and its power for the next order.
    square: f64,
    power: f64,
    before: bool,
}

impl Enough {
    /// Terms that go on falling so leave one tolerance beyond the lowest order, less beyond a higher one.
    const MARGIN: f64 = 0.8;

    pub(crate) fn new(end_theta: f64) -> Self {
        let square = (end_theta / Self::MARGIN).powi(2);
        Self {
            square,
            power: square.powi(LOWEST_ORDER as i32 - 1),
            before: false,
        }
    }

    /// Takes the next order's coefficients in, by their weighed square; the first are those below
    /// [`LOWEST_ORDER`].
    pub(crate) fn with(&mut self, coefficients: f64) -> bool {
        let small = coefficients * self.power <= 1.0;
        self.power *= self.square;
        std::mem::replace(&mut self.before, small) && small
    }
}
