//! What a scene file says of one plane: of the only one, or of one of several with what is the scene's.

use crate::device::external::Caller;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::spec::Spec;
use crate::scene::tables::{ContactTable, FrictionTable, PlaneTable, SceneTables, SensorTable};

/// One plane, with every table that it cannot do without.
#[derive(Debug, Clone)]
pub(crate) struct PlaneSpec {
    /// Speaks of the plane.
    pub(crate) text: SceneText,
    /// The scene's tables, the plane's own in their place.
    pub(crate) tables: SceneTables,
    pub(crate) contact: ContactTable,
    pub(crate) friction: FrictionTable,
    pub(crate) contact_radius_m: f64,
    /// Whether no controller knows of it.
    pub(crate) seal: bool,
    /// Who levitates in the place of the program that `[controller]` names.
    pub(crate) caller: Option<Caller>,
}

impl Spec {
    /// Whether it describes a whole rotor.
    pub fn has_planes(&self) -> bool {
        !self.tables.plane.is_empty()
    }

    /// The plane of a scene that has one.
    pub(crate) fn only_plane(&self) -> Result<PlaneSpec, SceneError> {
        let (tables, text) = (&self.tables, &self.text);
        if self.has_planes() {
            let message = "makes this a scene of a whole rotor, which does not go here".to_owned();
            let help = "run, modes and advise take such a scene; what else there is needs one of a single plane";
            return Err(text.error_at_key("plane", message, Some(help.to_owned())));
        }
        let (rotor, start) = (&tables.rotor, &tables.start);
        let load = (tables.disturbance.iter()).position(|d| d.position_m.is_some());
        let of_several = [
            (
                "rotor.transverse_inertia_kg_m2",
                rotor.transverse_inertia_kg_m2.is_some(),
            ),
            (
                "rotor.polar_inertia_kg_m2",
                rotor.polar_inertia_kg_m2.is_some(),
            ),
            ("rotor.bending", !rotor.bending.is_empty()),
            (
                "rotor.polar_coupling_kg_m2",
                !rotor.polar_coupling_kg_m2.0.is_empty(),
            ),
            ("start.tilt_rad", start.tilt_rad.is_some()),
            ("start.tilt_rate_rad_s", start.tilt_rate_rad_s.is_some()),
            ("shaft", !tables.shaft.is_empty()),
            ("disc", !tables.disc.is_empty()),
            ("rotor.bending_to_hz", rotor.bending_to_hz.is_some()),
            (
                "rotor.bending_damping_ratio",
                rotor.bending_damping_ratio.is_some(),
            ),
            ("rotor.elements", rotor.elements.is_some()),
            ("rotor.matrices_file", rotor.matrices_file.is_some()),
            ("support", !tables.support.is_empty()),
            ("unbalance", !tables.unbalance.is_empty()),
            (
                "magnet.position_m",
                tables
                    .magnet
                    .as_ref()
                    .is_some_and(|m| m.position_m.is_some()),
            ),
            (
                "magnet.poles",
                (tables.magnet.as_ref()).is_some_and(|m| m.poles.is_some()),
            ),
            (
                "magnet.lag_damping_ratio",
                (tables.magnet.as_ref()).is_some_and(|m| m.lag_damping_ratio.is_some()),
            ),
            (
                "race.load_drag_m",
                (tables.race.as_ref()).is_some_and(|race| race.load_drag_m.is_some()),
            ),
            ("retainer.heat", tables.retainer.heat.is_some()),
            ("sensor.position_m", tables.sensor.position_m.is_some()),
            (
                "levitation.tilt",
                tables.levitation.as_ref().is_some_and(|l| l.tilt.is_some()),
            ),
        ];
        let of_load = load.map_or_else(String::new, |i| format!("disturbance[{i}].position_m"));
        let message = "is of a whole rotor, and this scene has a point mass in one plane";
        let help = "describe the bearing planes by [[plane]], or remove it";
        text.none_given(&of_several, message, help)?;
        text.none_given(&[(of_load.as_str(), load.is_some())], message, help)?;
        PlaneSpec::new(text.clone(), tables.clone(), self.caller.clone(), false)
    }

    /// The planes of a whole rotor.
    pub(crate) fn planes(&self) -> Result<Vec<PlaneSpec>, SceneError> {
        let planes = self.tables.plane.iter().enumerate();
        planes
            .map(|(i, plane)| {
                let tables = with_own(self.tables.clone(), plane);
                PlaneSpec::new(
                    self.text.of_plane(i),
                    tables,
                    self.caller.clone(),
                    plane.seal,
                )
            })
            .collect()
    }
}

/// The scene's tables, those of the plane in the place of its own.
fn with_own(mut tables: SceneTables, plane: &PlaneTable) -> SceneTables {
    fn over<T: Clone>(table: &mut T, own: Option<&T>) {
        if let Some(own) = own {
            table.clone_from(own);
        }
    }
    tables.rotor.contact_radius_m = plane.contact_radius_m.or(tables.rotor.contact_radius_m);
    over(&mut tables.stator, plane.stator.as_ref());
    over(&mut tables.retainer, plane.retainer.as_ref());
    over(&mut tables.sensor, plane.sensor.as_ref());
    over(&mut tables.supervisor, plane.supervisor.as_ref());
    tables.contact = plane.contact.clone().or(tables.contact);
    tables.friction = plane.friction.clone().or(tables.friction);
    tables.race = plane.race.clone().or(tables.race);
    tables.magnet = plane.magnet.clone().or(tables.magnet);
    tables.biquads = plane.biquads.clone().or(tables.biquads);
    tables.levitation = plane.levitation.clone().or(tables.levitation);
    if !plane.outage.is_empty() {
        tables.outage.clone_from(&plane.outage);
    }
    if !plane.fault.is_empty() {
        tables.fault.clone_from(&plane.fault);
    }
    if plane.seal {
        tables.sensor = SensorTable::default();
        tables.supervisor.clear();
        (tables.magnet, tables.biquads, tables.levitation) = (None, None, None);
        tables.outage.clear();
        tables.fault.clear();
        tables.set_down.clear();
    }
    tables.plane.clear();
    tables
}

impl PlaneSpec {
    fn new(
        text: SceneText,
        tables: SceneTables,
        caller: Option<Caller>,
        seal: bool,
    ) -> Result<Self, SceneError> {
        let missing = |key: &str, give: &str| {
            let (key, help) = match text.plane {
                None => (key.to_owned(), give.to_owned()),
                Some(i) => (
                    format!("plane[{i}].{key}"),
                    format!("{give}, for this plane or for all"),
                ),
            };
            text.missing_at(&key, help)
        };
        let (contact, friction) = (tables.contact.clone(), tables.friction.clone());
        let radius_key = match text.plane {
            None => "rotor.contact_radius_m",
            Some(_) => "contact_radius_m",
        };
        Ok(Self {
            contact: contact.ok_or_else(|| missing("contact", "add a table [contact]"))?,
            friction: friction.ok_or_else(|| missing("friction", "add a table [friction]"))?,
            contact_radius_m: (tables.rotor.contact_radius_m).ok_or_else(|| {
                let give = "give the rotor's radius in the retainer bearing in m";
                missing(radius_key, give)
            })?,
            seal,
            text,
            tables,
            caller,
        })
    }
}
