//! A scene: a rotor, its bearing planes with their instruments and controllers, what happens to it, and what is asked.

mod arrays;
mod bearing;
mod biquads;
mod course;
mod devices;
pub mod diagnostic;
mod events;
mod external;
pub(crate) mod guess;
pub mod keys;
mod limits;
pub mod linear_loop;
mod lint;
pub mod nominal;
mod own_controller;
mod plane;
mod plane_spec;
mod plant;
mod poles;
pub mod policy_kind;
pub(crate) mod read;
mod refused;
mod resolve;
pub mod role;
mod rotor;
pub mod schema;
pub mod spec;
mod start;
mod state_space;
pub mod suggest;
mod supervised;
pub mod tables;
pub(crate) mod values;

use crate::device::actuator::{AmplifierParams, Outage};
use crate::device::levitation::{LevitationParams, SetDown};
use crate::device::loads::{BaseMotion, Disturbance, TimedChange};
use crate::device::sensor::{SensorParams, SpinSensorParams};
use crate::device::sensor_fault::{Fault, Samples};
use crate::device::whole_levitation::WholeLevitationParams;
use crate::scene::diagnostic::SceneError;
use crate::scene::nominal::{NominalKeys, Override};
use crate::scene::policy_kind::PolicyKind;
use crate::scene::spec::Spec;
use crate::scene::suggest::{Decided, Nominal};
use plant_model::machine::params::{MachineParams, MachineStart, Rotor};
use plant_model::params::{MagnetParams, PlantParams, RotorParams};
use plant_model::{Method, V2};
use std::path::Path;
use supervisor::Shaft;

/// A scene that can be run: every value checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Title, one line.
    pub title: String,
    /// What is shown and why.
    pub story: String,
    /// The machine; sensor i is the probe of plane i. Its places for loads are those of [`Self::loads`].
    pub machine: MachineParams,
    /// Where it starts, as seen from the line of the magnets.
    pub start: MachineStart,
    /// Its planes, one at least.
    pub planes: Vec<PlaneScene>,
    /// Forces that come and go.
    pub disturbances: Vec<Disturbance>,
    /// Motions of the housing; only for rigid stators.
    pub base_motions: Vec<BaseMotion>,
    /// Parameters that change, in order of time.
    pub changes: Vec<TimedChange>,
    /// Whether the samples say that the rotor levitated up to the start.
    pub levitated_before: bool,
    /// End of the run \[s\].
    pub duration_s: f64,
    /// Control rate \[Hz\].
    pub sample_rate_hz: f64,
    /// Whether the supervisor of a rotor ticks one of its planes in a sample, and the other in the next.
    pub planes_in_turn: bool,
    /// Tolerance of a contact step.
    pub rtol: f64,
    /// How contact is integrated.
    pub method: Method,
    /// Policies to run.
    pub policies: Vec<PolicyKind>,
    /// What is known of the spin.
    pub spin_sensor: SpinSensorParams,
    /// The levitation controller, where one holds the whole rotor; else each plane has its own.
    pub levitation: Option<WholeLevitationParams>,
    /// The rotor as its supervisor is configured, where that is another than it is.
    pub configured_shaft: Option<Shaft>,
    /// What is allowed and yet unlikely to be meant, with file and line.
    pub warnings: Vec<String>,
}

/// A plane of a scene: its instruments and controllers, and what is judged there.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneScene {
    /// Its name; that of an only plane may be empty.
    pub name: String,
    /// Whether it is a seal or a bushing: no controller knows of it.
    pub seal: bool,
    /// Which magnet of the machine is its own.
    pub magnet: Option<usize>,
    /// Weight that its magnet carries \[N\].
    pub weight_n: V2,
    /// Force that the firmware adds to whatever a policy asks for: minus the weight, where it is fed forward \[N\]; along the
    /// magnet's axes.
    pub feed_forward_n: V2,
    /// Severity that the retainer bearing may bear in all, where the scene says it.
    pub severity_allowed: Option<f64>,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// The amplifier, beside what the machine has of it.
    pub amplifier: AmplifierParams,
    pub outages: Vec<Outage>,
    /// Set-downs and lift-offs, in order of time.
    pub set_downs: Vec<SetDown>,
    /// The position sensor.
    pub sensor: SensorParams,
    /// Angles of the x axes of sensor and magnet from that of the scene \[rad\].
    pub axes_rad: [f64; 2],
    pub faults: Vec<Fault>,
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
    /// What the rotor decides that it is a plane of, in the place of suggested values.
    pub decided: Vec<Decided>,
    /// What `[supervisor]` puts in the place of suggested values, also without that policy.
    pub overrides: Vec<Override>,
    /// Backward contact speed above which a run is whirl \[m/s\].
    pub whirl_speed_m_s: f64,
}

impl PlaneScene {
    /// What a person reads for it.
    pub fn shown(&self) -> &str {
        match self.name.as_str() {
            "" => "the plane",
            name => name,
        }
    }

    /// Its name as it stands in names of files.
    pub fn name_in_files(&self) -> String {
        in_file_names(&self.name)
    }

    /// Where the levitation controller is to hold the rotor at a time, as seen from the centre of the magnets \[m\].
    pub fn reference_m(&self, t_s: f64) -> V2 {
        (self.set_downs.iter())
            .filter(|s| s.start_s <= t_s)
            .fold(V2::zeros(), |from_m, s| s.reference_m(from_m, t_s))
    }

    /// Whether the supervisor is informed at a time that the rotor is set down.
    pub fn set_down_announced(&self, t_s: f64) -> bool {
        let mut begun = self.set_downs.iter().filter(|s| s.start_s <= t_s);
        begun.next_back().is_some_and(|s| s.announced)
    }
}

/// A plane's name as it stands in names of files.
pub(crate) fn in_file_names(name: &str) -> String {
    let plain = |c: char| match c.is_alphanumeric() {
        true => c,
        false => '_',
    };
    name.to_lowercase().chars().map(plain).collect()
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

    /// A plane alone: its wall, its magnet, and as rotor a point mass that moves as an impact there moves the machine's. That is
    /// what its controllers are designed for; what runs is the machine.
    pub fn plant(&self, plane: usize) -> PlantParams {
        let (wall, own) = (&self.machine.planes[plane], &self.planes[plane]);
        let magnet = own.magnet.map(|magnet| &self.machine.magnets[magnet]);
        let linear = self.machine.linear_magnets();
        let point = linear.point_mass(wall.position_m);
        PlantParams {
            rotor: RotorParams {
                mass_kg: point.mass_kg,
                stiffness_n_m: point.stiffness_n_m,
                damping_n_s_m: point.damping_n_s_m,
                eccentricity_m: self.machine.eccentricity_m,
                contact_radius_m: wall.radius_m,
            },
            spin: self.machine.spin,
            stator: wall.stator,
            contact: wall.contact,
            friction: wall.friction,
            magnet: magnet.map(|m| MagnetParams {
                force_max_n: m.force_max_n,
                // Of second order, its mean delay.
                lag_s: m.lag_s * m.lag_damping_ratio.map_or(1.0, |ratio| 2.0 * ratio),
            }),
            race: wall.race,
        }
    }

    /// Whether the rotor takes a force on its centre of mass: its bending modes have shapes there.
    pub fn takes_push(&self) -> bool {
        self.machine.rotor.reaches(0.0)
    }

    /// Places at which a run has loads, each once: first the centre of mass where that [takes a push](Self::takes_push), also
    /// without a load there, for with a place less the last bits are others.
    pub fn load_places_m(&self) -> Vec<f64> {
        let mut places_m = if self.takes_push() {
            vec![0.0]
        } else {
            Vec::new()
        };
        for load in self.loads() {
            if !places_m.contains(&load.position_m) {
                places_m.push(load.position_m);
            }
        }
        places_m
    }

    /// The machine with a place for each of the [loads](Self::loads).
    pub fn machine_with_loads(&self) -> MachineParams {
        MachineParams {
            loads_m: self.loads().map(|load| load.position_m).collect(),
            ..self.machine.clone()
        }
    }

    /// Clearance of a plane \[m\].
    pub fn clearance_m(&self, plane: usize) -> f64 {
        self.machine.planes[plane].contact.clearance_m
    }

    /// What the magnet of a plane can give \[N\]; 0 without one.
    pub fn force_max_n(&self, plane: usize) -> f64 {
        let magnet = self.planes[plane].magnet;
        magnet.map_or(0.0, |magnet| self.machine.magnets[magnet].force_max_n)
    }

    /// Whether the rotor's axis does more than its only plane shows: it tilts or bends.
    pub fn has_axis(&self) -> bool {
        !matches!(&self.machine.rotor, Rotor::Rigid(rigid) if !rigid.tilts())
    }

    /// Times at which something sets in or ends \[s\], in order.
    pub fn edges(&self) -> Vec<f64> {
        let loads = self.loads().flat_map(|d| [d.start_s, d.end_s()]);
        let outages = self.planes.iter().flat_map(|plane| &plane.outages);
        let outages = outages.flat_map(|o| [o.start_s, o.end_s()]);
        let changes = self.changes.iter().map(|c| c.at_s);
        let mut edges: Vec<f64> = loads.chain(outages).chain(changes).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        edges
    }

    /// When the last thing that happens to the rotor is over \[s\], as a plane sees it: the end of the last load, and of
    /// outages and faults there that end within the run (others count from their start), or the last change. What no sample
    /// sees of the sensor, and a change after the last sample's period, has not happened.
    pub fn clock_starts_s(&self, plane: usize) -> f64 {
        let within = |start_s: f64, end_s: f64| match end_s < self.duration_s {
            true => end_s,
            false => start_s,
        };
        let (samples, own) = (self.samples(), &self.planes[plane]);
        let faults = own.faults.iter().filter(|f| f.is_seen(samples));
        let changes = (self.changes.iter()).filter(|c| c.at_s < samples.end_s());
        (self.loads().map(|d| d.end_s()))
            .chain(own.outages.iter().map(|o| within(o.start_s, o.end_s())))
            .chain(faults.map(|f| within(f.start_s, f.end_s())))
            .chain(changes.map(|c| c.at_s))
            .chain(own.set_downs.iter().map(|s| within(s.start_s, s.end_s())))
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

    /// Disturbances, and base motions as the forces that the rotor feels at its centre of mass; its bending modes do not feel
    /// them.
    pub fn loads(&self) -> impl Iterator<Item = Disturbance> {
        let mass_kg = self.machine.rotor.rigid().mass_kg;
        let inertial = self.base_motions.iter().map(move |b| b.on_mass(mass_kg));
        self.disturbances.iter().cloned().chain(inertial)
    }
}
