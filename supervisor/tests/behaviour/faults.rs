//! A fault of the sensor: what the supervisor does in it, and how it comes back.

use supervisor::{Command, Config, Events, Mode, Status, Supervisor};
use test_support::bench::{Bench, WHIRL_STEP};
use test_support::rig::{RADIUS_M, apart, asking, config, config_with, length, on_circle};

/// In a fault each component falls by the same in every tick, the cap in `fault_blend_s`, and stays zero as long as the
/// sensor is bad.
/// Requirement: SR-17
#[test]
fn the_force_is_blended_to_zero_in_the_configured_time() {
    for blend_s in [0.0_f32, 5e-4, 2e-3] {
        let with = config_with(|c| c.fault_blend_s = blend_s);
        let (mut bench, _) = Bench::whirl(&with);
        let forces = (0..200).map(|_| bench.tick([f32::NAN; 2]).force_n);
        let forces: Vec<[f32; 2]> = forces.skip(8).collect();
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

/// A fault ends with the K-th good sample in a row and not before, whatever it was about and however long it was, and what
/// the estimate was before has no part in what comes after.
/// Requirement: SR-19
#[test]
fn a_fault_ends_after_enough_good_samples_in_a_row() {
    for good_ticks in [2_u32, 10, 25] {
        let with = config_with(|c| c.fault_ticks = good_ticks as f32);
        let after = |mut bench: Bench, bad_ticks: u32| {
            while bench.supervisor.mode() != Mode::SensorFault {
                bench.tick([f32::NAN; 2]);
            }
            bench.ticks(bad_ticks, [f32::NAN; 2]);
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
        let whirl = || Bench::whirl(&with).0;
        let forces = after(whirl(), 100);
        assert_eq!(forces, after(Bench::new(&with), 100));
        assert_eq!(forces, after(whirl(), 5000));
        // At rest near the middle.
        assert!(forces.iter().all(|force_n| length(*force_n) < 200.0));
    }
}

/// The force of a rotor that has touched nothing falls in the time of a hand-over, in the second of two faults as in the first.
/// Requirement: SR-17
#[test]
fn a_levitated_rotor_loses_its_force_in_the_time_of_a_hand_over() {
    let with = config_with(|c| c.fault_blend_s = 2e-2);
    let step_n = 1000.0 * with.sample_period_s / with.handover_blend_s;
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut i = 0;
    let mut tick = |good: bool| {
        i += 1;
        let jitter_m = 1e-8 * (i % 7) as f32;
        let position_m = [[f32::NAN; 2], [2e-5 + jitter_m, jitter_m]][usize::from(good)];
        supervisor.tick(&asking(i, position_m, [-900.0, 0.0]))
    };
    for _ in 0..100 {
        assert_eq!(tick(true).mode, Mode::Levitated);
    }
    for _ in 0..2 {
        let refused: Vec<Command> = (0..100).map(|_| tick(false)).collect();
        let in_fault = |c: &Command| c.mode == Mode::SensorFault;
        let fault = refused.iter().position(in_fault).unwrap();
        assert_eq!(fault, 9, "ten ticks");
        let from_n = refused[fault - 1].force_n[0];
        for (i, command) in refused[fault..].iter().enumerate() {
            let left_n = (from_n + step_n * (i + 1) as f32).min(0.0);
            assert!((command.force_n[0] - left_n).abs() < 0.01, "{command:?}");
            assert_eq!(command.force_n[1], 0.0);
        }
        // Good samples end the fault; some more, and the next begins before the bearing is handed back.
        while tick(true).mode == Mode::SensorFault {}
        for _ in 0..3 {
            tick(true);
        }
    }
}

/// After a gap that cannot be made up for a sample that cannot be leaves nothing to go by: that is a fault at once, in which
/// the force fades, and no law acts on a position that nobody knows.
#[test]
fn without_any_sample_no_law_acts() {
    for bad in [[f32::NAN; 2], [1.0, 1.0]] {
        let (mut bench, angle) = Bench::whirl(&config());
        let before = bench.tick(on_circle(RADIUS_M, angle + WHIRL_STEP)).force_n;
        bench.sequence += 6;
        let mut last = before;
        for i in 0..8 {
            let command = bench.tick(bad);
            assert_eq!(command.mode, Mode::SensorFault);
            assert_eq!(command.events.contains(Events::SENSOR_FAULT), i == 0);
            // Along each axis it keeps its sign and falls.
            for (now, last) in command.force_n.into_iter().zip(last) {
                let falls = now * last >= 0.0 && now.abs() <= last.abs();
                assert!(falls, "{command:?} after {last:?}");
            }
            last = command.force_n;
        }
        assert!(length(last) < 0.7 * length(before));
    }
}

/// What nobody saw was no contact: a rotor that had just touched when the sensor failed is not whirling because of that.
#[test]
fn unseen_time_is_no_time_in_contact() {
    let with = config_with(|c| c.fault_ticks = 4.0);
    let mut bench = Bench::new(&with);
    for i in 0..60 {
        bench.tick(on_circle(1.8e-4, 0.09 * i as f32));
    }
    bench.tick(on_circle(RADIUS_M, 5.4));
    bench.ticks(200, [f32::NAN; 2]);
    let mut events = Events::empty();
    for i in 0..40 {
        let radius_m = if i == 6 { RADIUS_M } else { 1.85e-4 };
        events |= bench.tick(on_circle(radius_m, 0.09 * i as f32)).events;
    }
    assert!(events.contains(Events::SENSOR_OK | Events::TOUCHED));
    assert!(!events.contains(Events::WHIRL), "{events:?}");
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
        bench.ticks(refused, [f32::NAN; 2]);
        let whirl = (0..200).map(|i| bench.tick(on_circle(RADIUS_M, WHIRL_STEP * i as f32)));
        let last = whirl.last().unwrap();
        assert_eq!(last.mode, Mode::BackwardWhirl, "{refused}");
        last.force_n
    };
    let [with, without] = [run(9000), run(0)];
    assert!(apart(with, without) < 10.0, "{with:?} {without:?}");
}

/// In shadow a fault of the sensor takes nothing from the levitation command, and what the supervisor would command still leaves
/// out what the controller makes of the bad coordinate.
/// Requirement: SR-09
#[test]
fn in_shadow_a_fault_takes_nothing_from_the_levitation_controller() {
    let (mut bench, angle) = Bench::whirl(&config());
    for i in 0..100 {
        let [_, y] = on_circle(RADIUS_M, angle + WHIRL_STEP * i as f32);
        let command = bench.tick_with([f32::NAN, y], |now| {
            now.status |= Status::SHADOW;
            now.levitation_n = [-800.0, 500.0];
        });
        assert_eq!(command.force_n, [-800.0, 500.0]);
        if i > 70 {
            assert_eq!(command.mode, Mode::SensorFault);
            assert_eq!(command.own_n, [0.0, 500.0]);
        }
    }
}
