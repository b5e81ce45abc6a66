//! The rotor of a machine, and what acts on it apart from its planes.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::plant::spin;
use crate::scene::tables::{BendingTable, SceneTables};
use plant_model::machine::params::{
    BendingMode, MachineError, MachineParams, RigidRotor, Rotor, Support, Unbalance,
};
use plant_model::machine::shaft::{Disc, ReducedShaft, Shaft, ShaftSection};
use std::f64::consts::TAU;

/// Bending modes of a shaft are kept up to here, where the scene does not say \[Hz\].
const BENDING_TO_HZ: f64 = 3000.0;
/// Elements of a shaft.
const ELEMENTS: u32 = 16;

/// Where positions of the scene count from.
pub(crate) enum Origin {
    /// From the centre of mass.
    Centre,
    /// From the left end of a shaft.
    LeftEnd(ReducedShaft),
}

impl Origin {
    /// A place of the scene, from the centre of mass \[m\].
    pub(crate) fn centred_m(&self, position_m: f64) -> f64 {
        match self {
            Self::Centre => position_m,
            Self::LeftEnd(shaft) => shaft.centred_m(position_m),
        }
    }

    /// What gives way beside the modes at the plane of this number \[m/N\].
    pub(crate) fn residual_m_n(&self, plane: usize) -> f64 {
        match self {
            Self::Centre => 0.0,
            Self::LeftEnd(shaft) => shaft.residual_m_n[plane],
        }
    }
}

/// A machine without planes, magnets and loads, and where positions count from.
pub(crate) fn machine(
    tables: &SceneTables,
    text: &SceneText,
) -> Result<(MachineParams, Origin), SceneError> {
    let written = &tables.rotor;
    let of_a_point = [
        ("rotor.stiffness_n_m", written.stiffness_n_m),
        ("rotor.natural_frequency_hz", written.natural_frequency_hz),
        ("rotor.damping_n_s_m", written.damping_n_s_m),
        ("rotor.damping_ratio", written.damping_ratio),
    ];
    if let Some((key, _)) = of_a_point.iter().find(|(_, value)| value.is_some()) {
        let message = "is of a point mass; a whole rotor stands on supports".to_owned();
        let help = "give a [[support]] with position_m, stiffness_n_m and damping_n_s_m".to_owned();
        return Err(text.error_at_key(key, message, Some(help)));
    }
    let (rotor, origin) = match tables.shaft.is_empty() {
        true => (by_numbers(tables, text)?, Origin::Centre),
        false => {
            let shaft = of_a_shaft(tables, text)?;
            (shaft.rotor.clone(), Origin::LeftEnd(shaft))
        }
    };
    let moment_kg_m = rotor.rigid().mass_kg * written.eccentricity_m;
    let eccentric = (moment_kg_m > 0.0).then_some(Unbalance {
        position_m: 0.0,
        moment_kg_m,
        angle_rad: 0.0,
    });
    let unbalances = tables.unbalance.iter().map(|u| Unbalance {
        position_m: origin.centred_m(u.position_m),
        moment_kg_m: u.moment_kg_m,
        angle_rad: u.angle_rad,
    });
    let machine = MachineParams {
        rotor,
        supports: (tables.support.iter())
            .map(|s| Support {
                position_m: origin.centred_m(s.position_m),
                stiffness_n_m: s.stiffness_n_m.into(),
                damping_n_s_m: s.damping_n_s_m.into(),
            })
            .collect(),
        spin: spin(tables, text)?,
        unbalances: unbalances.chain(eccentric).collect(),
        magnets: Vec::new(),
        loads_m: Vec::new(),
        probes_m: Vec::new(),
        gravity_m_s2: written.gravity_m_s2.into(),
        planes: Vec::new(),
    };
    Ok((machine, origin))
}

/// A rotor by mass, inertias and modes.
fn by_numbers(tables: &SceneTables, text: &SceneText) -> Result<Rotor, SceneError> {
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
    if let Some((key, _)) = of_a_shaft.iter().find(|(_, given)| *given) {
        let message = "is of a shaft, and there is none".to_owned();
        let help = "describe it by [[shaft]], or remove this".to_owned();
        return Err(text.error_at_key(key, message, Some(help)));
    }
    let needed = |key: &str, value: Option<f64>, give: &str| {
        value.ok_or_else(|| text.missing_at(&format!("rotor.{key}"), give.to_owned()))
    };
    let rigid = RigidRotor {
        mass_kg: needed(
            "mass_kg",
            written.mass_kg,
            "give a number in kg, or [[shaft]]",
        )?,
        transverse_inertia_kg_m2: needed(
            "transverse_inertia_kg_m2",
            written.transverse_inertia_kg_m2,
            "give I_t about the centre of mass in kg m²",
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
        },
    })
}

/// A rotor by its shaft.
fn of_a_shaft(tables: &SceneTables, text: &SceneText) -> Result<ReducedShaft, SceneError> {
    let written = &tables.rotor;
    let of_numbers = [
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
    ];
    if let Some((key, _)) = of_numbers.iter().find(|(_, given)| *given) {
        let message = "follows from [[shaft]] and [[disc]]".to_owned();
        return Err(text.error_at_key(key, message, Some("remove it".to_owned())));
    }
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
    let places = places(tables);
    let nodes_m: Vec<f64> = places.iter().map(|(_, z)| *z).collect();
    let up_to_rad_s = TAU * written.bending_to_hz.unwrap_or(BENDING_TO_HZ);
    let damping_ratio = written.bending_damping_ratio.unwrap_or(0.0);
    let refused = |error: MachineError| {
        let node = (error.field.strip_prefix("nodes["))
            .and_then(|rest| rest.trim_end_matches(']').parse::<usize>().ok())
            .and_then(|i| places.get(i));
        let key = match node {
            Some((key, _)) => key.clone(),
            None => error.field.replace("discs[", "disc["),
        };
        text.refused(&key, error.value, error.expected)
    };
    shaft
        .reduced(&nodes_m, up_to_rad_s, damping_ratio)
        .map_err(refused)
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
