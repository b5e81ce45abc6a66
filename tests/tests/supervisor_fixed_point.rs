//! Fixed point and `f32` against `f64` on the same samples: every stream of the catalogue of overloads, recorded from
//! its closed loop. Samples that are no numbers have no fixed-point form and are left out.
//!
//! Near a transition of the mode anything goes. Fixed point has two more exceptions, which are counted:
//! it follows no speed above 20 lift-off speeds, where whirl is far beyond what any force can stop; and whether
//! the levitation controller is ready for the hand-over is a comparison of two noisy forces, so a
//! hand-over may begin at another tick, and blends behind until it is done.

use std::sync::LazyLock;
use supervisor::{Core, CoreCommand, Mode, Prepared, Q, Scalar};
use system_tests::per_unit::{Stream, record};

/// Largest difference of forces \[caps\].
const ALLOWED: f64 = 0.01;
/// Ticks to either side of a transition in which anything goes.
const NEAR_TICKS: usize = 2;
/// Backward speed that fixed point follows, position taking its share \[lift-off speeds\].
const FOLLOWED: f64 = 19.5;
/// Ticks in which the observer forgets that it could not follow.
const SETTLED_TICKS: usize = 100;
/// What comes later repeats itself \[s\].
const LONGEST_S: f64 = 0.25;

/// Every stream at both control rates.
static STREAMS: LazyLock<Vec<Stream>> = LazyLock::new(|| {
    let is_number = |name: &str| !name.contains("not a number") && !name.contains("infinity");
    [10_000.0, 20_000.0]
        .into_iter()
        .flat_map(|rate_hz| record(rate_hz, LONGEST_S, |_, case| is_number(&case.name)))
        .collect()
});

/// What stands in the way of the same command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Excuse {
    None,
    /// Whirl faster than fixed point follows.
    Fast,
    /// A hand-over that has begun in one number only, or at different ticks.
    Handover,
}

/// A tick that is not near a transition.
#[derive(Debug, Clone, Copy)]
struct Tick {
    excuse: Excuse,
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
    let report = Core::<f64, 64>::new(&Prepared::new(&stream.config).unwrap()).report();
    let whirl_limit = f64::from(report.whirl_limit_m_s / stream.config.scaling().speed_m_s);
    let mut ticks = Vec::new();
    let (mut fast_until, mut began, mut handover_apart) = (0, [0; 2], false);
    let mut before = [Mode::Levitated; 2];
    for (i, (is, should)) in commands.iter().zip(&reference).enumerate() {
        // In contact the severity is the backward speed.
        if should.severity * whirl_limit > FOLLOWED {
            fast_until = i + SETTLED_TICKS;
        }
        let modes = [is.mode, should.mode];
        for n in 0..2 {
            if modes[n] == Mode::Handover && before[n] != Mode::Handover {
                began[n] = i;
            }
        }
        before = modes;
        let handing_over = modes.contains(&Mode::Handover);
        handover_apart = if modes[0] == modes[1] {
            handing_over && began[0] != began[1]
        } else {
            handover_apart || handing_over
        };
        let apart = [0, 1].map(|n| f64::from(is.force[n].to_f32()) - should.force[n]);
        if !near[i] {
            ticks.push(Tick {
                excuse: match (i < fast_until, handover_apart) {
                    (true, _) => Excuse::Fast,
                    (false, true) => Excuse::Handover,
                    (false, false) => Excuse::None,
                },
                same_mode: modes[0] == modes[1],
                force: f64::hypot(apart[0], apart[1]),
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
    /// Wrong ticks: without an excuse, in fast whirl, by the hand-over.
    wrong: usize,
    wrong_fast: usize,
    wrong_handover: usize,
    /// Largest difference of forces without an excuse \[caps\].
    largest: f64,
}

/// All streams of some groups.
fn count<S: Scalar>(wanted: impl Fn(&str) -> bool) -> Count {
    let mut sum = Count::default();
    for stream in STREAMS.iter().filter(|s| wanted(s.group)) {
        let ticks = compare::<S>(stream);
        let wrong = |excuse: Excuse| {
            let wrong = ticks.iter().filter(|t| t.excuse == excuse && t.is_wrong());
            wrong.count()
        };
        let plain = ticks.iter().filter(|t| t.excuse == Excuse::None);
        sum.streams += 1;
        sum.ticks += ticks.len();
        sum.wrong_streams += usize::from(ticks.iter().any(Tick::is_wrong));
        sum.wrong += wrong(Excuse::None);
        sum.wrong_fast += wrong(Excuse::Fast);
        sum.wrong_handover += wrong(Excuse::Handover);
        sum.largest = plain.map(|t| t.force).fold(sum.largest, f64::max);
    }
    println!("{sum:?}");
    sum
}

const SENSOR_FAULTS: &str = "sensor faults";

/// The yardstick: what 24 bits make of it. No exception at all, and a tenth of what is allowed.
#[test]
fn f32_commands_what_f64_does() {
    let all = count::<f32>(|_| true);
    assert_eq!(all.wrong_streams, 0, "{all:?}");
    assert!(all.streams > 2500 && all.ticks > 6_000_000, "{all:?}");
    assert!(all.largest > 1e-4 && all.largest < 1e-3, "{all:?}");
}

/// With sound sensors: the same modes, and forces within 1 % of the cap, but for runaway whirl and one hand-over in
/// a thousand streams.
#[test]
fn fixed_point_commands_what_f64_does() {
    let sound = count::<Q>(|group| group != SENSOR_FAULTS);
    assert!(sound.streams > 1000 && sound.ticks > 2_400_000, "{sound:?}");
    assert_eq!(sound.wrong, 0, "{sound:?}");
    assert!(sound.largest > 1e-3 && sound.largest < ALLOWED, "{sound:?}");
    assert!(sound.wrong_fast > 0 && sound.wrong_fast < 2500, "{sound:?}");
    assert!(sound.wrong_handover < 50, "{sound:?}");
}

/// Under sensor faults a jump may be one that fixed point cannot follow, and noise decides at the edge: the same
/// commands in all but one stream of twenty, and in all but one tick of a thousand.
#[test]
fn fixed_point_commands_what_f64_does_under_sensor_faults() {
    let faulty = count::<Q>(|group| group == SENSOR_FAULTS);
    assert!(
        faulty.streams > 1500 && faulty.ticks > 3_700_000,
        "{faulty:?}"
    );
    let wrong = faulty.wrong + faulty.wrong_fast + faulty.wrong_handover;
    assert!(20 * faulty.wrong_streams < faulty.streams, "{faulty:?}");
    assert!(1000 * wrong < faulty.ticks, "{faulty:?}");
    assert!(faulty.wrong < 100, "{faulty:?}");
}
