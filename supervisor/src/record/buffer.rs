//! What a frozen record is read from. The tick writes it while it records; from the tick that freezes the record until the
//! background gives it back nobody does.

use crate::border::modes::MODES;
use crate::border::signal::Mode;
use crate::number::words::{Cells, Words as _};
use crate::record::entry::{ENTRY_WORDS, Track};
use core::sync::atomic::{AtomicU32, Ordering};

/// Words of what a core of 32-bit numbers remembers. One of `f64` keeps no samples, and of its state what there is room for.
pub(crate) const STATE_WORDS: usize = 124 + 4 * MODES;
/// Values of a configuration.
pub(crate) const CONFIG_WORDS: usize = crate::border::config::PARAMETERS.len();
/// Words of [`FrozenHeader`].
const HEADER_WORDS: usize = 7;
/// Words of a [`crate::account::severity::Severity`] and of [`crate::account::tally::Units`] of numbers of 64 bits; fewer of others.
const SEVERITY_WORDS: usize = 21;
const UNITS_WORDS: usize = 9;

/// Who has the buffer: the tick …
const RECORDS: u32 = 3;
/// … the background, to read what has frozen …
const FROZEN: u32 = 1;
/// … and again the tick, which does not know yet.
const READ: u32 = 2;

/// What is known of a record when it freezes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FrozenHeader {
    /// Which plane this is, of how many.
    pub(crate) plane: [u8; 2],
    /// Entries ever written, those of the record, and those of them since the state, if that is of use.
    pub(crate) written: u32,
    pub(crate) ticks: u32,
    pub(crate) since: u32,
    pub(crate) keeps: bool,
    /// It is that of a new core.
    pub(crate) is_new: bool,
    /// Complete stretches of the slow track.
    pub(crate) stretches: u32,
    /// Of the last tick.
    pub(crate) sequence: u32,
    pub(crate) mode: Mode,
    /// The bearing was on.
    pub(crate) on: bool,
    /// Coasting down was asked for in the event, or before it and still.
    pub(crate) coast_down: bool,
    /// Events before this one that found a record frozen.
    pub(crate) dropped: u32,
}

impl FrozenHeader {
    /// In as few words as it goes: a tick that freezes has little stack for more.
    #[inline]
    pub(crate) fn words(&self) -> [u32; HEADER_WORDS] {
        let [plane, planes] = self.plane;
        let flags = [self.keeps, self.is_new, self.on, self.coast_down];
        let flags = (flags.into_iter().rev()).fold(0, |sum, flag| sum << 1 | u8::from(flag));
        [
            u32::from_le_bytes([plane, planes, self.mode as u8, flags]),
            self.written,
            self.ticks,
            self.since,
            self.stretches,
            self.sequence,
            self.dropped,
        ]
    }

    pub(crate) fn from_words(words: [u32; HEADER_WORDS]) -> Self {
        let [packed, written, ticks, since, stretches, sequence, dropped] = words;
        let [plane, planes, mode, flags] = packed.to_le_bytes();
        Self {
            plane: [plane, planes],
            written,
            ticks,
            since,
            keeps: flags & 1 != 0,
            is_new: flags & 2 != 0,
            stretches,
            sequence,
            mode: Mode::decode(&mut core::iter::once(u32::from(mode))),
            on: flags & 4 != 0,
            coast_down: flags & 8 != 0,
            dropped,
        }
    }
}

/// Room for a record of `N` entries (a power of two).
///
/// The order of the fields is kept, with written numbers on both sides of the entries: then the compiler clears these where the
/// buffer will stay, and has no copy of them on the stack on the way there.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct RecordBuffer<const N: usize> {
    owner: AtomicU32,
    /// Before some tick: what was remembered, with which configuration.
    pub(crate) state: Cells<STATE_WORDS>,
    pub(crate) config: Cells<CONFIG_WORDS>,
    /// What had come to the bearing when the event began, where the state does not say that; and in which units it or the state
    /// does.
    pub(crate) opening: Cells<SEVERITY_WORDS>,
    pub(crate) opening_units: Cells<UNITS_WORDS>,
    /// The same at its end.
    pub(crate) closing: Cells<SEVERITY_WORDS>,
    pub(crate) closing_units: Cells<UNITS_WORDS>,
    pub(crate) closed: Cells<HEADER_WORDS>,
    pub(crate) entries: [Cells<ENTRY_WORDS>; N],
    pub(crate) track: Track,
}

impl<const N: usize> RecordBuffer<N> {
    const MASK: usize = {
        assert!(
            N.is_power_of_two() && N >= 4,
            "record length must be a power of two, at least 4"
        );
        N - 1
    };

    /// That of a recorder.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self::of(RECORDS)
    }

    /// For a copy: all zero, so that a `static` needs no flash.
    #[inline(always)]
    pub(crate) const fn blank() -> Self {
        Self::of(0)
    }

    #[inline(always)]
    const fn of(owner: u32) -> Self {
        Self {
            owner: AtomicU32::new(owner),
            state: Cells::new(),
            config: Cells::new(),
            opening: Cells::new(),
            opening_units: Cells::new(),
            closing: Cells::new(),
            closing_units: Cells::new(),
            closed: Cells::new(),
            entries: [const { Cells::new() }; N],
            track: [const { Cells::new() }; _],
        }
    }

    /// The place of an entry, by how many were written before it.
    #[inline]
    pub(crate) fn entry(&self, count: u32) -> Option<&Cells<ENTRY_WORDS>> {
        self.entries.get(count as usize & Self::MASK)
    }

    /// By the tick: all is written.
    pub(crate) fn freeze(&self) {
        self.owner.store(FROZEN, Ordering::Release);
    }

    /// By the background: whether there is a record to be read.
    pub(crate) fn is_frozen(&self) -> bool {
        self.owner.load(Ordering::Acquire) == FROZEN
    }

    /// By the background: what is written in another one, which has frozen.
    pub(crate) fn become_copy_of(&self, other: &Self) {
        let Self {
            owner,
            state,
            config,
            opening,
            opening_units,
            closing,
            closing_units,
            closed,
            entries,
            track,
        } = self;
        state.become_copy_of(&other.state);
        config.become_copy_of(&other.config);
        opening.become_copy_of(&other.opening);
        opening_units.become_copy_of(&other.opening_units);
        closing.become_copy_of(&other.closing);
        closing_units.become_copy_of(&other.closing_units);
        closed.become_copy_of(&other.closed);
        (entries.iter().zip(&other.entries)).for_each(|(to, from)| to.become_copy_of(from));
        (track.iter().zip(&other.track)).for_each(|(to, from)| to.become_copy_of(from));
        owner.store(FROZEN, Ordering::Release);
    }

    /// By the background: it has read what it wanted of a frozen record.
    pub(crate) fn give_back(&self) {
        if self.is_frozen() {
            self.owner.store(READ, Ordering::Release);
        }
    }

    /// By the tick: whether the background has given back what had frozen.
    pub(crate) fn is_back(&self) -> bool {
        self.owner.load(Ordering::Acquire) == READ
    }

    /// By the tick: goes on recording.
    pub(crate) fn resume(&self) {
        self.owner.store(RECORDS, Ordering::Relaxed);
    }
}

impl<const N: usize> Clone for RecordBuffer<N> {
    fn clone(&self) -> Self {
        Self {
            owner: AtomicU32::new(self.owner.load(Ordering::Acquire)),
            state: self.state.clone(),
            config: self.config.clone(),
            opening: self.opening.clone(),
            opening_units: self.opening_units.clone(),
            closing: self.closing.clone(),
            closing_units: self.closing_units.clone(),
            closed: self.closed.clone(),
            entries: self.entries.clone(),
            track: self.track.clone(),
        }
    }
}
