//! Whether the drive does what it is told, where its force is measured.

use crate::coeffs::Coeffs;
use crate::scalar::Scalar;
use crate::signal::Status;
use crate::vec2::Vec2;

/// Largest deviation of the measured force from the model of amplifier and delay that is obedience \[caps\]: a lag
/// twice or half as long as configured makes it no larger, whatever is commanded …
const DOUBT: f32 = 0.5;
/// … and the largest as a share of the modelled force: a weak drive obeys.
const WEAK: f32 = 0.75;
/// What a slow one comes nearer to its command in a tick, at least \[caps\].
const PROGRESS: f32 = 0.02;
/// Ticks for which an axis that does not obey gets nothing, over those that made it one.
const REST: i8 = 8;
/// Most ticks that make one: what `i8` leaves room for.
const MOST_TICKS: u16 = 15;

/// Memory of the monitor.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Drive<S> {
    /// Force that the model of amplifier and delay delivers at this tick.
    pub(crate) modelled: Vec2<S>,
    /// Of each axis: ticks in a row in which it did not obey; or, negative, how long it will get nothing.
    off: [i8; 2],
}

impl<S: Scalar> Drive<S> {
    /// Axes that get nothing because they do not obey.
    #[inline]
    pub(crate) fn lost(&self) -> Status {
        if self.off == [0; 2] {
            return Status::empty();
        }
        let mut lost = Status::empty();
        for (ticks, axis) in self.off.into_iter().zip(Status::LOST_AXES) {
            if ticks < 0 {
                lost |= axis;
            }
        }
        lost
    }

    /// A tick in which nobody can tell: not measured, or switched off.
    #[inline]
    pub(crate) fn unseen(&mut self) {
        self.off = [0; 2];
    }

    /// Compares the force measured now with the model; `before` is the one of the last tick, and `due` the command.
    #[inline(never)]
    pub(crate) fn watch(
        &mut self,
        now: Vec2<S>,
        (before, due): (Vec2<S>, Vec2<S>),
        coeffs: &Coeffs<S>,
    ) {
        let deviation = now - self.modelled;
        let doubt = S::of(DOUBT);
        let usual = deviation.x.size() <= doubt && deviation.y.size() <= doubt;
        if usual && self.off == [0; 2] {
            return;
        }
        let most = coeffs.fault_ticks.min(MOST_TICKS) as i8;
        let [x, y] = &mut self.off;
        for (ticks, now, before, due, modelled) in [
            (x, now.x, before.x, due.x, self.modelled.x),
            (y, now.y, before.y, due.y, self.modelled.y),
        ] {
            let nearer = (due - before).size() - (due - now).size();
            let doubt = doubt.or_more(modelled.size() * S::of(WEAK));
            *ticks = if *ticks < 0 {
                *ticks + 1
            } else if (now - modelled).size() <= doubt || nearer > S::of(PROGRESS) {
                0
            } else if *ticks + 1 < most {
                *ticks + 1
            } else {
                -most * REST
            };
        }
    }
}
