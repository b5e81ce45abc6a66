//! A drive that does not do what is commanded, where its force is measured: what is noticed, what is not, and what follows.

use proptest::prelude::*;
use supervisor::{Command, Config, Events, Mode, Sample, Status, Supervisor};
use test_support::rig::{
    RADIUS_M, WHIRL_STEP, asking, config, config_with, on_circle, sample_with, ticks_of,
};

/// What a drive makes of a command \[N\].
type Makes = fn([f32; 2]) -> [f32; 2];

/// A supervisor on a rotor that whirls on the wall, with an amplifier behind it.
struct DriveLoop {
    supervisor: Supervisor<64>,
    sequence: u32,
    /// Commands on their way, the oldest first.
    line: Vec<[f32; 2]>,
    lag_s: f32,
    delivered_n: [f32; 2],
}

impl DriveLoop {
    fn new(config: &Config, lag_s: f32, delay: usize) -> Self {
        Self {
            supervisor: Supervisor::new(config).unwrap(),
            sequence: 0,
            line: vec![[0.0; 2]; delay],
            lag_s,
            delivered_n: [0.0; 2],
        }
    }

    /// A tick in a whirl; the amplifier gets what the drive makes of the command.
    fn tick(&mut self, makes: Makes, status: Status) -> Command {
        let position_m = on_circle(RADIUS_M, WHIRL_STEP * (self.sequence + 1) as f32);
        let now = sample_with(0, position_m, |now| now.status |= status);
        self.tick_of(now, makes)
    }

    /// A tick with the next number and the force that is delivered.
    fn tick_of(&mut self, now: Sample, makes: impl Fn([f32; 2]) -> [f32; 2]) -> Command {
        self.sequence += 1;
        let command = self.supervisor.tick(&Sample {
            sequence: self.sequence,
            applied_n: self.delivered_n,
            ..now
        });
        self.line.push(command.force_n);
        let wanted_n = makes(self.line.remove(0));
        let left = (-50e-6 / self.lag_s).exp();
        for (delivered_n, to) in self.delivered_n.iter_mut().zip(wanted_n) {
            *delivered_n = to + (*delivered_n - to) * left;
        }
        command
    }
}

const OBEYS: Makes = |force| force;

/// A sample of a rotor in the middle, with what levitation commands and the force that is measured.
fn in_the_middle(sequence: u32, levitation_n: [f32; 2], applied_n: [f32; 2]) -> Sample {
    let position_m = [5, 7].map(|turns| 1e-6 * (sequence % turns) as f32);
    sample_with(sequence, position_m, |now| {
        now.status |= Status::APPLIED_VALID;
        (now.levitation_n, now.applied_n) = (levitation_n, applied_n);
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// A drive that obeys is left alone: with half or twice the lag, weak, with another delay, whatever is commanded. (With a
    /// third of its force, twice the lag and a tick more of delay at once a count of five begins to be reached.)
    /// Requirement: SR-22
    #[test]
    fn a_drive_that_obeys_is_left_alone(
        lag in 0.5..2.0_f32,
        weak in 0.4..1.2_f32,
        delay in 1..3_usize,
        fault_ticks in 5..20_u32,
        commands in prop::collection::vec(([-1000.0..1000.0_f32, -1000.0..1000.0_f32], 1..40_u32), 1..60),
    ) {
        let with = config_with(|c| c.fault_ticks = fault_ticks as f32);
        let mut drive = DriveLoop::new(&with, lag * with.amplifier_lag_s, delay);
        for (levitation_n, ticks) in commands {
            for _ in 0..ticks {
                // The levitation controller commands what it likes.
                let now = in_the_middle(drive.sequence + 1, levitation_n, [0.0; 2]);
                let command = drive.tick_of(now, |due| due.map(|force_n| weak * force_n));
                prop_assert!(!command.events.contains(Events::AXIS_LOST), "{:?}", command);
            }
        }
    }
}

/// A drive that is slow because its voltage is small comes nearer to the command all the time, and that is enough, however
/// often one looks.
/// Requirement: SR-22
#[test]
fn a_slow_drive_is_left_alone() {
    for sample_period_s in [20e-6_f32, 50e-6, 100e-6] {
        let with = config_with(|c| c.sample_period_s = sample_period_s);
        let mut supervisor = Supervisor::<64>::new(&with).unwrap();
        let mut delivered_n = [0.0_f32; 2];
        for i in 0..4000_u32 {
            let full = if i / 400 % 2 == 0 { 900.0 } else { -900.0 };
            let command = supervisor.tick(&in_the_middle(i, [full, 100.0], delivered_n));
            assert!(!command.events.contains(Events::AXIS_LOST), "{i}");
            for (delivered_n, to) in delivered_n.iter_mut().zip(command.force_n) {
                // From one cap to the other in 4 ms, a dozen times slower than the lag alone.
                let most = 5e5 * sample_period_s;
                *delivered_n += (to - *delivered_n).clamp(-most, most);
            }
        }
    }
}

/// Inverted, dead, swapped and stuck axes are found within `fault_ticks` and the few that the force needs to get there, while
/// the whole cap brakes a whirl; they get nothing for a while, then they are tried again; and an axis that obeys keeps its
/// force.
/// Requirement: SR-22
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
        let with = config_with(|c| c.fault_ticks = 5.0);
        let mut drive = DriveLoop::new(&with, with.amplifier_lag_s, 1);
        for _ in 0..300 {
            let command = drive.tick(OBEYS, Status::APPLIED_VALID);
            assert!(!command.events.contains(Events::AXIS_LOST), "{name}");
        }
        // A tick without a measured force ends no rest.
        let measured = |i| [Status::APPLIED_VALID, Status::empty()][usize::from(i % 100 == 99)];
        let commands: Vec<_> = (0..500).map(|i| drive.tick(makes, measured(i))).collect();
        let seen = |event| ticks_of(&commands, event).len();
        assert!(seen(Events::AXIS_LOST) >= 3, "{name}");
        assert!(seen(Events::AXIS_BACK) >= 3, "{name}: tried again");
        assert!(commands.iter().all(|c| c.mode != Mode::SensorFault));
        for (axis, wrong) in wrong.into_iter().enumerate() {
            let zero: Vec<bool> = commands.iter().map(|c| c.force_n[axis] == 0.0).collect();
            if !wrong {
                assert!(zero.iter().filter(|zero| **zero).count() <= 1, "{name}");
                continue;
            }
            // A turn of the whirl is 63 ticks, and an axis can only be judged while it delivers against a command.
            let first = zero.iter().position(|zero| *zero);
            assert!(first.is_some_and(|i| i <= 70), "{name}: {first:?}");
        }
        // In order again, it is believed again.
        let tick = |_| drive.tick(OBEYS, Status::APPLIED_VALID);
        let after: Vec<_> = (0..200).map(tick).collect();
        assert_eq!(ticks_of(&after[60..], Events::AXIS_LOST).len(), 0, "{name}");
    }
}

/// Nothing is said of a drive whose force is not measured, or which is off.
/// Requirement: SR-22
#[test]
fn what_is_not_measured_is_not_judged() {
    for without in [Status::APPLIED_VALID, Status::BEARING_ON] {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        for i in 0..400 {
            let mut now = in_the_middle(i, [900.0, -300.0], [-900.0, 300.0]);
            now.status -= without;
            let command = supervisor.tick(&now);
            assert!(!command.events.contains(Events::AXIS_LOST));
            assert_eq!(command.force_n, [900.0, -300.0]);
        }
    }
}

/// A bearing that carries something when its force is first measured, after a start, a pause of the measurement, a gap or while
/// the bearing was off, is no drive that disobeys, however late commands take effect.
#[test]
fn what_the_bearing_carries_at_first_is_believed() {
    let held_n = [-900.0, 400.0];
    let against_n = held_n.map(|force_n: f32| -force_n);
    for delay_samples in [0.0, 1.0, 3.0, 7.0] {
        let with = config_with(|c| (c.delay_samples, c.fault_ticks) = (delay_samples, 2.0));
        for (what, ticks, status, gap) in [
            ("start", 0, Status::empty(), 0),
            ("measured late", 100, Status::APPLIED_VALID, 0),
            ("a gap", 100, Status::empty(), 100),
            ("off", 100, Status::BEARING_ON, 0),
        ] {
            let mut supervisor = Supervisor::<64>::new(&with).unwrap();
            let mut sequence = 0;
            let mut tick = |levitation_n, applied_n, without| {
                sequence += 1;
                let mut now = in_the_middle(sequence, levitation_n, applied_n);
                now.status -= without;
                let command = supervisor.tick(&now);
                assert!(!command.events.contains(Events::AXIS_LOST), "{what}");
                if sequence == ticks {
                    sequence += gap;
                }
            };
            for _ in 0..ticks {
                let applied_n = if what == "off" { [0.0; 2] } else { against_n };
                tick(against_n, applied_n, status);
            }
            for _ in 0..100 {
                tick(held_n, held_n, Status::empty());
            }
        }
    }
}

/// Nothing is expected of an axis that is reported lost: what is left of its force dies away, and when it is back, it is.
#[test]
fn an_axis_that_is_reported_lost_is_not_judged() {
    let with = config_with(|c| c.fault_ticks = 2.0);
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut applied_n = [900.0, 0.0];
    for i in 0..200 {
        let mut now = in_the_middle(i, [900.0, 0.0], applied_n);
        let lost = (100..120).contains(&i);
        now.status.set(Status::AXIS_X_LOST, lost);
        let command = supervisor.tick(&now);
        // Down while it is lost, so slowly that it would count as disobedience, and up again.
        let (to, share) = if lost { (0.0, 0.03) } else { (900.0, 0.1) };
        applied_n[0] += (to - applied_n[0]) * share;
        assert_eq!(command.force_n[0], to, "{i}");
        assert_eq!(command.events.contains(Events::AXIS_LOST), i == 100);
    }
}

/// A drive that is switched off is believed when it is on again, also where its force is not measured meanwhile.
#[test]
fn off_and_on_ends_a_rest() {
    for measured in [Status::APPLIED_VALID, Status::empty()] {
        let mut drive = DriveLoop::new(&config(), 1.6e-4, 1);
        let mut ticks = (0..200).map(|_| drive.tick(|[x, y]| [-x, -y], Status::APPLIED_VALID));
        assert!(ticks.any(|command| command.events.contains(Events::AXIS_LOST)));
        drive.sequence += 1;
        let position_m = on_circle(RADIUS_M, WHIRL_STEP * drive.sequence as f32);
        let status = |s: Status| (s | measured) - Status::BEARING_ON;
        let off = sample_with(drive.sequence, position_m, |s| s.status = status(s.status));
        drive.supervisor.tick(&off);
        // A turn of the whirl: both axes are needed.
        let mut largest_n = [0.0_f32; 2];
        for _ in 0..63 {
            let command = drive.tick(OBEYS, Status::APPLIED_VALID);
            assert!(!command.events.contains(Events::AXIS_LOST));
            largest_n = [0, 1].map(|k| largest_n[k].max(command.force_n[k].abs()));
        }
        assert!(largest_n.iter().all(|n| *n > 900.0), "{largest_n:?}");
    }
}

/// In shadow the supervisor has no drive: whatever that does, the levitation command goes through bit for bit, and
/// nothing is held against it when the supervisor may act.
/// Requirement: SR-09
#[test]
fn in_shadow_nothing_is_taken_from_the_levitation_controller() {
    let mut drive = DriveLoop::new(&config(), 1.6e-4, 1);
    for i in 0..600_u32 {
        let shadow = i < 590;
        let full = if i / 50 % 2 == 0 { 900.0 } else { -900.0 };
        let mut now = asking(
            0,
            on_circle(RADIUS_M, WHIRL_STEP * i as f32),
            [full, -300.0],
        );
        now.status |= Status::APPLIED_VALID;
        now.status.set(Status::SHADOW, shadow);
        let command = drive.tick_of(now, |[x, y]| [-x, y]);
        assert!(!shadow || command.force_n == now.levitation_n);
        assert!(!command.events.contains(Events::AXIS_LOST));
    }
}

/// An axis that does not obey is lost after `fault_ticks` ticks of it, fifteen at most, and gets nothing for eight times as
/// long, to the tick.
/// Requirement: SR-22
#[test]
fn an_axis_is_lost_and_tried_again_after_its_time_to_the_tick() {
    for fault_ticks in [2, 5, 15, 40] {
        let with = config_with(|c| c.fault_ticks = fault_ticks as f32);
        let mut supervisor = Supervisor::<64>::new(&with).unwrap();
        let obeys_until = 100;
        let ticks = (0..obeys_until + 200).map(|i| {
            let applied_n = if i < obeys_until { 500.0 } else { -500.0 };
            supervisor.tick(&in_the_middle(i, [500.0, 0.0], [applied_n, 0.0]))
        });
        let commands: Vec<_> = ticks.collect();
        let first = |event| ticks_of(&commands, event)[0];
        let (lost, back) = (first(Events::AXIS_LOST), first(Events::AXIS_BACK));
        // Nothing from the tick after the last of them on.
        let ticks = fault_ticks.min(15);
        assert_eq!(lost, (obeys_until + ticks) as usize, "{fault_ticks}");
        assert_eq!(back - lost, 8 * ticks as usize, "{fault_ticks}");
        assert!(commands[lost..back].iter().all(|c| c.force_n[0] == 0.0));
    }
}

/// Commands that all come a tick late, and are said to: a measured force that follows them is that of a drive that obeys.
#[test]
fn late_commands_in_a_row_are_a_line_that_is_a_tick_longer() {
    for (status, late_ticks) in [(Status::LATE, 399), (Status::empty(), 0)] {
        let mut drive = DriveLoop::new(&config(), 1.6e-4, 1);
        for i in 0..600 {
            let status = if i > 200 { status } else { Status::empty() };
            let command = drive.tick(OBEYS, status | Status::APPLIED_VALID);
            assert!(!command.events.contains(Events::AXIS_LOST));
            if i == 200 {
                drive.line.insert(0, drive.line[0]);
            }
        }
        assert_eq!(drive.supervisor.report().late_ticks, late_ticks);
    }
}
