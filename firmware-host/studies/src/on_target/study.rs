//! What is run on the emulated processors, and as a study.

use super::budgets::{BudgetError, Budgets, Verdict, renew};
use super::counts::OfMode;
use super::emulator;
use super::images::Project;
use super::loops::in_the_loop;
use super::machines::{Build, MACHINES, Machine};
use super::measure::{Streams, TargetError, measure};
use super::numbers::Number;
use super::record::Length;
use super::results::{Report, TargetRow};
use crate::campaign::{self, Block, Chapter, Claim, Extent, Progress, StudyError, each};
use std::path::Path;

/// What is to be run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Streams that are replayed, counted and held against budgets.
    Replay {
        /// Quick replays 100 000 ticks instead of a million.
        extent: Extent,
        /// Whether the budgets are made of what is measured before.
        renew: bool,
    },
    /// The processors in closed loops with the plant.
    Loops,
}

/// Builds the images of the project around a folder and runs them on machines, on the threads of the pool that it is
/// called in.
///
/// # Errors
/// [`TargetError`].
pub fn run_on(
    folder: &Path,
    machines: &[Machine],
    wanted: Wanted,
    progress: &dyn Progress,
) -> Result<Report, TargetError> {
    // What is missing is reported before anything takes its time.
    let qemu = emulator::version()?;
    let project = Project::around(folder)?;
    Budgets::load(&project.budgets())?;
    let mut machines = machines.to_vec();
    if wanted == Wanted::Loops {
        let all: Vec<String> = machines.iter().map(Machine::title).collect();
        machines.retain(|m| m.number == Number::Float && m.build != Build::Bare);
        if machines.is_empty() {
            return Err(TargetError::NoLoop(all.join(", ")));
        }
    }
    let mut builds: Vec<(&'static str, Build)> = Vec::new();
    for machine in &machines {
        let build = (machine.target, machine.build);
        if !builds.contains(&build) {
            builds.push(build);
        }
    }
    progress.begin(
        (builds.len() + machines.len()) as u64,
        "builds and processors",
    );
    for (target, build) in builds {
        project.build(target, build)?;
        progress.add(1);
    }
    let mut report = Report {
        qemu,
        streams: Vec::new(),
        targets: Vec::new(),
        loops: Vec::new(),
    };
    match wanted {
        // One at a time: the pace is part of the result.
        Wanted::Loops => {
            for machine in &machines {
                report.loops.extend(in_the_loop(&project, machine)?);
                progress.add(1);
            }
        }
        Wanted::Replay { extent, renew } => {
            replay(&project, &machines, (extent, progress), &mut report)?;
            judge(&project, renew, &mut report.targets)?;
        }
    }
    Ok(report)
}

fn replay(
    project: &Project,
    machines: &[Machine],
    (extent, progress): (Extent, &dyn Progress),
    report: &mut Report,
) -> Result<(), TargetError> {
    let length = extent.pick(Length::QUICK, Length::FULL);
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
    let rows = each(&pairs, |(m, s)| {
        let row = measure(project, m, s);
        progress.add(1);
        row
    });
    report.targets = rows.into_iter().collect::<Result<_, TargetError>>()?;
    Ok(())
}

/// Holds the figures against their budgets, which may be made of them before.
fn judge(project: &Project, make: bool, rows: &mut [TargetRow]) -> Result<(), BudgetError> {
    if make {
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

/// Every processor, in the project around the working folder.
///
/// # Errors
/// [`TargetError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<campaign::Report, StudyError> {
    let wanted = Wanted::Replay {
        extent,
        renew: false,
    };
    let report = run_on(Path::new("."), &MACHINES, wanted, progress)?;
    Ok(campaign::Report {
        classes: Vec::new(),
        title: "On the target".to_owned(),
        claims: report.targets.iter().flat_map(claims).collect(),
        cases: (report.targets.iter())
            .filter_map(|t| Some(t.replayed.as_ref()?.ticks))
            .sum(),
        chapters: chapters(&report),
    })
}

/// What a tick costs.
pub fn chapters(report: &Report) -> Vec<Chapter> {
    let story = format!(
        "Instructions of a tick with the recorder's part, by {}.",
        report.qemu
    );
    vec![
        Chapter::new("A tick", vec![Block::text(story), ticks(report)]),
        Chapter::folded("By the mode after the tick", vec![by_mode(report)]),
        Chapter::new("Two planes in one tick", vec![two_planes(report)]),
    ]
}

fn name(row: &TargetRow) -> String {
    format!("{} {}", row.name, row.number)
}

fn ticks(report: &Report) -> Block {
    const COLUMNS: [&str; 9] = [
        "target",
        "least",
        "median",
        "worst",
        "worst of all replayed",
        "text [B]",
        "RAM [B]",
        "stack [B]",
        "bit-exact ticks",
    ];
    let row = |t: &TargetRow| {
        [
            name(t),
            t.min_instructions.to_string(),
            t.median_instructions.to_string(),
            t.worst_instructions.to_string(),
            (t.long_stream)
                .map_or(t.worst_instructions, |long| long.worst_instructions)
                .to_string(),
            t.text_bytes.to_string(),
            t.ram_bytes.to_string(),
            t.stack_bytes.to_string(),
            (t.replayed.as_ref()).map_or_else(String::new, |r| {
                format!("{} of {}", r.bit_exact_ticks, r.ticks)
            }),
        ]
    };
    Block::table(COLUMNS, report.targets.iter().map(row))
}

fn by_mode(report: &Report) -> Block {
    let modes = (report.targets.iter()).flat_map(|t| t.modes.iter().map(move |mode| (t, mode)));
    let row = |(t, mode): (&TargetRow, &OfMode)| {
        [
            name(t),
            mode.mode.to_owned(),
            mode.spread.ticks.to_string(),
            mode.spread.min_instructions.to_string(),
            mode.spread.median_instructions.to_string(),
            mode.spread.worst_instructions.to_string(),
        ]
    };
    Block::table(
        ["target", "mode", "ticks", "least", "median", "worst"],
        modes.map(row),
    )
}

fn two_planes(report: &Report) -> Block {
    let row = |t: &TargetRow| {
        let pair = t.pair?;
        Some([
            name(t),
            pair.median_instructions.to_string(),
            pair.worst_instructions.to_string(),
            pair.worst_half_instructions.to_string(),
            pair.ram_bytes.to_string(),
            pair.stack_bytes.to_string(),
        ])
    };
    let columns = [
        "target",
        "median",
        "worst",
        "worst half",
        "RAM without recorders [B]",
        "stack [B]",
    ];
    Block::table(columns, report.targets.iter().filter_map(row))
}

fn claims(row: &TargetRow) -> Vec<Claim> {
    let name = name(row);
    let exact = row.replayed.as_ref().map(|replayed| {
        Claim::at_least(
            format!("{name}: ticks with the bits of the host"),
            replayed.ticks as f64,
            replayed.bit_exact_ticks as f64,
        )
    });
    let budget = |v: &Verdict| {
        let bound = v.required.unwrap_or(v.budget).min(v.budget);
        Claim::at_most(
            format!("{name}: {}", v.figure.replace('_', " ")),
            bound as f64,
            v.measured as f64,
        )
    };
    exact
        .into_iter()
        .chain(row.budgets.iter().map(budget))
        .collect()
}
