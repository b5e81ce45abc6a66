//! The command line: what goes in, what comes out as JSON, what is refused.

use super::{AMB, advise, stderr};
use serde_json::Value;
use supervisor::PARAMETERS;
use system_tests::scene_path;

#[test]
fn json_has_its_keys_and_agrees_with_the_scene() {
    let numbers: Vec<&str> = AMB.iter().copied().chain(["--json"]).collect();
    let output = advise(&numbers);
    assert!(output.status.success(), "{}", stderr(&output));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
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
    assert_eq!(
        json["parameters"].as_array().unwrap().len(),
        PARAMETERS.len()
    );
    assert_eq!(json["warnings"][0]["key"], "lag_drives");
    assert!(json["warnings"][0]["remedy"].is_string());
    assert!(
        json["supervisor_table"]
            .as_str()
            .unwrap()
            .starts_with("[supervisor]")
    );

    // The overload scene is the same bearing but for the converter's step and the spin.
    let mut more = numbers.clone();
    more.extend(["--quantum-m=1e-7", "--spin-hz=200"]);
    let numbers: Value = serde_json::from_slice(&advise(&more).stdout).unwrap();
    let path = scene_path("overload_then_release");
    let output = advise(&[path.to_str().unwrap(), "--json"]);
    let scene: Value = serde_json::from_slice(&output.stdout).unwrap();
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
    let with = |more: &[&str]| -> Vec<String> {
        let name = |arg: &str| arg.split('=').next().unwrap_or_default().to_owned();
        let replaced: Vec<String> = more.iter().map(|arg| name(arg)).collect();
        let kept = AMB.iter().filter(|arg| !replaced.contains(&name(arg)));
        kept.chain(more).map(|arg| (*arg).to_owned()).collect()
    };
    let benchmark = scene_path("benchmark_b1");
    let impact = scene_path("impact_at_40_hz");
    let (benchmark, impact) = (benchmark.to_str().unwrap(), impact.to_str().unwrap());
    let cases: Vec<(Vec<String>, &str)> = vec![
        (vec![], "--mass-kg is missing"),
        (
            AMB[..6].iter().map(|s| (*s).to_owned()).collect(),
            "--force-max-n is missing",
        ),
        (
            with(&["--mass-kg=-1"]),
            "--mass-kg is -1, expected a finite number greater than 0",
        ),
        (with(&["--mass-kg=nan"]), "--mass-kg is NaN"),
        (
            with(&["--centre-offset-m=1"]),
            "--centre-offset-m is 1, expected a length below --clearance-m",
        ),
        (
            with(&["--contact-mass-kg=1e3"]),
            "--contact-mass-kg is 1000, expected at most the rotor's mass",
        ),
        (with(&["--clearance-m=0"]), "--clearance-m is 0"),
        (with(&["--friction=-0.1"]), "--friction is -0.1"),
        (with(&["--restitution=1.1"]), "--restitution is 1.1"),
        (
            with(&["--sample-rate-hz=0"]),
            "--sample-rate-hz is 0, expected a number from 1 to 1e6",
        ),
        (
            with(&["--delay-samples=8"]),
            "--delay-samples is 8, expected a whole number from 0 to 7",
        ),
        (
            with(&["--lag-s=0.5"]),
            "--lag-s: the supervisor derives amplifier_lag_s = 0.5",
        ),
        (with(&["--mass-kg=ten"]), "--mass-kg"),
        (vec![benchmark.to_owned()], "has no magnet"),
        (
            vec![impact.to_owned(), "--mass-kg=3".to_owned()],
            "cannot be used with",
        ),
        (
            vec!["nowhere.toml".to_owned()],
            "cannot read scene nowhere.toml",
        ),
    ];
    for (args, message) in cases {
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let output = advise(&args);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {text}");
        assert!(text.contains(message), "{args:?}: {text}");
        assert!(output.stdout.is_empty());
    }
}
