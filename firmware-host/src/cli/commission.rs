//! `commission LOG`: the numbers of a machine from a recorded run in which its supervisor checked them.

mod configured;
mod show;

use crate::cli::advise::Format;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::output::OutputError;
use configured::Setup;
use firmware_bench::commission::Commissioned;
use firmware_bench::commission::log::Log;
use firmware_bench::commission::record::OfRecord;
use firmware_bench::log_file::{LogError, LogFile, Renamed};
use firmware_bench::record::file::RecordFile;
use firmware_bench::report::commission;
use std::path::{Path, PathBuf};

/// Arguments of `commission`.
#[derive(Debug, Clone, clap::Args)]
pub struct CommissionArgs {
    /// Log of one plane, as CSV, Parquet, MAT or MCAP: t_s, measured_x_m, measured_y_m, commanded_x_n, commanded_y_n,
    /// stimulus_x_n, stimulus_y_n and perhaps spin_rad_s, a row a tick. A trace of run is one. Of a rotor in two planes two logs, or
    /// one with PLANE.measured_x_m and so on. Or a flight record.
    #[arg(required = true, num_args = 1..=2, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// A column of the log that has another name, and perhaps another unit, e.g. measured_x_m=x1_um*1e-6.
    #[arg(long, value_name = "NAME=COLUMN[*FACTOR]")]
    pub column: Vec<Renamed>,
    /// Log of a walk, the rotor slowly led along its retainer bearing all the way round: clearance and centre.
    #[arg(long, value_name = "LOG")]
    pub walk: Option<PathBuf>,
    /// Scene of the machine: what its supervisor is configured with is compared with what is found. Of two planes it says what stands
    /// where.
    #[arg(long, value_name = "SCENE")]
    pub machine: Option<PathBuf>,
    /// Plane of that scene, from 0 on, of a log of one.
    #[arg(long, default_value_t = 0, requires = "machine")]
    pub plane: usize,
    /// Print what is found of the configuration as it is written in firmware or a scene, in place of the tables.
    #[arg(long, value_enum, conflicts_with = "json")]
    pub format: Option<Format>,
    /// Print JSON instead of the tables.
    #[arg(long)]
    pub json: bool,
    /// Write a page with the fits, too.
    #[arg(long, value_name = "FILE")]
    pub page: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &CommissionArgs) -> Result<(), CommandError> {
    let machine = args.machine.as_deref().map(Setup::load).transpose()?;
    let record = match &args.logs[..] {
        [path] if !LogFile::is_at(path) => record_at(path),
        _ => None,
    };
    let commissioned = match record {
        Some(file) => of_record(args, &file)?,
        None => of_logs(args, machine.as_ref())?,
    };
    if let Some(path) = &args.page {
        let name = args.logs[0].display().to_string();
        let page = commission::html(&name, &commissioned)
            .map_err(|e| CommandError::other("drawing the page", e))?;
        std::fs::write(path, page).map_err(OutputError::at(path))?;
    }
    if args.json {
        return print(&(pretty(&commissioned, "formatting what was found")? + "\n"));
    }
    match args.format {
        Some(format) => print(&show::listing(&commissioned.parameters, format)),
        None => show::tables(&commissioned),
    }
}

/// The records at this path, if that is what is in it.
fn record_at(path: &Path) -> Option<RecordFile> {
    let file = RecordFile::of(&std::fs::read(path).ok()?);
    (!file.records.is_empty()).then_some(file)
}

/// What a record tells, compared with what it says that its supervisor was configured with.
fn of_record(args: &CommissionArgs, file: &RecordFile) -> Result<Commissioned, CommandError> {
    let path = &args.logs[0];
    let no_log = |what: &str| {
        let message = format!(
            "{}: a flight record, and {what} is of a log",
            path.display()
        );
        wrong(message, "leave the option out, or give a log")
    };
    match (&args.walk, args.column.is_empty(), &args.machine) {
        (Some(_), ..) => return Err(no_log("--walk")),
        (_, false, _) => return Err(no_log("--column")),
        (.., Some(_)) => return Err(no_log("--machine")),
        _ => {}
    }
    let of = OfRecord::new(file).ok_or_else(|| {
        let message = format!("{}: no event is in it", path.display());
        wrong(message, "give the sections of a frozen record")
    })?;
    let mut found = of.found;
    found.compare(&of.configured);
    Ok(found)
}

fn of_logs(args: &CommissionArgs, machine: Option<&Setup>) -> Result<Commissioned, CommandError> {
    if let Some(logs) = of_both_planes(args, machine)? {
        let of = machine.ok_or_else(without_scene)?;
        if args.walk.is_some() {
            return Err(wrong(
                "--walk is of one plane, and the log is of two".to_owned(),
                "give the log of each plane by itself with its walk",
            ));
        }
        let places = of.two_planes()?;
        let mut found =
            (Commissioned::of_rotor(&logs, &places)).map_err(|e| refused(&args.logs[0], e))?;
        found.compare(&of.of_rotor(&places)?);
        return Ok(found);
    }
    let path = &args.logs[0];
    let log = Log::read(path, &args.column).map_err(|e| refused(path, e))?;
    let mut found = Commissioned::of(&log).map_err(|e| refused(path, e))?;
    match &args.walk {
        Some(walk) => {
            let positions_m = Log::positions(walk, &args.column).map_err(|e| refused(walk, e))?;
            (found.with_walk(&positions_m)).map_err(|e| refused(walk, e))?;
        }
        None => found.without_walk(),
    }
    if let Some(machine) = machine {
        found.compare(&machine.of_plane(args.plane)?);
    }
    Ok(found)
}

/// Logs of both planes, where there are two or one has both.
fn of_both_planes(
    args: &CommissionArgs,
    machine: Option<&Setup>,
) -> Result<Option<[Log; 2]>, CommandError> {
    if let [first, second] = &args.logs[..] {
        let read = |path: &Path| Log::read(path, &args.column).map_err(|e| refused(path, e));
        let logs = [read(first)?, read(second)?];
        let [a, b] = &logs;
        a.goes_with(b).map_err(|e| refused(second, e))?;
        return Ok(Some(logs));
    }
    let path = &args.logs[0];
    match machine.filter(|machine| machine.has_two_planes()) {
        Some(machine) => {
            let names = machine.two_planes()?.names;
            Log::of_planes(path, &args.column, &names).map_err(|e| refused(path, e))
        }
        None => Ok(None),
    }
}

fn without_scene() -> CommandError {
    wrong(
        "two logs, and no scene of their machine".to_owned(),
        "give the scene with --machine: what stands where along the rotor is not in a log",
    )
}

fn wrong(message: String, help: &str) -> CommandError {
    CommandError::Numbers {
        message,
        help: help.to_owned(),
    }
}

fn refused(path: &Path, LogError { message, help }: LogError) -> CommandError {
    CommandError::Numbers {
        message: format!("{}: {message}", path.display()),
        help,
    }
}
