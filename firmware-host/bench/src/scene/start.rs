//! Where a machine starts.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::tables::{PlaneTable, SceneTables};
use plant_model::V2;
use plant_model::machine::params::{MachineParams, MachineStart};
use std::f64::consts::TAU;

/// The start: centre of mass and tilt, or what both planes say.
pub(crate) fn start(
    tables: &SceneTables,
    text: &SceneText,
    machine: &MachineParams,
) -> Result<MachineStart, SceneError> {
    let (start, spin) = (&tables.start, &tables.spin);
    let mut at = MachineStart {
        centre_m: start.position_m.into(),
        centre_velocity_m_s: start.velocity_m_s.into(),
        tilt_rad: start.tilt_rad.unwrap_or_default().into(),
        tilt_rate_rad_s: start.tilt_rate_rad_s.unwrap_or_default().into(),
        spin_rad_s: spin.frequency_hz * TAU,
        spin_phase_rad: start.spin_phase_rad,
    };
    let by_plane = |p: &PlaneTable| p.start_position_m.is_some() || p.start_velocity_m_s.is_some();
    let Some(first) = tables.plane.iter().position(by_plane) else {
        return Ok(at);
    };
    let error = |message: &str, help: &str| {
        let key = match tables.plane[first].start_position_m {
            Some(_) => "start_position_m",
            None => "start_velocity_m_s",
        };
        let key = format!("plane[{first}].{key}");
        Err(text.error_at_key(&key, message.to_owned(), Some(help.to_owned())))
    };
    let bearings: Vec<usize> = (0..tables.plane.len())
        .filter(|plane| !tables.plane[*plane].seal)
        .collect();
    let [of_a, of_b] = bearings[..] else {
        let message = "says where the rotor starts for two planes, and there is another number";
        return error(message, "give start.position_m and start.tilt_rad");
    };
    let whole = [
        at.centre_m,
        at.centre_velocity_m_s,
        at.tilt_rad,
        at.tilt_rate_rad_s,
    ];
    if whole.iter().any(|v| *v != V2::zeros()) {
        let message = "says what [start] says as well";
        return error(message, "remove position, velocity and tilt from [start]");
    }
    let [a, b] = [of_a, of_b].map(|plane| &tables.plane[plane]);
    if a.position_m == b.position_m {
        let message = "does not say how the rotor is tilted: both planes stand at one place";
        return error(message, "give start.position_m and start.tilt_rad");
    }
    let [from_m, to_m] = [of_a, of_b].map(|plane| machine.planes[plane].position_m);
    let both = |of: fn(&PlaneTable) -> V2| {
        let slope = (of(b) - of(a)) / (to_m - from_m);
        (of(a) - from_m * slope, slope)
    };
    (at.centre_m, at.tilt_rad) = both(|p| p.start_position_m.unwrap_or_default().into());
    (at.centre_velocity_m_s, at.tilt_rate_rad_s) =
        both(|p| p.start_velocity_m_s.unwrap_or_default().into());
    Ok(at)
}
