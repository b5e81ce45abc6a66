//! Spin of the rotor, eq. (2.7): held, free, or with its angle.

use crate::V2;
use crate::part::{Part, Weights};

/// A model of the spin.
pub(crate) trait Spin: Copy + Send + 'static {
    /// What changes in time.
    type State: Part;
    /// Whether the angle of the rotor is known, which an unbalance needs.
    const KNOWS_ANGLE: bool = true;
    /// State at the start of a run.
    fn start(&self, spin_rad_s: f64, phase_rad: f64) -> Self::State;
    /// Ω \[rad/s\].
    fn spin_rad_s(&self, state: &Self::State) -> f64;
    /// Ω replaced, where it is a state; says whether it was.
    fn set_spin_rad_s(&self, state: &mut Self::State, spin_rad_s: f64) -> bool;
    /// Angle σ of the rotor \[rad\]. Only called with an unbalance.
    fn phase_rad(&self, state: &Self::State, t_s: f64) -> f64;
    /// 1/J \[1/(kg m²)\]; 0 where the speed is held.
    fn inverse_inertia(&self) -> f64;
    /// Drive torque t_d \[N m\]; 0 where the speed is held, since friction decides it there.
    fn drive_torque_n_m(&self) -> f64;
    /// Drive torque replaced, where the speed is free; says whether it was.
    fn set_drive_torque_n_m(&mut self, _torque_n_m: f64) -> bool {
        false
    }
    /// Time derivative for a spin acceleration \[rad/s²\]. Linear in both.
    fn rates(&self, state: &Self::State, acceleration: f64) -> Self::State;
    /// What a change of the state changes in spin and angle.
    fn change(_change: &Self::State) -> (f64, f64) {
        (0.0, 0.0)
    }
    /// Angle of the rotor moved on \[rad\], where it is a state.
    fn turn(&self, _state: &mut Self::State, _angle_rad: f64) {}
    /// State after `dt_s` without contact.
    fn coast(&self, state: &Self::State, dt_s: f64) -> Self::State;
}

/// Speed held by the drive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Held {
    /// Ω \[rad/s\].
    pub spin_rad_s: f64,
    /// σ at t = 0 \[rad\].
    pub phase_rad: f64,
}

impl Spin for Held {
    type State = ();
    #[inline]
    fn start(&self, _spin_rad_s: f64, _phase_rad: f64) {}
    #[inline]
    fn spin_rad_s(&self, _state: &()) -> f64 {
        self.spin_rad_s
    }
    fn set_spin_rad_s(&self, _state: &mut (), _spin_rad_s: f64) -> bool {
        false
    }
    #[inline]
    fn phase_rad(&self, _state: &(), t_s: f64) -> f64 {
        self.phase_rad + self.spin_rad_s * t_s
    }
    #[inline]
    fn inverse_inertia(&self) -> f64 {
        0.0
    }
    #[inline]
    fn drive_torque_n_m(&self) -> f64 {
        0.0
    }
    #[inline]
    fn rates(&self, _state: &(), _acceleration: f64) {}
    #[inline]
    fn coast(&self, _state: &(), _dt_s: f64) {}
}

/// A number of the spin as a state: with `ANGLE` it counts in an error as an angle, without as a speed.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Single<const ANGLE: bool>(pub(crate) f64);

/// Ω as a state.
pub(crate) type SpinState = Single<false>;
/// σ as a state.
pub(crate) type PhaseState = Single<true>;

impl<const ANGLE: bool> Part for Single<ANGLE> {
    const STATES: usize = 1;
    fn write(&self, out: &mut [f64]) {
        out[0] = self.0;
    }
    fn read(from: &[f64]) -> Self {
        Self(from[0])
    }
    #[inline]
    fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.0 += factor * other.0;
    }
    #[inline]
    fn weighed_square(&self, weights: &Weights) -> f64 {
        let weight = if ANGLE { weights.phase } else { weights.spin };
        (self.0 * weight).powi(2)
    }
    #[inline]
    fn is_finite(&self) -> bool {
        self.0.is_finite()
    }
    #[inline]
    fn rotated(&self, _turn: V2) -> Self {
        *self
    }
    fn perp(&self) -> Self {
        Self::default()
    }
}

/// Speed driven and braked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Free {
    /// J \[kg m²\].
    pub inertia_kg_m2: f64,
    /// t_d \[N m\].
    pub drive_torque_n_m: f64,
}

impl Spin for Free {
    type State = SpinState;
    const KNOWS_ANGLE: bool = false;
    fn set_drive_torque_n_m(&mut self, torque_n_m: f64) -> bool {
        self.drive_torque_n_m = torque_n_m;
        true
    }
    fn change(change: &SpinState) -> (f64, f64) {
        (change.0, 0.0)
    }
    fn start(&self, spin_rad_s: f64, _phase_rad: f64) -> SpinState {
        Single(spin_rad_s)
    }
    #[inline]
    fn spin_rad_s(&self, state: &SpinState) -> f64 {
        state.0
    }
    fn set_spin_rad_s(&self, state: &mut SpinState, spin_rad_s: f64) -> bool {
        state.0 = spin_rad_s;
        true
    }
    fn phase_rad(&self, _state: &SpinState, _t_s: f64) -> f64 {
        0.0
    }
    #[inline]
    fn inverse_inertia(&self) -> f64 {
        1.0 / self.inertia_kg_m2
    }
    #[inline]
    fn drive_torque_n_m(&self) -> f64 {
        self.drive_torque_n_m
    }
    #[inline]
    fn rates(&self, _state: &SpinState, acceleration: f64) -> SpinState {
        Single(acceleration)
    }
    #[inline]
    fn coast(&self, state: &SpinState, dt_s: f64) -> SpinState {
        Single(state.0 + self.drive_torque_n_m * self.inverse_inertia() * dt_s)
    }
}

/// Speed and angle as states: for an unbalance at a free spin, and beside a race for a held one too, so that the number of
/// combinations of parts stays small.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phased {
    /// 1/J \[1/(kg m²)\]; 0 where the spin is held.
    pub inverse_inertia: f64,
    /// t_d \[N m\]; 0 where the spin is held.
    pub drive_torque_n_m: f64,
}

impl Phased {
    fn is_free(&self) -> bool {
        self.inverse_inertia > 0.0
    }
}

impl Spin for Phased {
    /// Ω, σ.
    type State = (SpinState, PhaseState);
    fn set_drive_torque_n_m(&mut self, torque_n_m: f64) -> bool {
        if self.is_free() {
            self.drive_torque_n_m = torque_n_m;
        }
        self.is_free()
    }
    fn change(change: &Self::State) -> (f64, f64) {
        (change.0.0, change.1.0)
    }
    fn turn(&self, state: &mut Self::State, angle_rad: f64) {
        state.1.0 += angle_rad;
    }
    fn start(&self, spin_rad_s: f64, phase_rad: f64) -> Self::State {
        (Single(spin_rad_s), Single(phase_rad))
    }
    #[inline]
    fn spin_rad_s(&self, state: &Self::State) -> f64 {
        state.0.0
    }
    fn set_spin_rad_s(&self, state: &mut Self::State, spin_rad_s: f64) -> bool {
        if self.is_free() {
            state.0.0 = spin_rad_s;
        }
        self.is_free()
    }
    #[inline]
    fn phase_rad(&self, state: &Self::State, _t_s: f64) -> f64 {
        state.1.0
    }
    #[inline]
    fn inverse_inertia(&self) -> f64 {
        self.inverse_inertia
    }
    #[inline]
    fn drive_torque_n_m(&self) -> f64 {
        self.drive_torque_n_m
    }
    #[inline]
    fn rates(&self, state: &Self::State, acceleration: f64) -> Self::State {
        (Single(acceleration), Single(state.0.0))
    }
    #[inline]
    fn coast(&self, (spin, phase): &Self::State, dt_s: f64) -> Self::State {
        let gain = self.drive_torque_n_m * self.inverse_inertia * dt_s;
        (
            Single(spin.0 + gain),
            Single(phase.0 + (spin.0 + 0.5 * gain) * dt_s),
        )
    }
}
