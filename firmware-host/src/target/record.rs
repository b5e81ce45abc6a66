//! Recorded streams: what a supervisor was told on the host, and what it commanded.

use super::closed_loops::closed_loops;
use super::coverage::Coverage;
use super::made_up::made_up;
use crate::overloads::plan::CatalogueError;
use crate::policies::Supervise;
use firmware_image::RECORD;
use firmware_image::wire::{
    COMMAND_BYTES, HEADER_BYTES, Hash, Header, SAMPLE_BYTES, SEGMENT_BYTES, Segment, put_command,
    put_header, put_sample, put_segment,
};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;
use supervisor::{Command, Config, Mode, Sample, Supervisor};

/// The supervisor as the images have it.
pub type Recorded = Supervisor<RECORD>;

/// A new supervisor and its ticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Its configuration.
    pub config: Config,
    /// What it was told and what it commanded.
    pub ticks: Vec<(Sample, Command)>,
}

impl Piece {
    /// No tick yet.
    pub fn new(config: Config) -> Self {
        Self {
            config,
            ticks: Vec::new(),
        }
    }

    fn coverage(&self) -> Coverage {
        let mut coverage = Coverage::default();
        let mut before = Mode::Levitated;
        for (_, command) in &self.ticks {
            coverage.add(before, command.mode);
            before = command.mode;
        }
        coverage
    }
}

/// What passes the border of a supervisor, written down.
pub type Tape = Rc<RefCell<Vec<(Sample, Command)>>>;

/// A supervisor with its tape.
#[derive(Debug)]
pub struct Recording {
    /// Whoever supervises.
    pub supervisor: Box<dyn Supervise>,
    /// What it was told and what it commanded.
    pub tape: Tape,
}

impl Supervise for Recording {
    fn tick(&mut self, sample: &Sample) -> Command {
        let command = self.supervisor.tick(sample);
        self.tape.borrow_mut().push((*sample, command));
        command
    }

    fn mode(&self) -> Mode {
        self.supervisor.mode()
    }
}

/// How a stream is made up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Length {
    /// Ticks of closed loops, at most.
    pub closed_loop: usize,
    /// Ticks in all.
    pub all: usize,
}

impl Length {
    /// The long one.
    pub const FULL: Self = Self::of(1_000_000);
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
    /// One supervisor after the other.
    pub pieces: Vec<Piece>,
}

impl Stream {
    /// Records closed loops of the catalogue, and then samples that are made up. The same for the same
    /// length.
    ///
    /// # Errors
    /// [`CatalogueError`] if the catalogue is not valid.
    pub fn record(length: Length) -> Result<Self, CatalogueError> {
        let mut pieces = closed_loops(length.closed_loop)?;
        let so_far: usize = pieces.iter().map(|p| p.ticks.len()).sum();
        pieces.extend(made_up(length.all.saturating_sub(so_far))?);
        Ok(Self { pieces })
    }

    /// Ticks in all.
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
        let mut bytes = [0; COMMAND_BYTES];
        for (_, command) in self.pieces.iter().flat_map(|p| &p.ticks) {
            put_command(command, &mut bytes);
            hash.add(&bytes);
        }
        hash
    }

    /// Writes it as the images read it.
    ///
    /// # Errors
    /// Of writing.
    pub fn write(&self, to: impl Write) -> io::Result<()> {
        let mut to = io::BufWriter::new(to);
        let mut header = [0; HEADER_BYTES];
        let segments = self.pieces.len() as u32;
        put_header(Header { segments }, &mut header);
        to.write_all(&header)?;
        let (mut segment, mut sample, mut command) =
            ([0; SEGMENT_BYTES], [0; SAMPLE_BYTES], [0; COMMAND_BYTES]);
        for piece in &self.pieces {
            let begin = Segment {
                config: piece.config,
                ticks: piece.ticks.len() as u32,
            };
            put_segment(&begin, &mut segment);
            to.write_all(&segment)?;
            for (told, commanded) in &piece.ticks {
                put_sample(told, &mut sample);
                put_command(commanded, &mut command);
                to.write_all(&sample)?;
                to.write_all(&command)?;
            }
        }
        to.flush()
    }
}
