//! What a frozen record is written down as: sections that each say what they are, to which record they belong and whether they
//! are whole, so that a file that is cut or damaged gives what is left of it.
//!
//! A section is, in words of 32 bits, little-endian: its [`Part`]; the record that it belongs to; its number among those of its
//! part in the lower half and the count of words that follow in the upper; these; the CRC-32 (IEEE) of all before.

use crate::account::severity::{Fastest, Severity};
use crate::account::tally::Units;
use crate::border::config::{Config, PARAMETERS};
use crate::border::finding::Checked;
use crate::border::parts::LEFT_OUT;
use crate::number::scalar::{Number, Scalar};
use crate::number::words::{Cells, Words, crc_of_word};
use crate::record::buffer::{FrozenHeader, RecordBuffer, STATE_WORDS};
use crate::record::entry::{ENTRY_WORDS, Entry, STRETCH_WORDS};
use crate::tick::State;
use core::marker::PhantomData;

/// Version of what is written.
pub const RECORD_VERSION: u16 = 4;
/// Most words that a section has between its head and its checksum.
pub const MOST_WORDS: usize = 180;
/// Most bytes of a section.
pub const SECTION_BYTES: usize = 4 * (3 + MOST_WORDS + 1);
/// Entries of a section, and stretches of the slow track.
const ENTRIES: usize = MOST_WORDS / ENTRY_WORDS;
const STRETCHES: usize = MOST_WORDS / STRETCH_WORDS;

/// Parts of a record, in the order in which they are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Part {
    /// What the record is: [`Head`].
    Head = u32::from_le_bytes(*b"AMBR"),
    /// Outcome of the event: [`Summary`].
    Summary = u32::from_le_bytes(*b"SUMM"),
    /// Values of the configuration, in the order of [`crate::PARAMETERS`].
    Config = u32::from_le_bytes(*b"CONF"),
    /// Of a rotor: mass, both inertias, and for each plane the places of retainer bearing, sensor and magnet.
    Shaft = u32::from_le_bytes(*b"SHFT"),
    /// The slow track: [`crate::Stretch`]es.
    Track = u32::from_le_bytes(*b"SLOW"),
    /// What the core remembered before the tick that [`Head::state_at`] says.
    State = u32::from_le_bytes(*b"STAT"),
    /// [`Entry`]s.
    Ticks = u32::from_le_bytes(*b"TICK"),
    /// The end, without words.
    End = u32::from_le_bytes(*b"ENDS"),
}

impl Part {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Head,
        Self::Summary,
        Self::Config,
        Self::Shaft,
        Self::Track,
        Self::State,
        Self::Ticks,
        Self::End,
    ];
}

/// What firmware adds to a record.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stamp {
    /// Which firmware this is.
    pub firmware: u32,
    /// A clock's time \[µs\], and the sequence number of the sample at that time.
    pub time_us: u64,
    /// See `time_us`.
    pub at_sequence: u32,
}

/// First section of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Head {
    /// [`RECORD_VERSION`].
    pub version: u32,
    /// Version of the supervisor: major, minor and patch, a byte each, from the highest but one. In the highest, a bit for each part
    /// that is left out: unbalance, axis monitor, thermal budget.
    pub supervisor: u32,
    /// [`crate::Number`] of the core.
    pub number: u32,
    /// Which plane this is, of how many.
    pub plane: u32,
    /// See `plane`.
    pub planes: u32,
    /// Entries in all.
    pub ticks: u32,
    /// Entry before which the state was kept; [`NO_STATE`] where none is of use.
    pub state_at: u32,
    /// Words of that state.
    pub state_words: u32,
    /// Stretches of the slow track.
    pub stretches: u32,
    /// Sequence number of the last tick before the record froze.
    pub closed_at: u32,
    /// Events before this one that found a record frozen, or have gone from an [`crate::Archive`]: they are in no file.
    pub dropped: u32,
    /// [`Stamp::firmware`].
    pub firmware: u32,
    /// [`Stamp::time_us`].
    pub time_us: u64,
    /// [`Stamp::at_sequence`].
    pub at_sequence: u32,
}

crate::number::words::words_of_fields!(Head {
    version,
    supervisor,
    number,
    plane,
    planes,
    ticks,
    state_at,
    state_words,
    stretches,
    closed_at,
    dropped,
    firmware,
    time_us,
    at_sequence,
});

impl Head {
    /// From the words of its section; of any others, something.
    pub fn from_words(words: &[u32]) -> Self {
        Self::decode(&mut words.iter().copied())
    }
}

/// [`Head::state_at`] where no state is of use.
pub const NO_STATE: u32 = u32::MAX;

/// Outcome of an event. Counts and maxima are those of the event, not those since the supervisor was made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    /// [`crate::Mode`] in which it ended, as a number: `Levitated` where the levitation controller has the bearing again.
    pub mode: u32,
    /// Whether the bearing was on at the end.
    pub bearing_on: bool,
    /// Whether coasting down was asked for in the event, or before it and still.
    pub coast_down: bool,
    /// Touches.
    pub touches: u32,
    /// Ticks in contact.
    pub contact_ticks: u32,
    /// Fastest normal speed before an impact \[m/s\].
    pub hardest_impact_m_s: f32,
    /// Fastest backward speed in contact \[m/s\].
    pub backward_speed_max_m_s: f32,
    /// The most that the cap arrests \[m/s\].
    pub whirl_limit_m_s: f32,
    /// By how much the severity index has risen, and what it has come to.
    pub severity: f32,
    /// See `severity`.
    pub severity_index: f32,
    /// Landings since the supervisor was made, with this one.
    pub landings: u32,
}

crate::number::words::words_of_fields!(Summary {
    mode,
    bearing_on,
    coast_down,
    touches,
    contact_ticks,
    hardest_impact_m_s,
    backward_speed_max_m_s,
    whirl_limit_m_s,
    severity,
    severity_index,
    landings,
});

impl Summary {
    /// From the words of its section; of any others, something.
    pub fn from_words(words: &[u32]) -> Self {
        Self::decode(&mut words.iter().copied())
    }
}

/// A frozen record. It does not change while this is there.
#[derive(Debug, Clone, Copy)]
pub struct Record<'a, S: Scalar, const N: usize> {
    buffer: &'a RecordBuffer<N>,
    closed: FrozenHeader,
    number: PhantomData<S>,
    /// Of a rotor.
    pub(crate) shaft: Option<[f32; 9]>,
}

impl<'a, S: Scalar, const N: usize> Record<'a, S, N> {
    pub(crate) fn new(buffer: &'a RecordBuffer<N>) -> Option<Self> {
        buffer.is_frozen().then(|| Self {
            buffer,
            closed: FrozenHeader::from_words(Words::decode(&mut buffer.closed.words())),
            number: PhantomData,
            shaft: None,
        })
    }

    fn entry(&self, index: usize) -> Option<Entry> {
        let FrozenHeader { written, ticks, .. } = self.closed;
        let index = u32::try_from(index).ok().filter(|index| *index < ticks)?;
        let place = self
            .buffer
            .entry(written.wrapping_sub(ticks).wrapping_add(index))?;
        Some(Entry::from_words(Words::decode(&mut place.words())))
    }

    /// Entries from oldest to newest.
    pub fn entries(&self) -> impl Iterator<Item = Entry> {
        (0..N).map_while(|index| self.entry(index))
    }

    /// The configuration that the core had when its state was kept.
    pub fn config(&self) -> Config {
        let values: [f32; PARAMETERS.len()] = Words::decode(&mut self.buffer.config.words());
        Config::from_values(values)
    }

    /// [`Head::dropped`].
    pub(crate) fn dropped(&mut self) -> &mut u32 {
        &mut self.closed.dropped
    }

    /// [`Head::closed_at`].
    pub(crate) fn closed_at(&self) -> u32 {
        self.closed.sequence
    }

    /// Outcome of the event.
    pub fn summary(&self) -> Summary {
        let (buffer, closed) = (self.buffer, &self.closed);
        let opening = match (closed.keeps, closed.is_new) {
            (false, _) => Severity::decode(&mut buffer.opening.words()),
            (true, false) => State::<S>::severity_in(buffer.state.words()),
            (true, true) => Severity::default(),
        };
        let [before, now] = [
            (opening, &buffer.opening_units),
            (
                Severity::decode(&mut buffer.closing.words()),
                &buffer.closing_units,
            ),
        ]
        .map(|(severity, units)| {
            let units = Units::decode(&mut units.words());
            severity
                .tally(Fastest::default())
                .report(&units, Checked::default())
        });
        Summary {
            mode: closed.mode as u32,
            bearing_on: closed.on,
            coast_down: closed.coast_down,
            touches: now.impacts.wrapping_sub(before.impacts),
            contact_ticks: now.contact_ticks.wrapping_sub(before.contact_ticks),
            hardest_impact_m_s: now.impact_speed_max_m_s,
            backward_speed_max_m_s: now.backward_speed_max_m_s,
            whirl_limit_m_s: now.whirl_limit_m_s,
            severity: now.severity_index - before.severity_index,
            severity_index: now.severity_index,
            landings: now.landings,
        }
    }

    fn head(&self, stamp: &Stamp) -> Head {
        let closed = &self.closed;
        let [plane, planes] = closed.plane.map(u32::from);
        let state_at = if closed.keeps && S::NUMBER != Number::Double {
            closed.ticks.wrapping_sub(closed.since)
        } else {
            NO_STATE
        };
        Head {
            version: u32::from(RECORD_VERSION),
            supervisor: SUPERVISOR_VERSION,
            number: S::NUMBER as u32,
            plane,
            planes,
            ticks: closed.ticks,
            state_at,
            state_words: STATE_WORDS as u32,
            stretches: closed.stretches,
            closed_at: closed.sequence,
            dropped: closed.dropped,
            firmware: stamp.firmware,
            time_us: stamp.time_us,
            at_sequence: stamp.at_sequence,
        }
    }

    /// A section of the record, 0 the first; `None` beyond the last. `stamp` is the same for all sections. They are written one
    /// after the other as they are, each sealed by [`Section::seal`].
    pub fn section(&self, index: u32, stamp: &Stamp) -> Option<Section> {
        let head = self.head(stamp);
        let mut section = Section::new(&head);
        let buffer = self.buffer;
        let mut index = index as usize;
        for part in Part::ALL {
            let (words, per_section) = match part {
                Part::Shaft if self.shaft.is_none() => continue,
                Part::Track => (head.stretches as usize, STRETCHES),
                Part::State if head.state_at == NO_STATE => continue,
                Part::State => (head.state_words as usize, MOST_WORDS),
                Part::Ticks => (head.ticks as usize, ENTRIES),
                Part::Head | Part::Summary | Part::Config | Part::Shaft | Part::End => (1, 1),
            };
            let sections = words.div_ceil(per_section);
            if index >= sections {
                index -= sections;
                continue;
            }
            section.begin(part, index as u32);
            let from = index * per_section;
            let mut put = |word| section.push(word);
            match part {
                Part::Head => head.encode(&mut put),
                Part::Summary => self.summary().encode(&mut put),
                Part::Config => self.config().values().encode(&mut put),
                Part::Shaft => self.shaft.unwrap_or_default().encode(&mut put),
                Part::Track => {
                    let complete = buffer.track.iter().take(head.stretches as usize);
                    let these = complete.skip(from).take(per_section);
                    these.for_each(|stretch| stretch.words().for_each(&mut put));
                }
                Part::State => {
                    let new = Cells::new();
                    let state = match self.closed.is_new {
                        true => {
                            State::<S>::default().write_all(&new);
                            &new
                        }
                        false => &buffer.state,
                    };
                    let these = state.words().skip(from).take(per_section);
                    these.for_each(&mut put);
                }
                Part::Ticks => {
                    let these = (from..from + per_section).map_while(|i| self.entry(i));
                    these.for_each(|entry| entry.words().encode(&mut put));
                }
                Part::End => {}
            }
            return Some(section);
        }
        None
    }
}

/// Version of this crate as [`Head::supervisor`] has it.
pub const SUPERVISOR_VERSION: u32 = number(env!("CARGO_PKG_VERSION_MAJOR")) << 16
    | number(env!("CARGO_PKG_VERSION_MINOR")) << 8
    | number(env!("CARGO_PKG_VERSION_PATCH"))
    | LEFT_OUT << 24;

/// A number in decimal digits.
const fn number(text: &str) -> u32 {
    let (bytes, mut i, mut n) = (text.as_bytes(), 0, 0);
    while i < bytes.len() {
        n = 10 * n + (bytes[i] - b'0') as u32;
        i += 1;
    }
    n
}

/// Some words of a record, to be sealed and written down.
#[derive(Debug, Clone)]
pub struct Section {
    /// Little-endian.
    words: heapless::Vec<[u8; 4], { SECTION_BYTES / 4 }>,
    /// Of the record that it belongs to.
    head: Head,
    sealed: bool,
}

impl Section {
    fn new(head: &Head) -> Self {
        Self {
            words: heapless::Vec::new(),
            head: *head,
            sealed: false,
        }
    }

    /// What the second word will be is known when it is sealed, and so is the number of words in the third.
    fn begin(&mut self, part: Part, index: u32) {
        [part as u32, 0, index]
            .into_iter()
            .for_each(|word| self.push(word));
    }

    /// Once, and not for each word of the state.
    #[inline(never)]
    fn push(&mut self, word: u32) {
        // There is room: a section has no more words than this.
        let _full = self.words.push(word.to_le_bytes());
    }

    /// Adds the record, the count and the checksum; the bytes are then as they are to be written.
    pub fn seal(&mut self) -> &[u8] {
        if !core::mem::replace(&mut self.sealed, true) {
            // What no two records of a machine have in common: their times and what they are of.
            let mut record = !0;
            self.head
                .encode(&mut |word| record = crc_of_word(record, word));
            let count = self.words.len().saturating_sub(3) as u32;
            if let [_, of, numbers, ..] = self.words.as_mut_slice() {
                *of = record.to_le_bytes();
                *numbers = (u32::from_le_bytes(*numbers) | count << 16).to_le_bytes();
            }
            let crc = crc_of(self.as_bytes());
            self.push(crc);
        }
        self.as_bytes()
    }

    fn as_bytes(&self) -> &[u8] {
        self.words.as_slice().as_flattened()
    }
}

/// CRC-32 (IEEE, reflected, polynomial 0xEDB88320, start and final XOR 0xFFFFFFFF) of whole words, little-endian; what is beyond
/// the last whole word does not count.
pub fn crc_of(bytes: &[u8]) -> u32 {
    let (words, _) = bytes.as_chunks::<4>();
    !words
        .iter()
        .fold(!0, |crc, word| crc_of_word(crc, u32::from_le_bytes(*word)))
}
