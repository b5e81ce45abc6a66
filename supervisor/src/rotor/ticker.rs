//! The half of a rotor's supervisor that ticks, both planes at once or one after the other.

use crate::border::coeffs::Coeffs;
use crate::border::config::Config;
use crate::border::shaft::{Shaft, ShaftError};
use crate::border::signal::{Command, CoreCommand, CoreSample, Events, Sample, Status};
use crate::check::{Check, Seen};
use crate::estimate::neighbour::PlaneState;
use crate::number::words::{Cells, Words};
use crate::per_unit::{Plane, Prepared};
use crate::record::recorder::{self, Shared};
use crate::rotor::coupling::{Coupling, spin};
use crate::supervisor::in_newtons;

/// What both planes commanded at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RotorCommand {
    /// Each plane its own.
    pub planes: [Command; 2],
    /// For each plane, whether the other one has engaged since the records were read: hold back what would disturb now
    /// (excitation, a set-down, a reconfiguration).
    pub other_engaged: [bool; 2],
    /// One plane has asked for the machine to be run down. Stays until [`crate::RotorSupervisor::new`].
    pub coast_down: bool,
}

/// The shaft when the states of both planes were kept.
pub(crate) type KeptShaft = Cells<9>;

/// What is of the machine and not of a plane.
#[derive(Debug, Clone)]
pub(crate) struct MachineState {
    shaft: Shaft,
    couplings: [Coupling; 2],
    /// Planes that have engaged since the records were read.
    engaged: [bool; 2],
    coast_down: bool,
    /// Which plane the check looks at, and how often it had come to an end there before.
    second_checked: bool,
    attempts: u8,
}

impl MachineState {
    /// Of configurations with the masses and ratios that they are to have.
    ///
    /// # Errors
    /// [`ShaftError`].
    pub(super) fn new(shaft: &Shaft, configs: &[Config; 2]) -> Result<Self, ShaftError> {
        Ok(Self {
            couplings: Coupling::of_checked(shaft, configs)?,
            shaft: *shaft,
            engaged: [false; 2],
            coast_down: false,
            second_checked: false,
            attempts: 0,
        })
    }
}

/// A tick of which the first plane has had its half: what the second plane's needs of it, see [`RotorTicker::tick_first`].
///
/// A half whose other one never comes leaves the records of both planes a tick apart.
#[derive(Debug, Clone, Copy)]
#[must_use = "the second plane waits for its half"]
pub struct HalfTick {
    /// What the first plane commands, but for events of its record: those come with the second half.
    pub command: Command,
    per_unit: CoreSample<f32>,
    /// As the sample had it: the check looks at ticks that it does not let through.
    status: Status,
    half: HalfPerUnit,
}

/// The same per unit.
#[derive(Debug, Clone, Copy)]
struct HalfPerUnit {
    command: CoreCommand<f32>,
    seen: recorder::Seen,
    /// Both planes before it.
    ends: [PlaneState<f32>; 2],
}

/// What a test has to give back.
pub(crate) struct SavedState {
    machine: MachineState,
    coeffs: [Coeffs<f32>; 2],
    checks: [Check; 2],
}

/// The half of a [`crate::RotorSupervisor`] that ticks: for the control interrupt, or whatever owns the bearings.
#[derive(Debug)]
pub struct RotorTicker<'a, const RECORD: usize = 512> {
    pub(super) machine: &'a mut MachineState,
    pub(super) planes: [&'a mut Plane<f32>; 2],
    pub(super) checks: [&'a mut Check; 2],
    pub(super) shared: [&'a Shared<RECORD>; 2],
    pub(super) kept_shaft: &'a KeptShaft,
}

impl<const RECORD: usize> RotorTicker<'_, RECORD> {
    /// As [`crate::RotorSupervisor::tick`]; the reader sees what has come of it from then on.
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, samples: &[Sample; 2]) -> RotorCommand {
        let command = self.ticked(samples);
        self.publish_in_turn(&command);
        command
    }

    /// As [`crate::RotorSupervisor::reconfigure`]: between two ticks.
    ///
    /// # Errors
    /// [`ShaftError`]; then nothing has changed.
    pub fn reconfigure(&mut self, shaft: &Shaft, configs: &[Config; 2]) -> Result<(), ShaftError> {
        let [first, second] = configs;
        self.reconfigured(shaft, [first, second])?;
        self.publish(true);
        Ok(())
    }

    pub(super) fn reconfigured(
        &mut self,
        shaft: &Shaft,
        [first, second]: [&Config; 2],
    ) -> Result<(), ShaftError> {
        let configs = [shaft.plane(0, first), shaft.plane(1, second)];
        self.machine.couplings = Coupling::of_checked(shaft, &configs)?;
        self.machine.shaft = *shaft;
        for (plane, config) in self.planes.iter_mut().zip(&configs) {
            // Checked above.
            let (prepared, _) = Prepared::from_valid(config);
            plane.reconfigure(&prepared);
        }
        for ((check, shared), config) in self.checks.iter_mut().zip(self.shared).zip(&configs) {
            **check = Check::new(config);
            check.begin(&shared.checked);
        }
        Ok(())
    }

    /// For a test in its place, see [`Plane::begin_test`]: another shaft and both planes alike.
    pub(crate) fn begin_test(&mut self, shaft: &Shaft, config: &Config) -> SavedState {
        let configs = [shaft.plane(0, config), shaft.plane(1, config)];
        let kept = self.machine.clone();
        if let Ok(couplings) = Coupling::of_checked(shaft, &configs) {
            self.machine.couplings = couplings;
        }
        let [first, second] = &mut self.planes;
        let [to_first, to_second] = configs.map(|config| Prepared::from_valid(&config).0);
        let [check, other] = &mut self.checks;
        SavedState {
            machine: kept,
            coeffs: [first.begin_test(&to_first), second.begin_test(&to_second)],
            checks: [check, other].map(|check| core::mem::replace(*check, Check::off())),
        }
    }

    /// After it, as new.
    pub(crate) fn end_test(&mut self, kept: SavedState) {
        *self.machine = MachineState {
            engaged: [false; 2],
            coast_down: false,
            ..kept.machine
        };
        let planes = self.planes.iter_mut().zip(self.shared);
        (planes.zip(kept.coeffs))
            .for_each(|((plane, shared), coeffs)| plane.end_test(shared, coeffs));
        (self.checks.iter_mut().zip(kept.checks)).for_each(|(check, kept)| **check = kept);
    }

    pub(crate) fn publish(&self, with_units: bool) {
        let pairs = self.planes.iter().zip(self.shared);
        pairs.for_each(|(plane, shared)| plane.publish(shared, with_units));
    }

    pub(super) fn rearm(&mut self) {
        let pairs = self.planes.iter_mut().zip(self.shared);
        pairs.for_each(|(plane, shared)| plane.rearm(shared));
        self.machine.engaged = [false; 2];
    }

    /// The first plane's half of a tick, for firmware that has no time for both in one period of its loop: this one in one
    /// period, [`Self::tick_second`] in the next. Each plane's `sample_period_s` is then two periods.
    ///
    /// Command [`HalfTick::command`] at once. Both halves together are to the bit a [`Self::tick`] of the same samples.
    // One copy, whoever calls it.
    #[inline(never)]
    pub fn tick_first(&mut self, sample: &Sample) -> HalfTick {
        self.first_half(sample)
    }

    /// The second plane's half, with a sample of now that has the number of the first one's; the outcome of the tick as a whole.
    #[inline(never)]
    pub fn tick_second(&mut self, half: &HalfTick, sample: &Sample) -> RotorCommand {
        let command = self.second_half(half, sample);
        self.publish_in_turn(&command);
        command
    }

    #[inline]
    fn publish_in_turn(&mut self, command: &RotorCommand) {
        let planes = self.planes.iter_mut().zip(self.shared);
        for ((plane, shared), to) in planes.zip(&command.planes) {
            plane.publish_in_turn(shared, to.mode, to.events);
        }
    }

    #[inline]
    pub(super) fn ticked(&mut self, [at_first, at_second]: &[Sample; 2]) -> RotorCommand {
        let half = self.first_half(at_first);
        self.second_half(&half, at_second)
    }

    /// In the units of a plane, and with what the check lets through: one plane that contradicts, and neither acts.
    #[inline]
    fn admitted(&self, end: usize, sample: &Sample) -> CoreSample<f32> {
        let [check, other] = &self.checks;
        let watching = if check.is_open() { other } else { check };
        let [first, second] = &self.planes;
        let plane = if end == 0 { first } else { second };
        let mut per_unit = plane.scaling().sample(sample);
        per_unit.status = watching.admitted(per_unit.status);
        per_unit
    }

    #[inline]
    pub(super) fn first_half(&mut self, sample: &Sample) -> HalfTick {
        let per_unit = self.admitted(0, sample);
        let half = self.first_per_unit(&per_unit);
        let [first, _] = &self.planes;
        HalfTick {
            command: in_newtons(first.scaling(), sample, &per_unit, &half.command),
            per_unit,
            status: sample.status,
            half,
        }
    }

    #[inline]
    pub(super) fn second_half(&mut self, first_half: &HalfTick, sample: &Sample) -> RotorCommand {
        let per_unit = self.admitted(1, sample);
        let [to_first, to_second] =
            self.second_per_unit(&first_half.half, [&first_half.per_unit, &per_unit]);
        if !self.checks.iter().all(|check| check.is_over()) {
            let of_first = CoreSample {
                status: first_half.status,
                ..first_half.per_unit
            };
            let of_second = CoreSample {
                status: sample.status,
                ..per_unit
            };
            self.watch([&of_first, &of_second]);
        }
        let [_, second] = &self.planes;
        let planes = [
            Command {
                events: to_first.events,
                ..first_half.command
            },
            in_newtons(second.scaling(), sample, &per_unit, &to_second),
        ];
        let machine = &mut *self.machine;
        for ((engaged, plane), command) in machine.engaged.iter_mut().zip(&self.planes).zip(&planes)
        {
            let engages = command.mode.is_engaged();
            // Over, and nothing was worth a record.
            let leaves_nothing = !engages && plane.is_armed();
            *engaged = (*engaged || engages) && !leaves_nothing;
            machine.coast_down |= command.events.contains(Events::COAST_DOWN);
        }
        let [first, second] = machine.engaged;
        RotorCommand {
            planes,
            other_engaged: [second, first],
            coast_down: machine.coast_down,
        }
    }

    /// The check looks at a tick of one plane, until it has come to an end there, and then of the other.
    #[cold]
    #[inline(never)]
    fn watch(&mut self, [at_first, at_second]: [&CoreSample<f32>; 2]) {
        let [check, other] = &mut self.checks;
        let [first, second] = &self.planes;
        let ends = [first.plane_state(), second.plane_state()];
        let MachineState {
            couplings: [to_first, to_second],
            second_checked,
            attempts,
            ..
        } = &mut *self.machine;
        let [of_first, of_second] = self.shared;
        let seen = |plane: &Plane<f32>, sample: &CoreSample<f32>, coupling: &Coupling, beside| {
            let coeffs = plane.coeffs();
            let around = coupling.coupling(&ends, beside, spin(sample));
            let (levitated, by_force) = plane.levitates();
            let acceleration = by_force + around.gained(coeffs.tick) * coeffs.per_tick;
            Seen::new(sample, (levitated, acceleration), coeffs)
        };
        let (looked_at, waits) = if *second_checked {
            let seen = seen(second, at_second, to_second, &ends[0]);
            other.watch(&of_second.checked, &seen);
            (other, check)
        } else {
            let seen = seen(first, at_first, to_first, &ends[1]);
            check.watch(&of_first.checked, &seen);
            (check, other)
        };
        if looked_at.is_over() || looked_at.attempts() != *attempts {
            looked_at.pause();
            *second_checked = !*second_checked;
            *attempts = waits.attempts();
        }
    }

    /// What firmware adds to the forces that it asks for next \[N\]; as [`crate::Supervisor::stimulus_n`], of one plane after the other.
    pub fn stimulus_n(&self) -> [[f32; 2]; 2] {
        let [check, other] = &self.checks;
        let [first, second] = &self.planes;
        let newtons = |check: &Check, plane: &Plane<f32>| {
            (check.stimulus()).map(|force| force * plane.scaling().force_n)
        };
        [newtons(check, first), newtons(other, second)]
    }

    #[inline]
    pub(super) fn per_unit(
        &mut self,
        [at_first, at_second]: &[CoreSample<f32>; 2],
    ) -> [CoreCommand<f32>; 2] {
        let half = self.first_per_unit(at_first);
        self.second_per_unit(&half, [at_first, at_second])
    }

    #[inline]
    fn first_per_unit(&mut self, sample: &CoreSample<f32>) -> HalfPerUnit {
        // Both are given back, one after the other.
        let mut pairs = self.planes.iter().zip(self.shared);
        if pairs.all(|(plane, shared)| plane.is_back(shared)) {
            self.rearm();
        }
        let [first, second] = &mut self.planes;
        let [coupling, _] = &self.machine.couplings;
        // As they are before either tick.
        let ends = [first.plane_state(), second.plane_state()];
        let beside = coupling.coupling(&ends, &ends[1], spin(sample));
        let [shared, _] = self.shared;
        let (command, seen) = first.tick_beside(shared, sample, &beside);
        HalfPerUnit {
            command,
            seen,
            ends,
        }
    }

    #[inline]
    fn second_per_unit(
        &mut self,
        half: &HalfPerUnit,
        samples: [&CoreSample<f32>; 2],
    ) -> [CoreCommand<f32>; 2] {
        let [_, second] = &mut self.planes;
        let [_, coupling] = &self.machine.couplings;
        let [_, sample] = samples;
        let beside = coupling.coupling(&half.ends, &half.ends[0], spin(sample));
        let [_, shared] = self.shared;
        let (command, seen) = second.tick_beside(shared, sample, &beside);
        // One event of one machine: both planes record it, over the same ticks.
        let (mut commands, seen) = ([half.command, command], half.seen.or(seen));
        let planes = self.planes.iter_mut().zip(self.shared);
        for (((plane, shared), command), sample) in planes.zip(&mut commands).zip(samples) {
            command.events |= plane.advance(shared, seen, sample, command.mode);
        }
        // Both or none: a replay needs what both remembered before the same tick.
        if self.planes.iter().all(|plane| plane.may_keep()) {
            let planes = self.planes.iter_mut().zip(self.shared);
            planes.for_each(|(plane, shared)| plane.keep(shared));
            self.machine
                .shaft
                .values()
                .write_cells(self.kept_shaft.all(), 0);
        }
        commands
    }
}
