//! The supervisor that the images run: its numbers are chosen here and nowhere else.

use crate::RECORD;
use supervisor::{Command, Config, Entry, Sample};

/// The supervisor under test.
pub type Supervisor = supervisor::Supervisor<RECORD>;

/// Name of its numbers.
pub const NUMBER: &str = "f32";

/// Bytes of its state without the ring of the flight record.
pub const RAM_BYTES: usize = size_of::<Supervisor>() - RECORD * size_of::<Entry>();

/// A new one; `None` for a configuration that is not valid.
pub fn new(config: &Config) -> Option<Supervisor> {
    Supervisor::new(config).ok()
}

/// One tick with the recorder's part. A function of its own, so that there is one place to count in.
#[inline(never)]
pub fn tick(supervisor: &mut Supervisor, sample: &Sample, command: &mut Command) {
    *command = supervisor.tick(sample);
}
