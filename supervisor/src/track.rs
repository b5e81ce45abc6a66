//! The slow track of a record: extremes over stretches of ticks that grow with the time since the event began, so that few
//! words reach from its first milliseconds to seconds.

use crate::cells::Cells;
use crate::scalar::Scalar;
use crate::signal::{Events, Mode};
use crate::words::Words as _;

/// Stretches of a track …
pub const STRETCHES: usize = 64;
/// … of so many ticks at first …
const FIRST_TICKS: u16 = 32;
/// … which double each time that so many have passed: 65 280 ticks in all.
const DOUBLES_AFTER: usize = 8;

/// Words of a stretch.
pub const STRETCH_WORDS: usize = 6;

/// Some ticks of an event, 24 bytes. Extremes are numbers of the core, per unit, as their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Stretch {
    /// Sequence number of its last sample.
    pub sequence: u32,
    /// Ticks in it, and those of them in contact.
    pub ticks: u16,
    /// See `ticks`.
    pub contact_ticks: u16,
    /// Touches.
    pub touches: u16,
    /// Modes in it, a bit each.
    pub modes: u16,
    /// Square of the largest distance from the centre, by the estimate \[clearances²\].
    pub radius_square: u32,
    /// Square of the largest force that the supervisor commanded \[caps²\].
    pub force_square: u32,
    /// Largest severity, see [`crate::Command::severity`].
    pub severity: u32,
}

impl Stretch {
    /// As words, each to be written down little-endian.
    pub(crate) fn words(&self) -> [u32; STRETCH_WORDS] {
        let pair = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
        [
            self.sequence,
            pair(self.ticks, self.contact_ticks),
            pair(self.touches, self.modes),
            self.radius_square,
            self.force_square,
            self.severity,
        ]
    }

    /// From words as a record has them.
    pub fn from_words(words: [u32; STRETCH_WORDS]) -> Self {
        let [
            sequence,
            ticks,
            touches,
            radius_square,
            force_square,
            severity,
        ] = words;
        Self {
            sequence,
            ticks: ticks as u16,
            contact_ticks: (ticks >> 16) as u16,
            touches: touches as u16,
            modes: (touches >> 16) as u16,
            radius_square,
            force_square,
            severity,
        }
    }
}

/// The stretches that are complete.
pub(crate) type Track = [Cells<STRETCH_WORDS>; STRETCHES];

/// How many of them there are, and the one that is under way.
#[derive(Debug, Clone)]
pub(crate) struct Progress<S> {
    done: usize,
    now: Stretch,
    /// Squares of radius and force; severity.
    radius: S,
    force: S,
    severity: S,
}

impl<S: Scalar> Progress<S> {
    pub(crate) fn new() -> Self {
        Self {
            done: 0,
            now: Stretch::default(),
            radius: S::ZERO,
            force: S::ZERO,
            severity: S::ZERO,
        }
    }

    /// An event begins.
    pub(crate) fn clear(&mut self) {
        self.done = 0;
        self.begin();
    }

    fn begin(&mut self) {
        self.now = Stretch::default();
        (self.radius, self.force, self.severity) = (S::ZERO, S::ZERO, S::ZERO);
    }

    /// Whether there is no more room.
    pub(crate) fn is_full(&self) -> bool {
        self.done >= STRETCHES
    }

    /// A tick, with the squares of radius and force.
    #[inline]
    pub(crate) fn push(
        &mut self,
        track: &Track,
        sequence: u32,
        [radius, force]: [S; 2],
        severity: S,
        (mode, events, touching): (Mode, Events, bool),
    ) {
        let touched = events.contains(Events::TOUCHED);
        let now = &mut self.now;
        now.ticks += 1;
        now.contact_ticks += u16::from(touching);
        now.touches = now.touches.saturating_add(u16::from(touched));
        now.modes |= 1 << (mode as u8 & 7);
        self.radius = self.radius.max(radius);
        self.force = self.force.max(force);
        self.severity = self.severity.max(severity);
        let ticks = FIRST_TICKS << (self.done / DOUBLES_AFTER).min(STRETCHES / DOUBLES_AFTER - 1);
        if now.ticks >= ticks {
            self.end(track, sequence);
        }
    }

    /// The event is over.
    pub(crate) fn finish(&mut self, track: &Track, sequence: u32) {
        if self.now.ticks > 0 {
            self.end(track, sequence);
        }
    }

    #[inline(never)]
    fn end(&mut self, track: &Track, sequence: u32) {
        let done = Stretch {
            sequence,
            radius_square: self.radius.bits(),
            force_square: self.force.bits(),
            severity: self.severity.bits(),
            ..self.now
        };
        if let Some(stretch) = track.get(self.done) {
            done.words().lay(stretch.all(), 0);
            self.done += 1;
        }
        self.begin();
    }

    /// How many are complete.
    pub(crate) fn done(&self) -> u32 {
        self.done as u32
    }
}
