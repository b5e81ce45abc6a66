//! `fmu SCENE.toml`: plant, supervisor and closed loop of a scene as co-simulation units.

use crate::cli::error::{CommandError, print, say};
use crate::cli::load;
use crate::cli::output::{Staging, probe};
use clap::ValueEnum;
use firmware_bench::scene::spec::Spec;
use firmware_fmu::bundle::bundle;
use firmware_fmu::unit::{Unit, Version, Which};
use std::path::{Path, PathBuf};

/// Arguments of `fmu`.
#[derive(Debug, Clone, clap::Args)]
pub struct FmuArgs {
    /// Scene file, e.g. firmware-host/scenes/impact_at_40_hz.toml.
    pub scene: PathBuf,
    /// Folder for plant.fmu, supervisor.fmu and closed_loop.fmu [default: runs/ and the name of the scene file].
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Version of the interface.
    #[arg(long, value_enum, default_value_t = Fmi::V3)]
    pub fmi: Fmi,
    /// The library that runs in the units [default: libfirmware_fmu.so beside this program].
    #[arg(long, value_name = "FILE")]
    pub library: Option<PathBuf>,
}

/// Version of the Functional Mock-up Interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Fmi {
    /// 3.0, of 2022.
    #[value(name = "3.0")]
    V3,
    /// 2.0, of 2014.
    #[value(name = "2.0")]
    V2,
}

const LIBRARY: &str = "libfirmware_fmu.so";

/// Writes the units of the scene.
///
/// # Errors
/// [`CommandError`], with nothing written.
pub fn execute(args: &FmuArgs) -> Result<(), CommandError> {
    // What it warns of is said once, not for each unit.
    load(&args.scene)?;
    let own = Path::new("runs").join(args.scene.file_stem().unwrap_or(args.scene.as_os_str()));
    let out = args.out.clone().unwrap_or(own);
    probe(&out)?;
    let library = library(args.library.as_deref())?;
    let version = match args.fmi {
        Fmi::V3 => Version::Fmi3,
        Fmi::V2 => Version::Fmi2,
    };
    let staging = Staging::for_folder(&out)?;
    let mut written = Vec::new();
    for which in Which::ALL {
        let spec = Spec::load(&args.scene)?.without_warnings();
        let Some(unit) = Unit::new(which, spec)? else {
            say(format_args!(
                "warning: no {}.fmu: the scene has no policy supervisor",
                which.name()
            ));
            continue;
        };
        let bytes = bundle(&unit, &args.scene, version, &library)
            .map_err(|error| CommandError::other("making a unit", error))?;
        let name = format!("{}.fmu", which.name());
        staging.write(&name, bytes)?;
        let variables = unit.variables().len();
        written.push(format!("{name}: {variables} variables\n"));
    }
    // A unit of an earlier scene would be taken for one of this scene.
    let is_unit = |name: &str| {
        let units = Which::ALL.iter().map(|which| which.name());
        name.strip_suffix(".fmu")
            .is_some_and(|name| units.clone().any(|unit| unit == name))
    };
    let folder = staging.publish_over(is_unit)?;
    print(&format!("{}in {}\n", written.concat(), folder.display()))
}

/// The library's bytes.
fn library(given: Option<&Path>) -> Result<Vec<u8>, CommandError> {
    let beside = || {
        let here = std::env::current_exe().ok()?;
        let folder = here.parent()?;
        // Where cargo leaves what the program is linked with.
        let places = [folder.join(LIBRARY), folder.join("deps").join(LIBRARY)];
        places.into_iter().find(|place| place.is_file())
    };
    let refused = |message: String, help: &str| CommandError::Numbers {
        message,
        help: help.to_owned(),
    };
    let place = given.map(Path::to_owned).or_else(beside).ok_or_else(|| {
        refused(
            format!("{LIBRARY} is not beside this program"),
            "build it with cargo build --release -p firmware-fmu, or name it with --library",
        )
    })?;
    std::fs::read(&place).map_err(|reason| {
        refused(
            format!("{}: {reason}", place.display()),
            "give the library by its path with --library",
        )
    })
}
