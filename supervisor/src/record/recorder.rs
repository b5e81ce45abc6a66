//! Flight recorder, the tick's side of it: writes inputs and outcome of the ticks of an event, from a state on from
//! which they can be replayed; a slow track that reaches to its end; and events for the background task.

use crate::account::severity::{Fastest, Severity};
use crate::account::tally::Units;
use crate::border::coeffs::Coeffs;
use crate::border::config::Config;
use crate::border::finding::CheckedCell;
use crate::border::signal::{CoreCommand, CoreSample, Events, Mode, Status};
use crate::number::scalar::Scalar;
use crate::number::words::Words as _;
use crate::record::buffer::{CONFIG_WORDS, FrozenHeader, RecordBuffer};
use crate::record::entry;
use crate::record::publish::{EventQueue, Latest, QueuedEvent};
use crate::tick::State;
use core::sync::atomic::{AtomicU32, Ordering};

/// All that has happened is published every so many ticks: half as many after a restart in the second plane of a rotor, so
/// that both are never due at once.
const PUBLISHED_EVERY: u8 = 8;

/// What makes an engagement worth a record: one without must not spend the record of one with it.
const WORTH_IT: Events = Events::TOUCHED.union(Events::SENSOR_FAULT);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// Recording; nothing has happened yet.
    Armed,
    /// Recording for so many more ticks, and then the slow track alone until the event is over.
    Triggered(usize),
    Frozen,
    /// The ticks are those of a self-test: nothing is written down.
    Paused,
}

/// What a tick was for the recorder; of a rotor, for those of both planes.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seen {
    /// The supervisor has the bearing.
    engaged: bool,
    /// A record begins, if none has.
    triggers: bool,
    /// It is worth one.
    worth_it: bool,
}

impl Seen {
    /// Of both planes.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            engaged: self.engaged || other.engaged,
            triggers: self.triggers || other.triggers,
            worth_it: self.worth_it || other.worth_it,
        }
    }
}

/// What the tick's side knows of the record.
#[derive(Debug, Clone)]
pub(crate) struct Recorder<S: Scalar> {
    progress: Progress,
    /// Entries written, those before the first without a break, and those when the state was kept: all modulo 2³².
    written: u32,
    begun_at: u32,
    kept_at: u32,
    /// The state that is kept is of the entries that are there; and is the one of a new core, which is not written down.
    keeps: bool,
    is_new: bool,
    /// Ticks until it is kept again; negative where it has been due for so many, since no tick had time for it.
    due: i32,
    /// The engagement that triggered has had a touch, or a fault.
    worth_it: bool,
    lost: bool,
    /// Fastest in the events before the one that is recorded.
    pub(crate) earlier: Fastest<S>,
    /// Which plane this is, of how many.
    plane: [u8; 2],
    /// Coasting down was asked for in the event, or before it and still; and whether it had been when the state was kept.
    coast_down: bool,
    kept_coast_down: bool,
    /// Events that have found a record frozen, and those that did before this one began.
    dropping: u32,
    dropped: u32,
    /// Values of the configuration now, and whether the buffer has others.
    config: [f32; CONFIG_WORDS],
    stale: bool,
    track: entry::TrackProgress<S>,
    /// Ticks since all was published.
    unpublished: u8,
}

/// What both sides use.
#[derive(Debug, Clone)]
#[repr(C)]
pub(crate) struct Shared<const N: usize> {
    pub(crate) latest: Latest,
    pub(crate) buffer: RecordBuffer<N>,
    pub(crate) events: EventQueue,
    pub(crate) checked: CheckedCell,
}

impl<const N: usize> Shared<N> {
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self {
            latest: Latest::new(),
            buffer: RecordBuffer::new(),
            events: EventQueue::new(),
            checked: CheckedCell::new(),
        }
    }
}

// Each once, and not wherever it is wanted; with a frame of its own and not in that of the tick.

#[inline(never)]
fn lay_severity<S: Scalar>(severity: &Severity<S>, cells: &[AtomicU32]) {
    severity.write_cells(cells, 0);
}

#[inline(never)]
fn lay_units<S: Scalar>(coeffs: &Coeffs<S>, cells: &[AtomicU32]) {
    Units::of(coeffs).write_cells(cells, 0);
}

#[inline(never)]
fn lay_values(values: &[f32], cells: &[AtomicU32]) {
    (values.iter().zip(cells))
        .for_each(|(value, cell)| cell.store(value.to_bits(), Ordering::Relaxed));
}

/// Entries before the trigger.
const fn before<const N: usize>() -> usize {
    N / 4
}

impl<S: Scalar> Recorder<S> {
    /// Before the first tick.
    #[inline(always)]
    pub(crate) fn new<const N: usize>(config: &Config, plane: [u8; 2]) -> Self {
        Self {
            progress: Progress::Armed,
            written: 0,
            begun_at: 0,
            kept_at: 0,
            keeps: true,
            is_new: true,
            due: before::<N>() as i32,
            worth_it: false,
            lost: false,
            earlier: Fastest::default(),
            plane,
            coast_down: false,
            kept_coast_down: false,
            dropping: 0,
            dropped: 0,
            config: config.values(),
            stale: true,
            track: entry::TrackProgress::new(),
            unpublished: PUBLISHED_EVERY / 2 * plane[0],
        }
    }

    /// Whether the state is to be kept before the next tick: so often that one is never far before a trigger.
    #[inline]
    pub(crate) fn is_due(&self) -> bool {
        self.due <= 0
    }

    /// Keeps the state. In a quiet tick: it costs some hundred instructions.
    #[inline(never)]
    pub(crate) fn keep<const N: usize>(
        &mut self,
        buffer: &RecordBuffer<N>,
        state: &mut State<S>,
        coeffs: &Coeffs<S>,
    ) {
        self.start_new_event(&mut state.severity.fastest);
        if core::mem::take(&mut self.stale) {
            lay_values(&self.config, buffer.config.all());
            lay_units(coeffs, buffer.opening_units.all());
        }
        self.kept_coast_down = state.severity.coast_down();
        state.write_all(&buffer.state);
        (self.kept_at, self.due) = (self.written, before::<N>() as i32);
        (self.keeps, self.is_new) = (true, false);
        // Before counts begin anew.
        let length = self.written.wrapping_sub(self.begun_at).min(N as u32);
        self.begun_at = self.written.wrapping_sub(length);
    }

    /// Another configuration.
    pub(crate) fn reconfigured(&mut self, config: &Config, speed: S) {
        self.earlier = self.earlier.rescaled(speed);
        (self.config, self.stale) = (config.values(), true);
        if self.progress == Progress::Armed {
            (self.begun_at, self.due) = (self.written, 0);
            self.keeps = false;
        }
    }

    /// Whether it is the turn of all that has happened, after a tick with these events.
    #[inline]
    pub(crate) fn is_published_now(&mut self, events: Events) -> bool {
        self.unpublished += 1;
        if !events.is_empty() && self.unpublished < 2 * PUBLISHED_EVERY {
            self.unpublished = self.unpublished.max(PUBLISHED_EVERY);
            return false;
        }
        let due = self.unpublished >= PUBLISHED_EVERY;
        if due {
            self.unpublished = 0;
        }
        due
    }

    /// Whether ticks are written down.
    #[inline]
    fn writes(&self) -> bool {
        matches!(self.progress, Progress::Armed | Progress::Triggered(1..))
    }

    /// Takes in a tick's inputs. Before the tick, which needs the registers for something else then.
    #[inline]
    pub(crate) fn push_sample<const N: usize>(
        &mut self,
        buffer: &RecordBuffer<N>,
        sample: &CoreSample<S>,
    ) {
        if self.writes()
            && let Some(place) = buffer.entry(self.written)
        {
            entry::write_sample(sample, place);
        }
    }

    /// Takes a tick in, with what is remembered after it. What the tick was.
    #[inline]
    pub(crate) fn push<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        sample: &CoreSample<S>,
        state: &State<S>,
        command: &CoreCommand<S>,
    ) -> Seen {
        if self.writes() {
            if let Some(place) = shared.buffer.entry(self.written) {
                entry::write_command(command, place);
            }
            self.written = self.written.wrapping_add(1);
            self.due = self.due.wrapping_sub(1);
        }
        let quiet = command.events.is_empty();
        if quiet && self.progress == Progress::Armed {
            // Most ticks.
            return Seen::default();
        }
        let seen = if quiet {
            Seen {
                engaged: command.mode.is_engaged(),
                ..Seen::default()
            }
        } else {
            self.happened(
                &shared.events,
                sample.sequence,
                command.mode,
                command.events,
            )
        };
        let begins = seen.triggers && self.progress == Progress::Armed;
        if begins || matches!(self.progress, Progress::Triggered(_)) {
            let (position, touching) = state.whereabouts();
            let track = &shared.buffer.track;
            (self.track).push(track, sample.sequence, command, position, touching);
        }
        seen
    }

    /// A tick with events.
    #[inline(never)]
    fn happened(&mut self, queue: &EventQueue, sequence: u32, mode: Mode, events: Events) -> Seen {
        if self.progress != Progress::Paused {
            self.queue(queue, sequence, mode, events);
        }
        let engaged = mode.is_engaged();
        let touched = engaged && events.intersects(WORTH_IT);
        let begins = events.contains(Events::ENGAGED);
        if self.progress != Progress::Frozen {
            self.coast_down |= events.contains(Events::COAST_DOWN);
        } else if begins {
            self.dropping = self.dropping.saturating_add(1);
        }
        Seen {
            engaged,
            triggers: touched || begins,
            // One that begins on the wall has no touch to come.
            worth_it: touched || begins && mode != Mode::Approach,
        }
    }

    /// Goes on by a tick; what the recorder itself has to report.
    #[inline]
    pub(crate) fn advance<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        seen: Seen,
        sample: &CoreSample<S>,
        mode: Mode,
        severity: &Severity<S>,
        coeffs: &Coeffs<S>,
    ) -> Events {
        match self.progress {
            Progress::Armed if seen.triggers => {
                self.worth_it = seen.worth_it;
                self.begin(&shared.buffer, severity, coeffs);
                // A quarter before the trigger, three quarters after it.
                self.progress = Progress::Triggered(N - before::<N>());
                self.due = i32::MAX;
            }
            Progress::Triggered(left) => {
                self.worth_it |= seen.worth_it;
                self.progress = Progress::Triggered(left.saturating_sub(1));
                let over = !seen.engaged || self.track.is_full();
                if over && !self.worth_it {
                    self.discard(&shared.buffer, left);
                } else if over && left <= 1 {
                    return self.freeze(shared, sample, mode, severity, coeffs);
                }
            }
            Progress::Armed | Progress::Frozen | Progress::Paused => {}
        }
        Events::empty()
    }

    #[inline(never)]
    fn freeze<const N: usize>(
        &mut self,
        shared: &Shared<N>,
        sample: &CoreSample<S>,
        mode: Mode,
        severity: &Severity<S>,
        coeffs: &Coeffs<S>,
    ) -> Events {
        let (sequence, status) = (sample.sequence, sample.status);
        let buffer = &shared.buffer;
        self.track.finish(&buffer.track, sequence);
        let (ticks, since) = self.lengths::<N>();
        // Without a state that says it. A new core's begins with nothing, whatever the units.
        if self.stale && (since.is_none() || self.is_new) {
            lay_values(&self.config, buffer.config.all());
        }
        lay_severity(severity, buffer.closing.all());
        lay_units(coeffs, buffer.closing_units.all());
        let closed = FrozenHeader {
            plane: self.plane,
            written: self.written,
            ticks,
            since: since.unwrap_or_default(),
            keeps: since.is_some(),
            is_new: self.is_new,
            stretches: self.track.done(),
            sequence,
            mode,
            on: status.contains(Status::BEARING_ON),
            coast_down: self.coast_down,
            dropped: self.dropped,
        };
        closed.words().write_cells(buffer.closed.all(), 0);
        buffer.freeze();
        self.progress = Progress::Frozen;
        self.queue(&shared.events, sequence, mode, Events::RECORD_FROZEN);
        Events::RECORD_FROZEN
    }

    /// Nothing was worth a record. The ring goes on, if it has not stopped.
    #[inline(never)]
    fn discard<const N: usize>(&mut self, buffer: &RecordBuffer<N>, left: usize) {
        let begun_at = self.begun_at;
        self.rearm(buffer);
        if left > 1 {
            self.begun_at = begun_at;
        }
    }

    /// What had come to the bearing when the rotor still levitated, or, where that was not kept, until now.
    #[inline(never)]
    fn begin<const N: usize>(
        &mut self,
        buffer: &RecordBuffer<N>,
        severity: &Severity<S>,
        coeffs: &Coeffs<S>,
    ) {
        let (_, since) = self.lengths::<N>();
        self.coast_down |= match since {
            Some(_) => self.kept_coast_down,
            None => {
                lay_severity(severity, buffer.opening.all());
                lay_units(coeffs, buffer.opening_units.all());
                severity.coast_down()
            }
        };
        self.dropped = core::mem::take(&mut self.dropping);
    }

    fn queue(&mut self, queue: &EventQueue, sequence: u32, mode: Mode, mut events: Events) {
        if self.lost {
            events |= Events::QUEUE_FULL;
        }
        let event = QueuedEvent {
            sequence,
            mode,
            events,
        };
        self.lost = !queue.push(event);
    }

    /// Entries of a record, and how many of them are since the state that was kept.
    fn lengths<const N: usize>(&self) -> (u32, Option<u32>) {
        let length = self.written.wrapping_sub(self.begun_at).min(N as u32);
        let since = self.written.wrapping_sub(self.kept_at);
        (length, (self.keeps && since <= length).then_some(since))
    }

    /// Whether it waits for an engagement.
    #[inline]
    pub(crate) fn is_armed(&self) -> bool {
        self.progress == Progress::Armed
    }

    /// Whether the background has given a frozen record back.
    #[inline]
    pub(crate) fn is_back<const N: usize>(&self, buffer: &RecordBuffer<N>) -> bool {
        self.progress == Progress::Frozen && buffer.is_back()
    }

    pub(crate) fn rearm<const N: usize>(&mut self, buffer: &RecordBuffer<N>) {
        if self.progress != Progress::Armed {
            self.progress = Progress::Armed;
            // What comes now does not follow what is there.
            (self.begun_at, self.due) = (self.written, 0);
            self.keeps = false;
            self.coast_down = false;
            self.track.clear();
            buffer.resume();
        }
    }

    /// Looks away.
    pub(crate) fn pause(&mut self) {
        (self.progress, self.due) = (Progress::Paused, i32::MAX);
    }

    /// As new, for a core that is.
    pub(crate) fn restart<const N: usize>(&mut self, buffer: &RecordBuffer<N>) {
        let config = Config::from_values(self.config);
        *self = Self::new::<N>(&config, self.plane);
        buffer.resume();
    }

    /// What comes now is of another event.
    pub(crate) fn start_new_event(&mut self, fastest: &mut Fastest<S>) {
        self.earlier = self.earlier.or(core::mem::take(fastest));
    }
}
