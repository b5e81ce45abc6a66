//! A scene: the plant, its instruments and controllers, what happens to it, and what is asked.

mod arrays;
mod biquads;
mod devices;
pub mod diagnostic;
mod events;
mod external;
pub(crate) mod guess;
pub mod keys;
mod limits;
mod lint;
pub mod machine;
pub mod nominal;
mod own_controller;
mod plane_spec;
mod plant;
pub mod policy_kind;
mod resolve;
mod rotor;
pub mod schema;
pub mod spec;
mod state_space;
pub mod suggest;
pub mod tables;
pub(crate) mod values;

use crate::device::actuator::{AmplifierParams, Outage};
use crate::device::levitation::{LevitationParams, SetDown};
use crate::device::loads::{BaseMotion, Disturbance, Loads, TimedChange};
use crate::device::sensor::{SensorParams, SpinSensorParams};
use crate::device::sensor_fault::{Fault, Samples};
use crate::device::whole_levitation::WholeLevitationParams;
use crate::scene::diagnostic::SceneError;
use crate::scene::nominal::{NominalKeys, Override};
use crate::scene::policy_kind::PolicyKind;
use crate::scene::spec::Spec;
use crate::scene::suggest::{Decided, Nominal};
use plant_model::params::{PlantParams, Start};
use plant_model::{BuildError, Method, Options, Plant, V2, build};
use std::path::Path;

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
    /// Set-downs and lift-offs, in order of time.
    pub set_downs: Vec<SetDown>,
    /// Whether the samples say that the rotor levitated up to the start.
    pub levitated_before: bool,
    /// The centre of the retainer bearing as seen from the centre of magnets and sensors \[m\]. The plant
    /// keeps the retainer bearing at its origin, so a levitated rotor stands at minus this.
    pub centre_offset_m: V2,
    /// Severity that the retainer bearing may bear in all, where the scene says it.
    pub severity_allowed: Option<f64>,
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
    /// The controller of the user's in its place.
    pub controller: Option<WholeLevitationParams>,
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
    /// What the rotor decides that it is a plane of, in the place of suggested values.
    pub decided: Vec<Decided>,
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
        Spec::load(path)?.resolve()
    }

    /// A scene from the text of a file; errors name it `name`.
    ///
    /// # Errors
    /// [`SceneError`] with line and key.
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        Spec::parse(name, text)?.resolve()
    }

    /// A scene's plant at its start.
    ///
    /// # Errors
    /// [`BuildError`] for the first value out of range.
    pub fn build(&self, options: Options) -> Result<Plant, BuildError> {
        build(&self.plant, &self.start, options)
    }

    /// Position as seen from the centre of magnets and sensors \[m\].
    pub fn from_magnets_m(&self, position_m: V2) -> V2 {
        position_m + self.centre_offset_m
    }

    /// External force on the rotor: weight, loads, and what shaft and magnets do about their own centre more than about that
    /// of the plant. Between two [edges](Self::edges) nothing begins or ends.
    pub fn external(&self) -> Loads {
        Loads::new(self.constant_n(), self.loads().collect())
    }

    /// What of it never changes \[N\].
    pub fn constant_n(&self) -> V2 {
        self.weight_n - self.plant.rotor.stiffness_n_m * self.centre_offset_m
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
            .chain(self.set_downs.iter().map(|s| within(s.start_s, s.end_s())))
            .fold(0.0, f64::max)
    }

    /// Where the levitation controller is to hold the rotor at a time, as seen from the centre of the magnets \[m\].
    pub fn reference_m(&self, t_s: f64) -> V2 {
        (self.set_downs.iter())
            .filter(|s| s.start_s <= t_s)
            .fold(V2::zeros(), |from_m, s| s.reference_m(from_m, t_s))
    }

    /// Whether the supervisor is told at a time that the rotor is set down.
    pub fn set_down_announced(&self, t_s: f64) -> bool {
        let mut begun = self.set_downs.iter().filter(|s| s.start_s <= t_s);
        begun.next_back().is_some_and(|s| s.announced)
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
}
