//! Slips of the pen that are run, and said.

use super::short_scene;
use std::fs;
use system_tests::{host, root, run_scene, scene_path};
use tempfile::TempDir;

/// What is allowed and hardly meant is run, and said with its line.
#[test]
fn slips_are_warned_of() {
    let folder = TempDir::new().unwrap();
    let warned = |from: &str, to: &str| {
        let scene = short_scene(folder.path(), |t| {
            let text = t.replacen(from, to, 1);
            assert_ne!(text, t, "{from}");
            text
        });
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        String::from_utf8(result.stderr).unwrap()
    };
    let slips = [
        (
            "[run]",
            "[start]\nposition_m = [2.1e-3, 0.0]\n[run]",
            "start.position_m",
        ),
        (
            "[run]",
            "[start]\nvelocity_m_s = [21.0, 0.0]\n[run]",
            "start.velocity_m_s",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = 10.0\neccentricity_m = 2.1e-4",
            "rotor.eccentricity_m",
        ),
        (
            "contact_radius_m = 0.05",
            "contact_radius_m = 1.9e-4",
            "contact.clearance_m",
        ),
        ("[sensor]", "[sensor]\nrange_m = 1.9e-4", "sensor.range_m"),
        (
            "frequency_hz = 200.0",
            "frequency_hz = 5001.0",
            "spin.frequency_hz",
        ),
        (
            "contact_radius_m = 0.05",
            "contact_radius_m = 5.1",
            "rotor.contact_radius_m",
        ),
        (
            "[run]",
            "[supervisor]\nmass_kg = 10.6\n[run]",
            "supervisor.mass_kg",
        ),
        (
            "[magnet]",
            "[retainer]\ncentre_offset_m = [1.1e-6, 0.0]\n[magnet]",
            "retainer.centre_offset_m",
        ),
        (
            "coefficient = 0.15",
            "coefficient = 0.15\nrolling_coefficient = 0.15",
            "friction.rolling_coefficient",
        ),
        (
            "proportional_n_m = 5e5",
            "proportional_n_m = 2e5",
            "levitation",
        ),
        (
            "sample_rate_hz = 20000",
            "sample_rate_hz = 9900",
            "run.sample_rate_hz",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = 10.0\ngravity_m_s2 = [0.0, -9810.0]",
            "rotor.gravity_m_s2",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = 10.0\ngravity_m_s2 = [0.0, -100.0]",
            "magnet.force_max_n",
        ),
        ("[sensor]", "[sensor]\ngain = 0.0", "sensor.gain"),
        ("[sensor]", "[sensor]\ngain = [1.0, -1.0]", "sensor.gain"),
        (
            "[sensor]",
            "[[fault]]\nstart_s = 0.010_012\nduration_s = 1e-5\nkind = \"nan\"\n[sensor]",
            "fault[0].start_s",
        ),
        (
            "[sensor]",
            "[[outage]]\nstart_s = 0.010_012\nduration_s = 1e-5\n[sensor]",
            "outage[0].start_s",
        ),
        (
            "[sensor]",
            "[[change]]\nat_s = 0.010_01\neccentricity_m = 1e-6\n[[change]]\nat_s = 0.010_02\neccentricity_m = 0.0\n[sensor]",
            "change[0].at_s",
        ),
    ];
    let page = fs::read_to_string(root().join("docs/src/host/keys.md")).unwrap();
    let (_, listed) = page.split_once("\n## Warnings\n").unwrap();
    let listed = listed.split("\n## ").next().unwrap();
    for (from, to, key) in slips {
        let in_page = match key.split_once('.') {
            Some(("supervisor", _)) => "supervisor.<parameter>".to_owned(),
            _ => key.replace("[0]", "[]"),
        };
        assert!(listed.contains(&format!("`{in_page}`")), "{key}");
        let shown = warned(from, to);
        let warning = shown.lines().find(|l| l.starts_with("warning: "));
        let warning = warning.unwrap_or_else(|| panic!("{to}: {shown}"));
        assert!(
            warning.contains(key) && warning.contains("short.toml:"),
            "{warning}"
        );
    }
    // Two changes of a scene: the cap of an axis below the weight, and a change in the rest of a sample.
    for (edits, key) in [
        (
            [
                (
                    "mass_kg = 10.0",
                    "mass_kg = 30.0\ngravity_m_s2 = [0.0, -9.81]",
                ),
                ("[magnet]", "[magnet]\naxis_force_max_n = 280.0"),
            ],
            "magnet.axis_force_max_n",
        ),
        (
            [
                ("duration_s = 0.03", "duration_s = 0.030_02"),
                (
                    "[sensor]",
                    "[[change]]\nat_s = 0.030_01\neccentricity_m = 1e-6\n[sensor]",
                ),
            ],
            "change[0].at_s",
        ),
    ] {
        let scene = short_scene(folder.path(), |t| {
            (edits.iter()).fold(t, |t, (from, to)| t.replacen(from, to, 1))
        });
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        let shown = String::from_utf8(result.stderr).unwrap();
        let warning = shown.lines().find(|l| l.starts_with("warning: "));
        assert!(warning.is_some_and(|w| w.contains(key)), "{key}: {shown}");
    }
    // Refused at another key: the slip is reported beside it.
    let shown = warned("clearance_m = 2e-4", "clearance_m = 0.2");
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
    for (from, to) in [
        ("[run]", "[start]\nposition_m = [2.1e-4, 0.0]\n[run]"),
        ("[run]", "[start]\nvelocity_m_s = [0.5, 0.0]\n[run]"),
        ("mass_kg = 10.0", "mass_kg = 10.0\neccentricity_m = 1e-5"),
        ("[sensor]", "[sensor]\nrange_m = 2.1e-4"),
        (
            "[magnet]",
            "[retainer]\ncentre_offset_m = [0.9e-6, 0.0]\n[magnet]",
        ),
        (
            "[run]",
            "[supervisor]\nmass_kg = 10.4\ndamping_n_s_m = 100.0\n[run]",
        ),
        (
            "coefficient = 0.15",
            "coefficient = 0.15\nrolling_coefficient = 0.14",
        ),
        ("proportional_n_m = 5e5", "proportional_n_m = 3e5"),
        ("sample_rate_hz = 20000", "sample_rate_hz = 10000"),
        (
            "mass_kg = 10.0",
            "mass_kg = 10.0\ngravity_m_s2 = [0.0, -99.0]",
        ),
        (
            "[sensor]",
            "[[fault]]\nstart_s = 0.010_012\nduration_s = 4e-5\nkind = \"nan\"\n[sensor]",
        ),
        (
            "[sensor]",
            "[[change]]\nat_s = 0.010_01\neccentricity_m = 1e-6\n[[change]]\nat_s = 0.010_02\nfriction_coefficient = 0.1\n[sensor]",
        ),
    ] {
        assert_eq!(warned(from, to), "", "{to}");
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
