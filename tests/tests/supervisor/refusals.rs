//! Samples that cannot be: how soon the supervisor refuses them, what it does meanwhile, and when they make a fault.

use supervisor::{Command, Config, Events, Limits, Mode, RejectReason, Sample, Status, Supervisor};
use system_tests::bench::{Bench, WHIRL_STEP};
use system_tests::rig::{RADIUS_M, config, length, on_circle, sample};

/// Ticks of these samples until the fault, each refused from the first on.
fn ticks_to_fault(mut tick: impl FnMut(u32) -> Command) -> u32 {
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
            let with = Config {
                fault_ticks,
                ..config()
            };
            let (mut bench, _) = Bench::whirl(&with);
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

/// A repeated number is refused in the same tick and a fault in the third, wherever the samples lie.
/// Requirement: SR-14
#[test]
fn a_dropout_is_a_fault_within_three_ticks() {
    let (mut bench, angle) = Bench::whirl(&config());
    let ticks = ticks_to_fault(|_| {
        let command = bench.tick_again(on_circle(RADIUS_M, angle));
        assert!(command.events.contains(Events::SEQUENCE));
        command
    });
    assert_eq!(ticks, 3);
    assert_eq!(bench.supervisor.report().fault, RejectReason::Dropout);
}

/// A sensor that stands still while the rotor moves is a fault within ten ticks: both coordinates, or
/// one of them; in flight and in contact; at any speed of three steps in some ticks.
/// Requirement: SR-15
#[test]
fn a_stuck_sensor_is_a_fault_within_ten_ticks() {
    for stuck in [[true, true], [true, false], [false, true]] {
        let (mut bench, mut angle) = Bench::whirl(&config());
        // Both coordinates move there.
        while !(0.6..0.9).contains(&angle.rem_euclid(std::f32::consts::PI)) {
            angle += WHIRL_STEP;
            bench.tick(on_circle(RADIUS_M, angle));
        }
        let last = on_circle(RADIUS_M, angle);
        let mut ticks = 0;
        while bench.supervisor.mode() != Mode::SensorFault {
            ticks += 1;
            let now = on_circle(RADIUS_M, angle + WHIRL_STEP * ticks as f32);
            bench.tick([0, 1].map(|i| if stuck[i] { last[i] } else { now[i] }));
            assert!(ticks <= 10, "{stuck:?}");
        }
        assert_eq!(bench.supervisor.report().fault, RejectReason::Stuck);
    }
    // In flight, from 2 µm a tick.
    for step in [2e-6_f32, 1e-5, 5e-5] {
        let mut bench = Bench::new(&config());
        let ticks_before = (1.2e-4 / step) as u32;
        let mut x = -1e-4;
        for _ in 0..ticks_before {
            x += step;
            bench.tick([x, 0.3 * x]);
        }
        let fault = (1..=10).find(|_| bench.tick([x, 0.3 * x]).mode == Mode::SensorFault);
        assert!(fault.is_some(), "{step} m a tick");
    }
}

/// Electronics that die one channel after the other are a fault as soon as neither has changed for three samples.
/// Requirement: SR-15
#[test]
fn coordinates_may_stick_one_after_the_other() {
    for later in 0..4_u32 {
        let (mut bench, mut angle) = Bench::whirl(&config());
        while !(0.6..0.9).contains(&angle.rem_euclid(std::f32::consts::PI)) {
            angle += WHIRL_STEP;
            bench.tick(on_circle(RADIUS_M, angle));
        }
        let at = |ticks: u32| on_circle(RADIUS_M, angle + WHIRL_STEP * ticks as f32);
        let ticks = ticks_to_fault(|ticks| bench.tick([at(0)[0], at(ticks.min(later))[1]]));
        // At this speed no converter hides two ticks of standstill.
        assert!((2..=3).contains(&ticks), "{ticks}");
    }
}

/// A sensor that rightly stands still is left alone: a rotor at rest in the middle, on the wall under a
/// force, or with a coarse converter.
/// Requirement: SR-15
#[test]
fn a_rotor_at_rest_is_no_stuck_sensor() {
    for position_m in [[0.0, 0.0], [1e-4, -5e-5], [2.01e-4, 0.0]] {
        let mut bench = Bench::new(&config());
        for i in 0..2000_u32 {
            // One step of the converter now and then.
            let step = if i / 300 % 2 == 0 { 0.0 } else { 1e-6 };
            bench.tick([position_m[0] + step, position_m[1]]);
            let report = bench.supervisor.report();
            assert_eq!(report.refusal, RejectReason::None, "{position_m:?} at {i}");
        }
    }
}

/// A coordinate that has changed beside one that was no number has changed: it is not stuck in the sample after it.
#[test]
fn a_change_beside_a_bad_coordinate_is_a_change() {
    for still in 0..2 {
        let mut bench = Bench::new(&config());
        let mut position_m = [0.0; 2];
        let on = |by: [f32; 2], position_m: &mut [f32; 2]| {
            *position_m = [position_m[0] + by[0], position_m[1] + by[1]];
            *position_m
        };
        for _ in 0..50 {
            bench.tick(on([2e-6; 2], &mut position_m));
        }
        // Until it would be stuck in the next sample.
        let mut step_m = [2e-6; 2];
        step_m[still] = 0.0;
        loop {
            let before = bench.supervisor.clone();
            let command = bench.tick(on(step_m, &mut position_m));
            if command.limits.contains(Limits::SAMPLE_REFUSED) {
                bench.supervisor = before;
                bench.sequence -= 1;
                break;
            }
        }
        position_m[still] += 1e-6;
        let mut bad_m = position_m;
        bad_m[1 - still] = f32::NAN;
        assert!(bench.tick(bad_m).limits.contains(Limits::SAMPLE_REFUSED));
        let command = bench.tick(on(step_m, &mut position_m));
        assert!(!command.limits.contains(Limits::SAMPLE_REFUSED));
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
            let off = [0, 1].map(|k| command.force_n[k] - without.force_n[k]);
            assert!(length(command.force_n) > 990.0);
            assert!(length(off) < 60.0, "{i}: {off:?} N off");
        }
    }
}

/// In mode Levitated the controller's answer to a sample that cannot be does not go through, since it saw the same reading: the
/// command before it stays, to a rounding. In shadow, with the bearing off, and where a sample is merely missing, it does.
/// Requirement: SR-16
#[test]
fn the_command_of_a_sample_that_cannot_be_does_not_go_through() {
    for (status, through) in [
        (Status::empty(), false),
        (Status::SHADOW, true),
        (Status::BEARING_ON, true),
    ] {
        for bad in [[f32::NAN, 0.0], [7e-4, 0.0], [1.0, 1.0]] {
            let (mut bench, mut last) = (Bench::new(&config()), [0.0; 2]);
            for i in 0..300 {
                bench.sequence += 1;
                let refused = i % 10 == 9;
                let good = [1e-6 * (i % 7) as f32, 1e-6 * (i % 3) as f32];
                let mut now = sample(bench.sequence, if refused { bad } else { good });
                now.status ^= status;
                now.levitation_n = if refused {
                    [900.0, -100.0]
                } else {
                    [0.3 * i as f32, -20.0]
                };
                let command = bench.supervisor.tick(&now);
                assert_eq!(command.mode, Mode::Levitated);
                assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), refused);
                if refused && !through {
                    let off = [0, 1].map(|k| command.force_n[k] - last[k]);
                    assert!(length(off) < 1e-4, "{command:?} after {last:?}");
                } else {
                    assert_eq!(command.force_n, now.levitation_n);
                    last = now.levitation_n;
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

/// Over some missed ticks the estimate coasts: the force is within a tenth of the cap of what it would have been.
/// Requirement: SR-20
#[test]
fn missed_ticks_are_made_up_for() {
    for missed in 1..=4_u32 {
        let run = |skips: bool| {
            let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
            let mut last = Command::default();
            for i in 0..14_u32 {
                if skips && (6..6 + missed).contains(&i) {
                    continue;
                }
                // 0.16 m/s along x: too fast for the way that is left.
                let x = 8e-6 * i as f32 + 2e-5;
                last = supervisor.tick(&sample(i, [x, 1e-8 * i as f32]));
            }
            last
        };
        let (with, without) = (run(false), run(true));
        assert_eq!(with.mode, without.mode);
        let off = [0, 1].map(|k| with.force_n[k] - without.force_n[k]);
        assert!(length(off) < 100.0, "{missed}: {off:?}");
    }
    // After more than that the sample before is no help: whatever the jump, the estimate starts there.
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    for i in 0..20 {
        supervisor.tick(&sample(i, [1e-6 * i as f32, 0.0]));
    }
    let command = supervisor.tick(&sample(25, [-1.5e-4, 1e-5]));
    assert!(command.events.contains(Events::SEQUENCE));
    assert_eq!(command.limits, Limits::empty());
    assert_eq!(command.mode, Mode::Levitated, "at rest there");
}

/// Gaps that come again and again make nothing of the noise of a rotor that stands still under a force and a load.
/// Requirement: SR-10
#[test]
fn repeated_gaps_do_not_engage() {
    for (missed, good) in (1..=4).flat_map(|missed| (1..=5).map(move |good| (missed, good))) {
        let mut supervisor = Supervisor::<16>::new(&config()).unwrap();
        for i in 0..3000_u32 {
            let noise = |k: u32| 1e-6 * ((f64::from(i + k) * 0.618_034).fract() as f32 - 0.5);
            let command = supervisor.tick(&Sample {
                levitation_n: [100.0, 0.0],
                ..sample(i + i / good * missed, [noise(0), noise(1000)])
            });
            assert_eq!(command.mode, Mode::Levitated, "{missed} after {good}");
        }
    }
}

/// A number that counts the samples that should have come is not taken for missed ticks after a dropout.
#[test]
fn a_dropout_may_or_may_not_use_up_a_number() {
    for next in [6, 7] {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        for i in 0..6 {
            supervisor.tick(&sample(i, [1e-6 * i as f32, 0.0]));
        }
        let repeated = Sample {
            sequence: 5,
            ..sample(0, [5e-6, 0.0])
        };
        assert!(supervisor.tick(&repeated).events.contains(Events::SEQUENCE));
        let command = supervisor.tick(&sample(next, [7e-6, 0.0]));
        assert!(!command.events.contains(Events::SEQUENCE));
    }
}

/// However far the model runs away while samples are refused, which a pull of the magnets makes it do, the supervisor follows
/// the rotor again as soon as samples are good.
#[test]
fn samples_refused_for_long_leave_an_estimate_that_comes_back() {
    let with = Config {
        // A pull of nine tenths of the cap at the wall: the model runs away twofold in each millisecond.
        stiffness_n_m: -0.9 * 1000.0 / 2e-4,
        fault_ticks: 10_000.0,
        ..config()
    };
    let run = |refused: u32| {
        let mut bench = Bench::new(&with);
        for i in 0..100 {
            bench.tick([2e-5, 1e-7 * (i % 3) as f32]);
        }
        for _ in 0..refused {
            bench.tick([f32::NAN; 2]);
        }
        let whirl = (0..200).map(|i| bench.tick(on_circle(RADIUS_M, WHIRL_STEP * i as f32)));
        let last = whirl.last().unwrap();
        assert_eq!(last.mode, Mode::BackwardWhirl, "{refused}");
        last.force_n
    };
    let [with, without] = [run(9000), run(0)];
    assert!(
        length([with[0] - without[0], with[1] - without[1]]) < 10.0,
        "{with:?} {without:?}"
    );
}
