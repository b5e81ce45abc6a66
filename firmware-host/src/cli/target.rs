//! `target`: the supervisor on emulated processors, bit for bit, with its figures against their budgets.

mod show;

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_studies::campaign::Extent;
use firmware_studies::on_target::machines::{MACHINES, Machine};
use firmware_studies::on_target::results::Report;
use firmware_studies::on_target::study::{Wanted, run_on};
use std::path::PathBuf;

/// Arguments of `target`.
#[derive(Debug, Clone, clap::Args)]
pub struct TargetArgs {
    /// Print JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// Replay 100 000 ticks instead of a million. Counted are the same ticks in both.
    #[arg(long)]
    pub quick: bool,
    /// Instead: put the emulated processors into closed loops with the plant, and compare with the host alone.
    #[arg(long = "loop", conflicts_with = "quick")]
    pub in_loop: bool,
    /// Write what is measured into the [budget.*] tables of budgets.toml.
    #[arg(long, conflicts_with = "in_loop")]
    pub renew: bool,
    /// Only this processor: M3, M0, M4F or M7. May be repeated.
    #[arg(long, value_name = "NAME", ignore_case = true, value_parser = names())]
    pub only: Vec<String>,
    /// The project's folder, or one in it.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub project: PathBuf,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

fn names() -> clap::builder::PossibleValuesParser {
    let mut names: Vec<&'static str> = Vec::new();
    for machine in MACHINES {
        if !names.contains(&machine.name) {
            names.push(machine.name);
        }
    }
    names.into()
}

/// Builds the images, runs them and prints what came out.
///
/// # Errors
/// [`CommandError`]; [`CommandError::Targets`] after the results were printed.
pub fn execute(args: &TargetArgs) -> Result<(), CommandError> {
    let machines: Vec<Machine> = (MACHINES.into_iter())
        .filter(|m| {
            let named = |n: &String| n.eq_ignore_ascii_case(m.name);
            args.only.is_empty() || args.only.iter().any(named)
        })
        .collect();
    let report = run(args, &machines)?;
    match args.json {
        true => print(&(pretty(&report, "formatting the results")? + "\n"))?,
        false => print_wrapped(&show::text(&report))?,
    }
    match report.failures() {
        none if none.is_empty() => Ok(()),
        failures => Err(CommandError::Targets(failures)),
    }
}

fn run(args: &TargetArgs, machines: &[Machine]) -> Result<Report, CommandError> {
    let wanted = match (args.in_loop, args.quick) {
        (true, _) => Wanted::Loops,
        (false, quick) => Wanted::Replay {
            extent: Extent::new(quick),
            renew: args.renew,
        },
    };
    let progress = LateProgress::default();
    let run = || run_on(&args.project, machines, wanted, &progress);
    let report = (args.threads.pool()?).install(run);
    progress.finish();
    Ok(report?)
}
