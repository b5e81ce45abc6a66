//! `export TRACE.parquet`: a trace as CSV or MCAP, with its units and what it is of. `export SCENE.toml --plant`: what a
//! controller is designed for, as matrices.

mod csv;
mod mat;
mod mcap;
mod table;

use self::table::Trace;
use crate::cli::error::{CommandError, print};
use crate::cli::load;
use crate::cli::output::{Staging, probe};
use clap::ValueEnum;
use firmware_bench::scene::linear_loop::{DesignPlant, NoLoop};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Arguments of `export`.
#[derive(Debug, Clone, clap::Args)]
pub struct ExportArgs {
    /// A trace, e.g. runs/impact_at_40_hz/trace_supervisor.parquet; any other Parquet file with a column t_s does as well. With
    /// --plant a scene file.
    #[arg(value_name = "TRACE|SCENE")]
    pub of: PathBuf,
    /// To what [default with --plant: npz].
    #[arg(long, value_enum, required_unless_present = "plant")]
    pub to: Option<Format>,
    /// Of a scene, what its levitation controller has before it, from commanded forces to readings, about the middle at a spin:
    /// A, B, C, D in continuous time and Ad, Bd, Cd, Dd from sample to sample, with delays.
    #[arg(long)]
    pub plant: bool,
    /// Spin of the plant in Hz [default: that of the scene].
    #[arg(long, requires = "plant")]
    pub spin_hz: Option<f64>,
    /// Where the file goes [default: the folder of the trace].
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

/// What a trace may be written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table of text; units and metadata in a file beside it, as CSV on the Web has them.
    Csv,
    /// Messages in JSON with their schema, for Foxglove and PlotJuggler.
    Mcap,
    /// Of a plant: arrays of NumPy.
    Npz,
    /// Of a plant: a MAT file.
    Mat,
}

/// Writes the trace, or the plant of a scene, in the other format.
///
/// # Errors
/// [`CommandError`], with nothing written.
pub fn execute(args: &ExportArgs) -> Result<(), CommandError> {
    let (of_a_trace, to) = match (args.plant, args.to) {
        (true, to) => (false, to.unwrap_or(Format::Npz)),
        (false, to) => (true, to.unwrap_or(Format::Csv)),
    };
    if of_a_trace != matches!(to, Format::Csv | Format::Mcap) {
        return Err(CommandError::Numbers {
            message: "--to: traces go to csv or mcap, plants to npz or mat".to_owned(),
            help: "give --plant with a scene file, or another format".to_owned(),
        });
    }
    let beside = args.of.parent().unwrap_or(Path::new("."));
    let out = args.out.as_deref().unwrap_or(beside);
    let out = match out.as_os_str().is_empty() {
        true => Path::new("."),
        false => out,
    };
    let stem = args.of.file_stem().unwrap_or_default();
    let stem = stem.to_string_lossy();
    if of_a_trace {
        trace(args, to, out, &stem)
    } else {
        plant(args, to, out, &stem)
    }
}

fn plant(args: &ExportArgs, to: Format, out: &Path, stem: &str) -> Result<(), CommandError> {
    let scene = load(&args.of)?;
    let of_scene = scene.start.spin_rad_s;
    let spin_rad_s = args.spin_hz.map_or(of_scene, |hz| hz * TAU);
    let refused = |message: String, help: &str| CommandError::Numbers {
        message,
        help: help.to_owned(),
    };
    if !spin_rad_s.is_finite() {
        let message = format!("--spin-hz is {}", args.spin_hz.unwrap_or_default());
        return Err(refused(message, "give a finite number of turns a second"));
    }
    let plant = DesignPlant::new(&scene, spin_rad_s).map_err(|error| match error {
        NoLoop::NoController => {
            let message = format!("{} has no magnet", args.of.display());
            refused(
                message,
                "add a [magnet]: without one there is nothing to command",
            )
        }
        error => CommandError::other("making the plant", error),
    })?;
    probe(out)?;
    let staging = Staging::for_folder(out)?;
    let name = match to {
        Format::Mat => {
            let name = format!("{stem}_plant.mat");
            staging.write(&name, mat::write(&plant))?;
            name
        }
        _ => {
            let name = format!("{stem}_plant.npz");
            let bytes = plant.npz();
            staging.write(&name, bytes.map_err(|e| CommandError::other("packing", e))?)?;
            name
        }
    };
    let folder = staging.publish()?;
    let [a, b, c, _] = &plant.continuous;
    print(&format!(
        "{name}: {} states, {} forces, {} readings at {} Hz, every {} s\nin {}\n",
        a.nrows(),
        b.ncols(),
        c.nrows(),
        spin_rad_s / TAU,
        plant.names.sample_period_s,
        folder.display()
    ))
}

fn trace(args: &ExportArgs, to: Format, out: &Path, stem: &str) -> Result<(), CommandError> {
    let trace = Trace::open(&args.of)?;
    probe(out)?;
    let staging = Staging::for_folder(out)?;
    let (name, rows) = match to {
        Format::Csv => {
            let name = format!("{stem}.csv");
            let mut rows = Ok(0);
            staging.write_by(&name, |file| csv::write(&trace, file, &mut rows))?;
            staging.write(
                &format!("{name}-metadata.json"),
                csv::metadata(&trace, &name),
            )?;
            (name, rows?)
        }
        _ => {
            let name = format!("{stem}.mcap");
            let mut rows = Ok(0);
            staging.write_by(&name, |file| mcap::write(&trace, file, &mut rows))?;
            (name, rows?)
        }
    };
    let folder = staging.publish()?;
    print(&format!("{name}: {rows} rows\nin {}\n", folder.display()))
}
