//! What a control engineer wants to know of a bearing before the supervisor goes in: limits in closed
//! form, reaction time, noise, a suggested configuration, and what is weak.

mod listing;
mod noise;
mod rotor;
mod show;
mod warnings;

use crate::scene::nominal::{Override, replaced};
use crate::scene::suggest::{Decided, Nominal, Suggested, suggested};
use plant_model::analysis::arrest::Arrest;
use plant_model::analysis::onset::{critical_tangential_speed_m_s, lift_off_speed_m_s};
use serde::Serialize;
use supervisor::{Config, ConfigError, PARAMETERS};

pub use crate::crossover::{Crossover, SmallSignals};
pub use crate::scene::role::{ModeAtRisk, Role};
pub use listing::{Language, listing, rotor_in_c, short, table};
pub use noise::Noise;
pub use rotor::RotorAdvice;
pub use show::text;
pub use warnings::Warning;

/// Speeds at which the way in a reaction time is given \[m/s\].
const TYPICAL_SPEEDS_M_S: [f64; 3] = [0.1, 0.3, 1.0];

/// Share of v_lim from which the arrest time is given: at v_lim itself it is without end.
pub(crate) const ARREST_SHARE: f64 = 0.85;

/// Lag beyond which even a tangential force is worth less than half of itself.
pub(crate) const USEFUL_LAG_DEG: f64 = 75.0;

/// A runout that is faster than this share of √(F·c/m) is what the reading usually does, and hides an approach.
pub const RUNOUT_SPEED_SHARE: f64 = 0.4;

/// All of it; keys are stable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Advice {
    /// Scene or "plain numbers".
    pub title: String,
    /// What the advice is about.
    pub nominal: Nominal,
    /// Speeds that matter.
    pub limits: Limits,
    /// From a position to the force that answers it.
    pub reaction: Reaction,
    /// Lag of a force that turns with the whirl; none where there is no whirl limit.
    pub lag: Option<Lag>,
    /// Noise of the estimated speed.
    pub noise: Noise,
    /// What an impact may be.
    pub impact: Impact,
    /// What becomes of a vibration of the reading.
    #[serde(flatten)]
    pub vibration: Vibration,
    /// The suggested configuration, a row a parameter.
    pub parameters: Vec<Parameter>,
    /// The same as a table for a scene.
    pub supervisor_table: String,
    /// What is weak, and what to do.
    pub warnings: Vec<Warning>,
}

impl Advice {
    /// The configuration that it is about: suggested, but for what the scene replaces.
    pub fn in_use(&self) -> Config {
        let mut rows = self.parameters.iter();
        let values = [(); PARAMETERS.len()].map(|()| {
            let row = rows.next();
            row.map_or(0.0, |row| row.replaced_by.unwrap_or(row.value))
        });
        Config::from_values(values)
    }
}

/// Speeds that matter in continuous contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Limits {
    /// v_t,crit \[m/s\]: friction drives whirl above it; none where that is at every speed or at none.
    pub passive_threshold_m_s: Option<f64>,
    /// What that means.
    pub passive_threshold_text: &'static str,
    /// Force that the actuator has in every direction \[N\].
    pub force_n: f64,
    /// Below it a full inward force breaks the contact \[m/s\]; 0 where it cannot even at rest.
    pub lift_off_m_s: f64,
    /// v_lim \[m/s\]: whirl is arrested below it; none where there is no such limit.
    pub whirl_limit_m_s: Option<f64>,
    /// Why there is none, or what it means.
    pub whirl_limit_text: &'static str,
    /// Whirl frequency at v_lim, on its circle \[Hz\].
    pub whirl_limit_hz: Option<f64>,
    /// Time to stop the whirl from `ARREST_SHARE` of v_lim \[s\].
    pub arrest_time_s: Option<f64>,
}

/// From a position to the force that answers it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reaction {
    /// Longest wait for the next sample \[s\].
    pub sample_s: f64,
    /// Ticks of delay \[s\].
    pub delay_s: f64,
    /// Mean age of a force that is held for a tick \[s\].
    pub hold_s: f64,
    /// Amplifier \[s\].
    pub lag_s: f64,
    /// From a sample to the mean of its force \[s\]: delay, hold, lag.
    pub detect_to_force_s: f64,
    /// The same with the wait for the sample \[s\].
    pub worst_s: f64,
    /// How far the rotor goes from a sample to its force.
    pub ways: Vec<Way>,
}

/// A way at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Way {
    /// Speed \[m/s\].
    pub speed_m_s: f64,
    /// Way \[m\].
    pub way_m: f64,
    /// The same in clearances.
    pub way_clearances: f64,
}

/// Lag of a force that turns with the whirl at v_lim.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Lag {
    /// ω·(delay + hold) + atan(ω·lag) \[°\].
    pub angle_deg: f64,
    /// The part of delay and hold \[rad\]; the supervisor leads by 1 rad of it at most.
    pub delay_angle_rad: f64,
    /// atan μ \[°\]: beyond it re-centring drives the whirl.
    pub friction_angle_deg: f64,
    /// Beyond it tangential braking is not worth much \[°\].
    pub useful_deg: f64,
}

/// What an impact may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Impact {
    /// Outward speed in the centre beyond which contact cannot be avoided \[m/s\].
    pub unavoidable_m_s: f64,
    /// K = μ(1 + e)/(1 − e).
    pub bounce_gain: f64,
    /// Radial impact whose own friction impulse makes v_lim, on a hard wall \[m/s\].
    pub first_m_s: Option<f64>,
    /// The same on a wall that yields \[m/s\].
    pub first_compliant_m_s: Option<f64>,
    /// Radial impact that makes v_lim with all bounces to come \[m/s\].
    pub all_bounces_m_s: Option<f64>,
    /// Radial impact that makes v_t,crit with all bounces to come: what the rotor bears without help \[m/s\].
    pub passive_m_s: Option<f64>,
}

/// A vibration of the reading that the force does not change: runout, bending, noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Vibration {
    /// A small one is damped below it and driven above it, in flight \[Hz\]; none where it is damped up to half the rate of
    /// the loop.
    pub crossover_hz: Option<f64>,
    /// The most that the force drives with above it, as a coefficient \[N s/m\] …
    pub driving_n_s_m: Option<f64>,
    /// … and where \[Hz\].
    pub driving_hz: Option<f64>,
    /// Largest amplitude of a runout at the spin, on one axis, with which the supervisor helps \[m\]; none where no spin
    /// is known.
    pub runout_limit_m: Option<f64>,
}

/// A parameter of the suggested configuration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    pub name: &'static str,
    pub value: f32,
    pub unit: &'static str,
    /// How it was chosen.
    pub reason: String,
    /// What the scene's own `[supervisor]` puts in its place.
    pub replaced_by: Option<f32>,
}

/// A suggested value outside its range.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// Which and why.
    pub error: ConfigError,
    /// Field of [`Nominal`] that it comes from.
    pub source: Option<&'static str>,
}

impl Advice {
    /// For nominal data. `overrides` is what a scene puts in the place of single values.
    ///
    /// # Errors
    /// The first suggested value that the supervisor would refuse.
    pub fn new(
        title: &str,
        nominal: &Nominal,
        overrides: &[Override],
    ) -> Result<Self, Box<OutOfRange>> {
        Self::of_plane(title, nominal, &[], overrides)
    }

    /// The same of a plane of a rotor, of which `decided` is what the whole rotor puts in the place of suggested values.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_plane(
        title: &str,
        nominal: &Nominal,
        decided: &[Decided],
        overrides: &[Override],
    ) -> Result<Self, Box<OutOfRange>> {
        let suggested = suggested(nominal).with(decided);
        let config = &suggested.config;
        config.validate().map_err(|error| {
            let source = suggested.source(error.parameter().name);
            Box::new(OutOfRange { error, source })
        })?;
        let in_use = replaced(config, overrides);
        let limits = limits(nominal);
        let reaction = reaction(nominal);
        let noise = Noise::of(nominal, overrides, &limits);
        let mut advice = Self {
            title: title.to_owned(),
            nominal: *nominal,
            lag: lag(nominal, &limits, &reaction),
            noise,
            impact: impact(nominal, config, &limits, &reaction),
            vibration: vibration(nominal, &in_use),
            limits,
            reaction,
            parameters: parameters(&suggested, &in_use),
            supervisor_table: String::new(),
            warnings: Vec::new(),
        };
        advice.supervisor_table = table(&advice.parameters);
        advice.warnings = warnings::of(&advice, &in_use);
        Ok(advice)
    }
}

/// The coefficient that drives backward whirl.
fn driving_friction(n: &Nominal) -> f64 {
    n.friction_coefficient - n.rolling_coefficient
}

fn limits(n: &Nominal) -> Limits {
    let plant = n.plant();
    let force_n = n.force_everywhere_n();
    let drives = driving_friction(n) > 0.0;
    let threshold = critical_tangential_speed_m_s(&plant).filter(|v| *v > 0.0);
    let passive_threshold_text = match threshold {
        Some(_) => "friction drives whirl above it; below it damping and shaft win",
        None if !drives => "none: friction drives nothing",
        // μ·(m·v²/c + |k|·c) = d·v has two solutions where the damping is strong.
        None if n.stiffness_n_m < 0.0
            && n.damping_n_s_m.powi(2)
                > -4.0 * driving_friction(n).powi(2) * n.mass_kg * n.stiffness_n_m =>
        {
            "none: the negative stiffness presses the rotor onto the wall and friction drives it from rest; only between two speeds damping wins"
        }
        None if n.stiffness_n_m < 0.0 => {
            "none: the negative stiffness presses the rotor onto the wall, friction drives it from any speed"
        }
        None => "none: without shaft stiffness and damping friction drives it from any speed",
    };
    // Without a positive speed at which friction wins there is nothing to arrest from.
    let arrest = Arrest::new(&plant, force_n).filter(|a| a.limit_m_s > 0.0);
    let time_s = arrest
        .map(|a| a.time_s(ARREST_SHARE * a.limit_m_s, 0.0))
        .filter(|t| t.is_finite());
    Limits {
        passive_threshold_m_s: threshold,
        passive_threshold_text,
        force_n,
        lift_off_m_s: lift_off_speed_m_s(&plant, force_n),
        whirl_limit_m_s: arrest.map(|a| a.limit_m_s),
        whirl_limit_text: match arrest {
            Some(_) => "the cap arrests whirl below it; above it friction wins",
            None if !drives => "none: friction drives nothing",
            None if n.stiffness_n_m < 0.0 => {
                "none: the negative stiffness presses the rotor onto the wall, and from rest friction is more than the cap"
            }
            None => "none: damping is more than friction at any speed",
        },
        whirl_limit_hz: arrest.map(|a| a.limit_m_s / a.radius_m / std::f64::consts::TAU),
        arrest_time_s: time_s,
    }
}

pub(crate) fn reaction(n: &Nominal) -> Reaction {
    let sample_s = n.period_s();
    let (delay_s, hold_s) = (f64::from(n.delay_samples) * sample_s, 0.5 * sample_s);
    let detect_to_force_s = delay_s + hold_s + n.lag_s;
    let way = |speed_m_s: f64| Way {
        speed_m_s,
        way_m: speed_m_s * detect_to_force_s,
        way_clearances: speed_m_s * detect_to_force_s / n.clearance_m,
    };
    Reaction {
        sample_s,
        delay_s,
        hold_s,
        lag_s: n.lag_s,
        detect_to_force_s,
        worst_s: sample_s + detect_to_force_s,
        ways: TYPICAL_SPEEDS_M_S.map(way).to_vec(),
    }
}

fn lag(n: &Nominal, limits: &Limits, reaction: &Reaction) -> Option<Lag> {
    let rate_rad_s = limits.whirl_limit_hz? * std::f64::consts::TAU;
    let delay_angle_rad = rate_rad_s * (reaction.delay_s + reaction.hold_s);
    Some(Lag {
        angle_deg: (delay_angle_rad + (rate_rad_s * n.lag_s).atan()).to_degrees(),
        delay_angle_rad,
        friction_angle_deg: driving_friction(n).atan().to_degrees(),
        useful_deg: USEFUL_LAG_DEG,
    })
}

fn impact(n: &Nominal, config: &Config, limits: &Limits, reaction: &Reaction) -> Impact {
    let (mu, e) = (driving_friction(n), f64::from(config.restitution));
    let bounce_gain = mu.max(0.0) * (1.0 + e) / (1.0 - e);
    let limit = limits.whirl_limit_m_s;
    let first = |v: f64| v / (mu * (1.0 + e));
    // v·(1 + b·v) = v_first: the positive root, in the form that has no difference of like numbers.
    let b =
        std::f64::consts::FRAC_PI_4 / n.clearance_m * (n.mass_kg / n.contact_stiffness_n_m).sqrt();
    let compliant = |v: f64| 2.0 * v / (1.0 + (1.0 + 4.0 * b * v).sqrt());
    Impact {
        unavoidable_m_s: unavoidable_m_s(n, limits.force_n, reaction.detect_to_force_s),
        bounce_gain,
        first_m_s: limit.map(first),
        first_compliant_m_s: limit.map(|v| compliant(first(v))),
        all_bounces_m_s: limit.map(|v| v / bounce_gain),
        passive_m_s: limits.passive_threshold_m_s.map(|v| v / bounce_gain),
    }
}

/// v² = 2·a·(c − v·T) + k·c²/m with a = (F − load)/m, and no farther than the wall in T; 0 where not even
/// a rotor at rest is safe.
fn unavoidable_m_s(n: &Nominal, force_n: f64, horizon_s: f64) -> f64 {
    let (c, m) = (n.clearance_m, n.mass_kg);
    let a = (force_n - n.load_n) / m;
    let at = a * horizon_s;
    let work = 2.0 * a * c + n.stiffness_n_m * c * c / m;
    if a <= 0.0 || work <= 0.0 {
        return 0.0;
    }
    (work / (at + (at * at + work).sqrt())).min(c / horizon_s)
}

fn vibration(n: &Nominal, in_use: &Config) -> Vibration {
    let crossover = SmallSignals::new(in_use).crossover();
    let runout_limit_m = n.spin_hz.map(|hz| {
        let rate_rad_s = std::f64::consts::TAU * hz.abs();
        (RUNOUT_SPEED_SHARE * n.force_speed_m_s() / rate_rad_s).min(n.clearance_m)
    });
    Vibration {
        crossover_hz: crossover.map(|c| c.frequency_hz),
        driving_n_s_m: crossover.map(|c| c.driving_n_s_m),
        driving_hz: crossover.map(|c| c.driving_hz),
        runout_limit_m,
    }
}

fn parameters(suggested: &Suggested, in_use: &Config) -> Vec<Parameter> {
    let used = in_use.values();
    let row = |(i, (p, value)): (usize, (&supervisor::Parameter, f32))| Parameter {
        name: p.name,
        value,
        unit: p.unit,
        reason: (suggested.reasons.get(i)).map_or(String::new(), |r| r.text.clone()),
        replaced_by: Some(used[i]).filter(|used| *used != value),
    };
    let values = suggested.config.values();
    (PARAMETERS.iter().zip(values).enumerate())
        .map(row)
        .collect()
}
