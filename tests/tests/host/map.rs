//! `map`: the critical impact speed over two keys of a scene.

use crate::refusals::{all, command_line};
use serde_json::Value;
use std::fs;
use std::path::Path;
use system_tests::{host, scene_path};
use tempfile::TempDir;

const X: &str = "friction.coefficient=0.05..0.6";
const Y: &str = "contact.restitution=0.1..0.9";

/// Exit code, what it printed, and what it said.
fn map(arguments: &[&str], out: &Path) -> (Option<i32>, String, String) {
    let output = (host().arg("map").args(arguments))
        .args(["--json", "--out"])
        .arg(out)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn a_map_is_the_same_by_lanes_and_one_by_one_whatever_the_threads() {
    let folder = TempDir::new().unwrap();
    let scene = scene_path("impact_at_40_hz");
    let scene = scene.to_str().unwrap();
    let run =
        |threads: &str, name: &str| {
            let out = folder.path().join(name);
            let arguments = [
                scene,
                "--x",
                X,
                "--y",
                Y,
                "--cells",
                "24x20",
                "--held-spin",
                "--threads",
                threads,
            ];
            let (code, said, error) = map(&arguments, &out);
            assert_eq!(code, Some(0), "{error}");
            let page = fs::read_to_string(out.join("map.html")).unwrap();
            assert!(page.contains(
                "Critical impact speed over friction.coefficient and contact.restitution"
            ));
            let done: Value = serde_json::from_str(&said).unwrap();
            (done, fs::read(out.join("map.parquet")).unwrap())
        };
    let (done, alone) = run("1", "one");
    assert_eq!(done["cells"], 480);
    assert_eq!(done["lanes"], done["runs"]);
    assert!(done["checked"].as_u64().unwrap() >= 80);
    assert_eq!(done["equal_to_scalar"], done["checked"]);
    // Most friction and the springiest wall bear least: less than a tenth of what the least friction and the deadest wall bear.
    let speed = |key: &str| done[key].as_f64().unwrap();
    assert!(10.0 * speed("lowest_m_s") < speed("highest_m_s"));
    assert_eq!(run("2", "two").1, alone);
}

#[test]
fn free_spin_goes_one_by_one() {
    let folder = TempDir::new().unwrap();
    let scene = scene_path("impact_at_40_hz");
    let inclination = "impact.inclination_deg=-20..80";
    let arguments = [
        scene.to_str().unwrap(),
        "--x",
        X,
        "--y",
        inclination,
        "--cells",
        "3x2",
    ];
    let (code, said, error) = map(&arguments, &folder.path().join("map"));
    assert_eq!(code, Some(0), "{error}");
    let done: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(done["lanes"], 0);
    assert!(done["runs"].as_u64().unwrap() > 50);
}

/// Negative stiffness drives the rotor from any speed, which is not the same as from none; what the map leaves out it names.
#[test]
fn a_rotor_that_nothing_holds_bears_nothing() {
    let folder = TempDir::new().unwrap();
    let scene = scene_path("overload_then_release");
    let arguments = [scene.to_str().unwrap(), "--held-spin", "--cells", "2x2"];
    let out = folder.path().join("map");
    let (code, said, error) = map(&[&arguments[..], &["--x", X, "--y", Y]].concat(), &out);
    assert_eq!(code, Some(0), "{error}");
    let done: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(done["highest_m_s"], 0.0);
    assert_eq!(done["left_out"], serde_json::json!(["loads"]));
}

/// Of one key that is spread, percentiles are the speeds at these shares of its range: more friction bears less.
#[test]
fn percentiles_are_those_of_what_is_spread() {
    let folder = TempDir::new().unwrap();
    let scene = scene_path("impact_at_40_hz");
    let out = folder.path().join("map");
    // One cell, its middle at the scene's own numbers.
    let cell = |more: &[&str]| {
        let x = ["--x", "contact.stiffness_n_m=0.9e8..1.1e8"];
        let y = ["--y", "contact.restitution=0.6..0.8"];
        let fixed = [scene.to_str().unwrap(), "--held-spin", "--cells", "1x1"];
        let (code, said, error) = map(&[&fixed[..], &x, &y, more].concat(), &out);
        assert_eq!(code, Some(0), "{error}");
        fs::remove_dir_all(&out).unwrap();
        let done: Value = serde_json::from_str(&said).unwrap();
        assert_eq!(done["equal_to_scalar"], done["checked"]);
        (done["lowest_m_s"].as_f64().unwrap(), done["runs"].clone())
    };
    let mut of_all = None;
    for (of, coefficient) in [("p5", "0.385"), ("p50", "0.25"), ("p95", "0.115")] {
        let (known, _) = cell(&["--set", &format!("friction.coefficient={coefficient}")]);
        let spread = ["--spread", "friction.coefficient=0.1..0.4"];
        let (drawn, runs) = cell(&[&spread[..], &["--draws", "100", "--of", of]].concat());
        assert!(
            (drawn / known - 1.0).abs() < 0.03,
            "{of}: {drawn} for {known}"
        );
        // The same draws, whatever is shown of them.
        assert_eq!(*of_all.get_or_insert(runs.clone()), runs);
    }
}

#[test]
fn what_is_no_map_is_refused_and_leaves_nothing() {
    let line = format!("map @impact_at_40_hz --x {X} --y {Y} --cells 2x2 --json --out map");
    all("command_lines/map", 16, &line, command_line);
}
