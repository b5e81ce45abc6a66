//! The dearest tick, looked for: samples that nobody has chosen, and of those that cost most more like them.

use super::counts::ticks_of;
use super::emulator;
use super::images::Project;
use super::machines::{MACHINES, Machine};
use super::measure::{TargetError, count_words};
use super::numbers::Number;
use super::record::{Length, Stream};
use super::synthetic::{Chance, seeded};
use super::tick_log::{Piece, Tick};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError};
use firmware_image::wire::{CommandBits, SampleBits, mode_of, sample_of};
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

/// Ticks of a round: as many as the short stream has.
const ROUND_TICKS: usize = Length::QUICK.all;
/// Of these, so many are drawn anew.
const NEW_TICKS: usize = ROUND_TICKS / 4;
/// Ticks that are kept and changed.
const KEPT: usize = 60;
/// What comes before the dearest tick that is not cut off, at least, and within which samples are changed.
const BEFORE: usize = 300;
const CHANGED: usize = 24;
/// A round takes some seconds; more only where the emulator hangs.
const LIMIT: Duration = Duration::from_secs(300);

/// A tick that costs much, with all inputs before it.
#[derive(Debug, Clone)]
struct Dear {
    instructions: u32,
    mode: u8,
    piece: Piece,
}

/// The search, so many rounds on; always the same.
struct Search {
    chance: Chance,
    kept: Vec<Dear>,
    rounds: u64,
    ticks: usize,
}

impl Search {
    fn new() -> Self {
        Self {
            chance: Chance::new(20_261_126),
            kept: Vec::new(),
            rounds: 0,
            ticks: 0,
        }
    }

    fn round(&mut self, project: &Project, machine: &Machine) -> Result<(), TargetError> {
        self.rounds += 1;
        let first = self.kept.is_empty();
        let new = if first { ROUND_TICKS } else { NEW_TICKS };
        let (mut pieces, _) = seeded(1000 + self.rounds, Number::Float, new)?;
        let mut left = ROUND_TICKS.saturating_sub(new);
        while left > 0 && !first {
            let child = self.child();
            left = left.saturating_sub(child.ticks.len());
            pieces.push(child);
        }
        let stream = Stream {
            number: Number::Float,
            pieces,
            left_out: 0,
        };
        let folder = TempDir::with_prefix("supervisor-search-")?;
        stream.write(std::fs::File::create(folder.path().join("stream.bin"))?)?;
        let words = count_words(project, (machine, "count"), folder.path(), LIMIT)?;
        let counts: Vec<(u32, u8)> = ticks_of(&words).collect();
        self.ticks += counts.len();
        let mut counts = counts.as_slice();
        for piece in stream.pieces {
            let (own, rest) = counts.split_at(piece.ticks.len().min(counts.len()));
            counts = rest;
            self.keep(piece, own);
        }
        Ok(())
    }

    /// Keeps the dearest tick of a piece, if it is one of the dearest.
    fn keep(&mut self, mut piece: Piece, counts: &[(u32, u8)]) {
        let dearest = counts.iter().enumerate().max_by_key(|(_, (n, _))| *n);
        let Some((at, (instructions, mode))) = dearest else {
            return;
        };
        piece.ticks.truncate(at + 1);
        self.kept.push(Dear {
            instructions: *instructions,
            mode: *mode,
            piece,
        });
        self.kept
            .sort_by_key(|dear| std::cmp::Reverse(dear.instructions));
        self.kept.truncate(KEPT);
    }

    /// One that is kept, with some of its last samples changed, and perhaps without what came long before.
    fn child(&mut self) -> Piece {
        let chance = &mut self.chance;
        let mut of_parent = || &self.kept[chance.below(self.kept.len())].piece;
        let (parent, other) = (of_parent(), of_parent());
        let all = parent.ticks.len();
        let from = match self.chance.one_in(3) {
            true => all.saturating_sub(BEFORE + self.chance.below(2 * BEFORE)),
            false => 0,
        };
        let mut samples: Vec<SampleBits> = (parent.ticks.iter().skip(from))
            .map(|tick| sample_of(&tick.sample))
            .collect();
        let config = if self.chance.one_in(8) {
            other.config
        } else {
            parent.config
        };
        for _ in 0..1 + self.chance.below(4) {
            let back = self.chance.below(CHANGED.min(samples.len()));
            let at = samples.len() - 1 - back;
            let donor = &other.ticks[self.chance.below(other.ticks.len())];
            change(
                &mut samples,
                at,
                &sample_of(&donor.sample),
                &mut self.chance,
            );
        }
        // What is commanded nobody compares.
        let ticks = samples.iter();
        Piece {
            config,
            ticks: ticks
                .map(|sample| Tick::new(sample, &CommandBits::default()))
                .collect(),
        }
    }
}

/// Changes one thing of a sample, or of all from it on.
fn change(samples: &mut [SampleBits], at: usize, donor: &SampleBits, chance: &mut Chance) {
    let kind = chance.below(8);
    if kind == 0 {
        let missed = 1 + chance.below(5) as u32;
        for sample in &mut samples[at..] {
            sample.sequence = sample.sequence.wrapping_add(missed);
        }
        return;
    }
    let by = chance.between(0.8, 1.2);
    let scaled = |bits: u32| (f32::from_bits(bits) * by).to_bits();
    let sample = &mut samples[at];
    match kind {
        1 => sample.status ^= supervisor::Status::from_bits_retain(1 << chance.below(8)),
        2 => sample.position = sample.position.map(scaled),
        3 => sample.position = donor.position,
        4 => sample.spin = donor.spin,
        5 => sample.levitation = donor.levitation,
        6 => sample.applied = donor.applied,
        _ => {
            sample.levitation = sample.levitation.map(scaled);
            sample.applied = sample.applied.map(scaled);
        }
    }
}

/// On a Cortex-M4 with FPU, beside the stream that the budgets are of.
///
/// # Errors
/// [`TargetError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let rounds: u64 = extent.pick(10, 150);
    emulator::version()?;
    let project = Project::around(Path::new("."))?;
    let usual = |m: &&Machine| m.name == "M4F";
    let machine = MACHINES.iter().find(usual).unwrap_or(&MACHINES[0]);
    project.build(machine.target, machine.build)?;
    let folder = TempDir::with_prefix("supervisor-search-")?;
    let stream = Stream::record(Number::Float, Length::QUICK)?;
    stream.write(std::fs::File::create(folder.path().join("stream.bin"))?)?;
    let words = count_words(&project, (machine, "count"), folder.path(), LIMIT)?;
    let counted = ticks_of(&words).map(|(n, _)| n).max().unwrap_or(0);

    progress.begin(rounds, "rounds");
    let mut search = Search::new();
    let mut rows = Vec::new();
    while search.rounds < rounds {
        search.round(&project, machine)?;
        progress.add(1);
        if search.rounds.is_power_of_two() || search.rounds == rounds {
            rows.push([
                search.rounds.to_string(),
                search.ticks.to_string(),
                search
                    .kept
                    .first()
                    .map_or(0, |d| d.instructions)
                    .to_string(),
            ]);
        }
    }
    let dearest = search.kept.first();
    let found = dearest.map_or(0, |dear| dear.instructions);
    let mode = dearest.and_then(|dear| mode_of(dear.mode));
    let over_counted = f64::from(found) / f64::from(counted.max(1));
    let dearest_found = "dearest found, over that of the counted stream";
    let story = format!(
        "On {}: the dearest tick of the stream that budgets are of has {counted} instructions, the dearest that was found {found}; it ends in mode {}. Rounds of {ROUND_TICKS} ticks, a quarter of them drawn anew, the others from the {KEPT} dearest so far with some of the last {CHANGED} samples before the dearest tick changed.",
        machine.text,
        mode.map_or("unknown", supervisor::Mode::name),
    );
    let columns = ["rounds", "ticks", "most instructions of a tick"];
    Ok(Report {
        classes: Vec::new(),
        title: "The worst tick".to_owned(),
        claims: vec![
            Claim::at_least(dearest_found, 1.0, over_counted),
            Claim::at_most(dearest_found, 1.3, over_counted),
        ],
        cases: search.ticks as u64,
        chapters: vec![Chapter::new(
            "What a search finds",
            vec![Block::text(story), Block::table(columns, rows)],
        )],
    })
}
