//! `init`: from numbers to a scene that runs.

use crate::refusals::{all, command_line};
use serde_json::Value;
use system_tests::ran::{Folder, Ran, edited, has, lacks, list};

const SMALL: &str = "--sample-rate-hz 20000 --mass-kg 10 --stiffness-n-m -2e5 --clearance-m 2e-4 \
    --contact-stiffness-n-m 1e9 --force-max-n 1000 --lag-s 1.6e-4 --friction 0.15 --noise-rms-m 1e-6";
/// A horizontal one of 200 kg on a shaft, slow, with a late and weak magnet.
const LARGE: &str = "--sample-rate-hz 10000 --mass-kg 200 --stiffness-n-m 1e6 --clearance-m 4e-4 \
    --contact-stiffness-n-m 3e8 --force-max-n 6000 --lag-s 5e-4 --friction 0.25 --noise-rms-m 2e-6 \
    --load-n 1962 --spin-hz -60 --contact-radius-m 0.15";

pub(crate) fn init(folder: &Folder, file: &str, numbers: &str) -> Ran {
    folder.ran(&format!("init {file} {numbers}"))
}

/// What `modes` says of the loop of a scene that is levitated.
pub(crate) fn judged(folder: &Folder, file: &str) -> Value {
    let judged = folder.ran(&format!("modes --levitated --points 2 --json {file}"));
    let judged = judged.json();
    assert_eq!(judged["stable"], true);
    judged
}

/// The supervisor brings the rotor of a scene back.
pub(crate) fn recovers(folder: &Folder, file: &str) {
    let ran = folder.ran(&format!("run {file} --out out --json --no-trace"));
    let verdict = ran.json();
    let supervisor = &verdict["policies"]["supervisor"];
    assert_eq!(supervisor["outcome"], "recovered", "{verdict}");
    assert!(supervisor["impacts"].as_u64() > Some(0));
}

/// A rotor of 30 kg in two bearings at unlike distances.
const ROTOR: &str = "--sample-rate-hz 20000 --mass-kg 30 --stiffness-n-m -3e5 --clearance-m 2e-4 \
    --contact-stiffness-n-m 3e8 --force-max-n 900 --lag-s 1e-4 --friction 0.15 --noise-rms-m 1e-6 --spin-hz 150 \
    --contact-radius-m 0.05 --load-n 294 --bearings-m -0.2,0.3";

/// By its inertias, as a cylinder or as a shaft that bends: its loop is in zone A, and the supervisor brings it back.
#[test]
fn a_rotor_in_two_bearings_is_levitated() {
    let folder = Folder::fresh();
    let inertias = "--transverse-inertia-kg-m2 1.2 --polar-inertia-kg-m2 0.9";
    for (name, inertias) in [
        ("cylinder", "--length-m 0.8"),
        ("disc", inertias),
        ("shaft", "--length-m 0.8 --shaft-diameter-m 0.075"),
    ] {
        let file = format!("{name}.toml");
        let written = init(&folder, &file, &format!("{ROTOR} {inertias}"));
        // What a shaft bends by the supervisor is told of, once.
        let expected = usize::from(name == "shaft");
        assert_eq!(written.said.lines().count(), expected, "{}", written.said);
        written.good();
        let judged = judged(&folder, &file);
        let highest_hz = list(&judged["loop_modes"]).iter();
        let highest_hz = highest_hz.filter_map(|m| m["frequency_hz"].as_f64());
        assert_eq!(highest_hz.fold(0.0, f64::max) > 300.0, name == "shaft");
        let sensitivity = list(&judged["sensitivity"]);
        assert!(sensitivity.len() == 4 && sensitivity.iter().all(|axis| axis["zone"] == "A"));
        recovers(&folder, &file);
    }
    let rotor = format!("init none.toml {ROTOR} --length-m 0.8");
    all("command_lines/init_rotor", 5, &rotor, command_line);
}

/// ki, ks and the largest current are the force cap and the stiffness that follow from them.
#[test]
fn a_magnet_may_be_given_by_its_currents() {
    let folder = Folder::fresh();
    let currents = [
        ("--stiffness-n-m -2e5", "--ks-n-m 2e5"),
        ("--force-max-n 1000", "--ki-n-a 125 --current-max-a 8"),
    ];
    init(&folder, "force", SMALL).good();
    init(&folder, "current", &edited(SMALL, &currents)).good();
    let text = folder.text("force");
    has(&text, &["negative_stiffness_n_m = 200000.0\n"]);
    assert_eq!(folder.text("current"), text);
}

#[test]
fn a_scene_from_nine_numbers_runs_and_is_levitated() {
    let folder = Folder::fresh();
    for (file, numbers, assumed) in [("small.toml", SMALL, 2), ("large.toml", LARGE, 0)] {
        let written = init(&folder, file, numbers);
        assert_eq!(written.said, "", "{file}");
        has(&written.good(), &["firmware-host run"]);
        let text = folder.text(file);
        assert!(text.starts_with("#:schema ./scene.schema.json\n"));
        let put_in = text.matches("# assumed: put in your own").count();
        assert_eq!(put_in, assumed, "{file}");
        let schema = folder.json("scene.schema.json");
        assert!(schema["properties"]["rotor"].is_object());

        recovers(&folder, file);
        // Before the overload and without it the controller holds the rotor and never touches.
        let alone = "--set disturbance=[] --set run.policies=[\"levitation\"]";
        let line = format!("run {file} --out out --json --no-trace {alone}");
        let verdict = folder.ran(&line).json();
        let levitation = &verdict["policies"]["levitation"];
        assert_eq!(levitation["outcome"], "recovered", "{file}");
        assert_eq!(levitation["impacts"], 0, "{file}");

        let again = init(&folder, file, numbers).fails(2);
        has(&again, &["is there already"]);
        assert_eq!(folder.text(file), text);
    }
}

#[test]
fn what_is_missing_or_wrong_is_named_and_nothing_is_written() {
    let line = format!("init machine.toml {SMALL}");
    all("command_lines/init", 5, &line, command_line);
    let refused = command_line(&format!("init none/machine.toml {SMALL}"), &[]);
    has(&refused, &["give a file in a folder that is there"]);
    lacks(&refused, &["--out"]);
}
