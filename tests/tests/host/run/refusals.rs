//! What is refused, and what it says then.

use super::{names, short, short_scene};
use crate::refusals::{all, flat};
use std::fs;
use std::path::PathBuf;
use system_tests::run_scene;
use tempfile::TempDir;

/// What `run` says of a scene: of the line that the row has changed, with nothing left behind, and a guess only where there is one.
pub(super) fn refused(scene: &str, row: &[String]) -> String {
    let folder = TempDir::new().unwrap();
    let file = short_scene(folder.path(), |_| scene.to_owned());
    let last_key = row[2].rsplit('.').next().unwrap();
    let last_key = last_key.split('[').next().unwrap();
    let changed = |l: &str| row[1].lines().any(|t| !t.is_empty() && l.contains(t));
    let at = |l: &str| changed(l) && l.contains(last_key);
    let line = scene.lines().count() - scene.lines().rev().position(at).unwrap();
    let result = run_scene(&file, &folder.path().join("out"), &[]);
    let said = flat(&result.stderr);
    assert_eq!(result.status.code(), Some(2), "{row:?}\n{said}");
    let at_line = said.contains(&format!("short.toml:{line}:"));
    assert!(at_line, "{row:?}: not line {line} in\n{said}");
    let guess = "did you mean";
    let guessed = row.iter().any(|word| word.contains(guess));
    assert_eq!(said.contains(guess), guessed, "{row:?}\n{said}");
    assert_eq!(names(folder.path()), ["short.toml"], "{row:?}");
    assert!(result.stdout.is_empty());
    said
}

#[test]
fn bad_scenes_are_refused_with_file_line_key_and_expectation() {
    all("runs/refused", 49, &short(), refused);
}

/// What `[supervisor]` says is checked whether or not that policy is run, with the line: a slip of the pen
/// would otherwise show only once somebody adds the policy. A parameter that is derived from the scene is
/// no mistake there, as nobody asks for it.
#[test]
fn parameters_of_a_supervisor_that_is_not_run_are_checked_too() {
    let without = short().replacen(", \"supervisor\"]", "]", 1);
    assert_ne!(without, short());
    all("runs/without_the_supervisor", 5, &without, refused);
    // A lag that the supervisor could not take is no mistake of a scene without it.
    let slow = without.replacen("lag_s = 1.6e-4", "lag_s = 0.5", 1);
    for good in [without + "\n[supervisor]\nhold_share = 0.7\n", slow] {
        let folder = TempDir::new().unwrap();
        let scene = short_scene(folder.path(), |_| good.clone());
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        let error = String::from_utf8_lossy(&result.stderr);
        assert_eq!(result.status.code(), Some(0), "{error}");
    }
}

#[test]
fn missing_scenes_and_unwritable_folders_are_refused() {
    let folder = TempDir::new().unwrap();
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
}
