//! Disks that are not what was hoped for.

use super::short_scene;
use std::process::Command;
use system_tests::host;
use system_tests::ran::{has, ran};

/// Where a file cannot be written to its end, the error names it in its final place, and nothing is left.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_does_not_fit_is_named() {
    let folder = short_scene(&[]);
    // No file above 8 KB: that needs no full disk, and ends the same way.
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" run \"$1\" --out \"$2\"";
    let mut sh = Command::new("sh");
    sh.args(["-c", limited]).arg(host().get_program());
    let error = ran(sh.arg(folder.at("short.toml")).arg(folder.at("out"))).fails(2);
    let named = folder.at("out/trace_passive.parquet").display().to_string();
    has(
        &error,
        &[&format!("{named}: file too large"), "free some space there"],
    );
    assert_eq!(folder.names("."), ["short.toml"]);
}
