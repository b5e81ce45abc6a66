//! The judge of the model: what the reading usually does, and the way out of an engagement that makes no progress.

use supervisor::{Core, Events, Mode, Prepared, Q, Status, Supervisor};
use test_support::bench::Bench;
use test_support::rig::{
    RADIUS_M, asking, close, config, new_rotor, on_circle, sample, sample_with,
};
use test_support::storm::{AnyBits, Chance, Storm};

/// Clearance of the rig \[m\], and √(m·c/F) \[ticks\].
pub(super) const C_M: f32 = 2e-4;
const UNIT_TICKS: f32 = 1.414e-3 / 50e-6;
/// A window: 6·t₀, and the tick at its end.
const WINDOW_TICKS: u32 = (6.0 * UNIT_TICKS) as u32 + 1;
/// No engagement is longer.
const MOST_TICKS: u32 = 2049 * WINDOW_TICKS;

/// Noise of a coordinate, triangular, of this standard deviation.
pub(super) fn noise(chance: &mut Chance, rms: f32) -> f32 {
    (chance.share() + chance.share() - 1.0) * rms * 6_f32.sqrt()
}

/// Ticks of the longest engagement.
fn longest(modes: impl Iterator<Item = Mode>) -> u32 {
    let engaged = modes.scan(0, |running, mode| {
        *running = if mode.is_engaged() { *running + 1 } else { 0 };
        Some(*running)
    });
    engaged.max().unwrap_or_default()
}

/// The longest engagement of a stream of any bits.
fn longest_in_a_storm<S: AnyBits>(seed: u64, ticks: u32) -> u32 {
    let mut core = Core::<S, 64>::new(&Prepared::new(&config()).unwrap());
    let mut storm = Storm::new(seed);
    longest((0..ticks).map(|_| core.tick(&storm.next_sample::<S>()).mode))
}

/// Requirement: SR-11
#[test]
fn no_engagement_of_any_bits_lasts_beyond_its_bound() {
    for seed in 0..4 {
        let f32 = longest_in_a_storm::<f32>(seed, 1_000_000);
        let f64 = longest_in_a_storm::<f64>(seed, 1_000_000);
        let longest = f32.max(f64).max(longest_in_a_storm::<Q>(seed, 1_000_000));
        assert!(longest <= MOST_TICKS, "{longest}");
    }
}

/// A rotor that lies on the bearing for good is held for long, and not for ever: the bound is reached, to a window or two.
/// Requirement: SR-11
#[test]
fn what_rests_is_held_to_the_bound() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut handed_back = 0;
    let longest = longest((0..3 * MOST_TICKS).map(|i| {
        // Of a controller that has no force to spare.
        let at_m = [1.01 * C_M, 1e-8 * (i % 2) as f32];
        let command = supervisor.tick(&asking(i, at_m, [-900.0, 0.0]));
        handed_back += u32::from(command.events.contains(Events::HANDED_BACK));
        command.mode
    }));
    let reached = MOST_TICKS - 3 * WINDOW_TICKS + 1..=MOST_TICKS;
    assert!(reached.contains(&longest), "{longest} of {MOST_TICKS}");
    assert!(handed_back >= 2);
    assert_eq!(supervisor.report().handed_back, handed_back);
}

/// One that bounces from wall to wall without losing speed, whatever is done, is given up after four windows and a part of one, and
/// the pauses double.
/// Requirement: SR-11
#[test]
fn bouncing_on_is_given_up_and_pauses_double() {
    let mut bench = Bench::new(&config());
    let ticks = (0..200 * WINDOW_TICKS).map(|i| {
        let way = 0.8 * i as f32 / UNIT_TICKS;
        let from_wall = (way % 4.0 - 2.0).abs() - 1.0;
        let at_m = [1.03 * C_M * from_wall, 1e-7 * (i % 7) as f32];
        bench.tick(at_m).mode
    });
    let modes: Vec<Mode> = ticks.collect();
    let longest = longest(modes.iter().copied());
    assert!(longest <= 5 * WINDOW_TICKS, "{longest}");
    let stretches = modes.chunk_by(|a, b| a.is_engaged() == b.is_engaged());
    let pauses = stretches.map(|modes| modes.iter().filter(|m| **m == Mode::HandedBack).count());
    let pauses: Vec<usize> = pauses.filter(|ticks| *ticks > 0).collect();
    // The last is cut by the end.
    let [pauses @ .., _] = &pauses[..] else {
        panic!("no pause");
    };
    assert!(pauses.len() >= 4, "{pauses:?}");
    for (n, pause) in pauses.iter().enumerate() {
        let windows = *pause as f32 / WINDOW_TICKS as f32;
        close(windows, 8.0 * 2_f32.powi(n as i32), 0.05);
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
    let run = |tick: &mut dyn FnMut(u32) -> Mode| {
        let modes: Vec<Mode> = (0..40 * WINDOW_TICKS).map(tick).collect();
        assert!(modes.contains(&Mode::HandedBack));
        longest(modes.into_iter())
    };
    let (mut plane, mut rotor) = (Bench::new(&config()), new_rotor(&config()));
    let alone = run(&mut |i| plane.tick(swinging(i)).mode);
    let of_rotor = run(&mut |i| rotor.tick(&[sample(i, swinging(i)); 2]).planes[0].mode);
    let at_once = of_rotor > WINDOW_TICKS && of_rotor <= 2 * WINDOW_TICKS;
    assert!(at_once, "{of_rotor}");
    assert!(alone > 3 * WINDOW_TICKS, "{alone}");
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
            let at = on_circle(radius_m, angle);
            let now = sample_with(i, at, |s| s.spin_rad_s = 1000.0 * over);
            let command = supervisor.tick(&now);
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
    let orbit = |i: u32, radius_m: f32| sample(i, on_circle(radius_m, -spin * i as f32));
    // Ends of stretches: both orbit; one rubs; both orbit; the other one touches; the bearing is off; it touches again.
    let free = 6 * WINDOW_TICKS;
    let rubbed = free + 5 * WINDOW_TICKS;
    let (touch, touched) = (rubbed + 20, rubbed + 26);
    let (off, on) = (touched + 20, touched + 20 + 4 * WINDOW_TICKS);
    let (again, ended) = (on + 20, on + 26);
    let modes = |rubs: bool| {
        let mut rotor = new_rotor(&config());
        let mut alone = Supervisor::<64>::new(&config()).unwrap();
        let mut seen = Vec::new();
        for i in 0..ended {
            let at = |wall: bool| orbit(i, if wall { RADIUS_M } else { 0.5 * C_M });
            let mut samples = [
                at(rubs && (free..rubbed).contains(&i)),
                at((touch..touched).contains(&i) || (again..ended).contains(&i)),
            ];
            if (off..on).contains(&i) {
                (samples[0].status, samples[1].status) = (Status::SPIN_VALID, Status::SPIN_VALID);
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
