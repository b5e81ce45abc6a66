//! `target`: the supervisor on emulated processors, bit for bit, with its figures against their budgets.

mod show;

use crate::commands::error::{CommandError, print};
use crate::commands::progress::pool;
use crate::target::budgets::Budgets;
use crate::target::emulator;
use crate::target::images::Project;
use crate::target::loops::in_the_loop;
use crate::target::machines::{MACHINES, Machine};
use crate::target::measure::{Streams, TargetError, measure};
use crate::target::record::Length;
use crate::target::results::Report;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
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
    /// Only this processor: M3, M4F or M7. May be repeated.
    #[arg(long, value_name = "NAME", ignore_case = true, value_parser = names())]
    pub only: Vec<String>,
    /// The project's folder, or one in it.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub project: PathBuf,
    /// Threads to use [default: all cores]. Results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

fn names() -> clap::builder::PossibleValuesParser {
    MACHINES.map(|m| m.name).into()
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
    let text = if args.json {
        let pretty = serde_json::to_string_pretty(&report);
        let pretty = pretty.map_err(|e| CommandError::other("formatting the results", e))?;
        format!("{pretty}\n")
    } else {
        show::text(&report)
    };
    print(&text)?;
    match report.failures() {
        none if none.is_empty() => Ok(()),
        failures => Err(CommandError::Targets(failures)),
    }
}

fn run(args: &TargetArgs, machines: &[Machine]) -> Result<Report, CommandError> {
    // What is missing is told before anything takes its time.
    let qemu = emulator::version().map_err(TargetError::from)?;
    let project = Project::around(&args.project).map_err(TargetError::from)?;
    let budgets = Budgets::load(&project.budgets()).map_err(TargetError::from)?;
    let mut targets: Vec<&'static str> = machines.iter().map(|m| m.target).collect();
    targets.sort_unstable();
    targets.dedup();
    for target in targets {
        project.build(target).map_err(TargetError::from)?;
    }
    let mut report = Report {
        qemu,
        stream: None,
        targets: Vec::new(),
        loops: Vec::new(),
    };
    if args.in_loop {
        // One at a time: the pace is part of the result.
        for machine in machines {
            report.loops.extend(in_the_loop(&project, machine)?);
        }
        return Ok(report);
    }
    let length = if args.quick {
        Length::QUICK
    } else {
        Length::FULL
    };
    report.targets = pool(args.threads)?.install(|| {
        let streams = Streams::record(length)?;
        report.stream = Some(streams.row.clone());
        let one = |machine| measure(&project, machine, &streams, &budgets);
        machines
            .par_iter()
            .map(one)
            .collect::<Result<_, TargetError>>()
    })?;
    Ok(report)
}
