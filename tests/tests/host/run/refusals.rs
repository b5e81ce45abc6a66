//! What is refused, and what it says then.

use super::{names, short_scene};
use std::fs;
use std::path::{Path, PathBuf};
use system_tests::{host, run_scene};
use tempfile::TempDir;

/// Bad scenes: what is changed in a good one, the line and key that the error must name, and what it
/// must say was expected.
#[test]
fn bad_scenes_are_refused_with_file_line_key_and_expectation() {
    let cases: &[(&str, &str, &str, &str)] = &[
        (
            "mass_kg = 10.0",
            "mass_kg = 10.0\ncolour = 3",
            "colour",
            "expected one of",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = 10,5",
            "mass_kg",
            "decimals with a point",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = 10 kg  # heavy",
            "mass_kg",
            "the number alone: 10;",
        ),
        (
            "seed = 1",
            "seed = 99999999999999999999",
            "seed",
            "too far from 0",
        ),
        (
            "stiffness_n_m = 1e9\nrestitution = 0.7",
            "stiffness_n_m = 1e308\nrestitution = 0.7",
            "contact.restitution",
            "no finite damping with contact.stiffness_n_m",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = \"ten\"",
            "mass_kg",
            "expected a number",
        ),
        (
            "force_n = [1300.0, 750.0]",
            "force_n = [1300.0, 750.0, 0.0]",
            "force_n",
            "expected two",
        ),
        (
            "start_s = 0.02",
            "start_s = 0.2",
            "disturbance[0].start_s",
            "not before the end of the run",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = -10.0",
            "rotor.mass_kg",
            "greater than 0",
        ),
        (
            "stiffness_n_m = 1e9\nrestitution = 0.7",
            "stiffness_n_mn = 1e26\ndamping_s_m = 0.1",
            "contact.stiffness_n_mn",
            "the supervisor derives contact_stiffness_n_m",
        ),
        (
            "force_max_n = 1000.0\nlag_s = 1.6e-4                  # 1 kHz amplifier\nnegative_stiffness_n_m = 2e5",
            "force_max_n = 9e6\nnegative_stiffness_n_m = 2e10",
            "magnet.negative_stiffness_n_m",
            "the supervisor derives stiffness_n_m",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = nan",
            "rotor.mass_kg",
            "greater than 0",
        ),
        (
            "clearance_m = 2e-4",
            "clearance_m = 0.0",
            "contact.clearance_m",
            "greater than 0",
        ),
        (
            "restitution = 0.7",
            "restitution = 1.5",
            "contact.restitution",
            "at most 1",
        ),
        (
            "[friction]",
            "[race]\ninertia_kg_m2 = 0.0\n\n[friction]",
            "race.inertia_kg_m2",
            "greater than 0",
        ),
        (
            "[friction]",
            "[race]\ninertia_kg_m2 = 1e-3\ndrag_n_m_s = -1.0\n\n[friction]",
            "race.drag_n_m_s",
            "0 or greater",
        ),
        (
            "[friction]",
            "[race]\ninertia_kg_m2 = 1e-3\nstart_frequency_hz = nan\n\n[friction]",
            "race.start_frequency_hz",
            "a finite number",
        ),
        (
            "[friction]",
            "[race]\ninertia_kg_m2 = 1e-3\ndrag = 1.0\n\n[friction]",
            "drag",
            "expected one of",
        ),
        (
            "[friction]",
            "[retainer]\nellipticity = 0.3\n\n[friction]",
            "retainer.ellipticity",
            "a number from 0 to 0.2",
        ),
        (
            "[friction]",
            "[retainer]\nlong_axis_deg = 30.0\n\n[friction]",
            "retainer.long_axis_deg",
            "give retainer.ellipticity",
        ),
        (
            "[friction]",
            "[race]\ninertia_kg_m2 = 1e-3\n[retainer]\nellipticity = 0.05\n\n[friction]",
            "retainer.ellipticity",
            "remove [race]",
        ),
        (
            "[friction]",
            "[retainer]\nellipticity = 0.05\n[stator.inner]\nmass_kg = 5.0\nstiffness_n_m = 1e8\ndamping_n_s_m = 1e4\n\n[friction]",
            "retainer.ellipticity",
            "remove [stator]",
        ),
        (
            "sample_rate_hz = 20000",
            "sample_rate_hz = inf",
            "run.sample_rate_hz",
            "a number from",
        ),
        (
            "coefficient = 0.15",
            "coefficient = 0.15\nspeed_scale_m_s = 1.0",
            "friction.speed_scale_m_s",
            "needs both",
        ),
        ("\"radial\"", "\"sideways\"", "run.policies", "policies are"),
        (
            "noise_rms_m = 1e-6",
            "noise_rms_m = -1e-6",
            "sensor.noise_rms_m",
            "a number from",
        ),
        (
            "duration_s = 0.03",
            "duration_s = 1e5",
            "run.duration_s",
            "a billion",
        ),
        (
            "force_n = [1300.0, 750.0]",
            "force_n = 1500.0",
            "force_n",
            "give two numbers in N, [x, y]",
        ),
        (
            "negative_stiffness_n_m = 2e5",
            "negative_stiffness_n_m = -2e5",
            "magnet.negative_stiffness_n_m",
            "that it is negative is in the name",
        ),
        (
            "force_n = [1300.0, 750.0]",
            "force_n = [1300.0, inf]",
            "disturbance[0].force_n",
            "a number from",
        ),
        (
            "[[disturbance]]",
            "[supervisor]\nhold_share = 2.0\n[[disturbance]]",
            "supervisor.hold_share",
            "0.1 to 0.95",
        ),
        (
            "[[disturbance]]",
            "[supervisor]\nhold = 2.0\n[[disturbance]]",
            "supervisor.hold",
            "parameters are",
        ),
        (
            "mass_kg = 10.0",
            "mass_kg = 10.0\ndamping_ratio = 0.1",
            "rotor.damping_ratio",
            "damping_n_s_m instead",
        ),
        (
            "seed = 1",
            "seed = 1\nmethod = \"euler\"",
            "method",
            "series",
        ),
        (
            "stiffness_n_m = 1e9\nrestitution = 0.7",
            "stiffness_n_mn = 1e13\nrestitution = 0.7",
            "contact.restitution",
            "restitution_speed_m_s too",
        ),
        (
            "stiffness_n_m = 1e9",
            "stiffness_n_m = 1e9\nexponent = 1.5",
            "contact.exponent",
            "give contact.stiffness_n_mn",
        ),
        (
            "stiffness_n_m = 1e9",
            "stiffness_n_mn = 1e13\nstiffness_n_m = 1e9",
            "contact.stiffness_n_m",
            "says the same",
        ),
        (
            "restitution = 0.7",
            "damping_s_mm = 0.7",
            "damping_s_mm",
            "did you mean",
        ),
        ("title = ", "title = = ", "title", ""),
        ("title = \"", "title = \"\\n", "title", "a name in one line"),
        (
            "title = \"",
            "title = \"\\u001b[31m",
            "title",
            "control characters",
        ),
        ("[contact]", "[contract]", "contract", "expected one of"),
    ];
    let folder = TempDir::new().unwrap();
    for (from, to, key, expected) in cases {
        let mut line = 0;
        let scene = short_scene(folder.path(), |t| {
            assert!(t.contains(from), "{from} is not in the scene");
            t.replacen(from, to, 1)
        });
        let text = fs::read_to_string(&scene).unwrap();
        let last_key = key.rsplit('.').next().unwrap().split('[').next().unwrap();
        for (i, l) in text.lines().enumerate() {
            let changed = to.lines().any(|t| !t.is_empty() && l.contains(t));
            if changed && l.contains(last_key) {
                line = i + 1;
            }
        }
        let out = folder.path().join("out");
        let result = run_scene(&scene, &out, &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        let flat: String = error
            .replace("│", " ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert_eq!(result.status.code(), Some(2), "{to}\n{error}");
        assert!(flat.contains(key), "{to}: no {key} in\n{error}");
        assert!(
            flat.contains(expected),
            "{to}: no \"{expected}\" in\n{error}"
        );
        assert!(
            error.contains(&format!("short.toml:{line}:")),
            "{to}: not line {line} in\n{error}"
        );
        assert_eq!(
            names(folder.path()),
            ["short.toml"],
            "{to}: left something behind"
        );
        assert!(result.stdout.is_empty());
    }
}

/// What `[supervisor]` says is checked whether or not that policy is run, with the line: a slip of the pen
/// would otherwise show only once somebody adds the policy. A parameter that is derived from the scene is
/// no mistake there, as nobody asks for it.
#[test]
fn parameters_of_a_supervisor_that_is_not_run_are_checked_too() {
    let without = "policies = [\"passive\", \"radial\"]";
    let all = "policies = [\"passive\", \"radial\", \"levitation\", \"supervisor\"]";
    let folder = TempDir::new().unwrap();
    let refused = |line: &str| {
        let scene = short_scene(folder.path(), |t| {
            t.replacen(all, without, 1) + "\n[supervisor]\n" + line + "\n"
        });
        let text = fs::read_to_string(&scene).unwrap();
        assert!(text.contains(without));
        let out = folder.path().join("out");
        let result = run_scene(&scene, &out, &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        let at = format!("short.toml:{}:", text.lines().count());
        (result.status.code(), error.contains(&at), error)
    };
    for (line, expected) in [
        ("hold_shar = 0.5", "did you mean `hold_share`?"),
        ("hold_share = 2.0", "0.1 to 0.95"),
        ("hold_share = nan", "0.1 to 0.95"),
        ("hold_share = 1e300", "0.1 to 0.95"),
        ("hold_share = \"much\"", "expected a number"),
    ] {
        let (code, with_line, error) = refused(line);
        assert_eq!(code, Some(2), "{line}\n{error}");
        assert!(with_line && error.contains(expected), "{line}\n{error}");
    }
    let (code, _, error) = refused("hold_share = 0.7");
    assert_eq!(code, Some(0), "{error}");
    // A lag that the supervisor could not take is no mistake of a scene without it.
    let scene = short_scene(folder.path(), |t| {
        (t.replacen(all, without, 1)).replacen("lag_s = 1.6e-4", "lag_s = 0.5", 1)
    });
    let result = run_scene(&scene, &folder.path().join("slow"), &[]);
    let error = String::from_utf8_lossy(&result.stderr);
    assert_eq!(result.status.code(), Some(0), "{error}");
}

#[test]
fn missing_scenes_and_unwritable_folders_are_refused() {
    let folder = TempDir::new().unwrap();
    let result = run_scene(
        Path::new("no_such_scene.toml"),
        &folder.path().join("out"),
        &[],
    );
    assert_eq!(result.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&result.stderr).contains("no_such_scene.toml"));

    // One byte of another encoding.
    let scene = folder.path().join("latin.toml");
    fs::write(&scene, b"# a\ntitle = \"St\xf6rung\"\n").unwrap();
    let result = run_scene(&scene, &folder.path().join("out"), &[]);
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert_eq!(result.status.code(), Some(2), "{error}");
    assert!(error.contains("latin.toml:2: is no UTF-8 text"), "{error}");
    fs::remove_file(&scene).unwrap();

    // A file where a folder should be stops everyone, also the superuser.
    let scene = short_scene(folder.path(), |t| t);
    for out in [
        scene.clone(),
        scene.join("below_a_file"),
        PathBuf::from("/proc/no_folder_here/out"),
    ] {
        let result = run_scene(&scene, &out, &[]);
        let error = String::from_utf8_lossy(&result.stderr).into_owned();
        assert_eq!(result.status.code(), Some(2), "{error}");
        assert!(error.contains("cannot write results"), "{error}");
        assert_eq!(names(folder.path()), ["short.toml"]);
    }
    // So does a folder where a file should be: nothing is written beside it.
    let out = folder.path().join("out");
    fs::create_dir_all(out.join("report.html")).unwrap();
    let result = run_scene(&scene, &out, &[]);
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert_eq!(result.status.code(), Some(2), "{error}");
    assert!(error.contains("report.html: is a directory"), "{error}");
    assert_eq!(names(&out), ["report.html"]);
    let no_arguments = host().arg("run").output().unwrap();
    assert_eq!(no_arguments.status.code(), Some(2));
}

/// A cap too small for the magnet's own pull is named as such, and not as a key that has no default.
#[test]
fn a_magnet_that_cannot_lift_is_named() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| {
        t.replace("force_max_n = 1000.0", "force_max_n = 39.0")
    });
    let result = run_scene(&scene, &folder.path().join("out"), &[]);
    let error = String::from_utf8(result.stderr).unwrap();
    assert_eq!(result.status.code(), Some(2), "{error}");
    assert!(error.contains("magnet.force_max_n: is 39"), "{error}");
}
