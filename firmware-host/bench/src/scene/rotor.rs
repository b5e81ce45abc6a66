//! The rotor of a machine, and what acts on it apart from its planes.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::tables::{BendingTable, SceneTables};
use plant_model::machine::params::{
    BendingMode, MachineParams, RigidRotor, Rotor, Support, Unbalance,
};
use plant_model::params::SpinParams;
use std::f64::consts::TAU;

/// A machine without planes, magnets and loads.
pub(crate) fn machine(tables: &SceneTables, text: &SceneText) -> Result<MachineParams, SceneError> {
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
    let needed = |key: &str, value: Option<f64>, give: &str| {
        value.ok_or_else(|| text.missing_at(&format!("rotor.{key}"), give.to_owned()))
    };
    let rigid = RigidRotor {
        mass_kg: written.mass_kg,
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
    let rotor = match written.bending.is_empty() {
        true => Rotor::Rigid(rigid),
        false => Rotor::Modal {
            rigid,
            bending: (written.bending.iter().enumerate())
                .map(|(i, mode)| bending(i, mode, text))
                .collect::<Result<_, _>>()?,
            polar_coupling_kg_m2: written.polar_coupling_kg_m2.0.clone(),
        },
    };
    let eccentric = (written.eccentricity_m > 0.0).then_some(Unbalance {
        position_m: 0.0,
        moment_kg_m: written.mass_kg * written.eccentricity_m,
        angle_rad: 0.0,
    });
    let spin = &tables.spin;
    let unbalances = tables.unbalance.iter().map(|u| Unbalance {
        position_m: u.position_m,
        moment_kg_m: u.moment_kg_m,
        angle_rad: u.angle_rad,
    });
    Ok(MachineParams {
        rotor,
        supports: (tables.support.iter())
            .map(|s| Support {
                position_m: s.position_m,
                stiffness_n_m: s.stiffness_n_m,
                damping_n_s_m: s.damping_n_s_m,
            })
            .collect(),
        spin: match spin.inertia_kg_m2 {
            None => SpinParams::Held,
            Some(inertia_kg_m2) => SpinParams::Free {
                inertia_kg_m2,
                drive_torque_n_m: spin.drive_torque_n_m.unwrap_or(0.0),
            },
        },
        unbalances: unbalances.chain(eccentric).collect(),
        magnets: Vec::new(),
        loads_m: Vec::new(),
        probes_m: Vec::new(),
        gravity_m_s2: written.gravity_m_s2.into(),
        planes: Vec::new(),
    })
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
