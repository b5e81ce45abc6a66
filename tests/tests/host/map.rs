//! `map`: the critical impact speed over two keys of a scene.

use crate::refusals::{all, command_line};
use serde_json::Value;
use system_tests::ran::{Folder, has, number};

const X: &str = "friction.coefficient=0.05..0.6";
const Y: &str = "contact.restitution=0.1..0.9";

/// What is said of a map in JSON, and the folder in which it lies.
fn map(scene: &str, more: &str) -> (Value, Folder) {
    let folder = Folder::fresh();
    let done = folder.ran(&format!("map @{scene} {more} --json --out map"));
    (done.json(), folder)
}

#[test]
fn a_map_is_the_same_by_lanes_and_one_by_one_whatever_the_threads() {
    let run = |threads: u32| {
        let more = format!("--x {X} --y {Y} --cells 24x20 --held-spin --threads {threads}");
        let (done, folder) = map("impact_at_40_hz", &more);
        let title = "Critical impact speed over friction.coefficient and contact.restitution";
        has(&folder.text("map/map.html"), &[title]);
        (done, folder.bytes("map/map.parquet"))
    };
    let (done, alone) = run(1);
    assert_eq!(done["cells"], 480);
    assert_eq!(done["lanes"], done["runs"]);
    assert!(done["checked"].as_u64().unwrap() >= 80);
    assert_eq!(done["equal_to_scalar"], done["checked"]);
    // Most friction and the springiest wall bear least: less than a tenth of what the least friction and the deadest wall bear.
    assert!(10.0 * number(&done["lowest_m_s"]) < number(&done["highest_m_s"]));
    assert_eq!(run(2).1, alone);
}

#[test]
fn free_spin_goes_one_by_one() {
    let more = format!("--x {X} --y impact.inclination_deg=-20..80 --cells 3x2");
    let (done, _) = map("impact_at_40_hz", &more);
    assert_eq!(done["lanes"], 0);
    assert!(done["runs"].as_u64().unwrap() > 50);
}

/// Negative stiffness drives the rotor from any speed, which is not the same as from none; what the map leaves out it names.
#[test]
fn a_rotor_that_nothing_holds_bears_nothing() {
    let more = format!("--held-spin --cells 2x2 --x {X} --y {Y}");
    let (done, _) = map("overload_then_release", &more);
    assert_eq!(done["highest_m_s"], 0.0);
    assert_eq!(done["left_out"], serde_json::json!(["loads"]));
}

/// Of one key that is spread, percentiles are the speeds at these shares of its range: more friction bears less.
#[test]
fn percentiles_are_those_of_what_is_spread() {
    // One cell, its middle at the scene's own numbers.
    let cell = |more: &str| {
        let axes = "--x contact.stiffness_n_m=0.9e8..1.1e8 --y contact.restitution=0.6..0.8";
        let fixed = format!("{axes} --held-spin --cells 1x1 {more}");
        let (done, _) = map("impact_at_40_hz", &fixed);
        assert_eq!(done["equal_to_scalar"], done["checked"]);
        (number(&done["lowest_m_s"]), done["runs"].clone())
    };
    let mut of_all = None;
    for (of, coefficient) in [("p5", "0.385"), ("p50", "0.25"), ("p95", "0.115")] {
        let (known, _) = cell(&format!("--set friction.coefficient={coefficient}"));
        let spread = "--spread friction.coefficient=0.1..0.4 --draws 100 --of";
        let (drawn, runs) = cell(&format!("{spread} {of}"));
        let off = drawn / known - 1.0;
        assert!(off.abs() < 0.03, "{of}: {drawn} for {known}");
        // The same draws, whatever is shown of them.
        assert_eq!(*of_all.get_or_insert(runs.clone()), runs);
    }
}

#[test]
fn what_is_no_map_is_refused_and_leaves_nothing() {
    let line = format!("map @impact_at_40_hz --x {X} --y {Y} --cells 2x2 --json --out map");
    all("command_lines/map", 16, &line, command_line);
}
