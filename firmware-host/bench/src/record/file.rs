//! The sections of a record file. What is damaged is left out and named; what is given back was written so.

use std::collections::BTreeMap;
use supervisor::{
    Config, ENTRY_WORDS, Entry, Head, MOST_WORDS, NO_STATE, Number, Part, Q, RECORD_VERSION,
    STRETCH_WORDS, Scalar, Shaft, Stretch, Summary, crc_of,
};

/// Words of a section before those of its part, and with the checksum.
const HEAD_WORDS: usize = 3;
const FRAME_WORDS: usize = HEAD_WORDS + 1;

/// What is wrong with a file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// No section begins anywhere.
    #[error("no section of a flight record is in it")]
    NoSection,
    /// Bytes between whole sections.
    #[error(
        "{count} bytes from byte {from} on are of no whole section: damaged, cut off, or of something else"
    )]
    Bytes {
        /// The first of them.
        from: usize,
        /// How many.
        count: usize,
    },
    /// Written by another version of the format.
    #[error("a record of version {0} is in it; this program reads version {RECORD_VERSION}")]
    Version(u32),
    /// Sections whose record has no head in this file.
    #[error("{0} sections are of a record whose head is not in it")]
    WithoutHead(usize),
    /// A part that its head promises is not there, or not whole.
    #[error("of the record of plane {plane} {missing} of {of} {what} are missing")]
    Missing {
        /// Plane of the record.
        plane: u32,
        what: &'static str,
        /// How many.
        missing: usize,
        /// Of how many.
        of: usize,
    },
    /// Two sections claim one place and differ.
    #[error("of the record of plane {plane} a section is there twice, and not the same")]
    Twice {
        /// Plane of the record.
        plane: u32,
    },
}

/// The record of a plane, as far as it is whole.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneRecord {
    /// What it is.
    pub head: Head,
    /// Outcome of the event.
    pub summary: Option<Summary>,
    /// The supervisor's configuration.
    pub config: Option<Config>,
    /// Of a rotor.
    pub shaft: Option<Shaft>,
    /// The slow track; those that are missing are left out.
    pub track: Vec<Stretch>,
    /// What the core remembered before the entry [`Head::state_at`].
    pub state: Option<Vec<u32>>,
    /// Entries by their number, oldest first; those that are missing are left out.
    pub entries: BTreeMap<usize, Entry>,
}

/// What is in a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordFile {
    /// Records in the order of their heads.
    pub records: Vec<PlaneRecord>,
    /// What is wrong; nothing where all is as it was written.
    pub damage: Vec<Damage>,
}

/// Words of the sections of a record, by part and number.
type Parts = BTreeMap<(u32, u32), Vec<u32>>;

/// A whole section.
struct Section {
    part: Part,
    record: u32,
    index: u32,
    words: Vec<u32>,
    bytes: usize,
}

impl PlaneRecord {
    /// A number of the core that is recorded as its bits; NaN of one that keeps none.
    pub fn number(&self, bits: u32) -> f64 {
        match self.head.number {
            n if n == Number::Single as u32 => f64::from(f32::from_bits(bits)),
            n if n == Number::Fixed as u32 => f64::from(Q::of_bits(bits).to_f32()),
            _ => f64::NAN,
        }
    }
}

impl RecordFile {
    /// What of these bytes is whole.
    pub fn of(bytes: &[u8]) -> Self {
        let (sections, mut damage) = sections(bytes);
        if sections.is_empty() {
            return Self {
                records: Vec::new(),
                damage: vec![Damage::NoSection],
            };
        }
        let mut without_head = 0;
        let mut found: Vec<(u32, Head, Parts)> = Vec::new();
        for section in sections.iter().filter(|s| s.part == Part::Head) {
            let head = Head::from_words(&section.words);
            if head.version != u32::from(RECORD_VERSION) {
                damage.push(Damage::Version(head.version));
            } else if !found.iter().any(|(record, ..)| *record == section.record) {
                found.push((section.record, head, Parts::new()));
            }
        }
        for section in sections {
            let Some((_, head, parts)) = found.iter_mut().find(|(r, ..)| *r == section.record)
            else {
                without_head += usize::from(section.part != Part::Head);
                continue;
            };
            let place = (section.part as u32, section.index);
            let before = parts.insert(place, section.words.clone());
            if before.is_some_and(|words| words != section.words) {
                let plane = head.plane;
                damage.push(Damage::Twice { plane });
            }
        }
        if without_head > 0 {
            damage.push(Damage::WithoutHead(without_head));
        }
        let records = found
            .into_iter()
            .map(|(_, head, parts)| plane_record(head, &parts, &mut damage))
            .collect();
        Self { records, damage }
    }

    /// Whether all is as it was written.
    pub fn is_intact(&self) -> bool {
        self.damage.is_empty()
    }
}

/// Whole sections, and the bytes between them.
fn sections(bytes: &[u8]) -> (Vec<Section>, Vec<Damage>) {
    let (mut sections, mut damage) = (Vec::new(), Vec::new());
    let (mut at, mut bad_from) = (0, 0);
    let mut bad = |from: usize, to: usize| {
        if from < to {
            let count = to - from;
            damage.push(Damage::Bytes { from, count });
        }
    };
    while at < bytes.len() {
        if let Some(section) = section(&bytes[at..]) {
            bad(bad_from, at);
            at += section.bytes;
            bad_from = at;
            sections.push(section);
        } else {
            at += 1;
        }
    }
    bad(bad_from, bytes.len());
    (sections, damage)
}

/// The section that begins here, if one does.
fn section(bytes: &[u8]) -> Option<Section> {
    let (words, _) = bytes.as_chunks::<4>();
    let word = |i: usize| words.get(i).map(|word| u32::from_le_bytes(*word));
    let tag = word(0)?;
    let part = Part::ALL.into_iter().find(|part| *part as u32 == tag)?;
    let (record, numbers) = (word(1)?, word(2)?);
    let count = (numbers >> 16) as usize;
    if count > MOST_WORDS {
        return None;
    }
    let checked = bytes.get(..4 * (HEAD_WORDS + count))?;
    if word(HEAD_WORDS + count)? != crc_of(checked) {
        return None;
    }
    Some(Section {
        part,
        record,
        index: numbers & 0xFFFF,
        words: (0..count).map_while(|i| word(HEAD_WORDS + i)).collect(),
        bytes: 4 * (FRAME_WORDS + count),
    })
}

fn plane_record(head: Head, parts: &Parts, damage: &mut Vec<Damage>) -> PlaneRecord {
    let plane = head.plane;
    let mut miss = |what: &'static str, found: usize, of: usize| {
        if found < of {
            damage.push(Damage::Missing {
                plane,
                what,
                missing: of - found,
                of,
            });
        }
    };
    let one = |part: Part| parts.get(&(part as u32, 0));
    let floats = |words: &Vec<u32>| words.iter().map(|w| f32::from_bits(*w)).collect::<Vec<_>>();
    // All words of a part with the number of the first of each section.
    let many = |part: Part, per_section: usize| {
        let range = (part as u32, 0)..=(part as u32, u32::MAX);
        parts.range(range).flat_map(move |((_, index), words)| {
            let first = *index as usize * per_section;
            words
                .iter()
                .enumerate()
                .map(move |(i, word)| (first + i, *word))
        })
    };
    let summary = one(Part::Summary).map(|words| Summary::from_words(words));
    let config = one(Part::Config)
        .and_then(|words| floats(words).try_into().ok())
        .map(Config::from_values);
    let shaft = one(Part::Shaft)
        .and_then(|words| <[f32; 9]>::try_from(floats(words)).ok())
        .map(Shaft::from_values);
    let per_section = |words: usize| MOST_WORDS / words * words;
    let entries: BTreeMap<usize, Entry> =
        chunks(many(Part::Ticks, per_section(ENTRY_WORDS)), ENTRY_WORDS)
            .filter_map(|(i, words)| Some((i, Entry::from_words(words.try_into().ok()?))))
            .collect();
    let track: Vec<Stretch> = chunks(many(Part::Track, per_section(STRETCH_WORDS)), STRETCH_WORDS)
        .filter_map(|(_, words)| Some(Stretch::from_words(words.try_into().ok()?)))
        .collect();
    let state: Vec<u32> = many(Part::State, MOST_WORDS)
        .map(|(_, word)| word)
        .collect();
    miss("summaries", usize::from(summary.is_some()), 1);
    miss("configurations", usize::from(config.is_some()), 1);
    if head.planes > 1 {
        miss("shafts", usize::from(shaft.is_some()), 1);
    }
    miss("stretches", track.len(), head.stretches as usize);
    let state_words = if head.state_at == NO_STATE {
        0
    } else {
        head.state_words as usize
    };
    miss("words of the state", state.len(), state_words);
    miss("ticks", entries.len(), head.ticks as usize);
    miss("ends", usize::from(one(Part::End).is_some()), 1);
    let whole = state_words > 0 && state.len() == state_words;
    PlaneRecord {
        head,
        summary,
        config,
        shaft,
        track,
        state: whole.then_some(state),
        entries,
    }
}

/// Words by so many, each with its number.
fn chunks(
    words: impl Iterator<Item = (usize, u32)>,
    per_chunk: usize,
) -> impl Iterator<Item = (usize, Vec<u32>)> {
    let mut of: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (at, word) in words {
        of.entry(at / per_chunk).or_default().push(word);
    }
    of.into_iter()
}
