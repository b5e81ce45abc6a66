//! `init`: from numbers to a scene that runs.

use crate::refusals::{all, command_line};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};
use system_tests::{host, run_scene};
use tempfile::TempDir;

const SMALL: &str = "--sample-rate-hz 20000 --mass-kg 10 --stiffness-n-m -2e5 --clearance-m 2e-4 \
    --contact-stiffness-n-m 1e9 --force-max-n 1000 --lag-s 1.6e-4 --friction 0.15 --noise-rms-m 1e-6";
/// A horizontal one of 200 kg on a shaft, slow, with a late and weak magnet.
const LARGE: &str = "--sample-rate-hz 10000 --mass-kg 200 --stiffness-n-m 1e6 --clearance-m 4e-4 \
    --contact-stiffness-n-m 3e8 --force-max-n 6000 --lag-s 5e-4 --friction 0.25 --noise-rms-m 2e-6 \
    --load-n 1962 --spin-hz -60 --contact-radius-m 0.15";

fn init(file: &Path, numbers: &str) -> Output {
    let mut init = host();
    init.arg("init").arg(file).args(numbers.split_whitespace());
    init.stdin(Stdio::null()).output().expect("the host starts")
}

/// A rotor of 30 kg in two bearings at unlike distances.
const ROTOR: &str = "--sample-rate-hz 20000 --mass-kg 30 --stiffness-n-m -3e5 --clearance-m 2e-4 \
    --contact-stiffness-n-m 3e8 --force-max-n 900 --lag-s 1e-4 --friction 0.15 --noise-rms-m 1e-6 --spin-hz 150 \
    --contact-radius-m 0.05 --load-n 294 --bearings-m -0.2,0.3";

/// By its inertias, as a cylinder or as a shaft that bends: its loop is in zone A, and the supervisor brings it back.
#[test]
fn a_rotor_in_two_bearings_is_levitated() {
    let folder = TempDir::new().unwrap();
    for (name, inertias) in [
        ("cylinder", "--length-m 0.8"),
        (
            "disc",
            "--transverse-inertia-kg-m2 1.2 --polar-inertia-kg-m2 0.9",
        ),
        ("shaft", "--length-m 0.8 --shaft-diameter-m 0.075"),
    ] {
        let file = folder.path().join(format!("{name}.toml"));
        let written = init(&file, &format!("{ROTOR} {inertias}"));
        let error = String::from_utf8_lossy(&written.stderr).into_owned();
        assert!(written.status.success(), "{name}: {error}");
        // What a shaft bends by the supervisor has configured, once.
        let expected = usize::from(name == "shaft");
        assert_eq!(error.lines().count(), expected, "{name}: {error}");
        let judged = host()
            .args(["modes", "--levitated", "--points", "2", "--json"])
            .arg(&file)
            .output()
            .unwrap();
        let judged: Value = serde_json::from_slice(&judged.stdout).unwrap();
        assert_eq!(judged["stable"], true);
        let highest_hz = judged["loop_modes"].as_array().unwrap().iter();
        let highest_hz = highest_hz.filter_map(|m| m["frequency_hz"].as_f64());
        assert_eq!(highest_hz.fold(0.0, f64::max) > 300.0, name == "shaft");
        let sensitivity = judged["sensitivity"].as_array().unwrap();
        assert!(sensitivity.len() == 4 && sensitivity.iter().all(|axis| axis["zone"] == "A"));
        let ran = run_scene(&file, &folder.path().join("out"), &["--json", "--no-trace"]);
        let verdict: Value = serde_json::from_slice(&ran.stdout).unwrap();
        let supervisor = &verdict["policies"]["supervisor"];
        assert_eq!(supervisor["outcome"], "recovered", "{verdict}");
        assert!(supervisor["impacts"].as_u64().unwrap() > 0);
    }
    let rotor = format!("init none.toml {ROTOR} --length-m 0.8");
    all("command_lines/init_rotor", 5, &rotor, command_line);
}

/// ki, ks and the largest current are the force cap and the stiffness that follow from them.
#[test]
fn a_magnet_may_be_given_by_its_currents() {
    let folder = TempDir::new().unwrap();
    let [by_force, by_current] = ["force", "current"].map(|name| folder.path().join(name));
    let currents = SMALL
        .replace("--stiffness-n-m -2e5", "--ks-n-m 2e5")
        .replace("--force-max-n 1000", "--ki-n-a 125 --current-max-a 8");
    for (file, numbers) in [(&by_force, SMALL), (&by_current, &currents)] {
        assert!(init(file, numbers).status.success());
    }
    let text = fs::read_to_string(by_force).unwrap();
    assert!(text.contains("negative_stiffness_n_m = 200000.0\n"));
    assert_eq!(fs::read_to_string(by_current).unwrap(), text);
}

#[test]
fn a_scene_from_nine_numbers_runs_and_is_levitated() {
    let folder = TempDir::new().unwrap();
    for (name, numbers) in [("small", SMALL), ("large", LARGE)] {
        let file = folder.path().join(format!("{name}.toml"));
        let written = init(&file, numbers);
        let error = String::from_utf8_lossy(&written.stderr).into_owned();
        assert!(
            written.status.success() && error.is_empty(),
            "{name}: {error}"
        );
        assert!(String::from_utf8_lossy(&written.stdout).contains("firmware-host run"));
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.starts_with("#:schema ./scene.schema.json\n"));
        assert_eq!(
            text.matches("# assumed: put in your own").count(),
            if name == "small" { 2 } else { 0 }
        );
        let schema: Value =
            serde_json::from_slice(&fs::read(folder.path().join("scene.schema.json")).unwrap())
                .unwrap();
        assert!(schema["properties"]["rotor"].is_object());

        let out = folder.path().join("out");
        let ran = run_scene(&file, &out, &["--json", "--no-trace"]);
        let error = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert!(ran.status.success(), "{name}: {error}");
        let verdict: Value = serde_json::from_slice(&ran.stdout).unwrap();
        let policies = &verdict["policies"];
        assert_eq!(policies["supervisor"]["outcome"], "recovered", "{name}");
        assert!(
            policies["supervisor"]["impacts"].as_u64().unwrap() > 0,
            "{name}"
        );
        // Before the overload and without it the controller holds the rotor and never touches.
        let alone = [
            "--json",
            "--no-trace",
            "--set",
            "disturbance=[]",
            "--set",
            "run.policies=[\"levitation\"]",
        ];
        let ran = run_scene(&file, &out, &alone);
        let verdict: Value = serde_json::from_slice(&ran.stdout).unwrap();
        let levitation = &verdict["policies"]["levitation"];
        assert_eq!(
            (&levitation["outcome"], &levitation["impacts"]),
            (&"recovered".into(), &0.into()),
            "{name}"
        );

        let again = init(&file, numbers);
        assert_eq!(again.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&again.stderr).contains("is there already"));
        assert_eq!(fs::read_to_string(&file).unwrap(), text);
    }
}

#[test]
fn what_is_missing_or_wrong_is_named_and_nothing_is_written() {
    let folder = TempDir::new().unwrap();
    let line = format!("init machine.toml {SMALL}");
    all("command_lines/init", 5, &line, command_line);
    let refused = init(&folder.path().join("none/machine.toml"), SMALL);
    let error = String::from_utf8_lossy(&refused.stderr);
    assert!(
        error.contains("give a file in a folder that is there"),
        "{error}"
    );
    assert!(!error.contains("--out"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
