//! A sensor that stands still: found while the rotor moves, left alone where it rightly does, believed when it changes again.

use super::refusals::ticks_to_fault;
use super::trust::{C_M, noise};
use supervisor::{Events, Limits, Mode, RejectReason, Supervisor};
use test_support::bench::{Bench, WHIRL_STEP};
use test_support::rig::{RADIUS_M, config, on_circle, sample};
use test_support::storm::Chance;

/// In a whirl, at an angle at which both coordinates move.
fn where_both_move() -> (Bench, f32) {
    let (mut bench, mut angle) = Bench::whirl(&config());
    while !(0.6..0.9).contains(&angle.rem_euclid(std::f32::consts::PI)) {
        angle += WHIRL_STEP;
        bench.tick(on_circle(RADIUS_M, angle));
    }
    (bench, angle)
}

/// A sensor that stands still while the rotor moves is a fault within ten ticks: both coordinates, or
/// one of them; in flight and in contact; at any speed of three steps in some ticks.
/// Requirement: SR-15
#[test]
fn a_stuck_sensor_is_a_fault_within_ten_ticks() {
    for stuck in [[true, true], [true, false], [false, true]] {
        let (mut bench, angle) = where_both_move();
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

/// A coordinate that jumps, no farther than a rotor might, and stands still at once is stuck with its second sample; one that goes on
/// from there is a rotor that was struck.
/// Requirement: SR-15
#[test]
fn what_jumps_and_stands_still_is_stuck() {
    for (still, axis) in [(true, 0), (true, 1), (false, 0), (false, 1)] {
        let mut bench = Bench::new(&config());
        let mut chance = Chance::new(7);
        for _ in 0..400 {
            bench.tick([0, 1].map(|_| noise(&mut chance, 4e-7)));
        }
        assert_eq!(bench.supervisor.mode(), Mode::Levitated);
        for i in 0..2 {
            let mut at = [0, 1].map(|_| noise(&mut chance, 4e-7));
            at[axis] = 0.4 * C_M + if still { 0.0 } else { 2e-5 * i as f32 };
            bench.tick(at);
        }
        let stuck = bench.supervisor.report().refusal == RejectReason::Stuck;
        assert_eq!(stuck, still, "axis {axis}");
    }
}

/// Electronics that die one channel after the other are a fault as soon as neither has changed for three samples.
/// Requirement: SR-15
#[test]
fn coordinates_may_stick_one_after_the_other() {
    for later in 0..4_u32 {
        let (mut bench, angle) = where_both_move();
        let at = |ticks: u32| on_circle(RADIUS_M, angle + WHIRL_STEP * ticks as f32);
        let ticks = ticks_to_fault(|ticks| bench.tick([at(0)[0], at(ticks.min(later))[1]]));
        // At this speed no converter hides two ticks of standstill.
        assert!((2..=3).contains(&ticks), "{ticks}");
    }
}

/// No sample of a reading is refused.
fn is_left_alone(ticks: u32, at: impl Fn(u32) -> [f32; 2]) {
    let mut bench = Bench::new(&config());
    for i in 0..ticks {
        let refused = bench.tick(at(i)).limits.contains(Limits::SAMPLE_REFUSED);
        let why = bench.supervisor.report().refusal;
        assert_eq!(
            (refused, why),
            (false, RejectReason::None),
            "{:?}: {i}",
            at(i)
        );
    }
}

/// A sensor that rightly stands still is left alone: a rotor at rest in the middle, on the wall under a
/// force, or with a coarse converter.
/// Requirement: SR-15
#[test]
fn a_rotor_at_rest_is_no_stuck_sensor() {
    for [x, y] in [[0.0, 0.0], [1e-4, -5e-5], [2.01e-4, 0.0]] {
        // One step of the converter now and then.
        is_left_alone(2000, |i| [x + 1e-6 * (i / 300 % 2) as f32, y]);
    }
}

/// A coordinate that toggles by the step of its converter is no stuck sensor, whatever its pattern: every
/// return to the value before the last is a change, too.
#[test]
fn a_toggling_coordinate_is_not_stuck() {
    for pattern in [[0, 1, 1, 2], [0, 1, 1, 1], [1, 1, 2, 0], [0, 1, 0, 1]] {
        let step = |k: u32| 1e-6 * pattern[(k % 4) as usize] as f32;
        is_left_alone(3000, |i| [step(i), step(i / 2 + 1)]);
    }
}

/// A rotor at rest deep in the wall, on a sensor with steps: its first sample is taken for a whirl, but a guess is no
/// motion that a sensor could fail to show.
#[test]
fn a_guess_makes_no_stuck_sensor() {
    for radius in [1.025, 1.05, 1.5] {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        for i in 0..200 {
            // A step of the sensor now and then.
            let step_m = if i % 50 < 25 { 0.0 } else { 1e-6 };
            let command = supervisor.tick(&sample(i, [radius * 2e-4 + step_m, 1e-5]));
            assert!(!command.events.contains(Events::SENSOR_FAULT), "{radius}");
        }
        assert_eq!(supervisor.mode(), Mode::Pinned, "{radius}");
    }
}

/// A coordinate that has changed beside one that was no number has changed: it is not stuck in the sample after it.
#[test]
fn a_change_beside_a_bad_coordinate_is_a_change() {
    for still in 0..2 {
        let mut bench = Bench::new(&config());
        let mut position_m = [0.0; 2];
        let on = |by: [f32; 2], from: &mut [f32; 2]| {
            *from = [from[0] + by[0], from[1] + by[1]];
            *from
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

/// After a doubted sample a coordinate that a coarse converter merely repeats is not stuck.
/// Requirement: SR-16
#[test]
fn what_a_coarse_converter_repeats_beside_a_doubted_sample_is_not_stuck() {
    let mut bench = Bench::new(&config());
    let mut chance = Chance::new(3);
    let mut doubted = 0;
    for i in 0..400 {
        let off = if i >= 200 && i % 20 == 0 { 0.3 } else { 0.0 };
        let repeated = 2e-6 * (i / 3 % 2) as f32;
        let command = bench.tick([off * C_M + noise(&mut chance, 5e-7), repeated]);
        assert_eq!(command.mode, Mode::Levitated, "{i}");
        let refused = command.limits.contains(Limits::SAMPLE_REFUSED);
        assert_eq!(refused, off > 0.0, "{i}");
        doubted += u32::from(bench.supervisor.report().refusal == RejectReason::Doubted);
    }
    assert_eq!(doubted, 10);
}

/// After a sensor that was stuck no sample counts as good before both coordinates have changed; then the rotor may
/// rest, and they need not change any more.
/// Requirement: SR-19
#[test]
fn a_stuck_sensor_is_not_believed_before_it_changes() {
    let good_after = |read_m: &dyn Fn([f32; 2], u32) -> [f32; 2]| {
        let (mut bench, angle) = Bench::whirl(&config());
        let last = on_circle(RADIUS_M, angle);
        bench.ticks(500, last);
        assert_eq!(bench.supervisor.mode(), Mode::SensorFault);
        assert_eq!(bench.supervisor.report().fault, RejectReason::Stuck);
        let mut ticks = 1..100;
        ticks.find(|i| bench.tick(read_m(last, *i)).mode != Mode::SensorFault)
    };
    // x changes at 5, y at 8.
    let step_m = |i: u32, at: u32| if i < at { 0.0 } else { 1e-7 };
    let one_by_one = good_after(&|[x, y], i| [x - step_m(i, 5), y - step_m(i, 8)]);
    assert_eq!(one_by_one, Some(8 + 9), "ten from the second change on");
    // At rest somewhere else: one sample that is too far from the frozen one, and ten good ones at most.
    let at_rest = good_after(&|_, _| [-RADIUS_M, 3e-6]);
    assert!(at_rest.is_some_and(|i| i <= 12), "{at_rest:?}");
}
