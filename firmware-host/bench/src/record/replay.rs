//! The ticks of a record once more, by the supervisor of this build.

use crate::record::file::PlaneRecord;
use crate::record::unknown::Refusals;
use serde::Serialize;
use supervisor::{
    Core, CoreCommand, Entry, Events, Number, Prepared, Q, RejectReason, Report, RotorSupervisor,
    SUPERVISOR_VERSION, Scalar,
};

/// Outcome of a replay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Replay {
    /// Ticks that were replayed, in all planes.
    pub ticks: usize,
    /// Those of them whose command is another.
    pub differing: usize,
    /// Sequence number of the first of them.
    pub first_difference: Option<u32>,
}

/// Parts of the supervisor that a build may leave out, in the order of their bits in a record.
const PARTS: [&str; 4] = ["unbalance", "axis monitor", "thermal budget", "bending"];

/// Why ticks cannot be replayed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoReplay {
    /// The state, the configuration, or the first ticks after the state are not there.
    #[error(
        "what the supervisor remembered, its configuration, or the ticks after that are not in the file"
    )]
    Missing,
    /// It was made of `f64`.
    #[error("it was made with numbers of 64 bits, of which a record keeps no samples")]
    Numbers,
    /// The state has another size than that of this build.
    #[error("it was made by version {}.{}.{} of the supervisor, which remembers something else", .0 >> 16 & 0xFF, .0 >> 8 & 0xFF, .0 & 0xFF)]
    Version(u32),
    /// By a supervisor that lacks parts which this build has.
    #[error(
        "it was made by a supervisor without {}, which would command something else here",
        .0.iter().copied().zip(PARTS).filter_map(|(left_out, part)| left_out.then_some(part)).collect::<Vec<_>>().join(", ")
    )]
    Parts([bool; 4]),
    /// The configuration is not one.
    #[error("its configuration is not valid for this version of the supervisor")]
    Configuration,
    /// Of a rotor: the record of the other plane is not there.
    #[error("the record of the other plane of the same event is not in the file")]
    OtherPlane,
}

/// Replays the record of a plane, or those of both planes of a rotor.
///
/// # Errors
/// [`NoReplay`].
pub fn replay(records: &[&PlaneRecord]) -> Result<Replay, NoReplay> {
    Ok(with_refusals(records)?.0)
}

/// The same, and why readings were refused in each of these records.
pub(super) fn with_refusals(records: &[&PlaneRecord]) -> Result<(Replay, Vec<Refusals>), NoReplay> {
    let (Some(first), other) = (records.first(), records.get(1)) else {
        return Err(NoReplay::Missing);
    };
    match (first.head.planes, other) {
        (1, _) if first.head.number == Number::Single as u32 => of_one::<f32>(first),
        (1, _) if first.head.number == Number::Fixed as u32 => of_one::<Q>(first),
        (1, _) => Err(NoReplay::Numbers),
        (_, None) => Err(NoReplay::OtherPlane),
        (_, Some(other)) => of_rotor([first, other]),
    }
}

/// Ticks from the state on, without a break, with their numbers.
fn ticks(record: &PlaneRecord) -> impl Iterator<Item = (usize, &Entry)> {
    let from = record.head.state_at as usize;
    let these = (from..).map_while(|i| Some((i, record.entries.get(&i)?)));
    // A configuration that comes later is not in the record.
    these.map_while(move |(i, entry)| {
        let changed = u32::from(entry.events) & Events::RECONFIGURED.bits() != 0;
        (i == from || !changed).then_some((i, entry))
    })
}

impl Replay {
    fn new() -> Self {
        Self {
            ticks: 0,
            differing: 0,
            first_difference: None,
        }
    }

    fn compare<S: Scalar>(&mut self, entry: &Entry, command: &CoreCommand<S>) {
        self.ticks += 1;
        if !entry.gave(command) {
            self.differing += 1;
            self.first_difference = self.first_difference.or(Some(entry.sequence));
        }
    }
}

/// Whether the state is one of this build.
fn check<S: Scalar>(record: &PlaneRecord) -> Result<&[u32], NoReplay> {
    let state = record.state.as_ref().ok_or(NoReplay::Missing)?;
    if ticks(record).next().is_none() {
        return Err(NoReplay::Missing);
    }
    let version = record.head.supervisor;
    let of_version = |version: u32| version & 0x00FF_FFFF;
    if of_version(version) == of_version(SUPERVISOR_VERSION) && version != SUPERVISOR_VERSION {
        return Err(NoReplay::Parts(
            [24, 25, 26, 27].map(|bit| version >> bit & 1 == 1),
        ));
    }
    if version != SUPERVISOR_VERSION || state.len() != Core::<S, 4>::state_words() {
        return Err(NoReplay::Version(version));
    }
    Ok(state)
}

/// Why the reading of this tick was refused, or why the fault began that it is a part of.
fn refusal(report: &Report) -> RejectReason {
    match report.refusal {
        RejectReason::None => report.fault,
        reason => reason,
    }
}

fn of_one<S: Scalar>(record: &PlaneRecord) -> Result<(Replay, Vec<Refusals>), NoReplay> {
    let state = check::<S>(record)?;
    let config = record.config.ok_or(NoReplay::Missing)?;
    let prepared = Prepared::new(&config).map_err(|_| NoReplay::Configuration)?;
    let mut core = Core::<S, 4>::resumed(&prepared, state);
    let (mut replay, mut refusals) = (Replay::new(), Refusals::new());
    let unbelieved = record.unbelieved();
    for (number, entry) in ticks(record) {
        replay.compare(entry, &core.tick(&entry.sample()));
        if replay.differing == 0 && unbelieved.contains(&number) {
            refusals.insert(number, refusal(&core.report()));
        }
    }
    Ok((replay, vec![refusals]))
}

fn of_rotor(records: [&PlaneRecord; 2]) -> Result<(Replay, Vec<Refusals>), NoReplay> {
    let [a, b] = records;
    let same = |a: &PlaneRecord, b: &PlaneRecord| {
        let of = |r: &PlaneRecord| (r.head.closed_at, r.head.ticks, r.head.state_at);
        of(a) == of(b) && (a.head.plane, b.head.plane) == (0, 1) && a.shaft == b.shaft
    };
    if !same(a, b) {
        return Err(NoReplay::OtherPlane);
    }
    let states = [check::<f32>(a)?, check::<f32>(b)?];
    let (shaft, first, second) = match (a.shaft, a.config, b.config) {
        (Some(shaft), Some(first), Some(second)) => (shaft, first, second),
        _ => return Err(NoReplay::Missing),
    };
    let mut rotor = RotorSupervisor::<4>::resumed(&shaft, &[first, second], states)
        .map_err(|_| NoReplay::Configuration)?;
    let (mut replay, mut refusals) = (Replay::new(), vec![Refusals::new(); 2]);
    let unbelieved = records.map(PlaneRecord::unbelieved);
    for ((number, at_a), (_, at_b)) in ticks(a).zip(ticks(b)) {
        let [to_a, to_b] = rotor.tick_per_unit(&[at_a.sample(), at_b.sample()]);
        replay.compare(at_a, &to_a);
        replay.compare(at_b, &to_b);
        for end in 0..2 {
            if replay.differing == 0 && unbelieved[end].contains(&number) {
                let report = rotor.plane(end).report();
                refusals[end].insert(number, refusal(&report));
            }
        }
    }
    Ok((replay, refusals))
}
