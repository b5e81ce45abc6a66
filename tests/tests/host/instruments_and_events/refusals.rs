//! Keys that are out of range, missing, or without meaning are refused by name and line; good ones arrive.

use firmware_bench::device::axis::Axis;
use firmware_bench::device::loads::Shape;
use firmware_bench::device::sensor_fault::FaultKind;
use firmware_bench::scene::Scene;
use plant_model::V2;
use std::fs;
use system_tests::scene_path;

fn base() -> String {
    fs::read_to_string(scene_path("shock_15_g_on_amb")).unwrap()
}

/// What is changed in a good scene, the key that the error must name, what it must say.
#[test]
fn bad_keys_are_named() {
    let fault = |keys: &str| {
        format!("[[fault]]\nstart_s = 0.0\nduration_s = 0.01\n{keys}\n[[base_motion]]")
    };
    let table = |text: &str| format!("{text}\n[[base_motion]]");
    let motion = "[[base_motion]]";
    let cases: Vec<(&str, String, &str, &str)> = vec![
        (
            "shape = \"half_sine\"",
            "shape = \"triangle\"".into(),
            "shape",
            "half_sine",
        ),
        (
            "shape = \"half_sine\"",
            "shape = \"sine\"".into(),
            "base_motion[0].frequency_hz",
            "is missing",
        ),
        (
            "shape = \"half_sine\"",
            "frequency_hz = 3.0".into(),
            "base_motion[0].frequency_hz",
            "only",
        ),
        (
            "shape = \"half_sine\"",
            "shape = \"sine\"\nfrequency_hz = 3e4".into(),
            "base_motion[0].frequency_hz",
            "to 20000",
        ),
        (
            "shape = \"half_sine\"",
            "phase_rad = 3.0".into(),
            "base_motion[0].phase_rad",
            "only",
        ),
        (
            "[147.15, 0.0]",
            "[1e9, 0.0]".into(),
            "base_motion[0].acceleration_m_s2",
            "a number from",
        ),
        (
            "start_s = 0.02",
            "start_s = 0.1".into(),
            "base_motion[0].start_s",
            "not before the end",
        ),
        (
            "[retainer]",
            "[stator.inner]\nmass_kg = 1.0\nstiffness_n_m = 1e9\ndamping_n_s_m = 1e4\n[retainer]"
                .into(),
            "base_motion[0]",
            "rigid stator",
        ),
        (
            "[2e-5, 0.0]",
            "[2e-4, 0.0]".into(),
            "retainer.centre_offset_m",
            "below contact.clearance_m",
        ),
        (
            "centre_offset_m",
            "center_offset_m".into(),
            "center_offset_m",
            "centre_offset_m",
        ),
        (
            "axis_force_max_n = 1000.0",
            "axis_force_max_n = 0.0".into(),
            "magnet.axis_force_max_n",
            "greater than 0",
        ),
        (
            "slew_n_s = 2e6",
            "slew_n_s = -1.0".into(),
            "magnet.slew_n_s",
            "greater than 0",
        ),
        (
            "delay_samples = 2",
            "delay_samples = 0".into(),
            "magnet.delay_samples",
            "from 1 to 7",
        ),
        (
            "delay_samples = 2",
            "delay_samples = 2\ndelay_jitter_samples = 6".into(),
            "magnet.delay_jitter_samples",
            "at most 7",
        ),
        (
            "delay_samples = 2",
            "delay_samples = 8".into(),
            "magnet.delay_samples",
            "from 1 to 7",
        ),
        (
            "range_m = 5e-4",
            "range_m = 0.0".into(),
            "sensor.range_m",
            "a number from",
        ),
        (
            "range_m = 5e-4",
            "gain = [1.0, 200.0]".into(),
            "sensor.gain",
            "a number from",
        ),
        (
            "range_m = 5e-4",
            "offset_m = [2.0, 0.0]".into(),
            "sensor.offset_m",
            "a number from",
        ),
        (
            "range_m = 5e-4",
            "delay_samples = 8".into(),
            "sensor.delay_samples",
            "from 0 to 7",
        ),
        (
            "range_m = 5e-4",
            "delay_samples = 7".into(),
            "sensor.delay_samples",
            "makes 9 samples with magnet.delay_samples",
        ),
        (
            "[levitation]",
            "[damping]\ncoefficient_n_s_m = -1.0\n[levitation]".into(),
            "damping.coefficient_n_s_m",
            "a number from",
        ),
        (
            "[levitation]",
            "[spin_sensor]\nvalid = 1\n[levitation]".into(),
            "valid",
            "true or false",
        ),
        (
            motion,
            table("[[outage]]\nstart_s = 0.2\nduration_s = 0.01"),
            "outage[0].start_s",
            "not before the end",
        ),
        (
            motion,
            table("[[outage]]\nstart_s = 0.0\nduration_s = 0.01\naxis = \"z\""),
            "axis",
            "both",
        ),
        (
            motion,
            table("[[outage]]\nstart_s = 0.0\nduration_s = 0.01\ndelivers = \"half\""),
            "delivers",
            "swapped",
        ),
        (
            motion,
            table(
                "[[outage]]\nstart_s = 0.0\nduration_s = 0.01\ndelivers = \"swapped\"\naxis = \"x\"",
            ),
            "outage[0].axis",
            "of one axis",
        ),
        (
            motion,
            table(
                "[[outage]]\nstart_s = 0.0\nduration_s = 0.01\ndelivers = \"inverted\"\nknown = true",
            ),
            "outage[0].known",
            "reported to nobody",
        ),
        (motion, fault("kind = \"broken\""), "kind", "oscillation"),
        (
            motion,
            fault("kind = \"offset\""),
            "fault[0].value_m",
            "is missing",
        ),
        (
            motion,
            fault("kind = \"offset\"\nvalue_m = 2.0"),
            "fault[0].value_m",
            "a number from",
        ),
        (
            motion,
            fault("kind = \"nan\"\nfactor = 2.0"),
            "fault[0].factor",
            "no meaning",
        ),
        (
            motion,
            fault("kind = \"dropout\"\naxis = \"x\""),
            "fault[0].axis",
            "no meaning",
        ),
        (
            motion,
            fault("kind = \"bits\"\nbits = 33"),
            "fault[0].bits",
            "from 1 to 32",
        ),
        (
            motion,
            fault("kind = \"spikes\"\nrate_hz = 3e4\nsize_m = 1e-4"),
            "fault[0].rate_hz",
            "to 20000",
        ),
        (
            motion,
            table("[[change]]\nat_s = 0.01"),
            "change[0]",
            "changes nothing",
        ),
        (
            motion,
            table("[[change]]\nat_s = 0.1\neccentricity_m = 1e-5"),
            "change[0].at_s",
            "not before the end",
        ),
        (
            motion,
            table("[[change]]\nat_s = 0.0\neccentricity_m = -1e-5"),
            "change[0].eccentricity_m",
            "a number from",
        ),
        (
            motion,
            table(
                "[[change]]\nat_s = 0.01\neccentricity_m = 0.0\nfriction_coefficient = 0.1\n\
                 [[change]]\nat_s = 0.02\nfriction_coefficient = 0.2\n\
                 [[change]]\nat_s = 0.01\nfriction_coefficient = 0.2",
            ),
            "change[2].friction_coefficient",
            "given for 0.01 s by change[0] as well",
        ),
        (
            motion,
            table("[[change]]\nat_s = 0.0\nfriction_coefficient = -0.1"),
            "change[0].friction_coefficient",
            "a number from",
        ),
        (
            "inertia_kg_m2 = 0.02",
            "\n[[change]]\nat_s = 0.0\ndrive_torque_n_m = 1.0".into(),
            "change[0].drive_torque_n_m",
            "held",
        ),
    ];
    for (from, to, key, expected) in cases {
        let good = base();
        assert!(good.contains(from), "{from}");
        let text = good.replacen(from, &to, 1);
        let error = Scene::parse("scene.toml", &text)
            .expect_err(&to)
            .to_string();
        assert!(error.contains(key), "{to}: no {key} in {error}");
        assert!(error.contains(expected), "{to}: no {expected} in {error}");
    }
    for kind in ["rail", "bits\"\nbits = 12 #"] {
        let text = base().replacen("range_m = 5e-4", "", 1).replacen(
            motion,
            &fault(&format!("kind = \"{kind}\"")),
            1,
        );
        let error = Scene::parse("scene.toml", &text)
            .expect_err(kind)
            .to_string();
        assert!(
            error.contains("fault[0].kind: needs sensor.range_m"),
            "{error}"
        );
    }
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
