//! `accuracy`: error against run time, references, silently wrong runs, and the benchmark's scene files.

use plant_model::V2;
use plant_model::machine::params::MachineStart;
use plant_model::params::{RingParams, StatorParams};
use serde_json::json;
use system_tests::plants::{bouncing, bouncing_start};
use system_tests::ran::{Folder, Ran, has, list, number, scene_text};
use system_tests::scene;

fn accuracy(folder: &Folder, words: &str) -> Ran {
    folder.ran(&format!("accuracy --json {words}"))
}

/// Rows with stable keys, an error that follows the tolerance, no wrong runs, and a plot of all problems.
#[test]
fn errors_follow_the_tolerance_and_no_run_is_wrong() {
    let folder = Folder::fresh();
    let printed = accuracy(&folder, "@benchmark_b1 @benchmark_b3a --out out").json();
    let references = list(&printed["references"]);
    assert_eq!(references.len(), 2);
    for reference in references {
        assert_eq!(reference["confirmed"], true);
        assert_eq!(reference["methods"], json!(["series", "collocation"]));
        assert_eq!(reference["same_modes"], true);
        assert!(number(&reference["uncertainty"]) < 1e-9);
    }
    let rows = list(&printed["rows"]);
    assert_eq!(rows.len(), 2 * 2 * 9, "problems, methods, tolerances");
    for row in rows {
        for key in ["problem", "method"] {
            assert!(row[key].is_string(), "{key}");
        }
        for key in ["rtol", "error", "seconds", "evaluations", "mode_changes"] {
            assert!(row[key].is_number(), "{key}");
        }
        let first = row["problem"] == references[0]["problem"];
        assert_eq!(row["mode_changes"], if first { 6 } else { 19 });
        // The series keeps the tolerance; collocation goes by the ends of its steps.
        let allowed = match row["method"] == "series" {
            true => 3.0,
            false => 2000.0,
        };
        let [error, rtol] = ["error", "rtol"].map(|key| number(&row[key]));
        assert!(error < allowed * rtol, "{row}");
    }
    let wrong = list(&printed["wrong_runs"]);
    assert_eq!(wrong.len(), 10, "five tolerances for each problem");
    for row in wrong {
        let number = |key: &str| number(&row[key]);
        // A start speed in a hundred may be too near to another sequence of modes to be decided.
        assert!(number("left_out") <= 4.0, "{row}");
        assert_eq!(number("of") + number("left_out"), 400.0);
        assert_eq!(number("failed"), 0.0, "{row}");
        let allowed = if number("rtol") > 1e-5 { 2.0 } else { 0.0 };
        assert!(number("wrong") <= allowed, "{row}");
    }
    assert_eq!(printed["not_swept"], json!([]));
    let plot = folder.text("out/accuracy.html");
    assert_eq!(plot.matches("<svg").count(), references.len());
    for reference in references {
        has(&plot, &[reference["problem"].as_str().unwrap()]);
    }
    assert!(folder.at("out/accuracy.json").exists());
}

/// A frictionless, undamped rotor under a heavy load bounces into chaos: two methods end in different
/// places, and errors against either mean nothing.
#[test]
fn an_unconfirmed_reference_gives_no_errors() {
    let folder = Folder::fresh();
    let chaos = [
        ("damping_n_s_m = 200.0", "gravity_m_s2 = [40.0, -300.0]"),
        ("damping_n_s_m = 3162.2776601683795", ""),
        ("coefficient = 0.3", "coefficient = 0.0"),
        ("duration_s = 0.2", "duration_s = 0.7"),
    ];
    folder.scene("chaotic.toml", "benchmark_b1", &chaos);
    let ran = accuracy(&folder, "chaotic.toml --wrong-runs never");
    has(&ran.said, &["not confirmed"]);
    let printed = ran.json();
    assert_eq!(printed["references"][0]["confirmed"], false, "{printed}");
    for row in list(&printed["rows"]) {
        assert!(row["error"].is_null(), "{row}");
    }
    assert_eq!(printed["wrong_runs"], json!([]));
    assert_eq!(printed["not_swept"][0]["reason"], "not asked for");
}

/// A scene at rest has one start only.
#[test]
fn a_scene_at_rest_is_not_swept() {
    let folder = Folder::fresh();
    let at_rest = [
        ("velocity_m_s = [0.3, 0.0]", "position_m = [2e-4, 0.0]"),
        ("duration_s = 0.02", "duration_s = 0.002"),
    ];
    folder.scene("rest.toml", "benchmark_b3a", &at_rest);
    let printed = accuracy(&folder, "rest.toml --wrong-runs always").json();
    assert_eq!(printed["not_swept"][0]["reason"], "starts at rest");
}

fn start() -> MachineStart {
    let start = bouncing_start();
    MachineStart {
        centre_m: start.position_m,
        centre_velocity_m_s: start.velocity_m_s,
        spin_rad_s: start.spin_rad_s,
        spin_phase_rad: start.spin_phase_rad,
        ..MachineStart::default()
    }
}

/// The benchmark's problems as scene files are those of the integrator tests, to the bit.
#[test]
fn benchmark_scenes_are_the_benchmark_problems() {
    let expected = [("benchmark_b1", 1e8), ("benchmark_b2", 1e10)];
    for (name, stiffness_n_m) in expected {
        let scene = scene(name);
        assert_eq!(scene.plant(0), bouncing(stiffness_n_m), "{name}");
        assert_eq!(scene.start, start(), "{name}");
        assert_eq!(scene.duration_s, 0.2);
    }
    let expected = [
        ("benchmark_b3a", 1.0, 2e4),
        ("benchmark_b3b", 1.0, 2e6),
        ("benchmark_b3c", 0.1, 2e6),
    ];
    for (name, ring_kg, damping_n_s_m) in expected {
        let scene = scene(name);
        let mut plant = bouncing(1e10);
        plant.contact.law.linear_mut().unwrap().damping_n_s_m = damping_n_s_m;
        plant.stator = StatorParams::OneMass(RingParams {
            mass_kg: ring_kg,
            stiffness_n_m: V2::repeat(2e7),
            damping_n_s_m: V2::repeat(3000.0),
        });
        assert_eq!(scene.plant(0), plant, "{name}");
        assert_eq!(scene.start, start(), "{name}");
        assert_eq!(scene.duration_s, 0.02);
    }
}

/// Tables, plots and JSON tell problems by their titles, so no two may have the same.
#[test]
fn two_problems_of_one_title_are_refused() {
    let said = Folder::fresh()
        .ran("accuracy @benchmark_b1 @benchmark_b1")
        .refused();
    has(&said, &["two scenes have the title"]);
}

/// A run that cannot be trusted is told from the others by scene, method and tolerance.
#[test]
fn a_failed_run_says_which_it_was() {
    let folder = Folder::fresh();
    let force = "\n[[disturbance]]\nstart_s = 0.0\nduration_s = 0.1\nforce_n = [1e9, 0.0]\n";
    folder.put("thrown.toml", scene_text("benchmark_b1") + force);
    let said = folder.ran("accuracy thrown.toml").fails(1);
    has(&said, &["\"Benchmark B1: bouncing into rolling\""]);
    has(&said, &["series, rtol 1e-13", "far beyond its stator"]);
}
