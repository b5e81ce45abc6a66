//! Runs that fail on the way: named, with an exit code, and without harm to others.

use super::{names, short_scene};
use std::fs;
use system_tests::{host, run_scene};
use tempfile::TempDir;

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
    let result = run_scene(&scene, &out, &[]);
    let error = String::from_utf8(result.stderr).unwrap();
    assert_eq!(result.status.code(), Some(1), "{error}");
    assert!(error.contains("from the centre"), "{error}");
    assert_eq!(names(folder.path()), ["short.toml"]);
}

/// One policy's error leaves the others their results, and is marked in them. What the model really ran is said, and without
/// traces none is written.
#[test]
fn an_error_of_one_policy_leaves_the_others() {
    let folder = TempDir::new().unwrap();
    let soft =
        "[stator.inner]\nmass_kg = 1.0\nstiffness_n_m = 1e4\ndamping_n_s_m = 0.0\n\n[contact]";
    let scene = short_scene(folder.path(), |t| {
        t.replace("[contact]", soft)
            .replace("duration_s = 0.03", "duration_s = 0.10002")
            .replace("[1300.0, 750.0]", "[130.0, 75.0]")
    });
    let out = folder.path().join("out");
    let read = || -> serde_json::Value {
        serde_json::from_slice(&fs::read(out.join("verdict.json")).unwrap()).unwrap()
    };
    let result = run_scene(&scene, &out, &["--verify"]);
    let error = String::from_utf8(result.stderr).unwrap();
    let table = String::from_utf8(result.stdout).unwrap();
    assert_eq!(result.status.code(), Some(1), "{error}");
    assert!(error.contains("policy passive: at t = "), "{error}");
    assert!(table.contains("policy passive: at t = "), "{table}");
    let verdict = read();
    let passive = verdict["policies"]["passive"].as_object().unwrap();
    assert!(passive.len() == 1 && passive["error"].is_string());
    let supervised = &verdict["policies"]["supervisor"];
    assert_eq!(supervised["outcome"], "recovered");
    assert_eq!(supervised["verification"]["same_outcome"], true);
    assert_eq!(verdict["duration_s"], 0.1);
    let files = names(&out);
    assert!(!files.contains(&"trace_passive.parquet".to_owned()));
    assert!(files.contains(&"trace_supervisor.parquet".to_owned()));
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("Warning: policy passive: at t = "));

    run_scene(&scene, &out, &["--no-trace"]);
    assert!(names(&out).iter().all(|name| !name.ends_with(".parquet")));
}

/// An error that nobody can hear is still one, with the same exit code.
#[test]
#[cfg(target_os = "linux")]
fn an_error_that_cannot_be_printed_has_its_exit_code() {
    let full = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let status = (host().args(["run", "no_such_scene.toml"]).stderr(full)).status();
    assert_eq!(status.unwrap().code(), Some(2));
}
