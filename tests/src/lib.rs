//! What several tests share: plants, scenes, golden tables.

pub mod browser;
pub mod golden;
pub mod parameters;
pub mod per_unit;
pub mod plants;
pub mod ran;
pub mod recording;
pub mod requirements;
pub mod target;
pub mod terminal;

pub use test_support::{bearing, rig, storm};

use firmware_bench::scene::Scene;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Root of the workspace.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_owned()
}

/// Path of one of the project's scenes.
pub fn scene_path(name: &str) -> PathBuf {
    root().join(format!("firmware-host/scenes/{name}.toml"))
}

/// One of the project's scenes.
///
/// # Panics
/// If it cannot be loaded, with the reason.
pub fn scene(name: &str) -> Scene {
    Scene::load(&scene_path(name)).unwrap_or_else(|e| panic!("{e}"))
}

/// Python with what `tests/python/requirements.txt` names. `None` on a user's machine without it, with a message.
///
/// # Panics
/// In CI without it.
pub fn python() -> Option<PathBuf> {
    let python = root().join("target/tests-venv/bin/python");
    if !python.is_file() {
        target::skipped("target/tests-venv is missing");
        return None;
    }
    Some(python)
}

/// Names of all the project's scenes of one plane, in order.
///
/// # Panics
/// If their folder cannot be read.
pub fn scene_names() -> Vec<String> {
    names_in("firmware-host/scenes")
}

/// Names of all the project's scenes of a whole rotor, in order.
///
/// # Panics
/// If their folder cannot be read.
pub fn machine_scene_names() -> Vec<String> {
    names_in("firmware-host/scenes/machines")
}

fn names_in(folder: &str) -> Vec<String> {
    let folder = root().join(folder);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut names: Vec<String> = entries
        .filter_map(|e| Some(e.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|x| x == "toml"))
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

/// The host's binary, built by the same cargo call (tests/run builds it before the tests).
///
/// # Panics
/// If it is not there.
pub fn host() -> Command {
    let test = std::env::current_exe().unwrap_or_default();
    // target/<profile>/deps/<test>
    let folder = test.ancestors().nth(2).unwrap_or(&test);
    let binary = folder.join(format!("firmware-host{}", std::env::consts::EXE_SUFFIX));
    assert!(
        binary.exists(),
        "{} is missing: run tests/run",
        binary.display()
    );
    Command::new(binary)
}
