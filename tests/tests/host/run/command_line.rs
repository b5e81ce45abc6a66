//! Disks that are not what was hoped for.

use super::{names, short_scene};
use system_tests::host;
use tempfile::TempDir;

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
