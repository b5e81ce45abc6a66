//! Which way the rotor spins, and with it which whirl is backward.

use crate::scalar::Scalar;
use crate::signal::{CoreSample, Status};

/// Sense of the spin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spin {
    /// Unknown also where it is zero.
    Unknown,
    Counterclockwise,
    Clockwise,
}

impl Spin {
    /// What a sample says of it.
    #[inline]
    pub(crate) fn from_sample<S: Scalar>(sample: &CoreSample<S>) -> Self {
        let known = sample.status.contains(Status::SPIN_VALID) && sample.spin.is_finite();
        if known && sample.spin > S::ZERO {
            Self::Counterclockwise
        } else if known && sample.spin < S::ZERO {
            Self::Clockwise
        } else {
            Self::Unknown
        }
    }

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
