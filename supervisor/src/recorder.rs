//! Flight recorder: a fixed ring of the last ticks, frozen some time after the supervisor engages,
//! with a version and a checksum; and a queue of events for the background task.

use crate::signal::{Command, Events, Mode, Sample};
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
    fn bytes(&self) -> [u8; 16] {
        let [s0, s1, s2, s3] = self.sequence.to_le_bytes();
        let [[x0, x1], [y0, y1]] = self.position.map(i16::to_le_bytes);
        let [[f0, f1], [g0, g1]] = self.force.map(i16::to_le_bytes);
        let [e0, e1] = self.events.to_le_bytes();
        [
            s0,
            s1,
            s2,
            s3,
            x0,
            x1,
            y0,
            y1,
            f0,
            f1,
            g0,
            g1,
            self.mode,
            self.limits,
            e0,
            e1,
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

/// Entries that the checksum takes in per tick: bounds the time of a tick.
const CHECKED_PER_TICK: usize = 4;

/// Ring of `N` entries (a power of two).
#[derive(Debug, Clone)]
pub(crate) struct Recorder<const N: usize> {
    entries: [Entry; N],
    next: usize,
    state: State,
    crc: u32,
    queue: heapless::Deque<QueuedEvent, 16>,
    lost: bool,
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
            entries: [Entry::default(); N],
            next: 0,
            state: State::Armed,
            crc: !0,
            queue: heapless::Deque::new(),
            lost: false,
        }
    }

    /// Takes a tick in; says what the recorder itself has to report.
    pub(crate) fn push(
        &mut self,
        sample: &Sample,
        position: Vec2,
        force: Vec2,
        command: &Command,
    ) -> Events {
        let mut own = Events::empty();
        match self.state {
            State::Armed if command.events.contains(Events::ENGAGED) => {
                self.write(sample, position, force, command);
                // A quarter before the trigger, three quarters after it.
                self.state = State::Triggered(N - N / 4);
            }
            State::Armed => self.write(sample, position, force, command),
            State::Triggered(0) => {
                self.crc = !0;
                self.state = State::Freezing(0);
            }
            State::Triggered(left) => {
                self.write(sample, position, force, command);
                self.state = State::Triggered(left - 1);
            }
            State::Freezing(done) => {
                if self.check(done) {
                    own |= Events::RECORD_FROZEN;
                }
            }
            State::Frozen => {}
        }
        let events = command.events | own;
        if !events.is_empty() {
            let event = QueuedEvent {
                sequence: sample.sequence,
                mode: command.mode,
                events: if self.lost {
                    events | Events::QUEUE_FULL
                } else {
                    events
                },
            };
            self.lost = self.queue.push_back(event).is_err();
        }
        own
    }

    fn write(&mut self, sample: &Sample, position: Vec2, force: Vec2, command: &Command) {
        // `as` saturates, and turns NaN into 0.
        let packed = |v: Vec2| v.to_array().map(|x| (x * PER_UNIT) as i16);
        if let Some(entry) = self.entries.get_mut(self.next & Self::MASK) {
            *entry = Entry {
                sequence: sample.sequence,
                position: packed(position),
                force: packed(force),
                mode: command.mode as u8,
                limits: command.limits.bits() as u8,
                events: command.events.bits() as u16,
            };
        }
        self.next = self.next.wrapping_add(1) & Self::MASK;
    }

    /// Takes some entries into the checksum; true when it is complete.
    fn check(&mut self, done: usize) -> bool {
        for i in done..done + CHECKED_PER_TICK {
            if let Some(entry) = self.entries.get(self.next.wrapping_add(i) & Self::MASK) {
                for byte in entry.bytes() {
                    self.crc = crc_step(self.crc, byte);
                }
            }
        }
        let done = done + CHECKED_PER_TICK;
        if done < N {
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
        self.queue.pop_front()
    }
}

/// One byte into a CRC-32 (IEEE, reflected), a nibble at a time: no table of a kilobyte.
fn crc_step(crc: u32, byte: u8) -> u32 {
    #[rustfmt::skip]
    const NIBBLE: [u32; 16] = [
        0x0000_0000, 0x1DB7_1064, 0x3B6E_20C8, 0x26D9_30AC, 0x76DC_4190, 0x6B6B_51F4, 0x4DB2_6158, 0x5005_713C,
        0xEDB8_8320, 0xF00F_9344, 0xD6D6_A3E8, 0xCB61_B38C, 0x9B64_C2B0, 0x86D3_D2D4, 0xA00A_E278, 0xBDBD_F21C,
    ];
    let mut crc = crc ^ u32::from(byte);
    for _ in 0..2 {
        crc = (crc >> 4) ^ NIBBLE[(crc & 15) as usize];
    }
    crc
}

/// CRC-32 of entries, for a reader of a record to compare with.
pub fn crc_of<'a>(entries: impl Iterator<Item = &'a Entry>) -> u32 {
    let mut crc = !0;
    for entry in entries {
        for byte in entry.bytes() {
            crc = crc_step(crc, byte);
        }
    }
    !crc
}
