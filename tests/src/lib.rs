//! What several tests share: plants, scenes, golden tables.

pub mod cost;
pub mod golden;
pub mod plants;

use firmware_host::scene::Scene;
use std::path::{Path, PathBuf};

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
