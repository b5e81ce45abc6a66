//! The supervisor in SI units and `f32`: the core behind the one conversion.

use crate::coeffs::Scaling;
use crate::config::{Config, ConfigError};
use crate::events::QueuedEvent;
use crate::per_unit::{Core, Prepared};
use crate::record::Record;
use crate::signal::{Command, CoreCommand, CoreSample, Mode, Report, Sample, Status};

/// Supervisor of one bearing plane with a flight record of `RECORD` ticks (a power of two).
#[derive(Debug, Clone)]
pub struct Supervisor<const RECORD: usize = 512> {
    pub(crate) core: Core<f32, RECORD>,
}

impl<const RECORD: usize> Supervisor<RECORD> {
    /// A supervisor that starts levitated.
    ///
    /// # Errors
    /// The first parameter of `config` that is outside its range.
    pub fn new(config: &Config) -> Result<Self, ConfigError> {
        config.validate()?;
        Ok(Self::from_valid(config, [0, 1]))
    }

    /// One for a plane of a rotor, 0 or 1, of which [`crate::Machine::new`] has told the configuration.
    ///
    /// # Errors
    /// The first parameter of `config` that is outside its range.
    pub fn of_rotor(config: &Config, end: u8) -> Result<Self, ConfigError> {
        config.validate()?;
        Ok(Self::from_valid(config, [end, 2]))
    }

    // Always in its caller: then the compiler makes the whole where it will stay, and not on the stack first.
    #[inline(always)]
    pub(crate) fn from_valid(config: &Config, plane: [u8; 2]) -> Self {
        // Whatever is in range `f32` holds.
        let (prepared, _) = Prepared::from_valid(config);
        Self {
            core: Core::of_plane(&prepared, plane),
        }
    }

    /// Takes another configuration over, to hold from the next tick on; see [`Core::reconfigure`]. It
    /// computes some roots and exponentials: where that is too long between two ticks, use [`Core`] and
    /// [`Prepared`].
    ///
    /// # Errors
    /// The first parameter of `config` that is outside its range; then nothing has changed.
    pub fn reconfigure(&mut self, config: &Config) -> Result<(), ConfigError> {
        config.validate()?;
        let (prepared, _) = Prepared::from_valid(config);
        self.core.reconfigure(&prepared);
        Ok(())
    }

    /// One tick: total and bounded; see [`Core::tick`].
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, sample: &Sample) -> Command {
        let per_unit = self.core.scaling().sample(sample);
        let core = &mut self.core;
        let command = core.plane.tick(&core.shared, &per_unit);
        in_newtons(self.core.scaling(), sample, &per_unit, &command)
    }

    /// What the supervisor is doing.
    pub fn mode(&self) -> Mode {
        self.core.mode()
    }

    /// What has happened since the supervisor was made.
    pub fn report(&self) -> Report {
        self.core.report()
    }

    /// The frozen flight record, if there is one.
    pub fn record(&self) -> Option<Record<'_, f32, RECORD>> {
        self.core.record()
    }

    /// Discards a frozen record and waits for the next engagement.
    pub fn rearm(&mut self) {
        self.core.rearm();
    }

    /// Next event for the background task, oldest first.
    pub fn next_event(&mut self) -> Option<QueuedEvent> {
        self.core.next_event()
    }
}

/// The command for a sample in SI.
#[inline]
pub(crate) fn in_newtons(
    scaling: &Scaling,
    sample: &Sample,
    per_unit: &CoreSample<f32>,
    command: &CoreCommand<f32>,
) -> Command {
    let levitation = per_unit.levitation;
    let mut newtons = scaling.command(command);
    // Transparent means bit for bit: what the core left alone does not come back from per unit. A lost axis
    // gets nothing, also where a command is so small that per unit it is nothing. (Scaled as a whole before:
    // chosen number by number, x86-64 got vectors with integers in spare lanes, subnormal as floats and slow.)
    // Without a loop: where the compiler saves size it keeps the loop, and a check of its index that can panic.
    let [lost_x, lost_y] = Status::LOST_AXES.map(|lost| sample.status.contains(lost));
    let as_asked = |newtons: &mut [f32; 2], force: [f32; 2]| {
        if force[0] == levitation[0] && !lost_x {
            newtons[0] = sample.levitation_n[0];
        }
        if force[1] == levitation[1] && !lost_y {
            newtons[1] = sample.levitation_n[1];
        }
    };
    as_asked(&mut newtons.force_n, command.force);
    if sample.status.contains(Status::SHADOW) {
        as_asked(&mut newtons.own_n, command.own);
    } else {
        newtons.own_n = newtons.force_n;
    }
    newtons
}
