//! A flight record as firmware has written it down: its entries, and what happened in them.

use firmware_image::wire::mode_of;
use serde::Serialize;
use std::ops::RangeInclusive;
use supervisor::{Entry, Events, Limits, Mode, PER_UNIT, RECORD_TRIGGERS, crc_of};

/// Bytes of an entry.
pub const ENTRY_BYTES: usize = 16;

/// What the units of a record are in SI, as far as they are known.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Units {
    /// Clearance of the retainer bearing \[m\].
    pub clearance_m: Option<f64>,
    /// Force cap \[N\].
    pub force_max_n: Option<f64>,
    /// Ticks a second \[Hz\].
    pub sample_rate_hz: Option<f64>,
}

/// Why bytes are no flight record.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotARecord {
    /// The length is that of no number of entries.
    #[error("{0} bytes are no whole number of entries of {ENTRY_BYTES} bytes, or none")]
    Length(usize),
    /// A field that no supervisor writes.
    #[error("entry {entry} (byte {}) has mode {mode}; there are modes 0 to 6", entry * ENTRY_BYTES)]
    Mode {
        /// Number of the entry, from 0.
        entry: usize,
        /// What is in its place of the mode.
        mode: u8,
    },
}

/// A tick of the record, with what is known of the units applied.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tick {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Ticks since the engagement.
    pub tick: i64,
    /// Time since the engagement \[s\].
    pub time_s: Option<f64>,
    /// Position in clearances, at the retainer bearing.
    pub position: [f64; 2],
    /// Position \[m\].
    pub position_m: Option<[f64; 2]>,
    /// Commanded force in caps.
    pub force: [f64; 2],
    /// Commanded force \[N\].
    pub force_n: Option<[f64; 2]>,
    /// Mode after the tick.
    pub mode: &'static str,
    /// What bound the command.
    pub limits: Vec<&'static str>,
    /// What happened.
    pub events: Vec<&'static str>,
}

/// Ticks in one mode without a break.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stretch {
    /// The mode.
    pub mode: &'static str,
    /// First tick since the engagement.
    pub from_tick: i64,
    /// How many ticks.
    pub ticks: usize,
    /// Largest distance from the centre \[clearances\].
    pub largest_radius: f64,
    /// Largest force \[caps\].
    pub largest_force: f64,
}

/// A flight record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightRecord {
    /// Checksum of all entries, to compare with the one that the firmware gave.
    pub crc: u32,
    /// Whether it has the length of a record, a power of two, what froze it stands where it does in a whole one from oldest to
    /// newest, at the end of the first quarter, and the last entry is later than the first.
    pub whole: bool,
    /// Entries that were never written, before the first that was.
    pub empty: usize,
    /// Sequence numbers that are missing between two neighbours.
    pub missing: u64,
    /// The ticks, oldest first.
    pub ticks: Vec<Tick>,
    /// Modes in their order.
    pub stretches: Vec<Stretch>,
}

/// Entries from bytes, little-endian, oldest first.
///
/// # Errors
/// [`NotARecord`].
pub fn entries(bytes: &[u8]) -> Result<Vec<Entry>, NotARecord> {
    let (entries, rest) = bytes.as_chunks::<ENTRY_BYTES>();
    if entries.is_empty() || !rest.is_empty() {
        return Err(NotARecord::Length(bytes.len()));
    }
    let entry = |(number, b): (usize, &[u8; ENTRY_BYTES])| {
        let pair = |at: usize| {
            let of = |at| i16::from_le_bytes([b[at], b[at + 1]]);
            [of(at), of(at + 2)]
        };
        let mode = b[12];
        if mode_of(mode).is_none() {
            let entry = number;
            return Err(NotARecord::Mode { entry, mode });
        }
        Ok(Entry {
            sequence: u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            position: pair(4),
            force: pair(8),
            mode,
            limits: b[13],
            events: u16::from_le_bytes([b[14], b[15]]),
        })
    };
    entries.iter().enumerate().map(entry).collect()
}

impl FlightRecord {
    /// What entries say, oldest first. Times are counted from the last engagement in them, or from the first entry.
    pub fn of(entries: &[Entry], units: Units) -> Self {
        let empty = entries
            .iter()
            .take_while(|entry| **entry == Entry::default())
            .count();
        let written = &entries[empty..];
        let triggers = |entry: &Entry| entry.events & RECORD_TRIGGERS.bits() as u16 != 0;
        let engaged = |entry: &&Entry| entry.events & Events::ENGAGED.bits() as u16 != 0;
        let trigger = (entries.len() / 4).checked_sub(1);
        let a_length = entries.len().is_power_of_two();
        let start = written.iter().rev().find(engaged).or(written.first());
        let start = start.map_or(0, |entry| entry.sequence);
        let ticks: Vec<Tick> = written.iter().map(|e| tick(e, start, units)).collect();
        // A ring that was written down from elsewhere ends before it begins.
        let in_order = match written {
            [first, .., last] => last.sequence.wrapping_sub(first.sequence).cast_signed() >= 0,
            _ => true,
        };
        let gap = |pair: &[Entry]| {
            let step = pair[1].sequence.wrapping_sub(pair[0].sequence);
            // A number that is older than the one before is no gap.
            match step.cast_signed() {
                1.. => u64::from(step - 1),
                _ => 0,
            }
        };
        Self {
            crc: crc_of(entries.iter()),
            whole: a_length && trigger.is_some_and(|at| triggers(&entries[at])) && in_order,
            empty,
            missing: written.windows(2).map(gap).sum(),
            stretches: stretches(&ticks),
            ticks,
        }
    }

    /// Ticks that a person wants to see: in which something happened or the mode changed.
    pub fn turning_points(&self) -> impl Iterator<Item = &Tick> {
        let before = std::iter::once(None).chain(self.ticks.iter().map(Some));
        self.ticks
            .iter()
            .zip(before)
            .filter(|(tick, before)| {
                !tick.events.is_empty() || before.is_none_or(|b| b.mode != tick.mode)
            })
            .map(|(tick, _)| tick)
    }
}

fn tick(entry: &Entry, start: u32, units: Units) -> Tick {
    let per_unit = |v: [i16; 2]| v.map(|x| f64::from(x) / f64::from(PER_UNIT));
    let (position, force) = (per_unit(entry.position), per_unit(entry.force));
    // Sequence numbers may wrap: what is before the start is negative.
    let tick = i64::from(entry.sequence.wrapping_sub(start).cast_signed());
    let limits = Limits::from_bits_truncate(entry.limits.into());
    let events = Events::from_bits_truncate(entry.events.into());
    Tick {
        sequence: entry.sequence,
        tick,
        time_s: units.sample_rate_hz.map(|rate| tick as f64 / rate),
        position,
        position_m: units.clearance_m.map(|c| position.map(|x| x * c)),
        force,
        force_n: units.force_max_n.map(|cap| force.map(|x| x * cap)),
        mode: mode_of(entry.mode).map_or("unknown", Mode::name),
        limits: limits.iter_names().map(|(name, _)| name).collect(),
        events: events.iter_names().map(|(name, _)| name).collect(),
    }
}

fn stretches(ticks: &[Tick]) -> Vec<Stretch> {
    let most = |vectors: &mut dyn Iterator<Item = [f64; 2]>| {
        vectors.map(|[x, y]| x.hypot(y)).fold(0.0, f64::max)
    };
    ticks
        .chunk_by(|a, b| a.mode == b.mode)
        .map(|same| Stretch {
            mode: same[0].mode,
            from_tick: same[0].tick,
            ticks: same.len(),
            largest_radius: most(&mut same.iter().map(|t| t.position)),
            largest_force: most(&mut same.iter().map(|t| t.force)),
        })
        .collect()
}

/// What a unit of a record may be in SI.
pub const ANY_UNIT: RangeInclusive<f64> = 1e-9..=1e9;
