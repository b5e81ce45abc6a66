//! Flight recorder: what the ticks of an event were told and what came of it, from a state on from which they can be replayed;
//! a slow track that reaches to its end; and a queue of events for the background task.

use crate::config::Config;
use crate::scalar::Scalar;
use crate::severity::{Fastest, Severity};
use crate::signal::{CoreCommand, CoreSample, Events, Mode, Status};
use crate::tick::State;
use crate::track::Track;
use crate::vec2::Vec2;
use crate::words::Words as _;

/// Version of what [`crate::Record`] writes.
pub const RECORD_VERSION: u16 = 3;

/// One tick, 48 bytes: all that it depends on but for what was before, and what came of it. Numbers are those of the core, per
/// unit, as their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Entry {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Position of the sample \[clearances\].
    pub position: [u32; 2],
    /// Spin \[1/t₀\].
    pub spin: u32,
    /// Force that the levitation controller wanted \[caps\].
    pub levitation: [u32; 2],
    /// What the actuator was measured to deliver \[caps\].
    pub applied: [u32; 2],
    /// Commanded force, in shadow what it would have been \[caps\].
    pub force: [u32; 2],
    /// [`Mode`] as a number.
    pub mode: u8,
    /// Low byte of [`crate::Limits`].
    pub limits: u8,
    /// Low 16 bits of [`Events`].
    pub events: u16,
    /// Bits of [`Status`].
    pub status: u32,
}

/// Words of an entry.
pub const ENTRY_WORDS: usize = 12;

impl Entry {
    fn new<S: Scalar>(sample: &CoreSample<S>, command: &CoreCommand<S>) -> Self {
        Self {
            sequence: sample.sequence,
            position: sample.position.map(S::bits),
            spin: sample.spin.bits(),
            levitation: sample.levitation.map(S::bits),
            applied: sample.applied.map(S::bits),
            force: command.own.map(S::bits),
            mode: command.mode as u8,
            limits: command.limits.bits() as u8,
            events: command.events.bits() as u16,
            status: sample.status.bits(),
        }
    }

    /// The sample, as the core got it.
    pub fn sample<S: Scalar>(&self) -> CoreSample<S> {
        CoreSample {
            sequence: self.sequence,
            status: Status::from_bits_retain(self.status),
            position: self.position.map(S::of_bits),
            spin: S::of_bits(self.spin),
            levitation: self.levitation.map(S::of_bits),
            applied: self.applied.map(S::of_bits),
        }
    }

    /// Whether this is the command that the tick gave, to the last bit.
    pub fn gave<S: Scalar>(&self, command: &CoreCommand<S>) -> bool {
        Self::new(&self.sample::<S>(), command) == *self
    }

    /// As words, each to be written down little-endian.
    pub(crate) fn words(&self) -> [u32; ENTRY_WORDS] {
        let [x, y] = self.position;
        let [lx, ly] = self.levitation;
        let [ax, ay] = self.applied;
        let [fx, fy] = self.force;
        let said = u32::from(self.mode) | u32::from(self.limits) << 8;
        [
            self.sequence,
            x,
            y,
            self.spin,
            lx,
            ly,
            ax,
            ay,
            fx,
            fy,
            said | u32::from(self.events) << 16,
            self.status,
        ]
    }

    /// From words as a record has them.
    pub fn from_words(words: [u32; ENTRY_WORDS]) -> Self {
        let [sequence, x, y, spin, lx, ly, ax, ay, fx, fy, said, status] = words;
        Self {
            sequence,
            position: [x, y],
            spin,
            levitation: [lx, ly],
            applied: [ax, ay],
            force: [fx, fy],
            mode: said as u8,
            limits: (said >> 8) as u8,
            events: (said >> 16) as u16,
            status,
        }
    }
}

/// An event with its tick, for the background task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct QueuedEvent {
    /// Sequence number of the sample.
    pub sequence: u32,
    /// Mode after the tick.
    pub mode: Mode,
    /// What changed.
    pub events: Events,
}

/// What makes an engagement worth a record: one without must not spend the record of one with it.
const WORTH_IT: Events = Events::TOUCHED.union(Events::SENSOR_FAULT);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// Recording; nothing has happened yet.
    Armed,
    /// Recording for so many more ticks, and then the slow track alone until the event is over.
    Triggered(usize),
    Frozen,
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

/// How an event ended.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Closed {
    pub(crate) sequence: u32,
    pub(crate) mode: Mode,
    /// The bearing was on.
    pub(crate) on: bool,
}

/// Ring of `N` entries (a power of two).
///
/// The order of the fields is kept, and has written numbers on both sides of the entries: then the compiler
/// clears these where the recorder will stay, and has no copy of them on the stack on the way there.
#[derive(Debug, Clone)]
#[repr(C)]
pub(crate) struct Recorder<S: Scalar, const N: usize> {
    progress: Progress,
    /// Entries written, those before the first without a break, and those when the state was kept: all modulo 2³².
    written: u32,
    begun_at: u32,
    kept_at: u32,
    /// The state that is kept is of the entries that are there.
    keeps: bool,
    /// Ticks until it is kept again.
    due: u32,
    /// The engagement that triggered has had a touch, or a fault.
    worth_it: bool,
    lost: bool,
    /// Fastest in the events before the one that is recorded.
    pub(crate) earlier: Fastest<S>,
    /// Which plane this is, of how many.
    pub(crate) plane: [u8; 2],
    /// Of the last tick of the record.
    pub(crate) closed: Closed,
    /// Coasting down was asked for in the event, or before it and still.
    pub(crate) coast_down: bool,
    /// Events that have found a record frozen, and those that did before this one began.
    dropping: u32,
    pub(crate) dropped: u32,
    /// What had come to the bearing when the event began.
    pub(crate) opening: Severity<S>,
    /// The state before some tick.
    pub(crate) kept: State<S>,
    /// The configuration now, and that of the state where it is another: not copied in a tick.
    configs: [Config; 2],
    now: u8,
    kept_in: u8,
    /// What had come to the bearing when the record froze.
    pub(crate) closing: Severity<S>,
    entries: [Entry; N],
    pub(crate) track: Track<S>,
    queued: heapless::Deque<QueuedEvent, 16>,
}

impl<S: Scalar, const N: usize> Recorder<S, N> {
    const MASK: usize = {
        assert!(
            N.is_power_of_two() && N >= 4,
            "record length must be a power of two, at least 4"
        );
        N - 1
    };
    /// Entries before the trigger.
    const BEFORE: usize = N / 4;

    pub(crate) fn new(config: &Config, plane: [u8; 2]) -> Self {
        Self {
            progress: Progress::Armed,
            written: 0,
            begun_at: 0,
            kept_at: 0,
            // What is remembered before the first tick.
            keeps: true,
            due: Self::BEFORE as u32,
            worth_it: false,
            lost: false,
            earlier: Fastest::default(),
            plane,
            closed: Closed::default(),
            coast_down: false,
            dropping: 0,
            dropped: 0,
            opening: Severity::default(),
            kept: State::default(),
            configs: [*config; 2],
            now: 0,
            kept_in: 0,
            closing: Severity::default(),
            entries: [Entry::default(); N],
            track: Track::new(),
            queued: heapless::Deque::new(),
        }
    }

    /// Whether the state is to be kept before the next tick: so often that one is never far before a trigger.
    #[inline]
    pub(crate) fn is_due(&self) -> bool {
        self.due == 0
    }

    /// Keeps the state. In a quiet tick: it costs some hundred instructions.
    #[inline(never)]
    pub(crate) fn keep(&mut self, state: &mut State<S>) {
        self.part(&mut state.severity.fastest);
        self.kept.become_as(state);
        self.kept_in = self.now;
        (self.kept_at, self.keeps, self.due) = (self.written, true, Self::BEFORE as u32);
        // Before counts begin anew.
        let length = self.written.wrapping_sub(self.begun_at).min(N as u32);
        self.begun_at = self.written.wrapping_sub(length);
    }

    /// What is kept is of another configuration.
    pub(crate) fn reconfigured(&mut self, config: &Config, speed: S, index: f32) {
        self.earlier = self.earlier.rescaled(speed);
        self.opening.rescale(speed, index);
        self.closing.rescale(speed, index);
        self.now = 1 - (self.kept_in & 1);
        let [first, second] = &mut self.configs;
        *if self.now == 0 { first } else { second } = *config;
        if self.progress == Progress::Armed {
            (self.begun_at, self.due) = (self.written, 0);
            self.keeps = false;
        }
    }

    /// Takes a tick in, with what is remembered after it. What the tick was.
    #[inline]
    pub(crate) fn push(
        &mut self,
        sample: &CoreSample<S>,
        state: &State<S>,
        command: &CoreCommand<S>,
    ) -> Seen {
        let seen = if command.events.is_empty() {
            Seen {
                engaged: command.mode.is_engaged(),
                ..Seen::default()
            }
        } else {
            self.happened(sample.sequence, command.mode, command.events)
        };
        if let Progress::Armed | Progress::Triggered(1..) = self.progress {
            if let Some(entry) = self.entries.get_mut(self.written as usize & Self::MASK) {
                *entry = Entry::new(sample, command);
            }
            self.written = self.written.wrapping_add(1);
            self.due = self.due.saturating_sub(1);
        }
        let begins = seen.triggers && self.progress == Progress::Armed;
        if begins || matches!(self.progress, Progress::Triggered(_)) {
            let (position, touching) = state.whereabouts();
            let own = Vec2::from_array(command.own);
            let squares = [position.length_squared(), own.length_squared()];
            let happened = (command.mode, command.events, touching);
            (self.track).push(sample.sequence, squares, command.severity, happened);
        }
        seen
    }

    /// A tick with events.
    #[inline(never)]
    fn happened(&mut self, sequence: u32, mode: Mode, events: Events) -> Seen {
        self.queue((sequence, mode), events);
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
    pub(crate) fn advance(
        &mut self,
        seen: Seen,
        (sample, mode): (&CoreSample<S>, Mode),
        severity: &Severity<S>,
    ) -> Events {
        match self.progress {
            Progress::Armed if seen.triggers => {
                self.worth_it = seen.worth_it;
                self.begin(severity);
                // A quarter before the trigger, three quarters after it.
                self.progress = Progress::Triggered(N - Self::BEFORE);
                self.due = u32::MAX;
            }
            Progress::Triggered(left) => {
                self.worth_it |= seen.worth_it;
                self.progress = Progress::Triggered(left.saturating_sub(1));
                let over = !seen.engaged || self.track.is_full();
                if over && !self.worth_it {
                    self.discard(left);
                } else if over && left <= 1 {
                    return self.freeze((sample.sequence, sample.status, mode), severity);
                }
            }
            Progress::Armed | Progress::Frozen => {}
        }
        Events::empty()
    }

    #[inline(never)]
    fn freeze(&mut self, last: (u32, Status, Mode), severity: &Severity<S>) -> Events {
        let (sequence, status, mode) = last;
        let on = status.contains(Status::BEARING_ON);
        self.closing = *severity;
        self.track.finish(sequence);
        self.closed = Closed { sequence, mode, on };
        self.progress = Progress::Frozen;
        self.queue((sequence, mode), Events::RECORD_FROZEN);
        Events::RECORD_FROZEN
    }

    /// Nothing was worth a record. The ring goes on, if it has not stopped.
    #[inline(never)]
    fn discard(&mut self, left: usize) {
        let begun_at = self.begun_at;
        self.rearm();
        if left > 1 {
            self.begun_at = begun_at;
        }
    }

    /// What had come to the bearing when the rotor still levitated, or, where that was not kept, until now.
    #[inline(never)]
    fn begin(&mut self, severity: &Severity<S>) {
        let (_, since) = self.lengths();
        match since {
            Some(_) => self.opening.become_as(&self.kept.severity),
            None => self.opening.become_as(severity),
        }
        self.coast_down |= self.opening.coast_down();
        self.dropped = core::mem::take(&mut self.dropping);
    }

    fn queue(&mut self, (sequence, mode): (u32, Mode), mut events: Events) {
        if self.lost {
            events |= Events::QUEUE_FULL;
        }
        let event = QueuedEvent {
            sequence,
            mode,
            events,
        };
        self.lost = self.queued.push_back(event).is_err();
    }

    /// Entries of a record, and how many of them are since the state that was kept.
    pub(crate) fn lengths(&self) -> (usize, Option<usize>) {
        let length = (self.written.wrapping_sub(self.begun_at) as usize).min(N);
        let since = self.written.wrapping_sub(self.kept_at) as usize;
        (length, (self.keeps && since <= length).then_some(since))
    }

    /// The configuration of the state, or, where none is of use, that of now.
    pub(crate) fn config(&self) -> &Config {
        let (_, since) = self.lengths();
        let [first, second] = &self.configs;
        let which = since.map_or(self.now, |_| self.kept_in);
        if which == 0 { first } else { second }
    }

    /// An entry of the record, 0 the oldest.
    pub(crate) fn entry(&self, index: usize) -> Option<&Entry> {
        let (length, _) = self.lengths();
        if index >= length {
            return None;
        }
        let oldest = (self.written as usize).wrapping_sub(length);
        self.entries.get(oldest.wrapping_add(index) & Self::MASK)
    }

    /// Whether it waits for an engagement.
    pub(crate) fn is_armed(&self) -> bool {
        self.progress == Progress::Armed
    }

    /// Whether there is a record to be read.
    pub(crate) fn is_frozen(&self) -> bool {
        self.progress == Progress::Frozen
    }

    pub(crate) fn rearm(&mut self) {
        if self.progress != Progress::Armed {
            self.progress = Progress::Armed;
            // What comes now does not follow what is there.
            (self.begun_at, self.due) = (self.written, 0);
            self.keeps = false;
            self.coast_down = false;
            self.track.clear();
        }
    }

    /// What comes now is of another event.
    pub(crate) fn part(&mut self, fastest: &mut Fastest<S>) {
        self.earlier = self.earlier.or(core::mem::take(fastest));
    }

    pub(crate) fn next_event(&mut self) -> Option<QueuedEvent> {
        self.queued.pop_front()
    }
}
