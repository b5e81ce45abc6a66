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
    /// Whether the supervisor believed the reading.
    pub believed: bool,
    /// Reading of the position in clearances, at the retainer bearing.
    pub position: [f64; 2],
    /// The same \[m\].
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
    /// Largest distance from the centre \[clearances\], of the readings that were believed.
    pub largest_radius: Option<f64>,
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
    tick: i64,
    believed: bool,
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

    /// Number of each entry, and ticks since the last engagement. A call without a new sample takes a tick, too; whether sequence numbers count
    /// it or not, as the supervisor has it.
    pub(super) fn times(&self) -> Vec<(usize, i64)> {
        let (mut at, mut repeats, mut last) = (0, 0, None);
        let counted = self.entries.iter().map(|(number, entry)| {
            if let Some((before, sequence)) = last.replace((*number, entry.sequence)) {
                let ahead = since(sequence, entry.sequence);
                // Calls that are missing in the file took a tick each, too.
                let calls = (number - before) as i64;
                at += calls.max(ahead - repeats);
                repeats = if ahead <= 0 { repeats + calls } else { 0 };
            }
            (*number, entry, at)
        });
        let counted: Vec<_> = counted.collect();
        let engaged = |entry: &Entry| u32::from(entry.events) & Events::ENGAGED.bits() != 0;
        let zero = counted
            .iter()
            .rfind(|(_, entry, _)| engaged(entry))
            .or(counted.first());
        let zero = zero.map_or(0, |(.., at)| *at);
        counted
            .iter()
            .map(|(number, _, at)| (*number, at - zero))
            .collect()
    }

    /// Ticks since the last engagement of a sequence number: of the first call with it, where the record has one. Of a record without
    /// ticks they are counted from the slow track's first.
    pub fn tick_of(&self, sequence: u32) -> i64 {
        let mut near = None;
        for ((_, at), entry) in self.times().iter().zip(self.entries.values()) {
            match since(entry.sequence, sequence) {
                0 => return *at,
                ahead @ 1.. => near = Some(at + ahead),
                behind => near = near.or(Some(at + behind)),
            }
        }
        near.unwrap_or_else(|| {
            let begins = self.track.first().map(|stretch| {
                let others = u32::from(stretch.ticks.saturating_sub(1));
                stretch.sequence.wrapping_sub(others)
            });
            begins.map_or(0, |begins| since(begins, sequence))
        })
    }

    /// The stretches of the slow track, each with its first tick and the first after it.
    pub fn stretches(&self) -> impl Iterator<Item = (&supervisor::Stretch, [i64; 2])> {
        let engaged = |number: &usize| {
            let levitated = [Mode::Levitated, Mode::HandedBack].map(|mode| mode as u8);
            !levitated.contains(&self.entries[number].mode)
        };
        let times = self.times();
        let mut end = times
            .iter()
            .find(|(number, _)| engaged(number))
            .map(|(_, at)| *at);
        self.track.iter().map(move |stretch| {
            let ticks = i64::from(stretch.ticks);
            let counted = self.tick_of(stretch.sequence) + 1;
            // Calls without a new sample have the number of the last one.
            let to = end.map_or(counted, |end| counted.max(end + ticks));
            end = Some(to);
            (stretch, [to - ticks, to])
        })
    }
}

/// Ticks from a sequence number to another.
fn since(start: u32, sequence: u32) -> i64 {
    // Sequence numbers may wrap: what is before the start is negative.
    i64::from(sequence.wrapping_sub(start).cast_signed())
}

impl Ticks {
    /// Those of a record that are whole, in SI where its configuration is.
    pub fn of(record: &PlaneRecord) -> Self {
        let number = |bits: u32| record.number(bits);
        let unbelieved = record.unbelieved();
        let brief = |((at, entry), (_, tick)): ((&usize, &Entry), (usize, i64))| Brief {
            sequence: entry.sequence,
            tick,
            believed: !unbelieved.contains(at),
            position: entry.position.map(number),
            force: entry.force.map(number),
            mode: entry.mode,
            limits: entry.limits,
            events: entry.events,
        };
        let entries = record.entries.iter().zip(record.times());
        let entries: Vec<Brief> = entries.map(brief).collect();
        let units = record.units();
        let ticks: Vec<Tick> = entries.iter().map(|e| tick(e, units)).collect();
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

fn tick(entry: &Brief, units: Units) -> Tick {
    let (position, force) = (entry.position, entry.force);
    let tick = entry.tick;
    let limits = Limits::from_bits_truncate(entry.limits.into());
    let events = Events::from_bits_truncate(entry.events.into());
    Tick {
        sequence: entry.sequence,
        tick,
        time_s: units.sample_rate_hz.map(|rate| tick as f64 / rate),
        believed: entry.believed,
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
    let length = |[x, y]: [f64; 2]| x.hypot(y);
    ticks
        .chunk_by(|a, b| a.mode == b.mode)
        .map(|same| {
            let seen = same.iter().filter(|t| t.believed);
            Stretch {
                mode: same[0].mode,
                from_tick: same[0].tick,
                ticks: same.len(),
                largest_radius: seen.map(|t| length(t.position)).reduce(f64::max),
                largest_force: same.iter().map(|t| length(t.force)).fold(0.0, f64::max),
            }
        })
        .collect()
}
