//! When the position of the rotor is unknown: readings that the supervisor did not believe, and ticks of which there are none.

use crate::record::file::PlaneRecord;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use supervisor::{Entry, Events, Limits, Mode, RejectReason, Status, Stretch};

/// Why the position is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    NotANumber,
    OutOfRange,
    Jumped,
    NoNewSample,
    DidNotChange,
    Implausible,
    /// Sequence numbers are missing between two ticks.
    MissedTicks,
    /// It was refused; the record does not say why.
    Refused,
    /// The slow track has a sensor fault; of which kind it does not say.
    SensorFault,
    /// The ticks, or stretches of the slow track, are missing in the file.
    NotInFile,
}

impl Reason {
    fn of(reason: RejectReason) -> Self {
        match reason {
            RejectReason::NotFinite => Self::NotANumber,
            RejectReason::Range => Self::OutOfRange,
            RejectReason::Slew => Self::Jumped,
            RejectReason::Dropout => Self::NoNewSample,
            RejectReason::Stuck => Self::DidNotChange,
            RejectReason::Doubted => Self::Implausible,
            RejectReason::None => Self::Refused,
        }
    }

    /// After "because".
    pub fn because(self) -> &'static str {
        match self {
            Self::NotANumber => "the reading was not a number",
            Self::OutOfRange => "the reading was out of range",
            Self::Jumped => "the reading jumped farther than a rotor can move",
            Self::NoNewSample => "no new sample came",
            Self::DidNotChange => "the reading did not change",
            Self::Implausible => "the reading was not where the rotor could be",
            Self::MissedTicks => "samples are missing between two ticks",
            Self::Refused => "the supervisor refused the reading",
            Self::SensorFault => "the supervisor reported a sensor fault",
            Self::NotInFile => "this part of the record is not in the file",
        }
    }

    /// Whether a reading came that does not fit the rotor: then others that were believed may not either.
    pub(super) fn is_misfit(self) -> bool {
        use Reason::{DidNotChange, Implausible, Jumped, OutOfRange};
        matches!(self, OutOfRange | Jumped | DidNotChange | Implausible)
    }

    /// Whether it says more than that the reading was not believed.
    pub(super) fn is_specific(self) -> bool {
        !matches!(self, Self::Refused | Self::SensorFault)
    }
}

/// A stretch of time in which the position is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Unknown {
    /// First tick since the engagement, and the first after it with a position.
    #[serde(skip)]
    pub ticks: [i64; 2],
    /// The same \[s\], where the rate is known.
    pub from_s: Option<f64>,
    /// See `from_s`.
    pub to_s: Option<f64>,
    /// What most of its ticks have.
    pub reason: Reason,
    /// Whether it was too long for the supervisor's model to make up for: a sensor fault, more ticks than that, or nobody knows.
    #[serde(skip)]
    pub serious: bool,
}

/// A reading that has not changed for so many ticks, and then jumps, was stuck: both coordinates, and one alone.
const STUCK: [usize; 2] = [3, 8];
/// Such a jump of one coordinate \[clearances\].
const JUMP: f64 = 0.05;

/// The supervisor's model makes up for so many ticks without a sample.
const MADE_UP_FOR: i64 = 4;

/// Reasons by the number of the entry.
pub(super) type Refusals = BTreeMap<usize, RejectReason>;

/// Ticks of one reason.
struct Piece {
    ticks: [i64; 2],
    reason: Reason,
    fault: bool,
}

/// Follows whether the sensor is faulty from tick to tick.
#[derive(Default)]
struct Fault(bool);

impl Fault {
    fn after(&mut self, entry: &Entry) -> bool {
        let events = Events::from_bits_truncate(entry.events.into());
        let on = Status::from_bits_retain(entry.status).contains(Status::BEARING_ON);
        // The mode says it, but where the bearing is off or given back.
        self.0 = match entry.mode {
            mode if mode == Mode::SensorFault as u8 => true,
            mode if on && mode != Mode::HandedBack as u8 => false,
            _ => {
                events.contains(Events::SENSOR_FAULT)
                    || self.0 && !events.contains(Events::SENSOR_OK)
            }
        };
        self.0
    }
}

fn is_refused(entry: &Entry) -> bool {
    Limits::from_bits_truncate(entry.limits.into()).contains(Limits::SAMPLE_REFUSED)
}

/// Whether a stretch of the slow track has a mode.
pub(crate) fn has_mode(stretch: &Stretch, mode: Mode) -> bool {
    stretch.modes & 1 << mode as u16 != 0
}

/// Whether no reading carried the estimate anywhere in a stretch of the slow track.
pub fn is_unseen(stretch: &Stretch) -> bool {
    stretch.modes == 1 << Mode::SensorFault as u16 || stretch.radius_square == 0
}

impl PlaneRecord {
    /// Numbers of the entries whose reading the supervisor did not believe.
    pub(super) fn unbelieved(&self) -> BTreeSet<usize> {
        let mut fault = Fault::default();
        let bad = self.entries.iter().filter(|(_, entry)| {
            let faulty = fault.after(entry);
            faulty || is_refused(entry)
        });
        bad.map(|(number, _)| *number).collect()
    }

    /// Whether the file has all of its ticks and of its slow track.
    pub(super) fn is_whole(&self) -> bool {
        self.entries.len() >= self.head.ticks as usize
            && self.track.len() >= self.head.stretches as usize
    }

    /// Where the position is unknown, in time order; `refusals`: what a replay says of why.
    pub(super) fn unknown(&self, refusals: &Refusals) -> Vec<Unknown> {
        let (mut pieces, covered, fault) = self.of_ticks(refusals);
        pieces.extend(self.of_track(covered, fault));
        let period_s = self.config.map(|config| f64::from(config.sample_period_s));
        let seconds = |tick: i64| period_s.map(|period_s| tick as f64 * period_s);
        let together = pieces.chunk_by(|a, b| {
            let lost = |piece: &Piece| piece.reason == Reason::NotInFile;
            a.ticks[1] >= b.ticks[0] && lost(a) == lost(b)
        });
        together
            .filter_map(|same| {
                let ticks = [same.first()?.ticks[0], same.last()?.ticks[1]];
                let reason = reason_of_most(same);
                Some(Unknown {
                    ticks,
                    from_s: seconds(ticks[0]),
                    to_s: seconds(ticks[1]),
                    reason,
                    serious: reason == Reason::NotInFile
                        || ticks[1] - ticks[0] > MADE_UP_FOR
                        || same.iter().any(|piece| piece.fault),
                })
            })
            .collect()
    }

    /// Of the ticks; the first after them, and whether the sensor was faulty at their end.
    fn of_ticks(&self, refusals: &Refusals) -> (Vec<Piece>, Option<i64>, bool) {
        let lost = |ticks: [i64; 2]| Piece {
            ticks,
            reason: Reason::NotInFile,
            fault: false,
        };
        let (unbelieved, mut fault) = (self.unbelieved(), Fault::default());
        let stuck = self.stuck(&unbelieved, refusals);
        let (mut pieces, mut last) = (Vec::new(), None);
        for (number, at) in self.times() {
            let entry = &self.entries[&number];
            match last {
                None if number > 0 => pieces.push(lost([at - number as i64, at])),
                Some((before, from)) if number > before + 1 => pieces.push(lost([from, at])),
                Some((_, from)) if at > from => pieces.push(Piece {
                    ticks: [from, at],
                    reason: Reason::MissedTicks,
                    fault: false,
                }),
                _ => {}
            }
            let faulty = fault.after(entry);
            if unbelieved.contains(&number) {
                let reason = refusals.get(&number).copied();
                pieces.push(Piece {
                    ticks: [at, at + 1],
                    reason: Reason::of(reason.unwrap_or_default()),
                    fault: faulty,
                });
            } else if stuck.contains(&number) {
                pieces.push(Piece {
                    ticks: [at, at + 1],
                    reason: Reason::DidNotChange,
                    fault: false,
                });
            }
            last = Some((number, at + 1));
        }
        let end = last.map(|(number, end)| {
            let missing = (self.head.ticks as i64 - 1 - number as i64).max(0);
            if missing > 0 {
                pieces.push(lost([end, end + missing]));
            }
            end + missing
        });
        pieces.retain(|piece| piece.ticks[0] < piece.ticks[1]);
        (pieces, end, fault.0)
    }

    /// Entries that were believed because nothing moved, before a reading came that shows that the rotor had moved.
    fn stuck(&self, unbelieved: &BTreeSet<usize>, refusals: &Refusals) -> BTreeSet<usize> {
        let before = |number: usize| {
            Some((
                number.checked_sub(1)?,
                self.entries.get(&number.checked_sub(1)?)?,
            ))
        };
        let mut stuck = BTreeSet::new();
        for (number, entry) in self
            .entries
            .iter()
            .filter(|(number, _)| unbelieved.contains(number))
        {
            let reason = Reason::of(refusals.get(number).copied().unwrap_or_default());
            let Some((last, held)) = before(*number) else {
                continue;
            };
            if unbelieved.contains(&last) || !matches!(reason, Reason::Implausible | Reason::Jumped)
            {
                continue;
            }
            let same = |axes: &[usize]| {
                let alike = |at: &usize| {
                    let there = self.entries.get(at);
                    there.is_some_and(|e| axes.iter().all(|i| e.position[*i] == held.position[*i]))
                };
                (0..=last).rev().take_while(alike).collect::<Vec<_>>()
            };
            let jumped = |axis: usize| {
                (self.number(entry.position[axis]) - self.number(held.position[axis])).abs() > JUMP
            };
            let both = same(&[0, 1]);
            let one = [0, 1]
                .into_iter()
                .filter(|axis| jumped(*axis))
                .map(|axis| same(&[axis]));
            let found = [(both, STUCK[0])]
                .into_iter()
                .chain(one.map(|one| (one, STUCK[1])));
            stuck.extend(
                found
                    .filter(|(run, least)| run.len() >= *least)
                    .flat_map(|(run, _)| run),
            );
        }
        stuck
    }

    /// Of the slow track from a tick on, before which the sensor was faulty or not.
    fn of_track(&self, covered: Option<i64>, mut faulty: bool) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut covered = covered;
        let lost = self.track.len() < self.head.stretches as usize;
        let miss = |from: Option<i64>, to: i64, pieces: &mut Vec<Piece>| {
            if let Some(from) = from.filter(|from| lost && *from < to) {
                pieces.push(Piece {
                    ticks: [from, to],
                    reason: Reason::NotInFile,
                    fault: false,
                });
            }
        };
        for (stretch, [begin, end]) in self.stretches() {
            let from = covered.map_or(begin, |covered| begin.max(covered));
            if from >= end {
                continue;
            }
            miss(covered, from, &mut pieces);
            let unclear = [Mode::Levitated, Mode::HandedBack].map(|mode| 1 << mode as u16);
            // Neither of these modes says that the sensor is well again.
            faulty &= stretch.modes & !(unclear[0] | unclear[1]) == 0;
            let fault = has_mode(stretch, Mode::SensorFault);
            if fault || faulty || is_unseen(stretch) {
                pieces.push(Piece {
                    ticks: [from, end],
                    reason: Reason::SensorFault,
                    fault: true,
                });
            }
            covered = Some(end);
        }
        miss(covered, self.closed(), &mut pieces);
        pieces
    }

    /// The first tick after the event.
    fn closed(&self) -> i64 {
        let track = self.stretches().last().map(|(_, [_, end])| end);
        track
            .into_iter()
            .fold(self.tick_of(self.head.closed_at) + 1, i64::max)
    }

    /// Whether one of these stretches has all of the event, from the first engagement on.
    pub(super) fn is_unseen_throughout(&self, unknown: &[Unknown]) -> bool {
        let engaged = |entry: &Entry| {
            ![Mode::Levitated, Mode::HandedBack]
                .map(|mode| mode as u8)
                .contains(&entry.mode)
        };
        let times = self.times();
        let first = times
            .iter()
            .find(|(number, _)| engaged(&self.entries[number]));
        let (from, to) = (first.map_or(0, |(_, at)| *at), self.closed() - 1);
        (unknown.iter()).any(|stretch| stretch.ticks[0] <= from && stretch.ticks[1] >= to)
    }
}

/// That of most ticks; what says more goes first.
fn reason_of_most(pieces: &[Piece]) -> Reason {
    let mut ticks: BTreeMap<Reason, i64> = BTreeMap::new();
    for piece in pieces {
        *ticks.entry(piece.reason).or_default() += piece.ticks[1] - piece.ticks[0];
    }
    let most = (ticks.into_iter()).max_by_key(|(reason, ticks)| (reason.is_specific(), *ticks));
    most.map_or(Reason::Refused, |(reason, _)| reason)
}
