//! A retainer ball bearing: the race that the rotor touches has a spin of its own,
//! J_i·Ω̇_i = −R_i·s − b·Ω_i, eq. (2.37).

use super::{PhaseState, Single, Spin, SpinState};

/// The race, without its spin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Race {
    /// R_i \[m\].
    pub(crate) radius_m: f64,
    /// J_i \[kg m²\].
    pub(crate) inertia_kg_m2: f64,
    /// b \[N m s\].
    pub(crate) drag_n_m_s: f64,
    /// Ω_i at the start \[rad/s\].
    pub(crate) start_spin_rad_s: f64,
}

impl Race {
    /// Ω̇_i under sliding friction on the rotor \[rad/s²\]. Linear in both.
    #[inline]
    pub(crate) fn acceleration(&self, spin_rad_s: f64, sliding_n: f64) -> f64 {
        -(self.radius_m * sliding_n + self.drag_n_m_s * spin_rad_s) / self.inertia_kg_m2
    }

    /// What the drag adds to the sliding acceleration: the surface falls back \[m/s²\].
    #[inline]
    pub(crate) fn falling_back_m_s2(&self, spin_rad_s: f64) -> f64 {
        self.radius_m * self.drag_n_m_s / self.inertia_kg_m2 * spin_rad_s
    }

    /// R_i²/J_i: how easily the surface gives way \[1/kg\].
    #[inline]
    pub(crate) fn mobility(&self) -> f64 {
        self.radius_m * self.radius_m / self.inertia_kg_m2
    }

    /// Energy of the spin \[J\].
    #[inline]
    pub(crate) fn stored_j(&self, spin_rad_s: f64) -> f64 {
        0.5 * self.inertia_kg_m2 * spin_rad_s * spin_rad_s
    }

    /// Power lost in the bearing \[W\].
    #[inline]
    pub(crate) fn drag_w(&self, spin_rad_s: f64) -> f64 {
        self.drag_n_m_s * spin_rad_s * spin_rad_s
    }

    /// Energy lost in the bearing while nothing but the drag acts \[J\].
    #[inline]
    pub(crate) fn coasting_loss_j(&self, from_rad_s: f64, to_rad_s: f64) -> f64 {
        0.5 * self.inertia_kg_m2 * (from_rad_s - to_rad_s) * (from_rad_s + to_rad_s)
    }
}

/// Spin and angle of the rotor beside a race. One type for held and free spin: what a race costs, it
/// costs in contact, and the number of combinations of parts stays small.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raced {
    /// 1/J \[1/(kg m²)\]; 0 where the spin is held.
    pub(crate) inverse_inertia: f64,
    /// t_d \[N m\]; 0 where the spin is held.
    pub(crate) drive_torque_n_m: f64,
    /// The race.
    pub(crate) race: Race,
}

impl Spin for Raced {
    /// Ω, σ, Ω_i.
    type State = ((SpinState, PhaseState), SpinState);
    fn set_drive_torque_n_m(&mut self, torque_n_m: f64) -> bool {
        let free = self.inverse_inertia > 0.0;
        if free {
            self.drive_torque_n_m = torque_n_m;
        }
        free
    }
    fn change(change: &Self::State) -> (f64, f64) {
        (change.0.0.0, change.0.1.0)
    }
    fn turn(&self, state: &mut Self::State, angle_rad: f64) {
        state.0.1.0 += angle_rad;
    }
    fn start(&self, spin_rad_s: f64, phase_rad: f64) -> Self::State {
        (
            (Single(spin_rad_s), Single(phase_rad)),
            Single(self.race.start_spin_rad_s),
        )
    }
    #[inline]
    fn spin_rad_s(&self, state: &Self::State) -> f64 {
        state.0.0.0
    }
    fn set_spin_rad_s(&self, state: &mut Self::State, spin_rad_s: f64) -> bool {
        let free = self.inverse_inertia > 0.0;
        if free {
            state.0.0.0 = spin_rad_s;
        }
        free
    }
    #[inline]
    fn phase_rad(&self, state: &Self::State, _t_s: f64) -> f64 {
        state.0.1.0
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
    fn rates(&self, state: &Self::State, acceleration: f64, sliding_n: f64) -> Self::State {
        let race = self.race.acceleration(state.1.0, sliding_n);
        ((Single(acceleration), Single(state.0.0.0)), Single(race))
    }
    #[inline]
    fn race(&self) -> Option<&Race> {
        Some(&self.race)
    }
    #[inline]
    fn race_rad_s(state: &Self::State) -> f64 {
        state.1.0
    }
    #[inline]
    fn set_race_rad_s(state: &mut Self::State, spin_rad_s: f64) {
        state.1.0 = spin_rad_s;
    }
    #[inline]
    fn coast(&self, state: &Self::State, dt_s: f64) -> Self::State {
        let ((spin, phase), race) = *state;
        let gain = self.drive_torque_n_m * self.inverse_inertia * dt_s;
        let decay = (-self.race.drag_n_m_s / self.race.inertia_kg_m2 * dt_s).exp();
        (
            (
                Single(spin.0 + gain),
                Single(phase.0 + (spin.0 + 0.5 * gain) * dt_s),
            ),
            Single(race.0 * decay),
        )
    }
}
