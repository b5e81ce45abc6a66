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

/// Levels of optimisation beside the 3 of the profile `fw`.
pub const OTHER_LEVELS: [&str; 3] = ["2", "s", "z"];

/// For builds of which only is asked whether they link: without debug information, which takes half of the time.
pub const WITHOUT_DEBUG: [&str; 2] = ["--config", "profile.fw.debug=false"];

/// Makes a build in the profile `fw` one that optimises these two crates at another level, in a folder of its own under
/// `target-fw`. What they use stays at 3, so that it is compiled once for all levels: nearly all of it is generic or
/// inline, and so compiled with the crate that uses it.
pub fn at_level(cargo: &mut Command, level: &str, crates: [&str; 2]) {
    // Numbers stand alone in TOML, letters in quotes.
    let value = match level.parse::<u8>() {
        Ok(number) => number.to_string(),
        Err(_) => format!("\"{level}\""),
    };
    // What is shared, with the builds at level 3, too; only what is finished goes to the other folder.
    cargo.env("CARGO_BUILD_BUILD_DIR", "target-fw");
    cargo.args(["--target-dir", &format!("target-fw/{level}")]);
    cargo.args(WITHOUT_DEBUG);
    for name in crates {
        let setting = format!("profile.fw.package.{name}.opt-level={value}");
        cargo.args(["--config", &setting]);
    }
}

/// Builds images for a target with these further arguments. `None` as for [`target`].
///
/// # Panics
/// As [`target`].
pub fn build_some(target: &str, images: &[&str], more: &[&str]) -> Option<Output> {
    let mut cargo = build(target, images);
    cargo.args(["--target-dir", "target-fw"]).args(more);
    output(cargo, target)
}

/// The images that are only linked.
pub const PANIC_FREE: [&str; 2] = ["panic-free", "panic-free-q"];

/// The same at one of [`OTHER_LEVELS`].
///
/// # Panics
/// As [`target`].
pub fn build_at_level(target: &str, images: &[&str], level: &str, more: &[&str]) -> Option<Output> {
    let mut cargo = build(target, images);
    at_level(&mut cargo, level, ["amb-supervisor", "firmware-image"]);
    cargo.args(more);
    output(cargo, target)
}

fn build(target: &str, images: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(root());
    command.args(["build", "-p", "firmware-image", "--profile", "fw"]);
    command.args(["--target", target]);
    command.args(images.iter().map(|image| format!("--bin={image}")));
    command
}

fn output(mut cargo: Command, target: &str) -> Option<Output> {
    let output = cargo.output().unwrap_or_else(|e| panic!("{e}"));
    let error = String::from_utf8_lossy(&output.stderr);
    if error.contains("target may not be installed") {
        skipped(&format!("the Rust target {target} is not installed"));
        return None;
    }
    Some(output)
}
