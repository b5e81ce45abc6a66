//! Vectors in the plane, and their turns.

/// A vector in the plane.
pub type V2 = nalgebra::Vector2<f64>;

/// A quarter turn counter-clockwise.
#[inline]
pub(crate) fn perp(v: V2) -> V2 {
    V2::new(-v.y, v.x)
}

/// A turn counter-clockwise; `turn` holds cosine and sine of the angle.
#[inline]
pub(crate) fn rotate(v: V2, turn: V2) -> V2 {
    V2::new(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y)
}

/// A mass that moves in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Body {
    /// Position \[m\].
    pub position: V2,
    /// Velocity \[m/s\].
    pub velocity: V2,
}
