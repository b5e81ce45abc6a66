//! The stand-in firmware's levitation controller: a PID per axis with a filtered derivative, limited
//! as a vector, with an integrator that stops while the output is limited.

use crate::device::actuator::limited_n;
use plant_model::V2;
use supervisor::IntegratorHint;

/// Gains.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevitationParams {
    /// K_p \[N/m\].
    pub proportional_n_m: f64,
    /// K_i \[N/(m s)\].
    pub integral_n_m_s: f64,
    /// K_d \[N s/m\].
    pub derivative_n_s_m: f64,
    /// Time constant of the derivative's filter \[s\]; 0 takes the plain difference.
    pub derivative_filter_s: f64,
}

/// The controller's reference goes to another place, evenly, and stays there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetDown {
    /// Beginning \[s\].
    pub start_s: f64,
    /// Time in which it goes there \[s\].
    pub duration_s: f64,
    /// Where, as seen from the centre of the magnets \[m\].
    pub to_m: V2,
    /// Whether the supervisor is informed.
    pub announced: bool,
}

impl SetDown {
    /// End of the way \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// The reference at a time not before the start, from where it was \[m\].
    pub fn reference_m(&self, from_m: V2, t_s: f64) -> V2 {
        let share = ((t_s - self.start_s) / self.duration_s).clamp(0.0, 1.0);
        from_m + share * (self.to_m - from_m)
    }
}

/// Velocity from positions by differences, smoothed.
#[derive(Debug, Clone)]
pub(crate) struct VelocityFilter {
    period_s: f64,
    filter_s: f64,
    last_m: Option<V2>,
    velocity_m_s: V2,
}

impl VelocityFilter {
    /// A filter at rest; a time constant of 0 takes the plain difference.
    pub(crate) fn new(filter_s: f64, period_s: f64) -> Self {
        Self {
            period_s,
            filter_s,
            last_m: None,
            velocity_m_s: V2::zeros(),
        }
    }

    /// Velocity \[m/s\] after a position.
    pub(crate) fn velocity_m_s(&mut self, measured_m: V2) -> V2 {
        let difference = (measured_m - self.last_m.unwrap_or(measured_m)) / self.period_s;
        self.last_m = Some(measured_m);
        let share = self.period_s / (self.period_s + self.filter_s);
        self.velocity_m_s += share * (difference - self.velocity_m_s);
        self.velocity_m_s
    }

    /// A measured position, with the last one where a component is no number: one that got in would never
    /// get out of the filter again.
    pub(crate) fn usable_m(&self, measured_m: V2) -> V2 {
        let last = self.last_m.unwrap_or_default();
        measured_m.zip_map(&last, |new, old| if new.is_finite() { new } else { old })
    }
}

/// The controller's law on the true state, for references: no filter, and no integrator, which holds loads only.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueLevitation {
    /// Gains.
    pub params: LevitationParams,
    /// Cap \[N\].
    pub force_max_n: f64,
    /// Centre of the magnets, as positions are counted \[m\].
    pub centre_m: V2,
}

impl TrueLevitation {
    /// Force for the true position and velocity \[N\].
    pub fn force_n(&self, position_m: V2, velocity_m_s: V2) -> V2 {
        let p = &self.params;
        let wanted =
            -p.proportional_n_m * (position_m - self.centre_m) - p.derivative_n_s_m * velocity_m_s;
        limited_n(wanted, self.force_max_n)
    }
}

/// The controller.
#[derive(Debug, Clone)]
pub struct Levitation {
    params: LevitationParams,
    period_s: f64,
    force_max_n: f64,
    velocity: VelocityFilter,
    integral_n: V2,
}

impl Levitation {
    /// A controller at rest.
    pub fn new(params: LevitationParams, period_s: f64, force_max_n: f64) -> Self {
        Self {
            params,
            period_s,
            force_max_n,
            velocity: VelocityFilter::new(params.derivative_filter_s, period_s),
            integral_n: V2::zeros(),
        }
    }

    /// Force towards the centre for a measured position \[N\], limited to the cap.
    pub fn force_n(&mut self, measured_m: V2, hint: IntegratorHint) -> V2 {
        let p = &self.params;
        let measured_m = self.velocity.usable_m(measured_m);
        let velocity_m_s = self.velocity.velocity_m_s(measured_m);
        let wanted =
            -p.proportional_n_m * measured_m - p.derivative_n_s_m * velocity_m_s + self.integral_n;
        let limited = limited_n(wanted, self.force_max_n);
        if limited == wanted && hint != IntegratorHint::Hold {
            self.integral_n -= p.integral_n_m_s * self.period_s * measured_m;
        }
        limited
    }
}
