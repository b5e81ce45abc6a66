//! An entry of the flight record: one tick, by what it was told and what came of it.

use crate::cells::Cells;
use crate::scalar::Scalar;
use crate::signal::{CoreCommand, CoreSample, Status};
use crate::words::Words as _;

/// One tick, 48 bytes: all that it depends on but for what was before, and what came of it. Numbers are those of the core, per
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
        self.force == command.own.map(S::bits) && self.said() == said(command)
    }

    fn said(&self) -> u32 {
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
            self.said(),
            self.status,
        ]
    }

    /// From words as a record has them.
    pub fn from_words(words: [u32; ENTRY_WORDS]) -> Self {
        let [sequence, x, y, spin, lx, ly, ax, ay, fx, fy, said, status] = words;
        Self {
            sequence,
            position: [x, y],
            spin,
            levitation: [lx, ly],
            applied: [ax, ay],
            force: [fx, fy],
            mode: said as u8,
            limits: (said >> 8) as u8,
            events: (said >> 16) as u16,
            status,
        }
    }
}

/// Mode, limits and events in one word.
#[inline]
fn said<S: Scalar>(command: &CoreCommand<S>) -> u32 {
    let limits = command.limits.bits() as u8;
    command.mode as u32 | u32::from(limits) << 8 | command.events.bits() << 16
}

/// Lays what a tick is told into the words of its entry …
#[inline]
pub(crate) fn lay_told<S: Scalar>(sample: &CoreSample<S>, entry: &Cells<ENTRY_WORDS>) {
    let cells = entry.all();
    let at = sample.sequence.lay(cells, 0);
    let at = sample.position.map(S::bits).lay(cells, at);
    let at = sample.spin.bits().lay(cells, at);
    let at = sample.levitation.map(S::bits).lay(cells, at);
    sample.applied.map(S::bits).lay(cells, at);
    sample.status.bits().lay(cells, ENTRY_WORDS - 1);
}

/// … and what it answers.
#[inline]
pub(crate) fn lay_answer<S: Scalar>(command: &CoreCommand<S>, entry: &Cells<ENTRY_WORDS>) {
    let cells = entry.all();
    let at = command.own.map(S::bits).lay(cells, ENTRY_WORDS - 4);
    said(command).lay(cells, at);
}
