//! Recorded streams: inputs of a supervisor on the host, and what it commanded.

use super::closed_loops::closed_loops;
use super::coverage::Coverage;
use super::numbers::Number;
use super::synthetic;
use super::tick_log::Piece;
use crate::overloads::plan::CatalogueError;
use firmware_image::under_test::{Fixed, Float, UnderTest};
use firmware_image::wire::{
    HEADER_BYTES, Hash, Header, SEGMENT_BYTES, Segment, encode_header, encode_segment, sample_of,
};
use std::io::{self, Write};

/// What a stream consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Length {
    /// Ticks of closed loops, at most.
    pub closed_loop: usize,
    /// Ticks in all.
    pub all: usize,
}

impl Length {
    /// The long one.
    pub(crate) const FULL: Self = Self::of(1_000_000);
    /// The short one; its instructions are counted.
    pub const QUICK: Self = Self::of(100_000);

    /// Half closed loops.
    const fn of(all: usize) -> Self {
        Self {
            closed_loop: all / 2,
            all,
        }
    }
}

/// A recorded stream.
#[derive(Debug, Clone, PartialEq)]
pub struct Stream {
    /// What its numbers are.
    pub number: Number,
    /// One supervisor after the other.
    pub pieces: Vec<Piece>,
    /// Configurations that do not fit these numbers and were passed over.
    pub left_out: usize,
}

impl Stream {
    /// Records closed loops of the catalogue, and then synthetic samples. The same for the same
    /// length.
    ///
    /// # Errors
    /// [`CatalogueError`] if the catalogue is not valid.
    pub fn record(number: Number, length: Length) -> Result<Self, CatalogueError> {
        let (mut pieces, loops_left_out) = closed_loops(number, length.closed_loop)?;
        let so_far: usize = pieces.iter().map(|p| p.ticks.len()).sum();
        let (more, synthetic_left_out) =
            synthetic::pieces(number, length.all.saturating_sub(so_far))?;
        pieces.extend(more);
        Ok(Self {
            number,
            pieces,
            left_out: loops_left_out + synthetic_left_out,
        })
    }

    pub fn ticks(&self) -> usize {
        self.pieces.iter().map(|p| p.ticks.len()).sum()
    }

    /// Modes and ways in it.
    pub fn coverage(&self) -> Coverage {
        let mut coverage = Coverage::default();
        for piece in &self.pieces {
            coverage.merge(&piece.coverage());
        }
        coverage
    }

    /// Hash over its commands.
    pub fn hash(&self) -> Hash {
        let mut hash = Hash::default();
        for tick in self.pieces.iter().flat_map(|p| &p.ticks) {
            hash.add(&tick.command);
        }
        hash
    }

    /// Hash over what each supervisor leaves behind: report, events, frozen record.
    pub fn read_outs(&self) -> Hash {
        match self.number {
            Number::Float => read_outs_of::<Float>(&self.pieces),
            Number::Fixed => read_outs_of::<Fixed>(&self.pieces),
        }
    }

    /// Writes it as the images read it.
    ///
    /// # Errors
    /// Of writing.
    pub fn write(&self, to: impl Write) -> io::Result<()> {
        let mut to = io::BufWriter::new(to);
        let mut header = [0; HEADER_BYTES];
        let segments = self.pieces.len() as u32;
        encode_header(Header { segments }, &mut header);
        to.write_all(&header)?;
        let mut segment = [0; SEGMENT_BYTES];
        for piece in &self.pieces {
            let begin = Segment {
                config: piece.config,
                ticks: piece.ticks.len() as u32,
            };
            encode_segment(&begin, &mut segment);
            to.write_all(&segment)?;
            for tick in &piece.ticks {
                to.write_all(&tick.sample)?;
                to.write_all(&tick.command)?;
            }
        }
        to.flush()
    }
}

/// The pieces once more, each by a supervisor that is asked afterwards.
fn read_outs_of<U: UnderTest>(pieces: &[Piece]) -> Hash {
    let mut hash = Hash::default();
    for piece in pieces {
        // All that were recorded fit.
        let Some(mut supervisor) = U::new(&piece.config) else {
            continue;
        };
        for tick in &piece.ticks {
            let _command = U::TICK(&mut supervisor, &U::sample(&sample_of(&tick.sample)));
        }
        supervisor.read_out(&mut hash);
    }
    hash
}
