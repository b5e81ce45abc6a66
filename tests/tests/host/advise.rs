//! `advise`: closed forms, the suggested configuration, warnings, and the command line.

mod command;
mod crossover;
mod keys;
mod listing;
mod noise;
mod rotor;
mod shaken;
mod vibration;

use firmware_bench::advise::Advice;
use firmware_bench::scene::Scene;
use firmware_bench::scene::suggest::{Nominal, suggested};
use std::process::Output;
use supervisor::{DefaultRule, PARAMETERS};
use system_tests::{host, root, scene, scene_names, scene_path};

/// The AMB rotor of the theory chapter: 10 kg, −2e5 N/m, 0.2 mm, 1000 N, a 1 kHz amplifier, 20 kHz.
fn amb() -> Nominal {
    Nominal {
        sample_rate_hz: 20e3,
        mass_kg: 10.0,
        stiffness_n_m: -2e5,
        damping_n_s_m: 0.0,
        clearance_m: 2e-4,
        contact_stiffness_n_m: 1e9,
        contact_hardens: false,
        contact_mass_kg: 10.0,
        restitution: Some(0.7),
        friction_coefficient: 0.15,
        rolling_coefficient: 0.0,
        force_max_n: 1000.0,
        axis_force_max_n: None,
        slew_n_s: None,
        lag_s: 1.6e-4,
        delay_samples: 1,
        noise_rms_m: 1e-6,
        quantum_m: 0.0,
        range_m: None,
        load_n: 0.0,
        centre_offset_m: 0.0,
        spin_hz: None,
        runout_m: None,
        retainer_plane_ratio: 1.0,
        magnet_plane_ratio: 1.0,
    }
}

const AMB: [&str; 10] = [
    "--mass-kg=10",
    "--clearance-m=2e-4",
    "--friction=0.15",
    "--stiffness-n-m=-2e5",
    "--contact-stiffness-n-m=1e9",
    "--restitution=0.7",
    "--force-max-n=1000",
    "--lag-s=1.6e-4",
    "--sample-rate-hz=20000",
    "--noise-rms-m=1e-6",
];

fn advice(nominal: &Nominal) -> Advice {
    Advice::new("test", nominal, &[]).unwrap()
}

fn close(value: f64, by_hand: f64) {
    assert!(
        (value / by_hand - 1.0).abs() < 1e-6,
        "{value}, by hand {by_hand}"
    );
}

fn advise(args: &[&str]) -> Output {
    let out = host().arg("advise").args(args).output();
    out.expect("the host starts")
}

fn stderr(output: &Output) -> String {
    // Long lines are wrapped.
    let text = String::from_utf8_lossy(&output.stderr).replace('│', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn closed_forms_of_a_known_plant() {
    let a = advice(&amb());
    assert_eq!(a.limits.passive_threshold_m_s, None);
    assert!(
        a.limits
            .passive_threshold_text
            .contains("negative stiffness")
    );
    close(a.limits.lift_off_m_s, (2e-4 * 960.0 / 10.0_f64).sqrt());
    // (4.12) on the orbit r = c + F/(μ·√(1 + μ²)·k_c).
    let tilt = (1.0 + 0.15_f64.powi(2)).sqrt();
    let r = 2e-4 + 1000.0 / (0.15 * tilt * 1e9);
    let limit = (r / (0.15 * 10.0) * (1000.0 * tilt - 0.15 * 2e5 * r)).sqrt();
    close(a.limits.whirl_limit_m_s.unwrap(), limit);
    let omega = limit / r;
    close(
        a.limits.whirl_limit_hz.unwrap(),
        omega / std::f64::consts::TAU,
    );
    // Without damping (4.13) with v_lim for v_T, and longer by about the yielding of the wall, 3.3 % of r at v_lim.
    let time = r / (0.15 * limit) * 0.85_f64.atanh();
    let longer = a.limits.arrest_time_s.unwrap() / time;
    assert!((1.025..1.035).contains(&longer), "{longer}");

    let horizon = 50e-6 + 25e-6 + 160e-6;
    close(a.reaction.detect_to_force_s, horizon);
    close(a.reaction.worst_s, horizon + 50e-6);
    close(a.reaction.ways[1].way_m, 0.3 * horizon);
    let lag = a.lag.unwrap();
    let angle = omega * 75e-6 + (omega * 160e-6).atan();
    close(lag.angle_deg, angle.to_degrees());
    close(lag.friction_angle_deg, 8.530_765_609_948);

    let v = a.impact.unavoidable_m_s;
    close(
        v * v,
        2.0 * 100.0 * (2e-4 - v * horizon) - 2e5 * 4e-8 / 10.0,
    );
    let k = 0.15 * 1.7 / 0.3;
    assert!(
        (a.impact.bounce_gain / k - 1.0).abs() < 1e-6,
        "the restitution is an f32"
    );
    assert!((a.impact.all_bounces_m_s.unwrap() * k / limit - 1.0).abs() < 1e-6);
    assert!((a.impact.first_m_s.unwrap() * 0.15 * 1.7 / limit - 1.0).abs() < 1e-6);
    let v = a.impact.first_compliant_m_s.unwrap();
    let soft = 1.0 + std::f64::consts::FRAC_PI_4 * v / 2e-4 * 1e-4;
    assert!((0.15 * 1.7 * v * soft / limit - 1.0).abs() < 1e-6);
    assert_eq!(a.impact.passive_m_s, None);
    assert!(a.noise.tolerable && a.noise.share < 0.04);
}

/// The paper's onset rig has a threshold: 0.0579 m/s, and 0.082 m/s of radial impact without help.
#[test]
fn a_shaft_gives_a_threshold() {
    let scene = scene("impact_at_40_hz");
    let a = advice(&scene.nominal);
    assert!((a.limits.passive_threshold_m_s.unwrap() - 0.0579).abs() < 5e-5);
    assert!((a.impact.passive_m_s.unwrap() - 0.082).abs() < 5e-4);
    assert_eq!(
        a.noise.reference_m_s,
        a.limits.passive_threshold_m_s.unwrap()
    );
}

/// Without friction nothing drives; with hardly any force nothing can be stopped.
#[test]
fn what_has_no_limit_says_why() {
    let a = advice(&Nominal {
        friction_coefficient: 0.0,
        ..amb()
    });
    assert!(a.limits.whirl_limit_text.contains("drives nothing"));
    assert!(a.limits.whirl_limit_m_s.is_none() && a.impact.first_m_s.is_none() && a.lag.is_none());
    let a = advice(&Nominal {
        force_max_n: 1.0,
        ..amb()
    });
    assert!(a.limits.whirl_limit_text.contains("more than the cap"));
    assert_eq!(a.limits.lift_off_m_s, 0.0);
    assert_eq!(a.impact.unavoidable_m_s, 0.0);
}

/// What is called the most noise and the least rate is tolerable, and a little worse is not.
#[test]
fn the_noise_asked_for_is_enough_and_needed() {
    let most = advice(&amb()).noise.sensor_noise_most_m.unwrap();
    for (noise_rms_m, good) in [(most, true), (1.011 * most, false)] {
        let noise = advice(&Nominal {
            noise_rms_m,
            ..amb()
        })
        .noise;
        assert_eq!(noise.tolerable, good, "{noise_rms_m}");
    }
    let least = advice(&amb()).noise.sample_rate_least_hz.unwrap();
    for (sample_rate_hz, good) in [(least, true), (least / 1.011, false)] {
        let noise = advice(&Nominal {
            sample_rate_hz,
            ..amb()
        })
        .noise;
        assert_eq!(noise.tolerable, good, "{sample_rate_hz}");
    }
}

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
        ("slew", |n, x| n.slew_n_s = Some(x), 1e8, 1e5),
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
        (
            warning.map(|w| format!("{}; {}", w.text, w.remedy)),
            advice.supervisor_table,
        )
    };
    let (said, table) = told(1e-5, None);
    assert!(
        said.unwrap()
            .contains("a touch is not seen; a sensor that reads beyond 0.2316 mm")
    );
    assert!(
        table.contains("1.1                  # clearance; the least there is"),
        "{table}"
    );
    assert!(
        told(2.1e-4, None)
            .0
            .unwrap()
            .contains("rail counts as a position")
    );
    assert_eq!(told(8e-4, None).0, None);
    let (said, _) = told(8e-4, Some(20.0));
    assert!(said.unwrap().contains("set position_limit = 3.80"));
}

/// With the weight fed forward the supervisor may be given the whole cap or what the weight leaves of it; who has done the
/// second is not told to, and neither is taken for a table of another machine.
#[test]
fn what_a_weight_that_is_fed_forward_leaves_is_a_cap() {
    let own = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let with = |force_max_n: f64, fed: bool| {
        let text = own
            .replacen(
                "mass_kg = 10.0",
                "mass_kg = 10.0\ngravity_m_s2 = [0.0, -14.0]",
                1,
            )
            .replacen(
                "[levitation]",
                &format!("[levitation]\nfeed_forward_weight = {fed}"),
                1,
            );
        let text = format!("{text}\n[supervisor]\nforce_max_n = {force_max_n:?}\n");
        let scene = Scene::parse("scene", &text).unwrap();
        let advice = Advice::new("test", &scene.nominal, &scene.overrides).unwrap();
        let load = advice.warnings.into_iter().find(|w| w.key == "load");
        (load.map(|w| w.remedy), scene.warnings)
    };
    let (remedy, warnings) = with(1000.0, true);
    assert!(remedy.unwrap().contains("give the 860.0000 N"));
    assert_eq!(warnings, [""; 0]);
    assert_eq!(with(860.0, true), (None, vec![]));
    for (force_max_n, fed) in [(860.0, false), (700.0, true)] {
        let (_, warnings) = with(force_max_n, fed);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].contains("supervisor.force_max_n"),
            "{warnings:?}"
        );
    }
}

/// Every scene with a supervisor: with the printed table in it its configuration is the suggested one,
/// and without one, too.
#[test]
fn the_pasted_table_gives_the_same_configuration() {
    let mut pasted = 0;
    for name in scene_names() {
        let path = scene_path(&name);
        let scene = Scene::load(&path).unwrap();
        if scene.supervisor.is_none() {
            continue;
        }
        let output = advise(&[path.to_str().unwrap()]);
        assert!(output.status.success(), "{}", stderr(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        let table = &text[text.find("[supervisor]").unwrap()..];
        let own = std::fs::read_to_string(&path).unwrap();
        // What a scene sets itself makes way for the table.
        let (before, rest) = own.split_once("[supervisor]").unwrap_or((&own, ""));
        let after = rest.find("\n[").map_or("", |at| &rest[at..]);
        let with_table = Scene::parse(&name, &format!("{before}\n{after}\n{table}")).unwrap();
        let config = suggested(&scene.nominal).config;
        assert_eq!(with_table.supervisor.unwrap(), config, "{name}");
        if scene.overrides.is_empty() {
            assert_eq!(scene.supervisor.unwrap(), config, "{name}");
        }
        pasted += 1;
    }
    assert!(pasted >= 3, "{pasted}");
}

/// A bearing with awkward numbers: f32 through decimals and back.
#[test]
fn the_table_holds_every_bit() {
    let n = Nominal {
        mass_kg: 1.0 / 3.0,
        clearance_m: 1.234_567_89e-4,
        stiffness_n_m: -98_765.432_1,
        sample_rate_hz: 17_777.7,
        noise_rms_m: 3.333e-7,
        contact_stiffness_n_m: 1.234_567_8e8,
        ..amb()
    };
    let a = advice(&n);
    let config = suggested(&n).config;
    let own = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let scene = Scene::parse("scene", &format!("{own}\n{}", a.supervisor_table)).unwrap();
    assert_eq!(scene.supervisor.unwrap(), config);
    // Against a scene of its own the table says what that replaces.
    let with_own = Advice::new("test", &scene.nominal, &scene.overrides).unwrap();
    assert!(
        with_own
            .supervisor_table
            .contains("(this scene sets 0.33333334)")
    );
    for (p, value) in PARAMETERS.iter().zip(config.values()) {
        let row = a.parameters.iter().find(|r| r.name == p.name).unwrap();
        assert_eq!((row.value, row.unit), (value, p.unit));
        assert!(!row.reason.is_empty(), "{}", p.name);
    }
}

/// Under the heading of its group each parameter has its unit, range, default and text.
fn the_tables_of_parameters_say_what_the_crate_says() {
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/linking.md")).unwrap();
    let (_, tables) = page.split_once("\n## Parameters\n").unwrap();
    for p in PARAMETERS {
        let of_group = tables
            .split("\n### ")
            .find(|part| part.starts_with(&format!("{:?}\n", p.group)));
        let name = format!("`{}`", p.name);
        let mut rows = of_group
            .unwrap()
            .lines()
            .map(|l| l.split(" | ").collect::<Vec<_>>());
        let row = rows.find(|row| row[0].trim_start_matches("| ") == name);
        let row = row.unwrap_or_else(|| panic!("{name} is not of {:?}", p.group));
        let (low, high) = row[2].split_once(" to ").unwrap();
        assert_eq!(
            (row[1], low.parse(), high.parse()),
            (p.unit, Ok(p.low), Ok(p.high)),
            "{name}"
        );
        let default = match p.default {
            DefaultRule::Given => "**given**".to_owned(),
            DefaultRule::Derived(rule) => rule.to_owned(),
            DefaultRule::Constant(value, reason) => {
                let (shown, _) = row[3].split_once(": ").unwrap();
                assert_eq!(shown.parse(), Ok(value), "{name}");
                format!("{shown}: {reason}")
            }
        };
        assert_eq!((row[3], row[4]), (default.as_str(), p.text), "{name}");
    }
}

/// Both tables of the book know every parameter, and the page every warning.
#[test]
fn the_book_says_how_to_choose_every_parameter() {
    for page in ["linking", "advise"] {
        let path = root().join(format!("docs/src/supervisor/{page}.md"));
        let text = std::fs::read_to_string(path).unwrap();
        for p in PARAMETERS {
            let row = format!("`{}`", p.name);
            let in_table = (text.lines()).any(|l| l.starts_with('|') && l.contains(&row));
            assert!(in_table, "{page}.md: {}", p.name);
        }
    }
    the_tables_of_parameters_say_what_the_crate_says();
    let source = std::fs::read_to_string(root().join("firmware-host/bench/src/advise/warnings.rs"));
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/advise.md")).unwrap();
    let source = source.unwrap();
    let keys: Vec<&str> = (source.split("warning(").skip(1))
        .filter_map(|rest| rest.trim_start().strip_prefix('"')?.split('"').next())
        .collect();
    assert_eq!(keys.len(), 13, "{keys:?}");
    for key in keys {
        assert!(page.contains(&format!("| `{key}` |")), "{key}");
    }
}
