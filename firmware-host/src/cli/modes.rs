//! `modes SCENE.toml`: natural frequencies of a rotor over its spin, critical speeds, response to the unbalance, and how
//! its planes feel each other.

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::load;
use crate::cli::screen::print_wrapped;
use firmware_bench::modes::{Analysis, AnalysisError, Held, Range};
use firmware_bench::report::campbell;
use firmware_bench::scene::Scene;
use firmware_bench::scene::linear_loop::NoLoop;
use std::path::PathBuf;

/// Arguments of `modes`.
#[derive(Debug, Clone, clap::Args)]
pub struct ModesArgs {
    /// Scene file of a rotor that tilts or bends, e.g. firmware-host/scenes/machines/drop_of_both_ends.toml.
    pub scene: PathBuf,
    /// Highest spin in Hz [default: one and a half times that of the scene, 100 Hz at least].
    #[arg(long)]
    pub to_hz: Option<f64>,
    /// At how many spins from standstill to there, 2 to 1001.
    #[arg(long, default_value_t = 41)]
    pub points: usize,
    /// With the walls of all planes closed: contact springs and dampers hold the rotor.
    #[arg(long)]
    pub contact: bool,
    /// Under the levitation controller as it runs, sampled, late and behind lagging magnets: whether the loop is stable, its modes,
    /// sensitivity by ISO 14839-3, critical speeds with the separation that API 617 asks for.
    #[arg(long, conflicts_with = "contact")]
    pub levitated: bool,
    /// Write a page with the Campbell diagram and the response to the unbalance.
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Print JSON instead of the tables.
    #[arg(long)]
    pub json: bool,
}

/// Prints the modes.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &ModesArgs) -> Result<(), CommandError> {
    let numbers = |message: String, help: &str| CommandError::Numbers {
        message,
        help: help.to_owned(),
    };
    let scene = load(&args.scene)?;
    if !scene.has_axis() && !args.levitated {
        let message = format!("{} has a point mass in one plane", args.scene.display());
        let help = "give the rotor its inertias, or a [[shaft]], or look at its loop with --levitated: a point has no modes to find";
        return Err(numbers(message, help));
    }
    let to_hz = args.to_hz.unwrap_or_else(|| default_hz(&scene));
    if !(to_hz > 0.0 && to_hz <= 1e5) {
        let message = format!("--to-hz is {to_hz}");
        return Err(numbers(
            message,
            "give a spin in Hz, above 0 and at most 100000",
        ));
    }
    if !(2..=1001).contains(&args.points) {
        let message = format!("--points is {}", args.points);
        return Err(numbers(message, "give a number from 2 to 1001"));
    }
    let range = Range {
        to_hz,
        points: args.points,
        held: match (args.contact, args.levitated) {
            (true, _) => Held::Contact,
            (_, true) => Held::Levitated,
            _ => Held::Free,
        },
    };
    let analysis = Analysis::new(&scene, range).map_err(|error| match error {
        AnalysisError::Loop(NoLoop::NoController | NoLoop::External) => numbers(
            format!("--levitated: {}: {error}", args.scene.display()),
            "leave the option out, or give gains, filters or matrices",
        ),
        _ => CommandError::other("finding the modes", error),
    })?;
    if let Some(path) = &args.html {
        let page = campbell::html(&scene, &analysis)
            .map_err(|e| CommandError::other("drawing the page", e))?;
        std::fs::write(path, page).map_err(crate::cli::output::OutputError::at(path))?;
    }
    if args.json {
        return print(&(pretty(&analysis, "formatting the modes")? + "\n"));
    }
    print_wrapped(&campbell::text(&scene, &analysis))
}

fn default_hz(scene: &Scene) -> f64 {
    let spin_hz = scene.start.spin_rad_s.abs() / std::f64::consts::TAU;
    (1.5 * spin_hz).max(100.0)
}
