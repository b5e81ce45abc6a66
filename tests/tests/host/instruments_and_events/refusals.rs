//! Keys that are out of range, missing, or without meaning are refused by name and line; good ones arrive.

use crate::refusals::{all, parsed};
use firmware_bench::device::axis::Axis;
use firmware_bench::device::loads::Shape;
use firmware_bench::device::sensor_fault::FaultKind;
use firmware_bench::scene::Scene;
use plant_model::V2;
use system_tests::ran::scene_text;

fn base() -> String {
    scene_text("shock_15_g_on_amb")
}

#[test]
fn bad_keys_are_named() {
    all("scenes/shock_15_g_on_amb", 40, &base(), parsed);
    let without = base().replacen("range_m = 5e-4", "", 1);
    all("scenes/without_a_range", 2, &without, parsed);
}

#[test]
fn good_keys_arrive() {
    let more = "[[disturbance]]
start_s = 0.01
duration_s = 0.02
force_n = [1.0, 2.0]
shape = \"sine\"
frequency_hz = 30.0
phase_rad = 0.5
[[outage]]
start_s = 0.01
duration_s = 0.02
axis = \"y\"
known = true
[[fault]]
start_s = 0.03
duration_s = 0.5
kind = \"gain\"
factor = 0.9
axis = \"x\"
[[change]]
at_s = 0.04
eccentricity_m = 1e-5
[[change]]
at_s = 0.02
friction_coefficient = 0.3
[spin_sensor]
valid = false
reversed = true
gain = 1.02
[damping]
coefficient_n_s_m = 1234.0
";
    let text = format!("{}\n{more}", base());
    let scene = Scene::parse("scene.toml", &text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.machine.planes[0].centre_m, V2::new(2e-5, 0.0));
    // The file says where the rotor stands as seen from the magnets.
    assert_eq!(scene.start.centre_m, V2::zeros());
    let plane = &scene.planes[0];
    assert_eq!(scene.base_motions[0].shape, Shape::HalfSine);
    let sine = Shape::Sine {
        frequency_hz: 30.0,
        phase_rad: 0.5,
    };
    assert_eq!(scene.disturbances[0].shape, sine);
    assert_eq!(
        (plane.outages[0].axis, plane.outages[0].known),
        (Axis::Y, true)
    );
    assert_eq!(
        (plane.faults[0].axis, plane.faults[0].kind),
        (Axis::X, FaultKind::Gain(0.9))
    );
    assert_eq!(
        scene.changes[0].change.friction_coefficient,
        Some(0.3),
        "in order of time"
    );
    assert_eq!(scene.changes[1].at_s, 0.04);
    assert!(!scene.spin_sensor.valid && scene.spin_sensor.gain == -1.02);
    assert_eq!(plane.damping_n_s_m, 1234.0);
    let supervisor = plane.supervisor.unwrap();
    assert_eq!(supervisor.delay_samples, 2.0, "magnet and sensor");
    // The fault lasts to the end and counts from its start; the last change comes after it.
    assert_eq!(scene.clock_starts_s(0), 0.04);
}

/// The whole cap at lift-off speed, √(c·(F + k·c)/m).
#[test]
fn damping_has_a_default() {
    let scene = Scene::parse("scene.toml", &base()).unwrap();
    let damping_n_s_m = scene.planes[0].damping_n_s_m;
    let speed = (2e-4f64 * (1000.0 - 2e5 * 2e-4) / 10.0).sqrt();
    assert!((damping_n_s_m - 1000.0 / speed).abs() < 1e-9 * damping_n_s_m);
}
