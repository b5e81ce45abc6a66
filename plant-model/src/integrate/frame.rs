//! The frame in which a step of the stiff method is taken.

use crate::V2;

/// A frame that turns with the contact point, and is at rest in axes at the start of a step.
///
/// With its acceleration the contact normal, which turns by α = ω·t + ½·ω̇·t² + O(t³), leaves it with
/// the third power of the step only.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Frame {
    /// At the start \[rad/s\].
    pub(crate) turn_rad_s: f64,
    /// All along \[rad/s²\].
    pub(crate) turn_rad_s2: f64,
}

impl Frame {
    /// By how much it has turned \[rad\].
    fn angle_rad(&self, elapsed_s: f64) -> f64 {
        (self.turn_rad_s + 0.5 * self.turn_rad_s2 * elapsed_s) * elapsed_s
    }

    /// How fast it then turns \[rad/s\].
    pub(crate) fn rate_rad_s(&self, elapsed_s: f64) -> f64 {
        self.turn_rad_s + self.turn_rad_s2 * elapsed_s
    }

    /// What turns vectors of the frame into axes at rest: cosine and sine.
    pub(crate) fn out(&self, elapsed_s: f64) -> V2 {
        let (sin, cos) = self.angle_rad(elapsed_s).sin_cos();
        V2::new(cos, sin)
    }
}

/// The turn the other way round.
pub(crate) fn back(out: V2) -> V2 {
    V2::new(out.x, -out.y)
}
