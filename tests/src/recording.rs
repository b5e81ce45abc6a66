//! A supervisor that writes down what passes through it.

use firmware_bench::run::controller::Supervise;
use std::cell::RefCell;
use std::rc::Rc;
use supervisor::{Command, Config, ConfigError, Sample, Supervisor};

/// What a supervisor was told, and what it commanded.
pub type Tape = Rc<RefCell<Vec<(Sample, Command)>>>;

#[derive(Debug)]
struct Recording {
    supervisor: Supervisor<64>,
    tape: Tape,
}

impl Supervise for Recording {
    fn tick(&mut self, sample: &Sample) -> Command {
        let command = self.supervisor.tick(sample);
        self.tape.borrow_mut().push((*sample, command));
        command
    }
}

/// A supervisor for a closed loop, and its tape.
///
/// # Errors
/// As [`Supervisor::new`].
pub fn recording(config: &Config) -> Result<(Box<dyn Supervise>, Tape), ConfigError> {
    let tape = Tape::default();
    let recording = Recording {
        supervisor: Supervisor::new(config)?,
        tape: Rc::clone(&tape),
    };
    Ok((Box::new(recording), tape))
}
