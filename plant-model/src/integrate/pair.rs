//! What an embedded one-step method must give, so that step control, events and audit are written once.

use super::frame::Frame;
use crate::energy::Flows;
use crate::part::{Part, Weights};

/// What the integrators need of an evaluation of the field.
pub(crate) trait Rates<Y>: Copy + Default {
    /// Time derivative of the state.
    fn rates(&self) -> &Y;
    /// Powers, integrated beside the state.
    fn powers(&self) -> Flows;
}

/// A point from which a step starts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin<'a, Y, E> {
    pub(crate) t_s: f64,
    pub(crate) y: &'a Y,
    /// The field there.
    pub(crate) first: &'a E,
}

/// The field, and its derivative along a direction of state and time.
pub(crate) trait Field<Y, E> {
    /// The field at a point.
    fn at(&mut self, t_s: f64, y: &Y) -> E;
    /// d/dε of the rates at (t, y + ε·dy).
    fn along(&mut self, t_s: f64, y: &Y, dy: &Y) -> Y;
    /// How the direction in which the field is stiff turns, as seen from a point with the field there.
    fn frame(&self, _y: &Y, _first: &E) -> Frame {
        Frame::default()
    }
    /// Takes note of matrices factorised for one step size.
    fn factorised(&mut self) {}
}

/// An embedded pair with dense output. Stages are kept from step to step, so that no step allocates.
pub(crate) trait Pair<Y: Part, E: Rates<Y>> {
    /// Dense output of a step.
    type Dense;
    /// The error norm falls with this power of the step.
    const ERROR_POWER: f64;
    /// Longest step that can be stable, in periods of the fastest contact motion over 2π.
    const LONGEST: f64;
    /// Longest first step of a contact, in the same unit.
    const FIRST: f64;
    /// A pair that has done nothing.
    fn new() -> Self;
    /// Prepares for attempts from `origin`.
    fn begin(&mut self, _origin: &Origin<'_, Y, E>, _field: &mut impl Field<Y, E>) {}
    /// Steps from `origin` by `step_s`. Returns the end point and the error norm, below 1 where the
    /// step meets the weights.
    fn step(
        &mut self,
        origin: &Origin<'_, Y, E>,
        step_s: f64,
        weights: &Weights,
        field: &mut impl Field<Y, E>,
    ) -> (Y, f64);
    /// Longest step, in lengths of the last attempt, in which the iteration inside would converge well.
    /// None where there is no iteration, or nothing was learnt of it.
    fn reach(&self) -> Option<f64> {
        None
    }
    /// Takes note of the field at the end of the last step.
    fn set_end(&mut self, end: E);
    /// The field at start, stages and end of the last step.
    fn seen(&self) -> &[E];
    /// Dense output of the last step, after [`Pair::set_end`].
    fn dense(&mut self, field: &mut impl Field<Y, E>) -> Self::Dense;
    /// State at θ in [0, 1] of it.
    fn dense_at(dense: &Self::Dense, theta: f64) -> Y;
    /// Energy that went through each door in the last step, after [`Pair::set_end`].
    fn flows(&mut self, field: &mut impl Field<Y, E>) -> Flows;
}
