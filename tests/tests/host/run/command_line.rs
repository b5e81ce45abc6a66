//! Options and disks that are not what was hoped for.

use super::{names, short_scene};
use system_tests::{host, scene_path};
use tempfile::TempDir;

/// A number below zero is a number, and what was expected is said of it.
#[test]
fn negative_numbers_reach_their_option() {
    let path = scene_path("overload_then_release");
    let scene = path.to_str().unwrap();
    for (args, text) in [
        (
            vec!["sensitivity", scene, "--width", "-1"],
            "expected a number from 0.1 to 4",
        ),
        (
            vec!["sensitivity", scene, "--draws", "-1"],
            "-1 is not in 0..=1000",
        ),
        (
            vec!["sensitivity", scene, "--threads", "-1"],
            "-1 is not in 1..=1024",
        ),
        (
            vec!["run", scene, "--threads", "-1"],
            "-1 is not in 1..=1024",
        ),
        (vec!["accuracy", "--threads", "-1"], "-1 is not in 1..=1024"),
        (
            vec!["overloads", "--threads", "-1"],
            "-1 is not in 1..=1024",
        ),
        (
            vec!["study", "paper", "--threads", "-1"],
            "-1 is not in 1..=1024",
        ),
        (vec!["target", "--threads", "-1"], "-1 is not in 1..=1024"),
        (
            vec!["run", scene, "--threads", "--json"],
            "a value is required",
        ),
    ] {
        let output = host().args(&args).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {error}");
        assert!(error.contains(text), "{args:?}: {error}");
        assert!(!error.contains("tip:"), "{args:?}: {error}");
    }
}

/// Where a file cannot be written to its end, the error names it in its final place, and nothing is left.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_does_not_fit_is_named() {
    let folder = TempDir::new().unwrap();
    let scene = short_scene(folder.path(), |t| t);
    let out = folder.path().join("out");
    // No file above 8 KB: that needs no full disk, and ends the same way.
    let host = host().get_program().to_owned();
    let result = std::process::Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 16; exec \"$0\" run \"$1\" --out \"$2\"",
        ])
        .args([host, scene.into(), out.clone().into()])
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&result.stderr);
    assert_eq!(result.status.code(), Some(2), "{error}");
    let named = format!(
        "{}: file too large",
        out.join("trace_passive.parquet").display()
    );
    assert!(error.contains(&named), "{error}");
    assert!(error.contains("free some space there"), "{error}");
    assert_eq!(names(folder.path()), ["short.toml"]);
}
