//! What a supervisor of both planes meets beyond the point mass: nutation and bending.

use super::crossover::SmallSignals;
use crate::report::lines::{width, wrapped};
use crate::report::plot::text::figures;
use crate::scene::machine::MachineScene;
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::Write;
use supervisor::Config;

/// A turn of the nutation by the time a force acts beyond which the supervisor leaves the rotor to levitation, but for
/// backward whirl \[rad\].
pub const MOST_TURN_RAD: f64 = 1.25;

/// Of a rotor with a supervisor; keys are stable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RotorAdvice {
    /// Frequency with which a free tilt turns at the scene's spin, (I_p/I_t)·Ω \[Hz\]; its sign is that of the spin.
    pub nutation_hz: f64,
    /// By how much that turns from a sample to its force, the later plane's \[rad\].
    pub nutation_turn_rad: f64,
    /// The spin at which that is [`MOST_TURN_RAD`] \[Hz\]; none of a rotor without polar inertia.
    pub spin_of_most_turn_hz: Option<f64>,
    /// Bending modes below half the control rate, in the order of their frequencies.
    pub modes: Vec<ModeAtRisk>,
}

/// A bending mode under the supervisor's force in flight, for small vibrations; at rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeAtRisk {
    /// Natural frequency \[Hz\].
    pub frequency_hz: f64,
    /// Its own damping ratio.
    pub damping_ratio: f64,
    /// What the force adds to that, of all planes, with what they are told of bending; negative: it drives.
    pub added_damping_ratio: f64,
    /// The same if both planes were told of this mode alone; none where it cannot be kept apart.
    pub told_damping_ratio: Option<f64>,
    /// Displacement at the sensor of each plane, over the rigid rotor's …
    pub at_sensors: Vec<f64>,
    /// … and at its magnet.
    pub at_magnets: Vec<f64>,
}

impl ModeAtRisk {
    /// Whether an engaged supervisor would make it grow.
    pub fn grows(&self) -> bool {
        self.damping_ratio + self.added_damping_ratio < 0.0
    }
}

impl RotorAdvice {
    /// With these configurations of its planes; `None` of a rotor that has no supervisor for both.
    pub fn new(scene: &MachineScene, configs: &[Config]) -> Option<Self> {
        let shaft = scene.shaft()?;
        let [first, second] = configs else {
            return None;
        };
        let inertias =
            f64::from(shaft.polar_inertia_kg_m2) / f64::from(shaft.transverse_inertia_kg_m2);
        let late_s = |config: &Config| {
            let period_s = f64::from(config.sample_period_s);
            (f64::from(config.delay_samples.round()) + 0.5) * period_s
                + f64::from(config.amplifier_lag_s)
        };
        let later_s = late_s(first).max(late_s(second));
        let nutation_hz = inertias * scene.start.spin_rad_s / TAU;
        let mass_kg = f64::from(shaft.mass_kg);
        let signals = [first, second].map(SmallSignals::new);
        let nyquist_hz = signals[0].nyquist_hz();
        let mut modes: Vec<ModeAtRisk> = (scene.machine.rotor.bending().iter())
            .map(|mode| {
                let frequency_hz = mode.frequency_rad_s / TAU;
                let at = |places: [f32; 2]| places.map(|z| mode.displacement(f64::from(z)));
                let [a, b] = shaft.places;
                let at_sensors = at([a.sensor_m, b.sensor_m]);
                let at_magnets = at([a.magnet_m, b.magnet_m]);
                // At exactly the centre of what is kept apart the analysis has no number: nothing is felt.
                let ratio = |signals: &[SmallSignals; 2]| {
                    let felt = |plane: usize| {
                        let damping = signals[plane].damping_n_s_m(frequency_hz);
                        damping.filter(|d| d.is_finite()).unwrap_or_default()
                            * at_sensors[plane]
                            * at_magnets[plane]
                    };
                    (felt(0) + felt(1)) / (2.0 * mass_kg * mode.frequency_rad_s)
                };
                let told = [first, second].map(|config| Config {
                    bending_first_hz: frequency_hz as f32,
                    bending_second_hz: 0.0,
                    ..*config
                });
                let apart = told.iter().all(|c| c.keeps_apart(c.bending_first_hz));
                ModeAtRisk {
                    frequency_hz,
                    damping_ratio: mode.damping_ratio,
                    added_damping_ratio: ratio(&signals),
                    told_damping_ratio: apart.then(|| {
                        ratio(&[SmallSignals::new(&told[0]), SmallSignals::new(&told[1])])
                    }),
                    at_sensors: at_sensors.to_vec(),
                    at_magnets: at_magnets.to_vec(),
                }
            })
            .filter(|mode| mode.frequency_hz < nyquist_hz)
            .collect();
        modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
        Some(Self {
            nutation_hz,
            nutation_turn_rad: (TAU * nutation_hz * later_s).abs(),
            spin_of_most_turn_hz: (inertias > 0.0)
                .then(|| MOST_TURN_RAD / (TAU * inertias * later_s)),
            modes,
        })
    }

    /// For people.
    pub fn text(&self) -> String {
        let mut text = format!(
            "Nutation\n  {} Hz, which turns by {:.2} rad until a force acts",
            figures(self.nutation_hz),
            self.nutation_turn_rad
        );
        if let Some(spin_hz) = self.spin_of_most_turn_hz {
            let _ = write!(
                text,
                "; {MOST_TURN_RAD} rad, beyond which it acts on backward whirl alone, at a spin of {} Hz",
                figures(spin_hz)
            );
        }
        text.push('\n');
        if !self.modes.is_empty() {
            text.push_str("\nBending modes under the supervisor's force\n");
        }
        for mode in &self.modes {
            let verdict = match (mode.grows(), mode.added_damping_ratio < 0.0) {
                (true, _) => "it would grow",
                (_, true) => "driven, less than it is damped",
                _ => "damped",
            };
            let percent = |x: f64| format!("{:.2} %", 100.0 * x);
            let _ = writeln!(
                text,
                "  {} Hz: damping ratio {} and {} by the force: {verdict}",
                figures(mode.frequency_hz),
                percent(mode.damping_ratio),
                percent(mode.added_damping_ratio)
            );
            if !mode.grows() {
                continue;
            }
            let better = (mode.told_damping_ratio).filter(|told| *told > mode.added_damping_ratio);
            let _ = match better {
                Some(told) => writeln!(
                    text,
                    "    do: tell the supervisor bending_first_hz = {} (or bending_second_hz); then the force adds {}",
                    figures(mode.frequency_hz),
                    percent(told)
                ),
                None => writeln!(
                    text,
                    "    do: move sensor and magnet to the same side of the node, or raise observer_pole_flight"
                ),
            };
        }
        let lines = text
            .lines()
            .map(|line| wrapped(line, "    ", width()) + "\n");
        lines.collect()
    }
}
