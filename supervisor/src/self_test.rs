//! Self-test at boot: a rotor of the test's own goes through every mode but `HandedBack`, and all commands have to be what
//! they were when this version was made. Compiler, processor and memory that compute otherwise fail it.

use crate::coeffs::Coeffs;
use crate::config::Config;
use crate::scalar::Scalar;
use crate::signal::{CoreSample, Events, Status};
use crate::tick::State;
use crate::vec2::Vec2;

/// What the test went through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelfTest {
    /// FNV-1a of the bits of all commands.
    pub hash: u32,
    /// One bit a mode.
    pub modes: u32,
    /// All that happened.
    pub events: Events,
}

/// Whether this processor computes what it should; some milliseconds.
pub fn self_test<S: Scalar>() -> bool {
    SelfTest::run::<S>().hash == S::KNOWN_ANSWER
}

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
    thermal_time_s: 0.05,
    speed_max_m_s: 2.0,
    ..Config::example()
};

/// What the rotor of the test does.
#[derive(Clone, Copy)]
enum Story {
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

const AS_USUAL: Status = Status::SPIN_VALID.union(Status::BEARING_ON);

/// For so many ticks, with this status. A force that is measured is that of a drive which inverts x.
const STORIES: [(u32, Story, Status); 8] = [
    (40, Story::Centre, AS_USUAL),
    (60, Story::Flight, AS_USUAL),
    (80, Story::Whirl, AS_USUAL),
    (60, Story::Whirl, AS_USUAL.union(Status::APPLIED_VALID)),
    (60, Story::Rest, AS_USUAL),
    (30, Story::Nonsense, AS_USUAL),
    (20, Story::Flight, AS_USUAL.union(Status::SHADOW)),
    (160, Story::Centre, AS_USUAL),
];

impl SelfTest {
    /// Runs the test and says what came out.
    pub fn run<S: Scalar>() -> Self {
        // Without a recorder, which computes nothing.
        let (coeffs, _) = Coeffs::<S>::new(&CONFIG);
        let mut state = State::default();
        let mut result = Self {
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
                    Story::Flight if position.exceeds(S::from_f32(1.01)) => {
                        position * S::from_f32(0.97)
                    }
                    Story::Flight => position + step,
                    Story::Whirl => {
                        let onto = S::from_f32(1.01) * position.inverse_length();
                        position.rotated(turn) * onto
                    }
                    Story::Rest => Vec2::new(S::ZERO, S::from_f32(-1.005)),
                    Story::Nonsense => Vec2::new(S::from_f32(5.0), S::ZERO),
                    Story::Centre => position * S::from_f32(0.98),
                };
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let ripple = S::count(noise >> 24) * S::from_f32(1e-5);
                let seen = position + Vec2::new(ripple, -ripple);
                let sample = CoreSample {
                    sequence,
                    status,
                    position: seen.to_array(),
                    // Quick enough for an unbalance.
                    spin: S::from_f32(2.0),
                    levitation: (position * S::from_f32(-0.5)).to_array(),
                    applied,
                };
                let command = state.tick(&sample, &(), &coeffs);
                sequence = sequence.wrapping_add(1);
                result.modes |= 1 << (command.mode as u32);
                result.events |= command.events;
                let [x, y] = command.force;
                applied = [-x, y];
                let own = command.own.map(S::bits);
                let numbers = [x.bits(), y.bits(), command.severity.bits()];
                let (mode, hint) = (command.mode as u32, command.integrator as u32);
                let said = [mode, hint, command.limits.bits(), command.events.bits()];
                for word in own.into_iter().chain(numbers).chain(said) {
                    result.hash = (result.hash ^ word).wrapping_mul(0x0100_0193);
                }
            }
        }
        result
    }
}
