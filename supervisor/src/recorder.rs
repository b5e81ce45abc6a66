//! Flight recorder: a fixed ring of the last ticks, frozen some time after the supervisor engages if it then comes to a touch,
//! with a version and a checksum; and a queue of events for the background task.

use crate::scalar::Scalar;
use crate::signal::{Events, Limits, Mode};
use crate::vec2::Vec2;

/// Version of the layout of [`Entry`] and [`Record`].
pub const RECORD_VERSION: u16 = 2;

/// Units of recorded lengths and forces: 1/4096 of the clearance and of the cap.
pub const PER_UNIT: f32 = 4096.0;

/// One tick, 16 bytes. Lengths in 1/4096 clearance, forces in 1/4096 cap, saturated at ±8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Entry {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Measured position; the estimate where the sample was refused.
    pub position: [i16; 2],
    /// Commanded force; in shadow what it would have been.
    pub force: [i16; 2],
    /// [`Mode`] as a number.
    pub mode: u8,
    /// Low byte of [`crate::Limits`].
    pub limits: u8,
    /// Low 16 bits of [`Events`].
    pub events: u16,
}

impl Entry {
    /// The sixteen bytes as they are to be written down, little-endian.
    pub fn to_bytes(&self) -> [u8; 16] {
        let [a, b, c, d] = self.words().map(u32::to_le_bytes);
        [
            a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], c[0], c[1], c[2], c[3], d[0], d[1],
            d[2], d[3],
        ]
    }

    /// The sixteen bytes as little-endian words.
    fn words(&self) -> [u32; 4] {
        let pair = |[low, high]: [i16; 2]| u32::from(low as u16) | (u32::from(high as u16) << 16);
        let rest = u32::from(self.mode) | (u32::from(self.limits) << 8);
        [
            self.sequence,
            pair(self.position),
            pair(self.force),
            rest | (u32::from(self.events) << 16),
        ]
    }
}

/// An event with its tick, for the background task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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

/// What makes an engagement worth a record: one without must not spend the record of one with it.
const WORTH_IT: Events = Events::TOUCHED.union(Events::SENSOR_FAULT);

/// What starts a record: an engagement, or, where the last record was discarded during one, what makes it worth it. The
/// entry at the end of the first quarter of a record has one of these.
pub const RECORD_TRIGGERS: Events = Events::ENGAGED.union(WORTH_IT);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Recording; nothing has happened yet.
    Armed,
    /// Recording for so many more ticks.
    Triggered(usize),
    /// Checksum under way; so many words done.
    Freezing(usize),
    Frozen,
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
    /// The engagement that triggered has had a touch, or a fault.
    worth_it: bool,
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
            worth_it: false,
            queued: heapless::Deque::new(),
        }
    }

    /// Takes a tick in; says what the recorder itself has to report.
    #[inline]
    pub(crate) fn push<S: Scalar>(
        &mut self,
        sequence: u32,
        position: Vec2<S>,
        force: Vec2<S>,
        (mode, limits): (Mode, Limits),
        events: Events,
    ) -> Events {
        let mut own = Events::empty();
        if let State::Armed | State::Triggered(1..) = self.state {
            self.write(Entry {
                sequence,
                position: [position.x.packed(), position.y.packed()],
                force: [force.x.packed(), force.y.packed()],
                mode: mode as u8,
                limits: limits.bits() as u8,
                events: events.bits() as u16,
            });
        }
        match self.state {
            State::Armed => {
                let engaged = mode.is_engaged();
                if events.contains(Events::ENGAGED) || engaged && events.intersects(WORTH_IT) {
                    // One that begins on the wall has no touch to come.
                    self.worth_it = !matches!(mode, Mode::Approach);
                    // A quarter before the trigger, three quarters after it.
                    self.state = State::Triggered(N - N / 4);
                }
            }
            State::Triggered(left) => {
                self.worth_it |= events.intersects(WORTH_IT);
                let over = left == 0 || mode == Mode::Levitated;
                self.state = match left.checked_sub(1) {
                    _ if over && !self.worth_it => State::Armed,
                    Some(left) => State::Triggered(left),
                    None => State::Freezing(0),
                };
                self.crc = !0;
            }
            State::Freezing(done) => {
                if self.check(done) {
                    own |= Events::RECORD_FROZEN;
                }
            }
            State::Frozen => {}
        }
        if !(events | own).is_empty() {
            self.queue(sequence, mode, events | own);
        }
        own
    }

    fn queue(&mut self, sequence: u32, mode: Mode, mut events: Events) {
        if self.lost {
            events |= Events::QUEUE_FULL;
        }
        let event = QueuedEvent {
            sequence,
            mode,
            events,
        };
        self.lost = self.queued.push_back(event).is_err();
    }

    #[inline]
    fn write(&mut self, new: Entry) {
        if let Some(entry) = self.entries.get_mut(self.next & Self::MASK) {
            *entry = new;
        }
        self.next = self.next.wrapping_add(1) & Self::MASK;
    }

    /// Takes a word into the checksum, which bounds the time of a tick; true when it is complete.
    fn check(&mut self, done: usize) -> bool {
        if let Some(entry) = (self.entries).get(self.next.wrapping_add(done / 4) & Self::MASK) {
            self.crc = crc_of_word(self.crc, entry.words()[done & 3]);
        }
        let done = done + 1;
        if done < 4 * N {
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

    /// Whether it waits for an engagement.
    pub(crate) fn is_armed(&self) -> bool {
        self.state == State::Armed
    }

    /// Whether a record has begun that is not frozen yet.
    pub(crate) fn is_recording(&self) -> bool {
        matches!(self.state, State::Triggered(_) | State::Freezing(_))
    }

    pub(crate) fn rearm(&mut self) {
        self.state = State::Armed;
    }

    pub(crate) fn next_event(&mut self) -> Option<QueuedEvent> {
        self.queued.pop_front()
    }
}

/// Four bytes into a CRC-32 (IEEE, reflected), a nibble at a time: no table of a kilobyte.
fn crc_of_word(mut crc: u32, word: u32) -> u32 {
    #[rustfmt::skip]
    const NIBBLE: [u32; 16] = [
        0x0000_0000, 0x1DB7_1064, 0x3B6E_20C8, 0x26D9_30AC, 0x76DC_4190, 0x6B6B_51F4, 0x4DB2_6158, 0x5005_713C,
        0xEDB8_8320, 0xF00F_9344, 0xD6D6_A3E8, 0xCB61_B38C, 0x9B64_C2B0, 0x86D3_D2D4, 0xA00A_E278, 0xBDBD_F21C,
    ];
    crc ^= word;
    for _ in 0..8 {
        crc = (crc >> 4) ^ NIBBLE[(crc & 15) as usize];
    }
    crc
}

/// CRC-32 of entries, for a reader of a record to compare with.
pub fn crc_of<'a>(entries: impl Iterator<Item = &'a Entry>) -> u32 {
    !entries.flat_map(Entry::words).fold(!0, crc_of_word)
}
