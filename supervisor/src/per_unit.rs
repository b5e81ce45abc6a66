//! The supervisor per unit: coefficients, what is remembered, and the recorder beside it.

use crate::account::tally::{Tally, Units};
use crate::border::coeffs::{Coeffs, Scaling};
use crate::border::config::{Config, CoreError, NotRepresentable};
use crate::border::signal::{CoreCommand, CoreSample, Events, Mode, Report};
use crate::estimate::neighbour::{Neighbour, PlaneState};
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::Words;
use crate::record::publish::QueuedEvent;
use crate::record::recorder::{Recorder, Seen, Shared};
use crate::record::sections::Record;
use crate::tick::State;

/// Supervisor of one bearing plane in clearances and force caps, for a number `S`, with a flight record of
/// `RECORD` ticks (a power of two). [`Config::scaling`] says what the units are.
///
/// The order of the fields is kept: what a tick works with is within reach of one base register, and the long ring
/// of the recorder comes last.
#[derive(Debug, Clone)]
#[repr(C)]
pub struct Core<S: Scalar, const RECORD: usize = 512> {
    pub(crate) plane: Plane<S>,
    pub(crate) shared: Shared<RECORD>,
}

/// What the tick of a plane works with alone; what others see as well is in a [`Shared`] beside it.
#[derive(Debug, Clone)]
#[repr(C)]
pub(crate) struct Plane<S: Scalar> {
    coeffs: Coeffs<S>,
    state: State<S>,
    recorder: Recorder<S>,
}

/// Checked and converted configuration: made in the background, taken over between two ticks.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<S: Scalar>(Coeffs<S>, Config);

impl<S: Scalar> Prepared<S> {
    /// Checks and converts.
    ///
    /// # Errors
    /// A parameter outside its range, or a coefficient that `S` cannot hold.
    pub fn new(config: &Config) -> Result<Self, CoreError> {
        config.validate().map_err(CoreError::Range)?;
        match Self::from_valid(config) {
            (prepared, None) => Ok(prepared),
            (_, Some(lost)) => Err(CoreError::NotRepresentable(lost)),
        }
    }

    pub(crate) fn from_valid(config: &Config) -> (Self, Option<NotRepresentable>) {
        let (coeffs, lost) = Coeffs::new(config);
        (Self(coeffs, *config), lost)
    }
}

impl<S: Scalar> Plane<S> {
    /// Takes another configuration over; see [`Core::reconfigure`].
    pub(crate) fn reconfigure(&mut self, prepared: &Prepared<S>) {
        let (speed, _) = self.state.rescale(&self.coeffs, &prepared.0);
        self.coeffs = prepared.0;
        self.recorder.reconfigured(&prepared.1, speed);
    }

    /// One tick, with what the recorder does between two ticks.
    #[inline]
    pub(crate) fn tick<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        sample: &CoreSample<S>,
    ) -> CoreCommand<S> {
        if self.is_back(shared) {
            self.rearm(shared);
        }
        let (mut command, seen) = self.tick_beside(shared, sample, &());
        command.events |= self.advance(shared, seen, sample, command.mode);
        if self.may_keep() {
            self.keep(shared);
        }
        command
    }

    /// A tick of a plane that knows what is beside it, without what the recorder does between two ticks; and what it was for
    /// that.
    #[inline]
    pub(crate) fn tick_beside<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        sample: &CoreSample<S>,
        beside: &impl Neighbour<S>,
    ) -> (CoreCommand<S>, Seen) {
        self.recorder.push_sample(&shared.buffer, sample);
        let command = self.state.tick(sample, beside, &self.coeffs);
        let seen = (self.recorder).push(shared, sample, &self.state, &command);
        (command, seen)
    }

    /// Inputs for the other plane of a rotor.
    #[inline]
    pub(crate) fn plane_state(&self) -> PlaneState<S> {
        let observer = &self.state.observer;
        PlaneState {
            velocity: observer.known_velocity(),
            force: *observer.delivered(),
            unbalance: observer.unbalance(),
            unsettled: self.state.trust.is_unsettled(),
        }
    }

    /// The recorder goes on, by what both planes of a rotor have seen.
    #[inline]
    pub(crate) fn advance<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        seen: Seen,
        sample: &CoreSample<S>,
        mode: Mode,
    ) -> Events {
        let severity = &self.state.severity;
        (self.recorder).advance(shared, seen, sample, mode, severity, &self.coeffs)
    }

    /// Whether the recorder wants what is remembered, and the tick was one that has time for it.
    #[inline]
    pub(crate) fn may_keep(&self) -> bool {
        self.recorder.is_due() && !self.state.phase.is_engaged()
    }

    /// Keeps what is remembered: a replay begins here.
    pub(crate) fn keep<const N: usize>(&mut self, shared: &Shared<N>) {
        (self.recorder).keep(&shared.buffer, &mut self.state, &self.coeffs);
    }

    /// Whether no event is being recorded, and none waits to be read.
    #[inline]
    pub(crate) fn is_armed(&self) -> bool {
        self.recorder.is_armed()
    }

    /// Whether the background has given a frozen record back.
    #[inline]
    pub(crate) fn is_back<const N: usize>(&self, shared: &Shared<N>) -> bool {
        self.recorder.is_back(&shared.buffer)
    }

    /// For a test in its place: nothing remembered, other coefficients, and no recorder. Gives those back that it had.
    pub(crate) fn begin_test(&mut self, prepared: &Prepared<S>) -> Coeffs<S> {
        self.recorder.pause();
        self.state = State::default();
        core::mem::replace(&mut self.coeffs, prepared.0)
    }

    /// After it, as new.
    pub(crate) fn end_test<const N: usize>(&mut self, shared: &Shared<N>, coeffs: Coeffs<S>) {
        self.coeffs = coeffs;
        self.state = State::default();
        self.recorder.restart(&shared.buffer);
    }

    /// Waits for the next engagement.
    pub(crate) fn rearm<const N: usize>(&mut self, shared: &Shared<N>) {
        self.recorder.rearm(&shared.buffer);
        self.recorder
            .start_new_event(&mut self.state.severity.fastest);
    }

    /// The units of samples and commands.
    #[inline]
    pub(crate) fn scaling(&self) -> &Scaling {
        &self.coeffs.scaling
    }

    #[inline]
    pub(crate) fn coeffs(&self) -> &Coeffs<S> {
        &self.coeffs
    }

    /// Whether the levitation controller has the bearing, and what the commands since make of the rotor's acceleration.
    #[inline]
    pub(crate) fn levitates(&self) -> (bool, Vec2<S>) {
        let state = &self.state;
        (!state.phase.is_engaged(), *state.observer.delivered())
    }

    #[inline]
    fn tally(&self) -> Tally<S> {
        let State {
            guard,
            phase,
            trust,
            budget,
            severity,
            ..
        } = &self.state;
        Tally {
            mode: phase.mode(),
            handed_back: trust.handed_back,
            missed_ticks: guard.missed_ticks,
            repeated_ticks: guard.repeated_ticks,
            late_ticks: guard.late_ticks,
            refusal: guard.refusal,
            fault: guard.fault,
            thermal: budget.state(),
            ..severity.tally(self.recorder.earlier)
        }
    }

    /// What has happened, for everybody to see; and in which units, where these may have changed. With a frame of its own, and not
    /// in that of the tick.
    #[inline(never)]
    pub(crate) fn publish<const N: usize>(&self, shared: &Shared<N>, with_units: bool) {
        let units = with_units.then(|| Units::of(&self.coeffs));
        shared.latest.publish(&self.tally(), units.as_ref());
    }

    /// After a tick: the mode at once, all else when it is its turn. A tick with an event has enough to do: it is the next one
    /// that publishes its outcome.
    #[inline]
    pub(crate) fn publish_in_turn<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        mode: Mode,
        events: Events,
    ) {
        shared.latest.publish_mode(mode);
        if self.recorder.is_published_now(events) {
            self.publish(shared, false);
        }
    }
}

impl<S: Scalar, const RECORD: usize> Core<S, RECORD> {
    /// Bytes of the whole that are the flight recorder's: its ring, the queue of events, and where it is.
    pub const RECORDER_BYTES: usize = size_of::<Recorder<S>>() + size_of::<Shared<RECORD>>();

    /// A supervisor that starts levitated.
    pub fn new(prepared: &Prepared<S>) -> Self {
        Self::of_plane(prepared, [0, 1])
    }

    /// That of one plane, of so many.
    #[inline(always)]
    pub(crate) fn of_plane(prepared: &Prepared<S>, plane: [u8; 2]) -> Self {
        Self {
            plane: Plane {
                coeffs: prepared.0,
                state: State::default(),
                recorder: Recorder::new::<RECORD>(&prepared.1, plane),
            },
            shared: Shared::new(),
        }
    }

    /// One that goes on from what another one remembered, as a record holds it ([`crate::Part::State`]): its next commands are
    /// those of the other, to the last bit. Any words make one; too few leave the rest at nothing.
    pub fn resumed(prepared: &Prepared<S>, words: &[u32]) -> Self {
        let mut core = Self::new(prepared);
        core.resume(words);
        core
    }

    /// Words of what one remembers.
    pub fn state_words() -> usize {
        State::<S>::default().word_count() as usize
    }

    /// Goes on from these words.
    pub(crate) fn resume(&mut self, words: &[u32]) {
        self.plane.state = State::decode(&mut words.iter().copied());
    }

    /// Takes another configuration over, to hold from the next tick on. What is known of the rotor stays,
    /// and so do mode, counters and thermal state; entries of a flight record are in the units of
    /// their time, and the tick of the change has [`Events::RECONFIGURED`]. A smaller cap holds at once: from
    /// there on the slew limit holds.
    pub fn reconfigure(&mut self, prepared: &Prepared<S>) {
        self.plane.reconfigure(prepared);
    }

    /// One tick: total and bounded; the one loop that depends on data makes up for at most four missed
    /// ticks.
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, sample: &CoreSample<S>) -> CoreCommand<S> {
        self.plane.tick(&self.shared, sample)
    }

    /// The units of samples and commands.
    #[inline]
    pub fn scaling(&self) -> &Scaling {
        self.plane.scaling()
    }

    /// What the supervisor is doing.
    pub fn mode(&self) -> Mode {
        self.plane.state.phase.mode()
    }

    /// What has happened since the supervisor was made, in SI.
    pub fn report(&self) -> Report {
        let plane = &self.plane;
        let checked = self.shared.checked.load();
        plane.tally().report(&Units::of(&plane.coeffs), checked)
    }

    /// The frozen flight record, if there is one.
    pub fn record(&self) -> Option<Record<'_, S, RECORD>> {
        Record::new(&self.shared.buffer)
    }

    /// Discards a frozen record and waits for the next engagement.
    pub fn rearm(&mut self) {
        self.plane.rearm(&self.shared);
    }

    /// Next event for the background task, oldest first.
    pub fn next_event(&mut self) -> Option<QueuedEvent> {
        self.shared.events.pop()
    }
}
