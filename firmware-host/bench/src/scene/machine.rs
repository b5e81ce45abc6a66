//! A scene of a whole rotor: what a scene of one plane says, for each of its planes, and the rotor that they share.

mod bearing;
mod poles;
mod refused;
pub mod role;
mod start;
mod supervised;

use self::poles::poles;
use self::refused::refused;
use self::start::start;
use crate::device::levitation::LevitationParams;
use crate::device::loads::Disturbance;
use crate::device::modal_levitation::{ModalLevitationParams, Station, TiltParams, Weights};
use crate::device::whole_levitation::WholeLevitationParams;
use crate::scene::Scene;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::lint::slips;
use crate::scene::own_controller::own_controller;
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::resolve::OfMachine;
use crate::scene::rotor::{self, Origin};
use crate::scene::spec::Spec;
use crate::scene::tables::{PlaneTable, SceneTables, TiltTable};
use plant_model::V2;
use plant_model::machine::params::{
    MachineChange, MachineMagnet, MachineParams, MachinePlane, MachineStart, Rotor, Support,
};
use std::path::Path;
use supervisor::Shaft;

/// A plane of a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneScene {
    /// Its name.
    pub name: String,
    /// The plane alone: its instruments and controllers, its wall, and as rotor a point mass that moves as an impact there
    /// moves the machine's. That is what its controllers are designed for; what runs is the machine.
    pub scene: Scene,
    /// Which magnet of the machine is its own.
    pub magnet: Option<usize>,
    /// Whether it is a seal or a bushing: no controller knows of it.
    pub seal: bool,
}

/// A plane's name as it stands in names of files.
pub fn in_file_names(name: &str) -> String {
    let plain = |c: char| match c.is_alphanumeric() {
        true => c,
        false => '_',
    };
    name.to_lowercase().chars().map(plain).collect()
}

/// A scene of a whole rotor that can be run: every value checked.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineScene {
    /// The machine; sensor i is the probe of plane i, and every load has a place of its own.
    pub machine: MachineParams,
    /// Where it starts, as seen from the line of the magnets.
    pub start: MachineStart,
    /// Its planes.
    pub planes: Vec<PlaneScene>,
    /// Loads, in the order of the machine's places for them.
    pub loads: Vec<Disturbance>,
    /// The levitation controller, where one holds the whole rotor; else each plane has its own.
    pub levitation: Option<WholeLevitationParams>,
    /// Eccentricity of the centre of mass at the start, which is among the machine's unbalances \[m\].
    pub eccentricity_m: f64,
    /// The rotor as its supervisor is told it, where that is another than it is.
    pub told: Option<Shaft>,
    /// What is allowed and yet unlikely to be meant, with file and line.
    pub warnings: Vec<String>,
}

/// A scene file that can be run.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyScene {
    /// A point mass in one plane.
    Plane(Box<Scene>),
    /// A whole rotor.
    Machine(Box<MachineScene>),
}

impl AnyScene {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::resolve(&Spec::load(path)?)
    }

    /// A scene from the text of a file; errors name it `name`.
    ///
    /// # Errors
    /// [`SceneError`] with line and key.
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        Self::resolve(&Spec::parse(name, text)?)
    }

    /// The scene that keys and values make, every value checked.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key.
    pub fn resolve(spec: &Spec) -> Result<Self, SceneError> {
        Ok(match spec.has_planes() {
            true => Self::Machine(Box::new(spec.resolve_machine()?)),
            false => Self::Plane(Box::new(spec.resolve()?)),
        })
    }

    /// What holds for all planes: time, accuracy, policies, title.
    pub fn common(&self) -> &Scene {
        match self {
            Self::Plane(scene) => scene,
            Self::Machine(scene) => scene.common(),
        }
    }

    /// What it warns of.
    pub fn warnings(&self) -> &[String] {
        match self {
            Self::Plane(scene) => &scene.warnings,
            Self::Machine(scene) => &scene.warnings,
        }
    }
}

impl MachineScene {
    /// A scene from the text of a file; errors name it `name`.
    ///
    /// # Errors
    /// [`SceneError`] with line and key, also of a scene that has one plane.
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        Spec::parse(name, text)?.resolve_machine()
    }

    /// What holds for the machine as a whole: time, accuracy, policies, title.
    pub fn common(&self) -> &Scene {
        // There is one plane at least: the machine has been checked.
        &self.planes[0].scene
    }

    /// Times at which something sets in or ends in any plane \[s\], in order.
    pub fn edges(&self) -> Vec<f64> {
        let mut edges: Vec<f64> = self.planes.iter().flat_map(|p| p.scene.edges()).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        edges
    }
}

impl Spec {
    /// The scene of a whole rotor, every value checked.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key.
    pub fn resolve_machine(&self) -> Result<MachineScene, SceneError> {
        let planes = self.planes()?;
        let resolved = self.machine_of(&planes);
        let doubts = planes.first().map(slips).unwrap_or_default();
        resolved.map_err(|error| error.beside(&doubts))
    }

    fn machine_of(&self, planes: &[PlaneSpec]) -> Result<MachineScene, SceneError> {
        let (tables, text) = (&self.tables, &self.text);
        self.check_ranges()?;
        check_together(tables, text)?;
        let (mut machine, origin) = rotor::machine(tables, text)?;
        for (plane, written) in planes.iter().zip(&tables.plane) {
            let place = |own: Option<f64>| origin.centred_m(own.unwrap_or(written.position_m));
            machine.probes_m.push(place(plane.tables.sensor.position_m));
            if let Some(magnet) = &plane.tables.magnet {
                let position_m = place(magnet.position_m);
                machine.magnets.push(MachineMagnet {
                    position_m,
                    force_max_n: magnet.force_max_n,
                    lag_s: magnet.lag_s,
                    lag_damping_ratio: magnet.lag_damping_ratio,
                    poles: poles(magnet, &plane.text)?,
                });
                if magnet.negative_stiffness_n_m > 0.0 {
                    machine.supports.push(Support {
                        position_m,
                        stiffness_n_m: V2::repeat(-magnet.negative_stiffness_n_m),
                        ..Support::default()
                    });
                }
            }
        }
        // What the firmware has to do with.
        let known: Vec<PlaneSpec> = planes.iter().filter(|p| !p.seal).cloned().collect();
        let levitation = match own_controller(tables, text, &known)? {
            Some(own) => Some(own),
            None => modal_levitation(planes, &machine, text)?.map(WholeLevitationParams::Modal),
        };
        // What controllers are designed for.
        let linear = machine.linear_magnets();
        let weights = Weights::new(&positions(&machine.magnets));
        let mut magnet = 0;
        let mut scenes = Vec::new();
        for (index, (plane, written)) in planes.iter().zip(&tables.plane).enumerate() {
            let own = plane.tables.magnet.is_some().then_some(magnet);
            let rigid = machine.rotor.rigid();
            let position_m = origin.centred_m(written.position_m);
            let lever = |place_m: f64| rigid.lever(place_m, position_m);
            let of = OfMachine {
                point: linear.point_mass(position_m),
                carried_kg: own.map_or(0.0, |m| weights.translation[m] * rigid.mass_kg),
                residual_m_n: origin.residual_m_n(written.position_m),
                retainer_plane_ratio: 1.0 / lever(machine.probes_m[index]),
                magnet_plane_ratio: own.map_or(1.0, |m| lever(machine.magnets[m].position_m)),
                others_n: match own {
                    Some(_) => 0.0,
                    None => (machine.magnets.iter())
                        .map(|m| (lever(m.position_m) * m.force_max_n).abs())
                        .sum(),
                },
                // What a plane's loop is worth where other magnets pull too no plane can say.
                levitated_alone: levitation.is_none() && machine.magnets.len() < 2,
            };
            let mut scene = plane.resolve(Some(&of))?;
            for change in &mut scene.changes {
                change.unbalance = change.unbalance.map(|u| origin.centred(u));
            }
            // Noise of its own, and that of the file for the first.
            scene.seed =
                (scene.seed).wrapping_add(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(index as u64));
            machine.planes.push(MachinePlane {
                position_m,
                centre_m: scene.centre_offset_m,
                radius_m: plane.contact_radius_m,
                contact: scene.plant.contact,
                friction: scene.plant.friction,
                stator: scene.plant.stator,
                race: scene.plant.race,
                load_drag: bearing::load_drag(&plane.tables),
                heat: bearing::heat(&plane.tables),
            });
            magnet += usize::from(own.is_some());
            scenes.push(PlaneScene {
                name: written.name.clone(),
                scene,
                magnet: own,
                seal: plane.seal,
            });
        }
        let loads = self.loads(&scenes, &mut machine, &origin);
        let start = start(tables, text, &machine)?;
        (machine.validate())
            .and_then(|()| machine.method(tables.run.method.into()).map(drop))
            .and_then(|()| start.validate())
            .map_err(|error| refused(&error, self, &scenes))?;
        self.check_places_of_changes(&machine.rotor, &origin)?;
        let mut warnings: Vec<String> = Vec::new();
        for warning in scenes.iter().flat_map(|plane| &plane.scene.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        let mut scene = MachineScene {
            machine,
            start,
            planes: scenes,
            loads,
            levitation,
            eccentricity_m: tables.rotor.eccentricity_m,
            told: None,
            warnings,
        };
        scene.decide(text);
        match scene.refused_by_supervisor() {
            Some((plane, error)) => {
                let message = format!("leaves no supervisor for the rotor: {error}");
                let help = Some("or run without the policy supervisor".to_owned());
                let key = format!("plane[{plane}].position_m");
                Err(text.error_at_key(&key, message, help))
            }
            None => Ok(scene),
        }
    }

    /// Unbalances that come later have to be on the rotor as well.
    fn check_places_of_changes(&self, rotor: &Rotor, origin: &Origin) -> Result<(), SceneError> {
        for (i, change) in self.tables.change.iter().enumerate() {
            let change = MachineChange {
                unbalance: (change.unbalance.as_ref()).map(|u| origin.centred(u.into())),
                ..MachineChange::default()
            };
            change.validate(rotor).map_err(|error| {
                let key = format!("change[{i}].{}", error.field);
                self.text.refused(&key, error.value, error.expected)
            })?;
        }
        Ok(())
    }

    /// Loads and where they act; those of base motions at the centre of mass, which bending modes do not feel.
    fn loads(
        &self,
        planes: &[PlaneScene],
        machine: &mut MachineParams,
        origin: &Origin,
    ) -> Vec<Disturbance> {
        let Some(PlaneScene { scene, .. }) = planes.first() else {
            return Vec::new();
        };
        let mass_kg = machine.rotor.rigid().mass_kg;
        let inertial = scene.base_motions.iter().map(|b| b.on_mass(mass_kg));
        let places = self
            .tables
            .disturbance
            .iter()
            .map(|d| d.position_m.map_or(0.0, |z| origin.centred_m(z)));
        machine.loads_m = places
            .chain(scene.base_motions.iter().map(|_| 0.0))
            .collect();
        scene.disturbances.iter().copied().chain(inertial).collect()
    }
}

fn positions(magnets: &[MachineMagnet]) -> Vec<f64> {
    magnets.iter().map(|m| m.position_m).collect()
}

/// What a machine does not have, and names that are needed to tell its planes apart.
fn check_together(tables: &SceneTables, text: &SceneText) -> Result<(), SceneError> {
    let error = |key: &str, message: &str, help: &str| {
        Err(text.error_at_key(key, message.to_owned(), Some(help.to_owned())))
    };
    for (i, plane) in tables.plane.iter().enumerate() {
        let key = format!("plane[{i}].name");
        if plane.name.trim().is_empty() || plane.name.chars().any(char::is_control) {
            let message = "expected a name in one line, without control characters";
            return error(&key, message, "as \"coupling end\"");
        }
        let alike = |other: &PlaneTable| in_file_names(&other.name) == in_file_names(&plane.name);
        if let Some(j) = tables.plane[..i].iter().position(alike) {
            let message = format!("is that of plane[{j}], or makes the same name of a file");
            return error(&key, &message, "give each plane a name of its own");
        }
        let own = plane.levitation.as_ref();
        if own.is_some_and(|l| l.tilt.is_some()) {
            let key = format!("plane[{i}].levitation.tilt");
            let message = "is of the whole rotor, and not of one plane";
            return error(&key, message, "give it as [levitation.tilt]");
        }
        if plane.seal {
            let key = |table: &str| format!("plane[{i}].{table}");
            let of_a_bearing = [
                (key("magnet"), plane.magnet.is_some()),
                (key("sensor"), plane.sensor.is_some()),
                (key("levitation"), plane.levitation.is_some()),
                (key("biquads"), plane.biquads.is_some()),
                (key("supervisor"), plane.supervisor.is_some()),
                (key("outage"), !plane.outage.is_empty()),
                (key("fault"), !plane.fault.is_empty()),
                (key("start_position_m"), plane.start_position_m.is_some()),
                (
                    key("start_velocity_m_s"),
                    plane.start_velocity_m_s.is_some(),
                ),
            ];
            let given = of_a_bearing
                .each_ref()
                .map(|(key, given)| (key.as_str(), *given));
            let message = "is of a bearing, and this plane is a seal";
            text.none_given(&given, message, "remove it, or seal = true")?;
        }
        let gains_or_filters = [
            ("levitation", own.is_some()),
            ("biquads", plane.biquads.is_some()),
        ];
        for whole in tables.own_of_the_whole() {
            if let Some((key, _)) = gains_or_filters.iter().find(|(_, given)| *given) {
                let key = format!("plane[{i}].{key}");
                let message = format!("does not go with [{whole}], which holds the whole rotor");
                return error(&key, &message, "remove one of them");
            }
        }
        let by_mode = tables.levitation.as_ref().is_some_and(|l| l.tilt.is_some());
        if by_mode && own.is_some() {
            let key = format!("plane[{i}].levitation");
            let message = "does not go with [levitation.tilt], which holds the whole rotor";
            return error(&key, message, "remove one of them");
        }
    }
    Ok(())
}

/// The controller of the whole rotor, where the scene has one.
fn modal_levitation(
    planes: &[PlaneSpec],
    machine: &MachineParams,
    text: &SceneText,
) -> Result<Option<ModalLevitationParams>, SceneError> {
    let with_sensor = || (planes.iter().zip(&machine.probes_m)).filter(|(plane, _)| !plane.seal);
    let Some((levitation, tilt)) = (with_sensor().next())
        .and_then(|(plane, _)| plane.tables.levitation.as_ref())
        .and_then(|l| Some((l, l.tilt.as_ref()?)))
    else {
        return Ok(None);
    };
    let apart = |places: &[f64]| places.iter().any(|z| *z != places[0]);
    let sensors_m: Vec<f64> = with_sensor().map(|(_, sensor_m)| *sensor_m).collect();
    let magnets_m = positions(&machine.magnets);
    for (places, what) in [(&sensors_m, "sensors"), (&magnets_m, "magnets")] {
        if places.len() < 2 || !apart(places) {
            let message = format!("needs {what} at two places at least to tell and turn a tilt");
            let help = "give planes of different position_m a sensor and a magnet each".to_owned();
            return Err(text.error_at_key("levitation.tilt", message, Some(help)));
        }
    }
    let mut magnets = machine.magnets.iter();
    Ok(Some(ModalLevitationParams {
        translation: LevitationParams::from(levitation),
        tilt: tilt_params(tilt, machine.rotor.rigid().polar_inertia_kg_m2),
        stations: with_sensor()
            .map(|(plane, sensor_m)| Station {
                sensor_m: *sensor_m,
                magnet: (plane.tables.magnet.as_ref())
                    .and_then(|_| magnets.next())
                    .map(|m| (m.position_m, m.force_max_n)),
            })
            .collect(),
    }))
}

fn tilt_params(tilt: &TiltTable, polar_inertia_kg_m2: f64) -> TiltParams {
    TiltParams {
        proportional_n_m_rad: tilt.proportional_n_m_rad,
        integral_n_m_rad_s: tilt.integral_n_m_rad_s,
        derivative_n_m_s_rad: tilt.derivative_n_m_s_rad,
        cross_kg_m2: tilt.cross_feedback * polar_inertia_kg_m2,
    }
}
