//! A retainer bearing as it is: drag by load, and heat.

use crate::params::{FINITE, NOT_NEGATIVE, POSITIVE, ParamError, check};

/// Drag of a race by the load on it, beside the viscous one: the moment κ·f_n against its spin.
///
/// Near standstill the moment is κ·f_n·Ω_i/√(Ω_i² + Ω_0²), so that it has one value at each spin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadDrag {
    /// κ \[m\], ≥ 0: coefficient of friction of the bearing times half its bore, as 0.0015·15 mm.
    pub arm_m: f64,
    /// Ω_0 \[rad/s\], > 0.
    pub still_rad_s: f64,
}

/// A bearing's heat: all that it loses, by friction, damping and drag, warms one mass, and its clearance follows.
///
/// ```text
/// C·dT/dt = losses − G·T          clearance = that when cold + T·expansion
/// ```
///
/// T is the rise over the surroundings. It changes from call to call of `advance`: within one, losses are as if spread evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingHeat {
    /// C \[J/K\], > 0.
    pub capacity_j_k: f64,
    /// G \[W/K\], ≥ 0.
    pub conductance_w_k: f64,
    /// Growth of the clearance \[m/K\], either sign. The clearance stays above a tenth of that when cold.
    pub expansion_m_k: f64,
    /// T at the start \[K\].
    pub start_rise_k: f64,
}

impl LoadDrag {
    pub(super) fn validate(&self, field: impl Fn(&str) -> String) -> Result<(), ParamError> {
        let arm = self.arm_m;
        check(arm >= 0.0, field("load_drag.arm_m"), arm, NOT_NEGATIVE)?;
        let still = self.still_rad_s;
        check(still > 0.0, field("load_drag.still_rad_s"), still, POSITIVE)
    }

    /// The moment that one newton of load gives \[m\], with the sign of the spin.
    pub(crate) fn per_load_m(&self, spin_rad_s: f64) -> f64 {
        self.arm_m * spin_rad_s / spin_rad_s.hypot(self.still_rad_s)
    }
}

/// Share of the cold clearance that is left whatever the heat.
const LEAST_CLEARANCE: f64 = 0.1;

impl BearingHeat {
    pub(super) fn validate(&self, field: impl Fn(&str) -> String) -> Result<(), ParamError> {
        let capacity = self.capacity_j_k;
        check(
            capacity > 0.0,
            field("heat.capacity_j_k"),
            capacity,
            POSITIVE,
        )?;
        let leak = self.conductance_w_k;
        check(
            leak >= 0.0,
            field("heat.conductance_w_k"),
            leak,
            NOT_NEGATIVE,
        )?;
        check(
            true,
            field("heat.expansion_m_k"),
            self.expansion_m_k,
            FINITE,
        )?;
        check(true, field("heat.start_rise_k"), self.start_rise_k, FINITE)
    }

    /// Clearance at a rise \[m\].
    pub(crate) fn clearance_m(&self, cold_m: f64, rise_k: f64) -> f64 {
        (cold_m + self.expansion_m_k * rise_k).max(LEAST_CLEARANCE * cold_m)
    }

    /// Rise after `dt_s` with so much heat spread over it.
    pub(crate) fn risen_k(&self, rise_k: f64, heat_j: f64, dt_s: f64) -> f64 {
        let leaked = self.conductance_w_k / self.capacity_j_k * dt_s;
        // ∫ of what is left of each instant's heat, (1 − e^{−x})/x.
        let kept = if leaked > 0.0 {
            -(-leaked).exp_m1() / leaked
        } else {
            1.0
        };
        rise_k * (-leaked).exp() + heat_j / self.capacity_j_k * kept
    }
}
