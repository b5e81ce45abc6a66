//! Both ends of one rotor: who is told what, and records that belong together.

use firmware_image::under_test::{half_a_turn, shaft};
use supervisor::{Config, Events, Mode, Rotor, RotorCommand, Sample};
use system_tests::rig::{RADIUS_M, WHIRL_STEP, config, on_circle, sample};

/// Ticks to the wall, and of whirl on it.
const OUT: u32 = 40;
const ON_WALL: u32 = 120;
const BACK: u32 = 100;
const RECORD: usize = 64;

/// A rotor that is led from the centre to the wall, round on it backwards, and back, from a tick on.
fn led(tick: u32, from: u32) -> [f32; 2] {
    let Some(i) = tick.checked_sub(from) else {
        return [0.0; 2];
    };
    let share = if i < OUT {
        i as f32 / OUT as f32
    } else if i < OUT + ON_WALL {
        1.0
    } else {
        1.0 - ((i - OUT - ON_WALL) as f32 / BACK as f32).min(1.0)
    };
    let turns = i.clamp(OUT, OUT + ON_WALL) - OUT;
    on_circle(share * RADIUS_M, WHIRL_STEP * turns as f32)
}

/// Ticks of both ends, each led from a tick on; `None`: it stays in the middle.
fn run(
    rotor: &mut Rotor<RECORD>,
    ticks: std::ops::Range<u32>,
    from: [Option<u32>; 2],
) -> Vec<RotorCommand> {
    ticks
        .map(|i| {
            let at = |from: Option<u32>| from.map_or([0.0; 2], |from| led(i, from));
            // No sensor stands still to the last digit.
            let noise = 1e-6 * (i % 3) as f32;
            let samples = from.map(|from| sample(i, at(from).map(|x| x + noise)));
            rotor.tick(&samples)
        })
        .collect()
}

fn rotor(config: &Config) -> Rotor<RECORD> {
    Rotor::new(&shaft(config), &[*config; 2]).unwrap()
}

fn engaged_at(commands: &[RotorCommand], end: usize) -> Option<usize> {
    let engages = |c: &RotorCommand| c.planes[end].events.contains(Events::ENGAGED);
    commands.iter().position(engages)
}

/// From the tick on at which one end engages the other's firmware is told, and its supervisor stays out of it.
#[test]
fn an_engagement_is_told_to_the_other_end() {
    for end in [0, 1] {
        let mut from = [None; 2];
        from[end] = Some(20);
        let mut rotor = rotor(&config());
        let commands = run(&mut rotor, 0..200, from);
        let engaged = engaged_at(&commands, end).unwrap();
        assert!((20..20 + OUT as usize).contains(&engaged), "{engaged}");
        for (i, command) in commands.iter().enumerate() {
            let mut told = [false; 2];
            told[1 - end] = i >= engaged;
            assert_eq!(command.other_engaged, told, "tick {i}");
            assert_eq!(command.planes[1 - end].mode, Mode::Levitated);
        }
        assert_eq!(commands[150].planes[end].mode, Mode::BackwardWhirl);
    }
}

/// Records are read together, once both have frozen, with numbers that lay them side by side; then both are ready for
/// the next event.
#[test]
fn records_of_one_event_are_read_together() {
    let mut rotor = rotor(&config());
    // The second end follows before the first one's record has frozen: a quarter of it lies before the engagement.
    let late = 20 + RECORD as u32 / 2;
    let mut frozen_alone = false;
    let mut read: Vec<(usize, Vec<u32>)> = Vec::new();
    for i in 0..400 {
        let command = &run(&mut rotor, i..i + 1, [Some(20), Some(late)])[0];
        let frozen = [0, 1].map(|end| rotor.plane(end).record().is_some());
        frozen_alone |= frozen == [true, false];
        let all = frozen == [true, true];
        rotor.collect(|end, record| {
            assert!(all, "tick {i}");
            read.push((end, record.entries().map(|e| e.sequence).collect()));
        });
        if read.is_empty() && i >= late + OUT {
            assert_eq!(command.other_engaged, [true; 2], "tick {i}");
        }
    }
    assert!(frozen_alone);
    let [(0, first), (1, second)] = &read[..] else {
        panic!("{} records", read.len())
    };
    let both = first.iter().filter(|n| second.contains(n)).count();
    assert!(both > RECORD / 4, "{both} ticks in common");
    // The event is over: nobody is told of it any more, and the next one is read again.
    let commands = run(&mut rotor, 400..401, [None, None]);
    assert_eq!(commands[0].other_engaged, [false; 2]);
    run(&mut rotor, 401..800, [Some(420), None]);
    let mut again = Vec::new();
    rotor.collect(|end, _| again.push(end));
    assert_eq!(again, [0]);
}

/// One end's request is the machine's, and stays.
#[test]
fn a_request_to_coast_down_is_of_the_machine() {
    let impatient = Config {
        coast_down_s: 1e-3,
        ..config()
    };
    let mut rotor = rotor(&impatient);
    let commands = run(&mut rotor, 0..400, [None, Some(20)]);
    let asked = |c: &RotorCommand| c.planes[1].events.contains(Events::COAST_DOWN);
    let first = commands.iter().position(asked).unwrap();
    for (i, command) in commands.iter().enumerate() {
        assert_eq!(command.coast_down, i >= first, "tick {i}");
    }
}

/// The two ends of the counted pair: half a turn about the centre turns every command by half a turn, to the bit. So
/// both do what is dearest for one at the same tick.
#[test]
fn half_a_turn_turns_the_commands() {
    let mut rotor = rotor(&config());
    for i in 0..400 {
        let sample = Sample {
            levitation_n: led(i, 25).map(|x| -2e6 * x),
            ..sample(i, led(i, 20))
        };
        let [first, second] = rotor.tick(&[sample, half_a_turn(&sample)]).planes;
        assert_eq!(first.force_n, second.force_n.map(|x| -x), "tick {i}");
        assert_eq!(
            (first.mode, first.events, first.limits, first.severity),
            (second.mode, second.events, second.limits, second.severity)
        );
    }
}
