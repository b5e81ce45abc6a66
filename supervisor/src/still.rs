//! A sensor that is stuck: coordinates that do not change although the rotor moves.

use crate::scalar::Scalar;
use crate::vec2::Vec2;

/// What is remembered of each coordinate.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Still<S> {
    pub(crate) last: Option<Vec2<S>>,
    /// Predicted motion since the last change of each coordinate, as a sum of speeds over ticks.
    pub(crate) way: Vec2<S>,
    /// Coordinates that have stood still since the last fault began. One that has changed may rest after it, as
    /// the rotor may.
    pub(crate) awaited: [bool; 2],
}

impl<S: Scalar> Still<S> {
    /// Whether a coordinate has stood still for more than `most`. That holds until it changes.
    pub(crate) fn watch(
        &mut self,
        position: Vec2<S>,
        velocity: Vec2<S>,
        most: S,
        faulty: bool,
    ) -> bool {
        let [x, y] = match self.last.replace(position) {
            Some(last) => [position.x == last.x, position.y == last.y],
            None => [false; 2],
        };
        if !(x || y || faulty) {
            self.way = Vec2::ZERO;
            return false;
        }
        let on = |way: S, step: S, same: bool| match same {
            false => S::ZERO,
            true if farther(way, most) => way,
            true => way + step,
        };
        self.way = Vec2::new(on(self.way.x, velocity.x, x), on(self.way.y, velocity.y, y));
        if faulty {
            let [awaited_x, awaited_y] = self.awaited;
            self.awaited = [awaited_x && x, awaited_y && y];
        }
        farther(self.way.x, most) || farther(self.way.y, most)
    }

    /// A fault begins: from here on the model is no evidence.
    pub(crate) fn freeze(&mut self, most: S) {
        self.awaited = [farther(self.way.x, most), farther(self.way.y, most)];
        self.way = Vec2::ZERO;
    }

    /// After a change of the unit of length no coordinate can be compared with the one before.
    pub(crate) fn rescale(&mut self) {
        self.last = None;
    }
}

fn farther<S: Scalar>(way: S, most: S) -> bool {
    way > most || way < -most
}
