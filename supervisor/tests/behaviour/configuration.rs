//! A configuration: from nine numbers, valid for all that a bearing may be; refused by name for all that it may not.

use proptest::prelude::*;
use std::hint::black_box;
use supervisor::{
    Bearing, Config, ConfigError, DefaultRule, Events, PARAMETERS, PlanePositions, RULES,
    RotorSupervisor, Sample, Shaft, ShaftError, Supervisor,
};
use test_support::bearing::bearing;
use test_support::rig::{config, config_with, sample, shaft};

const EXAMPLE: Bearing = bearing([50e-6, 10.0, -2e5, 2e-4, 1000.0, 1.6e-4, 0.15, 1e9, 1e-6]);

/// The parameters that the numbers are given under, and the noise at the end.
const NAMES: [&str; 9] = [
    "sample_period_s",
    "mass_kg",
    "stiffness_n_m",
    "clearance_m",
    "force_max_n",
    "amplifier_lag_s",
    "friction_coefficient",
    "contact_stiffness_n_m",
    "sensor_step_m",
];

fn with_value(config: &Config, index: usize, value: f32) -> Config {
    let mut values = config.values();
    values[index] = value;
    Config::from_values(values)
}

fn range(name: &str) -> [f32; 2] {
    let row = PARAMETERS.iter().find(|p| p.name == name).unwrap();
    [row.low, row.high]
}

/// Both ends often, what lies between on the scale of the number.
fn within([low, high]: [f32; 2], share: f32) -> f32 {
    let inside = match low > 0.0 {
        true => low * (high / low).powf(share),
        false => low + share * (high - low),
    };
    match share {
        ..0.1 => low,
        0.9.. => high,
        _ => inside.clamp(low, high),
    }
}

/// Numbers of a bearing in their ranges.
fn any_numbers() -> impl Strategy<Value = [f32; 9]> {
    prop::array::uniform9(0.0..=1.0_f32).prop_map(|shares| {
        let mut numbers = [0.0; 9];
        for ((number, name), share) in numbers.iter_mut().zip(NAMES).zip(shares) {
            *number = within(range(name), share);
        }
        let most_m = (0.07 * bearing(numbers).clearance_m).min(1e-3);
        numbers[8] = match shares[8] {
            ..0.1 => 0.0,
            share => within([1e-10, most_m], share),
        };
        numbers
    })
}

/// Speed over position noise per tick, as the observer's page has them.
fn gain(p: f64, in_flight: bool) -> f64 {
    match in_flight {
        true => {
            let square =
                (1.0 - p).powi(3) / (1.0 + p).powi(5) * (13.0 + 50.0 * p + 49.0 * p * p) / 2.0;
            square.sqrt()
        }
        false => (2.0 * ((1.0 - p) / (1.0 + p)).powi(3)).sqrt(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Valid but for contradictions, and what a supervisor can be made of; the nine numbers are in it as they are, and known rules hold.
    #[test]
    fn nine_numbers_in_their_ranges_give_a_valid_configuration(numbers in any_numbers()) {
        let b = bearing(numbers);
        let config = Config::for_bearing(&b);
        let refused = config.validate().err();
        prop_assert!(refused.is_none_or(|error| error.contradiction.is_some()), "{:?}", b);
        for ((p, value), name) in PARAMETERS.iter().zip(config.values()).filter(|(p, _)| p.default == DefaultRule::Given).zip(NAMES) {
            prop_assert_eq!(p.name, name);
            let given = numbers[NAMES.iter().position(|n| *n == name).unwrap()];
            prop_assert_eq!(value.to_bits(), given.to_bits());
        }
        if refused.is_none() {
            let mut supervisor = Supervisor::<16>::new(&config).unwrap();
            prop_assert!(supervisor.tick(&Sample::default()).force_n.iter().all(|f| f.is_finite()));
        }

        let close = |value: f32, wanted: f64| (f64::from(value) / wanted - 1.0).abs() < 1e-6;
        let rate = (f64::from(b.contact_stiffness_n_m) / f64::from(b.mass_kg)).sqrt();
        prop_assert!(close(config.whirl_time_s, (std::f64::consts::TAU / rate).clamp(1e-3, 0.1)));
        prop_assert!(close(config.speed_max_m_s, (1.5 * f64::from(b.clearance_m) * rate).clamp(2.0, 1e3)));
        let band = 4.0 * f64::from(b.sensor_noise_m) / f64::from(b.clearance_m);
        prop_assert!(close(config.contact_band, band.max(0.01)));
    }

    /// The quickest poles in hundredths with which the speed is quiet enough, by the formulas in double precision.
    #[test]
    fn poles_are_the_quickest_that_are_quiet(numbers in any_numbers()) {
        let b = bearing(numbers);
        let config = Config::for_bearing(&b);
        let force_speed = (f64::from(b.force_max_n) * f64::from(b.clearance_m) / f64::from(b.mass_kg)).sqrt();
        let noise = f64::from(b.sensor_noise_m) / f64::from(b.sample_period_s) / force_speed;
        for (pole, quickest, in_flight) in [
            (config.observer_pole_flight, 50, true),
            (config.observer_pole_contact, 20, false),
        ] {
            let hundredths = (100.0 * pole).round() as i32;
            prop_assert_eq!(pole, hundredths as f32 / 100.0);
            let speed = |hundredths: i32| noise * gain(f64::from(hundredths) / 100.0, in_flight);
            prop_assert!(hundredths == 97 || speed(hundredths) <= 0.04 * (1.0 + 1e-5), "{:?}: {}", b, pole);
            prop_assert!(hundredths == quickest || speed(hundredths - 1) > 0.04 * (1.0 - 1e-5), "{:?}: {}", b, pole);
        }
    }

    /// Whatever the bits: what is refused is refused by the name of the first number that is outside its range.
    #[test]
    fn any_bits_are_accepted_or_refused_by_their_name(
        mut numbers in any_numbers(),
        bits in prop::array::uniform9(any::<u32>()),
        taken in prop::array::uniform9(prop::bool::weighted(0.2)),
    ) {
        for ((number, bits), taken) in numbers.iter_mut().zip(bits).zip(taken) {
            if taken {
                *number = f32::from_bits(bits);
            }
        }
        let b = bearing(numbers);
        let wrong = NAMES.iter().zip(numbers).find(|(name, value)| {
            let [low, high] = range(name);
            // No sensor need have any noise.
            let low = if **name == "sensor_step_m" { 0.0 } else { low };
            !(*value >= low && *value <= high)
        });
        let refused = match Config::for_bearing(&b).validate() {
            Err(error) if error.contradiction.is_none() => Err(error.parameter().name),
            _ => Ok(()),
        };
        // A noise that is much for the clearance is reported by the band, which the table has before the contact's stiffness.
        let in_doubt = f64::from(b.sensor_noise_m) > 0.07 * f64::from(b.clearance_m);
        let by_band = refused == Err("contact_band");
        match wrong.map(|(name, _)| *name) {
            Some("contact_stiffness_n_m") | None if in_doubt && by_band => {}
            Some(name) => prop_assert_eq!(refused, Err(name), "{:?}", b),
            None => prop_assert_eq!(refused, Ok(()), "{:?}", b),
        }
    }

    /// A plane of a rotor is the plane of its mass, and the rotor takes the configurations as they are.
    #[test]
    fn planes_of_a_rotor_follow_from_its_shaft(
        share in 0.1..0.9_f32,
        mass_kg in 0.1..1e3_f32,
        numbers in any_numbers(),
    ) {
        let b = bearing(numbers);
        let ends = [b, Bearing { friction_coefficient: 0.3, sensor_noise_m: 0.5 * b.sensor_noise_m, ..b }];
        let end = |retainer_m: f32| PlanePositions { retainer_m, sensor_m: 0.95 * retainer_m, magnet_m: 0.9 * retainer_m };
        let shaft = Shaft {
            mass_kg,
            transverse_inertia_kg_m2: 0.05 * mass_kg,
            polar_inertia_kg_m2: 0.03 * mass_kg,
            places: [end(-share), end(1.0 - share)],
        };
        let configs = Config::for_rotor(&shaft, &ends);
        let made = RotorSupervisor::<16>::new(&shaft, &configs).map(drop);
        let contradicts = |error: &ConfigError| error.contradiction.is_some();
        match made {
            Err(ShaftError::Plane(_, error)) if contradicts(&error) => {}
            made => prop_assert_eq!(made, Ok(()), "{:?}", configs),
        }
        for (plane, (config, b)) in configs.iter().zip(&ends).enumerate() {
            let alone = Config::for_bearing(&Bearing { mass_kg: config.mass_kg, ..*b });
            prop_assert_eq!(*config, shaft.plane(plane, &alone));
            prop_assert!(config.mass_kg < mass_kg);
        }
    }
}

/// The example of the crate is a configuration from nine numbers with what the drive says of itself, of which no machine is asked.
#[test]
fn the_example_follows_from_nine_numbers() {
    let config = Config {
        force_slew_n_s: 1e7,
        continuous_force_n: 400.0,
        check_first: 0.0,
        ..Config::for_bearing(&EXAMPLE)
    };
    assert_eq!(config, Config::example());
}

/// A constant, which the compiler computes, has the bits that the processor gives it.
#[test]
fn a_constant_has_the_same_bits() {
    const NOISY: Bearing = Bearing {
        sensor_noise_m: 3.3e-6,
        mass_kg: 7.3,
        ..EXAMPLE
    };
    const CONSTANTS: [Config; 2] = [Config::for_bearing(&EXAMPLE), Config::for_bearing(&NOISY)];
    let now = [EXAMPLE, NOISY].map(|b| Config::for_bearing(&black_box(b)));
    let bits = |configs: [Config; 2]| configs.map(|c| c.values().map(f32::to_bits));
    assert_eq!(bits(now), bits(CONSTANTS));
}

/// The table says what is there: constants are the same for two bearings that have nothing in common, and all else is not.
#[test]
fn the_table_has_the_defaults() {
    let other = bearing([1e-4, 2.0, 3e4, 5e-4, 77.0, 1e-3, 0.3, 2e7, 2e-5]);
    let values = [EXAMPLE, other].map(|b| Config::for_bearing(&b).values());
    for (i, p) in PARAMETERS.iter().enumerate() {
        let [a, b] = values.map(|v| v[i]);
        match p.default {
            DefaultRule::Constant(value, reason) => {
                assert_eq!([a, b], [value; 2], "{}", p.name);
                assert!(!reason.is_empty());
            }
            DefaultRule::Given => assert!(NAMES.contains(&p.name) && a != b, "{}", p.name),
            DefaultRule::Derived(rule) => assert!(a != b && !rule.is_empty(), "{}", p.name),
        }
    }
}

/// Every parameter is refused just outside its range and for NaN, and named.
/// Requirement: SR-28
#[test]
fn config_errors_name_field_value_and_range() {
    for (i, p) in PARAMETERS.iter().enumerate() {
        let below = p.low - p.low.abs().max(1e-3);
        for wrong in [f32::NAN, f32::INFINITY, below, p.high * 2.0 + 1.0] {
            let error = with_value(&config(), i, wrong).validate().unwrap_err();
            assert_eq!(error.parameter().name, p.name);
            let text = error.to_string();
            // Both ends, as a person would write them.
            let (_, range) = text.split_once("expected ").unwrap();
            let words: Vec<&str> = range.split(' ').collect();
            let ends = (words[0].parse(), words[2].parse());
            assert_eq!(ends, (Ok(p.low), Ok(p.high)));
            assert!(words[0].len().max(words[2].len()) <= 6, "{text}");
            assert!(text.starts_with(p.name), "{text}");
        }
        for edge in [p.low, p.high] {
            // In its range, and refused at most beside another.
            let refused = with_value(&config(), i, edge).validate().err();
            let beside = refused.is_none_or(|error| error.contradiction.is_some());
            assert!(beside, "{} at {edge}", p.name);
        }
    }
}

/// A slip of a power of ten, in its own range, is refused by both names.
/// Requirement: SR-28
#[test]
fn a_slip_that_contradicts_another_value_names_both() {
    // Its poles are slow.
    let noisy = Bearing {
        sensor_noise_m: 2.5e-6,
        ..EXAMPLE
    };
    let mut noisy = Config::for_bearing(&noisy);
    noisy.force_slew_n_s = 5e5;
    assert_eq!(noisy.validate(), Ok(()));
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
        let index = PARAMETERS.iter().position(|p| p.name == name).unwrap();
        let slip = with_value(&noisy, index, factor * noisy.values()[index]);
        let error = slip.validate().unwrap_err();
        let text = error.to_string();
        let named = text.contains(name) && text.contains(other);
        assert!(named, "{name}: {text}");
        let rule = error.rule().unwrap();
        let both = [rule.index, rule.other].map(|i| PARAMETERS[i].name);
        assert!(both.contains(&name) && both.contains(&other), "{text}");
        // What the text says is left is left.
        let broken = error.contradiction.unwrap();
        let left = with_value(&slip, rule.index, broken.limit).validate().err();
        let left = left.and_then(|e| e.contradiction);
        assert!(left.is_none_or(|c| c.rule > broken.rule), "{text}");
    }
    assert_eq!(RULES.len(), 6);
}

/// A parameter out of range changes nothing.
/// Requirement: SR-28
#[test]
fn a_refused_configuration_leaves_everything_as_it_is() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let wrong = config_with(|c| c.mass_kg = -1.0);
    let error = supervisor.reconfigure(&wrong).unwrap_err();
    assert_eq!(error.parameter().name, "mass_kg");
    let command = supervisor.tick(&sample(0, [1e-6, 2e-6]));
    assert_eq!(command.events, Events::empty());
}

/// Requirement: SR-28
#[test]
fn a_shaft_that_no_body_has_is_refused() {
    let good = shaft(&config());
    let [first, second] = good.places;
    let refused = |shaft: Shaft| RotorSupervisor::<16>::new(&shaft, &[config(); 2]).unwrap_err();
    for mass_kg in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(refused(Shaft { mass_kg, ..good }), ShaftError::Inertia);
    }
    for share in [-0.1, 2.1, f32::NAN] {
        let mut wrong = good;
        wrong.polar_inertia_kg_m2 = share * good.transverse_inertia_kg_m2;
        assert_eq!(refused(wrong), ShaftError::Inertia);
    }
    let mut unknown = second;
    unknown.sensor_m = f32::NAN;
    for places in [[first, first], [first, unknown]] {
        assert_eq!(refused(Shaft { places, ..good }), ShaftError::Places);
    }
    // A magnet so far beyond the centre of percussion that it pushes the bearing the other way.
    let mut beyond = second;
    beyond.magnet_m *= -10.0;
    let places = [first, beyond];
    let error = refused(Shaft { places, ..good });
    assert!(matches!(error, ShaftError::Plane(1, _)), "{error}");
    assert!(error.to_string().contains("magnet_plane_ratio"), "{error}");
    // What is refused changes nothing.
    let mut rotor = RotorSupervisor::<16>::new(&good, &[config(); 2]).unwrap();
    let before = rotor.clone();
    let wrong = rotor.reconfigure(&Shaft { places, ..good }, &[config(); 2]);
    assert!(wrong.is_err());
    assert_eq!(format!("{rotor:?}"), format!("{before:?}"));
    assert!(rotor.reconfigure(&good, &[config(); 2]).is_ok());
}
