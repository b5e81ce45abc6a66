//! Tables of parameters: the one that is printed to be pasted into a scene, and those of the book.

use super::{advice, advise, amb};
use firmware_bench::advise::Advice;
use firmware_bench::scene::Scene;
use firmware_bench::scene::suggest::{Nominal, suggested};
use supervisor::{DefaultRule, PARAMETERS};
use system_tests::ran::{has, scene_text};
use system_tests::{parameters, root, scene, scene_names};

/// Every scene with a supervisor: with the printed table in it its configuration is the suggested one,
/// and without one, too.
#[test]
fn the_pasted_table_gives_the_same_configuration() {
    let mut pasted = 0;
    for name in scene_names() {
        let scene = scene(&name);
        let plane = &scene.planes[0];
        if plane.supervisor.is_none() {
            continue;
        }
        let text = advise(&format!("@{name}")).good();
        let table = &text[text.find("[supervisor]").unwrap()..];
        let own = scene_text(&name);
        // What a scene sets itself makes way for the table.
        let (before, rest) = own.split_once("[supervisor]").unwrap_or((&own, ""));
        let after = rest.find("\n[").map_or("", |at| &rest[at..]);
        let with_table = Scene::parse(&name, &format!("{before}\n{after}\n{table}")).unwrap();
        let config = suggested(&plane.nominal).config;
        assert_eq!(with_table.planes[0].supervisor.unwrap(), config, "{name}");
        if plane.overrides.is_empty() {
            assert_eq!(plane.supervisor.unwrap(), config, "{name}");
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
    let own = scene_text("overload_then_release");
    let scene = Scene::parse("scene", &format!("{own}\n{}", a.supervisor_table)).unwrap();
    let plane = &scene.planes[0];
    assert_eq!(plane.supervisor.unwrap(), config);
    // Against a scene of its own the table says what that replaces.
    let with_own = Advice::new("test", &plane.nominal, &plane.overrides).unwrap();
    has(
        &with_own.supervisor_table,
        &["(this scene sets 0.33333334)"],
    );
    for (p, value) in PARAMETERS.iter().zip(config.values()) {
        let row = a.parameters.iter().find(|r| r.name == p.name).unwrap();
        assert_eq!((row.value, row.unit), (value, p.unit));
        assert!(!row.reason.is_empty(), "{}", p.name);
    }
}

/// The tables of the book say what the crate says, the page of the advice how all are suggested that are no constant, and every
/// warning.
#[test]
fn the_book_says_how_to_choose_every_parameter() {
    parameters::check(parameters::TABLES);
    let source = std::fs::read_to_string(root().join("firmware-host/bench/src/advise/warnings.rs"));
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/advise.md")).unwrap();
    for p in PARAMETERS {
        let row = format!("`{}`", p.name);
        let in_table = (page.lines()).any(|l| l.starts_with('|') && l.contains(&row));
        let is_constant = matches!(p.default, DefaultRule::Constant(..));
        assert!(in_table || is_constant, "advise.md: {}", p.name);
    }
    let source = source.unwrap();
    let keys: Vec<&str> = (source.split("warning(").skip(1))
        .filter_map(|rest| rest.trim_start().strip_prefix('"')?.split('"').next())
        .collect();
    assert_eq!(keys.len(), 16, "{keys:?}");
    for key in keys {
        assert!(page.contains(&format!("| `{key}` |")), "{key}");
    }
}
