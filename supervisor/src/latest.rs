//! What the last tick left to be seen by everybody, whatever their priority: a sequence lock of plain loads and stores.

use crate::cells::Cells;
use crate::scalar::Scalar;
use crate::signal::{Mode, Report};
use crate::tally::{Tally, Units};
use crate::words::Words as _;
use core::sync::atomic::{AtomicU32, Ordering, fence};

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
    pub(crate) fn put<S: Scalar>(&self, tally: &Tally<S>, units: Option<&Units<S>>) {
        let version = self.version.load(Ordering::Relaxed);
        self.version.store(version | 1, Ordering::Relaxed);
        // Who sees a word of what follows sees that it is being written.
        fence(Ordering::Release);
        tally.lay(self.tally.all(), 0);
        if let Some(units) = units {
            units.lay(self.units.all(), 0);
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

    pub(crate) fn report<S: Scalar>(&self) -> Option<Report> {
        let (tally, units) = self.get(|this| {
            let tally = Tally::<S>::take(&mut this.tally.words());
            (tally, Units::<S>::take(&mut this.units.words()))
        })?;
        Some(tally.report(&units))
    }

    /// Is one word: whole at any time.
    pub(crate) fn mode(&self) -> Mode {
        Mode::take(&mut self.tally.words())
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
