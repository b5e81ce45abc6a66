//! A supervisor in the emulator, in a closed loop with the plant here: samples go out and commands come back
//! over the console of its debugger, in lock step.

use super::emulator::{EmulatorError, Running, Time};
use super::machines::Machine;
use firmware_bench::run::controller::Supervise;
use firmware_image::line::{CONFIGURE, QUIT, READY, TICK};
use firmware_image::wire::{
    COMMAND_BYTES, CONFIG_BYTES, SAMPLE_BYTES, command_of, command_of_bits, encode_config,
    encode_sample, sample_bits,
};
use std::cell::RefCell;
use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{ChildStdin, ChildStdout, Stdio};
use std::rc::Rc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;
use supervisor::{Command, Config, Sample};

/// Longest wait for each answer, the first with the emulator's start.
const PATIENCE: Duration = Duration::from_secs(20);

/// Why the loop broke.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum LinkError {
    /// The emulator.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Emulator(#[from] EmulatorError),
    /// The image did not end when it was told to.
    #[error("the emulated processor does not end")]
    NoEnd,
    /// The line broke, or nothing came in time.
    #[error("the line to the emulated processor: {0}")]
    Line(#[from] io::Error),
    /// What came is no answer.
    #[error("the emulated processor answered {0:?}")]
    Answer(Vec<u8>),
}

/// The host's end of a console.
#[derive(Debug)]
struct Line {
    input: ChildStdin,
    /// What a thread reads, which may wait for ever; the receiver does not.
    output: Receiver<Vec<u8>>,
    /// What has come of the next answer.
    come: Vec<u8>,
}

impl Line {
    fn new(input: ChildStdin, mut output: ChildStdout) -> Self {
        let (sender, receiver) = channel();
        // Ends with the emulator, whose output ends then.
        std::thread::spawn(move || {
            let mut bytes = [0; 256];
            while let Ok(length @ 1..) = output.read(&mut bytes) {
                let come = bytes.get(..length).unwrap_or(&[]).to_vec();
                if sender.send(come).is_err() {
                    break;
                }
            }
        });
        Self {
            input,
            output: receiver,
            come: Vec::new(),
        }
    }

    /// The answer to a message.
    fn answer<const N: usize>(&mut self, kind: u8, content: &[u8]) -> io::Result<[u8; N]> {
        // In one piece: a write may wake the emulator.
        self.input.write_all(&[&[kind], content].concat())?;
        loop {
            if let Some(answer) = self.come.first_chunk().copied() {
                self.come.drain(..N);
                return Ok(answer);
            }
            self.come.extend(match self.output.recv_timeout(PATIENCE) {
                Ok(come) => come,
                Err(RecvTimeoutError::Timeout) => return Err(io::ErrorKind::TimedOut.into()),
                Err(RecvTimeoutError::Disconnected) => return Err(io::ErrorKind::BrokenPipe.into()),
            });
        }
    }
}

/// An emulated processor that supervises.
#[derive(Debug)]
pub(crate) struct Board {
    line: Line,
    /// Why the loop broke, if it did: a tick cannot fail.
    broken: Option<LinkError>,
    running: Running,
}

impl Board {
    /// Starts the image.
    ///
    /// # Errors
    /// [`LinkError`].
    pub(crate) fn start(machine: &Machine, image: &Path, folder: &Path) -> Result<Self, LinkError> {
        let mut running = Running::start(machine, image, folder, Time::Free, Stdio::piped())?;
        let no_console = || io::Error::from(io::ErrorKind::NotConnected);
        let (input, output) = running.console().ok_or_else(no_console)?;
        Ok(Self {
            line: Line::new(input, output),
            broken: None,
            running,
        })
    }

    /// Makes a new supervisor on the processor.
    ///
    /// # Errors
    /// [`LinkError`]; of a configuration that is refused too.
    pub(crate) fn configure(&mut self, config: &Config) -> Result<(), LinkError> {
        let mut bytes = [0; CONFIG_BYTES];
        encode_config(config, &mut bytes);
        match self.line.answer(CONFIGURE, &bytes)? {
            [READY] => Ok(()),
            other => Err(LinkError::Answer(other.to_vec())),
        }
    }

    fn tick(&mut self, sample: &Sample) -> Result<Command, LinkError> {
        let mut bytes = [0; SAMPLE_BYTES];
        encode_sample(&sample_bits(sample), &mut bytes);
        let answer: [u8; COMMAND_BYTES] = self.line.answer(TICK, &bytes)?;
        let command = command_of(&answer).ok_or_else(|| LinkError::Answer(answer.to_vec()))?;
        Ok(command_of_bits(&command))
    }

    /// Why the loop broke, if it did.
    pub(crate) fn take_broken(&mut self) -> Option<LinkError> {
        self.broken.take()
    }

    /// Ends the image.
    ///
    /// # Errors
    /// [`LinkError`].
    pub(crate) fn quit(mut self) -> Result<(), LinkError> {
        self.line.input.write_all(&[QUIT])?;
        match self.running.wait(PATIENCE) {
            Some(ended) if ended.well => Ok(()),
            Some(ended) => Err(LinkError::Answer(ended.all_output().into_bytes())),
            None => Err(LinkError::NoEnd),
        }
    }
}

/// The supervisor on a board, as a policy has it.
#[derive(Debug)]
pub(crate) struct Emulated {
    board: Rc<RefCell<Board>>,
}

impl Emulated {
    /// The new supervisor of a processor that has just been configured.
    pub(crate) fn new(board: Rc<RefCell<Board>>) -> Self {
        Self { board }
    }
}

impl Supervise for Emulated {
    /// Without force once the loop is broken; [`Board::take_broken`] says why.
    fn tick(&mut self, sample: &Sample) -> Command {
        let mut board = self.board.borrow_mut();
        if board.broken.is_some() {
            return Command::default();
        }
        match board.tick(sample) {
            Ok(command) => command,
            Err(why) => {
                board.broken = Some(why);
                Command::default()
            }
        }
    }
}
