//! Runs that fail on the way: named, with an exit code, and without harm to others.

use super::{RUN, short_scene};
use std::fs;
use system_tests::host;
use system_tests::ran::{has, lacks};

/// A run that leaves what the model describes ends with a named error, exit code 1 and no results.
#[test]
fn a_run_that_cannot_be_trusted_ends_with_an_error() {
    let folder = short_scene(&[SOFT, ("duration_s = 0.03", "duration_s = 1.0")]);
    has(&folder.ran(RUN).fails(1), &["from the centre"]);
    assert_eq!(folder.names("."), ["short.toml"]);
}

/// A magnet that pulls harder than the ring it is to be caught by is held.
const SOFT: (&str, &str) = (
    "[contact]",
    "[stator.inner]\nmass_kg = 1.0\nstiffness_n_m = 1e4\ndamping_n_s_m = 0.0\n\n[contact]",
);

/// One policy's error leaves the others their results, and is marked in them. What the model really ran is said, and without
/// traces none is written.
#[test]
fn an_error_of_one_policy_leaves_the_others() {
    let folder = short_scene(&[
        SOFT,
        ("duration_s = 0.03", "duration_s = 0.10002"),
        ("[1300.0, 750.0]", "[130.0, 75.0]"),
    ]);
    let ran = folder.ran(&format!("{RUN} --verify"));
    has(&ran.printed, &["policy passive: at t = "]);
    has(&ran.fails(1), &["policy passive: at t = "]);
    let verdict = folder.json("out/verdict.json");
    let passive = verdict["policies"]["passive"].as_object().unwrap();
    assert!(passive.len() == 1 && passive["error"].is_string());
    let supervised = &verdict["policies"]["supervisor"];
    assert_eq!(supervised["outcome"], "recovered");
    assert_eq!(supervised["verification"]["same_outcome"], true);
    assert_eq!(verdict["duration_s"], 0.1);
    assert!(!folder.at("out/trace_passive.parquet").exists());
    assert!(folder.at("out/trace_supervisor.parquet").exists());
    has(
        &folder.text("out/report.html"),
        &["Warning: policy passive: at t = "],
    );

    folder.ran(&format!("{RUN} --no-trace")).fails(1);
    lacks(&folder.names("out").join(" "), &[".parquet"]);
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
