//! Events on their way to the background: a ring that the tick writes and the background reads, neither waiting for the other.

use crate::cells::Cells;
use crate::signal::{Events, Mode};
use crate::words::Words as _;
use core::sync::atomic::{AtomicU32, Ordering};

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
        words.lay(place.all(), 0);
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
            sequence: u32::take(&mut words),
            mode: Mode::take(&mut words),
            events: Events::from_bits_retain(u32::take(&mut words)),
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
