//! Where the rotor is going: its speed, and the next impact at the end of a straight path.

use crate::estimate::Motion;
use crate::scalar::Scalar;
use crate::vec2::Vec2;

/// Speed, with its square and its inverse.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Speed<S> {
    /// v²; over that of the lift-off speed, which is 1.
    pub(crate) square: S,
    /// 1/v; 0 for a rotor without speed.
    pub(crate) inverse: S,
}

impl<S: Scalar> Speed<S> {
    #[inline]
    pub(crate) fn new(velocity: Vec2<S>) -> Self {
        let (square, inverse) = (velocity.length_squared(), velocity.inverse_length());
        Self { square, inverse }
    }

    /// Its size. Not kept: a product costs less than a place on the stack.
    #[inline]
    pub(crate) fn value(&self) -> S {
        self.square * self.inverse
    }
}

/// Where a straight flight meets the clearance circle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Impact<S> {
    /// Until then.
    pub(crate) time: S,
    pub(crate) normal: Vec2<S>,
    /// Normal and counter-clockwise tangential speed there.
    pub(crate) normal_speed: S,
    pub(crate) along: S,
}

impl<S: Scalar> Impact<S> {
    /// `None` for a rotor without speed, or beyond the wall.
    #[inline]
    pub(crate) fn ahead(motion: &Motion<S>, radius: S, speed: &Speed<S>) -> Option<Self> {
        let room = (S::ONE - radius) * (S::ONE + radius);
        if speed.inverse <= S::ZERO || room <= S::ZERO {
            return None;
        }
        let heading = motion.velocity * speed.inverse;
        let along = motion.position.dot(heading);
        let cosine = (along * along + room).sqrt();
        let chord = cosine - along;
        Some(Self {
            time: chord * speed.inverse,
            normal: motion.position + heading * chord,
            normal_speed: speed.value() * cosine,
            along: motion.position.perp().dot(motion.velocity),
        })
    }
}

/// Backward speed after all the impacts to come, v_b + K·v_n.
#[inline]
pub(crate) fn sum_of_impacts<S: Scalar>(backward: S, normal_speed: S, gain: S) -> S {
    backward + gain * normal_speed
}
