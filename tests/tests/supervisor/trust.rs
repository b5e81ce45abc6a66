//! The judge of the model: doubt about single samples, what the reading usually does, and the way out of an engagement
//! that makes no progress.

use firmware_image::under_test::shaft;
use supervisor::{
    Core, Events, Limits, Mode, Prepared, Q, RejectReason, RotorSupervisor, Sample, Status,
    Supervisor,
};
use system_tests::bench::Bench;
use system_tests::rig::{RADIUS_M, config, on_circle, sample};
use system_tests::storm::{AnyBits, Chance, Storm};

/// Clearance of the rig \[m\], and √(m·c/F) \[ticks\].
const C_M: f32 = 2e-4;
const UNIT_TICKS: f32 = 1.414e-3 / 50e-6;
/// A window: 6·t₀, and the tick at its end.
const WINDOW_TICKS: u32 = (6.0 * UNIT_TICKS) as u32 + 1;
/// No engagement is longer.
const MOST_TICKS: u32 = 2049 * WINDOW_TICKS;

/// Noise of a coordinate, triangular, of this standard deviation.
fn noise(chance: &mut Chance, rms: f32) -> f32 {
    (chance.share() + chance.share() - 1.0) * rms * 6_f32.sqrt()
}

/// The longest engagement of a stream of any bits.
fn longest_in_a_storm<S: AnyBits>(seed: u64, ticks: u32) -> u32 {
    let mut core = Core::<S, 64>::new(&Prepared::new(&config()).unwrap());
    let mut storm = Storm::new(seed);
    let (mut longest, mut running) = (0, 0);
    for _ in 0..ticks {
        let mode = core.tick(&storm.next_sample::<S>()).mode;
        running = if mode.is_engaged() { running + 1 } else { 0 };
        longest = longest.max(running);
    }
    longest
}

/// Requirement: SR-11
#[test]
fn no_engagement_of_any_bits_lasts_beyond_its_bound() {
    for seed in 0..4 {
        for longest in [
            longest_in_a_storm::<f32>(seed, 1_000_000),
            longest_in_a_storm::<f64>(seed, 1_000_000),
            longest_in_a_storm::<Q>(seed, 1_000_000),
        ] {
            assert!(longest <= MOST_TICKS, "{longest}");
        }
    }
}

/// A stream that is made to keep the supervisor busy, by what it says: what is engaged is kept engaged.
fn longest_kept(position: impl Fn(u32, Mode) -> [f32; 2], ticks: u32) -> (u32, u32) {
    let mut bench = Bench::new(&config());
    let mut mode = Mode::Levitated;
    let (mut longest, mut running, mut handed_back) = (0, 0, 0);
    for i in 0..ticks {
        // Whose controller has no force to spare.
        bench.sequence += 1;
        let [x, y] = position(i, mode);
        let command = bench.supervisor.tick(&Sample {
            levitation_n: [-900.0 * x.signum(), 0.0],
            ..sample(bench.sequence, [x, y])
        });
        mode = command.mode;
        running = if mode.is_engaged() { running + 1 } else { 0 };
        longest = longest.max(running);
        handed_back += u32::from(command.events.contains(Events::HANDED_BACK));
    }
    assert_eq!(bench.supervisor.report().handed_back, handed_back);
    (longest, handed_back)
}

/// A rotor that lies on the bearing for good is held for long, and not for ever: the bound is reached, to a window or two.
/// Requirement: SR-11
#[test]
fn what_rests_is_held_to_the_bound() {
    let lying = |i: u32, _| [1.01 * C_M, 1e-8 * (i % 2) as f32];
    let (longest, handed_back) = longest_kept(lying, 3 * MOST_TICKS);
    assert!(
        longest <= MOST_TICKS && longest > MOST_TICKS - 3 * WINDOW_TICKS,
        "{longest} of {MOST_TICKS}"
    );
    assert!(handed_back >= 2);
}

/// Position of a rotor that bounces from wall to wall at this speed [lift-off speeds], whatever is done.
fn bouncing(i: u32, speed: f32) -> [f32; 2] {
    let way = i as f32 * speed / UNIT_TICKS;
    let from_wall = (way % 4.0 - 2.0).abs() - 1.0;
    [1.03 * C_M * from_wall, 1e-7 * (i % 7) as f32]
}

/// One that bounces on without losing speed is given up after four windows and a part of one, and the pauses double.
/// Requirement: SR-11
#[test]
fn bouncing_on_is_given_up_and_pauses_double() {
    let mut bench = Bench::new(&config());
    let mut pauses = Vec::new();
    let (mut running, mut longest, mut pause) = (0, 0, 0);
    for i in 0..200 * WINDOW_TICKS {
        let mode = bench.tick(bouncing(i, 0.8)).mode;
        if mode.is_engaged() {
            running += 1;
            longest = longest.max(running);
            if pause > 0 {
                pauses.push(std::mem::take(&mut pause));
            }
        } else {
            running = 0;
            pause += u32::from(mode == Mode::HandedBack);
        }
    }
    assert!(longest <= 5 * WINDOW_TICKS, "{longest}");
    let windows: Vec<f32> = pauses
        .iter()
        .map(|p| *p as f32 / WINDOW_TICKS as f32)
        .collect();
    assert!(windows.len() >= 4, "{windows:?}");
    for (n, pause) in windows.iter().enumerate() {
        let expected = 8.0 * 2_f32.powi(n as i32);
        assert!((pause / expected - 1.0).abs() < 0.05, "{windows:?}");
    }
}

/// Of a whole rotor one that swings on in flight without losing speed is given up after its second window: there is no wall
/// that gives the speed, so it is the supervisor, or what it does not know. In one plane it has four.
#[test]
fn a_rotor_that_swings_on_in_flight_is_given_up_at_once() {
    let swinging = |i: u32| {
        let angle = 1.6 * i.saturating_sub(3 * WINDOW_TICKS) as f32 / UNIT_TICKS;
        [0.75 * C_M * angle.sin(), 1e-7 * (i % 7) as f32]
    };
    let longest = |modes: &mut dyn FnMut(u32) -> Mode| {
        let (mut longest, mut running, mut given_up) = (0, 0, 0);
        for i in 0..40 * WINDOW_TICKS {
            let mode = modes(i);
            running = if mode.is_engaged() { running + 1 } else { 0 };
            longest = longest.max(running);
            given_up += u32::from(mode == Mode::HandedBack);
        }
        assert!(given_up > 0);
        longest
    };
    let mut plane = Bench::new(&config());
    let alone = longest(&mut |i| plane.tick(swinging(i)).mode);
    let mut rotor = RotorSupervisor::<64>::new(&shaft(&config()), &[config(); 2]).unwrap();
    let of_rotor = longest(&mut |i| rotor.tick(&[sample(i, swinging(i)); 2]).planes[0].mode);
    assert!(
        of_rotor > WINDOW_TICKS && of_rotor <= 2 * WINDOW_TICKS,
        "{of_rotor}"
    );
    assert!(alone > 3 * WINDOW_TICKS, "{alone}");
}

/// A single sample that is off moves nothing, in either direction and of any size; what the second shows as well is so.
/// Requirement: SR-16
#[test]
fn one_sample_that_is_off_is_refused_and_two_are_not() {
    for size in [0.1, 0.3, 0.9] {
        let mut bench = Bench::new(&config());
        let mut chance = Chance::new(5);
        let mut tick = |bench: &mut Bench, off: f32| {
            let at = [
                off * C_M + noise(&mut chance, 5e-7),
                noise(&mut chance, 5e-7),
            ];
            bench.tick(at)
        };
        for _ in 0..200 {
            assert!(
                !tick(&mut bench, 0.0)
                    .limits
                    .contains(Limits::SAMPLE_REFUSED)
            );
        }
        for _ in 0..50 {
            let command = tick(&mut bench, size);
            assert!(command.limits.contains(Limits::SAMPLE_REFUSED), "{size}");
            assert_eq!(bench.supervisor.report().refusal, RejectReason::Doubted);
            assert_eq!(command.mode, Mode::Levitated, "{size}");
            for _ in 0..20 {
                assert_eq!(tick(&mut bench, 0.0).mode, Mode::Levitated, "{size}");
            }
        }
        if size < 0.5 {
            tick(&mut bench, size);
            let second = tick(&mut bench, size);
            assert!(!second.limits.contains(Limits::SAMPLE_REFUSED), "{size}");
        }
        assert_eq!(bench.supervisor.report().landings, 0);
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

/// The command that a levitation controller makes of a doubted sample does not go through.
/// Requirement: SR-16
#[test]
fn the_controllers_answer_to_a_doubted_sample_does_not_go_through() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut chance = Chance::new(9);
    let mut of = |i: u32, off: f32, levitation_n: [f32; 2]| {
        let at = [
            off * C_M + noise(&mut chance, 5e-7),
            noise(&mut chance, 5e-7),
        ];
        let mut sample = sample(i, at);
        sample.levitation_n = levitation_n;
        supervisor.tick(&sample).force_n
    };
    for i in 0..100 {
        assert_eq!(of(i, 0.0, [7.0, -3.0]), [7.0, -3.0]);
    }
    let held = of(100, 0.2, [-900.0, 0.0]);
    assert!(
        (held[0] - 7.0).abs() < 1e-3 && (held[1] + 3.0).abs() < 1e-3,
        "{held:?}"
    );
    assert_eq!(of(101, 0.0, [8.0, -3.0]), [8.0, -3.0]);
}

/// Runout that is there for two windows is the usual: the supervisor is not noticed, not even where the reading goes round
/// with three times the lift-off speed.
/// Requirement: SR-10
#[test]
fn what_is_usual_is_no_approach() {
    for (speed, amplitude) in [(0.6, 0.1), (1.0, 0.1), (3.0, 0.1), (2.0, 0.05)] {
        let mut bench = Bench::new(&config());
        let mut chance = Chance::new(11);
        let (mut phase, mut engaged) = (0.0_f32, 0);
        let step = speed / (amplitude * UNIT_TICKS);
        let growth = 40 * WINDOW_TICKS;
        for i in 0..3 * growth {
            phase = (phase + step) % std::f32::consts::TAU;
            let share = (i as f32 / growth as f32).min(1.0);
            let x = share * amplitude * C_M * phase.sin() + noise(&mut chance, 5e-7);
            let command = bench.tick([x, noise(&mut chance, 5e-7)]);
            engaged += u32::from(command.mode.is_engaged());
        }
        assert_eq!(engaged, 0, "{speed} at {amplitude}");
    }
}

/// An orbit that is too fast to be trusted hides an approach, and not a forward rub: contact at the spin's rate that goes on
/// for three windows engages the supervisor. At another rate it says nothing, nor while the spin changes.
#[test]
fn a_forward_rub_engages_one_that_trusts_no_reading() {
    let engaged_after = |rate: f32, run_up: f32| {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        let spin = 1000.0 * config().sample_period_s;
        // Ticks of an orbit at half the clearance, and of one on the wall.
        let (free, rubbing) = (6 * WINDOW_TICKS, 6 * WINDOW_TICKS);
        let (mut engaged, mut angle) = (None, 0.0);
        for i in 0..free + rubbing {
            let over = 1.0 + run_up * i.saturating_sub(free) as f32 / WINDOW_TICKS as f32;
            let (radius_m, step) = match i < free {
                true => (0.5 * C_M, spin),
                false => (RADIUS_M, rate * spin * over),
            };
            // Counter-clockwise, as the spin.
            angle -= step;
            let command = supervisor.tick(&Sample {
                spin_rad_s: 1000.0 * over,
                ..sample(i, on_circle(radius_m, angle))
            });
            if i >= 3 * WINDOW_TICKS && i < free {
                assert_eq!(command.mode, Mode::Levitated, "tick {i}");
            }
            if i >= free && command.mode.is_engaged() {
                assert_eq!(command.mode, Mode::Bounce);
                engaged = engaged.or(Some(i - free));
            }
        }
        engaged
    };
    let after = engaged_after(1.0, 0.0).unwrap();
    let windows = 2 * WINDOW_TICKS..4 * WINDOW_TICKS;
    assert!(windows.contains(&after), "{after}");
    assert_eq!(engaged_after(0.6, 0.0), None);
    assert_eq!(engaged_after(1.0, 0.02), None);
}

/// An end of a rotor whose reading is not trusted does not act on a touch, until the supervisor has acted at one of them: then it
/// does at both, and does not any more once a window has passed in peace. A plane that stands alone stands by.
#[test]
fn a_rotor_that_was_acted_on_is_not_left_before_it_has_settled() {
    let spin = 1000.0 * config().sample_period_s;
    let orbit = |i: u32, radius_m: f32| Sample {
        spin_rad_s: 1000.0,
        ..sample(i, on_circle(radius_m, -spin * i as f32))
    };
    // Ends of stretches: both orbit; one rubs; both orbit; the other one touches; the bearing is off; it touches again.
    let free = 6 * WINDOW_TICKS;
    let rubbed = free + 5 * WINDOW_TICKS;
    let (touch, touched) = (rubbed + 20, rubbed + 26);
    let (off, on) = (touched + 20, touched + 20 + 4 * WINDOW_TICKS);
    let (again, ended) = (on + 20, on + 26);
    let modes = |rubs: bool| {
        let mut rotor = RotorSupervisor::<64>::new(&shaft(&config()), &[config(); 2]).unwrap();
        let mut alone = Supervisor::<64>::new(&config()).unwrap();
        let mut seen = Vec::new();
        for i in 0..ended {
            let at = |wall: bool| orbit(i, if wall { RADIUS_M } else { 0.5 * C_M });
            let mut samples = [
                at(rubs && (free..rubbed).contains(&i)),
                at((touch..touched).contains(&i) || (again..ended).contains(&i)),
            ];
            if (off..on).contains(&i) {
                samples = samples.map(|sample| Sample {
                    status: Status::SPIN_VALID,
                    ..sample
                });
            }
            let [first, second] = rotor.tick(&samples).planes;
            seen.push([first.mode, second.mode, alone.tick(&samples[1]).mode]);
        }
        seen
    };
    let engages = |modes: &[[Mode; 3]], end: usize, ticks: std::ops::Range<u32>| {
        let of = &modes[ticks.start as usize..ticks.end as usize];
        of.iter().any(|at| at[end].is_engaged())
    };
    let (rubbed_before, undisturbed) = (modes(true), modes(false));
    assert!(engages(&rubbed_before, 0, free..rubbed));
    assert!(!engages(&rubbed_before, 1, 3 * WINDOW_TICKS..touch));
    assert!(engages(&rubbed_before, 1, touch..touched));
    assert!(!engages(&rubbed_before, 1, on..ended), "it has settled");
    for end in [0, 1] {
        assert!(!engages(&undisturbed, end, 3 * WINDOW_TICKS..ended));
    }
    for modes in [&rubbed_before, &undisturbed] {
        assert!(!engages(modes, 2, 3 * WINDOW_TICKS..ended), "alone");
    }
}

/// An engagement without a touch leaves the record to one with it, and is counted apart.
/// Requirement: SR-30
#[test]
fn an_engagement_without_contact_does_not_spend_the_record() {
    let mut bench = Bench::new(&config());
    let mut chance = Chance::new(13);
    let mut at = |r: f32| [r * C_M + noise(&mut chance, 2e-7), noise(&mut chance, 2e-7)];
    for _ in 0..400 {
        bench.tick(at(0.0));
    }
    // Towards the wall, and back before it.
    let mut engaged = 0;
    for i in 0..30 {
        engaged += u32::from(
            bench
                .tick(at(0.03 * i as f32))
                .events
                .contains(Events::ENGAGED),
        );
    }
    for i in (0..30).rev() {
        bench.tick(at(0.03 * i as f32));
    }
    assert_eq!(engaged, 1);
    let mut ticks = 0;
    while bench.supervisor.mode() != Mode::Levitated {
        bench.tick(at(0.0));
        ticks += 1;
        assert!(ticks < 2000);
    }
    for _ in 0..2000 {
        bench.tick(at(0.0));
    }
    let report = bench.supervisor.report();
    assert_eq!((report.nuisance_engagements, report.landings), (1, 0));
    assert!(bench.supervisor.record().is_none());
    for i in 0..60 {
        bench.tick(at((0.05 * i as f32).min(1.03)));
    }
    for _ in 0..2000 {
        bench.tick(at(0.0));
    }
    let report = bench.supervisor.report();
    assert_eq!((report.nuisance_engagements, report.landings), (1, 1));
    let record = bench.supervisor.record().expect("this one is worth it");
    let engaged = (record.entries()).position(|e| e.events & Events::ENGAGED.bits() as u16 != 0);
    assert_eq!(
        engaged,
        Some(15),
        "a quarter of the record lies before the touch"
    );
}

/// Of samples that are off and do not agree with each other two in a row are refused, and the third is believed.
/// Requirement: SR-16
#[test]
fn no_more_than_two_samples_in_a_row_are_doubted() {
    let mut bench = Bench::new(&config());
    let mut chance = Chance::new(17);
    let mut refused = |off: f32| {
        let at = [
            off * C_M + noise(&mut chance, 5e-7),
            noise(&mut chance, 5e-7),
        ];
        let command = bench.tick(at);
        command.limits.contains(Limits::SAMPLE_REFUSED)
    };
    assert!((0..200).all(|_| !refused(0.0)));
    assert_eq!([0.1, 0.25, 0.45].map(refused), [true, true, false]);
}
