//! What a scene leaves to be derived from the speed at which its magnet can still lift the rotor off.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::plane_spec::PlaneSpec;
use plant_model::analysis::onset::lift_off_speed_m_s;
use plant_model::params::PlantParams;

/// The scene's own limit of whirl; else 3·ω0·c with a shaft, and three times the speed at which the magnet can
/// still lift the rotor off without one. A shaft against which magnets pull may have little stiffness left, and then it
/// is the larger of both, as it is in a plane of a rotor whose magnets stand elsewhere, and move it with `others_n` \[m/s\].
pub(crate) fn whirl_speed_m_s(
    spec: &PlaneSpec,
    plant: &PlantParams,
    others_n: f64,
) -> Result<f64, SceneError> {
    const KEY: &str = "verdict.whirl_speed_m_s";
    if let Some(speed) = spec.tables.verdict.whirl_speed_m_s {
        return Ok(speed);
    }
    let force = plant.magnet.map_or(others_n, |m| m.force_max_n);
    let by_magnet = 3.0 * lift_off_speed_m_s(plant, force);
    let pulls = others_n > 0.0
        || (spec.tables.magnet.as_ref()).is_some_and(|magnet| magnet.negative_stiffness_n_m > 0.0);
    let speed = match plant.natural_frequency_rad_s() {
        Some(natural) if pulls => by_magnet.max(3.0 * natural * plant.contact.clearance_m),
        Some(natural) => 3.0 * natural * plant.contact.clearance_m,
        None => by_magnet,
    };
    if speed > 0.0 {
        return Ok(speed);
    }
    let say = "say which backward contact speed counts as whirl";
    if plant.magnet.is_some() {
        return Err(cannot_lift(plant, &spec.text, KEY, say));
    }
    let message = "is missing: without shaft stiffness and magnet it has no default".to_owned();
    Err(spec.text.error_at_key(KEY, message, Some(say.to_owned())))
}

/// Gain of the policy `damping` \[N s/m\]: the scene's, or the whole cap at lift-off speed.
pub(crate) fn damping_n_s_m(
    spec: &PlaneSpec,
    plant: &PlantParams,
    wanted: bool,
) -> Result<f64, SceneError> {
    const KEY: &str = "damping.coefficient_n_s_m";
    if let Some(d) = spec.tables.damping.coefficient_n_s_m {
        return Ok(d);
    }
    let force_n = plant.magnet.map_or(0.0, |m| m.force_max_n);
    let speed = lift_off_speed_m_s(plant, force_n);
    if speed > 0.0 {
        Ok(force_n / speed)
    } else if wanted {
        let say = "say how much force the policy \"damping\" sets against speed";
        Err(cannot_lift(plant, &spec.text, KEY, say))
    } else {
        Ok(0.0)
    }
}

/// A cap too small for the magnet's own pull, or a clearance in millimetres: that is the mistake, and not the key that
/// has no default for it.
fn cannot_lift(plant: &PlantParams, text: &SceneText, key: &str, say: &str) -> SceneError {
    let force = plant.magnet.map_or(0.0, |m| m.force_max_n);
    let pull = -plant.rotor.stiffness_n_m * plant.contact.clearance_m;
    let message = format!(
        "is {force}: it cannot lift the rotor off the retainer bearing, where the negative stiffness pulls with {pull:.4} \
         N, and {key} has no default"
    );
    let help = format!(
        "check the cap, the negative stiffness and contact.clearance_m; or, if they are meant, {say}"
    );
    text.error_at_key("magnet.force_max_n", message, Some(help))
}
