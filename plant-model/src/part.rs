//! States built of parts: what a scene lacks is the unit type and costs nothing.

use crate::V2;
use crate::vector::{perp, rotate};

/// Reciprocal scales against which the error of one step is weighed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// Per metre.
    pub position: f64,
    /// Per metre of the rotor against its ring, on which the contact force acts.
    pub gap: f64,
    /// Per metre per second.
    pub velocity: f64,
    /// Per radian per second.
    pub spin: f64,
    /// Per radian.
    pub phase: f64,
    /// Per newton.
    pub force: f64,
}

/// A piece of the state as the integrators see it: a vector with a weighed length.
pub(crate) trait Part: Copy + Default + Send + 'static {
    /// Number of scalar states.
    const STATES: usize;
    /// `self += factor · other`.
    fn add_scaled(&mut self, factor: f64, other: &Self);
    /// Σ (component / scale)².
    fn weighed_square(&self, weights: &Weights) -> f64;
    /// Whether every component is finite.
    fn is_finite(&self) -> bool;
    /// Writes the components to the first [`Part::STATES`] places.
    fn write(&self, out: &mut [f64]);
    /// Reads them back.
    fn read(from: &[f64]) -> Self;
    /// Every plane vector turned counter-clockwise; `turn` holds cosine and sine of the angle.
    fn rotated(&self, turn: V2) -> Self;
    /// Every plane vector turned by a quarter, everything else zero: what turning at 1 rad/s adds to
    /// the rates.
    fn perp(&self) -> Self;
}

impl Part for () {
    fn write(&self, _out: &mut [f64]) {}
    fn read(_from: &[f64]) -> Self {}
    const STATES: usize = 0;
    #[inline]
    fn add_scaled(&mut self, _factor: f64, _other: &Self) {}
    #[inline]
    fn weighed_square(&self, _weights: &Weights) -> f64 {
        0.0
    }
    #[inline]
    fn is_finite(&self) -> bool {
        true
    }
    fn rotated(&self, _turn: V2) -> Self {}
    fn perp(&self) -> Self {}
}

/// A mass that moves in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Body {
    /// Position \[m\].
    pub position: V2,
    /// Velocity \[m/s\].
    pub velocity: V2,
}

impl Part for Body {
    const STATES: usize = 4;
    fn write(&self, out: &mut [f64]) {
        let Self { position, velocity } = self;
        let components = [position.x, position.y, velocity.x, velocity.y];
        for (o, x) in out.iter_mut().zip(components) {
            *o = x;
        }
    }
    fn read(from: &[f64]) -> Self {
        let at = |i: usize| from.get(i).copied().unwrap_or_default();
        Self {
            position: V2::new(at(0), at(1)),
            velocity: V2::new(at(2), at(3)),
        }
    }
    #[inline]
    fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.position += factor * other.position;
        self.velocity += factor * other.velocity;
    }
    #[inline]
    fn weighed_square(&self, weights: &Weights) -> f64 {
        self.position.norm_squared() * weights.position * weights.position
            + self.velocity.norm_squared() * weights.velocity * weights.velocity
    }
    #[inline]
    fn is_finite(&self) -> bool {
        self.position
            .iter()
            .chain(&self.velocity)
            .all(|x| x.is_finite())
    }
    #[inline]
    fn rotated(&self, turn: V2) -> Self {
        Self {
            position: rotate(self.position, turn),
            velocity: rotate(self.velocity, turn),
        }
    }
    fn perp(&self) -> Self {
        Self {
            position: perp(self.position),
            velocity: perp(self.velocity),
        }
    }
}

/// Two parts side by side.
impl<A: Part, B: Part> Part for (A, B) {
    const STATES: usize = A::STATES + B::STATES;
    fn write(&self, out: &mut [f64]) {
        let (a, b) = out.split_at_mut(A::STATES);
        self.0.write(a);
        self.1.write(b);
    }
    fn read(from: &[f64]) -> Self {
        let (a, b) = from.split_at(A::STATES);
        (A::read(a), B::read(b))
    }
    #[inline]
    fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.0.add_scaled(factor, &other.0);
        self.1.add_scaled(factor, &other.1);
    }
    #[inline]
    fn weighed_square(&self, weights: &Weights) -> f64 {
        self.0.weighed_square(weights) + self.1.weighed_square(weights)
    }
    #[inline]
    fn is_finite(&self) -> bool {
        self.0.is_finite() && self.1.is_finite()
    }
    #[inline]
    fn rotated(&self, turn: V2) -> Self {
        (self.0.rotated(turn), self.1.rotated(turn))
    }
    fn perp(&self) -> Self {
        (self.0.perp(), self.1.perp())
    }
}
