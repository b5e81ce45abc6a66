//! What passes the border of a supervisor, tick by tick.

use super::coverage::Coverage;
use firmware_bench::run::controller::Supervise;
use firmware_image::wire::{
    COMMAND_BYTES, CommandBits, SAMPLE_BYTES, SampleBits, command_bits, encode_command,
    encode_sample, sample_bits,
};
use std::cell::RefCell;
use std::rc::Rc;
use supervisor::{Command, Config, Mode, Sample};

/// Inputs of a supervisor and what it commanded, as bytes: equal only with every bit of every number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tick {
    pub(super) sample: [u8; SAMPLE_BYTES],
    pub(super) command: [u8; COMMAND_BYTES],
    /// Mode after it.
    mode: Mode,
}

impl Tick {
    /// From the bits of both.
    pub fn new(sample: &SampleBits, command: &CommandBits) -> Self {
        let mut tick = Self {
            sample: [0; SAMPLE_BYTES],
            command: [0; COMMAND_BYTES],
            mode: command.mode,
        };
        encode_sample(sample, &mut tick.sample);
        encode_command(command, &mut tick.command);
        tick
    }
}

/// A new supervisor and its ticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Its configuration.
    pub config: Config,
    /// Its inputs and what it commanded.
    pub ticks: Vec<Tick>,
}

impl Piece {
    pub(super) fn coverage(&self) -> Coverage {
        let mut coverage = Coverage::default();
        let mut before = Mode::Levitated;
        for tick in &self.ticks {
            coverage.add(before, tick.mode);
            before = tick.mode;
        }
        coverage
    }
}

/// What passes the border of a supervisor, written down.
pub type TickLog = Rc<RefCell<Vec<Tick>>>;

/// A supervisor of floats with its log.
#[derive(Debug)]
pub struct Recording {
    /// Whoever supervises.
    pub supervisor: Box<dyn Supervise>,
    /// Its inputs and what it commanded.
    pub log: TickLog,
}

impl Supervise for Recording {
    fn tick(&mut self, sample: &Sample) -> Command {
        let command = self.supervisor.tick(sample);
        let tick = Tick::new(&sample_bits(sample), &command_bits(&command));
        self.log.borrow_mut().push(tick);
        command
    }
}
