//! Noise of the estimated speed against the speeds that the supervisor has to tell apart.

use super::{Limits, reaction};
use crate::suggest::{Nominal, speed_noise_m_s, suggested};
use serde::Serialize;
use supervisor::Config;

/// Noise of the speed may be this share of the speed that matters: three times it is then a third.
pub(super) const TOLERABLE_SHARE: f64 = 0.1;

/// Whirl passes its threshold within about this time of the first contact \[s\].
pub(super) const TIME_TO_ACT_S: f64 = 1e-3;

/// Noise of the estimated speed, and what would make it tolerable.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Noise {
    /// In flight (root mean square) \[m/s\].
    pub flight_m_s: f64,
    /// In contact (root mean square) \[m/s\].
    pub contact_m_s: f64,
    /// The speed that it is compared with: v_t,crit, or without one the lift-off speed, or without that
    /// √(F·c/m) \[m/s\].
    pub reference_m_s: f64,
    /// Noise in flight over that.
    pub share: f64,
    /// Time constant of the observer in flight, T/(1 − ρ) \[s\].
    pub observer_s: f64,
    /// Noise is at most a tenth of the reference, and observer and actuator react within 1 ms.
    pub tolerable: bool,
    /// Most sensor noise, converter's step included, that is tolerable at this rate \[m\]; none if none is.
    pub sensor_noise_most_m: Option<f64>,
    /// Least rate at which this sensor noise is tolerable \[Hz\]; none up to 1 MHz.
    pub sample_rate_least_hz: Option<f64>,
}

impl Noise {
    pub(super) fn of(n: &Nominal, config: &Config, limits: &Limits) -> Self {
        let reference_m_s = [limits.passive_threshold_m_s, Some(limits.lift_off_m_s)]
            .into_iter()
            .flatten()
            .find(|v| *v > 0.0)
            .unwrap_or(n.force_speed_m_s());
        let [flight_m_s, contact_m_s] = speed_noise_m_s(n, config);
        // Everything follows by the rules of the suggestion, poles included.
        let with_noise = |noise_rms_m: f64| Nominal {
            noise_rms_m,
            quantum_m: 0.0,
            ..*n
        };
        let with_rate = |sample_rate_hz: f64| Nominal {
            sample_rate_hz,
            ..*n
        };
        Self {
            flight_m_s,
            contact_m_s,
            reference_m_s,
            share: flight_m_s / reference_m_s,
            observer_s: observer_s(n, config),
            tolerable: tolerable(n, reference_m_s),
            sensor_noise_most_m: steps(n.clearance_m, 1.0 / 1.01, 2100)
                .find(|noise| tolerable(&with_noise(*noise), reference_m_s)),
            sample_rate_least_hz: steps(1e3, 1.01, 694)
                .find(|rate| tolerable(&with_rate(*rate), reference_m_s)),
        }
    }
}

fn observer_s(n: &Nominal, config: &Config) -> f64 {
    n.period_s() / (1.0 - f64::from(config.observer_pole_flight))
}

fn tolerable(n: &Nominal, reference_m_s: f64) -> bool {
    let config = suggested(n).config;
    let [flight_m_s, _] = speed_noise_m_s(n, &config);
    let react_s = reaction(n).detect_to_force_s + observer_s(n, &config);
    let quiet = config.validate().is_ok() && flight_m_s <= TOLERABLE_SHARE * reference_m_s;
    quiet && react_s <= TIME_TO_ACT_S
}

/// A geometric series: poles come in steps, so there is no root to find more exactly.
fn steps(from: f64, ratio: f64, count: i32) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| from * ratio.powi(i))
}
