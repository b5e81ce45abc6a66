//! The stand-in firmware's levitation controller: a PID per axis with a filtered derivative, limited
//! as a vector, with an integrator that stops while the output is limited.

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

/// The controller.
#[derive(Debug, Clone)]
pub struct Levitation {
    params: LevitationParams,
    period_s: f64,
    force_max_n: f64,
    last_m: Option<V2>,
    velocity_m_s: V2,
    integral_n: V2,
}

impl Levitation {
    /// A controller at rest.
    pub fn new(params: LevitationParams, period_s: f64, force_max_n: f64) -> Self {
        Self {
            params,
            period_s,
            force_max_n,
            last_m: None,
            velocity_m_s: V2::zeros(),
            integral_n: V2::zeros(),
        }
    }

    /// Force towards the centre for a measured position \[N\], limited to the cap.
    pub fn force_n(&mut self, measured_m: V2, hint: IntegratorHint) -> V2 {
        let p = &self.params;
        let difference = (measured_m - self.last_m.unwrap_or(measured_m)) / self.period_s;
        self.last_m = Some(measured_m);
        let share = self.period_s / (self.period_s + p.derivative_filter_s);
        self.velocity_m_s += share * (difference - self.velocity_m_s);
        let wanted = -p.proportional_n_m * measured_m - p.derivative_n_s_m * self.velocity_m_s
            + self.integral_n;
        let size = wanted.norm();
        let limited = size > self.force_max_n;
        if !limited && hint != IntegratorHint::Hold {
            self.integral_n -= p.integral_n_m_s * self.period_s * measured_m;
        }
        if limited {
            wanted * (self.force_max_n / size)
        } else {
            wanted
        }
    }
}
