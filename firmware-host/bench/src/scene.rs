//! A scene: the plant, its instruments and controllers, what happens to it, and what is asked.

mod devices;
pub mod diagnostic;
mod event_file;
mod events;
pub mod file;
mod limits;
mod lint;
pub mod nominal;
mod plant;
pub mod policy_kind;
mod required_keys;
pub mod suggest;
mod values;

use crate::device::levitation::LevitationParams;
use crate::device::loads;
use crate::device::sensor::{SensorParams, SpinSensorParams};
use crate::device::sensor_fault::Samples;
use crate::scene::devices::{
    amplifier_of, centre_offset_of, levitation_of, sensor_of, spin_sensor_of,
};
use crate::scene::diagnostic::{Checks, SceneError, SceneText, with_guess};
use crate::scene::events::events_of;
use crate::scene::file::{MethodFile, SceneFile};
use crate::scene::limits::{damping_of, whirl_speed_of};
use crate::scene::lint::{slips_of, unseen_of, warnings_of};
use crate::scene::plant::plant_of;
use crate::scene::policy_kind::PolicyKind;
use crate::scene::suggest::Nominal;
use plant_model::params::{PlantParams, Start};
use plant_model::{BuildError, Method, Options, Plant, V2, build, build_for_changes};
use std::f64::consts::TAU;
use std::path::Path;

pub use crate::device::actuator::{AmplifierParams, Delivers, Outage};
pub use crate::device::axis::Axis;
pub use crate::device::loads::{BaseMotion, Disturbance, Shape, TimedChange};
pub use crate::device::sensor_fault::{Fault, FaultKind};
pub use crate::scene::nominal::{NominalKeys, Override};

/// Rows of traces that a run may keep, of all its policies: some 0.3 KB each.
const MOST_ROWS: f64 = 1e7;

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
    /// Force that the firmware adds to whatever a policy asks for: minus the weight, where it is fed forward \[N\].
    pub feed_forward_n: V2,
    /// Forces that come and go.
    pub disturbances: Vec<Disturbance>,
    /// Motions of the housing; only for a rigid stator.
    pub base_motions: Vec<BaseMotion>,
    /// Parameters that change, in order of time.
    pub changes: Vec<TimedChange>,
    /// The centre of the retainer bearing as seen from the centre of magnets and sensors \[m\]. The plant
    /// keeps the retainer bearing at its origin, so a levitated rotor stands at minus this.
    pub centre_offset_m: V2,
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
    /// The amplifier, beside what the plant has of it.
    pub amplifier: AmplifierParams,
    /// Its outages.
    pub outages: Vec<Outage>,
    /// The position sensor.
    pub sensor: SensorParams,
    /// Its faults.
    pub faults: Vec<Fault>,
    /// What is known of the spin.
    pub spin_sensor: SpinSensorParams,
    /// The levitation controller; needed by the policies that use one.
    pub levitation: Option<LevitationParams>,
    /// `radial` pushes beyond this share of the clearance.
    pub radial_band: f64,
    /// `damping` sets so much force against speed \[N s/m\].
    pub damping_n_s_m: f64,
    /// Configuration of the supervisor; needed by the policy of that name.
    pub supervisor: Option<supervisor::Config>,
    /// What it is suggested from.
    pub nominal: Nominal,
    /// The keys that it comes from.
    pub nominal_keys: NominalKeys,
    /// What `[supervisor]` puts in the place of suggested values, also without that policy.
    pub overrides: Vec<Override>,
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

    /// A scene's plant at its start, with what its changes need.
    ///
    /// # Errors
    /// [`BuildError`] for the first value out of range.
    pub fn build(&self, options: Options) -> Result<Box<dyn Plant>, BuildError> {
        let unbalances = (self.changes.iter()).any(|c| c.change.eccentricity_m.is_some());
        let build = if unbalances { build_for_changes } else { build };
        build(&self.plant, &self.start, options)
    }

    /// Position as seen from the centre of magnets and sensors \[m\].
    pub fn from_magnets_m(&self, position_m: V2) -> V2 {
        position_m + self.centre_offset_m
    }

    /// Mean external force on the rotor from one time to another, between which there is no
    /// [edge](Self::edges) \[N\]: weight, loads, and what shaft and magnets do about their own centre more
    /// than about that of the plant.
    pub fn external_n(&self, from_s: f64, to_s: f64) -> V2 {
        let constant_n = self.weight_n - self.plant.rotor.stiffness_n_m * self.centre_offset_m;
        loads::mean_n(self.loads(), constant_n, (from_s, to_s))
    }

    /// Whether a load that acts from a time on varies.
    pub fn varies(&self, from_s: f64) -> bool {
        let acting = |d: &Disturbance| d.start_s <= from_s && from_s < d.end_s();
        (self.loads()).any(|d| acting(&d) && d.shape != Shape::Constant)
    }

    /// Parts in which [`Self::external_n`] is to be held from one time to another.
    pub fn parts(&self, from_s: f64, to_s: f64) -> u32 {
        loads::parts(self.loads(), (from_s, to_s))
    }

    /// Times at which something sets in or ends \[s\], in order.
    pub fn edges(&self) -> Vec<f64> {
        let loads = self.loads().flat_map(|d| [d.start_s, d.end_s()]);
        let outages = (self.outages.iter()).flat_map(|o| [o.start_s, o.end_s()]);
        let changes = self.changes.iter().map(|c| c.at_s);
        let mut edges: Vec<f64> = loads.chain(outages).chain(changes).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        edges
    }

    /// When the last thing that happens to the rotor is over \[s\]: the end of the last load, and of
    /// outages and faults that end within the run (others count from their start), or the last change. What no sample
    /// sees of the sensor, and a change after the last sample's period, has not happened.
    pub fn clock_starts_s(&self) -> f64 {
        let within = |start_s: f64, end_s: f64| match end_s < self.duration_s {
            true => end_s,
            false => start_s,
        };
        let samples = self.samples();
        let faults = self.faults.iter().filter(|f| f.is_seen(samples));
        let changes = (self.changes.iter()).filter(|c| c.at_s < samples.end_s());
        (self.loads().map(|d| d.end_s()))
            .chain(self.outages.iter().map(|o| within(o.start_s, o.end_s())))
            .chain(faults.map(|f| within(f.start_s, f.end_s())))
            .chain(changes.map(|c| c.at_s))
            .fold(0.0, f64::max)
    }

    /// Control samples of a run.
    pub(crate) fn samples(&self) -> Samples {
        Samples::new(self.duration_s, self.sample_rate_hz)
    }

    /// Time that a run to the end takes in the model: whole samples \[s\].
    pub fn simulated_s(&self) -> f64 {
        self.samples().count() as f64 / self.sample_rate_hz
    }

    /// Disturbances, and base motions as the forces that the rotor feels.
    pub fn loads(&self) -> impl Iterator<Item = Disturbance> {
        let mass_kg = self.plant.rotor.mass_kg;
        let inertial = self.base_motions.iter().map(move |b| b.on_mass(mass_kg));
        self.disturbances.iter().copied().chain(inertial)
    }

    /// As [`Scene::parse`], with the file's values edited before they are checked.
    pub fn parse_with(
        name: &str,
        text: &str,
        edit: &dyn Fn(&mut SceneFile),
    ) -> Result<Self, SceneError> {
        let text = SceneText {
            path: name.into(),
            text: text.to_owned(),
        };
        let mut file = keys_of(&text)?;
        edit(&mut file);
        Self::from_file(&file, &text)
    }

    fn from_text(text: &SceneText) -> Result<Self, SceneError> {
        let file = keys_of(text)?;
        Self::from_file(&file, text).map_err(|error| error.beside(&slips_of(&file, text)))
    }

    fn from_file(file: &SceneFile, text: &SceneText) -> Result<Self, SceneError> {
        let plant = plant_of(file, text)?;
        let mut start = Start {
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
        if matches!(file.run.method, MethodFile::Series) && !plant.has_series() {
            let with = match plant.contact.law.linear() {
                None => "contact.stiffness_n_mn",
                Some(_) => "retainer.ellipticity",
            };
            let message = format!("series does not go with {with}");
            let help =
                "take auto, explicit or stiff: this contact has no power series at the touch";
            return Err(text.error_at_key("run.method", message, Some(help.to_owned())));
        }
        let ticks = file.run.duration_s * file.run.sample_rate_hz;
        let rows = ticks * file.run.policies.len() as f64;
        if rows > MOST_ROWS {
            let help = "shorten run.duration_s, lower run.sample_rate_hz or run fewer policies";
            let help = help.to_owned();
            let message = format!(
                "{ticks:e} control samples for each of {} policies: expected at most 10 million in all",
                file.run.policies.len()
            );
            return Err(text.error_at_key("run.duration_s", message, Some(help)));
        }
        // A terminal takes other control characters for orders.
        if file.title.trim().is_empty() || file.title.chars().any(char::is_control) {
            let help = Some("what the scene is for goes into story".to_owned());
            let message = "expected a name in one line, without control characters".to_owned();
            return Err(text.error_at_key("title", message, help));
        }
        let sensor = sensor_of(file, &check)?;
        let amplifier = amplifier_of(file, &check)?;
        check.within("radial.band", file.radial.band, 0.0, 1.0)?;
        for axis in file.rotor.gravity_m_s2.0 {
            check.within("rotor.gravity_m_s2", axis, -1e4, 1e4)?;
        }
        let levitation = file.levitation.as_ref().map(|l| levitation_of(l, &check));
        let levitation = levitation.transpose()?;
        let policies = policies_of(file, text)?;
        let events = events_of(file, &check)?;
        let centre_offset_m = centre_offset_of(file, &check)?;
        start.position_m -= centre_offset_m;
        let whirl_speed_m_s = whirl_speed_of(file, &plant, &check)?;
        let damps = policies.contains(&PolicyKind::Damping);
        let damping_n_s_m = damping_of(file, &plant, &check, damps)?;
        let nominal = nominal::nominal_of(&plant, file);
        let nominal_keys = NominalKeys::new(&nominal, file);
        let supervised = policies.contains(&PolicyKind::Supervisor);
        let overrides = nominal::overrides(file, text)?;
        let supervisor = supervised
            .then(|| nominal::config((&nominal, &nominal_keys), &overrides, text))
            .transpose()?;
        let mut warnings = warnings_of(
            file,
            text,
            (&plant, &nominal),
            (&overrides, supervisor.as_ref()),
        );
        warnings.extend(unseen_of(file, text));
        let gravity: V2 = file.rotor.gravity_m_s2.0.into();
        Ok(Self {
            title: file.title.clone(),
            story: file.story.trim().to_owned(),
            whirl_speed_m_s,
            feed_forward_n: match &file.levitation {
                Some(l) if l.feed_forward_weight => -plant.rotor.mass_kg * gravity,
                _ => V2::zeros(),
            },
            weight_n: plant.rotor.mass_kg * gravity,
            plant,
            start,
            disturbances: events.disturbances,
            base_motions: events.base_motions,
            changes: events.changes,
            centre_offset_m,
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
            amplifier,
            outages: events.outages,
            sensor,
            faults: events.faults,
            spin_sensor: spin_sensor_of(file, &check)?,
            levitation,
            radial_band: file.radial.band,
            damping_n_s_m,
            warnings,
            supervisor,
            nominal,
            nominal_keys,
            overrides,
        })
    }
}

/// The keys of a file, not yet checked against each other.
fn keys_of(text: &SceneText) -> Result<SceneFile, SceneError> {
    toml::from_str(&text.text)
        .map_err(|error| text.error_in_toml(error.span().unwrap_or(0..0), error.message()))
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
