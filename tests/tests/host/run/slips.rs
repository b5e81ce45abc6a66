//! Slips of the pen that are run, and said.

use super::{RUN, short, short_scene};
use crate::refusals::{all, rows};
use std::fs;
use std::process::{Command, Stdio};
use system_tests::ran::{Folder, has, ran};
use system_tests::root;

/// What is allowed and hardly meant is run, and said with its line.
#[test]
fn slips_are_warned_of() {
    let folder = Folder::fresh();
    let ran = |text: &str| {
        folder.put("short.toml", text);
        folder.ran(RUN).said
    };
    let page = fs::read_to_string(root().join("docs/src/host/keys.md")).unwrap();
    let (_, listed) = page.split_once("\n## Warnings\n").unwrap();
    let listed = listed.split("\n## ").next().unwrap();
    let warning = |text: &str, row: &[String]| {
        let key = &row[2];
        let in_page = match key.split_once('.') {
            Some(("supervisor", _)) => "supervisor.<parameter>".to_owned(),
            _ => key.replace("[0]", "[]"),
        };
        has(listed, &[&format!("`{in_page}`")]);
        let said = ran(text);
        let warning = said.lines().find(|l| l.starts_with("warning: "));
        let warning = warning.unwrap_or_else(|| panic!("{row:?}: {said}"));
        has(warning, &["short.toml:"]);
        warning.to_owned()
    };
    all("runs/slips", 19, &short(), warning);
    // The cap of an axis below the weight, and a change in the rest of a sample.
    let weak = short().replacen("[magnet]", "[magnet]\naxis_force_max_n = 280.0", 1);
    all("runs/slip_of_an_axis", 1, &weak, warning);
    let rest = short().replacen("duration_s = 0.03", "duration_s = 0.030_02", 1);
    all("runs/slip_of_a_sample", 1, &rest, warning);
    // Refused at another key: the slip is told beside it.
    let said = ran(&short().replacen("clearance_m = 2e-4", "clearance_m = 0.2", 1));
    has(
        &said,
        &["look here first", "contact.clearance_m: is larger"],
    );
    // A supervisor would refuse such a sensor. The folder keeps what was said on the screen.
    let blind = short_scene(&[
        (", \"supervisor\"]", "]"),
        ("noise_rms_m = 1e-6", "noise_rms_m = 2.1e-4"),
        ("quantum_m = 1e-7", "quantum_m = 2.1e-4"),
    ]);
    let said = blind.ran(RUN).said;
    for text in [
        said,
        blind.text("out/verdict.json"),
        blind.text("out/report.html"),
    ] {
        has(
            &text,
            &[
                "sensor.noise_rms_m: is larger",
                "sensor.quantum_m: is larger",
            ],
        );
    }
    for row in rows("runs/no_slips", 12) {
        let text = short().replacen(&row[0], &row[1], 1);
        assert_ne!(text, short(), "{row:?}");
        assert_eq!(ran(&text), "", "{row:?}");
    }
}

/// A sweep is no scene and a scene no sweep; magnets that are told by currents, and an inertia that is too small, get numbers.
#[test]
fn what_was_meant_is_said() {
    let folder = Folder::fresh();
    let rigid = "one_machine/rigid";
    let currents = [("force_max_n = 600.0", "ki_n_a = 80.0")];
    folder.scene("currents.toml", rigid, &currents);
    let light = [("[spin]\n", "[spin]\ninertia_kg_m2 = 1e-9\n")];
    folder.scene("light.toml", rigid, &light);
    for (line, says) in [
        ("run @sweeps/impact", "firmware-host sweep"),
        ("sweep @one_machine/rigid", "firmware-host run"),
        (
            "run currents.toml",
            "force_max_n is k_i times the largest current",
        ),
        ("run light.toml", "4.4735e-2 kg m² or more"),
    ] {
        has(&folder.ran(line).fails(2), &[says]);
    }
}

/// Ctrl-C leaves nothing behind.
#[cfg(unix)]
#[test]
fn what_was_begun_is_removed_on_interrupt() {
    use std::time::{Duration, Instant};
    let folder = Folder::fresh();
    let line = "run @overload_then_release --set run.duration_s=50.0 --out out";
    let mut run = folder.command(line);
    let mut run = run
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = || !folder.names(".").is_empty();
    let waited = Instant::now();
    while !begun() && waited.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(begun());
    let mut kill = Command::new("kill");
    ran(kill.args(["-INT", &run.id().to_string()])).good();
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert!(!begun());
}
