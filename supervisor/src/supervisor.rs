//! The supervisor in SI units and `f32`: the core behind the one conversion.
//!
//! A supervisor in two halves, for two priorities: one ticks, the other reads what has become of it. Neither waits for the other.

use crate::border::coeffs::Scaling;
use crate::border::config::{Config, ConfigError};
use crate::border::finding::CheckedCell;
use crate::border::signal::{Command, CoreCommand, CoreSample, Mode, Report, Sample, Status};
use crate::check::{Check, Seen};
use crate::number::scalar::Scalar;
use crate::per_unit::{Core, Plane, Prepared};
use crate::record::publish::QueuedEvent;
use crate::record::recorder::Shared;
use crate::record::sections::Record;
use core::marker::PhantomData;

/// Supervisor of one bearing plane with a flight record of `RECORD` ticks (a power of two).
#[derive(Debug, Clone)]
pub struct Supervisor<const RECORD: usize = 512> {
    pub(crate) core: Core<f32, RECORD>,
    pub(crate) check: Check,
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

    /// One for a plane of a rotor, 0 or 1, of which [`crate::RotorCore::new`] has given the configuration.
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
        let new = Self {
            core: Core::of_plane(&prepared, plane),
            check: Check::new(config),
        };
        new.check.begin(&new.core.shared.checked);
        new
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
        self.check = Check::new(config);
        self.check.begin(&self.core.shared.checked);
        Ok(())
    }

    /// One tick: total and bounded; see [`Core::tick`].
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, sample: &Sample) -> Command {
        let core = &mut self.core;
        let mut per_unit = core.scaling().sample(sample);
        per_unit.status = self.check.admitted(per_unit.status);
        let command = core.plane.tick(&core.shared, &per_unit);
        if !self.check.is_over() {
            watch(&mut self.check, &core.shared.checked, &core.plane, sample);
        }
        in_newtons(self.core.scaling(), sample, &per_unit, &command)
    }

    /// What firmware adds to the force that it asks for next \[N\], so that the configuration is held against the machine: a sine of
    /// 3.5 % of the cap for some seconds of levitation, and nothing before and after; see [`Config::check_first`].
    pub fn stimulus_n(&self) -> [f32; 2] {
        let force_n = self.core.scaling().force_n;
        self.check.stimulus().map(|force| force * force_n)
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

/// The check looks at a tick of a plane that stands alone: from outside of the tick, and with units of its own, so that a tick that
/// is not looked at keeps its numbers in registers.
#[cold]
#[inline(never)]
fn watch(check: &mut Check, cell: &CheckedCell, plane: &Plane<f32>, sample: &Sample) {
    let per_unit = plane.scaling().sample(sample);
    let seen = Seen::new(&per_unit, plane.levitates(), plane.coeffs());
    check.watch(cell, &seen);
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
    if per_unit.status.contains(Status::SHADOW) {
        as_asked(&mut newtons.own_n, command.own);
    } else {
        newtons.own_n = newtons.force_n;
    }
    newtons
}

/// The half of a [`Core`] that ticks: for the control interrupt, or whatever owns the bearing.
#[derive(Debug)]
pub struct CoreTicker<'a, S: Scalar, const RECORD: usize = 512> {
    pub(crate) plane: &'a mut Plane<S>,
    pub(crate) shared: &'a Shared<RECORD>,
}

impl<S: Scalar, const RECORD: usize> CoreTicker<'_, S, RECORD> {
    /// As [`Core::tick`]; the reader sees what has come of it from then on.
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, sample: &CoreSample<S>) -> CoreCommand<S> {
        self.ticked(sample)
    }

    #[inline]
    fn ticked(&mut self, sample: &CoreSample<S>) -> CoreCommand<S> {
        let command = self.plane.tick(self.shared, sample);
        (self.plane).publish_in_turn(self.shared, command.mode, command.events);
        command
    }

    /// As [`Core::reconfigure`]: between two ticks.
    pub fn reconfigure(&mut self, prepared: &Prepared<S>) {
        self.plane.reconfigure(prepared);
        self.plane.publish(self.shared, true);
    }
}

/// The half of a [`Supervisor`] that ticks: for the control interrupt, or whatever owns the bearing.
#[derive(Debug)]
pub struct Ticker<'a, const RECORD: usize = 512> {
    pub(crate) core: CoreTicker<'a, f32, RECORD>,
    pub(crate) check: &'a mut Check,
}

impl<const RECORD: usize> Ticker<'_, RECORD> {
    /// As [`Supervisor::tick`]; the reader sees what has come of it from then on.
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, sample: &Sample) -> Command {
        let Self { core, check } = self;
        let mut per_unit = core.plane.scaling().sample(sample);
        per_unit.status = check.admitted(per_unit.status);
        let command = core.ticked(&per_unit);
        if !check.is_over() {
            watch(check, &core.shared.checked, core.plane, sample);
        }
        in_newtons(core.plane.scaling(), sample, &per_unit, &command)
    }

    /// As [`Supervisor::stimulus_n`].
    pub fn stimulus_n(&self) -> [f32; 2] {
        let force_n = self.core.plane.scaling().force_n;
        self.check.stimulus().map(|force| force * force_n)
    }

    /// As [`Supervisor::reconfigure`]: between two ticks.
    ///
    /// # Errors
    /// The first parameter of `config` that is outside its range; then nothing has changed.
    pub fn reconfigure(&mut self, config: &Config) -> Result<(), ConfigError> {
        config.validate()?;
        let (prepared, _) = Prepared::from_valid(config);
        self.core.reconfigure(&prepared);
        *self.check = Check::new(config);
        self.check.begin(&self.core.shared.checked);
        Ok(())
    }
}

/// The half that reads: for one task of a lower priority than the tick's, on the same processor or another one that sees the same
/// memory. Ticks may come at any time, between any two of its instructions; they are neither held up nor refused.
#[derive(Debug)]
pub struct Reader<'a, S: Scalar = f32, const RECORD: usize = 512> {
    shared: &'a Shared<RECORD>,
    number: PhantomData<S>,
}

impl<'a, S: Scalar, const RECORD: usize> Reader<'a, S, RECORD> {
    pub(crate) fn new(shared: &'a Shared<RECORD>) -> Self {
        Self {
            shared,
            number: PhantomData,
        }
    }

    pub(crate) fn shared(&self) -> &'a Shared<RECORD> {
        self.shared
    }

    /// Next event, oldest first. Up to 16 wait; see [`crate::Events::QUEUE_FULL`].
    pub fn next_event(&mut self) -> Option<QueuedEvent> {
        self.shared.events.pop()
    }

    /// The frozen flight record, if there is one. It stays as it is until [`Self::rearm`].
    pub fn record(&self) -> Option<Record<'_, S, RECORD>> {
        Record::new(&self.shared.buffer)
    }

    /// Gives a frozen record back; the next tick waits for an engagement again. Without one nothing happens.
    pub fn rearm(&mut self) {
        self.shared.buffer.give_back();
    }

    /// For other tasks that want to know how it stands.
    pub fn published(&self) -> Published<'a, S, RECORD> {
        Published {
            shared: self.shared,
            number: PhantomData,
        }
    }
}

/// What the ticks have published: for any number of tasks of any priority.
#[derive(Debug, Clone, Copy)]
pub struct Published<'a, S: Scalar = f32, const RECORD: usize = 512> {
    shared: &'a Shared<RECORD>,
    number: PhantomData<S>,
}

impl<S: Scalar, const RECORD: usize> Published<'_, S, RECORD> {
    /// What the supervisor was doing after its last tick.
    pub fn mode(&self) -> Mode {
        self.shared.latest.mode()
    }

    /// What had happened until one of its last eight ticks, or sixteen where many have events, all of the same one; an event is in
    /// it from the tick after it on. `None` where ticks came in between eight times, which takes
    /// some hundred instructions of this call each; and, asked from what has interrupted a tick, always.
    pub fn report(&self) -> Option<Report> {
        self.shared.latest.report::<S>(self.shared.checked.load())
    }
}

impl<S: Scalar, const RECORD: usize> Core<S, RECORD> {
    /// The half that ticks, by itself: for what counts its instructions.
    #[doc(hidden)]
    #[inline]
    pub fn ticker(&mut self) -> CoreTicker<'_, S, RECORD> {
        let Self { plane, shared } = self;
        CoreTicker { plane, shared }
    }

    /// Two halves for two priorities: one ticks, the other takes events and records away. No lock is needed between them, and
    /// their borrow keeps everybody else out.
    pub fn split(&mut self) -> (CoreTicker<'_, S, RECORD>, Reader<'_, S, RECORD>) {
        let Self { plane, shared } = self;
        plane.publish(shared, true);
        (CoreTicker { plane, shared }, Reader::new(shared))
    }
}

impl<const RECORD: usize> Supervisor<RECORD> {
    /// The half that ticks, by itself: for what counts its instructions.
    #[doc(hidden)]
    #[inline]
    pub fn ticker(&mut self) -> Ticker<'_, RECORD> {
        let Self { core, check } = self;
        let core = core.ticker();
        Ticker { core, check }
    }

    /// Two halves for two priorities: one ticks, the other takes events and records away. No lock is needed between them, and
    /// their borrow keeps everybody else out.
    ///
    /// ```
    /// use supervisor::{Config, Sample, Stamp, Supervisor};
    ///
    /// let mut supervisor = Supervisor::<512>::new(&Config::example())?;
    /// let (mut ticker, mut reader) = supervisor.split();
    ///
    /// let command = ticker.tick(&Sample::default()); // in the control interrupt
    ///
    /// while let Some(event) = reader.next_event() {} // in the background
    /// if let Some(record) = reader.record() {
    ///     let sections = (0..).map_while(|index| record.section(index, &Stamp::default()));
    ///     sections.for_each(|mut section| drop(section.seal()));
    ///     reader.rearm();
    /// }
    /// assert_eq!(reader.published().mode(), command.mode);
    /// # Ok::<(), supervisor::ConfigError>(())
    /// ```
    pub fn split(&mut self) -> (Ticker<'_, RECORD>, Reader<'_, f32, RECORD>) {
        let Self { core, check } = self;
        let (core, reader) = core.split();
        (Ticker { core, check }, reader)
    }
}
