//! One coordinate is bad: the other is left to the levitation controller, as long as it makes sense itself.

use supervisor::{Command, Mode, RejectReason};
use test_support::bench::{Bench, WHIRL_STEP};
use test_support::rig::{RADIUS_M, asking, config, config_with, on_circle};

/// Where one coordinate is no number or out of range, the force along it goes to zero in the time of a hand-over, and along
/// the other the levitation controller acts from the first tick on, bit for bit, whatever it makes of the bad one. Once the
/// other is wrong too, the force along that fades as well.
/// Requirement: SR-18
#[test]
fn a_coordinate_that_is_good_is_left_to_the_levitation_controller() {
    let with = config_with(|c| (c.fault_blend_s, c.position_limit) = (1e-2, 4.0));
    // The cap, in 40 ticks.
    let step_n = 25.0;
    for bad in [f32::NAN, f32::NEG_INFINITY, 8.1e-4] {
        for axis in 0..2 {
            let (mut bench, angle) = Bench::whirl(&with);
            let levitation = |i: u32| {
                let mut levitation_n = [600.0 - i as f32; 2];
                // Its derivative of a rail, or of what is no number.
                levitation_n[axis] = [1e6, f32::NAN, -3e38][i as usize % 3];
                levitation_n
            };
            let mut tick = |i: u32, both: bool| {
                let mut position_m = on_circle(RADIUS_M, angle + WHIRL_STEP * i as f32);
                position_m[axis] = bad;
                if both {
                    position_m = [bad; 2];
                }
                bench.tick_asking(position_m, levitation(i))
            };
            let last = (1..10).map(|i| tick(i, false)).last().unwrap();
            assert_ne!(last.mode, Mode::SensorFault);
            let from = last.force_n[axis];
            assert!(from.abs() > 100.0, "{from} to be blended out");
            let mut left = from.abs();
            for i in 1..=60 {
                let command = tick(9 + i, false);
                assert_eq!(command.mode, Mode::SensorFault);
                assert_eq!(command.force_n[1 - axis], levitation(9 + i)[1 - axis]);
                // No more than the other is sure to leave of the cap.
                let room = 1000.0 - levitation(9 + i)[1 - axis];
                left = (left - step_n).clamp(0.0, room);
                let off = command.force_n[axis] - left.copysign(from);
                assert!(off.abs() < 0.1, "{bad} on {axis}, {i}: {command:?}");
            }
            // Both are bad of a rotor that was whirling: slowly, from where the command was.
            let from = levitation(69)[1 - axis];
            for i in 1..=300 {
                let command = tick(69 + i, true);
                let left = (from - 5.0 * i as f32).max(0.0);
                assert_eq!(command.force_n[axis], 0.0);
                let off = command.force_n[1 - axis] - left;
                assert!(off.abs() < 0.1, "{bad} on {axis}, {i}: {command:?}");
            }
            // Not known again before the fault is over.
            assert_eq!(tick(370, false).force_n, [0.0; 2]);
        }
    }
}

/// Of a jump or a coordinate that is stuck the other one makes sense and is left to the levitation controller; of a dropout nobody
/// knows anything.
/// Requirement: SR-18
#[test]
fn the_coordinate_that_makes_sense_is_left_to_levitation() {
    for kind in 0..3 {
        let (mut bench, angle) = Bench::whirl(&config());
        let mut last = Command::default();
        for i in 0..60 {
            let [x, y] = on_circle(RADIUS_M, angle + WHIRL_STEP * i as f32);
            bench.sequence += u32::from(kind != 1);
            let position_m = match kind {
                0 => [x + 6e-4 * (i / 2 % 2) as f32, y],
                1 => [x, y],
                _ => [RADIUS_M, y],
            };
            last = (bench.supervisor).tick(&asking(bench.sequence, position_m, [300.0; 2]));
        }
        assert_eq!(last.mode, Mode::SensorFault);
        let good = if kind == 1 { 0.0 } else { 300.0 };
        assert_eq!(last.force_n, [0.0, good], "kind {kind}");
    }
}

/// A supervisor that was in whirl when one coordinate went bad, and where the other one is.
struct OneLeft {
    bench: Bench,
    bad: usize,
    reads_m: f32,
    at_m: f32,
}

impl OneLeft {
    const LEVITATION_N: f32 = 300.0;
    /// Of the cap in a tick: 10 ms of fading.
    const FADED_N: f32 = 5.0;
    /// Ticks that make a fault.
    const FAULT: usize = 10;

    /// Before the first bad sample.
    fn new(bad: usize, reads_m: f32) -> Self {
        let fault_ticks = Self::FAULT as f32;
        let with = config_with(|c| (c.fault_blend_s, c.fault_ticks) = (1e-2, fault_ticks));
        let (bench, angle) = Bench::whirl(&with);
        Self {
            bench,
            bad,
            reads_m,
            at_m: on_circle(RADIUS_M, angle)[1 - bad],
        }
    }

    /// In the fault.
    fn in_fault(bad: usize, reads_m: f32) -> Self {
        let mut left = Self::new(bad, reads_m);
        for _ in 0..Self::FAULT {
            left.tick(1e-6);
        }
        assert_eq!(left.tick(1e-6), Self::LEVITATION_N);
        left
    }

    /// A tick after a step of the good coordinate; the command along it.
    fn tick(&mut self, step_m: f32) -> f32 {
        self.at_m += step_m;
        let mut position_m = [self.at_m; 2];
        position_m[self.bad] = self.reads_m;
        let command = self.bench.tick_asking(position_m, [Self::LEVITATION_N; 2]);
        command.force_n[1 - self.bad]
    }

    /// Whether all that the levitation controller asks for along the good coordinate goes through, in a tick after a step of it.
    fn passes(&mut self, step_m: f32) -> bool {
        let force_n = self.tick(step_m);
        assert!(force_n <= Self::LEVITATION_N, "{force_n}");
        force_n == Self::LEVITATION_N
    }

    /// As many samples that fit to each other as end a fault but for one: none of them does.
    fn does_not_pass_yet(&mut self) {
        for _ in 1..Self::FAULT {
            assert!(!self.passes(1e-6));
        }
    }

    /// Whether the levitation controller acts along the good coordinate in the first tick of the fault, after these steps of it.
    fn is_left_after(&mut self, steps_m: [f32; Self::FAULT]) -> bool {
        let force_n = steps_m.map(|step_m| self.tick(step_m));
        assert_eq!(self.bench.supervisor.mode(), Mode::SensorFault);
        force_n[Self::FAULT - 1] == Self::LEVITATION_N
    }
}

/// 2 m/s in 50 µs, and 3 µm.
const LONGEST_STEP_M: f32 = 1.03e-4;
/// A coordinate and what makes it bad.
const BAD: [(usize, f32); 5] = [
    (0, f32::NAN),
    (1, f32::NAN),
    (0, 5e-3),
    (1, -5e-3),
    (1, f32::INFINITY),
];

/// A step of the good coordinate that the rotor cannot make is no position: what the levitation controller makes of it does
/// not go through in that tick, and after two in a row no more. One that it can make is none, nor one of as many ticks as were
/// missed.
/// Requirement: SR-18
#[test]
fn a_jump_of_the_coordinate_that_is_left_is_not_believed() {
    for (bad, reads_m) in BAD {
        let fresh = || OneLeft::in_fault(bad, reads_m);
        for jump_m in [1.01 * LONGEST_STEP_M, -1.01 * LONGEST_STEP_M, 5e-4] {
            let mut left = fresh();
            let can = [0.99, -0.99].map(|share| left.passes(share * LONGEST_STEP_M));
            assert_eq!(can, [true; 2]);
            // Out and back.
            for _ in 0..3 {
                let off_n = OneLeft::LEVITATION_N - left.tick(jump_m);
                assert!((off_n - OneLeft::FADED_N).abs() < 0.1, "{off_n} N");
                assert!(left.passes(-jump_m));
            }
            // Out, and from there on: until as many samples as end a fault fit to each other.
            for i in 1..2 + OneLeft::FAULT {
                let force_n = left.tick(if i == 1 { 2.0 * jump_m } else { 1e-6 });
                let faded_n = OneLeft::LEVITATION_N - OneLeft::FADED_N * i as f32;
                assert!((force_n - faded_n).abs() < 0.1, "{i}: {force_n} N");
            }
            assert!(left.passes(1e-6));
            assert!(!left.passes(jump_m));
            assert!(left.passes(-jump_m));
        }
        // Too far for one tick, but not for the two since the last one that fitted; as far as in three ticks, and the three
        // before count for the next one; after a gap nothing can be compared. Ticks that are missed, and such steps.
        let mut left = fresh();
        let rows = [(0, 1.9), (0, 0.01), (2, 2.9), (2, 3.1), (0, 0.8), (20, 5.0)];
        let passes = rows.map(|(missed, steps)| {
            left.bench.sequence += missed;
            left.passes(steps * LONGEST_STEP_M)
        });
        assert_eq!(passes, [false, true, true, false, true, true]);
    }
}

/// The same before the samples have made a fault: a jump that stays takes the coordinate from its first tick on, one sample
/// alone takes nothing but its tick.
#[test]
fn a_jump_before_the_fault_counts() {
    const JUMP_M: f32 = 6e-4;
    let at = |jumps: &[(usize, f32)]| {
        let mut steps_m = [1e-6; OneLeft::FAULT];
        jumps
            .iter()
            .for_each(|(tick, step_m)| steps_m[tick - 1] = *step_m);
        steps_m
    };
    for (bad, reads_m) in BAD {
        let left_after = |jumps: &[_]| OneLeft::new(bad, reads_m).is_left_after(at(jumps));
        assert!(left_after(&[]));
        for first in 1..OneLeft::FAULT {
            assert!(!left_after(&[(first, JUMP_M)]), "at {first}");
            let back = left_after(&[(first, JUMP_M), (first + 1, -JUMP_M)]);
            assert!(back, "at {first}");
        }
        // In the tick that makes the fault: for that tick.
        let mut left = OneLeft::new(bad, reads_m);
        assert!(!left.is_left_after(at(&[(OneLeft::FAULT, JUMP_M)])));
        assert!(left.passes(-JUMP_M));
    }
}

/// Once both coordinates are bad, by a repeated number here, the one that is left is used again after as many samples in a row
/// as end a fault: while the other one is bad, each near the one before, and none repeated.
#[test]
fn a_coordinate_that_fits_for_long_is_good_again() {
    for (bad, reads_m) in BAD {
        for interrupted in 0..3 {
            let mut left = OneLeft::in_fault(bad, reads_m);
            left.bench.sequence -= 1;
            assert!(!left.passes(1e-6), "a repeated number");
            left.does_not_pass_yet();
            // The last one but for which it would be good.
            if interrupted > 0 {
                left.bench.sequence -= u32::from(interrupted == 1);
                let step_m = if interrupted == 2 { 5e-4 } else { 1e-6 };
                assert!(!left.passes(step_m));
                left.does_not_pass_yet();
            }
            assert!(left.passes(1e-6), "{interrupted}");
        }
    }
}

/// A coordinate that stood still when the fault began is not good again before it has changed.
#[test]
fn a_coordinate_that_is_stuck_is_not_good_again() {
    for bad in 0..2 {
        let angle = Bench::whirl(&config()).1;
        let mut left = OneLeft::new(bad, on_circle(RADIUS_M, angle)[bad]);
        let last = left.at_m;
        // Stuck, while the other one still reads something that changes.
        while left.bench.supervisor.mode() != Mode::SensorFault {
            left.reads_m += 1e-6;
            left.tick(0.0);
        }
        assert_eq!(left.bench.supervisor.report().fault, RejectReason::Stuck);
        left.reads_m = f32::NAN;
        // Until the force of before has faded.
        let last_n = (0..200).map(|_| left.tick(0.0)).last();
        assert_eq!((left.at_m, last_n), (last, Some(0.0)));
        for _ in 1..OneLeft::FAULT {
            assert_eq!(left.tick(1e-6), 0.0);
        }
        assert!(left.passes(1e-6));
    }
}

/// Two jumps with a good sample of both coordinates between them are two single ones.
#[test]
fn a_good_sample_between_two_jumps_parts_them() {
    for (bad, reads_m) in BAD {
        let mut left = OneLeft::in_fault(bad, reads_m);
        for _ in 0..5 {
            assert!(!left.passes(5e-4));
            left.reads_m = 1e-5;
            left.tick(-5e-4);
            left.reads_m = reads_m;
        }
        assert!(left.passes(1e-6));
    }
}

/// A coordinate that was no number until the tick before is not good because the other one is none now.
#[test]
fn a_coordinate_is_good_after_samples_of_its_own() {
    let (mut bench, mut angle) = Bench::whirl(&config());
    let [stays_m, _] = on_circle(RADIUS_M, angle);
    let mut tick = |bad: [bool; 2], again: bool| -> Command {
        angle += WHIRL_STEP;
        let [_, y] = on_circle(RADIUS_M, angle);
        // Near to where x was last seen.
        let x = stays_m + 1e-6 * angle.sin();
        let coordinate = |bad: bool, at: f32| if bad { f32::NAN } else { at };
        let position = [coordinate(bad[0], x), coordinate(bad[1], y)];
        bench.sequence -= u32::from(again);
        bench.tick_asking(position, [700.0, 0.0])
    };
    for _ in 0..12 {
        tick([true, false], false);
    }
    tick([true, false], true);
    for _ in 0..9 {
        tick([true, false], false);
    }
    // The tenth of x alone would free y; of y alone this is the first.
    for i in 0..14 {
        let command = tick([false, true], false);
        assert_eq!(command.mode, Mode::SensorFault);
        assert_eq!(command.force_n[0] > 300.0, i >= 9, "{i}: {command:?}");
    }
}
