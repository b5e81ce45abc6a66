//! `review`: what it finds out of an event, and the event once more on a machine's scene.

use crate::refusals::{all, command_line};
use serde_json::Value;
use std::path::Path;
use std::process::Output;
use system_tests::{host, run_scene, scene_path};
use tempfile::TempDir;

fn review(file: &Path, more: &[&str]) -> Output {
    let mut command = host();
    command.arg("review").arg(file).args(more);
    command.output().expect("the host starts")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// What a load of 1500 N did is found again, and once more with it the plant does nearly the same.
#[test]
fn an_event_is_found_out_and_simulated() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scene = scene_path("overload_then_release");
    assert!(run_scene(&scene, &out, &[]).status.success());
    let file = out.join("record_supervisor.bin");
    let scene = scene.to_str().unwrap();
    let set = "supervisor.hold_share=0.3";
    let shown = review(&file, &["--scene", scene, "--set", set]);
    let text = String::from_utf8(shown.stdout).unwrap();
    assert!(shown.status.success(), "{text}");
    for word in [
        "load along x [N]",
        "not identifiable",
        "The event once more, on: ",
        set,
    ] {
        assert!(text.contains(word), "{word} is not in\n{text}");
    }
    let json = review(&file, &["--json", "--scene", scene, "--set", set]);
    let value: Value = serde_json::from_slice(&json.stdout).unwrap();
    let identified = &value["identified"];
    for (name, truth) in [("load_x_n", 1300.0), ("load_y_n", 750.0)] {
        let [value, low, high] = ["value", "low", "high"].map(|key| number(&identified[name][key]));
        assert!(low <= truth && truth <= high, "{name}: {identified}");
        assert!(
            (value - truth).abs() < 15.0 && high - low < 60.0,
            "{name}: {identified}"
        );
    }
    // Two single impacts are too few.
    assert_eq!(identified["restitution"], Value::Null);
    assert_eq!(identified["friction_coefficient"], Value::Null);
    let contacts = value["contacts"].as_array().unwrap();
    assert_eq!(contacts.len(), 3, "{contacts:?}");
    let over_mass = &contacts[0]["impulse"]["over_mass_m_s"];
    let friction = number(&over_mass[1]) / number(&over_mass[0]);
    // The spin is counter-clockwise: friction drives the rotor clockwise.
    assert!((friction + 0.15).abs() < 0.01, "{friction}");
    assert_eq!(value["configured_otherwise"], serde_json::json!([]));
    let policies = &value["simulated"]["policies"];
    let again = &policies["supervisor"];
    assert_eq!(again["outcome"], "recovered");
    let severity = number(&value["summary"]["severity"]);
    let simulated = number(&again["supervision"]["severity_index"]);
    assert!(
        (simulated / severity - 1.0).abs() < 0.15,
        "{simulated}, {severity}"
    );
    assert!(
        number(&policies["levitation"]["contact_impulse_n_s"])
            > 2.0 * number(&again["contact_impulse_n_s"])
    );
    assert!(policies["passive"].is_object() && policies[format!("supervisor, {set}")].is_object());
}

/// What is wrong is named, with exit code 2 and nothing on standard output.
#[test]
fn what_cannot_be_simulated_is_named() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scene = scene_path("overload_then_release");
    assert!(run_scene(&scene, &out, &["--no-trace"]).status.success());
    let file = out.join("record_supervisor.bin");
    let scene = scene.to_str().unwrap();
    let slower = folder.path().join("slower.toml");
    let text = std::fs::read_to_string(scene).unwrap();
    let text = text.replace("sample_rate_hz = 20000", "sample_rate_hz = 10000");
    std::fs::write(&slower, text).unwrap();
    let line = format!("review {} --json", file.display());
    all("command_lines/review", 4, &line, command_line);
    let slower = format!("{line} --scene {}", slower.display());
    assert!(command_line(&slower, &[]).contains("run.sample_rate_hz"));
}
