//! State of the plant: that of its parts, one after the other.

use crate::V2;
use crate::magnet::Amplifier;
use crate::part::{Body, Part, Weights};
use crate::plane::Raceway;
use crate::spin::Spin;
use crate::stator::{Rings, Stator};

/// State of one combination of parts.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct State<S, W, M, R> {
    pub(crate) rotor: Body,
    pub(crate) stator: S,
    pub(crate) spin: W,
    pub(crate) race: R,
    pub(crate) force: M,
}

pub(crate) type StateOf<S, W, M, R> =
    State<<S as Stator>::State, <W as Spin>::State, <M as Amplifier>::State, <R as Raceway>::State>;

impl<S: Rings, W: Part, M: Part, R: Part> Part for State<S, W, M, R> {
    const STATES: usize = Body::STATES + S::STATES + W::STATES + R::STATES + M::STATES;
    fn write(&self, out: &mut [f64]) {
        let (rotor, rest) = out.split_at_mut(Body::STATES);
        let (stator, rest) = rest.split_at_mut(S::STATES);
        let (spin, rest) = rest.split_at_mut(W::STATES);
        let (race, force) = rest.split_at_mut(R::STATES);
        self.rotor.write(rotor);
        self.stator.write(stator);
        self.spin.write(spin);
        self.race.write(race);
        self.force.write(force);
    }
    fn read(from: &[f64]) -> Self {
        let (rotor, rest) = from.split_at(Body::STATES);
        let (stator, rest) = rest.split_at(S::STATES);
        let (spin, rest) = rest.split_at(W::STATES);
        let (race, force) = rest.split_at(R::STATES);
        Self {
            rotor: Body::read(rotor),
            stator: S::read(stator),
            spin: W::read(spin),
            race: R::read(race),
            force: M::read(force),
        }
    }
    #[inline]
    fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.rotor.add_scaled(factor, &other.rotor);
        self.stator.add_scaled(factor, &other.stator);
        self.spin.add_scaled(factor, &other.spin);
        self.race.add_scaled(factor, &other.race);
        self.force.add_scaled(factor, &other.force);
    }
    #[inline]
    fn weighed_square(&self, weights: &Weights) -> f64 {
        let gap = self.rotor.position - self.stator.inner().position;
        gap.norm_squared() * weights.gap * weights.gap
            + self.rotor.weighed_square(weights)
            + self.stator.weighed_square(weights)
            + (self.spin.weighed_square(weights) + self.race.weighed_square(weights))
            + self.force.weighed_square(weights)
    }
    #[inline]
    fn is_finite(&self) -> bool {
        self.rotor.is_finite()
            && self.stator.is_finite()
            && self.spin.is_finite()
            && self.race.is_finite()
            && self.force.is_finite()
    }
    #[inline]
    fn rotated(&self, turn: V2) -> Self {
        Self {
            rotor: self.rotor.rotated(turn),
            stator: self.stator.rotated(turn),
            spin: self.spin.rotated(turn),
            race: self.race.rotated(turn),
            force: self.force.rotated(turn),
        }
    }
    fn perp(&self) -> Self {
        Self {
            rotor: self.rotor.perp(),
            stator: self.stator.perp(),
            spin: self.spin.perp(),
            race: self.race.perp(),
            force: self.force.perp(),
        }
    }
}
