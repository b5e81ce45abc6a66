//! From data sheets to the supervisor's configuration: one function for scenes and `advise`, on top of the one that firmware
//! has, [`Config::for_bearing`], so that none of them can differ.

use plant_model::params::{
    ContactParams, FrictionParams, LinearContact, MagnetParams, PlantParams, RotorParams,
    SlidingFriction, SpinParams, StatorParams,
};
use serde::Serialize;
use supervisor::{Bearing, Config, DefaultRule, PARAMETERS};

/// Control rates that the supervisor is made for \[Hz\].
pub(crate) const SUPERVISED_RATES_HZ: std::ops::RangeInclusive<f64> = 1e4..=5e4;

/// The suggested limit of positions lies at this share of the sensor's range, clear of the rail by more than its noise, …
pub(crate) const RAIL_SHARE: f64 = 0.95;
/// … but never below this \[clearances\]: the rotor presses the wall.
pub(crate) const LEAST_LIMIT: f64 = 1.1;

/// Nominal data of one bearing plane, SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Nominal {
    /// Control rate \[Hz\].
    pub sample_rate_hz: f64,
    /// Mass of the rotor that the plane carries \[kg\].
    pub mass_kg: f64,
    /// Shaft stiffness less the magnets' negative stiffness \[N/m\].
    pub stiffness_n_m: f64,
    /// Passive damping \[N s/m\].
    pub damping_n_s_m: f64,
    /// Radial clearance of the retainer bearing \[m\].
    pub clearance_m: f64,
    /// Stiffness of the contact \[N/m\].
    pub contact_stiffness_n_m: f64,
    /// Whether that is the tangent at a depth of one clearance of a contact that hardens.
    pub contact_hardens: bool,
    /// Mass that moves against the contact \[kg\]: rotor and ring, reduced.
    pub contact_mass_kg: f64,
    /// Restitution of a radial impact, where it is known.
    pub restitution: Option<f64>,
    /// Coefficient of sliding friction at rest.
    pub friction_coefficient: f64,
    /// Coefficient of rolling friction, which works against the whirl.
    pub rolling_coefficient: f64,
    /// Force cap, as the length of the vector \[N\].
    pub force_max_n: f64,
    /// Cap of each axis, where there is one \[N\].
    pub axis_force_max_n: Option<f64>,
    /// Fastest change of the force, where it is limited \[N/s\].
    pub slew_n_s: Option<f64>,
    /// Time constant of the amplifier with the magnet \[s\].
    pub lag_s: f64,
    /// Ticks from a position to the start of the force that answers it; an old position is the same to it
    /// as a late force.
    pub delay_samples: u32,
    /// Noise of the position (root mean square) \[m\].
    pub noise_rms_m: f64,
    /// Step of the converter \[m\].
    pub quantum_m: f64,
    /// Largest reading to either side, where it is known \[m\].
    pub range_m: Option<f64>,
    /// Static load that the bearing carries, its weight as a rule \[N\].
    pub load_n: f64,
    /// How far the centre of the retainer bearing lies off that of the sensors \[m\].
    pub centre_offset_m: f64,
    /// Spin, where it is known \[Hz\].
    pub spin_hz: Option<f64>,
    /// Amplitude of the runout that turns with the spin, of the reading on one axis, where it is known \[m\].
    pub runout_m: Option<f64>,
    /// Position at the retainer bearing over position at the sensor, as an impact moves them.
    pub retainer_plane_ratio: f64,
    /// Position at the magnet over position at the retainer bearing, likewise.
    pub magnet_plane_ratio: f64,
}

impl Nominal {
    /// Contact band that an offset of the retainer bearing needs \[clearances\], to see a touch on the side that is nearest
    /// to the sensors' centre; `None` where it has none.
    pub(crate) fn contact_band_needed(&self) -> Option<f64> {
        let needed = (3.0 * self.sensor_noise_m() + self.centre_offset_m) / self.clearance_m;
        (self.centre_offset_m != 0.0).then_some(needed)
    }

    /// Period of the tick \[s\].
    pub fn period_s(&self) -> f64 {
        1.0 / self.sample_rate_hz
    }

    /// Force that the actuator has in every direction \[N\].
    pub(crate) fn force_everywhere_n(&self) -> f64 {
        (self.axis_force_max_n).map_or(self.force_max_n, |axis| axis.min(self.force_max_n))
    }

    /// √(F·c/m) \[m/s\]: the lift-off speed without stiffness, the supervisor's unit of slow.
    pub fn force_speed_m_s(&self) -> f64 {
        (self.force_max_n * self.clearance_m / self.mass_kg).sqrt()
    }

    /// Noise of a position with the converter's step in it (root mean square) \[m\].
    pub fn sensor_noise_m(&self) -> f64 {
        (self.noise_rms_m.powi(2) + self.quantum_m.powi(2) / 12.0).sqrt()
    }

    /// The plant that the closed forms are about: rigid wall, held spin, constant friction.
    pub fn plant(&self) -> PlantParams {
        PlantParams {
            rotor: RotorParams {
                mass_kg: self.mass_kg,
                stiffness_n_m: self.stiffness_n_m,
                damping_n_s_m: self.damping_n_s_m,
                eccentricity_m: 0.0,
                // No closed form asks for it.
                contact_radius_m: 0.1,
            },
            spin: SpinParams::Held,
            stator: StatorParams::Rigid,
            contact: ContactParams {
                clearance_m: self.clearance_m,
                law: LinearContact {
                    stiffness_n_m: self.contact_stiffness_n_m,
                    damping_n_s_m: 0.0,
                }
                .into(),
            },
            friction: FrictionParams {
                sliding: SlidingFriction::Constant {
                    coefficient: self.friction_coefficient,
                },
                rolling_coefficient: self.rolling_coefficient,
            },
            magnet: Some(MagnetParams {
                force_max_n: self.force_max_n,
                lag_s: self.lag_s,
            }),
            race: None,
        }
    }
}

/// Why a parameter has its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Reason {
    /// Name of the field of [`Config`].
    pub name: &'static str,
    /// Field of [`Nominal`] that decides most; `None` where it is the same for every bearing.
    pub source: Option<&'static str>,
    /// How it was chosen, one line.
    pub text: String,
}

/// A configuration with a reason for each value.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggested {
    /// The values.
    pub config: Config,
    /// The reasons, in the order of the fields of [`Config`].
    pub reasons: Vec<Reason>,
}

/// A value that the whole rotor decides, in the place of what is suggested of its plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided {
    /// Place of the parameter in [`PARAMETERS`].
    pub index: usize,
    pub value: f32,
    /// Why, one line.
    pub reason: String,
}

impl Suggested {
    /// With what the whole rotor decides.
    #[must_use]
    pub fn with(mut self, decided: &[Decided]) -> Self {
        let mut values = self.config.values();
        for of_rotor in decided {
            values[of_rotor.index] = of_rotor.value;
            self.reasons[of_rotor.index]
                .text
                .clone_from(&of_rotor.reason);
        }
        self.config = Config::from_values(values);
        self
    }

    /// Field of [`Nominal`] that a parameter comes from.
    pub fn source(&self, name: &str) -> Option<&'static str> {
        (self.reasons.iter().find(|r| r.name == name)).and_then(|r| r.source)
    }
}

impl Nominal {
    /// The nine numbers that firmware derives its configuration from.
    pub fn bearing(&self) -> Bearing {
        Bearing {
            sample_period_s: self.period_s() as f32,
            mass_kg: self.mass_kg as f32,
            stiffness_n_m: self.stiffness_n_m as f32,
            clearance_m: self.clearance_m as f32,
            force_max_n: self.force_max_n as f32,
            amplifier_lag_s: self.lag_s as f32,
            friction_coefficient: self.friction_coefficient as f32,
            contact_stiffness_n_m: self.contact_stiffness_n_m as f32,
            sensor_noise_m: self.sensor_noise_m() as f32,
        }
    }
}

/// The configuration as an engineer would derive it from data sheets: that of [`Config::for_bearing`], and on top what is known
/// beyond its nine numbers.
pub fn suggested(n: &Nominal) -> Suggested {
    let bearing = n.bearing();
    let own = Config::for_bearing(&bearing);
    // The poles are about what noise and step do together, the others about the larger of them.
    let stepped = Config::for_bearing(&Bearing {
        sensor_noise_m: n.noise_rms_m.max(n.quantum_m) as f32,
        ..bearing
    });
    // What moves against the contact may be less than the rotor.
    let in_contact = Config::for_bearing(&Bearing {
        mass_kg: n.contact_mass_kg as f32,
        ..bearing
    });
    let position_limit = n.below_rail().map_or(own.position_limit, |limit| {
        limit.clamp(LEAST_LIMIT, f64::from(own.position_limit)) as f32
    });
    let config = Config {
        damping_n_s_m: n.damping_n_s_m as f32,
        delay_samples: n.delay_samples as f32,
        restitution: (n.restitution).map_or(own.restitution, |e| e.min(0.95) as f32),
        contact_band: stepped.contact_band,
        position_limit,
        whirl_time_s: in_contact.whirl_time_s,
        axis_force_max_n: (n.axis_force_max_n).map_or(own.axis_force_max_n, |axis| axis as f32),
        force_slew_n_s: n.slew_n_s.map_or(own.force_slew_n_s, |slew| slew as f32),
        retainer_plane_ratio: n.retainer_plane_ratio as f32,
        magnet_plane_ratio: n.magnet_plane_ratio as f32,
        speed_max_m_s: in_contact.speed_max_m_s,
        sensor_step_m: stepped.sensor_step_m,
        // A machine that is simulated has the numbers that it was made of.
        check_first: 0.0,
        ..own
    };
    let reasons = PARAMETERS.iter().map(|p| n.reason(p)).collect();
    Suggested { config, reasons }
}

impl Nominal {
    /// Limit of positions that is clear of the sensor's rail \[clearances\], where that is known.
    fn below_rail(&self) -> Option<f64> {
        (self.range_m).map(|range_m| RAIL_SHARE * range_m / self.clearance_m)
    }

    /// Why a parameter has its value: what was given, or else the rule of its default.
    fn reason(&self, parameter: &supervisor::Parameter) -> Reason {
        let name = parameter.name;
        let by_rule = match parameter.default {
            DefaultRule::Given => "as given",
            DefaultRule::Constant(_, rule) | DefaultRule::Derived(rule) => rule,
        };
        let step_source = if self.quantum_m > self.noise_rms_m {
            "quantum_m"
        } else {
            "noise_rms_m"
        };
        let (source, text) = match name {
            "sample_period_s" => (Some("sample_rate_hz"), "inverse of the control rate"),
            "stiffness_n_m" => (Some(name), "shaft less the magnets' negative stiffness"),
            "amplifier_lag_s" => (Some("lag_s"), by_rule),
            "damping_n_s_m" => (Some(name), "as given; 0 is on the safe side"),
            "friction_coefficient" => (Some(name), "sliding friction at rest"),
            "delay_samples" => (
                Some(name),
                "ticks of the sensor and of the actuator together",
            ),
            "restitution" if self.restitution.is_some() => (
                Some(name),
                "as given, at most 0.95: nearer to 1 the bounces never end",
            ),
            "contact_stiffness_n_m" if self.contact_hardens => (
                Some(name),
                "tangent at a depth of one clearance of the Hunt-Crossley law that is given",
            ),
            "observer_pole_flight" | "observer_pole_contact" | "contact_band" | "sensor_step_m" => {
                (Some(step_source), by_rule)
            }
            "position_limit" => match self.below_rail() {
                None => (None, by_rule),
                Some(limit) if limit < LEAST_LIMIT => (
                    Some("range_m"),
                    "the least there is: 0.95 of the sensor's range is less, and its rail looks like a position",
                ),
                Some(_) => (
                    Some("range_m"),
                    "0.95 of the sensor's range over clearance, from 1.1 to 20: at the rail it measures nothing",
                ),
            },
            "axis_force_max_n" if self.axis_force_max_n.is_some() => (Some(name), "as given"),
            "force_slew_n_s" if self.slew_n_s.is_some() => (Some("slew_n_s"), "as given"),
            "axis_force_max_n" | "force_slew_n_s" | "continuous_force_n" => {
                (Some("force_max_n"), by_rule)
            }
            "whirl_time_s" | "speed_max_m_s" => (Some("contact_stiffness_n_m"), by_rule),
            "retainer_plane_ratio" if self.retainer_plane_ratio != 1.0 => {
                (Some(name), "as an impact moves them")
            }
            "magnet_plane_ratio" if self.magnet_plane_ratio != 1.0 => {
                (Some(name), "as an impact moves them")
            }
            "restitution" => (Some(name), by_rule),
            "check_first" => (
                None,
                "a simulated machine has the numbers that it was made of; firmware begins with 1",
            ),
            _ => match parameter.default {
                DefaultRule::Given => (Some(name), by_rule),
                DefaultRule::Constant(..) | DefaultRule::Derived(_) => (None, by_rule),
            },
        };
        Reason {
            name,
            source,
            text: text.to_owned(),
        }
    }
}

/// Noise of the speed that the observer makes of the sensor's (root mean square), in flight and in
/// contact \[m/s\].
pub(crate) fn speed_noise_m_s(n: &Nominal, config: &Config) -> [f64; 2] {
    let per_gain = n.sensor_noise_m() / n.period_s();
    [
        per_gain * second_order_noise(f64::from(config.observer_pole_flight)),
        per_gain * first_order_noise(f64::from(config.observer_pole_contact)),
    ]
}

/// Speed noise over position noise per tick of the critically damped filters with a pole ρ: the
/// known variances of fading-memory filters of second …
fn second_order_noise(p: f64) -> f64 {
    ((1.0 - p).powi(3) / (1.0 + p).powi(5) * (13.0 + 50.0 * p + 49.0 * p * p) / 2.0).sqrt()
}

fn first_order_noise(p: f64) -> f64 {
    (2.0 * ((1.0 - p) / (1.0 + p)).powi(3)).sqrt()
}
