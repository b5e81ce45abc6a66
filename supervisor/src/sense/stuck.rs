//! A sensor that is stuck: coordinates that do not change although the rotor moves.

use crate::border::coeffs::Coeffs;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::SampleFlags;

/// What is remembered of a coordinate. `seen`: there is a last value.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Coordinate<S> {
    last: S,
    seen: bool,
    /// Predicted motion since its last change, as a sum of speeds over ticks.
    way: S,
    /// Samples in a row in which that was too much.
    stuck: u8,
    /// Samples since its last change.
    unchanged: u8,
    /// It has stood still since the last fault began. One that has changed may rest after it, as the rotor may.
    awaited: bool,
}

words_of_fields!(Coordinate<S> { last, seen, way, stuck, unchanged, awaited });

/// Both coordinates.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StuckDetector<S> {
    at: [Coordinate<S>; 2],
    /// Step of the converter, which may be coarser than was configured.
    step: S,
}

words_of_fields!(StuckDetector<S> { at, step });

/// A way that no converter hides \[clearances\], and in steps of a coarse one: noise of a step beside it seems to be speed.
const FAR: f32 = 0.1;
const FAR_STEPS: f32 = 8.0;

/// A change that is longer is one of the rotor \[clearances\].
const COARSEST: f32 = 0.03;

/// What a sample says of coordinates that stand still.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Standstill {
    /// For how many samples in a row one has, for more than the estimate can be wrong; holds until it changes.
    pub(crate) samples: u8,
    /// For how many neither has changed.
    pub(crate) both: u8,
    /// The rotor must have gone too far meanwhile for a coarse converter to hide it.
    pub(crate) far: bool,
}

impl<S: Scalar> StuckDetector<S> {
    /// Looks at a sample, with the velocity that the rotor is known to have.
    pub(crate) fn watch(
        &mut self,
        position: Vec2<S>,
        velocity: Vec2<S>,
        coeffs: &Coeffs<S>,
    ) -> Standstill {
        let [x, y] = &mut self.at;
        for (coordinate, now) in [(&*x, position.x), (&*y, position.y)] {
            self.step = coordinate.coarseness(now, self.step);
        }
        if x.changes(position.x) && y.changes(position.y) {
            self.moved_to(position);
            return Standstill::default();
        }
        let twice = (self.step + self.step) * coeffs.per_tick;
        let most = coeffs.guard.sensor_speeds.max(twice);
        let samples =
            (x.watch(position.x, velocity.x, most)).max(y.watch(position.y, velocity.y, most));
        Standstill {
            samples,
            both: x.unchanged.min(y.unchanged),
            far: x.is_far(coeffs.tick, self.step) || y.is_far(coeffs.tick, self.step),
        }
    }

    /// Coordinates that stand still beside one that has done so for more than the estimate can be wrong, that one with them.
    pub(crate) fn stuck(&self) -> SampleFlags {
        let [x, y] = &self.at;
        let mut flags = SampleFlags::empty();
        flags.set(SampleFlags::X_BAD, x.stands_still());
        flags.set(SampleFlags::Y_BAD, y.stands_still());
        flags
    }

    /// Coordinates that are far off and have not changed for so many samples, and count as stuck from here on: what jumps and
    /// then stands still is no rotor.
    pub(crate) fn jumped(&mut self, off: Vec2<S>, samples: u8) -> SampleFlags {
        let [x, y] = &mut self.at;
        let mut flags = SampleFlags::empty();
        for (coordinate, off, bad) in [
            (x, off.x, SampleFlags::X_BAD),
            (y, off.y, SampleFlags::Y_BAD),
        ] {
            if off.abs() > S::from_f32(FAR) && coordinate.unchanged >= samples {
                coordinate.stuck = coordinate.stuck.max(1);
                flags |= bad;
            }
        }
        flags
    }

    /// After samples that nobody showed it, each of which changed in both coordinates.
    pub(crate) fn moved_to(&mut self, last: Vec2<S>) {
        let [x, y] = &mut self.at;
        x.moved_to(last.x);
        y.moved_to(last.y);
    }

    /// The coordinate beside one that is bad, and its value. The first one is its own last.
    pub(crate) fn beside(
        &mut self,
        bad: SampleFlags,
        position: Vec2<S>,
    ) -> (&mut Coordinate<S>, S) {
        let [x, y] = &mut self.at;
        let (coordinate, now) = if bad == SampleFlags::X_BAD {
            (y, position.y)
        } else {
            (x, position.x)
        };
        if !coordinate.seen {
            coordinate.moved_to(now);
        } else if now != coordinate.last {
            coordinate.moved_to(coordinate.last);
        }
        (coordinate, now)
    }

    /// Whether a coordinate has not changed since the last fault began.
    pub(crate) fn is_awaited(&self) -> bool {
        self.at[0].awaited || self.at[1].awaited
    }

    /// A fault begins, in which these coordinates are the ones that are stuck: from here on the model is no evidence.
    pub(crate) fn freeze(&mut self, stuck: SampleFlags) {
        for (coordinate, bad) in (self.at.iter_mut()).zip([SampleFlags::X_BAD, SampleFlags::Y_BAD])
        {
            coordinate.awaited = coordinate.stuck > 0 || stuck.contains(bad);
            (coordinate.way, coordinate.stuck) = (S::ZERO, 0);
        }
    }

    /// After a change of the unit of length no coordinate can be compared with the one before.
    pub(crate) fn rescale(&mut self) {
        for coordinate in &mut self.at {
            coordinate.seen = false;
        }
    }
}

impl<S: Scalar> Coordinate<S> {
    /// Step of a converter: what ends a standstill is one at least, and no smaller change is none.
    fn coarseness(&self, now: S, step: S) -> S {
        let change = self.step(now);
        if !self.seen || change == S::ZERO {
            step
        } else if self.unchanged > 0 {
            change.min(S::from_f32(COARSEST))
        } else {
            step.min(change)
        }
    }

    /// Whether its way, a sum of speeds over ticks, is more than a converter of this step hides.
    fn is_far(&self, tick: S, step: S) -> bool {
        let hidden = (step * S::from_f32(FAR_STEPS)).max(S::from_f32(FAR));
        self.stuck > 0 && (self.way * tick).abs() > hidden
    }

    /// In the last sample.
    fn stands_still(&self) -> bool {
        self.stuck > 0 || self.unchanged > 0
    }

    fn changes(&self, now: S) -> bool {
        !self.seen || now != self.last
    }

    fn watch(&mut self, now: S, step: S, most: S) -> u8 {
        if self.changes(now) {
            self.moved_to(now);
            return 0;
        }
        self.unchanged = self.unchanged.saturating_add(1);
        self.way = self.way + step;
        if self.stuck > 0 || self.way > most || self.way < -most {
            self.stuck = self.stuck.saturating_add(1);
        }
        self.stuck
    }

    fn moved_to(&mut self, last: S) {
        *self = Self {
            last,
            seen: true,
            ..Self::default()
        };
    }

    /// The way to a value since the one that was accepted last.
    pub(crate) fn step(&self, now: S) -> S {
        (now - self.last).abs()
    }

    pub(crate) fn accept(&mut self, now: S) {
        self.last = now;
    }

    /// Whether it has not changed since the last fault began.
    pub(crate) fn is_awaited(&self) -> bool {
        self.awaited
    }
}
