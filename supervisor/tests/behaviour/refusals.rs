//! Samples that cannot be: how soon the supervisor refuses them, what it does meanwhile, and when they make a fault.

use super::trust::{C_M, noise};
use supervisor::{Command, Events, Limits, Mode, RejectReason, Status};
use test_support::bench::{Bench, WHIRL_STEP};
use test_support::rig::{RADIUS_M, apart, asking, config, config_with, length, on_circle, sample};
use test_support::storm::Chance;

/// Ticks of these samples until the fault, each refused from the first on.
pub(super) fn ticks_to_fault(mut tick: impl FnMut(u32) -> Command) -> u32 {
    for i in 1..=20 {
        let command = tick(i);
        assert!(command.limits.contains(Limits::SAMPLE_REFUSED), "tick {i}");
        if command.mode == Mode::SensorFault {
            assert!(command.events.contains(Events::SENSOR_FAULT));
            return i;
        }
        assert!(!command.events.contains(Events::SENSOR_FAULT));
        assert!(length(command.force_n) > 900.0, "the force goes on");
    }
    panic!("no fault in 20 ticks");
}

/// NaN, infinity and range are refused in the same tick and are a fault after `fault_ticks`.
/// Requirement: SR-12
#[test]
fn what_is_no_number_or_out_of_range_is_refused_at_once() {
    let cases = [
        ([f32::NAN, 0.0], RejectReason::NotFinite),
        ([0.0, f32::INFINITY], RejectReason::NotFinite),
        ([f32::MAX, 0.0], RejectReason::NotFinite),
        ([0.0, 20.1 * 2e-4], RejectReason::Range),
    ];
    for (position_m, why) in cases {
        for fault_ticks in [2.0, 10.0] {
            let (mut bench, _) = Bench::whirl(&config_with(|c| c.fault_ticks = fault_ticks));
            let mut reasons = Vec::new();
            let ticks = ticks_to_fault(|_| {
                let command = bench.tick(position_m);
                reasons.push(bench.supervisor.report().refusal);
                command
            });
            assert_eq!(ticks as f32, fault_ticks);
            assert!(reasons.iter().all(|r| *r == why), "{reasons:?}");
            assert_eq!(bench.supervisor.report().fault, why);
        }
    }
}

/// A jump that stays is a fault in the second tick.
/// Requirement: SR-13
#[test]
fn a_jump_that_stays_is_a_fault_within_two_ticks() {
    let (mut bench, angle) = Bench::whirl(&config());
    let ticks = ticks_to_fault(|i| {
        let [x, y] = on_circle(RADIUS_M, angle + WHIRL_STEP * i as f32);
        bench.tick([x + 6e-4, y])
    });
    assert!((2..=3).contains(&ticks), "{ticks}");
    assert_eq!(bench.supervisor.report().fault, RejectReason::Slew);
}

/// The way that is allowed is speed_max·T and three steps of the sensor, for each tick since the last
/// good sample.
/// Requirement: SR-13
#[test]
fn the_limit_of_a_jump_is_speed_and_three_steps() {
    // 2 m/s in 50 µs, and 3 µm.
    let limit = 1.03e-4_f32;
    for (way, refused) in [(0.999 * limit, false), (1.001 * limit, true)] {
        let mut bench = Bench::new(&config());
        bench.tick([0.0, 1e-6]);
        let command = bench.tick([way, 1e-6]);
        assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), refused);
    }
}

/// A single bad sample of any kind costs no force, makes no fault and gives the estimate no kick: the
/// commands stay near those of a run without it.
/// Requirement: SR-16
#[test]
fn a_single_bad_sample_neither_drops_the_force_nor_kicks() {
    /// What comes in place of a good sample; nothing new for `None`.
    type Bad = fn([f32; 2]) -> Option<[f32; 2]>;
    let kinds: [Bad; 5] = [
        |_| Some([f32::NAN, 0.0]),
        |[x, y]| Some([x + 7e-4, y]),
        |[x, y]| Some([x, y - 3e-4]),
        |_| Some([1.0, 1.0]),
        |_| None,
    ];
    for kind in kinds {
        let (mut bench, mut angle) = Bench::whirl(&config());
        let mut clean = bench.supervisor.clone();
        for i in 0..60_u32 {
            angle += WHIRL_STEP;
            let good = on_circle(RADIUS_M, angle);
            let bad = i % 20 == 10;
            let command = match (bad, kind(good)) {
                (true, Some(position_m)) => bench.tick(position_m),
                (true, None) => {
                    let command = bench.tick_again(good);
                    bench.sequence += 1;
                    command
                }
                _ => bench.tick(good),
            };
            let without = clean.tick(&sample(bench.sequence, good));
            assert_eq!(command.mode, Mode::BackwardWhirl);
            assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), bad);
            assert!(length(command.force_n) > 990.0);
            let off_n = apart(command.force_n, without.force_n);
            assert!(off_n < 60.0, "{i}: {off_n} N off");
        }
    }
}

/// In mode Levitated the controller's answer to a sample that cannot be does not go through, since it saw the same reading: the
/// command before it stays, to a rounding. In shadow, with the bearing off, and where a sample is merely missing, it does.
/// Requirement: SR-16
#[test]
fn the_command_of_a_sample_that_cannot_be_does_not_go_through() {
    let (acts, shadow, off) = (Status::empty(), Status::SHADOW, Status::BEARING_ON);
    for (status, through) in [(acts, false), (shadow, true), (off, true)] {
        // The last is merely doubted.
        for bad in [[f32::NAN, 0.0], [7e-4, 0.0], [1.0, 1.0], [4e-5, 0.0]] {
            let (mut bench, mut last) = (Bench::new(&config()), [0.0; 2]);
            for i in 0..300 {
                let refused = i % 10 == 9;
                let good = [1e-6 * (i % 7) as f32, 1e-6 * (i % 3) as f32];
                let [position_m, levitation_n] = match refused {
                    true => [bad, [900.0, -100.0]],
                    false => [good, [0.3 * i as f32, -20.0]],
                };
                bench.sequence += 1;
                let mut now = asking(bench.sequence, position_m, levitation_n);
                now.status ^= status;
                let command = bench.supervisor.tick(&now);
                assert_eq!(command.mode, Mode::Levitated);
                assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), refused);
                let doubted = bench.supervisor.report().refusal == RejectReason::Doubted;
                assert!(doubted || !refused || bad != [4e-5, 0.0]);
                if refused && !through {
                    let off_n = apart(command.force_n, last);
                    assert!(off_n < 1e-4, "{command:?} after {last:?}");
                } else {
                    assert_eq!(command.force_n, levitation_n);
                    last = levitation_n;
                }
                if i % 10 == 4 {
                    now.levitation_n[0] += 1.0;
                    let again = bench.supervisor.tick(&now);
                    assert!(again.limits.contains(Limits::SAMPLE_REFUSED));
                    assert_eq!(again.force_n, now.levitation_n);
                    last = now.levitation_n;
                }
            }
        }
    }
}

/// In a hand-over, too, what the controller makes of a sample that cannot be does not go through.
#[test]
fn in_a_hand_over_the_answer_to_such_a_sample_does_not_go_through() {
    let with = config_with(|c| c.handover_blend_s = 0.01);
    for bad in [[f32::NAN, 0.0], [7e-4, 0.0]] {
        let (mut bench, angle) = Bench::whirl(&with);
        let mut radius_m = RADIUS_M;
        let (mut wild, mut last_n) = (0, [0.0; 2]);
        for i in 0..400 {
            radius_m = (radius_m - 1e-5).max(1e-6 * (1.0 + (i % 5) as f32));
            let refused = bench.supervisor.mode() == Mode::Handover && i % 10 == 9;
            let good = (on_circle(radius_m, angle), [0.0; 2]);
            let (position_m, asked_n) = if refused { (bad, [-1e4, 0.0]) } else { good };
            let command = bench.tick_asking(position_m, asked_n);
            if refused {
                assert_eq!(command.mode, Mode::Handover);
                let off_n = apart(command.force_n, last_n);
                assert!(off_n < 1e-3, "{command:?} after {last_n:?}");
                wild += 1;
            }
            last_n = command.force_n;
        }
        assert!(wild > 5, "{wild} in hand-over");
        assert_eq!(bench.supervisor.mode(), Mode::Levitated);
    }
}

/// A single sample that is off moves nothing, in either direction and of any size; what the second shows as well is so. Of
/// samples that do not agree with each other either two in a row are refused, and the third is believed.
/// Requirement: SR-16
#[test]
fn one_sample_that_is_off_is_refused_and_two_are_not() {
    let is_refused = |command: &Command| command.limits.contains(Limits::SAMPLE_REFUSED);
    let levitated = || {
        let (mut bench, mut chance) = (Bench::new(&config()), Chance::new(5));
        let mut tick = move |off: f32| {
            let x = off * C_M + noise(&mut chance, 5e-7);
            let command = bench.tick([x, noise(&mut chance, 5e-7)]);
            let report = bench.supervisor.report();
            let doubted = report.refusal == RejectReason::Doubted;
            assert_eq!(is_refused(&command), doubted, "{off}");
            assert_eq!(report.landings, 0);
            command
        };
        for _ in 0..200 {
            let command = tick(0.0);
            assert!(!is_refused(&command) && command.mode == Mode::Levitated);
        }
        tick
    };
    for size in [0.1, 0.3, 0.9] {
        let mut tick = levitated();
        for _ in 0..50 {
            let command = tick(size);
            assert!(is_refused(&command) && command.mode == Mode::Levitated);
            for _ in 0..20 {
                assert_eq!(tick(0.0).mode, Mode::Levitated, "{size}");
            }
        }
        if size < 0.5 {
            let both = [size; 2].map(|off| is_refused(&tick(off)));
            assert_eq!(both, [true, false], "{size}");
        }
    }
    let mut tick = levitated();
    let refused = [0.1, 0.25, 0.45].map(|off| is_refused(&tick(off)));
    assert_eq!(refused, [true, true, false]);
}
