//! Unbalance: the part of the load that turns with the rotor, and with it where the mass centre is.
//!
//! A mass centre ε beside the axis pulls with ε·Ω². Beyond the cap that looks like a load which nothing can
//! hold, and is none: a rotor left alone circles round its mass centre, and only the slow motion of that leads to
//! the wall. So the observer keeps this part apart, and what is decided in flight is decided for the mass centre,
//! to which the wall is ε nearer.

use crate::border::coeffs::Coeffs;
use crate::border::parts::UNBALANCE;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::{Rotation, Spin};

/// Slowest spin \[1/t₀\]. Slower, a load that turns is a load: the cap has to stop the rotor against it before it
/// has gone round.
const SLOWEST: f32 = 1.25;
/// Share that is learnt of what is left, per radian of the turn. The fewer radians it takes, the more it takes of
/// a load that stands still: this share of it.
const LEARNT: f32 = 1.0 / 16.0;
/// Largest half of the angle by which the observer may be behind what turns, as a tangent.
const MOST_LAG: f32 = 1.5;
/// Squares of the accelerations \[caps²\] from which on it begins to count, less being easily held, or noise, and
/// counts fully. At a step between the two, rounding would decide.
const BEGINS_TO_COUNT: f32 = 0.16;
const COUNTS: f32 = 0.36;

/// The turn in one tick or a few.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn<S> {
    /// Size of the spin \[1/t₀\].
    rate: S,
    /// Cosine and sine of the angle.
    by: Vec2<S>,
    /// Half of the angle by which the observer's load is behind, as a tangent.
    half_behind: S,
}

impl<S: Scalar> Turn<S> {
    /// In so many ticks. `None` where the spin is unknown, slow, or so quick that the observer sees too little of what
    /// turns; or where it is more than a radian, up to which the series are good.
    #[inline]
    pub(crate) fn new(rotation: Rotation<S>, ticks: S, coeffs: &Coeffs<S>) -> Option<Self> {
        let rate = rotation.rate;
        let of_one = rate * coeffs.tick;
        let (angle, half_behind) = (of_one * ticks, of_one * coeffs.observer.flight_lag);
        let seen = half_behind.abs() <= S::from_f32(MOST_LAG) && angle.abs() <= S::ONE;
        let rate = rate.abs();
        let usable = UNBALANCE && seen && rate >= S::from_f32(SLOWEST);
        if !usable || rotation.sense == Spin::Unknown {
            return None;
        }
        Some(Self {
            rate,
            by: Vec2::at_angle(angle),
            half_behind,
        })
    }
}

/// What is known of it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Unbalance<S> {
    /// From the axis to the mass centre, times the size of the spin.
    arm: Vec2<S>,
}

words_of_fields!(Unbalance<S> { arm });

impl<S: Scalar> Unbalance<S> {
    /// Turns it by a tick; its mean acceleration in that.
    #[inline]
    pub(crate) fn carry(&mut self, turn: Option<&Turn<S>>) -> Vec2<S> {
        let Some(turn) = turn else {
            self.arm = Vec2::ZERO;
            return Vec2::ZERO;
        };
        // No rotor can circle round what is beyond the wall; nor round what is no number.
        if self.arm.exceeds(turn.rate) {
            self.arm = Vec2::ZERO;
        }
        let before = self.arm;
        self.arm = before.rotated(turn.by);
        (before + self.arm) * (S::from_f32(0.5) * turn.rate)
    }

    /// Learns from the load that the observer has left, which has to be led by what it is behind.
    #[inline]
    pub(crate) fn learn(&mut self, turn: &Turn<S>, load_step: Vec2<S>) {
        let half = turn.half_behind;
        let lead = Vec2::new(S::ONE - half * half, half + half);
        self.arm = self.arm + load_step.rotated(lead) * S::from_f32(LEARNT);
    }

    /// Forgets, where nothing can be learnt, as fast as it learns: a spin that is measured a little wrong would turn it
    /// anywhere in a long contact.
    #[inline]
    pub(crate) fn fade(&mut self, turn: &Turn<S>) {
        self.arm = self.arm * (S::ONE - turn.by.y.abs() * S::from_f32(LEARNT));
    }

    /// From the axis to the mass centre, and the speed of the one about the other, as far as an acceleration like this
    /// counts. `tilted`: what a plane of a rotor does not see of it, a tick ago.
    #[inline]
    pub(crate) fn counts(
        &self,
        turn: &Turn<S>,
        acceleration: Vec2<S>,
        tilted: Option<Vec2<S>>,
    ) -> Option<[Vec2<S>; 2]> {
        let beyond = acceleration.length_squared() - S::from_f32(BEGINS_TO_COUNT);
        if beyond <= S::ZERO {
            return None;
        }
        let share = (beyond * S::from_f32(1.0 / (COUNTS - BEGINS_TO_COUNT))).min(S::ONE);
        let clockwise = turn.by.y < S::ZERO;
        let sense = if clockwise { -share } else { share };
        let mut arm = self.arm;
        if let Some(tilted) = tilted {
            let whole = arm + tilted.rotated(turn.by);
            if !whole.exceeds(turn.rate) {
                arm = whole;
            }
        }
        Some([arm * share.div(turn.rate), arm.perp() * sense])
    }

    /// From the axis to the mass centre as a plane sees it, times the size of the spin.
    #[inline]
    pub(crate) fn arm(&self) -> Vec2<S> {
        self.arm
    }

    pub(crate) fn forget(&mut self) {
        self.arm = Vec2::ZERO;
    }

    /// After a change of the unit of speed.
    pub(crate) fn rescale(&mut self, speed: S) {
        self.arm = self.arm * speed;
    }
}
