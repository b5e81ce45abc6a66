//! The only judge of what comes in: NaN, range, jumps, sequence, a stuck sensor; the applied force and
//! the axes of the drive. What passes here is finite.
//!
//! A refused sample costs nothing by itself: the observer carries its model over the tick. Only several
//! in a row since the last good one make a fault, and how many depends on how sure the refusal is.

mod faults;

use self::faults::{RecoveryCount, Refused};
use crate::border::coeffs::Coeffs;
use crate::border::signal::{CoreSample, Events, RejectReason, Status};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::innovation::{Expected, Innovation};
use crate::sense::reading::{Reading, Rotation, SampleAssessment, SampleFlags};
use crate::sense::stuck::StuckDetector;

/// Missed ticks over which the observer's model is carried: bounds the time of a tick.
pub(crate) const MAX_MISSED: u32 = 4;
/// Readings in a row that have not moved and make a fault.
const STUCK: u8 = 3;
/// The same where only one coordinate stands still: a converter whose step is the noise repeats a reading of a moving rotor by
/// chance, sometimes twice or thrice.
const ONE_STUCK: u8 = 7;
/// The same where the rotor must have gone far meanwhile.
const FAR_STUCK: u8 = 2;
/// Longest applied force that is believed \[caps\].
const MOST_APPLIED: f32 = 2.0;

/// [`Guard::age`] where there is no good sample to compare with.
const NEVER: u16 = u16::MAX;

/// Velocity of the last tick.
pub(crate) struct LastVelocity<S> {
    pub(crate) velocity: Vec2<S>,
    /// Estimated without knowing the force of a contact.
    pub(crate) in_contact: bool,
}

impl<S: Scalar> LastVelocity<S> {
    /// What of it is beyond the most that the model accelerates by while the wall holds against it.
    #[inline(always)]
    fn certain(&self, coeffs: &Coeffs<S>) -> Vec2<S> {
        if !self.in_contact {
            return self.velocity;
        }
        let most = S::ONE + coeffs.stiffness.abs() * S::from_f32(1.5);
        (self.velocity).map(|speed| speed.beyond(coeffs.observer.blind_time * most))
    }
}

/// Memory of the guard.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Guard<S> {
    last_sequence: u32,
    /// The last good sample, and the ticks since then.
    last_good: Vec2<S>,
    age: u16,
    /// Calls with the last sequence number after the first.
    repeats: u16,
    /// There was a sample.
    begun: bool,
    /// The last tick came after a gap that was too long to make up for.
    jumped: bool,
    faulty: bool,
    /// There have been usual samples since the stuck detector looked.
    stuck_is_old: bool,
    stuck_detector: StuckDetector<S>,
    pub(crate) innovation: Innovation<S>,
    /// A coordinate has been stuck for so long that it is a fault.
    stuck: bool,
    refused: Refused,
    recovery: RecoveryCount,
    /// Status of the next sample, and what it says, for which nothing is to be remembered but the sample, see
    /// [`Guard::as_usual`]; nothing where there is none. (Not in one `Option`, which has a word of its own.) All bits of a
    /// status that mean something are in its lowest byte.
    usual: u8,
    usual_flags: SampleFlags,
    lost: SampleFlags,
    /// Of the last sample.
    pub(crate) refusal: RejectReason,
    /// Why the last fault began.
    pub(crate) fault: RejectReason,
    pub(crate) missed_ticks: u32,
    pub(crate) repeated_ticks: u32,
    pub(crate) late_ticks: u32,
}

words_of_fields!(Guard<S> { last_sequence, last_good, age, repeats, begun, jumped, faulty, stuck_is_old, stuck_detector, innovation, stuck, refused, recovery, usual, usual_flags, lost, refusal, fault, missed_ticks, repeated_ticks, late_ticks });

impl<S: Scalar> Default for Guard<S> {
    fn default() -> Self {
        Self {
            last_sequence: 0,
            last_good: Vec2::ZERO,
            age: NEVER,
            repeats: 0,
            begun: false,
            jumped: false,
            faulty: false,
            stuck_is_old: false,
            stuck_detector: StuckDetector::default(),
            innovation: Innovation::default(),
            stuck: false,
            refused: Refused::default(),
            recovery: RecoveryCount::default(),
            usual: 0,
            usual_flags: SampleFlags::empty(),
            lost: SampleFlags::empty(),
            refusal: RejectReason::None,
            fault: RejectReason::None,
            missed_ticks: 0,
            repeated_ticks: 0,
            late_ticks: 0,
        }
    }
}

impl<S: Scalar> Guard<S> {
    /// `estimated`: what the observer knew at the last tick.
    #[inline]
    pub(crate) fn judge(
        &mut self,
        sample: &CoreSample<S>,
        status: Status,
        expected: Expected<S>,
        estimated: impl FnOnce() -> LastVelocity<S>,
        coeffs: &Coeffs<S>,
    ) -> Reading<S> {
        let mut assessment = match self.as_usual(sample, status, expected, coeffs) {
            Some(flags) => SampleAssessment {
                flags,
                ..SampleAssessment::default()
            },
            None => {
                // By value, so that the usual sample stays in registers.
                let position = Vec2::from_array(sample.position);
                self.judge_in_full(
                    sample.sequence,
                    position,
                    status,
                    expected,
                    estimated(),
                    coeffs,
                )
            }
        };
        self.refusal = assessment.refusal;
        let measured = Vec2::from_array(sample.applied);
        if status.contains(Status::APPLIED_VALID) && !measured.exceeds(S::from_f32(MOST_APPLIED)) {
            assessment.flags |= SampleFlags::MEASURED;
        }
        Reading {
            assessment,
            sample: Vec2::from_array(sample.position),
            measured,
            rotation: Rotation::from_sample(sample),
        }
    }

    /// Most samples follow the last good one by a small step in both coordinates, with the same status, and
    /// nothing is wrong: all that can be said of them, at a third of the cost.
    #[inline]
    fn as_usual(
        &mut self,
        sample: &CoreSample<S>,
        status: Status,
        expected: Expected<S>,
        coeffs: &Coeffs<S>,
    ) -> Option<SampleFlags> {
        let position = Vec2::from_array(sample.position);
        let step = position - self.last_good;
        let usual = !self.usual_flags.is_empty()
            && status.bits() as u8 == self.usual
            && sample.sequence.wrapping_sub(self.last_sequence) == 1
            && step.x != S::ZERO
            && step.y != S::ZERO
            // Written so that NaN is unusual.
            && !step.exceeds(coeffs.guard.way_per_tick)
            && !position.exceeds(coeffs.guard.position_limit);
        if !usual {
            return None;
        }
        match expected.off(position) {
            Some(off) if self.innovation.fits(off, coeffs) => self.innovation.learn(off, coeffs),
            Some(_) => return None,
            None => self.innovation.skip(),
        }
        self.last_sequence = sample.sequence;
        self.last_good = position;
        self.stuck_is_old = true;
        Some(self.usual_flags)
    }

    #[inline(never)]
    fn judge_in_full(
        &mut self,
        sequence: u32,
        position: Vec2<S>,
        status: Status,
        expected: Expected<S>,
        last: LastVelocity<S>,
        coeffs: &Coeffs<S>,
    ) -> SampleAssessment {
        if core::mem::take(&mut self.stuck_is_old) {
            self.stuck_detector.moved_to(self.last_good);
        }
        let mut flags = SampleFlags::from_status(status);
        let (repeated, gap) = self.sequence(sequence);
        let mut events = Events::empty();
        if repeated || gap > 0 {
            events |= Events::SEQUENCE;
        }
        let anew = gap > MAX_MISSED;
        let missed = if anew { 0 } else { gap };
        if anew {
            self.age = NEVER;
            flags |= SampleFlags::ANEW;
        } else {
            self.age = self.age.saturating_add(1 + missed as u16);
        }
        if missed > 0 {
            flags |= SampleFlags::MISSED;
        }

        // A bearing that is off is not known to deliver what the model moves by.
        let known = !self.faulty && !anew && flags.contains(SampleFlags::ON);
        let trusted = if known {
            last.certain(coeffs)
        } else {
            Vec2::ZERO
        };
        let (refusal, bad) = if repeated {
            (RejectReason::Dropout, SampleFlags::BOTH_BAD)
        } else {
            let expected = expected.off(position).filter(|_| gap == 0);
            self.refusal(position, trusted, expected, coeffs)
        };
        if !self.faulty {
            events |= self.count(refusal, bad, position, coeffs);
        }
        if flags.contains(SampleFlags::LATE) {
            self.late_ticks = self.late_ticks.saturating_add(1);
            events |= Events::LATE;
        }
        let fits = self.other_fits(refusal, bad, position, 1 + missed, anew, coeffs);
        if refusal == RejectReason::None {
            flags |= SampleFlags::USED;
        }
        if self.faulty {
            // Nobody knows where the rotor is: a sample has to fit to the one before it.
            if is_measured(refusal) {
                // Where noise is what jumps, it has to be learnt to come out of this.
                self.innovation.learn(position - self.last_good, coeffs);
                (self.last_good, self.age) = (position, 0);
            }
            events |= self.recover(bad, fits, coeffs);
        }
        if self.faulty {
            flags |= SampleFlags::FAULTY | self.refused.bad;
            if !fits {
                flags |= SampleFlags::BOTH_BAD;
            }
        }
        events |= self.axes(flags & SampleFlags::LOST);
        self.expect_the_same(status, flags);
        SampleAssessment {
            events,
            flags,
            refusal,
            missed: missed as u8,
        }
    }

    /// Whether the coordinate beside one that is bad fits; true where there is none.
    #[inline(always)]
    fn other_fits(
        &mut self,
        refusal: RejectReason,
        bad: SampleFlags,
        position: Vec2<S>,
        ticks: u32,
        anew: bool,
        coeffs: &Coeffs<S>,
    ) -> bool {
        if refusal == RejectReason::None {
            self.refused.apart = 0;
            return true;
        }
        if refusal != RejectReason::Doubted {
            self.refused.bad |= bad;
        }
        if bad != SampleFlags::BOTH_BAD {
            return self.judge_other(position, bad, ticks, anew, coeffs);
        }
        if self.faulty {
            self.refused.apart = 0;
        }
        true
    }

    /// Remembers what the next sample has to be like to be a usual one.
    #[inline(always)]
    fn expect_the_same(&mut self, status: Status, flags: SampleFlags) {
        let kept = SampleFlags::USED | SampleFlags::ON | SampleFlags::LOST | SampleFlags::SHADOW;
        self.usual = (status - Status::LATE).bits() as u8;
        self.usual_flags = if flags.contains(SampleFlags::USED) && !self.faulty && !self.jumped {
            flags & kept
        } else {
            SampleFlags::empty()
        };
    }

    /// Takes in which axes are lost.
    #[inline(always)]
    fn axes(&mut self, lost: SampleFlags) -> Events {
        let before = core::mem::replace(&mut self.lost, lost);
        let mut events = Events::empty();
        if !(lost - before).is_empty() {
            events |= Events::AXIS_LOST;
        }
        if !(before - lost).is_empty() {
            events |= Events::AXIS_BACK;
        }
        events
    }

    /// Whether the number is that of no new sample, and how many ticks were missed.
    fn sequence(&mut self, sequence: u32) -> (bool, u32) {
        let last = core::mem::replace(&mut self.last_sequence, sequence);
        if !core::mem::replace(&mut self.begun, true) {
            return (false, 0);
        }
        let ahead = sequence.wrapping_sub(last);
        // An older number is no new sample either.
        if ahead == 0 || ahead > u32::MAX / 2 {
            self.repeats = self.repeats.saturating_add(1);
            self.repeated_ticks = self.repeated_ticks.saturating_add(1);
            return (true, 0);
        }
        // Where the number counts the samples that should have come, each repeated call was one.
        let missed = (ahead - 1).saturating_sub(u32::from(self.repeats));
        self.repeats = 0;
        self.missed_ticks = self.missed_ticks.saturating_add(missed);
        // Numbers that jump at each tick are no gaps, and nothing could be compared with anything.
        let long = missed > MAX_MISSED;
        let jumps = core::mem::replace(&mut self.jumped, long) && long;
        (jumps, missed)
    }

    /// What is wrong with a new sample, and with which coordinates. `off`: how far it is from where a rotor in flight is.
    fn refusal(
        &mut self,
        position: Vec2<S>,
        velocity: Vec2<S>,
        off: Option<Vec2<S>>,
        coeffs: &Coeffs<S>,
    ) -> (RejectReason, SampleFlags) {
        // What is no number exceeds everything.
        if position.exceeds(coeffs.guard.position_limit) {
            let bad = bad_coordinates(position, coeffs.guard.position_limit);
            return if position.is_finite() {
                (RejectReason::Range, bad)
            } else {
                (RejectReason::NotFinite, bad)
            };
        }
        let still = (self.stuck_detector).watch(position, velocity, coeffs);
        let enough = if still.far {
            FAR_STUCK
        } else if still.both >= STUCK {
            STUCK
        } else {
            ONE_STUCK
        };
        self.stuck = still.samples >= enough;
        if let Some(off) = off
            && !self.faulty
        {
            let doubted = self.innovation.doubted();
            if self.innovation.doubts(off, coeffs) {
                return (RejectReason::Doubted, SampleFlags::BOTH_BAD);
            }
            // The one after those that were doubted shows that they were right, but for what has not moved since.
            if doubted > 0 && still.samples == 0 {
                let bad = self.stuck_detector.jumped(off, doubted);
                if !bad.is_empty() {
                    self.stuck = true;
                    return (RejectReason::Stuck, bad);
                }
            }
        }
        let known = self.age != NEVER;
        let way = way_in(u32::from(self.age), coeffs) + self.innovation.excess_noise(coeffs);
        let step = position - self.last_good;
        if known && step.exceeds(way) {
            return (RejectReason::Slew, bad_coordinates(step, way));
        }
        if still.samples > 0 {
            return (RejectReason::Stuck, self.stuck_detector.stuck());
        }
        (RejectReason::None, SampleFlags::empty())
    }

    /// After a change of the unit of length.
    pub(crate) fn rescale(&mut self, length: S) {
        self.last_good = self.last_good * length;
        self.innovation.rescale(length);
        self.stuck_detector.rescale();
        self.stuck_is_old = false;
    }
}

/// The longest way that is plausible in so many ticks.
fn way_in<S: Scalar>(ticks: u32, coeffs: &Coeffs<S>) -> S {
    coeffs.guard.way_per_tick * S::count(ticks) + coeffs.guard.sensor_speeds * coeffs.tick
}

/// Which coordinates are no numbers or out of range; both where that is so of the radius alone.
#[inline]
fn bad_coordinates<S: Scalar>(position: Vec2<S>, most: S) -> SampleFlags {
    match (position.x.abs() <= most, position.y.abs() <= most) {
        (false, true) => SampleFlags::X_BAD,
        (true, false) => SampleFlags::Y_BAD,
        _ => SampleFlags::BOTH_BAD,
    }
}

/// Whether a sample, good or refused, says where the rotor may be.
fn is_measured(refusal: RejectReason) -> bool {
    !matches!(
        refusal,
        RejectReason::NotFinite | RejectReason::Range | RejectReason::Dropout
    )
}
