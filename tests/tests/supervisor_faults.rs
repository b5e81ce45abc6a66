//! A fault of the sensor: what the supervisor does in it, and how it comes back.

use supervisor::{Command, Config, Events, Mode, Refusal, Sample, Status};
use system_tests::bench::{Bench, WHIRL_STEP};
use system_tests::rig::{RADIUS_M, config, length, on_circle, sample};

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
