//! What was measured on the targets, as JSON has it.

use super::budgets::{Figures, Verdict};
use super::counts::OfMode;
use serde::Serialize;

/// A supervisor on a processor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TargetRow {
    /// Processor.
    pub name: &'static str,
    /// Numbers that it calculates in.
    pub number: &'static str,
    /// Board in QEMU.
    pub board: &'static str,
    /// Target of the compiler.
    pub target: &'static str,
    /// Ticks whose instructions were counted.
    pub counted_ticks: usize,
    /// Least instructions of a tick.
    pub min_instructions: u32,
    /// Half of the ticks have more.
    pub median_instructions: u32,
    /// Most instructions of a tick.
    pub worst_instructions: u32,
    /// The same for the ticks that ended in a mode.
    pub modes: Vec<OfMode>,
    /// The same for all ticks that were replayed, where they are more than the counted; without budgets.
    pub long_stream: Option<LongStream>,
    /// Both planes of a rotor in one tick, over the counted ticks; in floats. Held against twice a supervisor.
    pub pair: Option<PairOfPlanes>,
    /// Flash that the supervisor takes with all that it calls.
    pub text_bytes: u64,
    /// Instructions' part of it.
    pub code_bytes: u64,
    /// Its state without the recorder.
    pub ram_bytes: u64,
    /// Deepest stack of a tick, from its caller.
    pub stack_bytes: u64,
    /// Against the host; none of a build that the host does not have.
    #[serde(flatten)]
    pub replayed: Option<Replayed>,
    /// Figures against their budgets.
    pub budgets: Vec<Verdict>,
}

/// Outcome of a replay.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Replayed {
    /// Ticks that were replayed.
    pub ticks: u64,
    /// Of these, the ones with the same bits as on the host.
    pub bit_exact_ticks: u64,
    /// Hash over the commands of the replay.
    pub hash: String,
    /// Hash over what the supervisors leave behind: reports, events, frozen records.
    pub read_outs: String,
}

impl Replayed {
    /// What is wrong, against the host's stream.
    fn failures(&self, stream: &StreamRow) -> Vec<String> {
        let mut failures = Vec::new();
        if stream.read_outs != self.read_outs {
            failures.push("reports, events or records differ from the host's".to_owned());
        }
        if self.bit_exact_ticks != self.ticks {
            let differ = self.ticks - self.bit_exact_ticks;
            failures.push(format!(
                "{differ} of {} ticks differ from the host",
                self.ticks
            ));
        }
        // An image that read another stream would agree with that.
        if stream.ticks != self.ticks || stream.hash != self.hash {
            failures.push("the hash over all ticks is not the host's".to_owned());
        }
        failures
    }
}

/// Figures of the long stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct LongStream {
    pub ticks: usize,
    /// Most instructions of a tick.
    pub worst_instructions: u32,
    /// Deepest stack of a tick, from its caller.
    pub stack_bytes: u64,
}

/// Figures of the supervisor of a rotor in two bearing planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct PairOfPlanes {
    /// Half of the ticks have more.
    pub median_instructions: u32,
    /// Most instructions of a tick of both.
    pub worst_instructions: u32,
    /// The same of either half of a tick in two halves.
    pub worst_half_instructions: u32,
    /// Their state without recorders.
    pub ram_bytes: u64,
    /// Deepest stack of a tick of both, from its caller.
    pub stack_bytes: u64,
}

/// What a tick of a rotor costs over that of one plane: twice that, and what the planes know of each other.
const PAIR_OVER_ONE: std::ops::RangeInclusive<f64> = 2.3..=2.6;

impl PairOfPlanes {
    /// What is wrong, beside one supervisor in a row.
    fn failure(&self, row: &TargetRow) -> Option<String> {
        let ratio = f64::from(self.worst_instructions) / f64::from(row.worst_instructions);
        (!PAIR_OVER_ONE.contains(&ratio)).then(|| {
            format!(
                "a tick of two planes takes {} instructions, {ratio:.2} times that of one, not {} to {}",
                self.worst_instructions,
                PAIR_OVER_ONE.start(),
                PAIR_OVER_ONE.end()
            )
        })
    }
}

impl TargetRow {
    /// The figures that have budgets.
    pub fn figures(&self) -> Figures {
        Figures {
            worst_instructions: self.worst_instructions.into(),
            median_instructions: self.median_instructions.into(),
            text_bytes: self.text_bytes,
            ram_bytes: self.ram_bytes,
            stack_bytes: self.stack_bytes,
        }
    }
}

/// What a replayed stream goes through.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StreamRow {
    /// What its numbers are.
    pub number: &'static str,
    /// Supervisors, one after the other.
    pub pieces: usize,
    /// Configurations that were passed over because they do not fit the numbers.
    pub left_out: usize,
    pub ticks: u64,
    /// Hash over the host's commands.
    pub hash: String,
    /// Hash over what the host's supervisors leave behind.
    pub read_outs: String,
    /// Ticks that ended in each mode.
    pub modes: Vec<ModeTicks>,
    /// Ways from mode to mode that the state machine has.
    pub ways: usize,
    /// Ways that are not in the stream.
    pub missing_ways: Vec<String>,
    /// Ways of the stream that the state machine does not have.
    pub unknown_ways: Vec<String>,
}

/// Ticks of a mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeTicks {
    pub mode: &'static str,
    /// Ticks that ended in it.
    pub ticks: u64,
}

/// A scene with the supervisor on an emulated processor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopRow {
    /// Processor.
    pub name: &'static str,
    /// Numbers that it calculates in.
    pub number: &'static str,
    /// Scene of the catalogue.
    pub scene: String,
    /// Ticks of the loop.
    pub ticks: u64,
    /// Of these, the ones whose sample and command have the same bits as on the host alone.
    pub bit_exact_ticks: u64,
    /// Whether plant and verdict are the same too.
    pub same_plant: bool,
    /// Ticks in a second of wall time.
    pub ticks_per_s: f64,
}

/// Everything.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The emulator.
    pub qemu: String,
    /// The replayed streams, one for each kind of numbers.
    pub streams: Vec<StreamRow>,
    /// Replays, counts and sizes.
    pub targets: Vec<TargetRow>,
    /// Processors in the loop.
    pub loops: Vec<LoopRow>,
}

impl Report {
    /// What is wrong with it, a line each.
    pub fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        for stream in &self.streams {
            let number = stream.number;
            let missing = stream.missing_ways.iter();
            failures.extend(
                missing.map(|way| format!("the stream of {number} does not go from {way}")),
            );
            let unknown = stream.unknown_ways.iter();
            failures.extend(unknown.map(|way| format!("the stream of {number} goes from {way}")));
        }
        for t in &self.targets {
            let name = format!("{} {}", t.name, t.number);
            let stream = self.streams.iter().find(|s| s.number == t.number);
            let replayed = t.replayed.as_ref().zip(stream);
            let differs = replayed.map_or_else(Vec::new, |(r, stream)| r.failures(stream));
            failures.extend(differs.iter().map(|f| format!("{name}: {f}")));
            let pair = t.pair.and_then(|pair| pair.failure(t));
            failures.extend(pair.map(|f| format!("{name}: {f}")));
            let broken = t.budgets.iter().filter_map(Verdict::failure);
            failures.extend(broken.map(|f| format!("{name}: {f}")));
        }
        for l in &self.loops {
            if l.bit_exact_ticks != l.ticks || !l.same_plant {
                failures.push(format!(
                    "{} {} in the loop, {}: {} of {} ticks as on the host alone",
                    l.name, l.number, l.scene, l.bit_exact_ticks, l.ticks
                ));
            }
        }
        failures
    }
}
