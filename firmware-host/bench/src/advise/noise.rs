//! Noise of the estimated speed against the speeds that the supervisor has to tell apart.

use super::{Limits, reaction};
use crate::bisection::by_logarithm;
use crate::scene::nominal::{Override, replaced};
use crate::scene::suggest::{Nominal, speed_noise_m_s, suggested};
use serde::Serialize;
use supervisor::{Bearing, Config, PARAMETERS};

/// Noise of the speed may be this share of the speed that matters: three times it is then a third.
pub(super) const TOLERABLE_SHARE: f64 = 0.1;

/// Whirl passes its threshold within about this time of the first contact \[s\].
pub(super) const TIME_TO_ACT_S: f64 = 1e-3;

/// The fastest rate that is tried \[Hz\], and the step to the next.
const FASTEST_HZ: f64 = 1e6;
const RATE_STEP: f64 = 1.01;

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
    /// The larger of the two over that.
    pub share: f64,
    /// Time constant of the observer in flight, T/(1 − ρ) \[s\].
    pub observer_s: f64,
    /// Noise is at most a tenth of the reference, and observer and actuator react within 1 ms.
    pub tolerable: bool,
    /// Sensor noise, converter's step included, up to which all of it is tolerable at this rate \[m\]; none if none
    /// is.
    pub sensor_noise_most_m: Option<f64>,
    /// Least rate at which this sensor noise is tolerable \[Hz\], sought from the present one: downwards where that is
    /// tolerable, upwards where it is not; none up to 1 MHz.
    pub sample_rate_least_hz: Option<f64>,
    /// The quickest poles in flight and in contact with which it is tolerable, in steps of 0.01 from those in use upwards,
    /// or, were the observer too slow then, from the quickest that are suggested; none if there are none.
    pub quiet_poles: Option<[f64; 2]>,
}

impl Noise {
    /// With the poles that are in use: the suggested ones, or what a scene puts in their place.
    pub(super) fn of(n: &Nominal, overrides: &[Override], limits: &Limits) -> Self {
        let reference_m_s = [limits.passive_threshold_m_s, Some(limits.lift_off_m_s)]
            .into_iter()
            .flatten()
            .find(|v| *v > 0.0)
            .unwrap_or(n.force_speed_m_s());
        let judge = Judge {
            reference_m_s,
            poles: (overrides.iter().copied())
                .filter(|(index, _)| PARAMETERS[*index].name.starts_with("observer_pole"))
                .collect(),
        };
        let config = judge.config(n);
        let [flight_m_s, contact_m_s] = speed_noise_m_s(n, &config);
        let tolerable = judge.tolerates(n);
        Self {
            flight_m_s,
            contact_m_s,
            reference_m_s,
            share: flight_m_s.max(contact_m_s) / reference_m_s,
            observer_s: observer_s(n, config.observer_pole_flight),
            tolerable,
            sensor_noise_most_m: judge.sensor_noise_most_m(n),
            sample_rate_least_hz: judge.sample_rate_least_hz(n, tolerable),
            quiet_poles: judge.quiet_poles(n),
        }
    }
}

fn observer_s(n: &Nominal, pole_flight: f32) -> f64 {
    n.period_s() / (1.0 - f64::from(pole_flight))
}

struct Judge {
    reference_m_s: f64,
    /// Poles that are set, and not suggested anew for every sensor and rate.
    poles: Vec<Override>,
}

impl Judge {
    fn config(&self, n: &Nominal) -> Config {
        replaced(&suggested(n).config, &self.poles)
    }

    fn tolerates(&self, n: &Nominal) -> bool {
        let config = self.config(n);
        let quiet = (speed_noise_m_s(n, &config).iter()).all(|noise| self.is_quiet(*noise));
        quiet && self.works(n, &config)
    }

    fn is_quiet(&self, noise_m_s: f64) -> bool {
        noise_m_s <= TOLERABLE_SHARE * self.reference_m_s
    }

    /// Valid, and quick enough.
    fn works(&self, n: &Nominal, config: &Config) -> bool {
        let react_s = reaction(n).detect_to_force_s + observer_s(n, config.observer_pole_flight);
        config.validate().is_ok() && react_s <= TIME_TO_ACT_S
    }

    /// Whether a sensor and every quieter one is tolerated. Suggested poles come in steps, so a quieter sensor may have the
    /// noisier speed: but beyond the quickest pole never more than what the suggestion aims at.
    fn tolerates_up_to(&self, n: &Nominal) -> bool {
        let config = self.config(n);
        let own = suggested(n).config;
        let noise = speed_noise_m_s(n, &config);
        let used = [config.observer_pole_flight, config.observer_pole_contact];
        let suggested = [own.observer_pole_flight, own.observer_pole_contact];
        let quiet = (0..2).all(|i| {
            let stepped = used[i] == suggested[i] && used[i] > Bearing::QUICKEST_POLES[i];
            let most = if stepped {
                f64::from(Bearing::SPEED_NOISE_SHARE) * n.force_speed_m_s()
            } else {
                0.0
            };
            self.is_quiet(noise[i].max(most))
        });
        quiet && self.works(n, &config)
    }

    fn sensor_noise_most_m(&self, n: &Nominal) -> Option<f64> {
        let tolerated = |noise_rms_m: f64| {
            self.tolerates_up_to(&Nominal {
                noise_rms_m,
                quantum_m: 0.0,
                ..*n
            })
        };
        // By its logarithm: sensors differ by powers of ten.
        let (low, high) = (1e-9 * n.clearance_m, n.clearance_m);
        if !tolerated(low) {
            return None;
        }
        if tolerated(high) {
            return Some(high);
        }
        Some(by_logarithm((low, high), 1e-6, tolerated).0)
    }

    fn sample_rate_least_hz(&self, n: &Nominal, tolerable: bool) -> Option<f64> {
        let tolerated = |sample_rate_hz: f64| {
            self.tolerates(&Nominal {
                sample_rate_hz,
                ..*n
            })
        };
        let present = n.sample_rate_hz;
        if tolerable {
            let down = (0..).map(|i| present / RATE_STEP.powi(i));
            return down.take_while(|hz| tolerated(*hz)).last();
        }
        // A rate is bought in round numbers.
        let up = (1..).map(|i| (present * RATE_STEP.powi(i) / 100.0).ceil() * 100.0);
        up.take_while(|hz| *hz <= FASTEST_HZ)
            .find(|hz| tolerated(*hz))
    }

    /// From the poles in use upwards; or, where that is too slow, from the quickest.
    fn quiet_poles(&self, n: &Nominal) -> Option<[f64; 2]> {
        let used = self.config(n);
        let used = [used.observer_pole_flight, used.observer_pole_contact].map(f64::from);
        [used, Bearing::QUICKEST_POLES.map(f64::from)]
            .into_iter()
            .find_map(|from| self.quiet_poles_from(n, from))
    }

    fn quiet_poles_from(&self, n: &Nominal, from: [f64; 2]) -> Option<[f64; 2]> {
        let own = suggested(n).config;
        let with = |flight: f64, contact: f64| Config {
            observer_pole_flight: flight as f32,
            observer_pole_contact: contact as f32,
            ..own
        };
        // Whole hundredths, as they are written down.
        let hundredths = |pole: f64| (100.0 * pole - 1e-4).ceil() as u32;
        let quickest = |i: usize| {
            let noise = |pole: f64| speed_noise_m_s(n, &with(pole, pole))[i];
            (hundredths(from[i])..=hundredths(f64::from(Bearing::SLOWEST_POLE)))
                .map(|pole| f64::from(pole) / 100.0)
                .find(|pole| self.is_quiet(noise(*pole)))
        };
        let (flight, contact) = (quickest(0)?, quickest(1)?);
        let works = self.works(n, &with(flight, contact));
        works.then_some([flight, contact])
    }
}
