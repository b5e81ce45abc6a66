//! Values that contradict each other, each in its own range, are refused by both names.

use supervisor::{Bearing, Config, PARAMETERS, RULES};

/// A noisy machine: its poles are slow.
fn noisy() -> Config {
    Config::for_bearing(&Bearing {
        sample_period_s: 5e-5,
        mass_kg: 10.0,
        stiffness_n_m: -2e5,
        clearance_m: 2e-4,
        force_max_n: 1000.0,
        amplifier_lag_s: 1.6e-4,
        friction_coefficient: 0.15,
        contact_stiffness_n_m: 1e9,
        sensor_noise_m: 2.5e-6,
    })
}

/// A slip of a power of ten.
/// Requirement: SR-28
#[test]
fn a_slip_that_contradicts_another_value_names_both() {
    let slips = [
        ("sample_period_s", 10.0, "force_max_n"),
        ("observer_pole_flight", 0.1, "sensor_step_m"),
        ("observer_pole_contact", 0.1, "sensor_step_m"),
        ("sensor_step_m", 10.0, "observer_pole_flight"),
        ("axis_force_max_n", 0.1, "force_max_n"),
        ("force_slew_n_s", 0.1, "force_max_n"),
        ("contact_band", 0.1, "sensor_step_m"),
    ];
    for (name, factor, other) in slips {
        let mut config = noisy();
        config.force_slew_n_s = 5e5;
        assert_eq!(config.validate(), Ok(()));
        let mut values = config.values();
        let index = PARAMETERS.iter().position(|p| p.name == name).unwrap();
        values[index] *= factor;
        let error = Config::from_values(values).validate().unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains(name) && text.contains(other),
            "{name}: {text}"
        );
        let rule = error.rule().unwrap();
        let both = [rule.index, rule.other].map(|i| PARAMETERS[i].name);
        assert!(both.contains(&name) && both.contains(&other), "{text}");
        // What the text says is left is left.
        values = Config::from_values(values).values();
        values[rule.index] = error.contradiction.unwrap().limit;
        let left = Config::from_values(values).validate().err();
        assert!(
            left.and_then(|e| e.contradiction)
                .is_none_or(|c| c.rule > error.contradiction.unwrap().rule),
            "{text}"
        );
    }
    assert_eq!(RULES.len(), 6);
}
