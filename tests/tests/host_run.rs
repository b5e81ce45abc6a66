//! The command line as a person uses it: results, errors, exit codes, and what is left behind.

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use system_tests::{host, scene_path};
use tempfile::TempDir;

fn run(scene: &Path, out: &Path, more: &[&str]) -> Output {
    host()
        .arg("run")
        .arg(scene)
        .arg("--out")
        .arg(out)
        .args(more)
        .output()
        .expect("the host starts")
}

/// A short scene with noise and all policies, in a folder of its own.
fn short_scene(folder: &Path, edit: impl Fn(String) -> String) -> PathBuf {
    let text = fs::read_to_string(scene_path("overload_then_release")).expect("a scene");
    let text = text
        .replace("duration_s = 0.2", "duration_s = 0.03")
        .replace("duration_s = 0.05", "duration_s = 0.005");
    let path = folder.join("short.toml");
    fs::write(&path, edit(text)).expect("a writable folder");
    path
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = (fs::read_dir(folder).expect("a folder"))
        .map(|e| {
            e.expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

#[test]
fn the_impact_scene_shows_the_table_and_writes_everything() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("new").join("results");
    let result = run(&scene_path("impact_at_40_hz"), &out, &[]);
    let table = String::from_utf8(result.stdout).unwrap();
    assert!(
        result.status.success(),
        "{}",
        String::from_utf8_lossy(&result.stderr)
    );
    for word in [
        "passive",
        "radial",
        "levitation",
        "supervisor",
        "whirl",
        "recovered",
        "impacts",
    ] {
        assert!(table.contains(word), "{word} is missing in\n{table}");
    }
    assert_eq!(
        names(&out),
        [
            "report.html",
            "trace_levitation.parquet",
            "trace_passive.parquet",
            "trace_radial.parquet",
            "trace_supervisor.parquet",
            "verdict.json"
        ]
    );
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("<svg") && report.contains("Impact at 40 Hz"));
    assert!(!report.contains("<script") && !report.contains("src=\"http"));

    let verdict: Value =
        serde_json::from_slice(&fs::read(out.join("verdict.json")).unwrap()).unwrap();
    for (policy, outcome) in [
        ("passive", "whirl"),
        ("levitation", "whirl"),
        ("supervisor", "recovered"),
    ] {
        assert_eq!(verdict["policies"][policy]["outcome"], outcome);
        assert_eq!(
            verdict["policies"][policy]["recovered"],
            outcome == "recovered"
        );
    }
    let numbers = [
        "impacts",
        "contact_time_s",
        "peak_penetration_m",
        "peak_contact_force_n",
        "relevitation_time_s",
        "energy_residual",
        "run_time_s",
        "real_time_ratio",
    ];
    for key in numbers {
        assert!(verdict["policies"]["supervisor"][key].is_number(), "{key}");
    }
    assert!(
        verdict["policies"]["supervisor"]["max_backward_whirl_hz"].is_null(),
        "no whirl, no frequency"
    );
    assert!(
        verdict["policies"]["passive"]["max_backward_whirl_hz"]
            .as_f64()
            .unwrap()
            > 100.0
    );
}

#[test]
fn traces_hold_every_sample_and_every_mode_change() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let out = folder.path().join("out");
    assert!(run(&scene, &out, &[]).status.success());
    let reader =
        SerializedFileReader::new(fs::File::open(out.join("trace_supervisor.parquet")).unwrap())
            .unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    let columns: Vec<&str> = (0..schema.num_columns())
        .map(|i| schema.column(i).name().to_owned().leak() as &str)
        .collect();
    for name in [
        "t_s",
        "rotor_x_m",
        "rotor_vy_m_s",
        "inner_ring_x_m",
        "outer_ring_vy_m_s",
        "spin_rad_s",
        "race_spin_rad_s",
        "contact_force_n",
        "commanded_x_n",
        "delivered_y_n",
        "mode",
        "supervisor_mode",
    ] {
        assert!(columns.contains(&name), "{name}");
    }
    let at = |name: &str| columns.iter().position(|c| *c == name).unwrap();
    let (time, mode, change) = (at("t_s"), at("mode"), at("mode_change"));
    let (mut samples, mut changes, mut last) = (0, 0, (-1.0, String::new()));
    for row in reader.get_row_iter(None).unwrap() {
        let row = row.unwrap();
        let (t, m) = (
            row.get_double(time).unwrap(),
            row.get_string(mode).unwrap().clone(),
        );
        assert!(t >= last.0, "time runs backwards at {t}");
        if row.get_bool(change).unwrap() {
            changes += 1;
            assert_ne!(m, last.1, "no change at {t}");
        } else {
            samples += 1;
        }
        last = (t, m);
    }
    assert_eq!(samples, 601, "30 ms at 20 kHz, both ends");
    let verdict: Value =
        serde_json::from_slice(&fs::read(out.join("verdict.json")).unwrap()).unwrap();
    let impacts = verdict["policies"]["supervisor"]["impacts"]
        .as_u64()
        .unwrap();
    assert!(
        impacts >= 1 && changes >= impacts,
        "{changes} changes, {impacts} impacts"
    );
}

/// Last value of a column of the trace of the supervisor.
fn last_of(out: &Path, column: &str) -> f64 {
    let file = fs::File::open(out.join("trace_supervisor.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    let at = (0..schema.num_columns())
        .position(|i| schema.column(i).name() == column)
        .unwrap_or_else(|| panic!("no column {column}"));
    let last = reader.get_row_iter(None).unwrap().last().unwrap().unwrap();
    last.get_double(at).unwrap()
}

/// Without the table the ring is a bushing; with it contact spins the race up, towards the rotor's spin
/// of 200 Hz, or brakes it towards there.
#[test]
fn a_race_spins_with_the_rotor() {
    let folder = TempDir::new().unwrap();
    let of = |keys: &str| {
        let scene = short_scene(folder.path(), |t| {
            t.replace("[friction]", &format!("{keys}\n[friction]"))
        });
        let out = folder.path().join("out");
        let result = run(&scene, &out, &[]);
        assert!(
            result.status.success(),
            "{}",
            String::from_utf8_lossy(&result.stderr)
        );
        last_of(&out, "race_spin_rad_s") / std::f64::consts::TAU
    };
    assert_eq!(of(""), 0.0);
    let light = of("[race]\ninertia_kg_m2 = 1e-3\n");
    let heavy = of("[race]\ninertia_kg_m2 = 1e-1\n");
    let ahead = of("[race]\ninertia_kg_m2 = 1e-3\nstart_frequency_hz = 300.0\ndrag_n_m_s = 1e-6\n");
    assert!(light > 1.0 && light < 20.0, "{light}");
    assert!(heavy > 0.0 && heavy < 0.02 * light, "{heavy}");
    assert!(ahead > 280.0 && ahead < 299.0, "{ahead}");
}

/// Everything but the wall-clock times, which differ from run to run.
fn stripped(out: &Path) -> Vec<(String, Vec<u8>)> {
    let strip = |name: &str| {
        let bytes = fs::read(out.join(name)).expect("a result");
        if name != "verdict.json" {
            return bytes;
        }
        let text = String::from_utf8(bytes).expect("text");
        let kept = text
            .lines()
            .filter(|l| !l.contains("run_time_s") && !l.contains("real_time_ratio"));
        kept.collect::<Vec<_>>().join("\n").into_bytes()
    };
    (names(out).into_iter())
        .filter(|name| name != "report.html")
        .map(|name| (name.clone(), strip(&name)))
        .collect()
}

/// The report without the cells that show wall-clock times.
fn plots(out: &Path) -> String {
    let report = fs::read_to_string(out.join("report.html")).expect("a report");
    report.split("<svg").skip(1).collect()
}

#[test]
fn the_same_scene_and_seed_give_the_same_bits_on_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let outs: Vec<PathBuf> = ["1", "1", "2", "3"]
        .iter()
        .enumerate()
        .map(|(i, threads)| {
            let out = folder.path().join(format!("out{i}"));
            assert!(run(&scene, &out, &["--threads", threads]).status.success());
            out
        })
        .collect();
    for out in &outs[1..] {
        assert_eq!(stripped(&outs[0]), stripped(out));
        assert_eq!(plots(&outs[0]), plots(out));
    }
    let other = short_scene(folder.path(), |t| t.replace("seed = 1", "seed = 2"));
    let out = folder.path().join("other_seed");
    assert!(run(&other, &out, &[]).status.success());
    assert_ne!(stripped(&outs[0]), stripped(&out), "the seed must matter");
}

#[test]
fn json_goes_to_standard_output() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let result = run(&scene, &folder.path().join("out"), &["--json"]);
    assert!(result.status.success());
    let printed: Value = serde_json::from_slice(&result.stdout).unwrap();
    assert_eq!(printed["policies"].as_object().unwrap().len(), 4);
}

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
            "20 million",
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
            "1e-1 to 9.5e-1",
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
        let result = run(&scene, &out, &[]);
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
        let result = run(&scene, &out, &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        let at = format!("short.toml:{}:", text.lines().count());
        (result.status.code(), error.contains(&at), error)
    };
    for (line, expected) in [
        ("hold_shar = 0.5", "did you mean `hold_share`?"),
        ("hold_share = 2.0", "9.5e-1"),
        ("hold_share = nan", "9.5e-1"),
        ("hold_share = 1e300", "9.5e-1"),
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
    let result = run(&scene, &folder.path().join("slow"), &[]);
    let error = String::from_utf8_lossy(&result.stderr);
    assert_eq!(result.status.code(), Some(0), "{error}");
}

/// A scene with the nonlinear contact runs, verifies itself, and refuses the method that it has not.
#[test]
fn a_scene_may_have_a_nonlinear_contact() {
    let folder = TempDir::new().unwrap();
    let hardening = |more: &str| {
        short_scene(folder.path(), |t| {
            let contact = "stiffness_n_mn = 1e13\nexponent = 1.5\nrestitution_speed_m_s = 0.3";
            (t.replacen("stiffness_n_m = 1e9", contact, 1)).replacen("seed = 1", more, 1)
        })
    };
    let out = folder.path().join("out");
    let result = run(&hardening("seed = 1"), &out, &["--verify"]);
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert!(result.status.success(), "{error}");
    let refused = run(&hardening("method = \"series\""), &out, &[]);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{error}");
    assert!(error.contains("run.method"), "{error}");
    assert!(error.contains("auto, explicit or stiff"), "{error}");
}

/// A bearing out of round runs under every policy, verifies itself by the other method, and its report shows
/// the ellipse; the power series is refused where it is asked for.
#[test]
fn a_bearing_may_be_out_of_round() {
    let folder = TempDir::new().unwrap();
    let bore = "[retainer]\nellipticity = 0.05\nlong_axis_deg = 30.0\n\n[friction]";
    let scene = short_scene(folder.path(), |t| t.replacen("[friction]", bore, 1));
    let out = folder.path().join("out");
    let result = run(&scene, &out, &["--verify"]);
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{error}");
    let text = fs::read(out.join("verdict.json")).unwrap();
    let verdict: Value = serde_json::from_slice(&text).unwrap();
    let supervisor = &verdict["policies"]["supervisor"];
    assert_eq!(supervisor["method"], "explicit");
    assert_ne!(supervisor["outcome"], "whirl");
    assert!(supervisor["impacts"].as_u64().unwrap() > 0);
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("clearance ellipse"));

    let scene = short_scene(folder.path(), |t| {
        (t.replacen("[friction]", bore, 1)).replacen("seed = 1", "seed = 1\nmethod = \"series\"", 1)
    });
    let result = run(&scene, &out, &[]);
    assert_eq!(result.status.code(), Some(2));
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(error.contains("retainer.ellipticity"), "{error}");
}

#[test]
fn missing_scenes_and_unwritable_folders_are_refused() {
    let folder = TempDir::new().unwrap();
    let result = run(
        Path::new("no_such_scene.toml"),
        &folder.path().join("out"),
        &[],
    );
    assert_eq!(result.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&result.stderr).contains("no_such_scene.toml"));

    // A file where a folder should be stops everyone, also the superuser.
    let scene = short_scene(folder.path(), |t| t);
    for out in [
        scene.clone(),
        scene.join("below_a_file"),
        PathBuf::from("/proc/no_folder_here/out"),
    ] {
        let result = run(&scene, &out, &[]);
        let error = String::from_utf8_lossy(&result.stderr).into_owned();
        assert_eq!(result.status.code(), Some(2), "{error}");
        assert!(error.contains("cannot write results"), "{error}");
        assert_eq!(names(folder.path()), ["short.toml"]);
    }
    let no_arguments = host().arg("run").output().unwrap();
    assert_eq!(no_arguments.status.code(), Some(2));
}

/// Results of an earlier run are replaced, other files in the folder stay.
#[test]
fn a_folder_can_be_used_again() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("notes.txt"), "mine").unwrap();
    fs::write(out.join("verdict.json"), "old").unwrap();
    assert!(run(&scene, &out, &[]).status.success());
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
    assert_ne!(fs::read_to_string(out.join("verdict.json")).unwrap(), "old");
    assert_eq!(names(folder.path()), ["out", "short.toml"]);
}

/// A reader that stops reading is no error, and what was asked for is written.
#[test]
fn a_closed_pipe_is_no_panic() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let out = folder.path().join("out");
    let mut child = host()
        .arg("run")
        .arg(&scene)
        .arg("--out")
        .arg(&out)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let result = child.wait_with_output().unwrap();
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert!(result.status.success() && error.is_empty(), "{error}");
    assert!(out.join("verdict.json").exists());
}

/// A run that leaves what the model describes ends with a named error, exit code 1 and no results.
#[test]
fn a_run_that_cannot_be_trusted_ends_with_an_error() {
    let folder = TempDir::new().unwrap();
    // A magnet that pulls harder than the ring it is to be caught by is held.
    let soft =
        "[stator.inner]\nmass_kg = 1.0\nstiffness_n_m = 1e4\ndamping_n_s_m = 0.0\n\n[contact]";
    let scene = short_scene(folder.path(), |t| {
        t.replace("[contact]", soft)
            .replace("duration_s = 0.03", "duration_s = 1.0")
    });
    let out = folder.path().join("out");
    let result = run(&scene, &out, &[]);
    let error = String::from_utf8(result.stderr).unwrap();
    assert_eq!(result.status.code(), Some(1), "{error}");
    assert!(error.contains("from the centre"), "{error}");
    assert_eq!(names(folder.path()), ["short.toml"]);
}
