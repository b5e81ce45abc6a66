//! The force–time budget: the cap that it leaves, and what the supervisor makes of less.

use supervisor::{Command, Config, Events, Limits, Status, Supervisor};
use test_support::rig::{asking, config, config_with, length, sample, sample_with, whirl};

/// The cap falls when the closed form says so, by the curve that is documented, to the force at which
/// state and cap agree, and comes back by the same curve.
/// Requirement: SR-05
#[test]
fn the_cap_follows_the_thermal_state() {
    for continuous in [300.0_f64, 500.0, 900.0] {
        let time_s = 0.5;
        let limits = (continuous as f32, time_s as f32);
        let with = config_with(|c| (c.continuous_force_n, c.thermal_time_s) = limits);
        let mut supervisor = Supervisor::<16>::new(&with).unwrap();
        let curve = |state: f64| {
            let x = ((state - 1.0) / 0.1).clamp(0.0, 1.0);
            1000.0 - (1000.0 - continuous) * x * x * (3.0 - 2.0 * x)
        };
        let mut tick = |i: u32, wanted_n: f32| {
            let (at_m, asked_n) = (
                [1e-8 * (i % 100) as f32, 0.0],
                [0.6, -0.8].map(|x| x * wanted_n),
            );
            let command = supervisor.tick(&asking(i, at_m, asked_n));
            (command, supervisor.report())
        };
        let start = (1000.0 / continuous).powi(2);
        let reaches_1_s = -time_s * (1.0 - 1.0 / start).ln();
        let mut first = None;
        let ticks = 100_000;
        let mut state = 0.0_f64;
        let mut last = Command::default();
        for i in 0..ticks {
            let (command, report) = tick(i, 1000.0);
            assert!((length(command.force_n) - curve(state)).abs() < 0.3, "{i}");
            state += ((length(command.force_n) / continuous).powi(2) - state) * 50e-6 / time_s;
            assert!((f64::from(report.thermal_state) - state).abs() < 1e-4);
            if command.limits.contains(Limits::DERATED) {
                first.get_or_insert(f64::from(i) * 50e-6);
            }
            last = command;
        }
        let first = first.expect("ten time constants");
        let in_time = first >= reaches_1_s - 1e-4 && first < 1.05 * reaches_1_s + 1e-3;
        assert!(in_time, "{first} s, {reaches_1_s} s");
        let rest = length(last.force_n);
        assert!(rest > continuous && rest < 1.05 * continuous, "{rest} N");
        assert!(last.limits.contains(Limits::DERATED));
        // Back, without a jump.
        let mut cap = f64::from(tick(ticks, 0.0).1.force_cap_n);
        for i in ticks + 1..ticks + 4000 {
            let (_, report) = tick(i, 0.0);
            let now = f64::from(report.force_cap_n);
            assert!((now - curve(f64::from(report.thermal_state))).abs() < 0.1);
            assert!(now >= cap && now - cap < 5.0);
            cap = now;
        }
        assert_eq!(cap, 1000.0);
    }
}

/// Ticks that were missed are charged with the force that acts: what is measured, or nothing while the bearing is off, or
/// else the last command. A bearing that is off is not heated by what the controller asks for.
/// Requirements: SR-05, SR-08
#[test]
fn missed_ticks_are_charged_with_what_acts() {
    let _with = config_with(|c| (c.continuous_force_n, c.thermal_time_s) = (125.0, 0.5));
    let with = config_with(|c| (c.continuous_force_n, c.thermal_time_s) = (125.0, 0.5));
    let charged = |status: Status| {
        let mut supervisor = Supervisor::<16>::new(&with).unwrap();
        for i in 0..2000_u32 {
            // Four missed after every second.
            let at_m = [1e-8 * (i % 100) as f32, 0.0];
            let command = supervisor.tick(&sample_with(i + i / 2 * 4, at_m, |s| {
                (s.status, s.levitation_n) = (status, [100.0, 0.0]);
            }));
            assert_eq!(command.force_n, [100.0, 0.0]);
        }
        supervisor.report().thermal_state
    };
    let on = charged(Status::BEARING_ON);
    let ticks = 3.0 * 2000.0;
    let expected = 0.64 * (1.0 - (-ticks * 50e-6 / 0.5_f32).exp());
    assert!((on - expected).abs() < 2e-3, "{on} {expected}");
    assert_eq!(charged(Status::empty()), 0.0);
    assert_eq!(charged(Status::BEARING_ON | Status::APPLIED_VALID), 0.0);
}

/// A gap of the longest tick under the shortest thermal time heats up to the force and no further.
#[test]
fn a_gap_does_not_overshoot() {
    let mut supervisor = Supervisor::<16>::new(&Config {
        sample_period_s: 1e-2,
        // So slow a rotor that this is no slow tick.
        mass_kg: 1e4,
        continuous_force_n: 500.0,
        thermal_time_s: 1e-2,
        ..config()
    })
    .unwrap();
    let mut heat = |i: u32, wanted_n: f32| {
        supervisor.tick(&asking(5 * i, [1e-8 * i as f32, 0.0], [wanted_n, 0.0]));
        supervisor.report().thermal_state
    };
    let hot: Vec<f32> = (0..10).map(|i| heat(i, 400.0)).collect();
    let warm = hot.iter().all(|state| (0.0..0.6401).contains(state));
    assert!(warm && hot[9] > 0.63, "{hot:?}");
    let cold: Vec<f32> = (10..20).map(|i| heat(i, 0.0)).collect();
    assert!(cold.iter().all(|state| *state >= 0.0), "{cold:?}");
}

/// Speed \[m/s\] and first place \[clearances\] of a rotor on its way through the middle to the wall. By the middle
/// the observer has got over the start.
const SPEED_M_S: f32 = 0.1;
const FIRST: f32 = -0.8;

/// Where the supervisor takes over from a levitation controller that does nothing, after `warm_ticks` of the whole
/// cap there and back, and the cap then; in clearances and caps.
fn takes_over(warm_ticks: u32) -> (f64, f64) {
    let config = config_with(|c| (c.continuous_force_n, c.thermal_time_s) = (300.0, 0.5));
    let mut supervisor = Supervisor::<16>::new(&config).unwrap();
    for i in 0..warm_ticks {
        let force_n = if i % 2 == 0 { 1000.0 } else { -1000.0 };
        let at_m = [FIRST * 2e-4 + 1e-8 * (i % 100) as f32, 0.0];
        supervisor.tick(&asking(i, at_m, [0.0, force_n]));
    }
    let way_m = SPEED_M_S * config.sample_period_s;
    for i in 0.. {
        let x_m = FIRST * 2e-4 + way_m * i as f32;
        let command = supervisor.tick(&sample(warm_ticks + i, [x_m, 0.0]));
        if command.events.contains(Events::ENGAGED) {
            let cap = supervisor.report().force_cap_n / config.force_max_n;
            return (f64::from(x_m / 2e-4), f64::from(cap));
        }
        assert!(x_m < 2e-4, "no contact without a warning");
    }
    unreachable!("the rotor has reached the wall")
}

/// Contact is unavoidable where the force that is left, and no more, does not stop the rotor any longer.
#[test]
fn a_warm_magnet_takes_over_earlier() {
    let unit_m_s = (1000.0 * 2e-4_f64 / 10.0).sqrt();
    let (v, kappa) = (f64::from(SPEED_M_S) / unit_m_s, -2e5 * 2e-4 / 1000.0);
    let horizon = (1.5 * 50e-6 + 1.6e-4) * unit_m_s / 2e-4;
    let mut radii = Vec::new();
    for warm_ticks in [2, 2000] {
        let (radius, cap) = takes_over(warm_ticks);
        // (5.8) with the cap: r where v² = 2·s·(1 − r − v·H) + κ·(1 − r²).
        let left = |r: f64| 2.0 * cap * (1.0 - r - v * horizon) + kappa * (1.0 - r * r) - v * v;
        let mut radii_below = (0..10_000).map(|i| 1e-4 * f64::from(i));
        let expected = radii_below.find(|r| left(*r) < 0.0).unwrap();
        println!("cap {cap}, takes over at {radius}, expected {expected}");
        radii.push((radius, cap));
        // A tick's way is 0.025 clearances.
        assert!((radius - expected).abs() < 0.03, "{radius}, {expected}");
    }
    assert!(radii[0].1 > 0.99 && radii[1].1 < 0.5);
}

/// A continuous force of at least the cap is no budget.
/// Requirement: SR-05
#[test]
fn without_a_budget_the_cap_never_falls() {
    let mut supervisor = Supervisor::new(&config()).unwrap();
    let commands = whirl(&mut supervisor, 0..5000, Status::empty());
    assert!(commands.iter().all(|c| !c.limits.contains(Limits::DERATED)));
    assert_eq!(supervisor.report().force_cap_n, 1000.0);
}
