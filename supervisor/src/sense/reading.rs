//! Which way the rotor spins, and with it which whirl is backward.
//!
//! What is known of a sample once the guard has judged it.

use crate::border::signal::{CoreSample, Events, RejectReason, Status};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::Words;

/// Sense of the spin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spin {
    /// Unknown also where it is zero.
    Unknown,
    Counterclockwise,
    Clockwise,
}

/// The spin as a sample says it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rotation<S> {
    pub(crate) sense: Spin,
    /// Counter-clockwise \[1/t₀\]; anything where the sense is unknown.
    pub(crate) rate: S,
}

impl<S: Scalar> Rotation<S> {
    #[inline]
    pub(crate) fn from_sample(sample: &CoreSample<S>) -> Self {
        let rate = sample.spin;
        let known = sample.status.contains(Status::SPIN_VALID) && rate.is_finite();
        let sense = if known && rate > S::ZERO {
            Spin::Counterclockwise
        } else if known && rate < S::ZERO {
            Spin::Clockwise
        } else {
            Spin::Unknown
        };
        Self { sense, rate }
    }
}

impl Spin {
    /// A counter-clockwise speed counted against the spin; with unknown spin every whirl counts, for
    /// friction will drive it.
    #[inline]
    pub(crate) fn backward<S: Scalar>(self, along: S) -> S {
        match self {
            Self::Counterclockwise => -along,
            Self::Clockwise => along,
            Self::Unknown => along.abs(),
        }
    }

    /// Sense of backward where a rotor moves along the wall, +1 counter-clockwise: against the surface speed
    /// of the spin, or, with unknown spin, along the whirl that is there.
    #[inline]
    pub(crate) fn sense_of_backward<S: Scalar>(self, along: S) -> S {
        let counterclockwise = match self {
            Self::Counterclockwise => false,
            Self::Clockwise => true,
            Self::Unknown => along > S::ZERO,
        };
        if counterclockwise { S::ONE } else { -S::ONE }
    }
}

bitflags::bitflags! {
    /// What the guard has found, in one register. Bits that a [`Status`] says have their place in it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(crate) struct SampleFlags: u16 {
        /// The sample may be used; else the observer runs on its model.
        const USED = 1;
        /// The bearing may act.
        const ON = Status::BEARING_ON.bits() as u16;
        /// Position has been implausible for too long.
        const FAULTY = 1 << 2;
        /// Nothing can act along x, along y.
        const X_LOST = Status::AXIS_X_LOST.bits() as u16;
        const Y_LOST = Status::AXIS_Y_LOST.bits() as u16;
        /// The last command came too late.
        const LATE = Status::LATE.bits() as u16;
        /// The applied force is measured and believed.
        const MEASURED = 1 << 11;
        /// The supervisor only watches.
        const SHADOW = Status::SHADOW.bits() as u16;
        /// The observer has to start anew.
        const ANEW = 1 << 7;
        /// Ticks were missed.
        const MISSED = 1 << 8;
        /// During a fault: the coordinate x, y cannot be trusted.
        const X_BAD = 1 << 9;
        const Y_BAD = 1 << 10;
        const BOTH_BAD = Self::X_BAD.bits() | Self::Y_BAD.bits();
        const LOST = Self::X_LOST.bits() | Self::Y_LOST.bits();
        /// What a status says.
        const SAID = Self::ON.bits() | Self::SHADOW.bits() | Self::LOST.bits() | Self::LATE.bits();
        /// What the observer has to know before the tick.
        const UNUSUAL = Self::FAULTY.bits() | Self::ANEW.bits() | Self::LATE.bits() | Self::MISSED.bits();
    }
}

impl Words for SampleFlags {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        self.bits().encode(to);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        Self::from_bits_truncate(u16::decode(from))
    }
}

impl SampleFlags {
    /// What the flags of a sample are of which nothing is to be said, among those that say something.
    pub(crate) const AT_EASE: (Self, Self) = {
        let usual = Self::USED.union(Self::ON);
        (
            usual,
            usual
                .union(Self::UNUSUAL)
                .union(Self::LOST)
                .union(Self::SHADOW),
        )
    };

    /// What the status says.
    #[inline]
    pub(crate) fn from_status(status: Status) -> Self {
        Self::from_bits_truncate(status.bits() as u16) & Self::SAID
    }

    /// Whether an axis is lost.
    #[inline]
    pub(crate) fn has_lost(self) -> bool {
        self.intersects(Self::LOST)
    }

    /// The part of a force that the axes can carry.
    #[inline]
    pub(crate) fn carried<S: Scalar>(self, force: Vec2<S>) -> Vec2<S> {
        if !self.has_lost() {
            return force;
        }
        let on = |lost: Self, force: S| {
            if self.contains(lost) { S::ZERO } else { force }
        };
        Vec2::new(on(Self::X_LOST, force.x), on(Self::Y_LOST, force.y))
    }

    /// The axes that are lost by the status, and not because they do not track.
    #[inline]
    pub(crate) fn known(self, status: Status) -> Self {
        self - (Self::LOST - Self::from_status(status))
    }

    /// A force along the coordinates that a fault of the sensor leaves, another one along those that are bad.
    #[inline]
    pub(crate) fn sensed<S: Scalar>(self, good: Vec2<S>, bad: Vec2<S>) -> Vec2<S> {
        let on = |flag: Self, good: S, bad: S| if self.contains(flag) { bad } else { good };
        Vec2::new(
            on(Self::X_BAD, good.x, bad.x),
            on(Self::Y_BAD, good.y, bad.y),
        )
    }
}

/// What is known of the actuator at this tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Actuator<S> {
    pub(crate) axes: SampleFlags,
    measured: Vec2<S>,
}

impl<S: Scalar> Actuator<S> {
    /// Measured force at this instant \[caps\].
    #[inline]
    pub(crate) fn applied(&self) -> Option<Vec2<S>> {
        (self.axes.contains(SampleFlags::MEASURED)).then_some(self.measured)
    }

    /// What acts of a commanded force: what is measured, or all that is commanded, or nothing while the bearing is off.
    #[inline]
    pub(crate) fn acting(&self, commanded: Vec2<S>) -> Vec2<S> {
        match self.applied() {
            Some(measured) => measured,
            None if self.axes.contains(SampleFlags::ON) => commanded,
            None => Vec2::ZERO,
        }
    }

    /// The part of a force that the axes can carry.
    #[inline]
    pub(crate) fn carried(&self, force: Vec2<S>) -> Vec2<S> {
        self.axes.carried(force)
    }
}

/// What the guard says of a sample.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SampleAssessment {
    pub(crate) events: Events,
    pub(crate) flags: SampleFlags,
    pub(crate) refusal: RejectReason,
    /// Ticks since the last call that the observer has to make up for.
    pub(crate) missed: u8,
}

/// A sample after judgement, per unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reading<S> {
    pub(crate) assessment: SampleAssessment,
    pub(crate) sample: Vec2<S>,
    pub(crate) measured: Vec2<S>,
    pub(crate) rotation: Rotation<S>,
}

impl<S: Scalar> Reading<S> {
    /// `None`: not to be used; the observer runs on its model.
    #[inline]
    pub(crate) fn position(&self) -> Option<Vec2<S>> {
        (self.assessment.flags.contains(SampleFlags::USED)).then_some(self.sample)
    }

    #[inline]
    pub(crate) fn actuator(&self) -> Actuator<S> {
        Actuator {
            axes: self.assessment.flags,
            measured: self.measured,
        }
    }
}

impl Default for SampleFlags {
    fn default() -> Self {
        Self::empty()
    }
}
