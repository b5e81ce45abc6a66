//! Images: built by cargo, found again, and looked into.

use super::machines::{Build, MACHINES, Machine};
use super::numbers::Number;
use object::{Object, ObjectSection, SectionKind};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Why there is no image.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ImageError {
    /// The sources of the images are not here.
    #[error("{} is not inside the project: there is no firmware-host/image", .0.display())]
    #[diagnostic(help("run it inside the project's folder, or give that with --project"))]
    NoProject(PathBuf),
    /// Cargo does not start.
    #[error("cargo cannot be started: {0}")]
    #[diagnostic(help("install Rust from https://rustup.rs"))]
    NoCargo(io::Error),
    /// The compiler's library for the target is missing.
    #[error("the Rust target {0} is not installed")]
    #[diagnostic(help("rustup target add {0}"))]
    NoTarget(&'static str),
    /// The panic handler was needed.
    #[error("a panic can be reached in an image for {0}")]
    #[diagnostic(help(
        "images link only without a path to a panic; look for indexing, unwrap, division or clamp in what has changed"
    ))]
    Panics(&'static str),
    /// Something else does not build.
    #[error("the images for {target} do not build:\n{output}")]
    Build {
        target: &'static str,
        /// cargo's message.
        output: String,
    },
    /// An image is not what it should be.
    #[error("{}: {reason}", image.display())]
    Image {
        /// File.
        image: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// The project's folder and where its images go.
#[derive(Debug, Clone)]
pub struct Project {
    root: PathBuf,
}

impl Project {
    /// The project that contains a folder.
    ///
    /// # Errors
    /// [`ImageError::NoProject`].
    pub fn around(folder: &Path) -> Result<Self, ImageError> {
        let here = (folder.canonicalize()).map_err(|_| ImageError::NoProject(folder.to_owned()))?;
        let root = here.ancestors().find(|f| f.join(MANIFEST).is_file());
        root.map(|root| Self {
            root: root.to_owned(),
        })
        .ok_or_else(|| ImageError::NoProject(folder.to_owned()))
    }

    /// Builds the images for a target that are run or measured on it.
    ///
    /// # Errors
    /// [`ImageError`].
    pub fn build(&self, target: &'static str, build: Build) -> Result<(), ImageError> {
        // Under `cargo run` the same cargo.
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut cargo = Command::new(cargo);
        cargo
            .current_dir(&self.root)
            .args(["build", "-p", "firmware-image"])
            .args(["--profile", "fw", "--target", target])
            .args(["--target-dir", &build.folder()])
            // What they use is compiled once for all that share it.
            .env("CARGO_BUILD_BUILD_DIR", Build::Usual.folder());
        match build {
            Build::Usual => {}
            Build::For(processor) => {
                cargo.env("RUSTFLAGS", format!("-C target-cpu={processor}"));
            }
            Build::Bare => {
                cargo.arg("--no-default-features");
            }
        }
        for machine in (MACHINES.iter()).filter(|m| (m.target, m.build) == (target, build)) {
            cargo.args(match (machine.number, build) {
                (Number::Float, Build::Bare) => &COUNTED[..],
                (Number::Float, _) => &FLOATS,
                (Number::Fixed, _) => &FIXED,
            });
        }
        let output = cargo.output().map_err(ImageError::NoCargo)?;
        if output.status.success() {
            return Ok(());
        }
        let text = String::from_utf8_lossy(&output.stderr);
        Err(if text.contains("target may not be installed") {
            ImageError::NoTarget(target)
        } else if text.contains("a_panic_can_be_reached") {
            ImageError::Panics(target)
        } else {
            ImageError::Build {
                target,
                output: text.into_owned(),
            }
        })
    }

    /// An image that has been built.
    pub fn image(&self, machine: &Machine, name: &str) -> PathBuf {
        let folder = self.root.join(machine.build.folder());
        folder.join(machine.target).join("fw").join(name)
    }

    /// The file of budgets.
    pub fn budgets(&self) -> PathBuf {
        self.root.join("firmware-host/image/budgets.toml")
    }

    /// Size of the supervisor on a machine.
    ///
    /// # Errors
    /// [`ImageError::Image`].
    pub fn text(&self, machine: &Machine) -> Result<Text, ImageError> {
        let image = self.image(machine, &machine.number.image("panic-free"));
        let wrong = |reason: &dyn ToString| ImageError::Image {
            image: image.clone(),
            reason: reason.to_string(),
        };
        let bytes = std::fs::read(&image).map_err(|e| wrong(&e))?;
        let file = object::File::parse(bytes.as_slice()).map_err(|e| wrong(&e))?;
        let of_kind = |kind: SectionKind| -> u64 {
            let sections = file.sections().filter(|s| s.kind() == kind);
            sections.map(|s| s.size()).sum()
        };
        Ok(Text {
            code_bytes: of_kind(SectionKind::Text),
            constant_bytes: of_kind(SectionKind::ReadOnlyData),
        })
    }
}

/// Images in floats that are measured.
const FLOATS: [&str; 6] = [
    "--bin=panic-free",
    "--bin=count",
    "--bin=count-pair",
    "--bin=count-half",
    "--bin=replay",
    "--bin=in-the-loop",
];
/// Images in fixed point that are.
const FIXED: [&str; 3] = ["--bin=panic-free-q", "--bin=count-q", "--bin=replay-q"];
/// Those of floats that are not compared with the host.
const COUNTED: [&str; 4] = [
    "--bin=panic-free",
    "--bin=count",
    "--bin=count-pair",
    "--bin=count-half",
];
const MANIFEST: &str = "firmware-host/image/Cargo.toml";

/// What the supervisor takes of the flash, with everything that it calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Text {
    /// Instructions.
    pub code_bytes: u64,
    /// Tables and texts.
    pub constant_bytes: u64,
}
