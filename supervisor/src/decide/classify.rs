//! What kind of contact it is: bounce, continuous backward whirl, forward rub, or held by a load.

use crate::border::coeffs::Coeffs;
use crate::decide::detect::ContactEstimate;
use crate::number::scalar::Scalar;
use crate::number::words::{Words, words_of_fields};
use crate::sense::reading::Rotation;

/// Kind of motion on the retainer bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Class {
    Bounce,
    BackwardWhirl,
    /// Sliding with the spin and at its rate, as unbalance drives it.
    ForwardRub {
        begins: bool,
    },
    Pinned,
}

/// Share of time in contact beyond which it is continuous.
const CONTINUOUS: f32 = 0.6;
/// What the share falls to without contact: a decay to zero passes the subnormal numbers, on which a desktop
/// processor spends a hundred times as long.
const NO_SHARE: f32 = 1e-9;
/// Whirl is faster, rest is slower than these shares of the square of the lift-off speed, which is 1.
const WHIRL_SPEED_SQUARED: f32 = 0.1;
const REST_SPEED_SQUARED: f32 = 0.05;
/// Share of the speed made up by the observer that may be wrong, as masses and forces are configured.
const DOUBT: f32 = 0.25;
/// Rest ends only beyond this share, so that noise does not end it.
const MOVING_SPEED_SQUARED: f32 = 0.2;

/// Turn that a whirl has to make to be one whatever the reading does beside it: runout of a tenth of the clearance seems to go
/// to and fro by 0.2 rad.
const EVIDENT_TURN: f32 = 0.5;

/// Forward rub goes round at the rate of the spin to within this share.
const RUB_RATE_SHARE: f32 = 0.25;

/// Memory of the classifier.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Classifier<S> {
    contact_share: S,
    /// Touching, and too slow for anything but rest. A rotor that turns round near the wall is that for a moment.
    ticks_slow: u32,
    is: Motions,
    /// Angle by which it has gone round without a break in a whirl \[rad\].
    turned: S,
}

words_of_fields!(Classifier<S> { contact_share, ticks_slow, is, turned });

/// Motions that go on as long as their conditions hold, which are wider than those by which they begin.
#[derive(Debug, Clone, Copy, Default)]
struct Motions {
    resting: bool,
    rubbing: bool,
}

/// In one word.
impl Words for Motions {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(u32::from(self.resting) | u32::from(self.rubbing) << 8);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        let [resting, rubbing, ..] = u32::decode(from).to_le_bytes();
        Self {
            resting: resting != 0,
            rubbing: rubbing != 0,
        }
    }
}

impl<S: Scalar> Classifier<S> {
    /// Whether the last tick was one of forward rub.
    pub(crate) fn rubs(&self) -> bool {
        self.is.rubbing
    }

    /// Whether the rotor touches so slowly that it all but rests there.
    pub(crate) fn is_slow(&self) -> bool {
        self.ticks_slow > 0
    }

    /// Whether it has gone round so far that no vibration of the reading looks like it.
    pub(crate) fn has_turned(&self) -> bool {
        self.turned > S::from_f32(EVIDENT_TURN)
    }

    /// The motion is not known any more: a speed that is not known is no rest.
    pub(crate) fn forget(&mut self) {
        self.ticks_slow = 0;
    }

    /// Whether it touches so much of the time that it may be in a whirl.
    #[inline]
    pub(crate) fn is_continuous(&self) -> bool {
        self.contact_share > S::from_f32(CONTINUOUS)
    }

    /// A sample shows contact all of this tick, or none.
    #[inline]
    fn share(&mut self, now: S, coeffs: &Coeffs<S>) {
        self.contact_share =
            self.contact_share + coeffs.contact_share_step * (now - self.contact_share);
    }

    /// A sample shows a rotor that flies, and has not touched for long.
    #[inline]
    pub(crate) fn flies(&mut self, coeffs: &Coeffs<S>) {
        self.share(S::from_f32(NO_SHARE), coeffs);
        *self = Self {
            contact_share: self.contact_share,
            ..Self::default()
        };
    }

    /// `seen`: by a sample of this tick; `blind_speed`: speed outwards that the observer has from being blind for the wall's
    /// force.
    #[inline]
    pub(crate) fn classify(
        &mut self,
        contact: &ContactEstimate<S>,
        seen: bool,
        blind_speed: impl FnOnce() -> S,
        rotation: Rotation<S>,
        coeffs: &Coeffs<S>,
    ) -> Class {
        let now = if contact.touching {
            S::ONE
        } else {
            S::from_f32(NO_SHARE)
        };
        if seen {
            self.share(now, coeffs);
        }
        let along = contact.tangential_speed;
        let along_square = along * along;
        if contact.touching {
            let blind_speed = blind_speed();
            let across =
                (contact.radial_speed - blind_speed).beyond(blind_speed.abs() * S::from_f32(DOUBT));
            let square = along_square + across * across;
            self.ticks_slow = if square < S::from_f32(REST_SPEED_SQUARED) {
                self.ticks_slow.saturating_add(1)
            } else {
                0
            };
            self.is.resting = if self.is.resting {
                square < S::from_f32(MOVING_SPEED_SQUARED)
            } else {
                self.ticks_slow > coeffs.whirl_ticks
            };
        } else {
            (self.ticks_slow, self.is.resting) = (0, false);
        }
        let before = core::mem::take(&mut self.is.rubbing);
        let turned = core::mem::replace(&mut self.turned, S::ZERO);
        let slow = if before {
            REST_SPEED_SQUARED
        } else {
            WHIRL_SPEED_SQUARED
        };
        let sliding = !self.is.resting && self.is_continuous() && along_square > S::from_f32(slow);
        if !sliding {
            return if self.is.resting {
                Class::Pinned
            } else {
                Class::Bounce
            };
        }
        // With unknown spin every whirl counts as backward: friction will make it so.
        if rotation.sense.backward(along) >= S::ZERO {
            let most = S::from_f32(EVIDENT_TURN * 2.0);
            self.turned = (turned + along.abs() * contact.per_radius * coeffs.tick).min(most);
            return Class::BackwardWhirl;
        }
        // By the radius that there is: a soft wall gives way. What began stays until it slows or turns.
        let orbit = along * contact.per_radius;
        let at_its_rate =
            (orbit - rotation.rate).abs() <= rotation.rate.abs() * S::from_f32(RUB_RATE_SHARE);
        self.is.rubbing = before || (contact.touching && at_its_rate);
        if self.is.rubbing {
            Class::ForwardRub { begins: !before }
        } else {
            Class::Bounce
        }
    }
}
