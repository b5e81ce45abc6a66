//! From data sheets to the supervisor's configuration: one function for scenes and `advise`, so that they
//! cannot differ.

use plant_model::params::{
    ContactParams, FrictionParams, LinearContact, MagnetParams, PlantParams, RotorParams,
    SlidingFriction, SpinParams, StatorParams,
};
use serde::Serialize;
use supervisor::Config;

/// Control rates that the supervisor is made for \[Hz\].
pub const SUPERVISED_RATES_HZ: std::ops::RangeInclusive<f64> = 1e4..=5e4;

/// Suggested poles of the observer have a noise of the speed of at most this share of √(F·c/m), …
pub(crate) const POLE_AIM: f64 = 0.04;
/// … and are the quickest that have it, from these upwards, in flight and in contact, …
pub(crate) const QUICKEST_POLES: [f64; 2] = [0.5, 0.2];
/// … to this one.
pub(crate) const SLOWEST_POLE: f64 = 0.97;

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
    pub fn contact_band_needed(&self) -> Option<f64> {
        let needed = (3.0 * self.sensor_noise_m() + self.centre_offset_m) / self.clearance_m;
        (self.centre_offset_m != 0.0).then_some(needed)
    }

    /// Period of the tick \[s\].
    pub fn period_s(&self) -> f64 {
        1.0 / self.sample_rate_hz
    }

    /// Force that the actuator has in every direction \[N\].
    pub fn force_everywhere_n(&self) -> f64 {
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

    /// √(k_c/m) of the rotor on the contact \[rad/s\].
    fn contact_rate_rad_s(&self) -> f64 {
        (self.contact_stiffness_n_m / self.contact_mass_kg).sqrt()
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
    /// Field of [`Nominal`] that decides most; `None` for a rule of thumb.
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

impl Suggested {
    /// Field of [`Nominal`] that a parameter comes from.
    pub fn source(&self, name: &str) -> Option<&'static str> {
        (self.reasons.iter().find(|r| r.name == name)).and_then(|r| r.source)
    }
}

/// The struct literal makes the compiler see that no field is missing.
macro_rules! suggested {
    ($($name:ident: $value:expr, $source:expr, $text:expr;)*) => {
        Suggested {
            config: Config { $($name: $value as f32),* },
            reasons: vec![
                $(Reason { name: stringify!($name), source: $source, text: $text.to_string() }),*
            ],
        }
    };
}

/// The configuration as an engineer would derive it from data sheets.
pub fn suggested(n: &Nominal) -> Suggested {
    let period_s = n.period_s();
    let contact_rate = n.contact_rate_rad_s();
    let step_m = n.noise_rms_m.max(n.quantum_m);
    // What the magnet does not limit is limited by nothing that matters.
    let axis_force_max_n = n.axis_force_max_n.unwrap_or(n.force_max_n);
    let free_slew_n_s = (1e3 * n.force_max_n / period_s).clamp(1.0, 1e12);
    let [flight, contact] = observer_poles(n);
    let axis_source = match n.axis_force_max_n {
        Some(_) => "axis_force_max_n",
        None => "force_max_n",
    };
    let slew_source = match n.slew_n_s {
        Some(_) => "slew_n_s",
        None => "force_max_n",
    };
    let step_source = if n.quantum_m > n.noise_rms_m {
        "quantum_m"
    } else {
        "noise_rms_m"
    };
    let below_rail = n
        .range_m
        .map(|range_m| RAIL_SHARE * range_m / n.clearance_m);
    let position_limit = below_rail.map_or(20.0, |limit| limit.clamp(LEAST_LIMIT, 20.0));
    let limit_source = n.range_m.map(|_| "range_m");
    const QUICKEST: &str = "speed noise is at most 4 % of √(F·c/m)";
    suggested! {
        sample_period_s: period_s, Some("sample_rate_hz"), "inverse of the control rate";
        mass_kg: n.mass_kg, Some("mass_kg"), "as given";
        stiffness_n_m: n.stiffness_n_m, Some("stiffness_n_m"), "shaft less the magnets' negative stiffness";
        damping_n_s_m: n.damping_n_s_m, Some("damping_n_s_m"), "as given; 0 is on the safe side";
        clearance_m: n.clearance_m, Some("clearance_m"), "as given";
        force_max_n: n.force_max_n, Some("force_max_n"), "as given";
        amplifier_lag_s: n.lag_s, Some("lag_s"), "as given";
        delay_samples: n.delay_samples, Some("delay_samples"), "ticks of the sensor and of the actuator together";
        friction_coefficient: n.friction_coefficient, Some("friction_coefficient"), "sliding friction at rest";
        restitution: n.restitution.unwrap_or(0.7).min(0.95), Some("restitution"), match n.restitution {
            Some(_) => "as given, at most 0.95: nearer to 1 the bounces never end",
            None => "not given: 0.7, steel on steel",
        };
        observer_pole_flight: flight, Some(step_source), format!("quickest from 0.5 to 0.97 whose {QUICKEST}");
        observer_pole_contact: contact, Some(step_source), format!("quickest from 0.2 to 0.97 whose {QUICKEST}");
        contact_band: (4.0 * (step_m / n.clearance_m)).max(0.01), Some(step_source), "4 times noise or step over clearance, at least 0.01";
        position_limit: position_limit, limit_source, match below_rail {
            Some(limit) if limit < LEAST_LIMIT => "the least there is: 0.95 of the sensor's range is less, its rail is not told from a position",
            Some(_) => "0.95 of the sensor's range over clearance, from 1.1 to 20: at the rail it measures nothing",
            None => "the sensor's range is not known: no machine measures so far out",
        };
        // Two half periods on the contact spring, but no less than a millisecond.
        whirl_time_s: (std::f64::consts::TAU / contact_rate).max(1e-3), Some("contact_stiffness_n_m"), "a period on the contact, 2π·√(m/k_c), at least 1 ms";
        hold_share: 0.8, None, "rule of thumb: gentle at first";
        handover_dwell_s: 5e-4, None, "rule of thumb: some samples without doubt";
        handover_blend_s: 2e-3, None, "rule of thumb: shorter than a levitation loop settles";
        fault_blend_s: 2e-2, None, "rule of thumb: longer than most interruptions; a force that stands still holds the rotor to one side, none lets it whirl";
        fault_ticks: 5.0, None, "rule of thumb: longer than a burst of interference, and little against the time to cross the clearance";
        axis_force_max_n: axis_force_max_n, Some(axis_source), match n.axis_force_max_n {
            Some(_) => "as given",
            None => "the cap: no limit of an axis was given",
        };
        force_slew_n_s: n.slew_n_s.unwrap_or(free_slew_n_s), Some(slew_source), match n.slew_n_s {
            Some(_) => "as given",
            None => "a thousand caps per sample: no limit was given",
        };
        continuous_force_n: n.force_max_n, Some("force_max_n"), "the cap: no thermal budget";
        thermal_time_s: 5.0, None, "without effect while there is no thermal budget";
        contact_stiffness_n_m: n.contact_stiffness_n_m, Some("contact_stiffness_n_m"), match n.contact_hardens {
            true => "tangent at a depth of one clearance of the Hunt-Crossley law that is given",
            false => "as given",
        };
        // Several periods of a whirl of some hundred hertz; the stop of the machine takes far longer.
        coast_down_s: 5e-3, None, "rule of thumb: several periods of the whirl";
        severity_limit: 20.0, None, "rule of thumb, until a landing has been measured";
        retainer_plane_ratio: n.retainer_plane_ratio, lever_source(n.retainer_plane_ratio, "retainer_plane_ratio"), match n.retainer_plane_ratio {
            1.0 => "one plane: sensor and retainer bearing move alike",
            _ => "as an impact moves them",
        };
        magnet_plane_ratio: n.magnet_plane_ratio, lever_source(n.magnet_plane_ratio, "magnet_plane_ratio"), match n.magnet_plane_ratio {
            1.0 => "one plane: magnet and retainer bearing move alike",
            _ => "as an impact moves them",
        };
        // Whirl is no faster than the rotor on the contact spring; half more for its deflection.
        speed_max_m_s: (1.5 * n.clearance_m * contact_rate).max(2.0), Some("contact_stiffness_n_m"), "1.5·c·√(k_c/m), at least 2 m/s";
        // A sensor without noise and steps is not a thing that gets stuck.
        sensor_step_m: step_m.max(5e-4 * n.clearance_m), Some(step_source), "noise or step, at least 1/2000 of the clearance";
    }
}

/// What a lever comes from that is none of one plane.
fn lever_source(ratio: f64, field: &'static str) -> Option<&'static str> {
    (ratio != 1.0).then_some(field)
}

/// Poles in flight and in contact.
fn observer_poles(n: &Nominal) -> [f64; 2] {
    // Noise of the estimated speed in units of the speed that the force can still lift off.
    let noise = n.sensor_noise_m() / n.period_s() / n.force_speed_m_s();
    [
        pole_for(noise, QUICKEST_POLES[0], second_order_noise),
        pole_for(noise, QUICKEST_POLES[1], first_order_noise),
    ]
}

/// Noise of the speed that the observer makes of the sensor's (root mean square), in flight and in
/// contact \[m/s\].
pub fn speed_noise_m_s(n: &Nominal, config: &Config) -> [f64; 2] {
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

/// … and of first order.
fn first_order_noise(p: f64) -> f64 {
    (2.0 * ((1.0 - p) / (1.0 + p)).powi(3)).sqrt()
}

/// The quickest pole, not below `quickest`, whose speed noise is at most a share of the lift-off
/// speed that the laws do not feel.
fn pole_for(noise: f64, quickest: f64, gain: fn(f64) -> f64) -> f64 {
    let mut pole = quickest;
    while pole < SLOWEST_POLE && noise * gain(pole) > POLE_AIM {
        pole += 0.01;
    }
    pole
}
