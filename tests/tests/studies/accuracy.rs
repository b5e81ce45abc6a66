//! `accuracy`: error against run time, references, silently wrong runs, and the benchmark's scene files.

use plant_model::V2;
use plant_model::machine::params::MachineStart;
use plant_model::params::{RingParams, StatorParams};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;
use system_tests::plants::{bouncing, bouncing_start};
use system_tests::{host, scene, scene_path};
use tempfile::TempDir;

fn accuracy(scenes: &[&Path], more: &[&str]) -> (Output, Value) {
    let result = host()
        .arg("accuracy")
        .args(scenes)
        .arg("--json")
        .args(more)
        .output()
        .expect("the host starts");
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert!(result.status.success(), "{error}");
    let printed = serde_json::from_slice(&result.stdout).expect("JSON");
    (result, printed)
}

/// Rows with stable keys, an error that follows the tolerance, no wrong runs, and a plot of all problems.
#[test]
fn errors_follow_the_tolerance_and_no_run_is_wrong() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scenes = ["benchmark_b1", "benchmark_b3a"].map(scene_path);
    let out_text = out.to_string_lossy().into_owned();
    let (_, printed) = accuracy(&[&scenes[0], &scenes[1]], &["--out", &out_text]);
    let references = printed["references"].as_array().unwrap();
    assert_eq!(references.len(), 2);
    for reference in references {
        assert_eq!(reference["confirmed"], true);
        assert_eq!(
            reference["methods"],
            serde_json::json!(["series", "collocation"])
        );
        assert_eq!(reference["same_modes"], true);
        assert!(reference["uncertainty"].as_f64().unwrap() < 1e-9);
    }
    let rows = printed["rows"].as_array().unwrap();
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
        let number = |key: &str| row[key].as_f64().unwrap();
        // The series keeps the tolerance; collocation goes by the ends of its steps.
        let allowed = if row["method"] == "series" {
            3.0
        } else {
            2000.0
        };
        assert!(number("error") < allowed * number("rtol"), "{row}");
    }
    let wrong = printed["wrong_runs"].as_array().unwrap();
    assert_eq!(wrong.len(), 10, "five tolerances for each problem");
    for row in wrong {
        let number = |key: &str| row[key].as_f64().unwrap();
        // A start speed in a hundred may be too near to another sequence of modes to be decided.
        assert!(number("left_out") <= 4.0, "{row}");
        assert_eq!(number("of") + number("left_out"), 400.0);
        assert_eq!(number("failed"), 0.0, "{row}");
        let allowed = if number("rtol") > 1e-5 { 2.0 } else { 0.0 };
        assert!(number("wrong") <= allowed, "{row}");
    }
    assert_eq!(printed["not_swept"].as_array().unwrap().len(), 0);
    let plot = fs::read_to_string(out.join("accuracy.html")).unwrap();
    assert_eq!(plot.matches("<svg").count(), references.len());
    for reference in references {
        let title = reference["problem"].as_str().unwrap();
        assert!(plot.contains(title), "{title} is not in the page");
    }
    assert!(out.join("accuracy.json").exists());
}

/// A frictionless, undamped rotor under a heavy load bounces into chaos: two methods end in different
/// places, and errors against either mean nothing.
#[test]
fn an_unconfirmed_reference_gives_no_errors() {
    let folder = TempDir::new().unwrap();
    let chaotic = folder.path().join("chaotic.toml");
    let text = fs::read_to_string(scene_path("benchmark_b1")).unwrap();
    let text = text
        .replace("damping_n_s_m = 200.0", "gravity_m_s2 = [40.0, -300.0]")
        .replace("damping_n_s_m = 3162.2776601683795", "")
        .replace("coefficient = 0.3", "coefficient = 0.0")
        .replace("duration_s = 0.2", "duration_s = 0.7");
    fs::write(&chaotic, text).unwrap();
    let (result, printed) = accuracy(&[&chaotic], &["--wrong-runs", "never"]);
    assert_eq!(printed["references"][0]["confirmed"], false, "{printed}");
    for row in printed["rows"].as_array().unwrap() {
        assert!(row["error"].is_null(), "{row}");
    }
    let warning = String::from_utf8_lossy(&result.stderr).into_owned();
    assert!(warning.contains("not confirmed"), "{warning}");
    assert_eq!(printed["wrong_runs"].as_array().unwrap().len(), 0);
    assert_eq!(printed["not_swept"][0]["reason"], "not asked for");
}

/// A scene at rest has one start only.
#[test]
fn a_scene_at_rest_is_not_swept() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("rest.toml");
    let text = fs::read_to_string(scene_path("benchmark_b3a")).unwrap();
    let text = text
        .replace("velocity_m_s = [0.3, 0.0]", "position_m = [2e-4, 0.0]")
        .replace("duration_s = 0.02", "duration_s = 0.002");
    fs::write(&path, text).unwrap();
    let (_, printed) = accuracy(&[&path], &["--wrong-runs", "always"]);
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
    let path = scene_path("benchmark_b1");
    let result = host()
        .arg("accuracy")
        .args([&path, &path])
        .output()
        .expect("the host starts");
    assert_eq!(result.status.code(), Some(2));
    assert!(result.stdout.is_empty());
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(error.contains("two scenes have the title"), "{error}");
}

/// A run that cannot be trusted is told from the others by scene, method and tolerance.
#[test]
fn a_failed_run_says_which_it_was() {
    let folder = TempDir::new().unwrap();
    let thrown = folder.path().join("thrown.toml");
    let text = fs::read_to_string(scene_path("benchmark_b1")).unwrap();
    let force = "[[disturbance]]\nstart_s = 0.0\nduration_s = 0.1\nforce_n = [1e9, 0.0]\n";
    fs::write(&thrown, format!("{text}\n{force}")).unwrap();
    let result = host()
        .arg("accuracy")
        .arg(&thrown)
        .output()
        .expect("the host starts");
    assert_eq!(result.status.code(), Some(1));
    let error = String::from_utf8_lossy(&result.stderr);
    for part in [
        "\"Benchmark B1: bouncing into rolling\"",
        "series, rtol 1e-13",
        "far beyond its stator",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
}
