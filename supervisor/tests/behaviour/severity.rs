//! How bad it was and will be: the whirl limit, severity, landings, and the request to coast down.

use supervisor::{Command, Config, Events, Limits, Mode, Sample, Status, Supervisor};
use test_support::rig::{
    RADIUS_M, WHIRL_STEP, close, config, config_with, on_circle, sample, sample_with, ticks_of,
    whirl, whirl_by,
};

/// Root of d/dt v = 0 by bisection on forces in double precision: μ·N = d·v + F·cos, N = m·v²/r − k·r − F·sin.
fn whirl_limit_m_s(config: &Config, force_n: f64) -> f64 {
    let [m, k] = [config.mass_kg, config.stiffness_n_m].map(f64::from);
    let [d, c] = [config.damping_n_s_m, config.clearance_m].map(f64::from);
    let mu = f64::from(config.friction_coefficient);
    let tilt = (1.0 + mu * mu).sqrt();
    let r = c + force_n / (mu * tilt) / f64::from(config.contact_stiffness_n_m);
    let drive = |v: f64| {
        let normal = m * v * v / r - k * r - force_n * mu / tilt;
        mu * normal - d * v - force_n / tilt
    };
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..200 {
        let v = 0.5 * (low + high);
        let side = if drive(v) < 0.0 { &mut low } else { &mut high };
        *side = v;
    }
    low
}

/// The whirl limit in the report is the balance of forces on the bent orbit.
#[test]
fn the_whirl_limit_is_the_balance_of_forces() {
    let limit_m_s = |with: &Config| {
        Supervisor::<16>::new(with)
            .unwrap()
            .report()
            .whirl_limit_m_s
    };
    for (stiffness, damping, shaft, mu, axis, lever) in [
        (1e9, 0.0, -2e5, 0.15, 1e7, 1.0),
        (1e8, 0.0, 0.0, 0.15, 1e7, 1.0),
        (1e9, 300.0, 8e5, 0.3, 600.0, 1.0),
        (1e9, 20.0, -2e5, 0.05, 700.0, 1.4),
    ] {
        let with = Config {
            contact_stiffness_n_m: stiffness,
            damping_n_s_m: damping,
            stiffness_n_m: shaft,
            friction_coefficient: mu,
            axis_force_max_n: axis,
            magnet_plane_ratio: lever,
            ..config()
        };
        let force = f64::from(1000_f32.min(axis)) * f64::from(lever);
        close(limit_m_s(&with), whirl_limit_m_s(&with, force), 1e-5);
    }
    // The figure of the soft contact that simulation meets.
    let soft_m_s = limit_m_s(&config_with(|c| c.contact_stiffness_n_m = 1e8));
    assert!((soft_m_s - 0.422).abs() < 5e-4);
}

/// Severity before contact: backward speed after the impacts to come over the whirl limit, by hand.
#[test]
fn severity_is_predicted_before_contact() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    // 0.4 m/s along x at y = −0.3 c: angular momentum, over c, of 0.12 m/s counter-clockwise.
    let mut before = 0;
    for i in 0..17_u32 {
        let x = 2e-5 * i as f32 - 1.6e-4;
        // Nothing pushes it off this course.
        let command = supervisor.tick(&sample_with(i, [x, -6e-5], |s| {
            s.status |= Status::APPLIED_VALID;
        }));
        if command.mode == Mode::Levitated {
            assert_eq!(command.severity, 0.0);
            continue;
        }
        // By then the observer has the speed.
        if i < 12 {
            continue;
        }
        before += 1;
        let (v_t, gain) = (0.12_f64, 0.15 * 1.7 / 0.3);
        let v_n = (0.16_f64 - v_t * v_t).sqrt();
        let expected = (-v_t + gain * v_n) / whirl_limit_m_s(&config(), 1000.0);
        close(command.severity, expected, 0.03);
    }
    assert!(before >= 4);
}

/// Landings, impacts, ticks, speeds and the index of a course that a hand can follow: two impacts in
/// one engagement, then rest in the middle, then a third.
#[test]
fn landings_are_counted_and_weighed() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut i = 0;
    let mut fly = |supervisor: &mut Supervisor<64>, from: f32, to: f32, ticks: u32| {
        for k in 1..=ticks {
            let x = from + (to - from) * k as f32 / ticks as f32;
            supervisor.tick(&sample(i, [x, 1e-9 * (k % 2) as f32]));
            i += 1;
        }
        supervisor.report()
    };
    fly(&mut supervisor, 0.0, 1e-6, 40);
    // 0.4 m/s to the wall, 0.28 m/s across to the other.
    fly(&mut supervisor, 1e-6, 2.01e-4, 10);
    let mid = fly(&mut supervisor, 2.01e-4, -2.07e-4, 29);
    assert_eq!((mid.landings, mid.impacts, mid.contact_ticks), (1, 2, 2));
    assert!((mid.impact_speed_max_m_s - 0.4).abs() < 0.04, "{mid:?}");
    let limit = whirl_limit_m_s(&config(), 1000.0);
    let by_hand = (0.4_f64.powi(2) + 0.28_f64.powi(2)) / limit.powi(2);
    close(mid.severity_index, by_hand, 0.15);

    fly(&mut supervisor, -2.07e-4, 0.0, 29);
    fly(&mut supervisor, 0.0, 1e-7, 400);
    assert_eq!(supervisor.mode(), Mode::Levitated);
    supervisor.rearm();
    let last = fly(&mut supervisor, 0.0, 2.01e-4, 10);
    assert_eq!((last.landings, last.impacts), (2, 3));
    assert!(last.severity_index > mid.severity_index);
}

/// Friction on a steady whirl: μ·N·v in each tick, with the normal force that holds the rotor on its
/// circle against the force that acts.
#[test]
fn the_index_grows_by_friction_in_whirl() {
    let mut supervisor = Supervisor::new(&config()).unwrap();
    // 0.16 m/s. No force is applied.
    const STEP: f32 = 0.04;
    whirl_by(STEP, &mut supervisor, 0..300, Status::APPLIED_VALID);
    let before = supervisor.report();
    whirl_by(STEP, &mut supervisor, 300..700, Status::APPLIED_VALID);
    let after = supervisor.report();
    assert_eq!(after.contact_ticks - before.contact_ticks, 400);
    let (v, c) = (f64::from(RADIUS_M * STEP) / 50e-6, 2e-4);
    close(after.backward_speed_max_m_s, v, 0.02);
    let normal = 10.0 * v * v / c + 2e5 * c;
    let energy = 0.15 * normal * v * 400.0 * 50e-6;
    let by_hand = energy / (0.5 * 10.0 * whirl_limit_m_s(&config(), 1000.0).powi(2));
    close(after.severity_index - before.severity_index, by_hand, 0.06);
}

/// When coasting down is asked for.
fn asked(commands: &[Command]) -> Vec<usize> {
    ticks_of(commands, Events::COAST_DOWN)
}

/// A tick of a whirl in which the bearing is off.
fn switched_off(step: f32, supervisor: &mut Supervisor<64>, tick: u32) {
    let at = on_circle(RADIUS_M, step * tick as f32);
    supervisor.tick(&sample_with(tick, at, |s| s.status = Status::SPIN_VALID));
}

/// Whirl beyond the limit is named in each tick and asks for coasting down once, after its time; whirl
/// below it is not and does not. Switched off and on, it may ask again.
/// Requirement: SR-27
#[test]
fn whirl_beyond_the_limit_asks_once_to_coast_down() {
    let limit = whirl_limit_m_s(&config(), 1000.0) as f32;
    for (share, beyond) in [(0.93, false), (1.08, true)] {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        let step = share * limit * 50e-6 / RADIUS_M;
        let before = whirl_by(step, &mut supervisor, 0..1000, Status::empty());
        switched_off(step, &mut supervisor, 1000);
        let after = whirl_by(step, &mut supervisor, 1001..1300, Status::empty());
        let times = [&before, &after].map(|commands| asked(commands).len());
        assert_eq!(times, [usize::from(beyond); 2]);
        for command in before[100..].iter().chain(&after) {
            let named = command.limits.contains(Limits::BEYOND_WHIRL_LIMIT);
            assert_eq!(named, beyond, "{share}");
        }
    }
}

/// So does the severity index, when it passes its limit.
/// Requirement: SR-27
#[test]
fn a_severity_index_beyond_its_limit_asks_once_to_coast_down() {
    let with = config_with(|c| (c.severity_limit, c.coast_down_s) = (3.0, 100.0));
    let mut supervisor = Supervisor::new(&with).unwrap();
    let mut indices = Vec::new();
    for i in 0..2000 {
        let commands = whirl(&mut supervisor, i..i + 1, Status::empty());
        let reports = ticks_of(&commands, Events::COAST_DOWN);
        indices.extend(reports.iter().map(|_| supervisor.report().severity_index));
    }
    let once = matches!(indices[..], [index] if index > 3.0 && index < 3.2);
    assert!(once, "{indices:?}");
    assert!(supervisor.report().coast_down);
}

/// An index that is beyond its limit is reported whichever of the two has moved: once, and again only after the limit was
/// above it.
#[test]
fn a_limit_that_is_lowered_below_the_index_asks() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    // Slower than what the cap arrests, which asks for nothing itself.
    let slow = 0.5 * WHIRL_STEP;
    let before = whirl_by(slow, &mut supervisor, 0..400, Status::empty());
    assert_eq!(asked(&before).len(), 0);
    let index = supervisor.report().severity_index;
    assert!(index > 0.0);
    let mut next = 400;
    // Off and on again, which lets an old request go.
    let mut with_limit = |severity_limit: f32| {
        let with = config_with(|c| c.severity_limit = severity_limit);
        supervisor.reconfigure(&with).unwrap();
        switched_off(slow, &mut supervisor, next);
        let ticks = next + 1..next + 50;
        let commands = whirl_by(slow, &mut supervisor, ticks, Status::empty());
        next += 50;
        asked(&commands).len()
    };
    assert_eq!(with_limit(0.5 * index), 1);
    assert_eq!(with_limit(0.5 * index), 0);
    assert_eq!(with_limit(1e6), 0);
    assert_eq!(with_limit(0.5 * index), 1);
}

/// The request to coast down comes with the first tick in which whirl beyond the limit has lasted longer than was configured.
/// Requirement: SR-27
#[test]
fn the_request_to_coast_down_comes_after_its_time_to_the_tick() {
    for ticks in [0, 1, 20, 100] {
        // Half a tick more, out of the way of rounding.
        let coast_down_s = (ticks as f32 + 0.5) * config().sample_period_s;
        let with = config_with(|c| c.coast_down_s = coast_down_s);
        let mut supervisor = Supervisor::new(&with).unwrap();
        let commands = whirl_by(1.2 * WHIRL_STEP, &mut supervisor, 0..300, Status::empty());
        let asked = asked(&commands)[0];
        let beyond = |c: &&Command| c.limits.contains(Limits::BEYOND_WHIRL_LIMIT);
        assert_eq!(commands[..=asked].iter().filter(beyond).count(), ticks + 1);
    }
}

/// The speed that an impact leaves is known from two samples off the wall, however slow the observer is in flight: the next
/// impact is weighed with it.
#[test]
fn the_speed_after_an_impact_is_known_from_two_samples() {
    let with = Config {
        observer_pole_flight: 0.95,
        observer_pole_contact: 0.3,
        stiffness_n_m: 0.0,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut index_after = |ticks: std::ops::Range<u32>| {
        for i in ticks {
            // To the wall with 0.3 m/s, back and across to the other with 0.21 m/s; nothing pushes.
            let to_wall_m = 1.5e-5 * 14_u32.saturating_sub(i) as f32;
            let from_wall_m = 1.05e-5 * i.saturating_sub(14) as f32;
            let at = [2.01e-4 - to_wall_m - from_wall_m, 1e-7 * (i % 2) as f32];
            let free = |s: &mut Sample| s.status |= Status::APPLIED_VALID;
            supervisor.tick(&sample_with(i, at, free));
        }
        let report = supervisor.report();
        (report.impacts, report.severity_index)
    };
    let (first, second) = (index_after(0..50), index_after(50..53));
    assert_eq!((first.0, second.0), (1, 2));
    let by_hand = (0.21 / whirl_limit_m_s(&with, 1000.0)).powi(2);
    close(second.1 - first.1, by_hand, 0.1);
}
