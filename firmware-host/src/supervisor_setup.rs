//! Configuration of the supervisor from the scene's nominal plant data, with the scene's overrides.

use crate::scene_error::{SceneError, SceneText, with_guess};
use crate::scene_file::SceneFile;
use plant_model::params::PlantParams;
use supervisor::{Config, PARAMETERS};

/// Where the suggested value of a parameter comes from.
const SOURCES: [(&str, &str); 18] = [
    ("sample_period_s", "run.sample_rate_hz"),
    ("mass_kg", "rotor.mass_kg"),
    ("stiffness_n_m", "rotor"),
    ("damping_n_s_m", "rotor"),
    ("clearance_m", "contact.clearance_m"),
    ("force_max_n", "magnet.force_max_n"),
    ("amplifier_lag_s", "magnet.lag_s"),
    ("delay_samples", "magnet.delay_samples"),
    ("friction_coefficient", "friction.coefficient"),
    ("restitution", "contact.restitution"),
    ("contact_band", "sensor"),
    ("whirl_time_s", "contact.stiffness_n_m"),
    ("axis_force_max_n", "magnet.force_max_n"),
    ("force_slew_n_s", "magnet.force_max_n"),
    ("continuous_force_n", "magnet.force_max_n"),
    ("contact_stiffness_n_m", "contact.stiffness_n_m"),
    ("speed_max_m_s", "contact.stiffness_n_m"),
    ("sensor_step_m", "sensor"),
];

/// Derives the configuration as an engineer would from data sheets; a key of the same name in
/// `[supervisor]` replaces a value.
pub(crate) fn config(
    plant: &PlantParams,
    file: &SceneFile,
    text: &SceneText,
) -> Result<Config, SceneError> {
    let mut values = suggested(plant, file).values();
    for (key, value) in &file.supervisor {
        let path = format!("supervisor.{key}");
        let Some(index) = PARAMETERS.iter().position(|p| p.name == key) else {
            let names: Vec<&str> = PARAMETERS.iter().map(|p| p.name).collect();
            let help = format!("parameters are {}", names.join(", "));
            let help = with_guess(help, key, names);
            return Err(text.error_at_key(&path, "unknown parameter".to_owned(), Some(help)));
        };
        let number = value
            .as_float()
            .or_else(|| value.as_integer().map(|i| i as f64));
        let Some(number) = number else {
            let help = Some(format!("unit: {}", PARAMETERS[index].unit));
            return Err(text.error_at_key(&path, "expected a number".to_owned(), help));
        };
        values[index] = number as f32;
    }
    let config = Config::from_values(values);
    config.validate().map_err(|e| {
        let name = e.parameter.name;
        let given = file.supervisor.contains_key(name);
        let source = SOURCES.iter().find(|(n, _)| *n == name && !given);
        let Some((_, source)) = source else {
            let path = format!("supervisor.{name}");
            return text.error_at_key(&path, e.to_string(), Some(e.parameter.text.to_owned()));
        };
        let message = format!("the supervisor derives {e} from this");
        let help = format!("correct {source}, set {name} in [supervisor], or drop the policy");
        text.error_at_key(source, message, Some(help))
    })?;
    Ok(config)
}

fn suggested(plant: &PlantParams, file: &SceneFile) -> Config {
    let period_s = 1.0 / file.run.sample_rate_hz;
    let contact_rate = plant.contact_rate_rad_s();
    let noise_share =
        file.sensor.noise_rms_m.max(file.sensor.quantum_m) / plant.contact.clearance_m;
    let mass = plant.rotor.mass_kg;
    let force_max_n = plant.magnet.map_or(0.0, |m| m.force_max_n);
    // Noise of the estimated speed in units of the speed that the force can still lift off.
    let sensor = &file.sensor;
    let noise_m = (sensor.noise_rms_m.powi(2) + sensor.quantum_m.powi(2) / 12.0).sqrt();
    let lift_off_m_s = (force_max_n * plant.contact.clearance_m / mass).sqrt();
    let noise = noise_m / period_s / lift_off_m_s;
    let clearance_m = plant.contact.clearance_m;
    let magnet = file.magnet.as_ref();
    // What the magnet does not limit is limited by nothing that matters.
    let axis_force_max_n = magnet
        .and_then(|m| m.axis_force_max_n)
        .unwrap_or(force_max_n);
    let slew_n_s = magnet
        .and_then(|m| m.slew_n_s)
        .unwrap_or((1e3 * force_max_n / period_s).max(1.0));
    Config {
        sample_period_s: period_s as f32,
        mass_kg: mass as f32,
        stiffness_n_m: plant.rotor.stiffness_n_m as f32,
        damping_n_s_m: plant.rotor.damping_n_s_m as f32,
        clearance_m: plant.contact.clearance_m as f32,
        force_max_n: force_max_n as f32,
        amplifier_lag_s: plant.magnet.map_or(0.0, |m| m.lag_s) as f32,
        // An old position is the same to it as a late force.
        delay_samples: (file.magnet.as_ref().map_or(1, |m| m.delay_samples)
            + file.sensor.delay_samples) as f32,
        friction_coefficient: plant.friction.sliding.coefficient(0.0) as f32,
        restitution: file.contact.restitution.unwrap_or(0.7).min(0.95) as f32,
        observer_pole_flight: pole_for(noise, 0.5, second_order_noise),
        observer_pole_contact: pole_for(noise, 0.2, first_order_noise),
        contact_band: (4.0 * noise_share).max(0.01) as f32,
        position_limit: 20.0,
        // Two half periods on the contact spring, but no less than a millisecond.
        whirl_time_s: (std::f64::consts::TAU / contact_rate).max(1e-3) as f32,
        hold_share: 0.8,
        handover_dwell_s: 5e-4,
        handover_blend_s: 2e-3,
        fault_blend_s: 1e-3,
        fault_ticks: 10.0,
        axis_force_max_n: axis_force_max_n as f32,
        force_slew_n_s: slew_n_s as f32,
        continuous_force_n: force_max_n as f32,
        thermal_time_s: 5.0,
        contact_stiffness_n_m: plant.contact.stiffness_n_m() as f32,
        // Several periods of a whirl of some hundred hertz; the stop of the machine takes far longer.
        coast_down_s: 5e-3,
        severity_limit: 20.0,
        retainer_plane_ratio: 1.0,
        magnet_plane_ratio: 1.0,
        // Whirl is no faster than the rotor on the contact spring; half more for its deflection.
        speed_max_m_s: (1.5 * clearance_m * contact_rate).max(2.0) as f32,
        // A sensor without noise and steps is not a thing that gets stuck.
        sensor_step_m: (sensor.noise_rms_m.max(sensor.quantum_m)).max(5e-4 * clearance_m) as f32,
    }
}

/// Speed noise over position noise per tick of the critically damped filters with a pole ρ: the
/// known variances of fading-memory filters of second …
fn second_order_noise(p: f64) -> f64 {
    ((1.0 - p).powi(3) / (1.0 + p).powi(5) * (13.0 + 50.0 * p + 49.0 * p * p) / 2.0).sqrt()
}

/// … and of first order.
fn first_order_noise(p: f64) -> f64 {
    (2.0 * ((1.0 - p) / (1.0 + p)).powi(3)).sqrt()
}

/// The quickest pole, not below `quickest`, whose speed noise is at most a share of the lift-off
/// speed that the laws do not feel.
fn pole_for(noise: f64, quickest: f64, gain: fn(f64) -> f64) -> f32 {
    const TOLERABLE: f64 = 0.04;
    let mut pole = quickest;
    while pole < 0.97 && noise * gain(pole) > TOLERABLE {
        pole += 0.01;
    }
    pole as f32
}
