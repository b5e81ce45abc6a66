//! The one state machine, and the only writer of [`Mode`] and of the events that belong to it.
//!
//! ```text
//!   Levitated ──unavoidable──► Approach ──touch──► Bounce ◄──► BackwardWhirl
//!       ▲  └───────────touch──────┼─────────────────▲ ▲ └────► Pinned ──left──► Bounce
//!       └──blended── Handover ◄───┴──calm for dwell─┘ │
//!                        └──────touch, unavoidable────┘          any ◄──► SensorFault
//! ```

use crate::border::coeffs::Coeffs;
use crate::border::signal::{Events, Mode};
use crate::decide::classify::Class;
use crate::decide::detect::ContactEstimate;
use crate::number::scalar::Scalar;
use crate::number::words::Words;
use crate::sense::reading::SampleFlags;

/// Of the whirl limit: a whirl that levitation is left to, where it keeps the rotor.
const DANGEROUS: f32 = 0.5;

/// What the next phase depends on beside the contact and its class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Verdict {
    /// Contact can be avoided.
    pub(crate) calm: bool,
    /// The levitation controller would do so.
    pub(crate) ready: bool,
    /// The noise leaves a speed to be seen.
    pub(crate) quiet: bool,
    /// The reading may be acted on.
    pub(crate) trusted: bool,
    /// The supervisor has acted on the rotor, which has not settled since: a touch is its affair, however the reading moves.
    pub(crate) unsettled: bool,
    /// A whirl has gone round far enough to be none of the reading alone.
    pub(crate) has_turned: bool,
    /// It touches most of the time.
    pub(crate) touches_on: bool,
    /// A forward rub has gone on for windows, at one spin.
    pub(crate) rubs_on: bool,
    /// The bearing has to be handed back, for so many ticks.
    pub(crate) hands_back: Option<u32>,
    /// Levitation keeps the rotor, also on the wall, and the supervisor acts on backward whirl alone.
    pub(crate) whirl_only: bool,
    /// What comes, or is there, is so slow that it can be left to a levitation controller that has force to spare.
    pub(crate) harmless: bool,
}

impl Verdict {
    /// Where what the reading usually does is too fast, a contact that goes on all the time still says what it is.
    #[inline(always)]
    fn is_evident(&self, class: Class) -> bool {
        match class {
            Class::BackwardWhirl => self.has_turned,
            Class::ForwardRub { .. } => self.rubs_on,
            _ => false,
        }
    }
}

/// A mode with the memory that belongs to it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Phase<S> {
    /// The levitation controller has the bearing.
    #[default]
    Levitated,
    /// Contact is coming. `calm_ticks`: since when it could be avoided after all.
    Approach { calm_ticks: u32 },
    /// Between and during short contacts.
    Bounce { calm_ticks: u32 },
    /// Sliding around the clearance without leaving it.
    BackwardWhirl,
    /// Lying on the bearing. `hold`: inward force \[caps\], the more the longer it lies there.
    Pinned { hold: S },
    /// The levitation controller's share grows from 0 to 1.
    Handover { weight: S },
    /// Without a position: `bouncing` or in lasting contact when it was lost.
    SensorFault { bouncing: bool },
    /// The levitation controller has the bearing for so many more ticks, whatever the rotor does.
    HandedBack { left: u32 },
}

/// Always as many: its number, ticks, and a share.
impl<S: Scalar> Words for Phase<S> {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        let (ticks, share) = match *self {
            Self::Approach { calm_ticks } | Self::Bounce { calm_ticks } => (calm_ticks, S::ZERO),
            Self::HandedBack { left } => (left, S::ZERO),
            Self::SensorFault { bouncing } => (u32::from(bouncing), S::ZERO),
            Self::Pinned { hold } => (0, hold),
            Self::Handover { weight } => (0, weight),
            Self::Levitated | Self::BackwardWhirl => (0, S::ZERO),
        };
        to(self.mode() as u32);
        to(ticks);
        share.encode(to);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        let (mode, ticks, share) = (u32::decode(from), u32::decode(from), S::decode(from));
        match mode {
            1 => Self::Approach { calm_ticks: ticks },
            2 => Self::Bounce { calm_ticks: ticks },
            3 => Self::BackwardWhirl,
            4 => Self::Pinned { hold: share },
            5 => Self::Handover { weight: share },
            6 => Self::SensorFault {
                bouncing: ticks != 0,
            },
            7 => Self::HandedBack { left: ticks },
            _ => Self::Levitated,
        }
    }
    #[inline]
    fn word_count(&self) -> u32 {
        2 + S::ZERO.word_count()
    }
}

impl<S: Scalar> Phase<S> {
    pub(crate) fn mode(self) -> Mode {
        match self {
            Self::Levitated => Mode::Levitated,
            Self::Approach { .. } => Mode::Approach,
            Self::Bounce { .. } => Mode::Bounce,
            Self::BackwardWhirl => Mode::BackwardWhirl,
            Self::Pinned { .. } => Mode::Pinned,
            Self::Handover { .. } => Mode::Handover,
            Self::SensorFault { .. } => Mode::SensorFault,
            Self::HandedBack { .. } => Mode::HandedBack,
        }
    }

    /// Whether it has waited for the controller for so long that it has to be asked what it wants.
    #[inline]
    pub(crate) fn has_waited(self, coeffs: &Coeffs<S>) -> bool {
        let most = coeffs.dwell_ticks + coeffs.patience_ticks;
        matches!(self, Self::Approach { calm_ticks } if calm_ticks >= most)
    }

    #[inline]
    pub(crate) fn is_engaged(self) -> bool {
        !matches!(self, Self::Levitated | Self::HandedBack { .. })
    }

    /// The phase of this tick, and what changed.
    #[inline]
    pub(crate) fn next(
        self,
        contact: &ContactEstimate<S>,
        verdict: &Verdict,
        class: Class,
        flags: SampleFlags,
        coeffs: &Coeffs<S>,
    ) -> (Self, Events) {
        let next = match verdict.hands_back {
            _ if !flags.contains(SampleFlags::ON) => Self::Levitated,
            Some(left) => Self::HandedBack { left },
            None => self.follow(contact, verdict, class, flags, coeffs),
        };
        let mut events = Events::empty();
        if contact.touched {
            events |= Events::TOUCHED;
        }
        if contact.left {
            events |= Events::LIFTED_OFF;
        }
        if class == (Class::ForwardRub { begins: true }) {
            events |= Events::FORWARD_RUB;
        }
        if next.mode() != self.mode() {
            events |= match next {
                Self::Levitated => Events::LEVITATED,
                Self::BackwardWhirl => Events::WHIRL,
                Self::Pinned { .. } => Events::PINNED,
                Self::Handover { .. } => Events::HANDOVER,
                Self::HandedBack { .. } => Events::HANDED_BACK,
                _ => Events::empty(),
            };
            if self == Self::Levitated {
                events |= Events::ENGAGED;
            }
        }
        (next, events)
    }

    /// Inward force on a rotor at rest on the wall at this tick: what pressed it there, and where that does not lift it off
    /// more and more, up to the whole cap.
    fn hold(self, load: S, coeffs: &Coeffs<S>) -> S {
        match self {
            Self::Pinned { hold } => hold + (S::JUST_BELOW_ONE - hold) * coeffs.blend_step,
            _ => load.clamp(coeffs.hold_share, S::JUST_BELOW_ONE),
        }
    }

    #[inline]
    fn follow(
        self,
        contact: &ContactEstimate<S>,
        verdict: &Verdict,
        class: Class,
        flags: SampleFlags,
        coeffs: &Coeffs<S>,
    ) -> Self {
        if let Self::HandedBack { left } = self {
            return match left.checked_sub(1) {
                Some(left) => Self::HandedBack { left },
                None => Self::Levitated,
            };
        }
        let faulty = flags.contains(SampleFlags::FAULTY);
        // Most ticks: whatever is judged, such a rotor goes on levitating.
        if self == Self::Levitated && !faulty && !contact.touching && !contact.unavoidable {
            return self;
        }
        let new_bounce = Self::Bounce { calm_ticks: 0 };
        if faulty {
            let bouncing = match self {
                Self::SensorFault { bouncing } => bouncing,
                Self::Bounce { .. } | Self::BackwardWhirl | Self::Pinned { .. } => true,
                _ => false,
            };
            return Self::SensorFault { bouncing };
        }
        if verdict.whirl_only {
            return self.follow_whirl_alone(contact, *verdict, class, coeffs);
        }
        let evident =
            contact.touching && (verdict.unsettled || (verdict.quiet && verdict.is_evident(class)));
        // What a load that turns takes round on the wall would only be thrown about.
        let rides = contact.touching
            && verdict.touches_on
            && matches!(class, Class::Bounce | Class::ForwardRub { .. });
        let left_alone = !evident && (verdict.harmless || rides);
        if self == Self::Levitated && (left_alone || (!evident && !verdict.trusted)) {
            return self;
        }
        if contact.touching {
            if let Self::Handover { weight } = self
                && left_alone
            {
                return Self::blended(weight, coeffs);
            }
            return match class {
                Class::Bounce | Class::ForwardRub { .. } => new_bounce,
                Class::BackwardWhirl => Self::BackwardWhirl,
                Class::Pinned => Self::Pinned {
                    hold: self.hold(contact.load, coeffs),
                },
            };
        }
        match self {
            Self::Levitated if contact.unavoidable => Self::Approach { calm_ticks: 0 },
            Self::Levitated => self,
            // Nothing has happened but in a reading that is not believed any more.
            Self::Approach { .. } if !verdict.trusted => Self::Levitated,
            Self::Approach { calm_ticks } => match after_calm(calm_ticks, verdict, coeffs) {
                Some(calm_ticks) => Self::Approach { calm_ticks },
                None => Self::Handover { weight: S::ZERO },
            },
            Self::Bounce { calm_ticks } => match after_calm(calm_ticks, verdict, coeffs) {
                Some(calm_ticks) => Self::Bounce { calm_ticks },
                None => Self::Handover { weight: S::ZERO },
            },
            Self::BackwardWhirl if class == Class::BackwardWhirl => self,
            Self::SensorFault { bouncing: false } => Self::Approach { calm_ticks: 0 },
            Self::BackwardWhirl | Self::Pinned { .. } | Self::SensorFault { .. } => new_bounce,
            Self::HandedBack { .. } => self,
            Self::Handover { .. } if contact.unavoidable && !verdict.harmless => {
                Self::Approach { calm_ticks: 0 }
            }
            Self::Handover { weight } => Self::blended(weight, coeffs),
        }
    }

    /// The same where levitation keeps the rotor: whatever is no backward whirl on the wall is blended over to it.
    fn follow_whirl_alone(
        self,
        contact: &ContactEstimate<S>,
        verdict: Verdict,
        class: Class,
        coeffs: &Coeffs<S>,
    ) -> Self {
        match self {
            Self::BackwardWhirl if class == Class::BackwardWhirl => self,
            _ if class == Class::BackwardWhirl
                && contact.touching
                && verdict.quiet
                && verdict.has_turned
                && contact.tangential_speed.abs() * coeffs.per_whirl_limit
                    > S::from_f32(DANGEROUS) =>
            {
                Self::BackwardWhirl
            }
            Self::Levitated | Self::HandedBack { .. } => self,
            Self::Handover { weight } => Self::blended(weight, coeffs),
            _ => Self::Handover { weight: S::ZERO },
        }
    }

    /// A tick of hand-over.
    fn blended(weight: S, coeffs: &Coeffs<S>) -> Self {
        let weight = weight + coeffs.blend_step;
        if weight < S::ONE {
            Self::Handover { weight }
        } else {
            Self::Levitated
        }
    }
}

/// Calm ticks so far, or `None` once they are enough and the controller is ready.
fn after_calm<S: Scalar>(calm_ticks: u32, verdict: &Verdict, coeffs: &Coeffs<S>) -> Option<u32> {
    if !verdict.calm {
        Some(0)
    } else if calm_ticks < coeffs.dwell_ticks {
        Some(calm_ticks + 1)
    } else if verdict.ready {
        None
    } else if calm_ticks < coeffs.dwell_ticks + coeffs.patience_ticks {
        Some(calm_ticks + 1)
    } else {
        // It has come nearer.
        Some(coeffs.dwell_ticks)
    }
}
