//! Configuration of the supervisor from the scene's nominal plant data, with the scene's overrides.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::guess;
use crate::scene::keys::{number, parameter};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::plant::hardening_key;
use crate::scene::suggest::{Nominal, suggested};
use plant_model::params::PlantParams;
use supervisor::{Config, ConfigError, PARAMETERS};

/// What a data sheet would say of the scene's bearing.
pub(crate) fn nominal(plant: &PlantParams, spec: &PlaneSpec) -> Nominal {
    let (file, contact) = (&spec.tables, &spec.contact);
    let magnet = file.magnet.as_ref();
    let samples_a_tick = if file.run.planes_in_turn { 2 } else { 1 };
    let delay_samples = magnet.map_or(1, |m| m.delay_samples) + file.sensor.delay_samples;
    Nominal {
        sample_rate_hz: file.run.sample_rate_hz / f64::from(samples_a_tick),
        mass_kg: plant.rotor.mass_kg,
        stiffness_n_m: plant.rotor.stiffness_n_m,
        damping_n_s_m: plant.rotor.damping_n_s_m,
        clearance_m: plant.contact.clearance_m,
        contact_stiffness_n_m: plant.contact.stiffness_n_m(),
        contact_hardens: hardening_key(contact).is_some(),
        contact_mass_kg: plant.contact_mass_kg(),
        restitution: contact.restitution,
        friction_coefficient: plant.friction.sliding.coefficient(0.0),
        rolling_coefficient: plant.friction.rolling_coefficient,
        force_max_n: plant.magnet.map_or(0.0, |m| m.force_max_n),
        axis_force_max_n: magnet.and_then(|m| m.axis_force_max_n),
        slew_n_s: magnet.and_then(|m| m.slew_n_s),
        lag_s: plant.magnet.map_or(0.0, |m| m.lag_s),
        delay_samples: delay_samples.div_ceil(samples_a_tick),
        noise_rms_m: file.sensor.noise_rms_m,
        quantum_m: file.sensor.quantum_m,
        range_m: file.sensor.range_m,
        load_n: plant.rotor.mass_kg * file.rotor.gravity_m_s2.length(),
        centre_offset_m: file.retainer.centre_offset_m.length(),
        spin_hz: Some(file.spin.frequency_hz),
        runout_m: (file.sensor.runout_m > 0.0).then_some(file.sensor.runout_m),
        retainer_plane_ratio: 1.0,
        magnet_plane_ratio: 1.0,
    }
}

/// The keys that the scene gives stiffness and damping by, of those that it may.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NominalKeys {
    stiffness: &'static str,
    damping: &'static str,
    contact_stiffness: &'static str,
}

impl NominalKeys {
    /// The keys that a file's nominal data come from.
    pub(crate) fn new(nominal: &Nominal, spec: &PlaneSpec) -> Self {
        let (file, contact) = (&spec.tables, &spec.contact);
        let rotor = &file.rotor;
        Self {
            stiffness: match (&file.magnet, rotor.natural_frequency_hz) {
                // The magnets' part outweighs the shaft's.
                (Some(_), _) if nominal.stiffness_n_m < 0.0 => "magnet.negative_stiffness_n_m",
                (_, Some(_)) => "rotor.natural_frequency_hz",
                (_, None) => "rotor.stiffness_n_m",
            },
            damping: match rotor.damping_ratio {
                Some(_) => "rotor.damping_ratio",
                None => "rotor.damping_n_s_m",
            },
            contact_stiffness: hardening_key(contact).unwrap_or("contact.stiffness_n_m"),
        }
    }

    /// Key of the scene that a field of [`Nominal`] comes from.
    pub fn key(&self, field: &str) -> &'static str {
        match field {
            "sample_rate_hz" => "run.sample_rate_hz",
            "mass_kg" => "rotor.mass_kg",
            "stiffness_n_m" => self.stiffness,
            "damping_n_s_m" => self.damping,
            "clearance_m" => "contact.clearance_m",
            "contact_stiffness_n_m" => self.contact_stiffness,
            "restitution" => "contact.restitution",
            "friction_coefficient" => "friction.coefficient",
            "force_max_n" => "magnet.force_max_n",
            "axis_force_max_n" => "magnet.axis_force_max_n",
            "slew_n_s" => "magnet.slew_n_s",
            "lag_s" => "magnet.lag_s",
            "delay_samples" => "magnet.delay_samples",
            "noise_rms_m" => "sensor.noise_rms_m",
            "quantum_m" => "sensor.quantum_m",
            "range_m" => "sensor.range_m",
            "retainer_plane_ratio" => "sensor.position_m",
            "magnet_plane_ratio" => "magnet.position_m",
            _ => "rotor",
        }
    }
}

/// A value of `[supervisor]`, by the place of its parameter in [`PARAMETERS`].
pub type Override = (usize, f32);

/// The names and values of overrides.
pub(crate) fn named(overrides: &[Override]) -> impl Iterator<Item = (&'static str, f32)> {
    (overrides.iter()).map(|(index, value)| (PARAMETERS[*index].name, *value))
}

/// A configuration with single values replaced.
pub fn replaced(config: &Config, overrides: &[Override]) -> Config {
    let mut values = config.values();
    for (index, value) in overrides {
        values[*index] = *value;
    }
    Config::from_values(values)
}

/// The parameters that `[supervisor]` gives, each checked by itself: also where the policy is not run, in
/// which case nothing else would look at them.
pub(crate) fn overrides(spec: &PlaneSpec) -> Result<Vec<Override>, SceneError> {
    let (text, supervisor) = (&spec.text, &spec.tables.supervisor);
    let mut given = Vec::with_capacity(supervisor.len());
    for (key, value) in supervisor {
        let path = format!("supervisor.{key}");
        let Some(index) = parameter(key) else {
            let names: Vec<&str> = PARAMETERS.iter().map(|p| p.name).collect();
            let help = format!("parameters are {}", names.join(", "));
            let help = guess::before(help, key, names);
            return Err(text.error_at_key(&path, "unknown parameter".to_owned(), Some(help)));
        };
        let parameter = &PARAMETERS[index];
        let Some(number) = number(value) else {
            let help = Some(format!("unit: {}", parameter.unit));
            return Err(text.error_at_key(&path, "expected a number".to_owned(), help));
        };
        let value = number as f32;
        if !(parameter.low..=parameter.high).contains(&value) {
            let refused = ConfigError {
                index,
                value,
                contradiction: None,
            };
            let help = Some(parameter.text.to_owned());
            return Err(text.error_at_key(&path, refused.to_string(), help));
        }
        given.push((index, value));
    }
    Ok(given)
}

/// The suggested configuration, with single values replaced.
pub(crate) fn config(
    nominal: &Nominal,
    keys: &NominalKeys,
    overrides: &[Override],
    text: &SceneText,
) -> Result<Config, SceneError> {
    let suggested = suggested(nominal);
    let config = replaced(&suggested.config, overrides);
    // What was given is in its range; what is left was derived, or contradicts what was given.
    config.validate().map_err(|e| {
        let name = e.parameter().name;
        if let Some(rule) = e.rule()
            && let Some((given, _)) = (overrides.iter())
                .find(|(index, _)| [rule.index, rule.other].contains(index))
        {
            let path = format!("supervisor.{}", PARAMETERS[*given].name);
            let help = Some(PARAMETERS[*given].text.to_owned());
            return text.error_at_key(&path, e.to_string(), help);
        }
        let Some(source) = suggested.source(name).map(|field| keys.key(field)) else {
            let path = format!("supervisor.{name}");
            return text.error_at_key(&path, e.to_string(), Some(e.parameter().text.to_owned()));
        };
        if name == "delay_samples" {
            // A sum, and the magnet's part of it may not be in the file.
            let message = format!(
                "makes {} samples with magnet.delay_samples; the supervisor makes up for {} at most",
                nominal.delay_samples,
                e.parameter().high
            );
            let help = "shorten one of them, set delay_samples in [supervisor], or drop the policy";
            return text.error_at_key("sensor.delay_samples", message, Some(help.to_owned()));
        }
        let message = format!("the supervisor derives {e} from this");
        let help = format!("correct {source}, set {name} in [supervisor], or drop the policy");
        text.error_at_key(source, message, Some(help))
    })?;
    Ok(config)
}
