//! What is warned of, and what is suggested where it would be.

use super::{advice, amb};
use firmware_bench::advise::Advice;
use firmware_bench::scene::Scene;
use firmware_bench::scene::suggest::{Nominal, suggested};
use supervisor::PARAMETERS;
use system_tests::ran::{edited, has, scene_text};

/// Each warning by one change of a plant that has none but the one of almost every bearing, on either
/// side of its threshold.
#[test]
fn warnings_appear_when_they_should() {
    // A lag below atan μ needs a fast amplifier, no delay and much friction.
    let quiet = Nominal {
        lag_s: 1e-5,
        delay_samples: 0,
        friction_coefficient: 0.3,
        ..amb()
    };
    let keys =
        |n: &Nominal| -> Vec<&'static str> { advice(n).warnings.iter().map(|w| w.key).collect() };
    assert!(keys(&quiet).is_empty(), "{:?}", keys(&quiet));
    type Edit = fn(&mut Nominal, f64);
    let cases: [(&str, Edit, f64, f64); 13] = [
        ("cap_below_load", |n, x| n.load_n = x, 999.0, 1000.0),
        (
            "cap_below_stiffness",
            |n, x| n.stiffness_n_m = x,
            -4.99e6,
            -5e6,
        ),
        ("rate", |n, x| n.sample_rate_hz = x, 10e3, 9.9e3),
        ("rate", |n, x| n.sample_rate_hz = x, 50e3, 50.1e3),
        ("slow_reaction", |n, x| n.lag_s = x, 9.7e-4, 9.8e-4),
        ("noise", |n, x| n.noise_rms_m = x, 5e-6, 1.45e-5),
        ("lag_drives", |n, x| n.lag_s = x, 1.5e-4, 3.5e-4),
        ("slew", |n, x| n.slew_n_s = Some(x), 1e8, 8e5),
        ("load", |n, x| n.load_n = x, 99.0, 100.0),
        ("range", |n, x| n.range_m = Some(x), 2.32e-4, 2.31e-4),
        ("range", |n, x| n.range_m = Some(x), 2.5e-4, 2e-4),
        ("range", |n, x| n.range_m = Some(x), 8e-4, 1e-5),
        ("centre_offset", |n, x| n.centre_offset_m = x, 9e-7, 1.1e-6),
    ];
    for (key, edit, without, with) in cases {
        for (value, expected) in [(without, false), (with, true)] {
            let mut n = quiet;
            edit(&mut n, value);
            assert_eq!(
                keys(&n).contains(&key),
                expected,
                "{key} at {value}: {:?}",
                keys(&n)
            );
        }
    }
    // The lag of many samples: useless, and more than the lead.
    for (delay_samples, useless, short) in [(1, false, false), (7, true, false), (7, true, true)] {
        let mut n = Nominal {
            delay_samples,
            lag_s: 1e-3,
            ..amb()
        };
        if !useless {
            n.lag_s = 1e-5;
        }
        n.sample_rate_hz = if short { 10e3 } else { 20e3 };
        assert_eq!(
            keys(&n).contains(&"lag_useless"),
            useless,
            "{delay_samples}"
        );
        assert_eq!(
            keys(&n).contains(&"lead_too_short"),
            short,
            "{delay_samples}"
        );
    }
    for w in advice(&amb()).warnings {
        assert!(!w.text.is_empty() && !w.remedy.is_empty());
    }
}

/// A sensor at its rail measures nothing: the suggested limit is 5 % below it, but in its range, and 20 without a range.
#[test]
fn the_position_limit_is_below_the_rail() {
    for (range_m, limit) in [
        (None, 20.0),
        (Some(8e-4), 3.8),
        (Some(2.5e-4), 1.1875),
        (Some(2e-4), 1.1),
        (Some(1.0), 20.0),
    ] {
        let nominal = Nominal { range_m, ..amb() };
        let given = suggested(&nominal).config.position_limit;
        assert!((given - limit).abs() < 1e-6, "{range_m:?}: {given}");
    }
}

/// A sensor that does not reach the wall, one that reaches hardly farther, and a limit beyond a rail that is far enough.
#[test]
fn a_sensor_that_does_not_see_the_wall_is_told() {
    let told = |range_m: f64, limit: Option<f32>| {
        let nominal = Nominal {
            range_m: Some(range_m),
            ..amb()
        };
        let index = PARAMETERS.iter().position(|p| p.name == "position_limit");
        let set: Vec<_> = limit
            .map(|limit| (index.unwrap(), limit))
            .into_iter()
            .collect();
        let advice = Advice::new("test", &nominal, &set).unwrap();
        let warning = advice.warnings.iter().find(|w| w.key == "range");
        let said = warning.map(|w| format!("{}; {}", w.text, w.remedy));
        (said.unwrap_or_default(), advice.supervisor_table)
    };
    let (said, table) = told(1e-5, None);
    has(
        &said,
        &["a touch is not seen; a sensor that reads beyond 0.2316 mm"],
    );
    has(
        &table,
        &["1.1                  # clearance; the least there is"],
    );
    has(&told(2.1e-4, None).0, &["rail counts as a position"]);
    assert_eq!(told(8e-4, None).0, "");
    has(&told(8e-4, Some(20.0)).0, &["set position_limit = 3.80"]);
}

/// With the weight fed forward the supervisor may be given the whole cap or what the weight leaves of it; who has done the
/// second is not told to, and neither is taken for a table of another machine.
#[test]
fn what_a_weight_that_is_fed_forward_leaves_is_a_cap() {
    let own = scene_text("overload_then_release");
    let with = |force_max_n: f64, fed: bool| {
        let fed = format!("[levitation]\nfeed_forward_weight = {fed}");
        let heavy = "mass_kg = 10.0\ngravity_m_s2 = [0.0, -14.0]";
        let text = edited(&own, &[("mass_kg = 10.0", heavy), ("[levitation]", &fed)]);
        let text = format!("{text}\n[supervisor]\nforce_max_n = {force_max_n:?}\n");
        let scene = Scene::parse("scene", &text).unwrap();
        let plane = &scene.planes[0];
        let advice = Advice::new("test", &plane.nominal, &plane.overrides).unwrap();
        let load = advice.warnings.into_iter().find(|w| w.key == "load");
        (load.map(|w| w.remedy), scene.warnings)
    };
    let (remedy, warnings) = with(1000.0, true);
    has(&remedy.unwrap(), &["give the 860.0000 N"]);
    assert_eq!(warnings, [""; 0]);
    assert_eq!(with(860.0, true), (None, vec![]));
    for (force_max_n, fed) in [(860.0, false), (700.0, true)] {
        let (_, warnings) = with(force_max_n, fed);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        has(&warnings[0], &["supervisor.force_max_n"]);
    }
}
