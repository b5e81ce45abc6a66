//! Samples that cannot be: how soon the supervisor knows, what it does, and how it comes back.

use supervisor::{Command, Config, Events, Limits, Mode, Refusal, Sample, Status, Supervisor};
use system_tests::rig::{config, length, on_circle, sample};

/// A supervisor with its counter of samples.
struct Bench {
    supervisor: Supervisor<64>,
    sequence: u32,
}

impl Bench {
    fn new(config: &Config) -> Self {
        Self {
            supervisor: Supervisor::new(config).unwrap(),
            sequence: 0,
        }
    }

    fn tick(&mut self, position_m: [f32; 2]) -> Command {
        self.sequence = self.sequence.wrapping_add(1);
        self.tick_again(position_m)
    }

    /// Without a new number.
    fn tick_again(&mut self, position_m: [f32; 2]) -> Command {
        self.supervisor.tick(&sample(self.sequence, position_m))
    }

    /// Whirls backward on the wall until it is braked, 20 µm a tick, and says at which angle it is.
    fn whirl(config: &Config) -> (Self, f32) {
        let mut bench = Self::new(config);
        let mut angle = 0.0;
        for _ in 0..200 {
            angle += WHIRL_STEP;
            let command = bench.tick(on_circle(RADIUS_M, angle));
            assert!(!command.limits.contains(Limits::SAMPLE_REFUSED));
        }
        assert_eq!(bench.supervisor.mode(), Mode::BackwardWhirl);
        (bench, angle)
    }
}

const RADIUS_M: f32 = 2.05e-4;
/// Angle of the whirl in a tick; in 70 ticks not the same coordinate twice.
const WHIRL_STEP: f32 = 0.0977;

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
#[test]
fn what_is_no_number_or_out_of_range_is_refused_at_once() {
    let cases = [
        ([f32::NAN, 0.0], Refusal::NotFinite),
        ([0.0, f32::INFINITY], Refusal::NotFinite),
        ([f32::MAX, 0.0], Refusal::NotFinite),
        ([0.0, 20.1 * 2e-4], Refusal::Range),
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
#[test]
fn a_jump_that_stays_is_a_fault_within_two_ticks() {
    let (mut bench, angle) = Bench::whirl(&config());
    let ticks = ticks_to_fault(|i| {
        let [x, y] = on_circle(RADIUS_M, angle + WHIRL_STEP * i as f32);
        bench.tick([x + 6e-4, y])
    });
    assert_eq!(ticks, 2);
    assert_eq!(bench.supervisor.report().fault, Refusal::Slew);
}

/// The way that is allowed is speed_max·T and three steps of the sensor, for each tick since the last
/// good sample.
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
#[test]
fn a_dropout_is_a_fault_within_three_ticks() {
    let (mut bench, angle) = Bench::whirl(&config());
    let ticks = ticks_to_fault(|_| {
        let command = bench.tick_again(on_circle(RADIUS_M, angle));
        assert!(command.events.contains(Events::SEQUENCE));
        command
    });
    assert_eq!(ticks, 3);
    assert_eq!(bench.supervisor.report().fault, Refusal::Dropout);
}

/// A sensor that stands still while the rotor moves is a fault within ten ticks: both coordinates, or
/// one of them; in flight and in contact; at any speed of three steps in some ticks.
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
        assert_eq!(bench.supervisor.report().fault, Refusal::Stuck);
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

/// A sensor that rightly stands still is left alone: a rotor at rest in the middle, on the wall under a
/// force, or with a coarse converter.
#[test]
fn a_rotor_at_rest_is_no_stuck_sensor() {
    for position_m in [[0.0, 0.0], [1e-4, -5e-5], [2.01e-4, 0.0]] {
        let mut bench = Bench::new(&config());
        for i in 0..2000_u32 {
            // One step of the converter now and then.
            let step = if i / 300 % 2 == 0 { 0.0 } else { 1e-6 };
            bench.tick([position_m[0] + step, position_m[1]]);
            let report = bench.supervisor.report();
            assert_eq!(report.refusal, Refusal::None, "{position_m:?} at {i}");
        }
    }
}

/// A single bad sample of any kind costs no force, makes no fault and gives the estimate no kick: the
/// commands stay near those of a run without it.
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

/// In a fault each component falls by the same in every tick, the cap in `fault_blend_s`, and stays zero as long as the
/// sensor is bad.
#[test]
fn the_force_is_blended_to_zero_in_the_configured_time() {
    for blend_s in [0.0_f32, 5e-4, 2e-3] {
        let with = Config {
            fault_blend_s: blend_s,
            ..config()
        };
        let (mut bench, _) = Bench::whirl(&with);
        let forces: Vec<[f32; 2]> = (0..200)
            .map(|_| bench.tick([f32::NAN; 2]).force_n)
            .skip(8)
            .collect();
        let (last, fading) = forces.split_first().unwrap();
        assert!(length(*last) > 990.0);
        let ticks = (blend_s / 50e-6).round().max(1.0);
        for (i, force) in fading.iter().enumerate() {
            for axis in 0..2 {
                let left = (last[axis].abs() - 1000.0 * (i + 1) as f32 / ticks).max(0.0);
                let off = force[axis] - left.copysign(last[axis]);
                assert!(off.abs() < 0.1, "{i} of {ticks}: {force:?} after {last:?}");
            }
        }
        assert!(fading[ticks as usize - 1..].iter().all(|f| *f == [0.0; 2]));
    }
}

/// Where one coordinate is no number or out of range, the force along it goes to zero in the time of a hand-over, and along
/// the other the levitation controller acts from the first tick on, bit for bit, whatever it makes of the bad one. Once the
/// other is wrong too, the force along that fades as well.
#[test]
fn a_coordinate_that_is_good_is_left_to_the_levitation_controller() {
    let with = Config {
        fault_blend_s: 1e-2,
        position_limit: 4.0,
        ..config()
    };
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
                bench.sequence += 1;
                bench.supervisor.tick(&Sample {
                    levitation_n: levitation(i),
                    ..sample(bench.sequence, position_m)
                })
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

/// Of a jump, a dropout or a sensor that is stuck nobody knows which coordinate is wrong: nothing of the levitation controller
/// goes through.
#[test]
fn what_may_concern_both_coordinates_leaves_neither() {
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
            last = bench.supervisor.tick(&Sample {
                levitation_n: [300.0, 300.0],
                ..sample(bench.sequence, position_m)
            });
        }
        assert_eq!(last.mode, Mode::SensorFault);
        assert_eq!(last.force_n, [0.0; 2], "kind {kind}");
    }
}

/// In mode Levitated the controller's answer to a sample that cannot be does not go through, since it saw the same reading: the
/// command before it stays, to a rounding. In shadow, with the bearing off, and where a sample is merely missing, it does.
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

/// A fault ends with the K-th good sample in a row and not before, whatever it was about, and what the
/// estimate was before has no part in what comes after.
#[test]
fn a_fault_ends_after_enough_good_samples_in_a_row() {
    for good_ticks in [2_u32, 10, 25] {
        let with = Config {
            fault_ticks: good_ticks as f32,
            ..config()
        };
        let after = |whirl: bool| {
            let mut bench = if whirl {
                Bench::whirl(&with).0
            } else {
                Bench::new(&with)
            };
            while bench.supervisor.mode() != Mode::SensorFault {
                bench.tick([f32::NAN; 2]);
            }
            for _ in 0..100 {
                bench.tick([f32::NAN; 2]);
            }
            // One too few, and a bad one.
            for i in 0..good_ticks - 1 {
                let command = bench.tick([3e-5, 1e-7 * i as f32]);
                assert_eq!(command.mode, Mode::SensorFault);
                assert_eq!(command.force_n, [0.0; 2]);
            }
            bench.tick([f32::NAN; 2]);
            let mut forces = Vec::new();
            for i in 1..=2 * good_ticks {
                let command = bench.tick([3e-5, 1e-7 * i as f32]);
                let ended = i >= good_ticks;
                assert_eq!(command.mode != Mode::SensorFault, ended, "{i}");
                assert_eq!(command.events.contains(Events::SENSOR_OK), i == good_ticks);
                forces.push(command.force_n);
            }
            forces
        };
        assert_eq!(after(true), after(false));
    }
}

/// After a sensor that was stuck no sample counts as good before both coordinates have changed; then the rotor may
/// rest, and they need not change any more.
#[test]
fn a_stuck_sensor_is_not_believed_before_it_changes() {
    let (mut bench, angle) = Bench::whirl(&config());
    let last = on_circle(RADIUS_M, angle);
    for _ in 0..500 {
        bench.tick(last);
    }
    assert_eq!(bench.supervisor.mode(), Mode::SensorFault);
    let ticks = (1..100)
        .find(|i| {
            // x changes at 5, y at 8.
            let [x, y] = [5, 8].map(|from| if *i < from { 0.0 } else { 1e-7 });
            bench.tick([last[0] - x, last[1] - y]).mode != Mode::SensorFault
        })
        .unwrap();
    assert_eq!(ticks, 8 + 9, "ten samples from the second change on");
}

/// The same of a rotor that has come to rest meanwhile, so that nothing changes any more after the first new sample.
#[test]
fn a_rotor_at_rest_ends_a_stuck_sensors_fault() {
    let (mut bench, angle) = Bench::whirl(&config());
    let last = on_circle(RADIUS_M, angle);
    for _ in 0..200 {
        bench.tick(last);
    }
    assert_eq!(bench.supervisor.mode(), Mode::SensorFault);
    assert_eq!(bench.supervisor.report().fault, Refusal::Stuck);
    let ticks = (1..100).find(|_| bench.tick([-RADIUS_M, 3e-6]).mode != Mode::SensorFault);
    // One sample that is too far from the frozen one, and ten good ones at most.
    assert!(
        ticks.is_some_and(|i| i <= 2 + config().fault_ticks as u32),
        "{ticks:?}"
    );
}

/// Over some missed ticks the model carries the estimate: the force is what it would have been.
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

/// In shadow a fault of the sensor takes nothing from the levitation command, and what the supervisor would command still leaves
/// out what the controller makes of the bad coordinate.
#[test]
fn in_shadow_a_fault_takes_nothing_from_the_levitation_controller() {
    let (mut bench, angle) = Bench::whirl(&config());
    for i in 0..100 {
        let [_, y] = on_circle(RADIUS_M, angle + WHIRL_STEP * i as f32);
        bench.sequence += 1;
        let mut now = sample(bench.sequence, [f32::NAN, y]);
        now.status |= Status::SHADOW;
        now.levitation_n = [-800.0, 500.0];
        let command = bench.supervisor.tick(&now);
        assert_eq!(command.force_n, now.levitation_n);
        if i > 70 {
            assert_eq!(command.mode, Mode::SensorFault);
            assert_eq!(command.own_n, [0.0, 500.0]);
        }
    }
}
