//! An entry of the flight record: one tick, by its inputs and its outcome.
//!
//! The slow track of a record: extremes over stretches of ticks that grow with the time since the event began, so that few
//! words reach from its first milliseconds to seconds.

use crate::border::signal::{CoreCommand, CoreSample, Events, Status};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::{Cells, Words as _};

/// One tick, 48 bytes: all that it depends on but for what was before, and its outcome. Numbers are those of the core, per
/// unit, as their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Entry {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Position of the sample \[clearances\].
    pub position: [u32; 2],
    /// Spin \[1/t₀\].
    pub spin: u32,
    /// Force that the levitation controller wanted \[caps\].
    pub levitation: [u32; 2],
    /// What the actuator was measured to deliver \[caps\].
    pub applied: [u32; 2],
    /// Commanded force, in shadow what it would have been \[caps\].
    pub force: [u32; 2],
    /// [`crate::Mode`] as a number.
    pub mode: u8,
    /// Low byte of [`crate::Limits`].
    pub limits: u8,
    /// Low 16 bits of [`crate::Events`].
    pub events: u16,
    /// Bits of [`Status`].
    pub status: u32,
}

/// Words of an entry.
pub const ENTRY_WORDS: usize = 12;

impl Entry {
    /// The sample, as the core got it.
    pub fn sample<S: Scalar>(&self) -> CoreSample<S> {
        CoreSample {
            sequence: self.sequence,
            status: Status::from_bits_retain(self.status),
            position: self.position.map(S::of_bits),
            spin: S::of_bits(self.spin),
            levitation: self.levitation.map(S::of_bits),
            applied: self.applied.map(S::of_bits),
        }
    }

    /// Whether this is the command that the tick gave, to the last bit.
    pub fn gave<S: Scalar>(&self, command: &CoreCommand<S>) -> bool {
        self.force == command.own.map(S::bits) && self.packed_flags() == packed_flags(command)
    }

    fn packed_flags(&self) -> u32 {
        u32::from(self.mode) | u32::from(self.limits) << 8 | u32::from(self.events) << 16
    }

    /// As words, each to be written down little-endian.
    pub(crate) fn words(&self) -> [u32; ENTRY_WORDS] {
        let [x, y] = self.position;
        let [lx, ly] = self.levitation;
        let [ax, ay] = self.applied;
        let [fx, fy] = self.force;
        let (sequence, spin) = (self.sequence, self.spin);
        [
            sequence,
            x,
            y,
            spin,
            lx,
            ly,
            ax,
            ay,
            fx,
            fy,
            self.packed_flags(),
            self.status,
        ]
    }

    /// From words as a record has them.
    pub fn from_words(words: [u32; ENTRY_WORDS]) -> Self {
        let [sequence, x, y, spin, lx, ly, ax, ay, fx, fy, packed, status] = words;
        Self {
            sequence,
            position: [x, y],
            spin,
            levitation: [lx, ly],
            applied: [ax, ay],
            force: [fx, fy],
            mode: packed as u8,
            limits: (packed >> 8) as u8,
            events: (packed >> 16) as u16,
            status,
        }
    }
}

/// Mode, limits and events in one word.
#[inline]
fn packed_flags<S: Scalar>(command: &CoreCommand<S>) -> u32 {
    let limits = command.limits.bits() as u8;
    command.mode as u32 | u32::from(limits) << 8 | command.events.bits() << 16
}

/// Writes a tick's inputs into the words of its entry …
#[inline]
pub(crate) fn write_sample<S: Scalar>(sample: &CoreSample<S>, entry: &Cells<ENTRY_WORDS>) {
    let cells = entry.all();
    let at = sample.sequence.write_cells(cells, 0);
    let at = sample.position.map(S::bits).write_cells(cells, at);
    let at = sample.spin.bits().write_cells(cells, at);
    let at = sample.levitation.map(S::bits).write_cells(cells, at);
    sample.applied.map(S::bits).write_cells(cells, at);
    sample.status.bits().write_cells(cells, ENTRY_WORDS - 1);
}

/// … and what it answers.
#[inline]
pub(crate) fn write_command<S: Scalar>(command: &CoreCommand<S>, entry: &Cells<ENTRY_WORDS>) {
    let cells = entry.all();
    let at = command.own.map(S::bits).write_cells(cells, ENTRY_WORDS - 4);
    packed_flags(command).write_cells(cells, at);
}

/// Stretches of a track …
pub(crate) const STRETCHES: usize = 64;
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
pub(crate) struct TrackProgress<S> {
    done: usize,
    now: Stretch,
    /// Squares of radius and force; severity.
    radius: S,
    force: S,
    severity: S,
}

impl<S: Scalar> TrackProgress<S> {
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

    /// A tick, with where the axis is.
    #[inline]
    pub(crate) fn push(
        &mut self,
        track: &Track,
        sequence: u32,
        command: &CoreCommand<S>,
        position: Vec2<S>,
        touching: bool,
    ) {
        let own = Vec2::from_array(command.own);
        let (radius, force) = (position.length_squared(), own.length_squared());
        let (mode, events) = (command.mode, command.events);
        let touched = events.contains(Events::TOUCHED);
        let now = &mut self.now;
        now.ticks += 1;
        now.contact_ticks += u16::from(touching);
        now.touches = now.touches.saturating_add(u16::from(touched));
        now.modes |= 1 << (mode as u8 & 7);
        self.radius = self.radius.max(radius);
        self.force = self.force.max(force);
        self.severity = self.severity.max(command.severity);
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
            done.words().write_cells(stretch.all(), 0);
            self.done += 1;
        }
        self.begin();
    }

    /// How many are complete.
    pub(crate) fn done(&self) -> u32 {
        self.done as u32
    }
}
