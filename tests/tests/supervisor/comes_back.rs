//! No state that the supervisor gets into may keep it: what a sensor, a counter or a load does for a while ends
//! with it, and what is wrong for good is a fault.

use supervisor::{Command, Config, Events, Mode, RejectReason, Supervisor};
use system_tests::rig::{RADIUS_M, WHIRL_STEP, config, length, on_circle, sample};

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

/// Ticks of a whirl whose sequence numbers are a function of the tick.
fn counted(number: impl Fn(u32) -> u32) -> Vec<Command> {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    (0..200_u32)
        .map(|i| {
            let position_m = on_circle(RADIUS_M, WHIRL_STEP * i as f32);
            supervisor.tick(&sample(number(i), position_m))
        })
        .collect()
}

/// Numbers that jump at every tick, or run backwards, compare no sample with any other: a fault within three ticks, and
/// not a guard that is off.
/// Requirement: SR-14
#[test]
fn numbers_that_do_not_count_are_a_fault() {
    let numbers: [fn(u32) -> u32; 2] = [|i| 6 * i, |i| 1000 - i];
    for number in numbers {
        let commands = counted(number);
        let fault = commands.iter().position(|c| c.mode == Mode::SensorFault);
        assert!(fault.is_some_and(|i| i <= 4), "{fault:?}");
        let mut later = commands.iter().skip(4);
        assert!(later.all(|c| c.mode == Mode::SensorFault));
    }
}

/// Two samples in the wrong order: the older one is no new sample, and four thousand million ticks were not missed.
/// Requirement: SR-14
#[test]
fn an_older_number_is_no_new_sample() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut refused = 0;
    for i in 0..200_u32 {
        let number = match i {
            100 => 101,
            101 => 100,
            other => other,
        };
        supervisor.tick(&sample(
            number,
            on_circle(RADIUS_M, WHIRL_STEP * number as f32),
        ));
        refused += u32::from(supervisor.report().refusal == RejectReason::Dropout);
    }
    assert_eq!(refused, 1);
    assert_eq!(supervisor.mode(), Mode::BackwardWhirl);
    let report = supervisor.report();
    assert!(report.missed_ticks <= 2, "{}", report.missed_ticks);
}

/// A rotor that has touched nothing loses its force as fast in the second of two faults as in the first.
#[test]
fn a_second_fault_of_a_levitated_rotor_is_no_slower() {
    let with = Config {
        fault_blend_s: 2e-2,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut i = 0;
    let mut tick = |supervisor: &mut Supervisor<64>, good: bool| {
        i += 1;
        let jitter_m = 1e-8 * (i % 7) as f32;
        let x = if good { 2e-5 + jitter_m } else { f32::NAN };
        let mut s = sample(i, [x, jitter_m]);
        s.levitation_n = [-300.0, 0.0];
        supervisor.tick(&s)
    };
    for _ in 0..100 {
        tick(&mut supervisor, true);
    }
    let mut ticks_to_nothing = || {
        let mut ticks = 0;
        loop {
            let command = tick(&mut supervisor, false);
            ticks += u32::from(command.mode == Mode::SensorFault);
            if length(command.force_n) == 0.0 {
                break;
            }
            assert!(ticks < 1000);
        }
        // Good samples end the fault; some more, and the next begins before the bearing is handed back.
        while tick(&mut supervisor, true).mode == Mode::SensorFault {}
        for _ in 0..3 {
            tick(&mut supervisor, true);
        }
        ticks
    };
    let first = ticks_to_nothing();
    let second = ticks_to_nothing();
    let blend_ticks = (with.handover_blend_s / with.sample_period_s).round() as u32;
    assert!(
        first <= blend_ticks && second <= blend_ticks,
        "{first}, {second}"
    );
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
