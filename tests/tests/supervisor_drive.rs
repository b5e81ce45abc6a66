//! A drive that does not do what it is told, where its force is measured: what is noticed, what is not, and what follows.

use proptest::prelude::*;
use supervisor::{Config, Events, Mode, Sample, Status, Supervisor};
use system_tests::rig::{RADIUS_M, WHIRL_STEP, config, on_circle, sample};

/// What a drive makes of a command \[N\].
type Makes = fn([f32; 2]) -> [f32; 2];

/// A supervisor on a rotor that whirls on the wall, with an amplifier behind it.
struct Bench {
    supervisor: Supervisor<64>,
    sequence: u32,
    /// Commands on their way, the oldest first.
    line: Vec<[f32; 2]>,
    lag_s: f32,
    delivered_n: [f32; 2],
}

impl Bench {
    fn new(config: &Config, lag_s: f32, delay: usize) -> Self {
        Self {
            supervisor: Supervisor::new(config).unwrap(),
            sequence: 0,
            line: vec![[0.0; 2]; delay],
            lag_s,
            delivered_n: [0.0; 2],
        }
    }

    /// A tick; the axes that are not lost get what the drive makes of the command.
    fn tick(&mut self, makes: Makes, status: Status) -> supervisor::Command {
        self.sequence += 1;
        let position_m = on_circle(RADIUS_M, WHIRL_STEP * self.sequence as f32);
        let mut now = sample(self.sequence, position_m);
        now.status |= status;
        let command = self.supervisor.tick(&Sample {
            applied_n: self.delivered_n,
            ..now
        });
        self.line.push(command.force_n);
        let wanted = makes(self.line.remove(0));
        self.deliver(wanted);
        command
    }

    /// A tick of the amplifier.
    fn deliver(&mut self, wanted_n: [f32; 2]) {
        let left = (-50e-6 / self.lag_s).exp();
        for (delivered_n, to) in self.delivered_n.iter_mut().zip(wanted_n) {
            *delivered_n = to + (*delivered_n - to) * left;
        }
    }
}

const OBEYS: Makes = |force| force;

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// A drive that obeys is left alone: with half or twice the lag, weak, with another delay, whatever is commanded.
    #[test]
    fn a_drive_that_obeys_is_left_alone(
        lag in 0.5..2.0_f32,
        weak in 0.3..1.2_f32,
        delay in 1..3_usize,
        fault_ticks in 5..20_u32,
        commands in prop::collection::vec(([-1000.0..1000.0_f32, -1000.0..1000.0_f32], 1..40_u32), 1..60),
    ) {
        let with = Config { fault_ticks: fault_ticks as f32, ..config() };
        let mut bench = Bench::new(&with, lag * with.amplifier_lag_s, delay);
        for (levitation_n, ticks) in commands {
            for _ in 0..ticks {
                bench.sequence += 1;
                // A rotor in the middle: the levitation controller commands what it likes.
                let position_m = [1e-6 * (bench.sequence % 5) as f32, 1e-6 * (bench.sequence % 7) as f32];
                let mut now = sample(bench.sequence, position_m);
                now.status |= Status::APPLIED_VALID;
                let applied_n = bench.delivered_n;
                let command = bench.supervisor.tick(&Sample { levitation_n, applied_n, ..now });
                prop_assert!(!command.events.contains(Events::AXIS_LOST), "{:?}", command);
                bench.line.push(command.force_n);
                let due = bench.line.remove(0);
                bench.deliver(due.map(|force_n| weak * force_n));
            }
        }
    }
}

/// A drive that is slow because its voltage is small comes nearer to the command in every tick, and that is enough.
#[test]
fn a_slow_drive_is_left_alone() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut delivered_n = [0.0_f32; 2];
    for i in 0..4000_u32 {
        let full = if i / 200 % 2 == 0 { 900.0 } else { -900.0 };
        let mut now = sample(i, [1e-6 * (i % 5) as f32, 1e-6 * (i % 7) as f32]);
        now.status |= Status::APPLIED_VALID;
        let command = supervisor.tick(&Sample {
            levitation_n: [full, 100.0],
            applied_n: delivered_n,
            ..now
        });
        assert!(!command.events.contains(Events::AXIS_LOST), "{i}");
        for (delivered_n, to) in delivered_n.iter_mut().zip(command.force_n) {
            // From one cap to the other in 80 ticks, a dozen times slower than the lag alone.
            *delivered_n += (to - *delivered_n).clamp(-25.0, 25.0);
        }
    }
}

/// Inverted, dead, swapped and stuck axes are found within `fault_ticks` and the few that the force needs to get there, while
/// the whole cap brakes a whirl; they get nothing for eight times as long, then they are tried again; and an axis
/// that obeys keeps its force.
#[test]
fn an_axis_that_does_not_obey_gets_nothing_for_a_while() {
    let drives: [(&str, Makes, [bool; 2]); 6] = [
        ("x inverted", |[x, y]| [-x, y], [true, false]),
        ("y inverted", |[x, y]| [x, -y], [false, true]),
        ("both inverted", |[x, y]| [-x, -y], [true, true]),
        ("x dead", |[_, y]| [0.0, y], [true, false]),
        ("swapped", |[x, y]| [y, x], [true, true]),
        ("y stuck", |[x, _]| [x, 900.0], [false, true]),
    ];
    for (name, makes, wrong) in drives {
        let with = Config {
            fault_ticks: 5.0,
            ..config()
        };
        let mut bench = Bench::new(&with, with.amplifier_lag_s, 1);
        for _ in 0..300 {
            let command = bench.tick(OBEYS, Status::APPLIED_VALID);
            assert!(!command.events.contains(Events::AXIS_LOST), "{name}");
        }
        let mut zero_ticks = [0; 2];
        let (mut first, mut back) = ([None; 2], false);
        for i in 0..600_u32 {
            let command = bench.tick(makes, Status::APPLIED_VALID);
            assert_ne!(command.mode, Mode::SensorFault);
            for axis in 0..2 {
                if command.force_n[axis] == 0.0 {
                    zero_ticks[axis] += 1;
                    first[axis] = first[axis].or(Some(i));
                }
            }
            back |= command.events.contains(Events::AXIS_BACK);
        }
        for axis in 0..2 {
            if wrong[axis] {
                // A turn of the whirl is 63 ticks, and an axis can only be told while it has a command.
                assert!(first[axis].is_some_and(|i| i <= 40), "{name}: {first:?}");
                assert!(zero_ticks[axis] >= 350, "{name}: {zero_ticks:?}");
            } else {
                assert!(zero_ticks[axis] <= 1, "{name}: {zero_ticks:?}");
            }
        }
        assert!(back, "{name}: tried again");
        // In order again, it is believed again.
        let after: Vec<_> = (0..200)
            .map(|_| bench.tick(OBEYS, Status::APPLIED_VALID))
            .collect();
        let lost = |c: &supervisor::Command| c.events.contains(Events::AXIS_LOST);
        assert!(!after[60..].iter().any(lost), "{name}");
    }
}

/// Nothing is said of a drive whose force is not measured, or which is off.
#[test]
fn what_is_not_measured_is_not_judged() {
    for (status, off) in [
        (Status::empty(), Status::empty()),
        (Status::APPLIED_VALID, Status::BEARING_ON),
    ] {
        let mut bench = Bench::new(&config(), 1.6e-4, 1);
        for _ in 0..400 {
            bench.sequence += 1;
            let mut now = sample(bench.sequence, [1e-6 * (bench.sequence % 5) as f32, 1e-6]);
            now.status |= status;
            now.status -= off;
            let command = bench.supervisor.tick(&Sample {
                levitation_n: [900.0, -300.0],
                applied_n: [-900.0, 300.0],
                ..now
            });
            assert!(!command.events.contains(Events::AXIS_LOST));
            assert_eq!(command.force_n, [900.0, -300.0]);
        }
    }
}
