//! Refused samples: whether they make a fault, in one coordinate or both, and when it is over.

use super::{Guard, NEVER, way_in};
use crate::border::coeffs::Coeffs;
use crate::border::signal::{Events, RejectReason};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::SampleFlags;

/// Refused samples in a row that make a fault, of the kinds that are no mere interference.
const JUMPS: u8 = 2;
const DROPOUTS: u8 = 3;

/// Refused samples since the last good one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Refused {
    all: u16,
    /// Coordinates that were wrong.
    pub(super) bad: SampleFlags,
    jumps: u8,
    dropouts: u8,
    /// Where one coordinate is bad: ticks since the other one fitted, none if it did last.
    pub(super) apart: u8,
}

words_of_fields!(Refused {
    all,
    bad,
    jumps,
    dropouts,
    apart
});

/// In a fault: samples in a row that fit, with the same coordinates bad.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RecoveryCount {
    bad: SampleFlags,
    samples: u16,
}

words_of_fields!(RecoveryCount { bad, samples });

impl<S: Scalar> Guard<S> {
    /// Judges the coordinate beside one that is bad, so many ticks after the last sample: whether it fits, or is farther
    /// from that than the rotor can be. Then it is not used, and after the second in a row both are bad.
    pub(super) fn judge_other(
        &mut self,
        position: Vec2<S>,
        bad: SampleFlags,
        ticks: u32,
        anew: bool,
        coeffs: &Coeffs<S>,
    ) -> bool {
        let refused = &mut self.refused;
        let (other, now) = self.stuck_detector.beside(bad, position);
        let ticks = ticks + u32::from(refused.apart);
        let fits = anew || other.step(now) <= way_in(ticks, coeffs);
        let all_bad = self.faulty && refused.bad == SampleFlags::BOTH_BAD;
        let second = refused.apart > 0;
        if fits || second || all_bad {
            other.accept(now);
            refused.apart = 0;
        } else {
            // At most one more than a gap that is made up for.
            refused.apart = ticks as u8;
        }
        if !fits && second {
            refused.bad = SampleFlags::BOTH_BAD;
        }
        fits && !(all_bad && other.is_awaited())
    }

    /// Before a fault: counts a sample, refused in these coordinates or good, and says whether those since the last good one
    /// make a fault. Where nothing is known of the rotor, the first does.
    pub(super) fn count(
        &mut self,
        refusal: RejectReason,
        bad: SampleFlags,
        position: Vec2<S>,
        coeffs: &Coeffs<S>,
    ) -> Events {
        let refused = &mut self.refused;
        let often = |count: &mut u8, most: u8| {
            *count += 1;
            *count >= most
        };
        let sure = match refusal {
            RejectReason::None => {
                (self.last_good, self.age) = (position, 0);
                *refused = Refused::default();
                return Events::empty();
            }
            // The next ones say whether it was right; too few are doubted for a fault.
            RejectReason::Doubted => return Events::empty(),
            RejectReason::NotFinite | RejectReason::Range => false,
            RejectReason::Slew => often(&mut refused.jumps, JUMPS),
            RejectReason::Dropout => often(&mut refused.dropouts, DROPOUTS),
            RejectReason::Stuck => self.stuck,
        };
        // Readings that are the last ones by chance may be many in a row, of x here and of y there.
        refused.all += u16::from(refusal != RejectReason::Stuck);
        if !sure && refused.all < coeffs.guard.fault_ticks && self.age != NEVER {
            return Events::empty();
        }
        self.age = NEVER;
        self.faulty = true;
        self.fault = refusal;
        self.recovery = RecoveryCount::default();
        self.stuck_detector
            .freeze(if refusal == RejectReason::Stuck {
                bad
            } else {
                SampleFlags::empty()
            });
        Events::SENSOR_FAULT
    }

    /// In a fault: after as many samples in a row that fit, with the same coordinates bad, no others are; with none bad
    /// it is over.
    pub(super) fn recover(&mut self, bad: SampleFlags, fits: bool, coeffs: &Coeffs<S>) -> Events {
        let recovery = &mut self.recovery;
        if bad != recovery.bad {
            *recovery = RecoveryCount { bad, samples: 0 };
        }
        let waits = bad.is_empty() && self.stuck_detector.is_awaited();
        if !fits || waits || bad == SampleFlags::BOTH_BAD {
            recovery.samples = 0;
            return Events::empty();
        }
        recovery.samples = recovery.samples.saturating_add(1);
        if recovery.samples < coeffs.guard.fault_ticks {
            return Events::empty();
        }
        self.refused.bad = bad;
        if !bad.is_empty() {
            return Events::empty();
        }
        self.faulty = false;
        self.refused = Refused::default();
        Events::SENSOR_OK
    }
}
