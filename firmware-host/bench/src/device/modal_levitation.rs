//! Levitation of a whole rotor by its rigid modes: one controller for the translation of the centre of mass, one for the tilt,
//! with cross feedback of what the spin does to the tilt.

use crate::device::actuator::limited_n;
use crate::device::levitation::{LevitationParams, VelocityFilter};
use plant_model::V2;

/// Gains of the tilt; its derivative has the filter of the translation's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TiltParams {
    /// Moment per slope \[N m/rad\].
    pub proportional_n_m_rad: f64,
    /// Moment per slope and time \[N m/(rad s)\].
    pub integral_n_m_rad_s: f64,
    /// Moment per rate of slope \[N m s/rad\].
    pub derivative_n_m_s_rad: f64,
    /// Moment per rate of slope and spin, across it \[kg m²\].
    pub cross_kg_m2: f64,
}

/// A station of a rotor: its sensor, and its magnet where it has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Of the sensor, from the centre of mass \[m\].
    pub sensor_m: f64,
    /// Of the magnet \[m\], and its cap \[N\].
    pub magnet: Option<(f64, f64)>,
}

/// A controller by mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalLevitationParams {
    /// Gains of the translation, all magnets together.
    pub translation: LevitationParams,
    /// Gains of the tilt.
    pub tilt: TiltParams,
    /// Where it measures and acts.
    pub stations: Vec<Station>,
}

/// Weights of places along a rotor: those of a translation add to 1 and make no moment, those of a tilt add to 0 and make the
/// moment 1; the least squares of both. What they make of readings is position of the centre of mass and slope.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    pub translation: Vec<f64>,
    /// Of the tilt \[1/m\].
    pub tilt: Vec<f64>,
}

impl Weights {
    /// Of these places \[m\]; without a tilt where all are the same.
    pub fn new(positions_m: &[f64]) -> Self {
        let count = positions_m.len() as f64;
        let mean_m = positions_m.iter().sum::<f64>() / count;
        let spread: f64 = positions_m.iter().map(|z| (z - mean_m).powi(2)).sum();
        let tilt = |z: &f64| match spread > 0.0 {
            true => (z - mean_m) / spread,
            false => 0.0,
        };
        Self {
            translation: (positions_m.iter())
                .map(|z| 1.0 / count - mean_m * tilt(z))
                .collect(),
            tilt: positions_m.iter().map(tilt).collect(),
        }
    }
}

/// One mode's share of it.
#[derive(Debug, Clone)]
struct Mode {
    gains: LevitationParams,
    velocity: VelocityFilter,
    integral: V2,
}

impl Mode {
    fn new(gains: LevitationParams, period_s: f64) -> Self {
        Self {
            velocity: VelocityFilter::new(gains.derivative_filter_s, period_s),
            gains,
            integral: V2::zeros(),
        }
    }

    /// What it asks for, and the rate that it sees.
    fn answer(&mut self, reading: V2) -> (V2, V2) {
        let rate = self.velocity.velocity_m_s(reading);
        let g = &self.gains;
        let wanted = self.integral - g.proportional_n_m * reading - g.derivative_n_s_m * rate;
        (wanted, rate)
    }
}

/// The controller.
#[derive(Debug, Clone)]
pub(crate) struct ModalLevitation {
    period_s: f64,
    cross_kg_m2: f64,
    stations: Vec<Station>,
    sensors: Weights,
    /// In the order of the stations that have a magnet.
    magnets: Weights,
    translation: Mode,
    tilt: Mode,
    last_m: Vec<V2>,
}

impl ModalLevitation {
    /// A controller at rest.
    pub(crate) fn new(params: &ModalLevitationParams, period_s: f64) -> Self {
        let (translation, tilt) = (params.translation, &params.tilt);
        let of = |places: Vec<f64>| Weights::new(&places);
        let stations = params.stations.iter();
        Self {
            period_s,
            cross_kg_m2: tilt.cross_kg_m2,
            sensors: of(stations.clone().map(|s| s.sensor_m).collect()),
            magnets: of((stations.filter_map(|s| s.magnet)).map(|m| m.0).collect()),
            last_m: vec![V2::zeros(); params.stations.len()],
            stations: params.stations.clone(),
            translation: Mode::new(translation, period_s),
            tilt: Mode::new(
                LevitationParams {
                    proportional_n_m: tilt.proportional_n_m_rad,
                    integral_n_m_s: tilt.integral_n_m_rad_s,
                    derivative_n_s_m: tilt.derivative_n_m_s_rad,
                    ..translation
                },
                period_s,
            ),
        }
    }

    /// Forces of the stations \[N\] for what their sensors measure \[m\], each within its cap; a reading that is no number
    /// counts as the last. Integrators stand while one is at its cap, or where a hint says so.
    pub(crate) fn forces_n(
        &mut self,
        measured_m: impl Iterator<Item = V2>,
        spin_rad_s: f64,
        hold: bool,
        forces_n: &mut [V2],
    ) {
        let (mut centre_m, mut slope) = (V2::zeros(), V2::zeros());
        for (i, reading_m) in measured_m.enumerate().take(self.last_m.len()) {
            let last_m = &mut self.last_m[i];
            *last_m = reading_m.zip_map(last_m, |new, old| if new.is_finite() { new } else { old });
            centre_m += self.sensors.translation[i] * *last_m;
            slope += self.sensors.tilt[i] * *last_m;
        }
        let (force_n, _) = self.translation.answer(centre_m);
        let (mut moment, rate) = self.tilt.answer(slope);
        // I_t·φ̈ + I_p·Ω·ψ̇ = M_φ and I_t·ψ̈ − I_p·Ω·φ̇ = M_ψ.
        moment += self.cross_kg_m2 * spin_rad_s * V2::new(rate.y, -rate.x);
        let (mut magnet, mut limited) = (0, hold);
        for (station, force) in self.stations.iter().zip(forces_n) {
            *force = V2::zeros();
            if let Some((_, cap_n)) = station.magnet {
                let wanted_n =
                    self.magnets.translation[magnet] * force_n + self.magnets.tilt[magnet] * moment;
                *force = limited_n(wanted_n, cap_n);
                limited |= *force != wanted_n;
                magnet += 1;
            }
        }
        if !limited {
            for (mode, reading) in [(&mut self.translation, centre_m), (&mut self.tilt, slope)] {
                mode.integral -= mode.gains.integral_n_m_s * self.period_s * reading;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_part_translation_and_tilt() {
        let places = [-0.3, 0.1, 0.45];
        let weights = Weights::new(&places);
        let sum = |w: &[f64], of: fn(f64) -> f64| -> f64 {
            w.iter().zip(places).map(|(w, z)| w * of(z)).sum()
        };
        for (weights, total, moment) in
            [(&weights.translation, 1.0, 0.0), (&weights.tilt, 0.0, 1.0)]
        {
            assert!((sum(weights, |_| 1.0) - total).abs() < 1e-12);
            assert!((sum(weights, |z| z) - moment).abs() < 1e-12);
        }
        assert_eq!(Weights::new(&[0.2]).tilt, [0.0]);
    }

    /// A slope that turns with the spin is met by a moment against what the spin does to it.
    #[test]
    fn cross_feedback_sets_itself_against_the_spin() {
        let params = ModalLevitationParams {
            translation: LevitationParams {
                proportional_n_m: 0.0,
                integral_n_m_s: 0.0,
                derivative_n_s_m: 0.0,
                derivative_filter_s: 0.0,
            },
            tilt: TiltParams {
                proportional_n_m_rad: 0.0,
                integral_n_m_rad_s: 0.0,
                derivative_n_m_s_rad: 0.0,
                cross_kg_m2: 0.5,
            },
            stations: [-0.2, 0.2]
                .map(|z| Station {
                    sensor_m: z,
                    magnet: Some((z, 1e3)),
                })
                .to_vec(),
        };
        let mut levitation = ModalLevitation::new(&params, 1e-4);
        let mut forces_n = [V2::zeros(); 2];
        for step in [0.0, 1.0] {
            let tilted = [-0.2, 0.2].map(|z| V2::new(0.0, 1e-7 * step * z));
            levitation.forces_n(tilted.into_iter(), 100.0, false, &mut forces_n);
        }
        // ψ̇ = 1e-3 rad/s: M_φ = I_p·Ω·ψ̇ = 0.05 N m, over an arm of 0.4 m.
        assert!((forces_n[1].x - 0.125).abs() < 1e-12, "{forces_n:?}");
        assert!((forces_n[0] + forces_n[1]).norm() < 1e-12);
    }
}
