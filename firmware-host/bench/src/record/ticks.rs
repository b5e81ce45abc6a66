//! The ticks of a flight record for a person: what happened in them, of any version.

use crate::record::file::PlaneRecord;
use firmware_image::wire::mode_of;
use serde::Serialize;
use std::ops::RangeInclusive;
use supervisor::{Entry, Events, Limits, Mode, crc_of};

/// Units of version 2: 1/4096 of the clearance and of the cap.
pub const PER_UNIT: f64 = 4096.0;
/// Bytes of an entry of version 2.
pub const ENTRY_BYTES: usize = 16;

/// What froze a record of version 2 at the end of its first quarter.
const TRIGGERS: Events = Events::ENGAGED
    .union(Events::TOUCHED)
    .union(Events::SENSOR_FAULT);

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

/// Why bytes are no flight record of version 2.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotARecord {
    /// The length is that of no number of entries.
    #[error("{0} bytes are no whole number of entries of {ENTRY_BYTES} bytes, or none")]
    Length(usize),
    /// A field that no supervisor writes.
    #[error("entry {entry} (byte {}) has mode {mode}; there are modes 0 to 7", entry * ENTRY_BYTES)]
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

/// Name of the mode of this number.
pub fn mode_name(number: u8) -> Option<&'static str> {
    mode_of(number).map(Mode::name)
}

/// Ticks of a record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ticks {
    /// Sequence numbers that are missing between two neighbours.
    pub missing: u64,
    /// The ticks, oldest first.
    pub ticks: Vec<Tick>,
    /// Modes in their order.
    pub stretches: Vec<Stretch>,
}

/// A flight record of version 2, which is its entries and nothing else.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightRecord {
    /// Checksum of all entries, to compare with the one that the firmware gave.
    pub crc: u32,
    /// Whether it has the length of a record, a power of two, what froze it stands where it does in a whole one from oldest to
    /// newest, at the end of the first quarter, and the last entry is later than the first.
    pub whole: bool,
    /// Entries that were never written, before the first that was.
    pub empty: usize,
    /// What is in it.
    #[serde(flatten)]
    pub of: Ticks,
}

/// An entry of any version.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Brief {
    sequence: u32,
    position: [f64; 2],
    force: [f64; 2],
    mode: u8,
    limits: u8,
    events: u16,
}

/// Entries of version 2, little-endian, oldest first.
fn entries(bytes: &[u8]) -> Result<Vec<Brief>, NotARecord> {
    let (entries, rest) = bytes.as_chunks::<ENTRY_BYTES>();
    if entries.is_empty() || !rest.is_empty() {
        return Err(NotARecord::Length(bytes.len()));
    }
    let entry = |(number, b): (usize, &[u8; ENTRY_BYTES])| {
        let pair = |at: usize| {
            let of = |at| i16::from_le_bytes([b[at], b[at + 1]]);
            per_unit([of(at), of(at + 2)])
        };
        let mode = b[12];
        if mode_of(mode).is_none() {
            let entry = number;
            return Err(NotARecord::Mode { entry, mode });
        }
        Ok(Brief {
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

fn per_unit(v: [i16; 2]) -> [f64; 2] {
    v.map(|x| f64::from(x) / PER_UNIT)
}

impl FlightRecord {
    /// What the bytes of a record of version 2 say. Times are counted from the last engagement in them, or from the first
    /// entry.
    ///
    /// # Errors
    /// [`NotARecord`].
    pub fn of(bytes: &[u8], units: Units) -> Result<Self, NotARecord> {
        let entries = entries(bytes)?;
        let empty = entries
            .iter()
            .take_while(|entry| **entry == Brief::default())
            .count();
        let written = &entries[empty..];
        let triggers = |entry: &Brief| entry.events & TRIGGERS.bits() as u16 != 0;
        let trigger = (entries.len() / 4).checked_sub(1);
        let a_length = entries.len().is_power_of_two();
        // A ring that was written down from elsewhere ends before it begins.
        let in_order = match written {
            [first, .., last] => last.sequence.wrapping_sub(first.sequence).cast_signed() >= 0,
            _ => true,
        };
        Ok(Self {
            crc: crc_of(bytes),
            whole: a_length && trigger.is_some_and(|at| triggers(&entries[at])) && in_order,
            empty,
            of: Ticks::new(written, units),
        })
    }
}

impl PlaneRecord {
    /// What its units are in SI, where its configuration is whole.
    pub fn units(&self) -> Units {
        let config = self.config.as_ref();
        Units {
            clearance_m: config.map(|c| f64::from(c.clearance_m)),
            force_max_n: config.map(|c| f64::from(c.force_max_n)),
            sample_rate_hz: config.map(|c| 1.0 / f64::from(c.sample_period_s)),
        }
    }
}

impl Ticks {
    /// Those of a record of version 3 that are whole, in SI where its configuration is.
    pub fn of(record: &PlaneRecord) -> Self {
        let number = |bits: u32| record.number(bits);
        let brief = |entry: &Entry| Brief {
            sequence: entry.sequence,
            position: entry.position.map(number),
            force: entry.force.map(number),
            mode: entry.mode,
            limits: entry.limits,
            events: entry.events,
        };
        let entries: Vec<Brief> = record.entries.values().map(brief).collect();
        Self::new(&entries, record.units())
    }

    fn new(entries: &[Brief], units: Units) -> Self {
        let engaged = |entry: &&Brief| entry.events & Events::ENGAGED.bits() as u16 != 0;
        let start = entries.iter().rev().find(engaged).or(entries.first());
        let start = start.map_or(0, |entry| entry.sequence);
        let ticks: Vec<Tick> = entries.iter().map(|e| tick(e, start, units)).collect();
        let gap = |pair: &[Brief]| {
            let step = pair[1].sequence.wrapping_sub(pair[0].sequence);
            // A number that is older than the one before is no gap.
            match step.cast_signed() {
                1.. => u64::from(step - 1),
                _ => 0,
            }
        };
        Self {
            missing: entries.windows(2).map(gap).sum(),
            stretches: stretches(&ticks),
            ticks,
        }
    }

    /// Ticks since the engagement of a sequence number.
    pub fn tick_of(&self, sequence: u32) -> i64 {
        let zero = (self.ticks.first()).map_or(0, |t| t.sequence.wrapping_sub(t.tick as u32));
        i64::from(sequence.wrapping_sub(zero).cast_signed())
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

fn tick(entry: &Brief, start: u32, units: Units) -> Tick {
    let (position, force) = (entry.position, entry.force);
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
