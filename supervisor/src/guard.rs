//! The only judge of what comes in: NaN, range, jumps, sequence, a stuck sensor; the applied force and
//! the axes of the drive. What passes here is finite.
//!
//! A refused sample costs nothing by itself: the observer carries its model over the tick. Only several
//! in a row since the last good one make a fault, and how many depends on how sure the refusal is.

use crate::coeffs::Coeffs;
use crate::reading::{Facts, Reading, Verdict};
use crate::scalar::Scalar;
use crate::signal::{CoreSample, Events, Refusal, Status};
use crate::spin::Spin;
use crate::still::Still;
use crate::vec2::Vec2;

/// Missed ticks over which the observer's model is carried: bounds the time of a tick.
pub(crate) const MAX_MISSED: u32 = 4;
/// Refused samples in a row that make a fault, of the kinds that are no mere interference.
const JUMPS: u8 = 2;
const DROPOUTS: u8 = 3;
const STUCK: u8 = 3;
/// Longest applied force that is believed \[caps\].
const MOST_APPLIED: f32 = 2.0;

/// Refused samples since the last good one.
#[derive(Debug, Clone, Copy, Default)]
struct Refused {
    /// All of them; in a fault of both coordinates samples in a row in which one alone was bad, and the other one fitted.
    all: u16,
    /// Coordinates that were wrong.
    bad: Facts,
    jumps: u8,
    dropouts: u8,
    stuck: u8,
    /// Where one coordinate is bad: ticks since the other one fitted, none if it did last.
    apart: u8,
}

/// Memory of the guard.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Guard<S> {
    last_sequence: Option<u32>,
    /// Calls with the last sequence number after the first.
    repeats: u32,
    /// The last tick came after a gap that was too long to make up for.
    jumped: bool,
    /// The last good sample, and the ticks since then.
    last_good: Option<(Vec2<S>, u32)>,
    still: Still<S>,
    refused: Refused,
    /// Good samples in a row during a fault.
    good: u16,
    faulty: bool,
    /// Status of the next sample, and what it says, for which nothing is to be remembered but the sample, see
    /// [`Guard::as_usual`]; nothing where there is none. (Not in one `Option`, which has a word of its own.)
    usual: Status,
    usual_facts: Facts,
    /// There have been usual samples since `still` looked.
    still_is_old: bool,
    /// Why the last fault began.
    pub(crate) fault: Refusal,
    lost: Facts,
    pub(crate) missed_ticks: u32,
    pub(crate) repeated_ticks: u32,
    pub(crate) late_ticks: u32,
}

impl<S: Scalar> Guard<S> {
    /// `estimated`: velocity of the last tick, and whether it was made without knowing the contact force.
    #[inline]
    pub(crate) fn judge(
        &mut self,
        (sample, status): (&CoreSample<S>, Status),
        estimated: impl FnOnce() -> (Vec2<S>, bool),
        coeffs: &Coeffs<S>,
    ) -> Reading<S> {
        let mut verdict = match self.as_usual(sample, status, coeffs) {
            Some(facts) => Verdict {
                facts,
                ..Verdict::default()
            },
            None => {
                // A copy, so that the usual sample stays in registers.
                let sample = *sample;
                self.judge_in_full((&sample, status), estimated(), coeffs)
            }
        };
        let measured = Vec2::from_array(sample.applied);
        if status.contains(Status::APPLIED_VALID) && !measured.exceeds(S::of(MOST_APPLIED)) {
            verdict.facts |= Facts::MEASURED;
        }
        Reading {
            verdict,
            sample: Vec2::from_array(sample.position),
            measured,
            spin: Spin::of(sample),
        }
    }

    /// Most samples follow the last good one by a small step in both coordinates, with the same status, and
    /// nothing is wrong: all that can be said of them, at a third of the cost.
    #[inline]
    fn as_usual(
        &mut self,
        sample: &CoreSample<S>,
        status: Status,
        coeffs: &Coeffs<S>,
    ) -> Option<Facts> {
        if self.usual_facts.is_empty() {
            return None;
        }
        let (sequence, (last, _)) = (self.last_sequence.as_mut()?, self.last_good.as_mut()?);
        let position = Vec2::from_array(sample.position);
        let step = position - *last;
        let usual = status == self.usual
            && sample.sequence.wrapping_sub(*sequence) == 1
            && step.x != S::ZERO
            && step.y != S::ZERO
            // Written so that NaN is unusual.
            && !step.exceeds(coeffs.way_per_tick)
            && !position.exceeds(coeffs.position_limit);
        if !usual {
            return None;
        }
        *sequence = sample.sequence;
        *last = position;
        self.still_is_old = true;
        Some(self.usual_facts)
    }

    #[inline(never)]
    fn judge_in_full(
        &mut self,
        (sample, status): (&CoreSample<S>, Status),
        (velocity, in_contact): (Vec2<S>, bool),
        coeffs: &Coeffs<S>,
    ) -> Verdict {
        if core::mem::take(&mut self.still_is_old) {
            // What the usual way leaves out: since then every sample has changed in both coordinates.
            self.still.last = self.last_good.map(|(last, _)| last);
            self.still.way = Vec2::ZERO;
        }
        let mut facts = facts_of(status);
        let (repeated, gap, mut events) = self.sequence(sample.sequence);
        let anew = gap > MAX_MISSED;
        let missed = if anew { 0 } else { gap };
        if anew {
            self.last_good = None;
            facts |= Facts::ANEW;
        }
        if missed > 0 {
            facts |= Facts::MISSED;
        }
        if let Some((_, ticks)) = &mut self.last_good {
            *ticks = ticks.saturating_add(1 + missed);
        }

        let position = Vec2::from_array(sample.position);
        // A bearing that is off is not known to deliver what the model moves by.
        let trusted = if self.faulty || anew || !facts.contains(Facts::ON) {
            Vec2::ZERO
        } else if in_contact {
            velocity.map(|speed| beyond(speed, coeffs.blind_speed))
        } else {
            velocity
        };
        let refusal = if repeated {
            Refusal::Dropout
        } else {
            self.refusal(position, trusted, coeffs)
        };
        events |= self.count(refusal, position, coeffs);
        if facts.contains(Facts::LATE) {
            self.late_ticks = self.late_ticks.saturating_add(1);
            events |= Events::LATE;
        }
        let mut jumped = false;
        if refusal == Refusal::None {
            facts |= Facts::USED;
            self.refused.apart = 0;
        } else {
            let bad = match refusal {
                Refusal::NotFinite | Refusal::Range => {
                    bad_coordinates(position, coeffs.position_limit)
                }
                _ => Facts::BOTH_BAD,
            };
            self.refused.bad |= bad;
            if bad != Facts::BOTH_BAD {
                jumped = self.judge_other(position, bad, (1 + missed, anew), coeffs);
            } else if self.faulty {
                (self.refused.all, self.refused.apart) = (0, 0);
            }
        }
        if self.faulty {
            facts |= Facts::FAULTY | self.refused.bad;
            if jumped {
                facts |= Facts::BOTH_BAD;
            }
        }
        let lost = facts & (Facts::X_LOST | Facts::Y_LOST);
        let before = core::mem::replace(&mut self.lost, lost);
        if !(lost - before).is_empty() {
            events |= Events::AXIS_LOST;
        }
        if !(before - lost).is_empty() {
            events |= Events::AXIS_BACK;
        }
        let kept = Facts::USED | Facts::ON | Facts::X_LOST | Facts::Y_LOST;
        self.usual = status - Status::LATE;
        self.usual_facts = if facts.contains(Facts::USED) && !self.faulty {
            facts & kept
        } else {
            Facts::empty()
        };
        Verdict {
            events,
            facts,
            refusal,
            missed: missed as u8,
        }
    }

    /// Whether the number is that of no new sample, and how many ticks were missed.
    fn sequence(&mut self, sequence: u32) -> (bool, u32, Events) {
        let Some(last) = self.last_sequence.replace(sequence) else {
            return (false, 0, Events::empty());
        };
        let ahead = sequence.wrapping_sub(last);
        // An older number is no new sample either.
        if ahead == 0 || ahead > u32::MAX / 2 {
            self.repeats = self.repeats.saturating_add(1);
            self.repeated_ticks = self.repeated_ticks.saturating_add(1);
            return (true, 0, Events::SEQUENCE);
        }
        // Where the number counts the samples that should have come, each repeated call was one.
        let missed = (ahead - 1).saturating_sub(self.repeats);
        self.repeats = 0;
        let events = if missed > 0 {
            self.missed_ticks = self.missed_ticks.saturating_add(missed);
            Events::SEQUENCE
        } else {
            Events::empty()
        };
        // Numbers that jump at each tick are no gaps, and nothing could be compared with anything.
        let long = missed > MAX_MISSED;
        let jumps = core::mem::replace(&mut self.jumped, long) && long;
        (jumps, missed, events)
    }

    /// What is wrong with a new sample.
    fn refusal(&mut self, position: Vec2<S>, velocity: Vec2<S>, coeffs: &Coeffs<S>) -> Refusal {
        if !position.is_finite() {
            return Refusal::NotFinite;
        }
        if position.exceeds(coeffs.position_limit) {
            return Refusal::Range;
        }
        let stuck = (self.still).watch(position, velocity, coeffs.sensor_speeds, self.faulty);
        if let Some((last, ticks)) = self.last_good
            && (position - last).exceeds(way_in(ticks, coeffs))
        {
            return Refusal::Slew;
        }
        if stuck {
            return Refusal::Stuck;
        }
        Refusal::None
    }

    /// Judges the coordinate beside one that is bad, so many ticks after the last sample. Whether it is farther from that
    /// than the rotor can be: then it is not used, and after the second in a row both are bad. In a fault of both it is good
    /// again after as many samples that fit as end a fault.
    fn judge_other(
        &mut self,
        position: Vec2<S>,
        bad: Facts,
        (ticks, anew): (u32, bool),
        coeffs: &Coeffs<S>,
    ) -> bool {
        let (still, refused) = (&mut self.still, &mut self.refused);
        let last = still.last.get_or_insert(position);
        let [awaited_x, awaited_y] = &mut still.awaited;
        let (now, last, way, awaited) = if bad == Facts::X_BAD {
            (position.y, &mut last.y, &mut still.way.y, awaited_y)
        } else {
            (position.x, &mut last.x, &mut still.way.x, awaited_x)
        };
        let ticks = ticks + u32::from(refused.apart);
        let fits = anew || (now - *last).size() <= way_in(ticks, coeffs);
        if now != *last {
            *way = S::ZERO;
            *awaited = false;
        }
        if self.faulty && refused.bad == Facts::BOTH_BAD {
            *last = now;
            refused.all = if fits && !*awaited {
                refused.all + 1
            } else {
                0
            };
            if refused.all >= coeffs.fault_ticks {
                (refused.bad, refused.all) = (bad, 0);
            }
        } else if fits {
            *last = now;
            refused.apart = 0;
        } else if refused.apart == 0 {
            // At most one more than a gap that is made up for.
            refused.apart = ticks as u8;
        } else {
            *last = now;
            refused.apart = 0;
            refused.bad = Facts::BOTH_BAD;
        }
        !fits
    }

    /// Fault and recovery.
    fn count(&mut self, refusal: Refusal, position: Vec2<S>, coeffs: &Coeffs<S>) -> Events {
        if refusal == Refusal::None && !self.faulty {
            self.last_good = Some((position, 0));
            self.refused = Refused::default();
            return Events::empty();
        }
        let measured = !matches!(
            refusal,
            Refusal::NotFinite | Refusal::Range | Refusal::Dropout
        );
        // In a fault nobody knows where the rotor is: a sample has to fit to the one before it.
        if self.faulty && measured {
            self.last_good = Some((position, 0));
        }
        if self.faulty {
            if refusal != Refusal::None {
                self.good = 0;
            } else if self.still.awaited == [false; 2] {
                self.good += 1;
            }
            if self.good < coeffs.fault_ticks {
                return Events::empty();
            }
            self.faulty = false;
            self.refused = Refused::default();
            return Events::SENSOR_OK;
        }
        let refused = &mut self.refused;
        refused.all += 1;
        match refusal {
            Refusal::Slew => refused.jumps += 1,
            Refusal::Dropout => refused.dropouts += 1,
            Refusal::Stuck => refused.stuck += 1,
            Refusal::None | Refusal::NotFinite | Refusal::Range => {}
        }
        let fault = refused.all >= coeffs.fault_ticks
            || refused.jumps >= JUMPS
            || refused.dropouts >= DROPOUTS
            || refused.stuck >= STUCK;
        if !fault {
            return Events::empty();
        }
        refused.all = 0;
        self.faulty = true;
        self.fault = refusal;
        self.good = 0;
        self.still.freeze(coeffs.sensor_speeds);
        self.last_good = measured.then_some((position, 0));
        Events::SENSOR_FAULT
    }

    /// After a change of the unit of length.
    pub(crate) fn rescale(&mut self, length: S) {
        if let Some((position, _)) = &mut self.last_good {
            *position = *position * length;
        }
        self.still.rescale();
        self.still_is_old = false;
    }
}

/// The longest way that is plausible in so many ticks.
fn way_in<S: Scalar>(ticks: u32, coeffs: &Coeffs<S>) -> S {
    coeffs.way_per_tick * S::count(ticks) + coeffs.sensor_speeds * coeffs.tick
}

/// Which coordinates are no numbers or out of range; both where that is so of the radius alone.
#[inline]
fn bad_coordinates<S: Scalar>(position: Vec2<S>, most: S) -> Facts {
    match (position.x.size() <= most, position.y.size() <= most) {
        (false, true) => Facts::X_BAD,
        (true, false) => Facts::Y_BAD,
        _ => Facts::BOTH_BAD,
    }
}

/// What the status bits say.
fn facts_of(status: Status) -> Facts {
    let pairs = [
        (Status::BEARING_ON, Facts::ON),
        (Status::AXIS_X_LOST, Facts::X_LOST),
        (Status::AXIS_Y_LOST, Facts::Y_LOST),
        (Status::LATE, Facts::LATE),
    ];
    let mut facts = Facts::empty();
    for (bit, fact) in pairs {
        if status.contains(bit) {
            facts |= fact;
        }
    }
    facts
}

/// What of a speed is beyond a doubt of this size.
fn beyond<S: Scalar>(speed: S, doubt: S) -> S {
    if speed > doubt {
        speed - doubt
    } else if speed < -doubt {
        speed + doubt
    } else {
        S::ZERO
    }
}
