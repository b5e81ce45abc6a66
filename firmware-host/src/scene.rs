//! A scene: the plant, its instruments and controllers, what happens to it, and what is asked.

use crate::instruments::SensorParams;
use crate::levitation::LevitationParams;
use crate::plant_setup::plant_of;
use crate::policy_kind::PolicyKind;
use crate::scene_error::{Checks, SceneError, SceneText, with_guess};
use crate::scene_file::{LevitationFile, MethodFile, SceneFile};
use crate::supervisor_setup;
use plant_model::analysis::onset::lift_off_speed_m_s;
use plant_model::params::{PlantParams, Start};
use plant_model::{Method, V2};
use std::f64::consts::TAU;
use std::path::Path;

/// A constant force on the rotor for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
    /// Beginning \[s\].
    pub start_s: f64,
    /// Duration \[s\].
    pub duration_s: f64,
    /// Force \[N\].
    pub force_n: V2,
}

impl Disturbance {
    /// End \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }
}

/// A scene that can be run: every value checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Title, one line.
    pub title: String,
    /// What is shown and why.
    pub story: String,
    /// The plant.
    pub plant: PlantParams,
    /// Where it starts.
    pub start: Start,
    /// Weight of the rotor \[N\].
    pub weight_n: V2,
    /// Forces that come and go.
    pub disturbances: Vec<Disturbance>,
    /// End of the run \[s\].
    pub duration_s: f64,
    /// Control rate \[Hz\].
    pub sample_rate_hz: f64,
    /// Tolerance of a contact step.
    pub rtol: f64,
    /// How contact is integrated.
    pub method: Method,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// Policies to run.
    pub policies: Vec<PolicyKind>,
    /// The position sensor.
    pub sensor: SensorParams,
    /// The levitation controller; needed by the policies that use one.
    pub levitation: Option<LevitationParams>,
    /// `radial` pushes beyond this share of the clearance.
    pub radial_band: f64,
    /// Configuration of the supervisor; needed by the policy of that name.
    pub supervisor: Option<supervisor::Config>,
    /// Backward contact speed above which a run is whirl \[m/s\].
    pub whirl_speed_m_s: f64,
    /// What is allowed and yet unlikely to be meant, with file and line.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::from_text(&SceneText::read(path)?)
    }

    /// A scene from the text of a file; errors name it `name`.
    ///
    /// # Errors
    /// [`SceneError`] with line and key.
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        Self::from_text(&SceneText {
            path: name.into(),
            text: text.to_owned(),
        })
    }

    /// Weight and disturbances that act from a time on \[N\].
    pub fn external_n(&self, from_s: f64) -> V2 {
        let acting = |d: &&Disturbance| d.start_s <= from_s && from_s < d.end_s();
        let forces = self.disturbances.iter().filter(acting);
        forces.fold(self.weight_n, |sum, d| sum + d.force_n)
    }

    fn from_text(text: &SceneText) -> Result<Self, SceneError> {
        let file: SceneFile = toml::from_str(&text.text)
            .map_err(|error| text.error_in_toml(error.span().unwrap_or(0..0), error.message()))?;
        Self::from_file(&file, text)
    }

    fn from_file(file: &SceneFile, text: &SceneText) -> Result<Self, SceneError> {
        let plant = plant_of(file, text)?;
        let start = Start {
            position_m: file.start.position_m.0.into(),
            velocity_m_s: file.start.velocity_m_s.0.into(),
            spin_rad_s: file.spin.frequency_hz * TAU,
            spin_phase_rad: file.start.spin_phase_rad,
        };
        let check = Checks { text };
        (start.validate()).map_err(|e| {
            let key = if e.field == "start.spin_rad_s" {
                "spin.frequency_hz"
            } else {
                e.field
            };
            check.refused(key, e.value, e.expected)
        })?;
        check.within("run.duration_s", file.run.duration_s, 1e-9, 1e5)?;
        check.within("run.sample_rate_hz", file.run.sample_rate_hz, 1.0, 1e6)?;
        check.within("run.rtol", file.run.rtol, 1e-14, 1e-2)?;
        if matches!(file.run.method, MethodFile::Series) && plant.contact.law.linear().is_none() {
            let message = "series does not go with contact.stiffness_n_mn".to_owned();
            let help =
                "take auto, explicit or stiff: this contact has no power series at the touch";
            return Err(text.error_at_key("run.method", message, Some(help.to_owned())));
        }
        let ticks = file.run.duration_s * file.run.sample_rate_hz;
        if ticks > 2e7 {
            let help = "shorten run.duration_s or lower run.sample_rate_hz".to_owned();
            let message = format!("{ticks:.0} control samples: expected at most 20 million");
            return Err(text.error_at_key("run.duration_s", message, Some(help)));
        }
        check.within("sensor.quantum_m", file.sensor.quantum_m, 0.0, 1.0)?;
        check.within("sensor.noise_rms_m", file.sensor.noise_rms_m, 0.0, 1.0)?;
        check.within("radial.band", file.radial.band, 0.0, 1.0)?;
        for axis in file.rotor.gravity_m_s2.0 {
            check.within("rotor.gravity_m_s2", axis, -1e4, 1e4)?;
        }
        let levitation = file.levitation.as_ref().map(|l| levitation_of(l, &check));
        let levitation = levitation.transpose()?;
        let policies = policies_of(file, text)?;
        let mut disturbances = Vec::with_capacity(file.disturbance.len());
        for (i, d) in file.disturbance.iter().enumerate() {
            check.within(&format!("disturbance[{i}].start_s"), d.start_s, 0.0, 1e5)?;
            check.within(
                &format!("disturbance[{i}].duration_s"),
                d.duration_s,
                0.0,
                1e5,
            )?;
            if d.start_s >= file.run.duration_s {
                let key = format!("disturbance[{i}].start_s");
                let end = file.run.duration_s;
                let message = format!("is {}, not before the end of the run at {end}", d.start_s);
                let help = Some("start it earlier, or lengthen run.duration_s".to_owned());
                return Err(text.error_at_key(&key, message, help));
            }
            for force in d.force_n.0 {
                check.within(&format!("disturbance[{i}].force_n"), force, -1e9, 1e9)?;
            }
            disturbances.push(Disturbance {
                start_s: d.start_s,
                duration_s: d.duration_s,
                force_n: d.force_n.0.into(),
            });
        }
        let supervised = policies.contains(&PolicyKind::Supervisor);
        let supervisor = supervised
            .then(|| supervisor_setup::config(&plant, file, text))
            .transpose()?;
        let gravity: V2 = file.rotor.gravity_m_s2.0.into();
        Ok(Self {
            title: file.title.clone(),
            story: file.story.trim().to_owned(),
            whirl_speed_m_s: whirl_speed_of(file, &plant, &check)?,
            weight_n: plant.rotor.mass_kg * gravity,
            plant,
            start,
            disturbances,
            duration_s: file.run.duration_s,
            sample_rate_hz: file.run.sample_rate_hz,
            rtol: file.run.rtol,
            method: match file.run.method {
                MethodFile::Auto => Method::Auto,
                MethodFile::Series => Method::Series,
                MethodFile::Explicit => Method::Explicit,
                MethodFile::Stiff => Method::Stiff,
            },
            seed: file.run.seed,
            policies,
            sensor: SensorParams {
                quantum_m: file.sensor.quantum_m,
                noise_rms_m: file.sensor.noise_rms_m,
            },
            levitation,
            radial_band: file.radial.band,
            warnings: warnings_of(file, text, supervised),
            supervisor,
        })
    }
}

fn levitation_of(l: &LevitationFile, check: &Checks<'_>) -> Result<LevitationParams, SceneError> {
    check.within("levitation.proportional_n_m", l.proportional_n_m, 0.0, 1e12)?;
    check.within("levitation.integral_n_m_s", l.integral_n_m_s, 0.0, 1e15)?;
    check.within("levitation.derivative_n_s_m", l.derivative_n_s_m, 0.0, 1e9)?;
    check.within(
        "levitation.derivative_filter_s",
        l.derivative_filter_s,
        0.0,
        1.0,
    )?;
    Ok(LevitationParams {
        proportional_n_m: l.proportional_n_m,
        integral_n_m_s: l.integral_n_m_s,
        derivative_n_s_m: l.derivative_n_s_m,
        derivative_filter_s: l.derivative_filter_s,
    })
}

/// Control rates that the supervisor is made for \[Hz\].
const SUPERVISED_RATES_HZ: std::ops::RangeInclusive<f64> = 1e4..=5e4;

fn warnings_of(file: &SceneFile, text: &SceneText, supervised: bool) -> Vec<String> {
    let (key, rate) = ("run.sample_rate_hz", file.run.sample_rate_hz);
    let mut warnings = Vec::new();
    if supervised && !SUPERVISED_RATES_HZ.contains(&rate) {
        let message = format!("is {rate}; the supervisor is made for 10 to 50 kHz");
        warnings.push(text.error_at_key(key, message, None).to_string());
    }
    warnings
}

fn policies_of(file: &SceneFile, text: &SceneText) -> Result<Vec<PolicyKind>, SceneError> {
    let key = "run.policies";
    let names = PolicyKind::ALL.map(PolicyKind::name).join(", ");
    let mut policies = Vec::new();
    for name in &file.run.policies {
        let kind = PolicyKind::from_name(name).ok_or_else(|| {
            let message = format!("there is no policy \"{name}\"");
            let known = PolicyKind::ALL.map(PolicyKind::name);
            let help = with_guess(format!("policies are {names}"), name, known);
            text.error_at_key(key, message, Some(help))
        })?;
        if policies.contains(&kind) {
            let help = Some("name each policy once".to_owned());
            return Err(text.error_at_key(key, format!("\"{name}\" is named twice"), help));
        }
        if kind != PolicyKind::Passive && file.magnet.is_none() {
            let help = Some("add a [magnet], or run only \"passive\"".to_owned());
            return Err(text.error_at_key(key, format!("\"{name}\" needs a magnet"), help));
        }
        if kind.levitates() && file.levitation.is_none() {
            let help = Some("add [levitation] with its gains".to_owned());
            return Err(text.error_at_key(
                key,
                format!("\"{name}\" needs a levitation controller"),
                help,
            ));
        }
        policies.push(kind);
    }
    if policies.is_empty() {
        let help = Some(format!("name at least one of {names}"));
        return Err(text.error_at_key(key, "is empty".to_owned(), help));
    }
    Ok(policies)
}

/// The scene's own limit; else 3·ω0·c with a shaft, and three times the speed at which the magnet can
/// still lift the rotor off without one.
fn whirl_speed_of(
    file: &SceneFile,
    plant: &PlantParams,
    check: &Checks<'_>,
) -> Result<f64, SceneError> {
    const KEY: &str = "verdict.whirl_speed_m_s";
    if let Some(speed) = file.verdict.whirl_speed_m_s {
        check.within(KEY, speed, 1e-9, 1e6)?;
        return Ok(speed);
    }
    if let Some(natural) = plant.natural_frequency_rad_s() {
        return Ok(3.0 * natural * plant.contact.clearance_m);
    }
    let force = plant.magnet.map_or(0.0, |m| m.force_max_n);
    let speed = 3.0 * lift_off_speed_m_s(plant, force);
    if speed > 0.0 {
        return Ok(speed);
    }
    let message = "is missing: without shaft stiffness and magnet it has no default".to_owned();
    let help = Some("say which backward contact speed counts as whirl".to_owned());
    Err(check.text.error_at_key(KEY, message, help))
}
