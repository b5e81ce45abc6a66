//! The command line as a person uses it: results, errors, exit codes, and what is left behind.

mod causes;
mod command_line;
mod errors;
mod refusals;
mod settings;
mod slips;
mod traces;

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use system_tests::{host, run_scene, scene_path};
use tempfile::TempDir;

/// A short scene with noise and all policies.
pub(crate) fn short() -> String {
    let text = fs::read_to_string(scene_path("overload_then_release")).expect("a scene");
    text.replace("duration_s = 0.2", "duration_s = 0.03")
        .replace("duration_s = 0.05", "duration_s = 0.005")
}

/// That scene in a folder of its own.
fn short_scene(folder: &Path, edit: impl Fn(String) -> String) -> PathBuf {
    let path = folder.join("short.toml");
    fs::write(&path, edit(short())).expect("a writable folder");
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
    let result = run_scene(&scene_path("impact_at_40_hz"), &out, &[]);
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
            "record_supervisor.bin",
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
    // One script, which the page names by its hash, and one block of data.
    assert_eq!(report.matches("<script").count(), 2);
    assert!(report.contains("script-src 'sha256-") && !report.contains("src=\"http"));
    // The conclusion before everything else, and the supervisor before the others.
    let conclusion = report
        .find("With the supervisor the rotor is back in the middle")
        .unwrap();
    assert!(
        conclusion
            < report
                .find("Without it the rotor whirls backward (passive")
                .unwrap()
    );
    assert!(report.find(">supervisor<").unwrap() < report.find(">passive<").unwrap());
    for row in [
        "landings seen",
        "severity index of them",
        "asks to coast down",
        "contact impulse [N s]",
    ] {
        assert!(
            report.contains(&format!("<th scope=\"row\">{row}</th>")),
            "{row}"
        );
    }

    let verdict: Value =
        serde_json::from_slice(&fs::read(out.join("verdict.json")).unwrap()).unwrap();
    // Dry friction backward whirl without end presses through the wall. So the screen and the file say.
    let far = "passive, radial, levitation: the wall gave way by more than the clearance";
    let warning = verdict["warnings"][0].as_str().unwrap_or_default();
    assert!(warning.starts_with(far), "{warning}");
    assert!(table.contains("the wall gave way"), "{table}");
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

/// Drawings of the report and the numbers behind its panels: all but tables, which have wall-clock times.
fn plots(out: &Path) -> String {
    let report = fs::read_to_string(out.join("report.html")).expect("a report");
    let drawings = report
        .split("<svg")
        .skip(1)
        .map(|rest| rest.split("</svg>").next());
    let (_, data) = report.split_once("id=\"report-data\"").expect("numbers");
    drawings.flatten().chain([data]).collect()
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
            assert!(
                run_scene(&scene, &out, &["--threads", threads])
                    .status
                    .success()
            );
            out
        })
        .collect();
    for out in &outs[1..] {
        assert_eq!(stripped(&outs[0]), stripped(out));
        assert_eq!(plots(&outs[0]), plots(out));
    }
    let other = short_scene(folder.path(), |t| t.replace("seed = 1", "seed = 2"));
    let out = folder.path().join("other_seed");
    assert!(run_scene(&other, &out, &[]).status.success());
    assert_ne!(stripped(&outs[0]), stripped(&out), "the seed must matter");
}

#[test]
fn json_goes_to_standard_output() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let result = run_scene(&scene, &folder.path().join("out"), &["--json"]);
    assert!(result.status.success());
    let printed: Value = serde_json::from_slice(&result.stdout).unwrap();
    assert_eq!(printed["policies"].as_object().unwrap().len(), 4);
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
    let result = run_scene(&hardening("seed = 1"), &out, &["--verify"]);
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert!(result.status.success(), "{error}");
    let refused = run_scene(&hardening("method = \"series\""), &out, &[]);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{error}");
    assert!(error.contains("run.method"), "{error}");
    assert!(error.contains("auto or collocation"), "{error}");
}

/// A bearing out of round runs under every policy, verifies itself by the other method, and its report shows
/// the ellipse; the power series is refused where it is asked for.
#[test]
fn a_bearing_may_be_out_of_round() {
    let folder = TempDir::new().unwrap();
    let bore = "[retainer]\nellipticity = 0.05\nlong_axis_deg = 30.0\n\n[friction]";
    let scene = short_scene(folder.path(), |t| t.replacen("[friction]", bore, 1));
    let out = folder.path().join("out");
    let result = run_scene(&scene, &out, &["--verify"]);
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{error}");
    let text = fs::read(out.join("verdict.json")).unwrap();
    let verdict: Value = serde_json::from_slice(&text).unwrap();
    let supervisor = &verdict["policies"]["supervisor"];
    assert_eq!(supervisor["method"], "collocation");
    assert_ne!(supervisor["outcome"], "whirl");
    assert!(supervisor["impacts"].as_u64().unwrap() > 0);
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("clearance ellipse"));

    let scene = short_scene(folder.path(), |t| {
        (t.replacen("[friction]", bore, 1)).replacen("seed = 1", "seed = 1\nmethod = \"series\"", 1)
    });
    let result = run_scene(&scene, &out, &[]);
    assert_eq!(result.status.code(), Some(2));
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(error.contains("retainer.ellipticity"), "{error}");
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
    assert!(run_scene(&scene, &out, &[]).status.success());
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

/// What is not printed is in the folder all the same.
#[test]
fn quiet_prints_nothing_and_writes_everything() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let [loud, quiet] = ["loud", "quiet"].map(|name| folder.path().join(name));
    assert!(!run_scene(&scene, &loud, &[]).stdout.is_empty());
    let output = run_scene(&scene, &quiet, &["--quiet"]);
    assert!(output.status.success() && output.stdout.is_empty());
    assert!(stripped(&loud) == stripped(&quiet));
    let both = run_scene(&scene, &quiet, &["--quiet", "--json"]);
    assert_eq!(both.status.code(), Some(2));
}

/// Each shell's script knows commands and options.
#[test]
fn shells_can_complete() {
    for shell in ["bash", "zsh", "fish"] {
        let output = host().args(["completions", shell]).output().unwrap();
        let script = String::from_utf8(output.stdout).unwrap();
        for word in ["sweep", "no-trace", "sensitivity"] {
            assert!(output.status.success() && script.contains(word), "{shell}");
        }
        assert!(!script.contains("serve-controller"), "{shell}");
    }
}
