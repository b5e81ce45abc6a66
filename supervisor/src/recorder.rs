//! Flight recorder: a fixed ring of the last ticks, frozen some time after the supervisor engages,
//! with a version and a checksum; and a queue of events for the background task.

use crate::scalar::Scalar;
use crate::signal::{Events, Limits, Mode};
use crate::vec2::Vec2;

/// Version of the layout of [`Entry`] and [`Record`].
pub const RECORD_VERSION: u16 = 1;

/// Units of recorded lengths and forces: 1/4096 of the clearance and of the cap.
pub const PER_UNIT: f32 = 4096.0;

/// One tick, 16 bytes. Lengths in 1/4096 clearance, forces in 1/4096 cap, saturated at ±8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Entry {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Measured position.
    pub position: [i16; 2],
    /// Commanded force.
    pub force: [i16; 2],
    /// [`Mode`] as a number.
    pub mode: u8,
    /// Low byte of [`crate::Limits`].
    pub limits: u8,
    /// Low 16 bits of [`Events`].
    pub events: u16,
}

impl Entry {
    /// The sixteen bytes, little-endian, in two halves.
    fn halves(&self) -> [[u8; 8]; 2] {
        let [s0, s1, s2, s3] = self.sequence.to_le_bytes();
        let [[x0, x1], [y0, y1]] = self.position.map(i16::to_le_bytes);
        let [[f0, f1], [g0, g1]] = self.force.map(i16::to_le_bytes);
        let [e0, e1] = self.events.to_le_bytes();
        [
            [s0, s1, s2, s3, x0, x1, y0, y1],
            [f0, f1, g0, g1, self.mode, self.limits, e0, e1],
        ]
    }
}

/// An event with its tick, for the background task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueuedEvent {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Mode after the tick.
    pub mode: Mode,
    /// What changed.
    pub events: Events,
}

/// A frozen record.
#[derive(Debug, Clone, Copy)]
pub struct Record<'a, const N: usize> {
    entries: &'a [Entry; N],
    oldest: usize,
    /// CRC-32 (IEEE) over the entries from oldest to newest, 16 little-endian bytes each.
    pub crc: u32,
}

impl<'a, const N: usize> Record<'a, N> {
    /// Entries from oldest to newest.
    pub fn entries(&self) -> impl Iterator<Item = &'a Entry> {
        let (newer, older) = self
            .entries
            .split_at_checked(self.oldest)
            .unwrap_or((&[], &[]));
        older.iter().chain(newer)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Recording; nothing has happened yet.
    Armed,
    /// Recording for so many more ticks.
    Triggered(usize),
    /// Checksum under way; so many entries done.
    Freezing(usize),
    Frozen,
}

/// What a tick gives to the recorder.
pub(crate) struct Tick<S> {
    pub(crate) sequence: u32,
    pub(crate) position: Vec2<S>,
    pub(crate) force: Vec2<S>,
    pub(crate) mode: Mode,
    pub(crate) limits: Limits,
    pub(crate) events: Events,
}

/// Ring of `N` entries (a power of two).
///
/// The order of the fields is kept, and has written numbers on both sides of the entries: then the compiler
/// clears these where the recorder will stay, and has no copy of them on the stack on the way there.
#[derive(Debug, Clone)]
#[repr(C)]
pub(crate) struct Recorder<const N: usize> {
    state: State,
    crc: u32,
    next: usize,
    entries: [Entry; N],
    lost: bool,
    queued: heapless::Deque<QueuedEvent, 16>,
}

impl<const N: usize> Recorder<N> {
    const MASK: usize = {
        assert!(
            N.is_power_of_two() && N >= 4,
            "record length must be a power of two, at least 4"
        );
        N - 1
    };

    pub(crate) fn new() -> Self {
        Self {
            state: State::Armed,
            crc: !0,
            next: 0,
            entries: [Entry::default(); N],
            lost: false,
            queued: heapless::Deque::new(),
        }
    }

    /// Takes a tick in; says what the recorder itself has to report.
    #[inline(never)]
    pub(crate) fn push<S: Scalar>(&mut self, tick: &Tick<S>) -> Events {
        let mut own = Events::empty();
        match self.state {
            State::Armed => {
                self.write(tick);
                if tick.events.contains(Events::ENGAGED) {
                    // A quarter before the trigger, three quarters after it.
                    self.state = State::Triggered(N - N / 4);
                }
            }
            State::Triggered(0) => {
                self.crc = !0;
                self.state = State::Freezing(0);
            }
            State::Triggered(left) => {
                self.write(tick);
                self.state = State::Triggered(left - 1);
            }
            State::Freezing(done) => {
                if self.check(done) {
                    own |= Events::RECORD_FROZEN;
                }
            }
            State::Frozen => {}
        }
        let events = tick.events | own;
        if !events.is_empty() {
            self.queue(tick, events);
        }
        own
    }

    fn queue<S>(&mut self, tick: &Tick<S>, mut events: Events) {
        if self.lost {
            events |= Events::QUEUE_FULL;
        }
        let event = QueuedEvent {
            sequence: tick.sequence,
            mode: tick.mode,
            events,
        };
        self.lost = self.queued.push_back(event).is_err();
    }

    #[inline]
    fn write<S: Scalar>(&mut self, tick: &Tick<S>) {
        if let Some(entry) = self.entries.get_mut(self.next & Self::MASK) {
            *entry = Entry {
                sequence: tick.sequence,
                position: [tick.position.x.packed(), tick.position.y.packed()],
                force: [tick.force.x.packed(), tick.force.y.packed()],
                mode: tick.mode as u8,
                limits: tick.limits.bits() as u8,
                events: tick.events.bits() as u16,
            };
        }
        self.next = self.next.wrapping_add(1) & Self::MASK;
    }

    /// Takes half an entry into the checksum, which bounds the time of a tick; true when it is complete.
    fn check(&mut self, done: usize) -> bool {
        if let Some(entry) = (self.entries).get(self.next.wrapping_add(done / 2) & Self::MASK) {
            let [early, late] = entry.halves();
            self.crc = crc_of_bytes(self.crc, if done & 1 == 0 { early } else { late });
        }
        let done = done + 1;
        if done < 2 * N {
            self.state = State::Freezing(done);
            return false;
        }
        self.crc = !self.crc;
        self.state = State::Frozen;
        true
    }

    pub(crate) fn record(&self) -> Option<Record<'_, N>> {
        (self.state == State::Frozen).then_some(Record {
            entries: &self.entries,
            oldest: self.next,
            crc: self.crc,
        })
    }

    pub(crate) fn rearm(&mut self) {
        self.state = State::Armed;
    }

    pub(crate) fn next_event(&mut self) -> Option<QueuedEvent> {
        self.queued.pop_front()
    }
}

/// CRC-32 (IEEE, reflected) of each byte. A kilobyte of flash halves the longest tick of the recorder.
const CRC_OF_BYTE: [u32; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            crc = (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
            bit += 1;
        }
        table[byte] = crc;
        byte += 1;
    }
    table
};

fn crc_of_bytes(crc: u32, bytes: [u8; 8]) -> u32 {
    let step = |crc: u32, byte: u8| (crc >> 8) ^ CRC_OF_BYTE[(crc as u8 ^ byte) as usize];
    bytes.into_iter().fold(crc, step)
}

/// CRC-32 of entries, for a reader of a record to compare with.
pub fn crc_of<'a>(entries: impl Iterator<Item = &'a Entry>) -> u32 {
    !entries.flat_map(Entry::halves).fold(!0, crc_of_bytes)
}
