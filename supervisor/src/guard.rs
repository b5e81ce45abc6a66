//! The only judge of what comes in: NaN, range, jumps, sequence, a stuck sensor; the applied force and
//! the axes of the drive. What passes here is finite.
//!
//! A refused sample costs nothing by itself: the observer carries its model over the tick. Only several
//! in a row since the last good one make a fault, and how many depends on how sure the refusal is.

use crate::coeffs::Coeffs;
use crate::signal::{Events, Limits, Refusal, Sample, Status};
use crate::vec2::Vec2;

/// What is known of the actuator at this tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Actuator {
    /// Measured force at this instant \[caps\].
    pub(crate) applied: Option<Vec2>,
    /// Whether x and y can act.
    pub(crate) acts: [bool; 2],
}

impl Actuator {
    /// The part of a force that the axes can carry.
    #[inline]
    pub(crate) fn carried(&self, force: Vec2) -> Vec2 {
        let [x, y] = self.acts;
        Vec2::new(if x { force.x } else { 0.0 }, if y { force.y } else { 0.0 })
    }
}

/// A sample after judgement, per unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reading {
    /// `None`: not to be used; the observer runs on its model.
    pub(crate) position: Option<Vec2>,
    /// Sign of the spin: +1, −1, or 0 where it is unknown or zero.
    pub(crate) spin_sign: f32,
    /// Position has been implausible for too long.
    pub(crate) faulty: bool,
    /// The bearing may act.
    pub(crate) bearing_on: bool,
    pub(crate) actuator: Actuator,
    /// Ticks since the last call that the observer has to make up for.
    pub(crate) missed: u32,
    /// The observer has to start anew.
    pub(crate) anew: bool,
    pub(crate) refusal: Refusal,
    pub(crate) limits: Limits,
    pub(crate) events: Events,
}

/// Missed ticks over which the observer's model is carried: bounds the time of a tick.
pub(crate) const MAX_MISSED: u32 = 4;
/// Refused samples in a row that make a fault, of the kinds that are no mere interference.
const JUMPS: u32 = 2;
const DROPOUTS: u32 = 3;
const STUCK: u32 = 3;
/// Longest applied force that is believed \[caps\].
const MOST_APPLIED: f32 = 2.0;

/// Refused samples since the last good one.
#[derive(Debug, Clone, Copy, Default)]
struct Refused {
    all: u32,
    jumps: u32,
    dropouts: u32,
    stuck: u32,
}

/// Memory of the guard.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Guard {
    last_sequence: Option<u32>,
    /// Calls with the last sequence number after the first.
    repeats: u32,
    /// The last good sample, and the ticks since then.
    last_good: Option<(Vec2, u32)>,
    still: Still,
    refused: Refused,
    /// Good samples in a row during a fault.
    good: u32,
    faulty: bool,
    /// Why the last fault began.
    pub(crate) fault: Refusal,
    acts: Option<[bool; 2]>,
}

impl Guard {
    /// `velocity` is the estimate of the last tick, `in_contact` whether it was made without knowing
    /// the contact force.
    pub(crate) fn judge(
        &mut self,
        sample: &Sample,
        velocity: Vec2,
        in_contact: bool,
        coeffs: &Coeffs,
    ) -> Reading {
        let bearing_on = sample.status.contains(Status::BEARING_ON);
        let (repeated, gap, mut events) = self.sequence(sample.sequence);
        let anew = gap > MAX_MISSED;
        let missed = if anew { 0 } else { gap };
        if anew {
            self.last_good = None;
        }
        if let Some((_, ticks)) = &mut self.last_good {
            *ticks = ticks.saturating_add(1 + missed);
        }

        let position = coeffs.position(sample.position_m);
        // A bearing that is off is not known to deliver what the model moves by.
        let trusted = match (self.faulty || anew, bearing_on, in_contact) {
            (true, ..) | (_, false, _) => Vec2::ZERO,
            (_, _, true) => Vec2::new(
                beyond(velocity.x, coeffs.blind_speed),
                beyond(velocity.y, coeffs.blind_speed),
            ),
            _ => velocity,
        };
        let refusal = if repeated {
            Refusal::Dropout
        } else {
            self.refusal(sample.position_m, position, trusted, coeffs)
        };
        events |= self.count(refusal, position, coeffs);

        let spin = sample.spin_rad_s;
        let known = sample.status.contains(Status::SPIN_VALID) && spin.is_finite();
        let spin_sign = match known {
            true if spin > 0.0 => 1.0,
            true if spin < 0.0 => -1.0,
            _ => 0.0,
        };
        let (actuator, axis_events) = self.actuator(sample, coeffs);
        let used = refusal == Refusal::None;
        Reading {
            position: used.then_some(position),
            spin_sign,
            faulty: self.faulty,
            bearing_on,
            actuator,
            missed,
            anew,
            refusal,
            limits: if used {
                Limits::empty()
            } else {
                Limits::SAMPLE_REFUSED
            },
            events: events | axis_events,
        }
    }

    /// Whether the number is the last one again, and how many ticks were missed.
    fn sequence(&mut self, sequence: u32) -> (bool, u32, Events) {
        let Some(last) = self.last_sequence.replace(sequence) else {
            return (false, 0, Events::empty());
        };
        let ahead = sequence.wrapping_sub(last);
        if ahead == 0 {
            self.repeats = self.repeats.saturating_add(1);
            return (true, 0, Events::SEQUENCE);
        }
        // Where the number counts the samples that should have come, each repeated call was one.
        let missed = (ahead - 1).saturating_sub(self.repeats);
        self.repeats = 0;
        let events = if missed > 0 {
            Events::SEQUENCE
        } else {
            Events::empty()
        };
        (false, missed, events)
    }

    /// What is wrong with a new sample.
    fn refusal(
        &mut self,
        sensor_m: [f32; 2],
        position: Vec2,
        velocity: Vec2,
        coeffs: &Coeffs,
    ) -> Refusal {
        if !position.is_finite() {
            return Refusal::NotFinite;
        }
        let stuck = (self.still).watch(sensor_m, velocity, coeffs.sensor_steps, self.faulty);
        if position.length_squared() > coeffs.position_limit * coeffs.position_limit {
            return Refusal::Range;
        }
        if let Some((last, ticks)) = self.last_good {
            let way = coeffs.way_per_tick * ticks as f32 + coeffs.sensor_steps;
            if (position - last).length_squared() > way * way {
                return Refusal::Slew;
            }
        }
        if stuck {
            return Refusal::Stuck;
        }
        Refusal::None
    }

    /// Fault and recovery.
    fn count(&mut self, refusal: Refusal, position: Vec2, coeffs: &Coeffs) -> Events {
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
            } else if self.fault != Refusal::Stuck || self.still.measures {
                // After a stuck sensor only samples that change say that it measures again.
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
        self.faulty = true;
        self.fault = refusal;
        self.good = 0;
        self.still.freeze(coeffs.sensor_steps);
        self.last_good = measured.then_some((position, 0));
        Events::SENSOR_FAULT
    }

    /// The applied force where it can be believed, and which axes act.
    fn actuator(&mut self, sample: &Sample, coeffs: &Coeffs) -> (Actuator, Events) {
        let acts = [
            !sample.status.contains(Status::AXIS_X_LOST),
            !sample.status.contains(Status::AXIS_Y_LOST),
        ];
        let [x_before, y_before] = self.acts.replace(acts).unwrap_or([true; 2]);
        let [x, y] = acts;
        let mut events = Events::empty();
        if (x_before && !x) || (y_before && !y) {
            events |= Events::AXIS_LOST;
        }
        if (!x_before && x) || (!y_before && y) {
            events |= Events::AXIS_BACK;
        }
        let applied = coeffs.force(sample.applied_n);
        let believed = sample.status.contains(Status::APPLIED_VALID)
            && applied.is_finite()
            && applied.length_squared() <= MOST_APPLIED * MOST_APPLIED;
        let actuator = Actuator {
            applied: believed.then_some(applied),
            acts,
        };
        (actuator, events)
    }
}

/// What of a speed is beyond a doubt of this size.
fn beyond(speed: f32, doubt: f32) -> f32 {
    if speed > doubt {
        speed - doubt
    } else if speed < -doubt {
        speed + doubt
    } else {
        0.0
    }
}

/// Looks for coordinates that do not change although the rotor moves.
#[derive(Debug, Clone, Copy, Default)]
struct Still {
    last: Option<[u32; 2]>,
    /// Predicted motion since the last change of each coordinate.
    way: Vec2,
    /// Coordinates that stood still when the last fault began, and of these the ones that still do.
    frozen: [bool; 2],
    awaited: [bool; 2],
    /// Whether a frozen coordinate has changed at this sample and none is awaited any more.
    measures: bool,
}

impl Still {
    /// Whether a coordinate has stood still for more than `most`. That holds until it changes.
    fn watch(&mut self, sensor_m: [f32; 2], velocity: Vec2, most: f32, faulty: bool) -> bool {
        let [x, y] = sensor_m.map(f32::to_bits);
        let [last_x, last_y] = self.last.replace([x, y]).unwrap_or([!x, !y]);
        let on = |way: f32, step: f32, same: bool| match same {
            false => 0.0,
            true if farther(way, most) => way,
            true => way + step,
        };
        self.way = Vec2::new(
            on(self.way.x, velocity.x, x == last_x),
            on(self.way.y, velocity.y, y == last_y),
        );
        if faulty {
            let ([frozen_x, frozen_y], [awaited_x, awaited_y]) = (self.frozen, self.awaited);
            self.awaited = [awaited_x && x == last_x, awaited_y && y == last_y];
            self.measures = ((frozen_x && x != last_x) || (frozen_y && y != last_y))
                && self.awaited == [false; 2];
        }
        farther(self.way.x, most) || farther(self.way.y, most)
    }

    /// A fault begins: from here on the model is no evidence.
    fn freeze(&mut self, most: f32) {
        self.frozen = [farther(self.way.x, most), farther(self.way.y, most)];
        self.awaited = self.frozen;
        self.way = Vec2::ZERO;
    }
}

fn farther(way: f32, most: f32) -> bool {
    way > most || way < -most
}
