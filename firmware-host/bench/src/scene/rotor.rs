//! The rotor of a machine, and what acts on it apart from its planes.

use crate::scene::arrays::Arrays;
use crate::scene::diagnostic::{Given, SceneError, SceneText};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::plant::spin;
use crate::scene::tables::{BendingTable, SceneTables, SupportTable, UnbalanceTable};
use plant_model::V2;
use plant_model::machine::params::{
    BendingMode, MachineParams, RigidRotor, Rotor, Support, Unbalance,
};
use plant_model::machine::reduced::{ReducedRotor, RotorMatrices};
use plant_model::machine::shaft::{Disc, Shaft, ShaftSection};
use plant_model::params::ParamError;
use std::f64::consts::TAU;

/// Bending modes of a shaft are kept up to here, where the scene does not say \[Hz\].
const BENDING_TO_HZ: f64 = 3000.0;
/// Elements of a shaft.
const ELEMENTS: u32 = 16;
/// Coordinates of a file of matrices: finding the modes takes the third power.
const MOST_COORDINATES: usize = 1000;

/// Where positions of the scene count from.
pub(crate) enum Origin {
    /// From the centre of mass.
    Centre,
    /// From the left end of a shaft, or as a file of matrices has it.
    Given(ReducedRotor),
}

impl Origin {
    /// A place of the scene, from the centre of mass \[m\].
    pub(crate) fn centred_m(&self, position_m: f64) -> f64 {
        match self {
            Self::Centre => position_m,
            Self::Given(rotor) => rotor.centred_m(position_m),
        }
    }

    /// The same; the centre of mass where none is given.
    pub(crate) fn place_m(&self, position_m: Option<f64>) -> f64 {
        position_m.map_or(0.0, |z| self.centred_m(z))
    }

    /// An unbalance at a place of the scene.
    pub(crate) fn centred(&self, unbalance: Unbalance) -> Unbalance {
        Unbalance {
            position_m: self.centred_m(unbalance.position_m),
            ..unbalance
        }
    }

    /// What gives way beside the modes at a place of the scene \[m/N\].
    pub(crate) fn residual_m_n(&self, position_m: f64) -> f64 {
        match self {
            Self::Centre => 0.0,
            Self::Given(rotor) => rotor.residual_m_n(position_m),
        }
    }
}

/// A machine without planes, magnets and loads, and where positions count from.
pub(crate) fn machine(
    tables: &SceneTables,
    planes: &[PlaneSpec],
    text: &SceneText,
) -> Result<(MachineParams, Origin), SceneError> {
    let written = &tables.rotor;
    let (rotor, origin) = if let Some(file) = &written.matrices_file {
        given(by_matrices(file, tables, text)?)
    } else if tables.shaft.is_empty() {
        (by_numbers(tables, planes, text)?, Origin::Centre)
    } else {
        given(of_a_shaft(tables, text)?)
    };
    if let Origin::Given(_) = origin
        && tables.plane.is_empty()
    {
        let help = "say by [[plane]] with position_m where along the shaft the bearing is";
        return Err(text.missing_at("plane", help.to_owned()));
    }
    let unbalances = tables.unbalance.iter().map(|u| origin.centred(u.into()));
    let supports = tables
        .support
        .iter()
        .map(|written| support(&origin, written));
    let own = of_the_centre(rotor.rigid().mass_kg, tables, text)?;
    let machine = MachineParams {
        supports: supports.chain(own).collect(),
        rotor,
        spin: spin(tables, text)?,
        unbalances: unbalances.collect(),
        eccentricity_m: written.eccentricity_m,
        magnets: Vec::new(),
        loads_m: Vec::new(),
        probes_m: Vec::new(),
        gravity_m_s2: written.gravity_m_s2.into(),
        planes: Vec::new(),
    };
    Ok((machine, origin))
}

fn given(rotor: ReducedRotor) -> (Rotor, Origin) {
    (rotor.rotor.clone(), Origin::Given(rotor))
}

/// What holds the centre of mass itself: the elastic shaft of a rotor that is one mass.
fn of_the_centre(
    mass_kg: f64,
    tables: &SceneTables,
    text: &SceneText,
) -> Result<Option<Support>, SceneError> {
    let file = &tables.rotor;
    let by_frequency = (file.natural_frequency_hz).map(|f| mass_kg * (f * TAU).powi(2));
    let stiffness_n_m = text.either(
        Given::new("rotor.stiffness_n_m", file.stiffness_n_m),
        Given::new("rotor.natural_frequency_hz", by_frequency),
    )?;
    let shaft_n_m = stiffness_n_m.unwrap_or(0.0);
    if file.damping_ratio.is_some() && shaft_n_m <= 0.0 {
        let message = "has no meaning without shaft stiffness".to_owned();
        let help = Some("give rotor.damping_n_s_m instead".to_owned());
        return Err(text.error_at_key("rotor.damping_ratio", message, help));
    }
    let by_ratio = (file.damping_ratio).map(|ratio| 2.0 * ratio * (mass_kg * shaft_n_m).sqrt());
    let damping_n_s_m = text.either(
        Given::new("rotor.damping_n_s_m", file.damping_n_s_m),
        Given::new("rotor.damping_ratio", by_ratio),
    )?;
    Ok(
        (stiffness_n_m.is_some() || damping_n_s_m.is_some()).then(|| Support {
            stiffness_n_m: V2::repeat(shaft_n_m),
            damping_n_s_m: V2::repeat(damping_n_s_m.unwrap_or(0.0)),
            ..Support::default()
        }),
    )
}

/// A support, in series with what the rotor gives way there beside its modes. Spring and damper share
/// the way as of slow motions, as a contact does.
fn support(origin: &Origin, written: &SupportTable) -> Support {
    let (stiffness_n_m, damping_n_s_m): (V2, V2) =
        (written.stiffness_n_m.into(), written.damping_n_s_m.into());
    let residual_m_n = origin.residual_m_n(written.position_m);
    // What pulls outwards is no spring in series with one.
    let share = stiffness_n_m.map(|k| 1.0 / (1.0 + k.max(0.0) * residual_m_n));
    let both = share.x * share.y;
    Support {
        position_m: origin.centred_m(written.position_m),
        stiffness_n_m: stiffness_n_m.component_mul(&share),
        damping_n_s_m: damping_n_s_m.component_mul(&share).component_mul(&share),
        cross_stiffness_n_m: both * V2::from(written.cross_stiffness_n_m),
        cross_damping_n_s_m: both * V2::from(written.cross_damping_n_s_m),
    }
}

impl From<&UnbalanceTable> for Unbalance {
    fn from(written: &UnbalanceTable) -> Self {
        Self {
            position_m: written.position_m,
            moment_kg_m: written.moment_kg_m,
            angle_rad: written.angle_rad,
        }
    }
}

/// A rotor by mass, inertias and modes.
fn by_numbers(
    tables: &SceneTables,
    planes: &[PlaneSpec],
    text: &SceneText,
) -> Result<Rotor, SceneError> {
    let written = &tables.rotor;
    let of_a_shaft = [
        ("disc", !tables.disc.is_empty()),
        ("rotor.bending_to_hz", written.bending_to_hz.is_some()),
        (
            "rotor.bending_damping_ratio",
            written.bending_damping_ratio.is_some(),
        ),
        ("rotor.elements", written.elements.is_some()),
    ];
    text.none_given(
        &of_a_shaft,
        "is of a shaft, and there is none",
        "describe it by [[shaft]], or remove this",
    )?;
    let needed = |key: &str, value: Option<f64>, give: &str| {
        value.ok_or_else(|| text.missing_at(&format!("rotor.{key}"), give.to_owned()))
    };
    let mass_kg = needed(
        "mass_kg",
        written.mass_kg,
        "give a number in kg, or [[shaft]]",
    )?;
    let Some(why) = tilts(tables, planes) else {
        return Ok(Rotor::Rigid(RigidRotor::point(mass_kg)));
    };
    let rigid = RigidRotor {
        mass_kg,
        transverse_inertia_kg_m2: needed(
            "transverse_inertia_kg_m2",
            written.transverse_inertia_kg_m2,
            &format!("{why} is of a rotor that tilts: give I_t about the centre of mass in kg m²"),
        )?,
        polar_inertia_kg_m2: needed(
            "polar_inertia_kg_m2",
            written.polar_inertia_kg_m2,
            "give I_p in kg m²; 0 for a rotor without gyroscopic effect",
        )?,
    };
    Ok(match written.bending.is_empty() {
        true => Rotor::Rigid(rigid),
        false => Rotor::Modal {
            rigid,
            bending: (written.bending.iter().enumerate())
                .map(|(i, mode)| bending(i, mode, text))
                .collect::<Result<_, _>>()?,
            polar_coupling_kg_m2: written.polar_coupling_kg_m2.0.clone(),
            damping_n_s_m: Vec::new(),
        },
    })
}

/// The key that makes the rotor more than a mass in one plane, in which everything stands.
fn tilts(tables: &SceneTables, planes: &[PlaneSpec]) -> Option<String> {
    let start = &tables.start;
    // A mass has a point, too.
    let of_more = of_numbers(tables).into_iter().skip(1);
    let mut keys = of_more.chain([
        ("start.tilt_rad", start.tilt_rad.is_some()),
        ("start.tilt_rate_rad_s", start.tilt_rate_rad_s.is_some()),
        ("plane", planes.len() > 1),
    ]);
    let found = keys.find(|(_, given)| *given);
    let off_centre = || places(tables).into_iter().find(|(_, z)| *z != 0.0);
    (found.map(|(key, _)| key.to_owned())).or_else(|| off_centre().map(|(key, _)| key))
}

/// Keys of a rotor by numbers.
fn of_numbers(tables: &SceneTables) -> [(&'static str, bool); 5] {
    let written = &tables.rotor;
    [
        ("rotor.mass_kg", written.mass_kg.is_some()),
        (
            "rotor.transverse_inertia_kg_m2",
            written.transverse_inertia_kg_m2.is_some(),
        ),
        (
            "rotor.polar_inertia_kg_m2",
            written.polar_inertia_kg_m2.is_some(),
        ),
        ("rotor.bending", !written.bending.is_empty()),
        (
            "rotor.polar_coupling_kg_m2",
            !written.polar_coupling_kg_m2.0.is_empty(),
        ),
    ]
}

/// What is asked of a rotor that is reduced to modes, with the name of each place.
struct Asked {
    places: Vec<(String, f64)>,
    up_to_rad_s: f64,
    damping_ratio: f64,
}

impl Asked {
    fn new(tables: &SceneTables) -> Self {
        let written = &tables.rotor;
        Self {
            places: places(tables),
            up_to_rad_s: TAU * written.bending_to_hz.unwrap_or(BENDING_TO_HZ),
            damping_ratio: written.bending_damping_ratio.unwrap_or(0.0),
        }
    }

    fn nodes_m(&self) -> Vec<f64> {
        self.places.iter().map(|(_, z)| *z).collect()
    }

    /// Key of the place that an error is about.
    fn key(&self, error: &ParamError) -> Option<&str> {
        let index = error.field.strip_prefix("nodes[")?;
        let index: usize = index.trim_end_matches(']').parse().ok()?;
        self.places.get(index).map(|(key, _)| key.as_str())
    }
}

/// A rotor by the matrices in a file.
fn by_matrices(
    file: &str,
    tables: &SceneTables,
    text: &SceneText,
) -> Result<ReducedRotor, SceneError> {
    let key = "rotor.matrices_file";
    let message = "follows from rotor.matrices_file, or contradicts it";
    text.none_given(&of_numbers(tables), message, "remove it")?;
    let of_a_shaft = [
        ("shaft", !tables.shaft.is_empty()),
        ("disc", !tables.disc.is_empty()),
        ("rotor.elements", tables.rotor.elements.is_some()),
    ];
    text.none_given(&of_a_shaft, message, "remove it")?;
    let known = ["M", "K", "D", "G", "places_m", "displacement"];
    let mut arrays = Arrays::load(text, (key, file), &known)?;
    let matrices = RotorMatrices {
        mass: arrays.take("M")?,
        stiffness: arrays.take("K")?,
        damping: arrays.take_if_there("D")?,
        gyroscopic: arrays.take_if_there("G")?,
        places_m: arrays.take("places_m")?.as_slice().to_vec(),
        displacement: arrays.take("displacement")?,
    };
    let coordinates = matrices.mass.nrows();
    if coordinates > MOST_COORDINATES {
        let message =
            format!("M of {file} has {coordinates} coordinates, at most {MOST_COORDINATES}");
        let help = "reduce the rotor before, to some hundred".to_owned();
        return Err(text.error_at_key(key, message, Some(help)));
    }
    let asked = Asked::new(tables);
    let reduced = matrices.reduced(&asked.nodes_m(), asked.up_to_rad_s, asked.damping_ratio);
    reduced
        .and_then(|reduced| reduced.rotor.validate().map(|()| reduced))
        .map_err(|error| match asked.key(&error) {
            Some(place) => text.refused(place, error.value, error.expected),
            None => {
                let name = match error.field.as_str() {
                    "mass" | "rotor.mass_kg" | "rotor.transverse_inertia_kg_m2" => "M",
                    "stiffness" => "K",
                    "damping" | "rotor.damping_n_s_m" => "D",
                    "gyroscopic" | "rotor.polar_inertia_kg_m2" | "rotor.polar_coupling_kg_m2" => {
                        "G"
                    }
                    name => name,
                };
                let (value, expected) = (error.value, error.expected);
                let message = format!("{name} of {file} has {value:e}: expected {expected}");
                text.error_at_key(key, message, Some(format!("give {expected}")))
            }
        })
}

/// A rotor by its shaft.
fn of_a_shaft(tables: &SceneTables, text: &SceneText) -> Result<ReducedRotor, SceneError> {
    let written = &tables.rotor;
    let message = "follows from [[shaft]] and [[disc]]";
    text.none_given(&of_numbers(tables), message, "remove it")?;
    let shaft = Shaft {
        sections: (tables.shaft.iter())
            .map(|s| ShaftSection {
                length_m: s.length_m,
                outer_diameter_m: s.outer_diameter_m,
                inner_diameter_m: s.inner_diameter_m,
                density_kg_m3: s.density_kg_m3,
                youngs_modulus_n_m2: s.youngs_modulus_n_m2,
                poisson_ratio: s.poisson_ratio,
            })
            .collect(),
        discs: (tables.disc.iter())
            .map(|d| Disc {
                position_m: d.position_m,
                mass_kg: d.mass_kg,
                transverse_inertia_kg_m2: d.transverse_inertia_kg_m2,
                polar_inertia_kg_m2: d.polar_inertia_kg_m2,
            })
            .collect(),
        elements: written.elements.unwrap_or(ELEMENTS) as usize,
    };
    let asked = Asked::new(tables);
    shaft
        .reduced(&asked.nodes_m(), asked.up_to_rad_s, asked.damping_ratio)
        .map_err(|error| {
            let key = match asked.key(&error) {
                Some(place) => place.to_owned(),
                None => error.field.replace("discs[", "disc["),
            };
            text.refused(&key, error.value, error.expected)
        })
}

/// Keys and values of all places on the rotor, those of the planes first.
fn places(tables: &SceneTables) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    let mut put = |key: String, z: Option<f64>| all.extend(z.map(|z| (key, z)));
    for (i, plane) in tables.plane.iter().enumerate() {
        put(format!("plane[{i}].position_m"), Some(plane.position_m));
    }
    for (i, plane) in tables.plane.iter().enumerate() {
        let sensor = plane.sensor.as_ref().and_then(|s| s.position_m);
        put(format!("plane[{i}].sensor.position_m"), sensor);
        let magnet = plane.magnet.as_ref().and_then(|m| m.position_m);
        put(format!("plane[{i}].magnet.position_m"), magnet);
    }
    put("sensor.position_m".to_owned(), tables.sensor.position_m);
    let magnet = tables.magnet.as_ref().and_then(|m| m.position_m);
    put("magnet.position_m".to_owned(), magnet);
    for (i, support) in tables.support.iter().enumerate() {
        put(format!("support[{i}].position_m"), Some(support.position_m));
    }
    for (i, unbalance) in tables.unbalance.iter().enumerate() {
        put(
            format!("unbalance[{i}].position_m"),
            Some(unbalance.position_m),
        );
    }
    for (i, load) in tables.disturbance.iter().enumerate() {
        put(format!("disturbance[{i}].position_m"), load.position_m);
    }
    for (i, change) in tables.change.iter().enumerate() {
        let unbalance = change.unbalance.as_ref().map(|u| u.position_m);
        put(format!("change[{i}].unbalance.position_m"), unbalance);
    }
    all
}

fn bending(i: usize, mode: &BendingTable, text: &SceneText) -> Result<BendingMode, SceneError> {
    let (places, shape) = (&mode.positions_m.0, &mode.displacements.0);
    if places.len() != shape.len() {
        let key = format!("rotor.bending[{i}].displacements");
        let message = format!("are {}, for {} places", shape.len(), places.len());
        let help = "give a displacement for each of positions_m".to_owned();
        return Err(text.error_at_key(&key, message, Some(help)));
    }
    Ok(BendingMode {
        frequency_rad_s: TAU * mode.frequency_hz,
        damping_ratio: mode.damping_ratio,
        shape: places.iter().copied().zip(shape.iter().copied()).collect(),
    })
}
