//! What a scene file says of one plane: of the only one, or of one of several with what is the scene's.

use crate::device::external::Caller;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::spec::Spec;
use crate::scene::tables::{ContactTable, FrictionTable, PlaneTable, SceneTables, SensorTable};

/// One plane, with every table that it cannot do without.
#[derive(Debug, Clone)]
pub(crate) struct PlaneSpec {
    /// Which of the planes it is.
    pub(crate) index: usize,
    pub(crate) name: String,
    /// Where along the axis, as the scene counts; the centre of mass where it does not say.
    pub(crate) position_m: Option<f64>,
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
    /// Its planes; without a `[[plane]]` there is one, at the centre of mass, of which the scene's own tables speak.
    pub(crate) fn planes(&self) -> Result<Vec<PlaneSpec>, SceneError> {
        if self.tables.plane.is_empty() {
            let tables = self.tables.clone();
            return Ok(vec![PlaneSpec::new(self, self.text.clone(), tables, None)?]);
        }
        let planes = self.tables.plane.iter().enumerate();
        planes
            .map(|(i, plane)| {
                let tables = with_own(self.tables.clone(), plane);
                PlaneSpec::new(self, self.text.of_plane(i), tables, Some(plane))
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
        spec: &Spec,
        text: SceneText,
        tables: SceneTables,
        own: Option<&PlaneTable>,
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
            index: text.plane.unwrap_or(0),
            name: own.map_or_else(String::new, |plane| plane.name.clone()),
            position_m: own.map(|plane| plane.position_m),
            seal: own.is_some_and(|plane| plane.seal),
            caller: spec.caller.clone(),
            text,
            tables,
        })
    }
}
