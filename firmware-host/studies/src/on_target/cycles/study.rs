//! Cycles of ticks as a study.

use super::disassembly::Instruction;
use super::table::{Counter, Cycles, Kind, Processor};
use super::trace::{TraceError, Traced, trace};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError};
use crate::on_target::counts::ticks_of;
use crate::on_target::emulator;
use crate::on_target::images::Project;
use crate::on_target::machines::{Build, MACHINES, Machine};
use crate::on_target::measure::{TargetError, count_words};
use crate::on_target::numbers::Number;
use crate::on_target::record::{Length, Stream};
use crate::on_target::tape::Piece;
use std::collections::HashMap;
use std::fs::File;
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

/// Ticks of each piece of the stream that are traced: from the first on, so that what goes before is the same as in the whole stream.
const OF_A_PIECE: usize = 60;
/// A trace takes seconds; more only where the emulator hangs.
const LIMIT: Duration = Duration::from_secs(600);

/// Those that Arm has published cycles of, with a clock that is usual for parts with them, in MHz.
const MODELLED: [(&str, Number, Processor, f64); 4] = [
    ("M4F", Number::Float, Processor::CortexM4F, 168.0),
    ("M4F-bare", Number::Float, Processor::CortexM4F, 168.0),
    ("M3", Number::Fixed, Processor::CortexM3, 120.0),
    ("M0", Number::Fixed, Processor::CortexM0, 48.0),
];

/// A tick of a path.
#[derive(Debug, Clone, Copy)]
struct Tick {
    instructions: u32,
    /// Of these, those that are there whatever compiles it, see [`is_needed`].
    needed: u32,
    cycles: Cycles,
}

impl Tick {
    /// Cycles an instruction.
    fn each(&self) -> (f64, f64) {
        let n = f64::from(self.instructions.max(1));
        (
            f64::from(self.cycles.low) / n,
            f64::from(self.cycles.high) / n,
        )
    }
}

/// What a machine's ticks take.
struct Row {
    machine: &'static Machine,
    clock_mhz: f64,
    /// All that were traced.
    ticks: Vec<Tick>,
    /// Of these, as many instructions as the clock counted.
    agreeing: usize,
    /// The one with most instructions in the stream.
    worst: Tick,
    /// Instructions of the stream's median tick; and how many are needed in traced ticks that have about as many, on average.
    median: (u32, f64),
    /// What it is made of: instructions and cycles at most.
    mix: Vec<(&'static str, u32, Cycles)>,
}

/// The pieces to trace: some beginnings, and up to its dearest tick the piece that has it, which comes last.
fn chosen(stream: &Stream, words: &[u8], beginnings: usize) -> Vec<Piece> {
    let counts: Vec<u32> = ticks_of(words).map(|(n, _)| n).collect();
    let dearest = (counts.iter().enumerate())
        .max_by_key(|(_, n)| **n)
        .map_or(0, |(at, _)| at);
    let mut first = 0;
    let mut with_dearest = None;
    for piece in &stream.pieces {
        if (first..first + piece.ticks.len()).contains(&dearest) {
            with_dearest = Some(cut(piece, dearest + 1 - first));
        }
        first += piece.ticks.len();
    }
    let step = stream.pieces.len().div_ceil(beginnings).max(1);
    let beginnings = stream
        .pieces
        .iter()
        .step_by(step)
        .map(|piece| cut(piece, OF_A_PIECE));
    beginnings.chain(with_dearest).collect()
}

fn cut(piece: &Piece, ticks: usize) -> Piece {
    Piece {
        config: piece.config,
        ticks: piece.ticks.iter().take(ticks).copied().collect(),
    }
}

/// Whether an instruction is the algorithm's. What moves floats between registers, announces conditions, or reads and writes
/// the frame or the constants beside the code is the compiler's: a better one might do without.
fn is_needed(kind: Kind, instruction: &Instruction) -> bool {
    let beside = |base: &&str| instruction.operands.contains(*base);
    !matches!(kind, Kind::FloatMove | Kind::Choice) && !["[sp", "[pc"].iter().any(beside)
}

/// Ticks within this share of the median are about as dear.
const ABOUT: f64 = 0.01;

/// What is needed of ticks that are about as dear as the median one, on average.
fn needed_about(median: u32, ticks: &[Tick]) -> f64 {
    let off = |tick: &&Tick| f64::from(tick.instructions.abs_diff(median));
    let near = ticks.iter().filter(|t| off(t) <= ABOUT * f64::from(median));
    let (count, sum) = near.fold((0.0, 0.0), |(n, sum), t| {
        (n + 1.0, sum + f64::from(t.needed))
    });
    sum / count
}

/// Instructions and cycles by kind.
type Mix = HashMap<Kind, (u32, Cycles)>;

/// Cycles of a path, and what it is made of.
fn cost(traced: &Traced, processor: Processor, path: &[u32]) -> Result<(Tick, Mix), TraceError> {
    let mut counter = Counter::new(processor);
    let mut mix = Mix::new();
    let mut needed = 0;
    for (at, address) in path.iter().enumerate() {
        // The last one returns.
        let then = path.get(at + 1).copied().unwrap_or(u32::MAX - 1);
        let instruction = traced.at(*address)?;
        let (kind, cycles) = counter.add(instruction, then);
        needed += u32::from(is_needed(kind, instruction));
        let (instructions, sum) = mix.entry(kind).or_default();
        *instructions += 1;
        sum.low += cycles.low;
        sum.high += cycles.high;
    }
    if let Some((_, cycles)) = mix.get_mut(&Kind::FloatDivide) {
        cycles.low += counter.waited();
    }
    let tick = Tick {
        instructions: path.len() as u32,
        needed,
        cycles: counter.total(),
    };
    Ok((tick, mix))
}

fn row(
    project: &Project,
    (machine, processor, clock_mhz): (&'static Machine, Processor, f64),
    stream: &Stream,
    beginnings: usize,
) -> Result<Row, StudyError> {
    let write = |stream: &Stream| -> Result<TempDir, TargetError> {
        let folder = TempDir::with_prefix("supervisor-cycles-")?;
        stream.write(File::create(folder.path().join("stream.bin"))?)?;
        Ok(folder)
    };
    let image = machine.number.image("count");
    let count = |folder: &TempDir| count_words(project, (machine, &image), folder.path(), LIMIT);
    let words = count(&write(stream)?)?;
    let mut all: Vec<u32> = ticks_of(&words).map(|(n, _)| n).collect();
    all.sort_unstable();
    let median = all.get(all.len() / 2).copied().unwrap_or_default();
    let pieces = chosen(stream, &words, beginnings);
    let folder = write(&Stream {
        number: stream.number,
        pieces,
        left_out: 0,
    })?;
    let counted: Vec<u32> = ticks_of(&count(&folder)?).map(|(n, _)| n).collect();
    let traced = trace(project, machine, folder.path(), LIMIT)?;
    let mut ticks = Vec::with_capacity(traced.ticks.len());
    let mut last = Mix::new();
    for path in &traced.ticks {
        let (tick, mix) = cost(&traced, processor, path)?;
        ticks.push(tick);
        last = mix;
    }
    let agreeing = counted
        .iter()
        .zip(&ticks)
        .filter(|(n, tick)| **n == tick.instructions)
        .count();
    let agreeing = agreeing.saturating_sub(counted.len().abs_diff(ticks.len()));
    let mix = Kind::ALL.into_iter().filter_map(|(kind, name)| {
        let (instructions, cycles) = last.get(&kind)?;
        Some((name, *instructions, *cycles))
    });
    let worst = ticks
        .last()
        .copied()
        .ok_or_else(|| format!("no tick of {} was traced", machine.title()))?;
    Ok(Row {
        machine,
        clock_mhz,
        agreeing,
        worst,
        median: (median, needed_about(median, &ticks)),
        mix: mix.collect(),
        ticks,
    })
}

/// On every processor that Arm tables cycles of.
///
/// # Errors
/// [`TargetError`], [`TraceError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let (processors, beginnings) = extent.pick((1, 2), (MODELLED.len(), 20));
    emulator::version()?;
    let project = Project::around(Path::new("."))?;
    progress.begin(processors as u64, "processors");
    let mut rows = Vec::new();
    let mut built: Vec<(&'static str, Build)> = Vec::new();
    for (name, number, processor, clock_mhz) in MODELLED.into_iter().take(processors) {
        let known = MACHINES
            .iter()
            .find(|m| m.name == name && m.number == number);
        let machine = known.ok_or_else(|| format!("there is no machine {name}"))?;
        if !built.contains(&(machine.target, machine.build)) {
            project.build(machine.target, machine.build)?;
            built.push((machine.target, machine.build));
        }
        let stream = Stream::record(number, Length::QUICK)?;
        rows.push(row(
            &project,
            (machine, processor, clock_mhz),
            &stream,
            beginnings,
        )?);
        progress.add(1);
    }
    Ok(Report {
        classes: Vec::new(),
        title: "Cycles of a tick, by a model".to_owned(),
        claims: rows.iter().flat_map(claims).collect(),
        cases: rows.iter().map(|r| r.ticks.len() as u64).sum(),
        chapters: vec![ticks(&rows), worst_ticks(&rows), needed(&rows)],
    })
}

fn claims(row: &Row) -> [Claim; 2] {
    let name = row.machine.title();
    let (low, high) = row.worst.each();
    [
        Claim::at_least(
            format!("{name}: traced ticks with as many instructions as the clock counted, share"),
            1.0,
            row.agreeing as f64 / row.ticks.len() as f64,
        ),
        Claim::at_most(
            format!("{name}: width of the model, most cycles over least, worst tick"),
            2.0,
            high / low,
        ),
    ]
}

fn ticks(rows: &[Row]) -> Chapter {
    const COLUMNS: [&str; 7] = [
        "target",
        "ticks traced",
        "cycles an instruction, least to most",
        "worst tick: instructions",
        "cycles, least to most",
        "clock, for example [MHz]",
        "time [µs]",
    ];
    let row = |row: &Row| {
        let all = || row.ticks.iter().map(Tick::each);
        let low = all().map(|(low, _)| low).fold(f64::INFINITY, f64::min);
        let high = all().map(|(_, high)| high).fold(0.0, f64::max);
        let cycles = row.worst.cycles;
        let time_us = |cycles: u32| f64::from(cycles) / row.clock_mhz;
        [
            row.machine.title(),
            row.ticks.len().to_string(),
            format!("{low:.2} to {high:.2}"),
            row.worst.instructions.to_string(),
            format!("{} to {}", cycles.low, cycles.high),
            format!("{}", row.clock_mhz),
            format!("{:.1} to {:.1}", time_us(cycles.low), time_us(cycles.high)),
        ]
    };
    let story = format!(
        "Every instruction of some ticks is traced in the emulator, with what Arm's manuals say it takes where memory has no wait states. Where a manual leaves a span, both ends are summed: this is a model with its error bars and no measurement. Traced are the first {OF_A_PIECE} ticks of some pieces of the stream that budgets are of, and its dearest tick with all before it."
    );
    Chapter::new(
        "Ticks",
        vec![
            Block::text(story),
            Block::table(COLUMNS, rows.iter().map(row)),
        ],
    )
}

fn worst_ticks(rows: &[Row]) -> Chapter {
    let lines = rows.iter().flat_map(|row| {
        row.mix.iter().map(|(name, instructions, cycles)| {
            [
                row.machine.title(),
                (*name).to_owned(),
                instructions.to_string(),
                format!("{} to {}", cycles.low, cycles.high),
            ]
        })
    });
    let columns = ["target", "what", "instructions", "cycles, least to most"];
    Chapter::new(
        "What the dearest tick is made of",
        vec![Block::table(columns, lines)],
    )
}

fn needed(rows: &[Row]) -> Chapter {
    let lines = rows.iter().flat_map(|row| {
        let (median, needed) = row.median;
        let line = |which: &str, instructions: u32, needed: f64| {
            [
                row.machine.title(),
                which.to_owned(),
                instructions.to_string(),
                format!("{needed:.0}"),
            ]
        };
        [
            line("worst", row.worst.instructions, f64::from(row.worst.needed)),
            line("median", median, needed),
        ]
    });
    let story = format!(
        "Instructions without those that move floats between registers, announce conditions (`IT`), or read and write the frame of a function or the constants beside it. What is left is arithmetic, comparisons, branches, and what goes between registers and memory that is not the frame: what the computation takes as it is written, with any compiler for the processor. Of the median tick they are the average over the traced ticks that are within {:.0} % of it.",
        100.0 * ABOUT
    );
    let columns = ["target", "tick", "instructions", "of these needed"];
    Chapter::new(
        "What no compiler saves",
        vec![Block::text(story), Block::table(columns, lines)],
    )
}
