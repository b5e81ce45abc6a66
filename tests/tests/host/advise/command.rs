//! The command line: what goes in, what comes out as JSON, what is refused.

use super::{AMB, advise};
use crate::refusals::{all, command_line};
use serde_json::Value;
use supervisor::PARAMETERS;
use system_tests::ran::list;

#[test]
fn json_has_its_keys_and_agrees_with_the_scene() {
    let json = advise(&format!("{AMB} --json")).json();
    for pointer in [
        "/nominal/mass_kg",
        "/limits/lift_off_m_s",
        "/limits/whirl_limit_m_s",
        "/limits/whirl_limit_hz",
        "/limits/arrest_time_s",
        "/reaction/detect_to_force_s",
        "/reaction/worst_s",
        "/reaction/ways/0/way_clearances",
        "/lag/angle_deg",
        "/lag/friction_angle_deg",
        "/noise/flight_m_s",
        "/noise/sensor_noise_most_m",
        "/noise/sample_rate_least_hz",
        "/impact/unavoidable_m_s",
        "/impact/bounce_gain",
        "/impact/first_m_s",
        "/impact/first_compliant_m_s",
        "/impact/all_bounces_m_s",
        "/crossover_hz",
        "/driving_n_s_m",
        "/driving_hz",
        "/parameters/0/value",
    ] {
        let value = json.pointer(pointer);
        assert!(value.is_some_and(Value::is_number), "{pointer}: {value:?}");
    }
    assert!(json["limits"]["passive_threshold_m_s"].is_null());
    assert_eq!(list(&json["parameters"]).len(), PARAMETERS.len());
    assert_eq!(json["warnings"][0]["key"], "lag_drives");
    assert!(json["warnings"][0]["remedy"].is_string());
    let table = json["supervisor_table"].as_str().unwrap();
    assert!(table.starts_with("[supervisor]"));

    // The overload scene is the same bearing but for the converter's step and the spin.
    let numbers = advise(&format!("{AMB} --json --quantum-m=1e-7 --spin-hz=200")).json();
    let scene = advise("@overload_then_release --json").json();
    for key in [
        "nominal",
        "limits",
        "noise",
        "impact",
        "crossover_hz",
        "runout_limit_m",
        "parameters",
        "warnings",
    ] {
        assert_eq!(numbers[key], scene[key], "{key}");
    }
}

#[test]
fn bad_numbers_end_with_code_2_and_say_what_is_wrong() {
    all(
        "command_lines/advise",
        21,
        &format!("advise {AMB}"),
        command_line,
    );
}
