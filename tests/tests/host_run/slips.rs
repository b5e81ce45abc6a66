//! Slips of the pen that are run, and said.

use super::short_scene;
use std::fs;
use system_tests::run_scene;
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
            "levitation.proportional_n_m",
        ),
        (
            "sample_rate_hz = 20000",
            "sample_rate_hz = 9900",
            "run.sample_rate_hz",
        ),
    ];
    for (from, to, key) in slips {
        let said = warned(from, to);
        let warning = said.lines().find(|l| l.starts_with("warning: "));
        let warning = warning.unwrap_or_else(|| panic!("{to}: {said}"));
        assert!(
            warning.contains(key) && warning.contains("short.toml:"),
            "{warning}"
        );
    }
    // Refused at another key: the slip is told beside it.
    let said = warned("clearance_m = 2e-4", "clearance_m = 0.2");
    assert!(
        said.contains("look here first") && said.contains("contact.clearance_m: is larger"),
        "{said}"
    );
    // A supervisor would refuse such a sensor. The folder keeps what was said on the screen.
    let scene = short_scene(folder.path(), |t| {
        t.replace(", \"supervisor\"]", "]")
            .replace("noise_rms_m = 1e-6", "noise_rms_m = 2.1e-4")
            .replace("quantum_m = 1e-7", "quantum_m = 2.1e-4")
    });
    let out = folder.path().join("blind");
    let said = String::from_utf8(run_scene(&scene, &out, &[]).stderr).unwrap();
    let verdict = fs::read_to_string(out.join("verdict.json")).unwrap();
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    for key in [
        "sensor.noise_rms_m: is larger",
        "sensor.quantum_m: is larger",
    ] {
        for text in [&said, &verdict, &report] {
            assert!(text.contains(key), "{key}: {said}");
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
        ("proportional_n_m = 5e5", "proportional_n_m = 2.1e5"),
        ("sample_rate_hz = 20000", "sample_rate_hz = 10000"),
    ] {
        assert_eq!(warned(from, to), "", "{to}");
    }
}
