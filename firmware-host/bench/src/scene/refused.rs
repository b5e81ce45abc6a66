//! What the machine of a scene refuses, at the key that it comes from.

use crate::scene::Scene;
use crate::scene::diagnostic::SceneError;
use crate::scene::plant::hardening_key;
use crate::scene::spec::Spec;
use plant_model::params::ParamError;

/// The error of a value by its name in [`plant_model::machine::params::MachineParams`].
pub(crate) fn refused(error: &ParamError, spec: &Spec, scene: &Scene) -> SceneError {
    let planes = &scene.planes;
    let (tables, text) = (&spec.tables, &spec.text);
    let (list, rest) = error.field.split_once('[').unwrap_or((&error.field, ""));
    let (index, field) = match rest.split_once("].") {
        Some((index, field)) => (index.parse().unwrap_or(0), field),
        None => (0, ""),
    };
    let at = |key: &str| text.refused(key, error.value, error.expected);
    let of_plane =
        |index: usize, key: &str| (text.of_plane(index)).refused(key, error.value, error.expected);
    // Where it has no place of its own, that of its plane is meant.
    let place = |plane: usize, own: Option<f64>, table: &str| match own {
        Some(_) => of_plane(plane, &format!("{table}.position_m")),
        None if tables.plane.is_empty() => at("rotor.bending"),
        None => at(&format!("plane[{plane}].position_m")),
    };
    match (list, field) {
        ("planes", "") | ("magnets", "") => at("plane"),
        ("planes", "position_m") if tables.plane.is_empty() => at("rotor.bending"),
        ("planes", "position_m") => at(&format!("plane[{index}].position_m")),
        ("planes", "radius_m") => of_plane(index, "rotor.contact_radius_m"),
        ("planes", "centre_m") => of_plane(index, "retainer.centre_offset_m"),
        ("spin.inertia_kg_m2", _) => {
            let polar = scene.machine.rotor.rigid().polar_inertia_kg_m2;
            let message = format!(
                "is {:e}, expected {}: {polar:.4e} kg m² or more",
                error.value, error.expected
            );
            text.error_at_key("spin.inertia_kg_m2", message, None)
        }
        ("run.method", _) => {
            let message = format!("expected {}", error.expected);
            text.error_at_key("run.method", message, None)
        }
        ("planes", "contact.stiffness_n_mn") => {
            let contact = spec.planes().ok().and_then(|planes| {
                let plane = planes.into_iter().nth(index)?;
                hardening_key(&plane.contact)
            });
            of_plane(index, contact.unwrap_or("contact.stiffness_n_mn"))
        }
        ("planes", "load_drag.arm_m") => of_plane(index, "race.load_drag_m"),
        ("planes", "load_drag.still_rad_s") => of_plane(index, "race.load_drag_from_hz"),
        ("planes", key) if key.starts_with("heat.") => of_plane(index, &format!("retainer.{key}")),
        ("planes", "stator.ellipticity") => of_plane(index, "retainer.ellipticity"),
        ("planes", key) => of_plane(index, key),
        ("probes", _) => {
            let plane = tables.plane.get(index);
            let sensor = plane
                .and_then(|p| p.sensor.as_ref())
                .unwrap_or(&tables.sensor);
            place(index, sensor.position_m, "sensor")
        }
        ("magnets", key) => {
            let plane = planes
                .iter()
                .position(|p| p.magnet == Some(index))
                .unwrap_or(0);
            let own = tables.plane.get(plane).and_then(|p| p.magnet.as_ref());
            match (own.or(tables.magnet.as_ref()), key) {
                (Some(magnet), "position_m") => place(plane, magnet.position_m, "magnet"),
                _ => of_plane(plane, &format!("magnet.{key}")),
            }
        }
        ("supports", key) if index < tables.support.len() => at(&format!("support[{index}].{key}")),
        // That of the centre, or of a magnet.
        ("supports", _) if tables.rotor.stiffness_n_m.is_some() => at("rotor.stiffness_n_m"),
        ("supports", _) => of_plane(0, "magnet.negative_stiffness_n_m"),
        ("unbalances", key) if index < tables.unbalance.len() => {
            at(&format!("unbalance[{index}].{key}"))
        }
        ("loads", _) => at(&format!("disturbance[{index}].position_m")),
        ("rotor.bending", "frequency_rad_s") => at(&format!("rotor.bending[{index}].frequency_hz")),
        ("rotor.bending", "shape") => at(&format!("rotor.bending[{index}].positions_m")),
        ("start.centre_m", _) => at("start.position_m"),
        ("start.centre_velocity_m_s", _) => at("start.velocity_m_s"),
        ("start.spin_rad_s", _) => at("spin.frequency_hz"),
        ("gravity_m_s2", _) => at("rotor.gravity_m_s2"),
        _ => at(&error.field),
    }
}
