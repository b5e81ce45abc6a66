//! The host's command for emulated processors, and what happens where there is no emulator.

use std::process::{Command, Output};

use crate::{host, root};

/// Runs `firmware-host target` with these arguments inside the project.
///
/// `None` on a user's machine without the emulator or a target of the compiler, with a message; in CI that is a
/// failure.
///
/// # Panics
/// In CI, with what is missing.
pub fn target(args: &[&str]) -> Option<Output> {
    let output = host()
        .current_dir(root())
        .arg("target")
        .args(args)
        .output()
        .unwrap_or_else(|e| panic!("{e}"));
    let error = String::from_utf8_lossy(&output.stderr);
    if output.status.success() || !error.contains("is not installed") {
        return Some(output);
    }
    skipped(&error);
    None
}

/// Says why a test is left out.
///
/// # Panics
/// In CI: there nothing may be left out.
pub fn skipped(why: &str) {
    assert!(std::env::var_os("CI").is_none(), "{why}");
    eprintln!("skipped: {}; tests/run installs what is needed", why.trim());
}

/// Builds images for a target with these further arguments. `None` as for [`target`].
///
/// # Panics
/// As [`target`].
pub fn build_images(target: &str, more: &[&str]) -> Option<Output> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(root())
        .args(["build", "-p", "firmware-image", "--bins"])
        .args(["--profile", "fw", "--target", target])
        .args(["--target-dir", "target-fw"])
        .args(more)
        .output()
        .unwrap_or_else(|e| panic!("{e}"));
    let error = String::from_utf8_lossy(&output.stderr);
    if error.contains("target may not be installed") {
        skipped(&format!("the Rust target {target} is not installed"));
        return None;
    }
    Some(output)
}
