//! Numbers of samples: missed, repeated, in the wrong order, and gaps that cannot be made up for.

use super::refusals::ticks_to_fault;
use supervisor::{Events, Limits, Mode, RejectReason, Supervisor};
use test_support::bench::{Bench, WHIRL_STEP};
use test_support::rig::{RADIUS_M, apart, asking, config, on_circle, sample};

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

/// Numbers that jump at every tick, or run backwards, compare no sample with any other: a fault within three ticks, and
/// not a guard that is off.
/// Requirement: SR-14
#[test]
fn numbers_that_do_not_count_are_a_fault() {
    let numbers: [fn(u32) -> u32; 2] = [|i| 6 * i, |i| 1000 - i];
    for number in numbers {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        for i in 0..200_u32 {
            let position_m = on_circle(RADIUS_M, WHIRL_STEP * i as f32);
            let mode = supervisor.tick(&sample(number(i), position_m)).mode;
            assert!(i < 4 || mode == Mode::SensorFault, "{i}");
        }
    }
}

/// Two samples in the wrong order: the older one is no new sample, and four thousand million ticks were not missed.
/// Requirement: SR-14
#[test]
fn an_older_number_is_no_new_sample() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut refused = 0;
    for i in 0..200_u32 {
        let number = if i / 2 == 50 { i ^ 1 } else { i };
        let position_m = on_circle(RADIUS_M, WHIRL_STEP * number as f32);
        supervisor.tick(&sample(number, position_m));
        refused += u32::from(supervisor.report().refusal == RejectReason::Dropout);
    }
    assert_eq!(refused, 1);
    assert_eq!(supervisor.mode(), Mode::BackwardWhirl);
    let report = supervisor.report();
    assert!(report.missed_ticks <= 2, "{}", report.missed_ticks);
}

/// Missed and repeated ticks are reported and counted, and a repeated sample is not used twice.
/// Requirement: SR-20
#[test]
fn missed_and_repeated_ticks_are_counted() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut last = u32::MAX;
    for sequence in [0, 1, 2, 5, 5, 6, 17, 18] {
        let at_m = 1e-7 * sequence as f32;
        let command = supervisor.tick(&sample(sequence, [at_m, -2.0 * at_m]));
        let ahead = sequence.wrapping_sub(last);
        assert_eq!(command.events.contains(Events::SEQUENCE), ahead != 1);
        assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), ahead == 0);
        last = sequence;
    }
    let report = supervisor.report();
    assert_eq!((report.missed_ticks, report.repeated_ticks), (2 + 10, 1));
}

/// Over some missed ticks the estimate coasts: the force is within a tenth of the cap of what it would have been.
/// Requirement: SR-20
#[test]
fn missed_ticks_are_made_up_for() {
    for missed in 1..=4_u32 {
        let run = |skips: bool| {
            let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
            let ticks = (0..14_u32).filter(|i| !(skips && (6..6 + missed).contains(i)));
            // 0.16 m/s along x: too fast for the way that is left.
            let at = |i: u32| sample(i, [8e-6 * i as f32 + 2e-5, 1e-8 * i as f32]);
            ticks.map(|i| supervisor.tick(&at(i))).last().unwrap()
        };
        let (with, without) = (run(false), run(true));
        assert_eq!(with.mode, without.mode);
        let off_n = apart(with.force_n, without.force_n);
        assert!(off_n < 100.0, "{missed}: {off_n}");
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
            let (sequence, at_m) = (i + i / good * missed, [noise(0), noise(1000)]);
            let command = supervisor.tick(&asking(sequence, at_m, [100.0, 0.0]));
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
        let repeated = sample(5, [5e-6, 0.0]);
        assert!(supervisor.tick(&repeated).events.contains(Events::SEQUENCE));
        let command = supervisor.tick(&sample(next, [7e-6, 0.0]));
        assert!(!command.events.contains(Events::SEQUENCE));
    }
}

/// Two long gaps with usual samples in between are not two in a row, whichever way those are judged.
#[test]
fn gaps_far_apart_are_not_in_a_row() {
    let (mut bench, mut angle) = Bench::whirl(&config());
    let rows = [(6, 1, false), (0, 50, false), (6, 1, false), (6, 1, true)];
    for (gap, ticks, refused) in rows {
        bench.sequence += gap;
        for _ in 0..ticks {
            angle += WHIRL_STEP;
            let command = bench.tick(on_circle(RADIUS_M, angle));
            assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), refused);
        }
    }
    assert_eq!(bench.supervisor.report().refusal, RejectReason::Dropout);
}

/// A gap in a whirl, which leaves the speed unknown for a tick, is no rest.
#[test]
fn a_gap_in_a_whirl_is_no_rest() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    for i in 0..400_u32 {
        let number = if i < 200 { i } else { i + 6 };
        let position_m = on_circle(RADIUS_M, WHIRL_STEP * number as f32);
        let command = supervisor.tick(&sample(number, position_m));
        let moving = matches!(command.mode, Mode::BackwardWhirl | Mode::Bounce);
        assert!(moving || i < 100, "{i}: {command:?}");
    }
}

/// Only the very first sample is taken so: after missed ticks a rotor that a load presses into the wall is held on.
#[test]
fn a_gap_makes_no_whirl_of_a_load() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut events_after = Events::empty();
    for i in 0..400 {
        let jitter_m = 1e-8 * (i % 7) as f32;
        // A gap of six ticks at 200.
        let sequence = if i < 200 { i } else { i + 6 };
        let command = supervisor.tick(&sample(sequence, [RADIUS_M + jitter_m, jitter_m]));
        if i == 199 {
            assert_eq!(command.mode, Mode::Pinned);
        }
        if i >= 200 {
            events_after |= command.events;
            let [x, y] = command.force_n;
            assert!(x < -300.0 && y.abs() < 300.0, "{i}: {command:?}");
        }
    }
    assert!(events_after.contains(Events::SEQUENCE) && !events_after.contains(Events::WHIRL));
}
