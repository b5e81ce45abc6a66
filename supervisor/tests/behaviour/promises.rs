//! What the supervisor does to a rotor: nothing, softens an approach, brakes a whirl.

use supervisor::{Command, Config, Events, IntegratorHint, Limits, Mode, Status, Supervisor};
use test_support::rig::{asking, config, length, new_supervisor, sample, sample_with};

/// A command beyond the cap is shortened in its direction; one that is no number becomes zero.
/// Requirement: SR-07
#[test]
fn levitation_commands_are_limited_with_a_flag() {
    let mut supervisor = new_supervisor();
    let in_bounds = |n: [f32; 2]| n[0] > 999.9 && n[0] <= 1000.0 && n[1] == 0.0;
    let [long, odd] = [(0, [3000.0, 0.0]), (1, [f32::NAN, 5.0])].map(|(i, levitation_n)| {
        let command = supervisor.tick(&asking(i, [0.0; 2], levitation_n));
        assert_eq!(command.limits, Limits::LEVITATION_CLAMPED);
        command.force_n
    });
    assert!(in_bounds(long), "{long:?}");
    assert_eq!(odd, [0.0, 5.0]);
}

/// What the supervisor commands on the way to the wall ahead along x at 0.4 m/s, spin counter-clockwise
/// (backward is −y there), as long as a force still comes before the impact: 1.5 ticks and 3.2 of lag.
fn approaching(force_max_n: f32) -> Vec<Command> {
    const STEP_M: f32 = 2e-5;
    let config = Config {
        force_max_n,
        axis_force_max_n: force_max_n,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&config).unwrap();
    let commands = (0..12_u32).filter_map(|i| {
        let x = STEP_M * i as f32 - 6e-5;
        let command = supervisor.tick(&asking(i, [x, 0.0], [3.0, -4.0]));
        let in_time = (2e-4 - x) / STEP_M > 5.5;
        (command.mode == Mode::Approach && in_time).then_some(command)
    });
    commands.collect()
}

/// An impact that would drive the rotor beyond what a weak magnet can stop is met along the wall, never with the
/// whole capacity inwards; one that is harmless to a strong one is softened.
#[test]
fn approach_is_tangential_where_it_is_dangerous() {
    let dangerous = approaching(200.0);
    assert!(!dangerous.is_empty());
    for command in &dangerous {
        let [inward, tangential] = [-command.force_n[0], command.force_n[1]];
        assert!(command.severity > 2.0, "{command:?}");
        assert!(inward < 0.9 * 200.0, "{command:?}");
        // The rest damps the speed of the impact itself.
        let most = (0.5 * length(command.force_n) as f32).max(100.0);
        assert!(tangential > most, "{command:?}");
    }
    let harmless = approaching(3100.0);
    assert!(!harmless.is_empty());
    for command in &harmless {
        // A hair above the whirl limit's share from which on impacts count.
        assert!(command.severity < 0.61, "{command:?}");
        assert!(command.force_n[0] < -0.99 * 3100.0, "{command:?}");
    }
    assert!(dangerous[0].events.contains(Events::ENGAGED));
    // The controller asks outwards there: running undoes what it holds.
    assert_eq!(dangerous[0].integrator, IntegratorHint::Run);
}

/// In sustained backward whirl the force brakes: against the motion, and mostly along the wall.
/// Requirement: SR-23
#[test]
fn whirl_is_braked_along_the_wall() {
    for spin in [1000.0_f32, -1000.0] {
        let mut supervisor = new_supervisor();
        let whirl = -spin.signum();
        let mut last = Command::default();
        let mut at = 0.0_f32;
        for i in 0..400_u32 {
            at = whirl * 500.0 * 50e-6 * i as f32;
            let mut s = sample(i, [2.05e-4 * at.cos(), 2.05e-4 * at.sin()]);
            s.spin_rad_s = spin;
            last = supervisor.tick(&s);
        }
        assert_eq!(last.mode, Mode::BackwardWhirl);
        // Delivered force: later by 1.5 ticks and the lag's atan(ωτ).
        let turn = whirl * 500.0 * 1.5 * 50e-6;
        let lag = whirl * (500.0_f32 * 1.6e-4).atan();
        let (n, t) = ((at + turn).cos(), (at + turn).sin());
        let rotate =
            |[x, y]: [f32; 2], a: f32| [x * a.cos() - y * a.sin(), x * a.sin() + y * a.cos()];
        let delivered = rotate(last.force_n, -lag);
        let radial = delivered[0] * n + delivered[1] * t;
        let along = whirl * (-delivered[0] * t + delivered[1] * n);
        assert!(along < -0.95 * 1000.0, "brakes with {along} N");
        // Inward of tangential by atan μ, never ahead of it.
        assert!((-0.2 * 1000.0..0.0).contains(&radial), "radial {radial} N");
    }
}

/// A bearing that is switched off is left alone, wherever the rotor lies; switched on, it is not.
/// Requirement: SR-08
#[test]
fn nothing_happens_while_the_bearing_is_off() {
    let mut supervisor = new_supervisor();
    let at_m = [2.01e-4, 0.0];
    for i in 0..200 {
        let off = sample_with(i, at_m, |s| s.status -= Status::BEARING_ON);
        let command = supervisor.tick(&off);
        assert_eq!((command.mode, command.force_n), (Mode::Levitated, [0.0; 2]));
    }
    // On the wall, and its controller has no force to spare.
    let on = asking(200, at_m, [-900.0, 0.0]);
    assert_ne!(supervisor.tick(&on).mode, Mode::Levitated);
}

/// With unknown spin and no whirl there is no sense to push in, and noise must not make one up.
#[test]
fn unknown_spin_does_not_make_the_force_jump() {
    let mut supervisor = new_supervisor();
    let mut last = 0.0;
    let mut jumps = 0;
    for i in 0..18_u32 {
        let noise = if i % 2 == 0 { 1e-6 } else { -1e-6 };
        let at_m = [1e-5 * i as f32, noise];
        let command = supervisor.tick(&sample_with(i, at_m, |s| s.status = Status::BEARING_ON));
        if command.mode != Mode::Levitated {
            jumps += u32::from((command.force_n[1] - last).abs() > 600.0);
            last = command.force_n[1];
        }
    }
    assert_eq!(jumps, 0);
}
