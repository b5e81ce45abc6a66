//! Events on their way to the background: a ring that the tick writes and the background reads, neither waiting for the other.
//!
//! What the last tick left to be seen by everybody, whatever their priority: a sequence lock of plain loads and stores.

use crate::account::tally::{Tally, Units};
use crate::border::finding::Checked;
use crate::border::signal::{Events, Mode, Report};
use crate::number::scalar::Scalar;
use crate::number::words::{Cells, Words as _, set};
use core::sync::atomic::{AtomicU32, Ordering, fence};

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

/// Events that wait at most, a power of two.
const MOST: usize = 16;

/// The ring. Each count is written by one side alone, and goes on for ever, modulo 2³².
#[derive(Debug)]
#[repr(C)]
pub(crate) struct EventQueue {
    put: AtomicU32,
    taken: AtomicU32,
    events: [Cells<3>; MOST],
}

impl EventQueue {
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self {
            put: AtomicU32::new(1),
            taken: AtomicU32::new(1),
            events: [const { Cells::new() }; MOST],
        }
    }

    fn place(&self, count: u32) -> Option<&Cells<3>> {
        self.events.get(count as usize % MOST)
    }

    /// By the tick. False where there is no room.
    pub(crate) fn push(&self, event: QueuedEvent) -> bool {
        let put = self.put.load(Ordering::Relaxed);
        // Acquired: who has taken an event out has read all of it.
        let waiting = put.wrapping_sub(self.taken.load(Ordering::Acquire));
        let Some(place) = self.place(put).filter(|_| waiting < MOST as u32) else {
            return false;
        };
        let words = [event.sequence, event.mode as u32, event.events.bits()];
        words.write_cells(place.all(), 0);
        self.put.store(put.wrapping_add(1), Ordering::Release);
        true
    }

    /// By the background.
    pub(crate) fn pop(&self) -> Option<QueuedEvent> {
        let taken = self.taken.load(Ordering::Relaxed);
        if self.put.load(Ordering::Acquire) == taken {
            return None;
        }
        let mut words = self.place(taken)?.words();
        let event = QueuedEvent {
            sequence: u32::decode(&mut words),
            mode: Mode::decode(&mut words),
            events: Events::from_bits_retain(u32::decode(&mut words)),
        };
        self.taken.store(taken.wrapping_add(1), Ordering::Release);
        Some(event)
    }
}

impl Clone for EventQueue {
    fn clone(&self) -> Self {
        let count = |of: &AtomicU32| AtomicU32::new(of.load(Ordering::Relaxed));
        Self {
            put: count(&self.put),
            taken: count(&self.taken),
            events: self.events.clone(),
        }
    }
}

/// Words of a tally and of its units, where numbers have 64 bits; of others fewer.
const MOST_WORDS: [usize; 2] = [20, 9];
/// A reader that a tick keeps interrupting gives up after so many.
const TRIES: u32 = 8;

/// Tally and units of the last tick.
#[derive(Debug)]
pub(crate) struct Latest {
    /// Odd while they are being written.
    version: AtomicU32,
    tally: Cells<{ MOST_WORDS[0] }>,
    units: Cells<{ MOST_WORDS[1] }>,
}

impl Latest {
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self {
            version: AtomicU32::new(0),
            tally: Cells::new(),
            units: Cells::new(),
        }
    }

    /// By the tick's side alone; with units where they may have changed.
    #[inline]
    pub(crate) fn publish<S: Scalar>(&self, tally: &Tally<S>, units: Option<&Units<S>>) {
        let version = self.version.load(Ordering::Relaxed);
        self.version.store(version | 1, Ordering::Relaxed);
        // Who sees a word of what follows sees that it is being written.
        fence(Ordering::Release);
        tally.write_cells(self.tally.all(), 0);
        if let Some(units) = units {
            units.write_cells(self.units.all(), 0);
        }
        self.version
            .store((version | 1).wrapping_add(1), Ordering::Release);
    }

    /// By anybody. `None` where ticks came in between each time.
    fn get<T>(&self, read: impl Fn(&Self) -> T) -> Option<T> {
        for _ in 0..TRIES {
            let before = self.version.load(Ordering::Acquire);
            let made = read(self);
            // All of it was read before the version is looked at again.
            fence(Ordering::Acquire);
            if before & 1 == 0 && self.version.load(Ordering::Relaxed) == before {
                return Some(made);
            }
        }
        None
    }

    pub(crate) fn report<S: Scalar>(&self, checked: Checked) -> Option<Report> {
        let (tally, units) = self.get(|this| {
            let tally = Tally::<S>::decode(&mut this.tally.words());
            (tally, Units::<S>::decode(&mut this.units.words()))
        })?;
        Some(tally.report(&units, checked))
    }

    /// The mode alone, of a tick that publishes nothing else.
    #[inline]
    pub(crate) fn publish_mode(&self, mode: Mode) {
        set(self.tally.all(), 0, mode as u32);
    }

    /// Is one word: whole at any time.
    pub(crate) fn mode(&self) -> Mode {
        Mode::decode(&mut self.tally.words())
    }
}

impl Clone for Latest {
    fn clone(&self) -> Self {
        Self {
            version: AtomicU32::new(self.version.load(Ordering::Relaxed)),
            tally: self.tally.clone(),
            units: self.units.clone(),
        }
    }
}
