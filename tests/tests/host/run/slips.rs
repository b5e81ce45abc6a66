//! Slips of the pen that are run, and said.

use super::{short, short_scene};
use crate::refusals::{all, rows};
use std::fs;
use system_tests::{host, root, run_scene, scene_path};
use tempfile::TempDir;

/// What is allowed and hardly meant is run, and said with its line.
#[test]
fn slips_are_warned_of() {
    let folder = TempDir::new().unwrap();
    let ran = |text: &str| {
        let scene = short_scene(folder.path(), |_| text.to_owned());
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        String::from_utf8(result.stderr).unwrap()
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
        assert!(listed.contains(&format!("`{in_page}`")), "{key}");
        let shown = ran(text);
        let warning = shown.lines().find(|l| l.starts_with("warning: "));
        let warning = warning.unwrap_or_else(|| panic!("{row:?}: {shown}"));
        assert!(warning.contains("short.toml:"), "{warning}");
        warning.to_owned()
    };
    all("runs/slips", 19, &short(), warning);
    // The cap of an axis below the weight, and a change in the rest of a sample.
    let weak = short().replacen("[magnet]", "[magnet]\naxis_force_max_n = 280.0", 1);
    all("runs/slip_of_an_axis", 1, &weak, warning);
    let rest = short().replacen("duration_s = 0.03", "duration_s = 0.030_02", 1);
    all("runs/slip_of_a_sample", 1, &rest, warning);
    // Refused at another key: the slip is told beside it.
    let shown = ran(&short().replacen("clearance_m = 2e-4", "clearance_m = 0.2", 1));
    assert!(
        shown.contains("look here first") && shown.contains("contact.clearance_m: is larger"),
        "{shown}"
    );
    // A supervisor would refuse such a sensor. The folder keeps what was said on the screen.
    let scene = short_scene(folder.path(), |t| {
        t.replace(", \"supervisor\"]", "]")
            .replace("noise_rms_m = 1e-6", "noise_rms_m = 2.1e-4")
            .replace("quantum_m = 1e-7", "quantum_m = 2.1e-4")
    });
    let out = folder.path().join("blind");
    let shown = String::from_utf8(run_scene(&scene, &out, &[]).stderr).unwrap();
    let verdict = fs::read_to_string(out.join("verdict.json")).unwrap();
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    for key in [
        "sensor.noise_rms_m: is larger",
        "sensor.quantum_m: is larger",
    ] {
        for text in [&shown, &verdict, &report] {
            assert!(text.contains(key), "{key}: {shown}");
        }
    }
    for row in rows("runs/no_slips", 12) {
        let text = short().replacen(&row[0], &row[1], 1);
        assert_ne!(text, short(), "{row:?}");
        assert_eq!(ran(&text), "", "{row:?}");
    }
}

/// A sweep is no scene and a scene no sweep; magnets that are given by currents, and an inertia that is too small, get numbers.
#[test]
fn what_was_meant_is_said() {
    let folder = TempDir::new().unwrap();
    let rigid = scene_path("one_machine/rigid");
    let changed = |name: &str, from: &str, to: &str| {
        let path = folder.path().join(name);
        let text = fs::read_to_string(&rigid).unwrap();
        assert!(text.contains(from));
        fs::write(&path, text.replace(from, to)).unwrap();
        path
    };
    let currents = changed("currents.toml", "force_max_n = 600.0", "ki_n_a = 80.0");
    let light = changed("light.toml", "[spin]\n", "[spin]\ninertia_kg_m2 = 1e-9\n");
    for (command, file, says) in [
        ("run", &scene_path("sweeps/impact"), "firmware-host sweep"),
        ("sweep", &rigid, "firmware-host run"),
        (
            "run",
            &currents,
            "force_max_n is k_i times the largest current",
        ),
        ("run", &light, "4.4735e-2 kg m² or more"),
    ] {
        let output = host()
            .current_dir(folder.path())
            .args([command, file.to_str().unwrap()])
            .output()
            .unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        let words: Vec<&str> = error.split_whitespace().collect();
        assert!(words.join(" ").contains(says), "{error}");
    }
}

/// Ctrl-C leaves nothing behind.
#[cfg(unix)]
#[test]
fn what_was_begun_is_removed_on_interrupt() {
    use std::time::{Duration, Instant};
    let folder = TempDir::new().unwrap();
    let scene = scene_path("overload_then_release");
    let mut run = host();
    let mut run = run
        .current_dir(folder.path())
        .args([
            "run",
            scene.to_str().unwrap(),
            "--set",
            "run.duration_s=50.0",
            "--out",
            "out",
        ])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let begun = || fs::read_dir(folder.path()).unwrap().count() > 0;
    let waited = Instant::now();
    while !begun() && waited.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(begun());
    let killed = std::process::Command::new("kill")
        .args(["-INT", &run.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert!(!begun());
}
