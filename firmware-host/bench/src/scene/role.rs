//! What the supervisor of a whole rotor does about a shaft that bends: modes that its force in flight would make grow are
//! configured, and where that does not suffice it leaves flight to levitation.

use crate::crossover::SmallSignals;
use crate::scene::Scene;
use crate::scene::diagnostic::SceneText;
use crate::scene::nominal::{Override, named, replaced};
use crate::scene::suggest::{Decided, suggested};
use serde::Serialize;
use std::f64::consts::TAU;
use supervisor::{Config, PARAMETERS};

/// Damping of a mode with that of the force \[%\] below which the supervisor leaves flight to levitation.
pub(crate) const LEAST_PERCENT: f64 = -0.5;

/// Bending beyond the line of the sensors, over the clearance, from which the rigid map from sensors to retainer bearings misleads
/// a force that drives bending.
const MOST_BENDING: f64 = 0.1;

/// A bending mode under the supervisor's force in flight, for small vibrations; at rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeAtRisk {
    /// Natural frequency \[Hz\].
    pub frequency_hz: f64,
    /// Its own damping ratio.
    pub damping_ratio: f64,
    /// What the force adds to that, of all planes, with the bending that is configured; negative: it drives.
    pub added_damping_ratio: f64,
    /// The same \[%\].
    pub damping_by_force_percent: f64,
    /// What the force adds if this mode alone is configured in both planes; none where it cannot be kept apart.
    pub told_damping_ratio: Option<f64>,
    /// Displacement at the sensor of each plane, over the rigid rotor's …
    pub at_sensors: Vec<f64>,
    pub at_magnets: Vec<f64>,
}

impl ModeAtRisk {
    /// Its own damping and that of the force \[%\].
    pub fn percent(&self) -> f64 {
        100.0 * (self.damping_ratio + self.added_damping_ratio)
    }

    /// Whether an engaged supervisor would make it grow.
    pub fn grows(&self) -> bool {
        self.percent() < 0.0
    }
}

/// What the supervisor of a rotor does.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Role {
    /// `full`, or `whirl only`: levitation keeps the rotor in the air.
    pub name: &'static str,
    /// Why.
    pub reason: String,
}

/// A mode as both planes move it.
struct Bends {
    rate_rad_s: f64,
    damping_ratio: f64,
    at_sensors: [f64; 2],
    at_magnets: [f64; 2],
}

impl Bends {
    fn frequency_hz(&self) -> f64 {
        self.rate_rad_s / TAU
    }

    /// What the force adds to the damping ratio.
    fn added(&self, mass_kg: f64, signals: &[SmallSignals; 2]) -> f64 {
        // At exactly the centre of what is kept apart the analysis has no number: nothing is felt.
        let felt = |plane: usize| {
            let damping = signals[plane].damping_n_s_m(self.frequency_hz());
            damping.filter(|d| d.is_finite()).unwrap_or_default()
                * self.at_sensors[plane]
                * self.at_magnets[plane]
        };
        (felt(0) + felt(1)) / (2.0 * mass_kg * self.rate_rad_s)
    }
}

/// Natural frequencies of modes as both planes have them configured.
fn configured(configs: &[Config; 2], [first, second]: [f64; 2]) -> [Config; 2] {
    configs.map(|config| Config {
        bending_first_hz: first as f32,
        bending_second_hz: second as f32,
        ..config
    })
}

impl Scene {
    /// Bending modes up to half the control rate, slowest first; none of a rotor that has no supervisor for both planes.
    fn bends(&self, config: &Config) -> Vec<Bends> {
        let Some(shaft) = self.shaft() else {
            return Vec::new();
        };
        let [a, b] = shaft.places;
        let nyquist_hz = 0.5 / f64::from(config.sample_period_s);
        let mut modes: Vec<Bends> = (self.machine.rotor.bending().iter())
            .map(|mode| {
                let at = |places: [f32; 2]| places.map(|z| mode.displacement(f64::from(z)));
                Bends {
                    rate_rad_s: mode.frequency_rad_s,
                    damping_ratio: mode.damping_ratio,
                    at_sensors: at([a.sensor_m, b.sensor_m]),
                    at_magnets: at([a.magnet_m, b.magnet_m]),
                }
            })
            .filter(|mode| mode.frequency_hz() < nyquist_hz)
            .collect();
        modes.sort_by(|a, b| a.rate_rad_s.total_cmp(&b.rate_rad_s));
        modes
    }

    /// Its bending modes below half the control rate under the force of a supervisor with these configurations, slowest first.
    pub(crate) fn modes_at_risk(&self, configs: &[Config; 2]) -> Vec<ModeAtRisk> {
        let mass_kg = self.machine.rotor.rigid().mass_kg;
        let signals = configs.each_ref().map(SmallSignals::new);
        let modes = self.bends(&configs[0]).into_iter();
        let at_risk = modes.map(|mode| {
            let alone = configured(configs, [mode.frequency_hz(), 0.0]);
            let apart = alone.iter().all(|c| c.keeps_apart(c.bending_first_hz));
            let added_damping_ratio = mode.added(mass_kg, &signals);
            ModeAtRisk {
                frequency_hz: mode.frequency_hz(),
                damping_ratio: mode.damping_ratio,
                added_damping_ratio,
                damping_by_force_percent: 100.0 * added_damping_ratio,
                told_damping_ratio: apart
                    .then(|| mode.added(mass_kg, &alone.each_ref().map(SmallSignals::new))),
                at_sensors: mode.at_sensors.to_vec(),
                at_magnets: mode.at_magnets.to_vec(),
            }
        });
        at_risk.collect()
    }

    /// Damping of each mode with that of the force \[%\], least first, with its frequency \[Hz\].
    fn damping(&self, configs: &[Config; 2]) -> Vec<[f64; 2]> {
        let mass_kg = self.machine.rotor.rigid().mass_kg;
        let signals = configs.each_ref().map(SmallSignals::new);
        let percent = |mode: &Bends| 100.0 * (mode.damping_ratio + mode.added(mass_kg, &signals));
        let modes = self.bends(&configs[0]);
        let mut all: Vec<[f64; 2]> = (modes.iter())
            .map(|mode| [percent(mode), mode.frequency_hz()])
            .collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        all
    }

    /// The least of that, with its frequency; none where nothing bends below half the control rate.
    pub(crate) fn least_damping(&self, configs: &[Config; 2]) -> Option<[f64; 2]> {
        self.damping(configs).first().copied()
    }

    /// Configurations of both planes in which no mode grows under the force, as far as configuring two modes does it, and else
    /// leave flight to levitation; with what the supervisor does then. `set` is what the scene sets itself, which stays.
    pub fn decided(&self, configs: &[Config; 2], set: [&[Override]; 2]) -> ([Config; 2], Role) {
        let is_set = |parameter: &str| {
            (set.iter()).any(|given| named(given).any(|(name, _)| name == parameter))
        };
        let damping = self.damping(configs);
        let mut decided = *configs;
        if damping.first().is_some_and(|[percent, _]| *percent < 0.0) {
            if !is_set("bending_first_hz") && !is_set("bending_second_hz") {
                decided = self.with_modes(configs, &damping);
            }
            if self.misleads(&decided) && !is_set("acts_in_flight") {
                for config in &mut decided {
                    config.acts_in_flight = 0.0;
                }
            }
        }
        let role = self.role(&decided);
        (decided, role)
    }

    /// Whether a mode grows under the force for all that is configured, or the retainer bearings are not where the sensors say.
    fn misleads(&self, configs: &[Config; 2]) -> bool {
        let least = self.least_damping(configs);
        least.is_some_and(|[percent, _]| percent < LEAST_PERCENT)
            || self.bends_by(configs) > MOST_BENDING
    }

    fn bends_by(&self, configs: &[Config; 2]) -> f64 {
        self.bending_over_clearance(configs).unwrap_or_default()
    }

    /// Whether the force would drive a mode that nobody has configured.
    fn drives(&self, configs: &[Config; 2]) -> bool {
        let rigid = configured(configs, [0.0; 2]);
        (self.least_damping(&rigid)).is_some_and(|[percent, _]| percent < 0.0)
    }

    /// With one or both of the two modes configured that are damped least, whichever leaves the most damping.
    fn with_modes(&self, configs: &[Config; 2], damping: &[[f64; 2]]) -> [Config; 2] {
        let apart = |hz: f64| configs.iter().all(|config| config.keeps_apart(hz as f32));
        let mut worst = (damping.iter())
            .filter(|[percent, hz]| *percent < 0.0 && apart(*hz))
            .map(|[_, hz]| *hz);
        let [first, second] = [worst.next(), worst.next()];
        let both = first.zip(second).map(|(first, second)| [first, second]);
        let alone = [first, second].map(|hz| hz.map(|hz| [hz, 0.0]));
        let least = |configs: &[Config; 2]| {
            (self.least_damping(configs)).map_or(f64::INFINITY, |[percent, _]| percent)
        };
        let mut best = (least(configs), *configs);
        for modes in alone.into_iter().chain([both]).flatten() {
            let with = configured(configs, modes);
            let percent = least(&with);
            if percent > best.0 {
                best = (percent, with);
            }
        }
        best.1
    }

    /// What a supervisor with these configurations does.
    pub fn role(&self, configs: &[Config; 2]) -> Role {
        let first = &configs[0];
        let modes: Vec<String> = [first.bending_first_hz, first.bending_second_hz]
            .into_iter()
            .filter(|hz| *hz > 0.0)
            .map(|hz| format!("{hz:.1} Hz"))
            .collect();
        let with = match modes.as_slice() {
            [] => String::new(),
            modes => format!(", with {} configured", modes.join(" and ")),
        };
        let acts = configs.iter().any(|config| config.acts_in_flight >= 0.5);
        let reason = match self.least_damping(configs) {
            None => "no bending mode lies below half the control rate".to_owned(),
            Some([percent, hz]) => {
                let mode = format!("the bending mode of {hz:.1} Hz");
                match percent < 0.0 {
                    true => format!(
                        "under its force in flight {mode} has a damping of {percent:.2} %{with}"
                    ),
                    false => format!(
                        "under its force no bending mode grows{with}; {mode} is damped least, with {percent:.2} %"
                    ),
                }
            }
        };
        let bends_by = self.bends_by(configs);
        let reason = match bends_by > MOST_BENDING {
            true => format!(
                "{reason}; between sensors and retainer bearings the shaft bends by {bends_by:.2} clearances under both caps"
            ),
            false => reason,
        };
        let driven = self.drives(configs) && self.misleads(configs);
        let by_hand = |value: u8| format!("acts_in_flight = {value} is set; {reason}");
        match (acts, driven) {
            (true, false) => Role {
                name: "full",
                reason,
            },
            (true, true) => Role {
                name: "full",
                reason: by_hand(1),
            },
            (false, true) => Role {
                name: "whirl only",
                reason,
            },
            (false, false) => Role {
                name: "whirl only",
                reason: by_hand(0),
            },
        }
    }

    /// Bending between each retainer bearing and the straight line through both sensors, under the caps of both magnets, over the
    /// clearance there: the larger of both planes; none where there is no such line.
    pub fn bending_over_clearance(&self, configs: &[Config; 2]) -> Option<f64> {
        let [a, b] = self.shaft()?.places;
        let sensors = [a, b].map(|place| f64::from(place.sensor_m));
        let magnets = [a, b].map(|place| f64::from(place.magnet_m));
        let apart_m = sensors[1] - sensors[0];
        let mass_kg = self.machine.rotor.rigid().mass_kg;
        let over = |end: usize| {
            let retainer_m = f64::from([a, b][end].retainer_m);
            let share = (retainer_m - sensors[0]) / apart_m;
            let bends = (self.machine.rotor.bending().iter()).map(|mode| {
                let at = |place_m: f64| mode.displacement(place_m);
                let straight = (1.0 - share) * at(sensors[0]) + share * at(sensors[1]);
                let pushed: f64 = (magnets.iter().zip(configs))
                    .map(|(magnet_m, config)| at(*magnet_m) * f64::from(config.force_max_n))
                    .sum();
                (at(retainer_m) - straight) * pushed / (mass_kg * mode.frequency_rad_s.powi(2))
            });
            bends.sum::<f64>().abs() / f64::from(configs[end].clearance_m)
        };
        (apart_m != 0.0).then(|| over(0).max(over(1)))
    }

    /// Decides for the planes of its supervisor, and warns of what is left.
    pub(super) fn decide(&mut self, text: &SceneText) {
        let Some(both) = self.supervised() else {
            return;
        };
        if self.machine.rotor.bending().is_empty() {
            return;
        }
        let suggested = both.map(|plane| suggested(&self.planes[plane].nominal));
        let [first, second] = both.map(|plane| self.planes[plane].overrides.as_slice());
        let configs = [
            replaced(&suggested[0].config, first),
            replaced(&suggested[1].config, second),
        ];
        // What is refused is refused elsewhere.
        if configs.iter().any(|config| config.validate().is_err()) {
            return;
        }
        let (decided, role) = self.decided(&configs, [first, second]);
        for (plane, (before, after)) in both.into_iter().zip(configs.iter().zip(&decided)) {
            let plane = &mut self.planes[plane];
            let values = before.values().into_iter().zip(after.values());
            plane.decided = (values.enumerate())
                .filter(|(_, (before, after))| before != after)
                .map(|(index, (_, value))| Decided {
                    index,
                    value,
                    reason: reason(PARAMETERS[index].name, &role),
                })
                .collect();
            plane.supervisor = plane.supervisor.map(|_| *after);
        }
        let runs = both
            .iter()
            .all(|plane| self.planes[*plane].supervisor.is_some());
        if !(text.warns && runs) {
            return;
        }
        let grows = (self.least_damping(&decided)).is_some_and(|[percent, _]| percent < 0.0);
        let message = match (role.name, grows) {
            ("full", false) => return,
            ("full", true) => format!("acts in flight as well, and {}", role.reason),
            _ => format!(
                "acts on evident backward whirl only and leaves flight to levitation: {}",
                role.reason
            ),
        };
        self.warnings.push(text.warning("supervisor", message));
    }
}

/// Why a decided parameter has its value.
fn reason(parameter: &str, role: &Role) -> String {
    match parameter {
        "acts_in_flight" => role.reason.clone(),
        _ => "its force in flight would drive this bending mode".to_owned(),
    }
}
