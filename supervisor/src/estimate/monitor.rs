//! Whether the drive does what is commanded, where its force is measured.

use crate::border::coeffs::Coeffs;
use crate::border::parts::AXIS_MONITOR;
use crate::border::signal::Status;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::Actuator;

/// Largest deviation of the measured force from the model of amplifier and delay that is tracking \[caps\]: a lag
/// twice or half as long as configured makes it no larger, whatever is commanded …
const DOUBT: f32 = 0.5;
/// … and the largest as a share of the modelled force: a weak drive tracks.
const WEAK: f32 = 0.75;
/// A force that is next to none \[caps\].
const LITTLE: f32 = 0.3;
/// How fast a slow one comes nearer to its command, at least \[caps/t₀\].
const PROGRESS: f32 = 0.5;
/// Ticks for which an axis that does not track its command gets nothing, over those that made it one.
const REST: i8 = 8;
/// Most ticks that make one: what `i8` leaves room for.
const MOST_TICKS: u16 = 15;

/// Memory of the monitor.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ActuatorMonitor<S> {
    /// What the model of amplifier and delay makes of the first force whose command is known of those that were measured
    /// without a break.
    modelled: Vec2<S>,
    /// How many were, as far as that matters.
    seen: u8,
    /// Of each axis: ticks in a row in which it did not track; or, negative, how long it will get nothing.
    off: [i8; 2],
}

words_of_fields!(ActuatorMonitor<S> { modelled, seen, off });

impl<S: Scalar> ActuatorMonitor<S> {
    /// Axes that get nothing because they do not track. Where the supervisor does not act it takes nothing away.
    #[inline]
    pub(crate) fn lost(&self, status: Status) -> Status {
        if !AXIS_MONITOR || self.off == [0; 2] {
            return Status::empty();
        }
        self.resting(status)
    }

    #[cold]
    fn resting(&self, status: Status) -> Status {
        let mut lost = Status::empty();
        if status & (Status::BEARING_ON | Status::SHADOW) == Status::BEARING_ON {
            for (ticks, axis) in self.off.into_iter().zip(Status::LOST_AXES) {
                if ticks < 0 {
                    lost |= axis;
                }
            }
        }
        lost
    }

    /// The force is not measured, or not at every tick: nobody can tell.
    #[inline]
    pub(crate) fn unseen(&mut self) {
        self.seen = 0;
        if self.off != [0; 2] {
            self.rest();
        }
    }

    /// What rests goes on to, what was counted is forgotten.
    #[cold]
    #[inline(never)]
    fn rest(&mut self) {
        self.off = self.off.map(|ticks| (ticks + 1).min(0));
    }

    /// The drive is switched off, or not the supervisor's.
    #[inline]
    pub(crate) fn switched_off(&mut self) {
        *self = Self::default();
    }

    /// Compares the force measured now with the model; `before` is the one of the last tick, and `due` the command.
    #[inline]
    pub(crate) fn watch(
        &mut self,
        now: Vec2<S>,
        before: Vec2<S>,
        due: Vec2<S>,
        actuator: &Actuator<S>,
        coeffs: &Coeffs<S>,
    ) {
        let mut deviation = Vec2::ZERO;
        if self.seen > coeffs.delay {
            let (modelled, _) = lagging(self.modelled, due, coeffs);
            // Of an axis that is lost nothing is expected.
            deviation = actuator.carried(now - modelled);
        } else {
            // What the bearing carries at first, and as long as the delay, was not commanded here.
            self.seen += 1;
        }
        self.modelled = now - deviation;
        let modelled = self.modelled;
        let doubt = S::from_f32(DOUBT);
        let usual = deviation.x.abs() <= doubt && deviation.y.abs() <= doubt;
        if usual && self.off == [0; 2] {
            return;
        }
        let progress = S::from_f32(PROGRESS) * coeffs.tick;
        let most = coeffs.guard.fault_ticks.min(MOST_TICKS) as i8;
        // Power that is gone, or comes back: a drive that gives next to nothing takes nothing away.
        let powerless = now.x.abs() <= S::from_f32(LITTLE) && now.y.abs() <= S::from_f32(LITTLE);
        let [x, y] = &mut self.off;
        for (ticks, deviation, modelled, now, before, due) in [
            (x, deviation.x, modelled.x, now.x, before.x, due.x),
            (y, deviation.y, modelled.y, now.y, before.y, due.y),
        ] {
            let nearer = (due - before).abs() - (due - now).abs();
            let doubt = doubt.max(modelled.abs() * S::from_f32(WEAK));
            *ticks = if *ticks < 0 {
                *ticks + 1
            } else if powerless {
                *ticks
            } else if deviation.abs() <= doubt || nearer > progress {
                0
            } else if *ticks + 1 < most {
                *ticks + 1
            } else {
                -most * REST
            };
        }
    }

    /// After a change of the unit of force.
    pub(crate) fn rescale(&mut self, force: S) {
        self.modelled = self.modelled * force;
    }
}

/// Force of a first-order actuator after a tick, and its mean over it.
#[inline]
pub(crate) fn lagging<S: Scalar>(
    before: Vec2<S>,
    command: Vec2<S>,
    coeffs: &Coeffs<S>,
) -> (Vec2<S>, Vec2<S>) {
    let away = before - command;
    (
        command + away * coeffs.lag_left,
        command + away * coeffs.lag_mean,
    )
}
