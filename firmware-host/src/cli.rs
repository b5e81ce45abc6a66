//! The commands, one file each.

pub mod accuracy;
pub mod advise;
mod chapters;
pub mod commission;
pub mod completions;
pub mod error;
pub mod export;
pub mod fmu;
pub mod harm;
pub mod init;
pub mod map;
pub mod modes;
pub mod output;
pub mod overloads;
mod progress;
pub mod review;
pub mod run;
pub mod schema;
pub mod screen;
pub mod sensitivity;
pub mod serve_controller;
pub mod study;
pub mod sweep;
pub mod target;
pub mod vectors;

use crate::cli::error::say;
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::spec::Spec;
use std::path::Path;

/// A scene, with its warnings said.
pub(crate) fn load(path: &Path) -> Result<Scene, SceneError> {
    load_changed(path, |_| Ok(()))
}

/// A scene with changes to what the file says, with its warnings said.
pub(crate) fn load_changed(
    path: &Path,
    change: impl FnOnce(&mut Spec) -> Result<(), SceneError>,
) -> Result<Scene, SceneError> {
    let mut spec = Spec::load(path)?;
    change(&mut spec)?;
    let scene = spec.resolve()?;
    warn(&scene.warnings);
    Ok(scene)
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        say(format_args!("warning: {warning}"));
    }
}
