//! The slew limit, and axes that the status says are lost.

use supervisor::{Events, Limits, Mode, Status, Supervisor};
use test_support::bounds::{Bounds, per_unit};
use test_support::rig::{
    WHIRL_STEP, config, config_with, length, new_supervisor, sample_with, ticks_of, whirl,
};

/// On a lost axis nothing is commanded, the other brakes with the sign that takes power from the whirl
/// and with nearly all that one axis can take; losing and regaining are events, once each.
/// Requirement: SR-04
#[test]
fn a_lost_axis_leaves_the_best_of_the_other() {
    for (lost, axis) in [(Status::AXIS_X_LOST, 1), (Status::AXIS_Y_LOST, 0)] {
        let with = config_with(|c| (c.amplifier_lag_s, c.delay_samples) = (0.0, 0.0));
        let mut supervisor = Supervisor::new(&with).unwrap();
        whirl(&mut supervisor, 0..200, Status::empty());
        let commands = whirl(&mut supervisor, 200..829, lost);
        let (mut power, mut bounds) = (0.0, Bounds::in_newtons(&with));
        for (i, command) in (200_u32..).zip(&commands) {
            assert_eq!(command.mode, Mode::BackwardWhirl);
            assert_eq!(command.events.contains(Events::AXIS_LOST), i == 200);
            (bounds.check(&per_unit(&with.scaling(), command), lost)).unwrap();
            assert_eq!(command.force_n[1 - axis], 0.0, "{i}");
            // Braking value of the force where it acts, half a tick later: against b̂ + μ·n̂.
            let angle = WHIRL_STEP * (i as f32 + 0.5);
            let (n, b) = ([angle.cos(), -angle.sin()], [-angle.sin(), -angle.cos()]);
            let value = -(command.force_n[axis] * (b[axis] + 0.15 * n[axis]));
            assert!(value > -30.0, "{i}: drives with {} N", -value);
            power += value;
        }
        // The sign alone would give 2/π of the force, a plain projection one half.
        let share = power / commands.len() as f32 / (1000.0 * (1.0_f32 + 0.0225).sqrt());
        assert!(share > 0.59 && share < 0.64, "{share}");
        let back = whirl(&mut supervisor, 829..840, Status::empty());
        assert_eq!(ticks_of(&back, Events::AXIS_BACK), [0]);
        assert!(back.iter().any(|c| c.force_n[1 - axis].abs() > 500.0));
    }
}

/// With both axes lost there is no force, and the mode still says what the rotor does.
/// Requirement: SR-04
#[test]
fn without_axes_the_mode_stays_meaningful() {
    let mut supervisor = Supervisor::new(&config()).unwrap();
    let lost = Status::AXIS_X_LOST | Status::AXIS_Y_LOST;
    let commands = whirl(&mut supervisor, 0..400, lost);
    assert!(commands.iter().all(|c| c.force_n == [0.0; 2]));
    assert_eq!(commands[399].mode, Mode::BackwardWhirl);
    assert!(commands[399].limits.contains(Limits::AXIS_CAP));
    // Levitated, a command on what is left goes through.
    let command = new_supervisor().tick(&sample_with(0, [0.0; 2], |s| {
        (s.levitation_n, s.status) = ([3.0, -4.0], s.status | Status::AXIS_X_LOST);
    }));
    assert_eq!(command.force_n, [0.0, -4.0]);
    let named = Limits::AXIS_CAP | Limits::LEVITATION_CLAMPED;
    assert_eq!(command.limits, named);
}

/// A slow command arrives after the time that its slew limit gives, exactly. On the axis that is left then the limit holds; the
/// force of the one that is lost is gone at once.
/// Requirements: SR-03, SR-04
#[test]
fn a_lost_axis_is_cut_at_once_and_the_other_goes_on_slowly() {
    // 5 N a tick; 300 N are 60 ticks away.
    let with = config_with(|c| c.force_slew_n_s = 1e5);
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut tick = |i: u32, lost: Status, levitation_n: [f32; 2]| {
        supervisor.tick(&sample_with(i, [1e-7 * i as f32, 0.0], |now| {
            now.levitation_n = levitation_n;
            now.status |= lost;
        }))
    };
    for i in 1..=100_u32 {
        let command = tick(i, Status::empty(), [180.0, -240.0]);
        let way = (5.0 * f64::from(i)).min(300.0);
        let off = length(command.force_n) - way;
        assert!(off.abs() < 1e-3, "{i}: {command:?}");
        let arrived = command.force_n == [180.0, -240.0];
        assert!(arrived == (i > 60) || i == 60, "{i}: {command:?}");
        assert_eq!(command.limits.contains(Limits::SLEW), !arrived);
        assert_eq!(command.mode, Mode::Levitated);
    }
    for i in 1..=10_u32 {
        let [x, y] = tick(100 + i, Status::AXIS_X_LOST, [180.0, 0.0]).force_n;
        assert_eq!(x, 0.0);
        assert!((y + 240.0 - 5.0 * i as f32).abs() < 1e-2, "{y}");
    }
}
