//! Both ends of one rotor: who is informed of what, and records that belong together.

use supervisor::{
    Command, Config, Events, Mode, RotorCommand, RotorSupervisor, Sample, Shaft, Status, Supervisor,
};
use test_support::records::written;
use test_support::rig::{
    RADIUS_M, WHIRL_STEP, all_at, asking, config, config_with, new_rotor, on_circle, quiet, sample,
    sample_with, shaft, ticks_of,
};

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

/// A sample of a sensor that does not stand still to the last digit.
fn noisy(tick: u32, position_m: [f32; 2]) -> Sample {
    sample(tick, position_m.map(|x| x + quiet(tick)[0]))
}

/// A plane of a rotor that knows nothing of the other.
fn alone(shaft: &Shaft, end: usize, config: &Config) -> Supervisor<RECORD> {
    Supervisor::new(&shaft.plane(end, config)).unwrap()
}

/// Ticks of both ends, each led from a tick on; `None`: it stays in the middle.
fn run(
    rotor: &mut RotorSupervisor<RECORD>,
    ticks: std::ops::Range<u32>,
    from: [Option<u32>; 2],
) -> Vec<RotorCommand> {
    let tick = |i| {
        let at = |from: Option<u32>| from.map_or([0.0; 2], |from| led(i, from));
        rotor.tick(&from.map(|from| noisy(i, at(from))))
    };
    ticks.map(tick).collect()
}

fn engaged_at(commands: &[RotorCommand], end: usize) -> Option<usize> {
    let engages = |c: &RotorCommand| c.planes[end].events.contains(Events::ENGAGED);
    commands.iter().position(engages)
}

/// Ticked in two halves a rotor commands, counts and records what it does in one tick of both planes; and the first plane's command
/// is there at once.
#[test]
fn two_halves_are_a_tick() {
    let record_of = |rotor: &RotorSupervisor<RECORD>, end| written(&rotor.record(end).unwrap());
    let [mut whole, mut halves] = [(); 2].map(|()| new_rotor(&config()));
    let (mut engaged, mut frozen) = (false, 0);
    for i in 0..1200 {
        // One end is led out at two times, the other in between, and both are unlike.
        let at = |from: [u32; 2]| {
            let from = from.into_iter().rev().find(|from| i >= *from);
            from.map_or([0.0; 2], |from| led(i, from))
        };
        let mut samples = [at([20, 600]), at([300, 630])].map(|at| noisy(i, at));
        samples[1].position_m[0] += 3e-6;
        if i == 500 {
            samples[1].position_m[1] = f32::NAN;
        }
        let command = whole.tick(&samples);
        let half = halves.tick_first(&samples[0]);
        let later = halves.tick_second(&half, &samples[1]);
        assert_eq!(bits(&later), bits(&command), "tick {i}");
        let mut at_once = command.planes[0];
        at_once.events -= Events::RECORD_FROZEN;
        assert_eq!(half.command, at_once, "tick {i}");
        engaged |= command.planes[1].mode.is_engaged();
        if whole.record(1).is_some() {
            for end in [0, 1] {
                assert_eq!(record_of(&halves, end), record_of(&whole, end), "tick {i}");
            }
            frozen += 1;
            whole.rearm();
            halves.rearm();
        }
    }
    assert!(engaged && frozen > 1, "{engaged} {frozen}");
    for end in [0, 1] {
        let reports = [&mut whole, &mut halves].map(|rotor| rotor.plane(end).report());
        assert_eq!(reports[0], reports[1]);
        assert!(reports[0].landings > 0);
    }
}

/// All of a command, so that even −0 is not 0.
fn bits(command: &RotorCommand) -> String {
    let of = |c: &Command| {
        let forces = [c.force_n, c.own_n].map(|f| f.map(f32::to_bits));
        (forces, c.severity.to_bits(), *c)
    };
    format!("{:?} {command:?}", command.planes.each_ref().map(of))
}

/// From the tick on at which one end engages the other's firmware is informed, and its supervisor stays out of it.
#[test]
fn an_engagement_is_told_to_the_other_end() {
    for end in [0, 1] {
        let mut from = [None; 2];
        from[end] = Some(20);
        let mut rotor = new_rotor(&config());
        let commands = run(&mut rotor, 0..200, from);
        let engaged = engaged_at(&commands, end).unwrap();
        assert!((20..20 + OUT as usize).contains(&engaged), "{engaged}");
        for (i, command) in commands.iter().enumerate() {
            let mut informed = [false; 2];
            informed[1 - end] = i >= engaged;
            assert_eq!(command.other_engaged, informed, "tick {i}");
            assert_eq!(command.planes[1 - end].mode, Mode::Levitated);
        }
        assert_eq!(commands[150].planes[end].mode, Mode::BackwardWhirl);
    }
}

/// Where nutation turns too far until a force acts, an approach and a touch are left to levitation, and backward whirl is not.
#[test]
fn beyond_its_turn_only_backward_whirl_is_acted_on() {
    let config = config();
    // A sample's age, the delay, and the lag.
    let late_s = (0.5 + config.delay_samples) * config.sample_period_s + config.amplifier_lag_s;
    let wall = 20 + OUT as usize;
    let engaged_at_turn = |turn_rad: f32| {
        let mut rotor = new_rotor(&config);
        let commands = (0..200).map(|i| {
            let mut now = noisy(i, led(i, 20));
            now.spin_rad_s = turn_rad / late_s / 0.8;
            rotor.tick(&[now; 2])
        });
        let commands: Vec<RotorCommand> = commands.collect();
        engaged_at(&commands, 0).unwrap()
    };
    for turn_rad in [0.1, 0.6, 1.2] {
        assert!(engaged_at_turn(turn_rad) < wall, "{turn_rad}");
    }
    // The last by more than a radian a tick.
    for turn_rad in [1.3, 2.0, 8.0] {
        let engaged = engaged_at_turn(turn_rad);
        let late = wall + 2..wall + ON_WALL as usize;
        assert!(late.contains(&engaged), "{turn_rad}: {engaged}");
    }
}

/// Both planes record the same ticks of one event, whichever engages, and freeze at once when it is over for both; then both
/// are ready for the next one.
/// Requirement: SR-30
#[test]
fn records_of_one_event_are_of_the_same_ticks() {
    let mut rotor = new_rotor(&config());
    let late = 20 + 3 * RECORD as u32 / 2;
    let mut read: Vec<(usize, Vec<u32>)> = Vec::new();
    let mut over = false;
    for i in 0..1000 {
        let command = &run(&mut rotor, i..i + 1, [Some(20), Some(late)])[0];
        over |= i > late && command.planes.iter().all(|c| c.mode == Mode::Levitated);
        let frozen = [0, 1].map(|end| rotor.plane(end).record().is_some());
        assert_eq!(frozen[0], frozen[1]);
        rotor.collect(|end, record| {
            assert!(over, "tick {i}");
            read.push((end, record.entries().map(|e| e.sequence).collect()));
        });
        if read.is_empty() && i >= late + OUT {
            assert_eq!(command.other_engaged, [true; 2], "tick {i}");
        }
    }
    let [(0, first), (1, second)] = &read[..] else {
        panic!("{} records", read.len())
    };
    assert_eq!(first, second);
    // The event is over: nobody is informed of it any more, and the next one is read again.
    let commands = run(&mut rotor, 1000..1001, [None, None]);
    assert_eq!(commands[0].other_engaged, [false; 2]);
    run(&mut rotor, 1001..2000, [Some(1020), None]);
    let mut again = Vec::new();
    rotor.collect(|end, _| again.push(end));
    assert_eq!(again, [0, 1]);
}

/// An engagement without a touch leaves no record: nobody waits for one, and nobody is informed of it any more.
#[test]
fn an_engagement_without_a_touch_holds_nothing_up() {
    let mut rotor = new_rotor(&config());
    let mut read = Vec::new();
    let (mut engaged, mut informed) = (false, false);
    for i in 0..1200_u32 {
        // The first end comes at the wall and turns round before it; later the second lands.
        let near = match i.checked_sub(20) {
            Some(i) if i < 36 => 0.9 * i as f32 / 36.0,
            Some(i) => 0.9 * (1.0 - (i - 36) as f32 / 60.0).max(0.0),
            None => 0.0,
        };
        let samples = [[1.95e-4 * near, 0.0], led(i, 600)].map(|at| noisy(i, at));
        let command = rotor.tick(&samples);
        engaged |= command.planes[0].events.contains(Events::ENGAGED);
        informed = command.other_engaged[1];
        if i == 590 {
            assert!(engaged && !informed, "{engaged} {informed}");
            assert_eq!(rotor.plane(0).report().landings, 0);
        }
        rotor.collect(|end, _| read.push(end));
    }
    assert_eq!(read, [0, 1]);
    assert!(!informed);
}

/// One end's request is the machine's, and stays.
/// Requirement: SR-27
#[test]
fn a_request_to_coast_down_is_of_the_machine() {
    let impatient = config_with(|c| c.coast_down_s = 1e-3);
    let mut rotor = new_rotor(&impatient);
    let commands = run(&mut rotor, 0..400, [None, Some(20)]);
    let second: Vec<Command> = commands.iter().map(|c| c.planes[1]).collect();
    let first = ticks_of(&second, Events::COAST_DOWN)[0];
    for (i, command) in commands.iter().enumerate() {
        assert_eq!(command.coast_down, i >= first, "tick {i}");
    }
}

/// Half a turn about the centre turns every command by half a turn, to the bit: so both ends of the pair that images count do
/// what is dearest for one at the same tick.
#[test]
fn half_a_turn_turns_the_commands() {
    let mut rotor = new_rotor(&config());
    for i in 0..400 {
        let levitation_n = led(i, 25).map(|x| -2e6 * x);
        let sample = asking(i, led(i, 20), levitation_n);
        let turned = asking(i, led(i, 20).map(|x| -x), levitation_n.map(|x| -x));
        let [first, second] = rotor.tick(&[sample, turned]).planes;
        assert_eq!(first.force_n, second.force_n.map(|x| -x), "tick {i}");
        let of = |c: Command| (c.mode, c.events, c.limits, c.severity);
        assert_eq!(of(first), of(second));
    }
}

/// A tilt that turns freely with the nutation, its radius growing to 0.6 of the clearance, too fast to pass for usual: both ends go round faster than
/// any force could stop them, and neither comes near the wall. `sense` of the turning: 1 with the spin.
fn nutating(spin_rad_s: f32, sense: f32, mut tick: impl FnMut(&[Sample; 2])) {
    let config = free();
    let shaft = shaft(&config);
    let rate = shaft.polar_inertia_kg_m2 / shaft.transverse_inertia_kg_m2 * spin_rad_s * sense;
    for i in 0..2000_u32 {
        let radius = 0.6 * config.clearance_m * (i as f32 / 60.0).min(1.0);
        let angle = (rate * config.sample_period_s * i as f32) % std::f32::consts::TAU;
        let at = [radius * angle.cos(), radius * angle.sin()];
        let of = |position_m| sample_with(i, position_m, |s| s.spin_rad_s = spin_rad_s);
        tick(&[of(at.map(|x| -x)), of(at)]);
    }
}

fn free() -> Config {
    config_with(|c| (c.stiffness_n_m, c.damping_n_s_m) = (0.0, 0.0))
}

/// Requirement: SR-10
#[test]
fn free_nutation_is_no_approach() {
    let engages = |spin: f32, sense: f32| {
        let mut rotor = new_rotor(&free());
        let mut engaged = [false; 2];
        nutating(spin, sense, |samples| {
            let planes = rotor.tick(samples).planes;
            engaged = [0, 1].map(|end| engaged[end] || planes[end].mode != Mode::Levitated);
        });
        engaged
    };
    // 450 Hz of nutation either way.
    for spin in [3500.0, -3500.0] {
        assert_eq!(engages(spin, 1.0), [false; 2], "{spin}");
        // Nothing turns the other way round by itself.
        assert_eq!(engages(spin, -1.0), [true; 2], "{spin}");
    }
    // A plane alone takes the first for an approach, too.
    let config = free();
    let shaft = shaft(&config);
    let mut alone = alone(&shaft, 0, &config);
    let mut engaged = false;
    nutating(3500.0, 1.0, |[sample, _]| {
        engaged |= alone.tick(sample).mode != Mode::Levitated;
    });
    assert!(engaged);
}

/// Without a valid spin nothing is known to turn the tilt, and without forces the planes are two that stand alone.
#[test]
fn without_spin_there_is_no_nutation() {
    let config = free();
    let shaft = shaft(&config);
    let mut rotor = new_rotor(&config);
    let mut alone = [0, 1].map(|end| alone(&shaft, end, &config));
    nutating(3500.0, 1.0, |samples| {
        let mut blind = *samples;
        blind.iter_mut().for_each(|s| s.status = Status::BEARING_ON);
        let commands = rotor.tick(&blind).planes;
        for ((command, alone), sample) in commands.iter().zip(&mut alone).zip(&blind) {
            assert_eq!(*command, alone.tick(sample));
        }
    });
}

/// What the magnet at one end does to the other is known there before it is seen: a push towards the wall that its own cap
/// cannot hold engages the supervisor within two ticks. A plane that stands alone takes as long as its slow observer.
#[test]
fn a_push_by_the_other_magnet_is_known_before_it_is_seen() {
    // Both planes on one side of the centre of mass; forces that act at once.
    let shaft = Shaft {
        mass_kg: 20.0,
        transverse_inertia_kg_m2: 2.0,
        polar_inertia_kg_m2: 0.0,
        places: [all_at(0.05), all_at(0.25)],
    };
    let with = |force_max_n: f32| Config {
        force_max_n,
        axis_force_max_n: force_max_n,
        amplifier_lag_s: 0.0,
        delay_samples: 0.0,
        observer_pole_flight: 0.9,
        ..free()
    };
    let configs = [with(500.0), with(2000.0)];
    let mut rotor = RotorSupervisor::<RECORD>::new(&shaft, &configs).unwrap();
    let mut alone = alone(&shaft, 0, &configs[0]);
    // Acceleration of each end per force at the second.
    let magnet_m = shaft.places[1].magnet_m;
    let per_kg = shaft.places.map(|place| {
        1.0 / shaft.mass_kg + place.retainer_m * magnet_m / shaft.transverse_inertia_kg_m2
    });
    // The first end drifts outwards, the second is braked from a tick on.
    let (mut position_m, mut speed_m_s) = ([6e-5_f32, 1e-4], [0.02_f32, -0.06]);
    let pushed_at = 60;
    let mut engaged = [None; 2];
    for i in 0..pushed_at + 20 {
        let mut samples = position_m.map(|x| sample(i, [x, 1e-7 * (i % 3) as f32]));
        if i >= pushed_at {
            samples[1].levitation_n = [1500.0, 0.0];
        }
        let commands = rotor.tick(&samples).planes;
        assert_eq!(commands[1].mode, Mode::Levitated, "tick {i}");
        let modes = [commands[0].mode, alone.tick(&samples[0]).mode];
        for (engaged, mode) in engaged.iter_mut().zip(modes) {
            *engaged = engaged.or(mode.is_engaged().then_some(i));
        }
        for (end, per_kg) in per_kg.into_iter().enumerate() {
            let gained = per_kg * commands[1].force_n[0] * configs[0].sample_period_s;
            position_m[end] += (speed_m_s[end] + 0.5 * gained) * configs[0].sample_period_s;
            speed_m_s[end] += gained;
        }
    }
    let [known, seen] = engaged.map(Option::unwrap);
    assert!((pushed_at + 1..=pushed_at + 2).contains(&known), "{known}");
    assert!(seen > known + 5, "{known} {seen}");
}
