//! `export TRACE.parquet`: a trace as CSV or MCAP, with its units and what it is of.

mod csv;
mod mcap;
mod table;

use self::table::Trace;
use crate::cli::error::{CommandError, print};
use crate::cli::output::{Staging, probe};
use clap::ValueEnum;
use std::path::{Path, PathBuf};

/// Arguments of `export`.
#[derive(Debug, Clone, clap::Args)]
pub struct ExportArgs {
    /// A trace, e.g. runs/impact_at_40_hz/trace_supervisor.parquet; any other Parquet file with a column t_s does as well.
    pub trace: PathBuf,
    /// To what.
    #[arg(long, value_enum)]
    pub to: Format,
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
}

/// Writes the trace in the other format.
///
/// # Errors
/// [`CommandError`], with nothing written.
pub fn execute(args: &ExportArgs) -> Result<(), CommandError> {
    let trace = Trace::open(&args.trace)?;
    let beside = args.trace.parent().unwrap_or(Path::new("."));
    let out = args.out.as_deref().unwrap_or(beside);
    let out = match out.as_os_str().is_empty() {
        true => Path::new("."),
        false => out,
    };
    probe(out)?;
    let staging = Staging::for_folder(out)?;
    let stem = args.trace.file_stem().unwrap_or_default();
    let stem = stem.to_string_lossy();
    let (name, rows) = match args.to {
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
        Format::Mcap => {
            let name = format!("{stem}.mcap");
            let mut rows = Ok(0);
            staging.write_by(&name, |file| mcap::write(&trace, file, &mut rows))?;
            (name, rows?)
        }
    };
    let folder = staging.publish()?;
    print(&format!("{name}: {rows} rows\nin {}\n", folder.display()))
}
