//! `target`: the supervisor on emulated processors, bit for bit, with its figures against their budgets.

mod show;

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::progress::Threads;
use firmware_studies::on_target::budgets::{BudgetError, Budgets, renew};
use firmware_studies::on_target::emulator;
use firmware_studies::on_target::images::Project;
use firmware_studies::on_target::loops::in_the_loop;
use firmware_studies::on_target::machines::{MACHINES, Machine};
use firmware_studies::on_target::measure::{Streams, TargetError, measure};
use firmware_studies::on_target::numbers::Number;
use firmware_studies::on_target::record::Length;
use firmware_studies::on_target::results::{Report, TargetRow};
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
    let text = if args.json {
        pretty(&report, "formatting the results")? + "\n"
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
    Budgets::load(&project.budgets()).map_err(TargetError::from)?;
    let mut machines = machines.to_vec();
    if args.in_loop {
        let all: Vec<String> = machines.iter().map(Machine::title).collect();
        machines.retain(|m| m.number == Number::Float);
        if machines.is_empty() {
            return Err(TargetError::NoLoop(all.join(", ")).into());
        }
    }
    let mut targets: Vec<&'static str> = machines.iter().map(|m| m.target).collect();
    targets.sort_unstable();
    targets.dedup();
    for target in targets {
        project.build(target).map_err(TargetError::from)?;
    }
    let mut report = Report {
        qemu,
        streams: Vec::new(),
        targets: Vec::new(),
        loops: Vec::new(),
    };
    if args.in_loop {
        // One at a time: the pace is part of the result.
        for machine in &machines {
            report.loops.extend(in_the_loop(&project, machine)?);
        }
        return Ok(report);
    }
    let length = if args.quick {
        Length::QUICK
    } else {
        Length::FULL
    };
    report.targets = args.threads.pool()?.install(|| {
        let mut work = Vec::new();
        for number in [Number::Float, Number::Fixed] {
            if machines.iter().any(|m| m.number == number) {
                let streams = Streams::record(number, length)?;
                report.streams.push(streams.row.clone());
                work.push((number, streams));
            }
        }
        // Each machine with the stream of its numbers, in the order of the table.
        let pairs: Vec<(&Machine, &Streams)> = (machines.iter())
            .filter_map(|m| Some((m, &work.iter().find(|(n, _)| *n == m.number)?.1)))
            .collect();
        let rows = pairs.par_iter().map(|(m, s)| measure(&project, m, s));
        rows.collect::<Result<Vec<_>, TargetError>>()
    })?;
    judge(args, &project, &mut report.targets).map_err(TargetError::from)?;
    Ok(report)
}

/// Holds the figures against their budgets, which may be made of them before.
fn judge(args: &TargetArgs, project: &Project, rows: &mut [TargetRow]) -> Result<(), BudgetError> {
    if args.renew {
        let figures: Vec<_> = (rows.iter())
            .map(|row| (row.name, row.number, row.figures()))
            .collect();
        renew(&project.budgets(), &figures)?;
    }
    let budgets = Budgets::load(&project.budgets())?;
    for row in rows {
        row.budgets = budgets.judge(row.name, row.number, &row.figures())?;
    }
    Ok(())
}
