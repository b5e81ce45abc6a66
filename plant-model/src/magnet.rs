//! The magnet's amplifier: a delivered force that follows the command at once or with a lag.

use crate::V2;
use crate::part::{Part, Weights};
use crate::series::{INVERSE, Series};
use crate::vector::{perp, rotate};

/// A model of the amplifier. Commands arrive already limited to the force cap.
pub(crate) trait Amplifier: Copy + Send + 'static {
    /// What changes in time.
    type State: Part;
    /// Whether the delivered force lags behind the command.
    const LAGS: bool;
    /// Delivered force \[N\].
    fn force_n(&self, state: &Self::State, command_n: V2) -> V2;
    /// Time derivative.
    fn rates(&self, state: &Self::State, command_n: V2) -> Self::State;
    /// Fastest rate \[1/s\].
    fn fastest_rate_rad_s(&self) -> f64;
    /// Fills `out` with the delivered force over `step_s` from a state under a held command \[N\]. Where nothing lags
    /// only entry 0 is touched.
    fn series(&self, out: &mut Series, start: (&Self::State, V2), step_s: f64, order: usize);
    /// State at θ of that series.
    fn at(series: &Series, theta: f64, order: usize) -> Self::State;
}

/// Delivers what is commanded: part of no size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Direct;

impl Amplifier for Direct {
    type State = ();
    const LAGS: bool = false;
    #[inline]
    fn force_n(&self, _state: &(), command_n: V2) -> V2 {
        command_n
    }
    #[inline]
    fn rates(&self, _state: &(), _command_n: V2) {}
    fn fastest_rate_rad_s(&self) -> f64 {
        0.0
    }
    #[inline]
    fn series(&self, out: &mut Series, (_state, command_n): (&(), V2), _: f64, _: usize) {
        out.0[0] = command_n;
    }
    #[inline]
    fn at(_series: &Series, _theta: f64, _order: usize) {}
}

/// Delivered force as a state.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ForceState(V2);

impl Part for ForceState {
    const STATES: usize = 2;
    fn write(&self, out: &mut [f64]) {
        out[0] = self.0.x;
        out[1] = self.0.y;
    }
    fn read(from: &[f64]) -> Self {
        Self(V2::new(from[0], from[1]))
    }
    #[inline]
    fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.0 += factor * other.0;
    }
    #[inline]
    fn weighed_square(&self, weights: &Weights) -> f64 {
        self.0.norm_squared() * weights.force * weights.force
    }
    #[inline]
    fn is_finite(&self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
    #[inline]
    fn rotated(&self, turn: V2) -> Self {
        Self(rotate(self.0, turn))
    }
    fn perp(&self) -> Self {
        Self(perp(self.0))
    }
}

/// First-order lag τ·ḟ = command − f.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lagged {
    /// τ \[s\], > 0.
    pub lag_s: f64,
}

impl Amplifier for Lagged {
    type State = ForceState;
    const LAGS: bool = true;
    #[inline]
    fn force_n(&self, state: &ForceState, _command_n: V2) -> V2 {
        state.0
    }
    #[inline]
    fn rates(&self, state: &ForceState, command_n: V2) -> ForceState {
        ForceState((command_n - state.0) / self.lag_s)
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        1.0 / self.lag_s
    }
    fn series(
        &self,
        out: &mut Series,
        (state, command_n): (&ForceState, V2),
        step_s: f64,
        order: usize,
    ) {
        out.0[0] = state.0;
        let ratio = step_s / self.lag_s;
        let mut term = ratio * (command_n - state.0);
        for (k, c) in out.0[..=order].iter_mut().enumerate().skip(1) {
            *c = term;
            term *= -ratio * INVERSE[k + 1];
        }
    }
    #[inline]
    fn at(series: &Series, theta: f64, order: usize) -> ForceState {
        ForceState(series.at(theta, order))
    }
}
