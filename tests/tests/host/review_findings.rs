//! `review`: what it finds out of an event, and the event once more on a machine's scene.

use crate::refusals::{all, command_line};
use serde_json::Value;
use system_tests::ran::{Folder, has, list, number};

/// What a load of 1500 N did is found again, and once more with it the plant does nearly the same.
#[test]
fn an_event_is_found_out_and_simulated() {
    let folder = Folder::fresh();
    folder.ran("run @overload_then_release --out .").good();
    let set = "supervisor.hold_share=0.3";
    let line = format!("review record_supervisor.bin --scene @overload_then_release --set {set}");
    let text = folder.ran(&line).good();
    has(
        &text,
        &[
            "load along x [N]",
            "not identifiable",
            "The event once more, on: ",
            set,
        ],
    );
    let told = folder.ran(&format!("{line} --json")).json();
    let identified = &told["identified"];
    for (name, truth) in [("load_x_n", 1300.0), ("load_y_n", 750.0)] {
        let [value, low, high] = ["value", "low", "high"].map(|key| number(&identified[name][key]));
        assert!(low <= truth && truth <= high, "{name}: {identified}");
        let close = (value - truth).abs() < 15.0 && high - low < 60.0;
        assert!(close, "{name}: {identified}");
    }
    // Two single impacts are too few.
    assert_eq!(identified["restitution"], Value::Null);
    assert_eq!(identified["friction_coefficient"], Value::Null);
    let contacts = list(&told["contacts"]);
    assert_eq!(contacts.len(), 3, "{contacts:?}");
    let over_mass = &contacts[0]["impulse"]["over_mass_m_s"];
    let friction = number(&over_mass[1]) / number(&over_mass[0]);
    // The spin is counter-clockwise: friction drives the rotor clockwise.
    assert!((friction + 0.15).abs() < 0.01, "{friction}");
    assert_eq!(told["configured_otherwise"], serde_json::json!([]));
    let policies = &told["simulated"]["policies"];
    let again = &policies["supervisor"];
    assert_eq!(again["outcome"], "recovered");
    let severity = number(&told["summary"]["severity"]);
    let simulated = number(&again["supervision"]["severity_index"]);
    let off = simulated / severity - 1.0;
    assert!(off.abs() < 0.15, "{simulated}, {severity}");
    let impulse = |of: &Value| number(&of["contact_impulse_n_s"]);
    assert!(impulse(&policies["levitation"]) > 2.0 * impulse(again));
    assert!(policies["passive"].is_object() && policies[format!("supervisor, {set}")].is_object());
}

/// What is wrong is named, with exit code 2 and nothing on standard output.
#[test]
fn what_cannot_be_simulated_is_named() {
    let folder = Folder::fresh();
    folder
        .ran("run @overload_then_release --out . --no-trace")
        .good();
    let rate = [("sample_rate_hz = 20000", "sample_rate_hz = 10000")];
    let slower = folder.scene("slower.toml", "overload_then_release", &rate);
    let file = folder.at("record_supervisor.bin");
    let line = format!("review {} --json", file.display());
    all("command_lines/review", 4, &line, command_line);
    let slower = format!("{line} --scene {}", slower.display());
    has(&command_line(&slower, &[]), &["run.sample_rate_hz"]);
}
