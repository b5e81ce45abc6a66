//! The judge of the model: what the rotor seems to do all the time is no approach, and an engagement that makes no progress
//! is given up.
//!
//! Time is looked at in windows of [`Coeffs::window_ticks`]. A window that ends levitated says how fast the reading usually
//! moves, whatever moves it: runout, bending, nutation, noise, an orbit. One that ends engaged says whether the engagement
//! comes farther.

use crate::border::coeffs::Coeffs;
use crate::border::signal::Status;
use crate::decide::phase::Phase;
use crate::number::scalar::Scalar;
use crate::number::words::{Words, words_of_fields};

/// Speeds up to here are no sign of anything: what configured noise and slow motion come to \[lift-off speeds\].
const ORDINARY: f32 = 0.2;
/// So much above the usual an outward speed has to be to count.
const MARGIN: f32 = 1.25;
/// With a usual speed above this the law would follow what is no motion of the rotor.
const UNTRUSTED_FROM: f32 = 0.4;
/// A square of the speed below which an engagement is no bouncing: it holds the rotor.
const QUIET_SQUARE: f32 = 0.1;
/// A square of the speed that has fallen to this share of the lowest before is progress.
const PROGRESS: f32 = 0.7;
/// What a window adds to the fault_score of an engagement: one of bouncing on, one without a position, one of a forward rub, which breaks
/// within some turns or not at all, one that makes progress, one in which the rotor is held. One of a rotor in flight that makes
/// none makes all of it: nothing but the supervisor moves it.
const SCORE_BOUNCING: u16 = 1024;
const SCORE_BLIND: u16 = 256;
const SCORE_RUBBING: u16 = 256;
const SCORE_PROGRESS: u16 = 32;
const SCORE_HELD: u16 = 2;
/// What breaking a forward rub that goes on adds, however soon it is over.
const SCORE_TRY: u16 = 2048;
/// What a levitated window in which nothing touches takes from it.
const FORGIVEN: u16 = 128;
/// The fault_score at which the bearing is handed back …
const HANDS_BACK_AT: u16 = 4096;
/// … and what is left of it for the next try.
const LEFT_AFTER: u16 = 2048;
/// Windows for which it stays handed back at first, and how often that doubles.
const HANDED_BACK_WINDOWS: u32 = 8;
const MOST_DOUBLED: u8 = 7;

/// What the judge sees of a tick.
#[derive(Clone, Copy)]
pub(crate) struct Seen<S> {
    pub(crate) speed_square: S,
    /// The wall is away.
    pub(crate) flies: bool,
    pub(crate) phase: Phase<S>,
    /// Forward, as unbalance drives it.
    pub(crate) rubs: bool,
    pub(crate) spin: S,
    pub(crate) status: Status,
}

/// What the judge remembers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Trust<S> {
    /// Largest square of the speed in this window.
    peak: S,
    /// Fastest in the last window; while a forward rub lasts, which teaches no speed, the size of the spin.
    before: S,
    /// Speed that an approach has to exceed, by what the reading usually does.
    pub(crate) margin: S,
    /// Lowest peak of this engagement.
    lowest: S,
    ticks_left: u16,
    disturbance: Disturbance,
    fault_score: u16,
    doubled: u8,
    pub(crate) handed_back: u16,
}

words_of_fields!(Trust<S> { peak, before, margin, lowest, ticks_left, disturbance, fault_score, doubled, handed_back });

/// What the wall and the supervisor do to the rotor, beside what it does by itself.
#[derive(Debug, Clone, Copy, Default)]
struct Disturbance {
    /// In this window they have moved it: not, or 1 and so many levitated windows more that a forward rub has lasted at one
    /// spin.
    windows: u8,
    /// Of a plane of a rotor: since the supervisor acted no levitated window has passed in which they have not.
    unsettled: bool,
    /// In this window the wall has.
    touched: bool,
    /// What has been seen of how the reading moves by itself.
    proof: Proof,
}

/// Whether the reading has been seen in peace for a window: before that nobody knows what is usual.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(u8)]
enum Proof {
    /// There was no sample.
    #[default]
    Nothing = 0,
    /// The first window is not over, or there was no peace in it.
    Begun = 1,
    Seen = 2,
}

/// In one word, so that records keep their length.
impl Words for Disturbance {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(u32::from(self.windows)
            | u32::from(self.unsettled) << 8
            | u32::from(self.touched) << 16
            | (self.proof as u32) << 24);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        let [windows, unsettled, touched, proof] = u32::decode(from).to_le_bytes();
        Self {
            windows,
            unsettled: unsettled != 0,
            touched: touched != 0,
            proof: match proof {
                0 => Proof::Nothing,
                1 => Proof::Begun,
                _ => Proof::Seen,
            },
        }
    }
}

impl<S: Scalar> Default for Trust<S> {
    fn default() -> Self {
        Self {
            peak: S::ZERO,
            // What has not been seen is not trusted.
            before: S::from_f32(UNSEEN),
            margin: S::from_f32(UNSEEN),
            lowest: S::from_f32(MOST_SQUARE),
            ticks_left: 0,
            disturbance: Disturbance::default(),
            fault_score: 0,
            doubled: 0,
            handed_back: 0,
        }
    }
}

/// Windows that a forward rub has to last …
const RUBS_ON: u8 = 3;
/// … and the share by which the spin may differ from what it was at the first: at the critical speeds of a run-up it comes and goes.
const SAME_SPIN: f32 = 0.003;
/// So many once it has been tried to break such a rub.
const TRIED: u8 = u8::MAX;

/// Usual speed while nothing has been seen: far beyond what is trusted \[lift-off speeds\].
const UNSEEN: f32 = 4.0;

/// More than any square of a speed is.
const MOST_SQUARE: f32 = 500.0;

impl<S: Scalar> Trust<S> {
    /// Whether the reading moves so little by itself that what it shows can be acted on.
    #[inline]
    pub(crate) fn is_granted(&self) -> bool {
        self.margin <= S::from_f32(UNTRUSTED_FROM * MARGIN - ORDINARY)
    }

    /// Whether a forward rub goes on and on, at one spin.
    #[inline]
    pub(crate) fn rubs_on(&self) -> bool {
        self.disturbance.windows >= RUBS_ON
    }

    /// Of a plane of a rotor: whether the supervisor has acted on it, and it has not settled since.
    #[inline]
    pub(crate) fn is_unsettled(&self) -> bool {
        self.disturbance.unsettled
    }

    /// The firmware knows that the rotor levitated until now, its reading moving as it usually does.
    #[inline]
    fn levitated_before(&mut self) {
        if self.disturbance.proof != Proof::Seen {
            self.disturbance.proof = Proof::Seen;
            (self.before, self.margin) = (S::ZERO, S::ZERO);
        }
    }

    /// The supervisor acts on a rotor.
    #[inline]
    pub(crate) fn acts(&mut self) {
        self.disturbance.unsettled = true;
    }

    /// A tick. Whether the bearing has to be handed back, and for how many ticks.
    #[inline]
    pub(crate) fn tick(&mut self, seen: &Seen<S>, coeffs: &Coeffs<S>) -> Option<u32> {
        self.peak = self.peak.max(seen.speed_square);
        let flies = seen.flies;
        if seen.phase.is_engaged() {
            let tries = if self.rubs_on() { TRIED } else { 1 };
            self.disturbance.windows = self.disturbance.windows.max(tries);
        } else if !flies {
            self.disturbance.windows = self.disturbance.windows.max(1);
        }
        self.disturbance.touched |= !flies;
        match self.ticks_left.checked_sub(1) {
            Some(left) => {
                self.ticks_left = left;
                None
            }
            None => {
                // A copy, so that the usual one stays in registers.
                let seen = *seen;
                self.window(&seen, coeffs)
            }
        }
    }

    /// The end of a window.
    #[inline(never)]
    fn window(&mut self, seen: &Seen<S>, coeffs: &Coeffs<S>) -> Option<u32> {
        let (phase, rubs) = (seen.phase, seen.rubs);
        if seen.status.contains(Status::LEVITATED_BEFORE) {
            self.levitated_before();
        }
        self.ticks_left = coeffs.window_ticks;
        let peak = core::mem::replace(&mut self.peak, S::ZERO);
        if self.disturbance.proof == Proof::Nothing {
            // With the first sample the first window begins.
            self.disturbance.proof = Proof::Begun;
            return None;
        }
        let disturbed = core::mem::take(&mut self.disturbance.windows);
        if disturbed == TRIED {
            // It has been tried to break a forward rub. One that comes back will come back again.
            self.fault_score = self
                .fault_score
                .saturating_add(SCORE_TRY)
                .min(HANDS_BACK_AT);
        }
        let touched = core::mem::take(&mut self.disturbance.touched);
        if rubs && phase == Phase::Levitated {
            let spin = seen.spin.abs();
            // As when it began: a rub in a run-up is not tried to be broken.
            if (spin - self.before).abs() <= spin * S::from_f32(SAME_SPIN) {
                self.disturbance.windows = disturbed.saturating_add(1).min(RUBS_ON);
            } else {
                self.before = spin;
            }
        }
        if !phase.is_engaged() {
            // What the wall or the supervisor did is not usual.
            if disturbed == 0 {
                self.disturbance.unsettled = false;
                self.disturbance.proof = Proof::Seen;
                self.learn(peak.sqrt());
            }
            self.lowest = S::from_f32(MOST_SQUARE);
            if phase == Phase::Levitated && disturbed != 0 && self.disturbance.unsettled {
                // Engagements that are over before a window is come to an end as well.
                self.fault_score = self
                    .fault_score
                    .saturating_add(SCORE_PROGRESS)
                    .min(HANDS_BACK_AT);
            } else if phase == Phase::Levitated && !touched {
                self.fault_score = self.fault_score.saturating_sub(FORGIVEN);
                if self.fault_score == 0 {
                    self.doubled = 0;
                }
            }
            return None;
        }
        let progress = peak <= self.lowest * S::from_f32(PROGRESS);
        if progress {
            self.lowest = peak;
        }
        let fault_score = match phase {
            Phase::SensorFault { .. } => SCORE_BLIND,
            _ if peak <= S::from_f32(QUIET_SQUARE) => SCORE_HELD,
            _ if progress => SCORE_PROGRESS,
            _ if rubs => SCORE_RUBBING,
            _ if self.disturbance.unsettled && !touched => HANDS_BACK_AT,
            _ => SCORE_BOUNCING,
        };
        self.fault_score = self.fault_score.saturating_add(fault_score);
        if self.fault_score < HANDS_BACK_AT {
            return None;
        }
        self.fault_score = LEFT_AFTER;
        self.handed_back = self.handed_back.saturating_add(1);
        let windows = HANDED_BACK_WINDOWS << self.doubled.min(MOST_DOUBLED);
        self.doubled = self.doubled.saturating_add(1).min(MOST_DOUBLED);
        Some(windows * u32::from(coeffs.window_ticks))
    }

    /// What two windows in a row have seen is usual: what passes is not.
    fn learn(&mut self, speed: S) {
        let before = core::mem::replace(&mut self.before, speed);
        let usual = speed.min(before);
        self.margin = (usual * S::from_f32(MARGIN) - S::from_f32(ORDINARY)).max(S::ZERO);
    }

    /// After a change of the unit of speed.
    pub(crate) fn rescale(&mut self, speed: S) {
        self.before = self.before * speed;
        self.margin = self.margin * speed;
        self.peak = S::ZERO;
        self.lowest = S::from_f32(MOST_SQUARE);
    }
}
