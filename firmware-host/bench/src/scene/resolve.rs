//! From what the user wrote to a scene that can be run.

use crate::device::levitation::LevitationParams;
use crate::device::loads::Disturbance;
use crate::device::modal_levitation::{ModalLevitationParams, Station, TiltParams, Weights};
use crate::device::sensor::SpinSensorParams;
use crate::device::whole_levitation::WholeLevitationParams;
use crate::scene::bearing;
use crate::scene::devices::centre_offset_m;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::lint::{of_the_loop, slips};
use crate::scene::own_controller::own_controller;
use crate::scene::plane::RotorContext;
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::poles::poles;
use crate::scene::refused::refused;
use crate::scene::rotor::{self, Origin};
use crate::scene::spec::Spec;
use crate::scene::start::start;
use crate::scene::tables::{PlaneTable, SceneTables, TiltTable};
use crate::scene::{Scene, in_file_names};
use plant_model::V2;
use plant_model::machine::params::{
    Change, MachineMagnet, MachineParams, MachinePlane, Rotor, Support,
};

/// Control samples of all policies of a run: of two an hour at 100 kHz, a quarter of an hour or more of a processor.
const MOST_SAMPLES: f64 = 1e9;

impl Spec {
    /// The scene, every value checked: in its range, and against the others.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key, and with slips beside it that may be the reason.
    pub fn resolve(&self) -> Result<Scene, SceneError> {
        let planes = self.planes()?;
        let resolved = self.resolve_with(&planes);
        let doubts = planes.first().map(slips).unwrap_or_default();
        resolved.map_err(|error| error.beside(&doubts))
    }

    fn resolve_with(&self, planes: &[PlaneSpec]) -> Result<Scene, SceneError> {
        let (tables, text) = (&self.tables, &self.text);
        self.check_ranges()?;
        check_title_and_length(tables, text)?;
        check_together(tables, text)?;
        let (mut machine, origin) = rotor::machine(tables, planes, text)?;
        for plane in planes {
            let place = |own: Option<f64>| origin.place_m(own.or(plane.position_m));
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
        let mut all = Vec::new();
        for plane in planes {
            let own = plane.tables.magnet.is_some().then_some(magnet);
            magnet += usize::from(own.is_some());
            let rigid = machine.rotor.rigid();
            let position_m = origin.place_m(plane.position_m);
            let lever = |place_m: f64| rigid.lever(place_m, position_m);
            let of = RotorContext {
                point: linear.point_mass(position_m),
                carried_kg: match own {
                    Some(m) => weights.translation[m] * rigid.mass_kg,
                    // Without a magnet an only plane carries all.
                    None if planes.len() == 1 => rigid.mass_kg,
                    None => 0.0,
                },
                residual_m_n: plane.position_m.map_or(0.0, |z| origin.residual_m_n(z)),
                magnet: own,
                retainer_plane_ratio: 1.0 / lever(machine.probes_m[plane.index]),
                magnet_plane_ratio: own.map_or(1.0, |m| lever(machine.magnets[m].position_m)),
                others_n: match own {
                    Some(_) => 0.0,
                    None => (machine.magnets.iter())
                        .map(|m| (lever(m.position_m) * m.force_max_n).abs())
                        .sum(),
                },
            };
            let resolved = plane.resolve(&of)?;
            machine.planes.push(MachinePlane {
                position_m,
                centre_m: centre_offset_m(plane)?,
                radius_m: plane.contact_radius_m,
                contact: resolved.plant.contact,
                friction: resolved.plant.friction,
                stator: resolved.plant.stator,
                race: resolved.plant.race,
                load_drag: bearing::load_drag(&plane.tables),
                heat: bearing::heat(&plane.tables),
            });
            all.push(resolved);
        }
        let start = start(tables, text, &machine)?;
        let mut warnings: Vec<String> = Vec::new();
        for warning in all.iter().flat_map(|plane| &plane.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        let Some(first) = all.first() else {
            return Err(text.missing_at("plane", "give one bearing plane at least".to_owned()));
        };
        let mut changes = first.changes.clone();
        for change in &mut changes {
            change.change.unbalance = change.change.unbalance.map(|u| origin.centred(u));
        }
        let run = &tables.run;
        let mut scene = Scene {
            title: tables.title.clone(),
            story: tables.story.trim().to_owned(),
            disturbances: self.disturbances(&first.disturbances, &origin),
            base_motions: first.base_motions.clone(),
            changes,
            levitated_before: tables.start.levitated_before,
            duration_s: run.duration_s,
            sample_rate_hz: run.sample_rate_hz,
            planes_in_turn: run.planes_in_turn,
            rtol: run.rtol,
            method: run.method.into(),
            policies: first.policies.clone(),
            spin_sensor: SpinSensorParams {
                valid: tables.spin_sensor.valid,
                gain: match tables.spin_sensor.reversed {
                    true => -tables.spin_sensor.gain,
                    false => tables.spin_sensor.gain,
                },
            },
            machine,
            start,
            planes: all.into_iter().map(|resolved| resolved.plane).collect(),
            levitation,
            configured_shaft: None,
            warnings,
        };
        (scene.machine_with_loads().validate())
            .and_then(|()| scene.machine.method(tables.run.method.into()).map(drop))
            .and_then(|()| start.validate())
            .map_err(|error| refused(&error, self, &scene))?;
        self.check_places_of_changes(&scene.machine.rotor, &origin)?;
        scene.decide(text);
        if text.warns {
            let doubt = of_the_loop(&scene, tables, text);
            scene.warnings.extend(doubt);
        }
        if scene.planes_in_turn && scene.supervised().is_none() {
            let message = "needs a rotor in two planes with a magnet each".to_owned();
            return Err(text.error_at_key(
                "run.planes_in_turn",
                message,
                Some("leave it out".to_owned()),
            ));
        }
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

    /// Unbalances that come later have to be on the rotor as well, and a centre of mass.
    fn check_places_of_changes(&self, rotor: &Rotor, origin: &Origin) -> Result<(), SceneError> {
        for (i, change) in self.tables.change.iter().enumerate() {
            let change = Change {
                unbalance: (change.unbalance.as_ref()).map(|u| origin.centred(u.into())),
                eccentricity_m: change.eccentricity_m,
                ..Change::default()
            };
            change.validate(rotor).map_err(|error| {
                let field = error.field.trim_start_matches("rotor.");
                let key = format!("change[{i}].{field}");
                self.text.refused(&key, error.value, error.expected)
            })?;
        }
        Ok(())
    }

    /// Disturbances where they act.
    fn disturbances(&self, all: &[Disturbance], origin: &Origin) -> Vec<Disturbance> {
        let places = self.tables.disturbance.iter().map(|d| d.position_m);
        (all.iter().zip(places))
            .map(|(disturbance, place)| Disturbance {
                position_m: origin.place_m(place),
                ..disturbance.clone()
            })
            .collect()
    }
}

fn check_title_and_length(written: &SceneTables, text: &SceneText) -> Result<(), SceneError> {
    let (run, title) = (&written.run, &written.title);
    let ticks = run.duration_s * run.sample_rate_hz;
    let policies = run.policies.0.len();
    if ticks * policies as f64 > MOST_SAMPLES {
        let help = "shorten run.duration_s, lower run.sample_rate_hz or run fewer policies";
        let message = format!(
            "{ticks:e} control samples for each of {policies} policies: expected at most a billion in all"
        );
        return Err(text.error_at_key("run.duration_s", message, Some(help.to_owned())));
    }
    // A terminal takes other control characters for orders.
    if title.trim().is_empty() || title.chars().any(char::is_control) {
        let help = Some("what the scene is for goes into story".to_owned());
        let message = "expected a name in one line, without control characters".to_owned();
        return Err(text.error_at_key("title", message, help));
    }
    Ok(())
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
