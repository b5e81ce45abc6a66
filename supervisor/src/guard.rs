//! The only judge of what comes in: NaN, range, sequence. What passes here is finite.

use crate::coeffs::Coeffs;
use crate::signal::{Events, Limits, Sample, Status};
use crate::vec2::Vec2;

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
    pub(crate) limits: Limits,
    pub(crate) events: Events,
}

/// Memory of the guard.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Guard {
    last_sequence: Option<u32>,
    /// Ticks in a row that contradict `faulty`.
    streak: u32,
    faulty: bool,
}

impl Guard {
    pub(crate) fn judge(&mut self, sample: &Sample, coeffs: &Coeffs) -> Reading {
        let mut limits = Limits::empty();
        let mut events = Events::empty();
        let repeated = self.last_sequence == Some(sample.sequence);
        let expected = self
            .last_sequence
            .is_none_or(|last| sample.sequence == last.wrapping_add(1));
        if !expected {
            events |= Events::SEQUENCE;
        }
        self.last_sequence = Some(sample.sequence);

        let position = coeffs.position(sample.position_m);
        let plausible = position.is_finite()
            && position.length_squared() <= coeffs.position_limit * coeffs.position_limit;
        let used = plausible && !repeated;
        if !used {
            limits |= Limits::SAMPLE_REFUSED;
        }
        if used != self.faulty {
            self.streak = 0;
        } else {
            self.streak += 1;
            if self.streak >= coeffs.fault_ticks {
                self.streak = 0;
                self.faulty = !self.faulty;
                events |= if self.faulty {
                    Events::SENSOR_FAULT
                } else {
                    Events::SENSOR_OK
                };
            }
        }
        let spin = sample.spin_rad_s;
        let known = sample.status.contains(Status::SPIN_VALID) && spin.is_finite();
        let spin_sign = match known {
            true if spin > 0.0 => 1.0,
            true if spin < 0.0 => -1.0,
            _ => 0.0,
        };
        Reading {
            position: used.then_some(position),
            spin_sign,
            faulty: self.faulty,
            bearing_on: sample.status.contains(Status::BEARING_ON),
            limits,
            events,
        }
    }
}
