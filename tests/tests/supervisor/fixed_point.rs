//! Fixed point and `f32` against `f64` on the same samples: every stream of the catalogue of overloads, recorded from
//! its closed loop. Samples that are no numbers have no fixed-point form and are left out.
//!
//! Near a transition of the mode anything goes. One exception is known and counted: whether the levitation
//! controller is ready for the hand-over is a comparison of two noisy forces, and where both are as good as
//! equal for a tick one number begins a hand-over that another does not, and blends behind until it is done.

use firmware_studies::overloads::fault_matrix::SENSOR_FAULTS;
use std::sync::LazyLock;
use supervisor::{CoreCommand, Mode, Q, Scalar};
use system_tests::per_unit::{Stream, record};

/// Largest difference of forces \[caps\].
const ALLOWED: f64 = 0.01;
/// Ticks to either side of a transition in which anything goes.
const NEAR_TICKS: usize = 2;
/// What comes later repeats itself \[s\].
const LONGEST_S: f64 = 0.25;

/// Every stream at both control rates.
static STREAMS: LazyLock<Vec<Stream>> = LazyLock::new(|| {
    let is_number = |name: &str| !name.contains("not a number") && !name.contains("infinity");
    let at = |rate_hz| record(rate_hz, LONGEST_S, |_, case| is_number(&case.name));
    [10_000.0, 20_000.0].into_iter().flat_map(at).collect()
});

/// A tick that is not near a transition.
#[derive(Debug, Clone, Copy)]
struct Tick {
    /// A hand-over has begun in one number only, or at different ticks; or a sensor fault hands a difference on.
    handover_apart: bool,
    same_mode: bool,
    /// Length of the difference of the forces \[caps\].
    force: f64,
}

impl Tick {
    fn is_wrong(&self) -> bool {
        !self.same_mode || self.force > ALLOWED
    }
}

/// Whether ticks are within [`NEAR_TICKS`] of a transition of either.
fn near_transitions<S: Scalar>(a: &[CoreCommand<S>], b: &[CoreCommand<f64>]) -> Vec<bool> {
    let mut near = vec![false; a.len()];
    for i in 1..a.len() {
        if a[i].mode != a[i - 1].mode || b[i].mode != b[i - 1].mode {
            let until = (i + NEAR_TICKS + 1).min(a.len());
            near[i.saturating_sub(NEAR_TICKS)..until].fill(true);
        }
    }
    near
}

/// A number against `f64`, tick by tick.
fn compare<S: Scalar>(stream: &Stream) -> Vec<Tick> {
    let reference = stream.commands::<f64>().unwrap();
    let commands = stream.commands::<S>().unwrap();
    let near = near_transitions(&commands, &reference);
    let mut ticks = Vec::new();
    let (mut began, mut handover_apart, mut apart_before) = ([0; 2], false, false);
    let mut before = [Mode::Levitated; 2];
    for (i, (is, should)) in commands.iter().zip(&reference).enumerate() {
        let modes = [is.mode, should.mode];
        for n in 0..2 {
            if modes[n] == Mode::Handover && before[n] != Mode::Handover {
                began[n] = i;
            }
        }
        before = modes;
        let handing_over = modes.contains(&Mode::Handover);
        handover_apart = if modes[0] == modes[1] {
            // In a sensor fault the force of the tick before fades, as the mode before has it: a difference that was
            // there already is handed on.
            let fades_apart = modes[0] == Mode::SensorFault && (handover_apart || apart_before);
            fades_apart || handing_over && began[0] != began[1]
        } else {
            handover_apart || handing_over
        };
        let apart = [0, 1].map(|n| f64::from(is.force[n].to_f32()) - should.force[n]);
        let force = f64::hypot(apart[0], apart[1]);
        apart_before = force > ALLOWED;
        if !near[i] {
            ticks.push(Tick {
                handover_apart,
                same_mode: modes[0] == modes[1],
                force,
            });
        }
    }
    ticks
}

/// Counts over streams.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Count {
    streams: usize,
    ticks: usize,
    /// Streams with a wrong tick, excused or not.
    wrong_streams: usize,
    /// Wrong ticks: without an excuse, by the hand-over.
    wrong: usize,
    wrong_handover: usize,
    /// Largest difference of forces without an excuse \[caps\].
    largest: f64,
}

impl Count {
    /// Whether faults of all sensors are among them.
    fn are_all(&self) -> bool {
        self.streams > 1500 && self.ticks > 3_700_000
    }
}

/// All streams of some groups.
fn count<S: Scalar>(wanted: impl Fn(&str) -> bool) -> Count {
    let mut sum = Count::default();
    for stream in STREAMS.iter().filter(|s| wanted(s.group)) {
        let ticks = compare::<S>(stream);
        let wrong = |apart: bool| {
            let wrong = (ticks.iter()).filter(|t| t.handover_apart == apart && t.is_wrong());
            wrong.count()
        };
        let plain = ticks.iter().filter(|t| !t.handover_apart);
        sum.streams += 1;
        sum.ticks += ticks.len();
        sum.wrong_streams += usize::from(ticks.iter().any(Tick::is_wrong));
        sum.wrong += wrong(false);
        sum.wrong_handover += wrong(true);
        sum.largest = plain.map(|t| t.force).fold(sum.largest, f64::max);
    }
    println!("{sum:?}");
    sum
}

/// One test: the streams are recorded once.
#[test]
fn f32_and_fixed_point_command_what_f64_does() {
    f32_commands_what_f64_does();
    fixed_point_commands_what_f64_does();
    fixed_point_commands_what_f64_does_under_sensor_faults();
}

/// The yardstick: what 24 bits make of it. A fifth of what is allowed, at the most after a hand-over that was apart in a fault,
/// and a hand-over or two among all the faults.
fn f32_commands_what_f64_does() {
    let sound = count::<f32>(|group| group != SENSOR_FAULTS);
    assert_eq!(sound.wrong_streams, 0, "{sound:?}");
    let faulty = count::<f32>(|group| group == SENSOR_FAULTS);
    assert!(faulty.are_all(), "{faulty:?}");
    assert_eq!(faulty.wrong, 0, "{faulty:?}");
    let few = faulty.wrong_streams < 5 && faulty.wrong_handover < 100;
    assert!(few, "{faulty:?}");
    let largest = sound.largest.max(faulty.largest);
    assert!(largest > 1e-4 && largest < 2e-3, "{largest}");
}

/// With sound sensors: the same modes, and forces within 1 % of the cap, but in less than one stream of a hundred and
/// one tick of a thousand, where a hand-over or a rest begins at another tick and what follows from it differs.
fn fixed_point_commands_what_f64_does() {
    let sound = count::<Q>(|group| group != SENSOR_FAULTS);
    assert!(sound.streams > 1000 && sound.ticks > 2_400_000, "{sound:?}");
    assert!(100 * sound.wrong_streams < sound.streams, "{sound:?}");
    let wrong = sound.wrong + sound.wrong_handover;
    assert!(1000 * wrong < sound.ticks, "{sound:?}");
    assert!(sound.largest > 1e-3, "{sound:?}");
}

/// Under sensor faults noise more often decides at the edge: the same commands but for hand-overs in less than one
/// stream of fifty and one tick of a thousand, and for one tick of 500 000 in which two cases of the law meet.
fn fixed_point_commands_what_f64_does_under_sensor_faults() {
    let faulty = count::<Q>(|group| group == SENSOR_FAULTS);
    assert!(faulty.are_all(), "{faulty:?}");
    assert!(500_000 * faulty.wrong < faulty.ticks, "{faulty:?}");
    assert!(50 * faulty.wrong_streams < faulty.streams, "{faulty:?}");
    assert!(1000 * faulty.wrong_handover < faulty.ticks, "{faulty:?}");
}
