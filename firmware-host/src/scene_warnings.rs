//! What a scene may say and hardly means: a slip of a unit, a table pasted from another machine.

use crate::scene_error::SceneText;
use crate::scene_file::SceneFile;
use crate::suggest::{Nominal, SUPERVISED_RATES_HZ, suggested};
use plant_model::params::PlantParams;
use supervisor::PARAMETERS;

/// A start that lies deeper in the wall than this, or would press the rotor deeper \[clearances\].
const DEEP: f64 = 10.0;

/// Parameters of the supervisor that a data sheet has, and the scene as well.
const GIVEN: [&str; 10] = [
    "sample_period_s",
    "mass_kg",
    "stiffness_n_m",
    "damping_n_s_m",
    "clearance_m",
    "force_max_n",
    "amplifier_lag_s",
    "delay_samples",
    "friction_coefficient",
    "contact_stiffness_n_m",
];

/// Warnings with file and line. `nominal` is what a supervisor that runs is told of the plant.
pub(crate) fn warnings_of(
    file: &SceneFile,
    text: &SceneText,
    (plant, nominal): (&PlantParams, Option<&Nominal>),
) -> Vec<String> {
    let warning = |key: &str, message: String| text.error_at_key(key, message, None).to_string();
    let clearance_m = plant.contact.clearance_m;
    let mut warnings = Vec::new();
    let [x, y] = file.start.position_m.0;
    let away = x.hypot(y) / clearance_m;
    if away > DEEP {
        let message = format!("is {away:.0} clearances from the centre; positions are in metres");
        warnings.push(warning("start.position_m", message));
    }
    let [x, y] = file.start.velocity_m_s.0;
    // A rotor of this speed presses a linear wall so far.
    let deep = x.hypot(y) / (plant.contact_rate_rad_s() * clearance_m);
    if deep > DEEP {
        let message = format!(
            "would press the rotor some {deep:.0} clearances deep into the wall; speeds are in m/s"
        );
        warnings.push(warning("start.velocity_m_s", message));
    }
    if file.rotor.eccentricity_m > clearance_m {
        let message = "is larger than the clearance; it is in metres".to_owned();
        warnings.push(warning("rotor.eccentricity_m", message));
    }
    let Some(nominal) = nominal else {
        return warnings;
    };
    let rate = file.run.sample_rate_hz;
    if !SUPERVISED_RATES_HZ.contains(&rate) {
        let message = format!("is {rate}; the supervisor is made for 10 to 50 kHz");
        warnings.push(warning("run.sample_rate_hz", message));
    }
    let values = suggested(nominal).config.values();
    for (parameter, value) in PARAMETERS.iter().zip(values) {
        let name = parameter.name;
        let given = file.supervisor.get(name).filter(|_| GIVEN.contains(&name));
        let given = given.and_then(|v| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)));
        // The table of `advise` holds every bit; what is rounded by hand is meant.
        if let Some(given) = given
            && (given - f64::from(value)).abs() > 0.05 * given.abs().max(f64::from(value).abs())
        {
            let message = format!(
                "is {given}, and the scene's own data say {value}; a table from another scene?"
            );
            warnings.push(warning(&format!("supervisor.{name}"), message));
        }
    }
    warnings
}
