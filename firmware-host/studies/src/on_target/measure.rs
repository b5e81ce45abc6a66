//! A target measured: replay, instructions, sizes.

use super::budgets::BudgetError;
use super::counts::{Counts, counts_of, ticks_of};
use super::coverage::ways;
use super::emulator::{self, EmulatorError, Time};
use super::images::{ImageError, Project};
use super::link::LinkError;
use super::machines::{Build, Machine};
use super::numbers::Number;
use super::record::{Length, Stream};
use super::results::{LongStream, ModeTicks, PairOfPlanes, Replayed, StreamRow, TargetRow};
use crate::overloads::plan::CatalogueError;
use firmware_bench::run::closed_loop::RunError;
use firmware_image::wire::MODES;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;
use supervisor::Mode;
use tempfile::TempDir;

/// Why there are no figures.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum TargetError {
    /// The images.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Image(#[from] ImageError),
    /// The emulator.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Emulator(#[from] EmulatorError),
    /// The budgets.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Budget(#[from] BudgetError),
    /// The line to the emulated board.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Link(#[from] LinkError),
    /// The catalogue, which streams and loops come from.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// A closed loop that cannot be trusted.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Only floats have an image for it.
    #[error("{0} has no image for the loop")]
    #[diagnostic(help("in the loop are M3, M4F and M7 with floats"))]
    NoLoop(String),
    /// The catalogue has no such scene.
    #[error("the catalogue has no scene {0:?}")]
    NoScene(String),
    /// Files between host and emulator.
    #[error("a file for the emulator: {0}")]
    File(#[from] std::io::Error),
}

/// A replay may take so long for each million ticks.
const LIMIT_S_PER_MILLION: u64 = 600;
/// The instructions of a tick on the emulator's clock, 2^10 ns each: what the image `count` knows too.
pub(super) const SHIFT: u8 = 10;

/// The streams of one kind of numbers on disk, where the emulator reads them.
#[derive(Debug)]
pub struct Streams {
    replayed: TempDir,
    counted: TempDir,
    limit: Duration,
    /// What the replayed one goes through.
    pub row: StreamRow,
}

impl Streams {
    /// Records both.
    ///
    /// # Errors
    /// [`TargetError::Catalogue`], [`TargetError::File`].
    pub fn record(number: Number, replayed: Length) -> Result<Self, TargetError> {
        let stream = Stream::record(number, replayed)?;
        let write = |stream: &Stream| -> Result<TempDir, TargetError> {
            let folder = TempDir::with_prefix("supervisor-target-")?;
            stream.write(std::fs::File::create(folder.path().join("stream.bin"))?)?;
            Ok(folder)
        };
        Ok(Self {
            replayed: write(&stream)?,
            counted: write(&Stream::record(number, Length::QUICK)?)?,
            limit: Duration::from_secs(
                60 + stream.ticks() as u64 * LIMIT_S_PER_MILLION / 1_000_000,
            ),
            row: row_of(&stream),
        })
    }
}

fn row_of(stream: &Stream) -> StreamRow {
    let coverage = stream.coverage();
    let named = |ways: Vec<(Mode, Mode)>| {
        (ways.iter())
            .map(|(from, to)| format!("{} to {}", from.name(), to.name()))
            .collect()
    };
    StreamRow {
        number: stream.number.name(),
        pieces: stream.pieces.len(),
        left_out: stream.left_out,
        ticks: stream.ticks() as u64,
        hash: format!("{:016x}", stream.hash().0),
        read_outs: format!("{:016x}", stream.read_outs().0),
        modes: (MODES.into_iter())
            .map(|mode| ModeTicks {
                mode: mode.name(),
                ticks: coverage.of_mode(mode),
            })
            .collect(),
        ways: ways().count(),
        missing_ways: named(coverage.missing_ways()),
        unknown_ways: named(coverage.unknown_ways()),
    }
}

/// What an image printed under a name.
fn printed<'a>(
    lines: &'a BTreeMap<String, String>,
    (image, machine): (&'static str, &Machine),
    name: &'static str,
) -> Result<&'a String, EmulatorError> {
    lines.get(name).ok_or(EmulatorError::Silent {
        image,
        machine: machine.name,
        name,
    })
}

/// The same as a number.
fn number(
    lines: &BTreeMap<String, String>,
    of: (&'static str, &Machine),
    name: &'static str,
) -> Result<u64, EmulatorError> {
    let (image, machine) = of;
    (printed(lines, of, name)?.parse()).map_err(|_| EmulatorError::Silent {
        image,
        machine: machine.name,
        name,
    })
}

/// The dearer half of a tick in two, where the second half of each has been counted.
fn worst_half(whole: &[u32], second: &[u32]) -> u32 {
    let halves = whole.iter().zip(second);
    let dearer = halves.map(|(whole, second)| whole.saturating_sub(*second).max(*second));
    dearer.max().unwrap_or_default()
}

/// What an image that counts says.
struct Counted {
    counts: Counts,
    /// Of each tick.
    instructions: Vec<u32>,
    stack_bytes: u64,
    ram_bytes: u64,
}

/// Counts the instructions of every tick of the stream in a folder; and the deepest stack.
///
/// # Errors
/// [`TargetError`].
fn count(
    project: &Project,
    (machine, image_name): (&Machine, &str),
    stream_folder: &Path,
    limit: Duration,
) -> Result<Counted, TargetError> {
    let (lines, bytes) = counted(project, (machine, image_name), stream_folder, limit)?;
    let counts = counts_of(&bytes).ok_or(EmulatorError::Silent {
        image: "count",
        machine: machine.name,
        name: "counts",
    })?;
    Ok(Counted {
        counts,
        instructions: ticks_of(&bytes).map(|(count, _)| count).collect(),
        stack_bytes: number(&lines, ("count", machine), "stack_bytes")?,
        ram_bytes: number(&lines, ("count", machine), "ram_bytes")?,
    })
}

/// The words that an image which counts has written of the stream in a folder.
///
/// # Errors
/// [`TargetError`].
pub(super) fn count_words(
    project: &Project,
    of: (&Machine, &str),
    stream_folder: &Path,
    limit: Duration,
) -> Result<Vec<u8>, TargetError> {
    Ok(counted(project, of, stream_folder, limit)?.1)
}

/// What it has said, and its words.
fn counted(
    project: &Project,
    (machine, image_name): (&Machine, &str),
    stream_folder: &Path,
    limit: Duration,
) -> Result<(BTreeMap<String, String>, Vec<u8>), TargetError> {
    let image = project.image(machine, image_name);
    // A folder of its own: machines write files of the same name.
    let folder = TempDir::with_prefix("supervisor-counts-")?;
    let stream = Path::new("stream.bin");
    std::fs::copy(stream_folder.join(stream), folder.path().join(stream))?;
    let time = Time::Counted { shift: SHIFT };
    let lines = emulator::run(machine, &image, folder.path(), time, limit)?;
    let bytes = std::fs::read(folder.path().join("counts.bin"))?;
    Ok((lines, bytes))
}

/// Everything of one machine but the verdicts on its figures; its images have been built.
///
/// # Errors
/// [`TargetError`].
pub fn measure(
    project: &Project,
    machine: &Machine,
    streams: &Streams,
) -> Result<TargetRow, TargetError> {
    let count_in = |folder: &TempDir, image: &str| {
        count(project, (machine, image), folder.path(), streams.limit)
    };
    let image = machine.number.image("count");
    let Counted {
        counts,
        stack_bytes,
        ram_bytes,
        ..
    } = count_in(&streams.counted, &image)?;
    let long_stream = if streams.row.ticks > counts.all.ticks as u64 {
        let counted = count_in(&streams.replayed, &image)?;
        Some(LongStream {
            ticks: counted.counts.all.ticks,
            worst_instructions: counted.counts.all.worst_instructions,
            stack_bytes: counted.stack_bytes,
        })
    } else {
        None
    };
    let pair = match machine.number {
        Number::Float => Some((
            count_in(&streams.counted, "count-pair")?,
            count_in(&streams.counted, "count-half")?,
        )),
        Number::Fixed => None,
    };
    let replayed = match machine.build {
        Build::Usual | Build::For(_) => Some(replay(project, machine, streams)?),
        Build::Bare => None,
    };
    let text = project.text(machine)?;
    Ok(TargetRow {
        name: machine.name,
        number: machine.number.name(),
        board: machine.board,
        target: machine.target,
        counted_ticks: counts.all.ticks,
        min_instructions: counts.all.min_instructions,
        median_instructions: counts.all.median_instructions,
        worst_instructions: counts.all.worst_instructions,
        modes: counts.modes,
        long_stream,
        pair: pair.map(|(pair, half)| PairOfPlanes {
            median_instructions: pair.counts.all.median_instructions,
            worst_instructions: pair.counts.all.worst_instructions,
            worst_half_instructions: worst_half(&pair.instructions, &half.instructions),
            ram_bytes: pair.ram_bytes,
            stack_bytes: pair.stack_bytes,
        }),
        text_bytes: text.code_bytes + text.constant_bytes,
        code_bytes: text.code_bytes,
        ram_bytes,
        stack_bytes,
        replayed,
        budgets: Vec::new(),
    })
}

/// Replays the stream and compares it with the host's commands.
fn replay(
    project: &Project,
    machine: &Machine,
    streams: &Streams,
) -> Result<Replayed, TargetError> {
    let image = project.image(machine, &machine.number.image("replay"));
    let folder = streams.replayed.path();
    let lines = emulator::run(machine, &image, folder, Time::Free, streams.limit)?;
    let replay = ("replay", machine);
    Ok(Replayed {
        ticks: number(&lines, replay, "ticks")?,
        bit_exact_ticks: number(&lines, replay, "bit_exact_ticks")?,
        hash: printed(&lines, replay, "hash")?.clone(),
        read_outs: printed(&lines, replay, "read_outs")?.clone(),
    })
}
