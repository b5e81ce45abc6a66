//! A supervisor that writes down what passes through it.

use firmware_bench::run::controller::Supervise;
use std::cell::RefCell;
use std::rc::Rc;
use supervisor::{Command, Config, ConfigError, Sample, Supervisor};

/// Inputs of a supervisor, and what it commanded.
pub type SampleLog = Rc<RefCell<Vec<(Sample, Command)>>>;

#[derive(Debug)]
struct Recording {
    supervisor: Supervisor<64>,
    log: SampleLog,
}

impl Supervise for Recording {
    fn tick(&mut self, sample: &Sample) -> Command {
        let command = self.supervisor.tick(sample);
        self.log.borrow_mut().push((*sample, command));
        command
    }
}

/// A supervisor for a closed loop, and its log.
///
/// # Errors
/// As [`Supervisor::new`].
pub fn recording(config: &Config) -> Result<(Box<dyn Supervise>, SampleLog), ConfigError> {
    let log = SampleLog::default();
    let recording = Recording {
        supervisor: Supervisor::new(config)?,
        log: Rc::clone(&log),
    };
    Ok((Box::new(recording), log))
}
