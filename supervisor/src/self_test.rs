//! Self-test at boot: a rotor of the test's own goes through every mode but `HandedBack`, and all commands have to be what
//! they were when this version was made. Compiler, processor and memory that compute otherwise fail it.
//!
//! It runs in the place of the supervisor that it is asked of, by the very tick that firmware calls: what drives the magnet is
//! what was tested, and flash holds it once.

use crate::border::config::Config;
use crate::border::parts::ALL;
use crate::border::shaft::{PlanePositions, Shaft};
use crate::border::signal::{Command, CoreCommand, CoreSample, Events, Sample, Status};
use crate::check::Check;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::per_unit::{Core, Prepared};
use crate::rotor::ticker::RotorTicker;
use crate::rotor::two_planes::RotorSupervisor;
use crate::supervisor::{CoreTicker, Supervisor, Ticker};

/// What the test went through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub struct SelfTest {
    /// Whether this processor computes what it should.
    pub passed: bool,
    /// FNV-1a of the bits of all commands.
    pub hash: u32,
    /// One bit a mode.
    pub modes: u32,
    /// All that happened.
    pub events: Events,
}

/// Hash of what a [`Supervisor`] commands, and a [`Ticker`].
const IN_NEWTONS: [u32; 2] = [0x3DC8_8487, 0xB0EF_3D67];
/// Of what a [`RotorSupervisor`] commands for its first plane and its second.
const OF_ROTOR: [u32; 2] = [0xF5A3_49E9, 0x99CD_40A3];

/// The example with some damping, caps of the axes and a quick budget.
const CONFIG: Config = Config {
    damping_n_s_m: 10.0,
    observer_pole_flight: 0.5,
    observer_pole_contact: 0.2,
    position_limit: 4.0,
    handover_blend_s: 1e-3,
    fault_blend_s: 1e-3,
    fault_ticks: 10.0,
    axis_force_max_n: 900.0,
    // What is left out is not tested.
    continuous_force_n: if ALL { 400.0 } else { 1000.0 },
    thermal_time_s: 0.05,
    speed_max_m_s: 2.0,
    ..Config::example()
};

/// A gyroscopic rotor, for a test of two planes.
const SHAFT: Shaft = Shaft {
    mass_kg: 20.0,
    transverse_inertia_kg_m2: 0.8,
    polar_inertia_kg_m2: 0.6,
    places: [end_at(-0.2), end_at(0.2)],
};

const fn end_at(place_m: f32) -> PlanePositions {
    PlanePositions {
        retainer_m: place_m,
        sensor_m: place_m,
        magnet_m: 0.8 * place_m,
    }
}

/// What the rotor of the test does.
#[derive(Clone, Copy)]
enum Scenario {
    /// Flies on.
    Flight,
    /// Slides round the clearance.
    Whirl,
    /// Lies on the bearing.
    Rest,
    /// Is somewhere no rotor can be.
    Nonsense,
    /// Is in the centre.
    Centre,
}

const AS_USUAL: Status = Status::SPIN_VALID
    .union(Status::BEARING_ON)
    .union(Status::LEVITATED_BEFORE);

/// Where the force is measured, and a drive can be judged.
const MEASURED: Status = if ALL {
    AS_USUAL.union(Status::APPLIED_VALID)
} else {
    AS_USUAL
};

/// For so many ticks, with this status. A force that is measured is that of a drive which inverts x.
const STORIES: [(u32, Scenario, Status); 8] = [
    (40, Scenario::Centre, AS_USUAL),
    (60, Scenario::Flight, AS_USUAL),
    (80, Scenario::Whirl, AS_USUAL),
    (60, Scenario::Whirl, MEASURED),
    (60, Scenario::Rest, AS_USUAL),
    (30, Scenario::Nonsense, AS_USUAL),
    (20, Scenario::Flight, AS_USUAL.union(Status::SHADOW)),
    (160, Scenario::Centre, AS_USUAL),
];

impl SelfTest {
    /// Goes through all stories with whatever answers a sample of the first plane, for each of its planes. Forces that are
    /// measured come as they were answered.
    fn run<S: Scalar, const PLANES: usize>(
        known_answers: [u32; 2],
        mut tick: impl FnMut(&CoreSample<S>) -> [CoreCommand<S>; PLANES],
    ) -> Self {
        let mut result = Self {
            passed: false,
            hash: 0x811C_9DC5,
            modes: 0,
            events: Events::empty(),
        };
        let mut position = Vec2::new(S::from_f32(0.01), S::from_f32(-0.02));
        let turn = Vec2::new(S::from_f32(0.996_2), S::from_f32(-0.087_2));
        let step = Vec2::new(S::from_f32(0.05), S::from_f32(0.02));
        let (mut sequence, mut applied) = (0, [S::ZERO; 2]);
        let mut noise = 1_u32;
        for (ticks, story, status) in STORIES {
            for _ in 0..ticks {
                position = match story {
                    Scenario::Flight if position.exceeds(S::from_f32(1.01)) => {
                        position * S::from_f32(0.97)
                    }
                    Scenario::Flight => position + step,
                    Scenario::Whirl => {
                        let onto = S::from_f32(1.01) * position.inverse_length();
                        position.rotated(turn) * onto
                    }
                    Scenario::Rest => Vec2::new(S::ZERO, S::from_f32(-1.005)),
                    Scenario::Nonsense => Vec2::new(S::from_f32(5.0), S::ZERO),
                    Scenario::Centre => position * S::from_f32(0.98),
                };
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let ripple = S::count(noise >> 24) * S::from_f32(1e-5);
                let seen = position + Vec2::new(ripple, -ripple);
                let sample = CoreSample {
                    sequence,
                    status,
                    position: seen.to_array(),
                    // Quick enough for an unbalance, or too slow.
                    spin: S::from_f32(if ALL { 2.0 } else { 0.5 }),
                    levitation: (position * S::from_f32(-0.5)).to_array(),
                    applied,
                };
                sequence = sequence.wrapping_add(1);
                for (plane, command) in (0..).zip(tick(&sample)) {
                    result.add(&command);
                    if plane == 0 {
                        let [x, y] = command.force;
                        applied = [-x, y];
                    }
                }
            }
        }
        let [with_all, without] = known_answers;
        result.passed = result.hash == if ALL { with_all } else { without };
        result
    }

    fn add<S: Scalar>(&mut self, command: &CoreCommand<S>) {
        self.modes |= 1 << (command.mode as u32);
        self.events |= command.events;
        let [force, own] = [command.force, command.own].map(|v| v.map(S::bits));
        let (mode, hint) = (command.mode as u32, command.integrator as u32);
        let flags = [mode, hint, command.limits.bits(), command.events.bits()];
        let words = (own.into_iter().chain(force)).chain([command.severity.bits()]);
        for word in words.chain(flags) {
            self.hash = (self.hash ^ word).wrapping_mul(0x0100_0193);
        }
    }
}

/// A sample of the test's bearing in SI.
fn in_metres(sample: &CoreSample<f32>) -> Sample {
    let scaling = CONFIG.scaling();
    Sample {
        sequence: sample.sequence,
        status: sample.status,
        position_m: sample.position.map(|x| x * scaling.length_m),
        spin_rad_s: sample.spin / scaling.time_s,
        levitation_n: sample.levitation.map(|x| x * scaling.force_n),
        applied_n: sample.applied,
    }
}

/// The second end goes the other way, at half of the size.
fn at_both_ends(sample: &CoreSample<f32>) -> [Sample; 2] {
    let first = in_metres(sample);
    let other_way = |v: [f32; 2]| v.map(|x| -0.5 * x);
    let second = Sample {
        position_m: other_way(first.position_m),
        levitation_n: other_way(first.levitation_n),
        ..first
    };
    [first, second]
}

/// A command as it goes into the hash.
fn answer(command: Command) -> CoreCommand<f32> {
    CoreCommand {
        force: command.force_n,
        own: command.own_n,
        mode: command.mode,
        limits: command.limits,
        events: command.events,
        integrator: command.integrator,
        severity: command.severity,
    }
}

fn prepared<S: Scalar>() -> Prepared<S> {
    let (prepared, _) = Prepared::from_valid(&CONFIG);
    prepared
}

impl<S: Scalar, const RECORD: usize> Core<S, RECORD> {
    /// Whether this processor computes what it should: a rotor of the test's own goes through its story by [`Self::tick`], in
    /// some milliseconds. For the boot, before the first sample: what was remembered is forgotten, and the core is as new. No
    /// event and no record comes of it.
    pub fn self_test(&mut self) -> SelfTest {
        let kept = self.plane.begin_test(&prepared());
        let result = SelfTest::run(S::KNOWN_ANSWERS, |sample| [self.tick(sample)]);
        self.plane.end_test(&self.shared, kept);
        result
    }
}

impl<S: Scalar, const RECORD: usize> CoreTicker<'_, S, RECORD> {
    /// As [`Core::self_test`], by [`Self::tick`], which publishes the modes of the test meanwhile.
    pub fn self_test(&mut self) -> SelfTest {
        let kept = self.plane.begin_test(&prepared());
        let result = SelfTest::run(S::KNOWN_ANSWERS, |sample| [self.tick(sample)]);
        self.plane.end_test(self.shared, kept);
        self.plane.publish(self.shared, true);
        result
    }
}

impl<const RECORD: usize> Supervisor<RECORD> {
    /// As [`Core::self_test`], by [`Self::tick`].
    pub fn self_test(&mut self) -> SelfTest {
        let kept = self.core.plane.begin_test(&prepared());
        let check = core::mem::replace(&mut self.check, Check::off());
        let result = SelfTest::run(IN_NEWTONS, |sample| {
            [self.tick(&in_metres(sample))].map(answer)
        });
        self.check = check;
        self.core.plane.end_test(&self.core.shared, kept);
        result
    }
}

impl<const RECORD: usize> Ticker<'_, RECORD> {
    /// As [`Core::self_test`], by [`Self::tick`], which publishes the modes of the test meanwhile.
    pub fn self_test(&mut self) -> SelfTest {
        let kept = self.core.plane.begin_test(&prepared());
        let check = core::mem::replace(self.check, Check::off());
        let result = SelfTest::run(IN_NEWTONS, |sample| {
            [self.tick(&in_metres(sample))].map(answer)
        });
        *self.check = check;
        let CoreTicker { plane, shared } = &mut self.core;
        plane.end_test(shared, kept);
        plane.publish(shared, true);
        result
    }
}

impl<const RECORD: usize> RotorSupervisor<RECORD> {
    /// As [`Core::self_test`], by [`Self::tick`]: both planes, and what they know of each other.
    pub fn self_test(&mut self) -> SelfTest {
        let kept = self.ticker().begin_test(&SHAFT, &CONFIG);
        let result = SelfTest::run(OF_ROTOR, |sample| {
            self.tick(&at_both_ends(sample)).planes.map(answer)
        });
        self.ticker().end_test(kept);
        result
    }
}

impl<const RECORD: usize> RotorTicker<'_, RECORD> {
    /// As [`RotorSupervisor::self_test`], by [`Self::tick`], which publishes the modes of the test meanwhile.
    pub fn self_test(&mut self) -> SelfTest {
        let kept = self.begin_test(&SHAFT, &CONFIG);
        let result = SelfTest::run(OF_ROTOR, |sample| {
            self.tick(&at_both_ends(sample)).planes.map(answer)
        });
        self.end_test(kept);
        self.publish(true);
        result
    }
}
