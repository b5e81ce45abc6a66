//! A supervisor in two halves, for two priorities: one ticks, the other reads what has become of it. Neither waits for the other.

use crate::config::{Config, ConfigError};
use crate::events::QueuedEvent;
use crate::per_unit::{Core, Plane, Prepared};
use crate::record::Record;
use crate::recorder::Shared;
use crate::scalar::Scalar;
use crate::signal::{Command, CoreCommand, CoreSample, Mode, Report, Sample};
use crate::supervisor::{Supervisor, in_newtons};
use core::marker::PhantomData;

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
        self.plane.publish(self.shared, false);
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
pub struct Ticker<'a, const RECORD: usize = 512>(pub(crate) CoreTicker<'a, f32, RECORD>);

impl<const RECORD: usize> Ticker<'_, RECORD> {
    /// As [`Supervisor::tick`]; the reader sees what has come of it from then on.
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, sample: &Sample) -> Command {
        let per_unit = self.0.plane.scaling().sample(sample);
        let command = self.0.ticked(&per_unit);
        in_newtons(self.0.plane.scaling(), sample, &per_unit, &command)
    }

    /// As [`Supervisor::reconfigure`]: between two ticks.
    ///
    /// # Errors
    /// The first parameter of `config` that is outside its range; then nothing has changed.
    pub fn reconfigure(&mut self, config: &Config) -> Result<(), ConfigError> {
        config.validate()?;
        let (prepared, _) = Prepared::from_valid(config);
        self.0.reconfigure(&prepared);
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
        Record::new(&self.shared.tape)
    }

    /// Gives a frozen record back; the next tick waits for an engagement again. Without one nothing happens.
    pub fn rearm(&mut self) {
        self.shared.tape.give_back();
    }

    /// For other tasks that want to know how it stands.
    pub fn published(&self) -> Published<'a, S, RECORD> {
        Published {
            shared: self.shared,
            number: PhantomData,
        }
    }
}

/// What the last tick has published: for any number of tasks of any priority.
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

    /// What had happened until its last tick, all of the same one. `None` where ticks came in between eight times, which takes
    /// some hundred instructions of this call each; and, asked from what has interrupted a tick, always.
    pub fn report(&self) -> Option<Report> {
        self.shared.latest.report::<S>()
    }
}

impl<S: Scalar, const RECORD: usize> Core<S, RECORD> {
    /// Two halves for two priorities: one ticks, the other takes events and records away. No lock is needed between them, and
    /// their borrow keeps everybody else out.
    pub fn split(&mut self) -> (CoreTicker<'_, S, RECORD>, Reader<'_, S, RECORD>) {
        let Self { plane, shared } = self;
        plane.publish(shared, true);
        (CoreTicker { plane, shared }, Reader::new(shared))
    }
}

impl<const RECORD: usize> Supervisor<RECORD> {
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
        let (ticker, reader) = self.core.split();
        (Ticker(ticker), reader)
    }
}
