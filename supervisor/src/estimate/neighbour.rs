//! What a plane knows of the rest of its rotor: forces elsewhere, and the tilt that the spin turns.

use crate::border::coeffs::Coeffs;
use crate::estimate::observer::Motion;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;

/// What a plane tells the other one of its rotor, as it is before a tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneState<S: Scalar> {
    /// Of the axis, where it is known.
    pub(crate) velocity: Option<Vec2<S>>,
    /// The force that acts there \[caps\].
    pub(crate) force: Vec2<S>,
    /// As in [`crate::estimate::unbalance::Unbalance`].
    pub(crate) unbalance: Vec2<S>,
    /// The supervisor has acted there, and no window has passed in peace since.
    pub(crate) unsettled: bool,
}

/// A plane's neighbourhood: nothing for one that stands alone, which then costs nothing.
pub(crate) trait Neighbour<S: Scalar> {
    /// Of a rotor with tilt.
    #[inline]
    fn coupling(&self) -> Option<&RotorCoupling<S>> {
        None
    }
}

impl<S: Scalar> Neighbour<S> for () {}

/// A rotor's tilt as a plane sees it, per unit of the plane.
///
/// Without forces the tilt's part w of a plane's velocity turns with the nutation, ν = (I_p/I_t)·Ω: ẇ = ν·ẑ×w. Then the plane
/// goes round a centre that moves with the rest of the velocity, at the distance |w|/ν.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RotorCoupling<S: Scalar> {
    /// Acceleration by known forces elsewhere.
    pub(crate) known: Vec2<S>,
    /// w.
    pub(crate) velocity: Vec2<S>,
    /// ν; 0 where it turns by more than a radian in a tick, of which samples show nothing.
    pub(crate) rate: S,
    /// It does.
    pub(crate) too_fast: bool,
    /// What the unbalance of the tilt is more than it seems to a plane: beside a principal axis that is inclined the axis
    /// goes round by all of its angle τ, but nutation turns that as well, so that what is left to pull is (1 − I_p/I_t)·τ.
    pub(crate) unbalance: Vec2<S>,
    /// Since the supervisor acted at one end, one or the other has not been left in peace.
    pub(crate) unsettled: bool,
}

/// Farthest turn of the nutation, from a decision until its force acts, that a lead makes up for \[rad\].
const MOST_TURN: f32 = 1.25;
/// Most of a lead \[rad\]. It turns all of the tilt's velocity, precession with it, whose damping falls with the cosine of
/// the lead as that of nutation does with the cosine of what the lead leaves: half of [`MOST_TURN`], and both are alike there.
const MOST_LEAD: f32 = 0.6;
/// Slower than this nutation is none \[1/t₀\]: within the time of an approach it does not turn.
const LEAST_RATE: f32 = 0.25;

impl<S: Scalar> Neighbour<S> for RotorCoupling<S> {
    #[inline]
    fn coupling(&self) -> Option<&Self> {
        Some(self)
    }
}

impl<S: Scalar> RotorCoupling<S> {
    /// By what w changes with an angle.
    #[inline]
    fn turned(&self, angle: S) -> Vec2<S> {
        self.velocity.rotated(Vec2::at_angle(angle)) - self.velocity
    }

    /// Speed gained in a tick.
    #[inline]
    pub(crate) fn gained(&self, tick: S) -> Vec2<S> {
        self.known * tick + self.turned(self.rate * tick)
    }

    /// Whether a force that is decided now acts before nutation has turned too far.
    #[inline]
    pub(crate) fn is_in_time(&self, coeffs: &Coeffs<S>) -> bool {
        !self.too_fast && (self.rate * coeffs.horizon).abs() <= S::from_f32(MOST_TURN)
    }

    /// The motion with the velocity that it has when a force that is decided now acts, as far as a lead goes.
    #[inline]
    pub(crate) fn ahead(&self, motion: &Motion<S>, coeffs: &Coeffs<S>) -> Motion<S> {
        let lead = (self.rate * coeffs.horizon).within(S::from_f32(MOST_LEAD));
        Motion {
            velocity: motion.velocity + self.turned(lead),
            // Here it is a load like any other.
            load_step: motion.load_step + self.known * coeffs.tick,
            ..*motion
        }
    }

    /// The centre that the plane goes round, its velocity, and the distance from it; `None` where nutation is slow.
    #[inline]
    pub(crate) fn centre(&self, motion: &Motion<S>) -> Option<(Vec2<S>, Vec2<S>, S)> {
        if self.rate.abs() < S::from_f32(LEAST_RATE) {
            return None;
        }
        let per_rate = S::ONE.div(self.rate);
        let arm = self.velocity.perp() * per_rate;
        Some((
            motion.position + arm,
            motion.velocity - self.velocity,
            arm.about_length(),
        ))
    }
}
