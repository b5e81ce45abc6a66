//! A supervisor in the emulator, in a closed loop with the plant here: samples go out and commands come back
//! over a serial port of the board, in lock step.

use super::emulator::{EmulatorError, Running, Time};
use super::machines::Machine;
use crate::policies::Supervise;
use firmware_image::line::{
    CONFIGURE, CONFIGURE_BYTES, LONGEST, Line, MAP_BYTES, QUIT, READY, TICK, rest_of,
};
use firmware_image::wire::{command_of_bits, put_config, sample_bits};
use std::cell::RefCell;
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::rc::Rc;
use std::time::{Duration, Instant};
use supervisor::{Command, Config, Mode, Sample};

/// Longest wait for the emulator, at its start and for each answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// Why the loop broke.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum LinkError {
    /// The emulator.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Emulator(#[from] EmulatorError),
    /// The emulator did not connect its port.
    #[error("the emulated board does not connect its serial port")]
    NoConnection,
    /// The line broke, or nothing came in time.
    #[error("the serial line to the emulated board: {0}")]
    Line(#[from] io::Error),
    /// What came is no answer.
    #[error("the emulated board answered {0:?}")]
    Answer(Vec<u8>),
}

/// An emulated board that supervises.
#[derive(Debug)]
pub struct Board {
    line: TcpStream,
    /// What both ends know.
    known: Line,
    /// Why the loop broke, if it did: a tick cannot fail.
    broken: Option<LinkError>,
    running: Running,
}

impl Board {
    /// Starts the image and waits for its line.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn start(machine: &Machine, image: &Path, folder: &Path) -> Result<Self, LinkError> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        listener.set_nonblocking(true)?;
        let serial = format!("tcp:{},nodelay", listener.local_addr()?);
        let mut running = Running::start(machine, image, folder, Time::Free, &serial)?;
        let until = Instant::now() + PATIENCE;
        let line = loop {
            match listener.accept() {
                Ok((line, _)) => break line,
                Err(e) if e.kind() != io::ErrorKind::WouldBlock => return Err(e.into()),
                Err(_) if running.ended() || Instant::now() > until => {
                    return Err(LinkError::NoConnection);
                }
                Err(_) => std::thread::sleep(Duration::from_millis(2)),
            }
        };
        line.set_nonblocking(false)?;
        line.set_nodelay(true)?;
        line.set_read_timeout(Some(PATIENCE))?;
        Ok(Self {
            line,
            known: Line::default(),
            broken: None,
            running,
        })
    }

    /// Makes a new supervisor on the board.
    ///
    /// # Errors
    /// [`LinkError`]; of a configuration that is refused too.
    pub fn configure(&mut self, config: &Config) -> Result<(), LinkError> {
        self.known = Line::default();
        let mut message = [CONFIGURE; CONFIGURE_BYTES];
        if let Some((_, bytes)) = message.split_first_chunk_mut::<1>()
            && let Some(bytes) = bytes.first_chunk_mut()
        {
            put_config(config, bytes);
        }
        self.line.write_all(&message)?;
        let mut answer = [0];
        self.line.read_exact(&mut answer)?;
        match answer {
            [READY] => Ok(()),
            other => Err(LinkError::Answer(other.to_vec())),
        }
    }

    fn tick(&mut self, sample: &Sample) -> Result<Command, LinkError> {
        let packed = self.known.pack_sample(&sample_bits(sample));
        let mut message = vec![TICK];
        message.extend(packed.bytes());
        self.line.write_all(&message)?;
        let mut answer = [0; LONGEST];
        let (map, rest) = answer.split_at_mut(MAP_BYTES);
        self.line.read_exact(map)?;
        let length = map.first_chunk().map_or(0, |map| rest_of(*map));
        let no_answer = |bytes: &[u8]| LinkError::Answer(bytes.to_vec());
        let rest = rest.get_mut(..length).ok_or_else(|| no_answer(map))?;
        self.line.read_exact(rest)?;
        let command = self.known.command(&answer);
        let command = command.ok_or_else(|| no_answer(&answer))?;
        Ok(command_of_bits(&command))
    }

    /// Why the loop broke, if it did.
    pub fn take_broken(&mut self) -> Option<LinkError> {
        self.broken.take()
    }

    /// Ends the image.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn quit(mut self) -> Result<(), LinkError> {
        self.line.write_all(&[QUIT])?;
        match self.running.wait(PATIENCE) {
            Some((true, _)) => Ok(()),
            Some((false, said)) => Err(LinkError::Answer(said.into_bytes())),
            None => Err(LinkError::NoConnection),
        }
    }
}

/// The supervisor on a board, as a policy has it.
#[derive(Debug)]
pub struct Emulated {
    board: Rc<RefCell<Board>>,
    mode: Mode,
}

impl Emulated {
    /// The new supervisor of a board that has just been configured.
    pub fn new(board: Rc<RefCell<Board>>) -> Self {
        Self {
            board,
            mode: Mode::default(),
        }
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
            Ok(command) => {
                self.mode = command.mode;
                command
            }
            Err(why) => {
                board.broken = Some(why);
                Command::default()
            }
        }
    }

    fn mode(&self) -> Mode {
        self.mode
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use firmware_image::wire::{CommandBits, SampleBits};
    use rand_chacha::ChaCha8Rng;
    use rand_core::{Rng, SeedableRng};
    use supervisor::{Limits, Status};

    /// Whatever the words are, both ends know the same after each message, and a usual tick is short.
    #[test]
    fn nothing_is_lost_on_the_line() {
        let mut chance = ChaCha8Rng::seed_from_u64(1);
        // One in four is any word, the others are as before.
        let mut next = |before: u32| match chance.next_u32() {
            any if any.is_multiple_of(4) => chance.next_u32(),
            _ => before,
        };
        let (mut host, mut board) = (Line::default(), Line::default());
        let (mut sample, mut command) = (SampleBits::default(), CommandBits::default());
        for _ in 0..10_000 {
            sample = SampleBits {
                sequence: next(sample.sequence.wrapping_add(1)),
                status: Status::from_bits_retain(next(sample.status.bits())),
                position: sample.position.map(&mut next),
                spin: next(sample.spin),
                levitation: sample.levitation.map(&mut next),
                applied: sample.applied.map(&mut next),
            };
            assert_eq!(board.sample(host.pack_sample(&sample).bytes()), sample);
            let own = sample.levitation.map(&mut next);
            command = CommandBits {
                own,
                force: own.map(&mut next),
                limits: Limits::from_bits_truncate(next(command.limits.bits())),
                severity: next(command.severity),
                ..command
            };
            let packed = board.pack_command(&command);
            assert_eq!(host.command(packed.bytes()), Some(command));
        }
        sample.sequence = sample.sequence.wrapping_add(1);
        assert_eq!(host.pack_sample(&sample).bytes().len(), MAP_BYTES);
    }
}
