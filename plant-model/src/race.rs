//! A retainer ball bearing: the race that the rotor touches has a spin of its own,
//! J_i·Ω̇_i = −R_i·s − b·Ω_i, eq. (2.37).

use crate::params::RaceParams;

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
    /// A race that runs on a bore of this radius \[m\].
    pub(crate) fn new(radius_m: f64, params: &RaceParams) -> Self {
        Self {
            radius_m,
            inertia_kg_m2: params.inertia_kg_m2,
            drag_n_m_s: params.drag_n_m_s,
            start_spin_rad_s: params.start_spin_rad_s,
        }
    }

    /// Ω_i after `dt_s` without contact \[rad/s\].
    pub(crate) fn coasted_rad_s(&self, spin_rad_s: f64, dt_s: f64) -> f64 {
        let decay = (-self.drag_n_m_s / self.inertia_kg_m2 * dt_s).exp();
        spin_rad_s * decay
    }

    /// Ω̇_i under sliding friction on the rotor \[rad/s²\]. Linear in both.
    #[inline]
    pub(crate) fn acceleration(&self, spin_rad_s: f64, sliding_n: f64) -> f64 {
        -(self.radius_m * sliding_n + self.drag_n_m_s * spin_rad_s) / self.inertia_kg_m2
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
