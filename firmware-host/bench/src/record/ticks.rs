//! The ticks of a flight record for a person: what happened in them.

use crate::record::file::PlaneRecord;
use firmware_image::wire::mode_of;
use serde::Serialize;
use supervisor::{Entry, Events, Limits, Mode};

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

/// An entry, its numbers as numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Brief {
    sequence: u32,
    position: [f64; 2],
    force: [f64; 2],
    mode: u8,
    limits: u8,
    events: u16,
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
    /// Those of a record that are whole, in SI where its configuration is.
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
