//! What crosses the supervisor's border besides positions: caps, slew limit, lost axes, the budget of
//! force and time, applied force, planes.

use proptest::prelude::*;
use supervisor::{Command, Config, Events, Limits, Mode, Sample, Status, Supervisor};
use system_tests::rig::{RADIUS_M, WHIRL_STEP, check, config, length, on_circle, sample, whirl};

/// A magnet that binds in every way: box inside the disc, slow, and soon warm.
fn bound() -> Config {
    Config {
        axis_force_max_n: 800.0,
        force_slew_n_s: 3e6,
        continuous_force_n: 300.0,
        thermal_time_s: 0.02,
        ..config()
    }
}

fn any_float() -> impl Strategy<Value = f32> {
    prop_oneof![
        2 => any::<u32>().prop_map(f32::from_bits),
        5 => -3e-4..3e-4_f32,
        3 => -2e3..2e3_f32,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever bits come in, in whatever mode: finite, within the cap, the axes' caps and the slew limit.
    /// Requirements: SR-01, SR-02, SR-03, SR-04
    #[test]
    fn any_bits_keep_every_limit(
        samples in prop::collection::vec(
            ([any_float(), any_float()], [any_float(), any_float()], [any_float(), any_float()], any_float(), any::<u32>(), 0..20_u32),
            1..80,
        ),
        shares in [0.2..1.5_f32, 5e-3..3.0_f32, 0.02..1.2_f32, 0.01..1.0_f32],
    ) {
        let with = Config {
            axis_force_max_n: 1000.0 * shares[0],
            force_slew_n_s: 1000.0 * shares[1] / 50e-6,
            continuous_force_n: 1000.0 * shares[2],
            thermal_time_s: shares[3],
            ..config()
        };
        let mut supervisor = Supervisor::<16>::new(&with).unwrap();
        let mut last_n = [0.0; 2];
        let mut sequence = 0_u32;
        for (position_m, levitation_n, applied_n, spin_rad_s, status, ahead) in samples {
            // Mostly one sample after the other, sometimes anything.
            sequence = sequence.wrapping_add(if ahead < 15 { 1 } else { status % (ahead * ahead) });
            let status = Status::from_bits_retain(if ahead < 10 { status & 7 } else { status });
            let command = supervisor.tick(&Sample { sequence, status, position_m, spin_rad_s, levitation_n, applied_n });
            prop_assert!(command.severity >= 0.0 && command.severity.is_finite());
            match check(&command, last_n, status, &with) {
                Ok(force_n) => last_n = force_n,
                Err(broken) => prop_assert!(false, "{}", broken),
            }
        }
        let report = supervisor.report();
        prop_assert!(report.severity_index.is_finite() && report.thermal_state.is_finite());
    }

    /// A levitation command within every limit goes through bit for bit, and nothing is said to bind.
    /// Requirement: SR-06
    #[test]
    fn levitation_within_the_limits_is_transparent(
        changes in prop::collection::vec([-90.0..90.0_f32, -90.0..90.0_f32], 1..80),
    ) {
        let with = bound();
        let mut supervisor = Supervisor::<16>::new(&with).unwrap();
        let mut force_n = [0.0_f32; 2];
        for (i, change) in changes.iter().enumerate() {
            for axis in 0..2 {
                force_n[axis] = (force_n[axis] + change[axis]).clamp(-200.0, 200.0);
            }
            let command = supervisor.tick(&Sample { levitation_n: force_n, ..sample(i as u32, [1e-7 * i as f32, 0.0]) });
            prop_assert_eq!(command.force_n.map(f32::to_bits), force_n.map(f32::to_bits));
            prop_assert_eq!(command.limits, Limits::empty());
        }
    }
}

/// All modes go by, and every limit holds and is named.
/// Requirement: SR-02
#[test]
fn limits_hold_and_are_named_through_a_whirl() {
    let with = bound();
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut last_n = [0.0; 2];
    let mut seen = Limits::empty();
    for command in whirl(&mut supervisor, 0..2000, Status::empty()) {
        last_n = check(&command, last_n, Status::empty(), &with).unwrap();
        seen |= command.limits;
    }
    let expected = Limits::AXIS_CAP | Limits::SLEW | Limits::DERATED | Limits::FORCE_CAP;
    assert!(seen.contains(expected), "{seen:?}");
}

/// Under caps of the axes the braking keeps its direction, and its room is used: it ends on the edge of
/// the box or of the disc.
#[test]
fn a_box_does_not_turn_the_braking_force() {
    let run = |axis_force_max_n: f32| {
        let with = Config {
            axis_force_max_n,
            ..config()
        };
        let mut supervisor = Supervisor::new(&with).unwrap();
        whirl(&mut supervisor, 0..400, Status::empty()).split_off(200)
    };
    for (free, boxed) in run(1000.0).iter().zip(run(750.0)) {
        let [a, b] = [free.force_n, boxed.force_n].map(|f| f.map(f64::from));
        let sine = (a[0] * b[1] - a[1] * b[0]) / (length(free.force_n) * length(boxed.force_n));
        assert!(sine.abs() < 0.01, "{free:?} {boxed:?}");
        let largest = b[0].abs().max(b[1].abs());
        assert!(
            largest > 749.0 || length(boxed.force_n) > 999.0,
            "{boxed:?}"
        );
    }
}

/// A slow command arrives after the time that its slew limit gives, exactly.
/// Requirement: SR-03
#[test]
fn the_slew_limit_is_the_length_of_the_change_per_time() {
    // 5 N a tick; 300 N are 60 ticks away.
    let with = Config {
        force_slew_n_s: 1e5,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    for i in 0..100_u32 {
        let s = Sample {
            levitation_n: [180.0, -240.0],
            ..sample(i, [1e-7 * i as f32, 0.0])
        };
        let command = supervisor.tick(&s);
        let way = (5.0 * f64::from(i + 1)).min(300.0);
        assert!(
            (length(command.force_n) - way).abs() < 1e-3,
            "{i}: {command:?}"
        );
        assert_eq!(
            command.limits.contains(Limits::SLEW),
            i < 59 || (i == 59 && way > 299.999 && command.force_n != [180.0, -240.0])
        );
        assert_eq!(command.mode, Mode::Levitated);
    }
}

/// On a lost axis nothing is commanded, the other brakes with the sign that takes power from the whirl
/// and with nearly all that one axis can take; losing and regaining are events, once each.
/// Requirement: SR-04
#[test]
fn a_lost_axis_leaves_the_best_of_the_other() {
    for (lost, axis) in [(Status::AXIS_X_LOST, 1), (Status::AXIS_Y_LOST, 0)] {
        let with = Config {
            amplifier_lag_s: 0.0,
            delay_samples: 0.0,
            ..config()
        };
        let mut supervisor = Supervisor::new(&with).unwrap();
        whirl(&mut supervisor, 0..200, Status::empty());
        let commands = whirl(&mut supervisor, 200..829, lost);
        let mut power = 0.0;
        let mut last_n = [0.0; 2];
        for (i, command) in (200_u32..).zip(&commands) {
            assert_eq!(command.mode, Mode::BackwardWhirl);
            assert_eq!(command.events.contains(Events::AXIS_LOST), i == 200);
            last_n = match i {
                200 => command.force_n,
                _ => check(command, last_n, lost, &with).unwrap(),
            };
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
        let events: Vec<bool> = (back.iter())
            .map(|c| c.events.contains(Events::AXIS_BACK))
            .collect();
        assert!(events[0] && !events[1..].contains(&true));
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
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut s = sample(0, [0.0; 2]);
    (s.levitation_n, s.status) = ([3.0, -4.0], s.status | Status::AXIS_X_LOST);
    let command = supervisor.tick(&s);
    assert_eq!(command.force_n, [0.0, -4.0]);
    assert_eq!(
        command.limits,
        Limits::AXIS_CAP | Limits::LEVITATION_CLAMPED
    );
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

/// A rotor moved by an actuator that is another than the model's: with its force measured the observer
/// follows it as closely as one whose model is right, and without it does not. What it takes the speed
/// for shows in the severity.
#[test]
fn the_applied_force_replaces_a_wrong_model() {
    /// Error of the estimated speed \[m/s\], root mean square, while 60 % of the commanded force
    /// throws a rotor across the clearance through another lag than the supervisor knows of.
    fn error(plant_lag_s: f64, measured: bool) -> f64 {
        let with = Config {
            // Slow, so that it leans on its model.
            observer_pole_flight: 0.9,
            stiffness_n_m: 0.0,
            // So severity is speed.
            friction_coefficient: 0.0,
            force_max_n: 4000.0,
            axis_force_max_n: 4000.0,
            continuous_force_n: 4000.0,
            ..config()
        };
        let mut supervisor = Supervisor::<16>::new(&with).unwrap();
        let limit = f64::from(supervisor.report().whirl_limit_m_s);
        let kept = (-50e-6 / plant_lag_s).exp();
        let (mut p, mut v) = ([-1.5e-4_f64, 8e-5], [0.0_f64; 2]);
        let (mut force, mut register) = ([0.0_f64; 2], [0.0_f32; 2]);
        let (mut sum, mut count) = (0.0, 0.0);
        for i in 0..60_u32 {
            let mut s = sample(i, p.map(|x| x as f32));
            s.applied_n = force.map(|f| f as f32);
            s.levitation_n = [3500.0, 0.0];
            if measured {
                s.status |= Status::APPLIED_VALID;
            }
            let command = supervisor.tick(&s);
            // Backward about the centre.
            let spin = (p[1] * v[0] - p[0] * v[1]) / 2e-4;
            if command.severity > 0.0 {
                sum += (f64::from(command.severity) * limit - spin.max(0.0)).powi(2);
                count += 1.0;
            }
            for axis in 0..2 {
                let target = 0.6 * f64::from(register[axis]);
                let away = force[axis] - target;
                // Exact mean of a lagging force over the tick.
                let mean = target + away * (1.0 - kept) * plant_lag_s / 50e-6;
                force[axis] = target + away * kept;
                p[axis] += v[axis] * 50e-6 + 0.5 * mean / 10.0 * 50e-6_f64.powi(2);
                v[axis] += mean / 10.0 * 50e-6;
            }
            register = command.force_n;
            if f64::hypot(p[0], p[1]) > 1.9e-4 {
                break;
            }
        }
        assert!(count > 2.0, "{count} ticks with contact ahead");
        f64::sqrt(sum / count)
    }
    for lag_s in [2e-5, 5e-4] {
        let (measured, modelled) = (error(lag_s, true), error(lag_s, false));
        assert!(
            measured < 2e-3 && modelled > 5.0 * measured,
            "{measured} {modelled}"
        );
    }
}

/// An applied force that is no number or longer than two caps is not believed: the model goes on, to the
/// bit.
#[test]
fn an_implausible_applied_force_is_not_believed() {
    let run = |status: Status, applied_n: [f32; 2]| {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        (0..300_u32)
            .map(|i| {
                let mut s = sample(i, on_circle(RADIUS_M, WHIRL_STEP * i as f32));
                s.status |= status;
                s.applied_n = applied_n;
                supervisor.tick(&s).force_n
            })
            .collect::<Vec<_>>()
    };
    let model = run(Status::empty(), [500.0, 0.0]);
    for implausible in [
        [f32::NAN, 0.0],
        [0.0, f32::INFINITY],
        [1500.0, 1500.0],
        [f32::MAX, 0.0],
    ] {
        assert_eq!(run(Status::APPLIED_VALID, implausible), model);
    }
    assert_ne!(run(Status::APPLIED_VALID, [1500.0, 0.0]), model);
}

/// Positions are those at the retainer bearing: a sensor at half the leverage with twice the ratio is
/// the same sensor, in commands and in the record.
#[test]
fn positions_are_carried_to_the_plane_of_the_retainer_bearing() {
    let run = |ratio: f32| {
        let with = Config {
            retainer_plane_ratio: ratio,
            sensor_step_m: 1e-6 / ratio,
            ..config()
        };
        let mut supervisor = Supervisor::<64>::new(&with).unwrap();
        // A record is frozen once the event is over.
        let commands: Vec<Command> = (0..1000_u32)
            .map(|i| {
                let share = 1.0 - (i.saturating_sub(400) as f32 / 100.0).min(0.99);
                let at = on_circle(share * RADIUS_M, WHIRL_STEP * i as f32);
                supervisor.tick(&sample(i, at.map(|x| x / ratio)))
            })
            .collect();
        let record: Vec<[u32; 2]> = supervisor
            .record()
            .unwrap()
            .entries()
            .map(|e| e.position)
            .collect();
        (commands, record)
    };
    assert_eq!(run(1.0), run(2.0));
}

/// Runs `ticks` on orbits within 0.4 c at the share of the speed, with noise; counts what is not the
/// levitation command to the bit.
fn idle(ticks: u32) -> u32 {
    // The pole that the host suggests for this noise.
    let with = Config {
        observer_pole_flight: 0.71,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut uniform = move || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random >> 40) as f32 / (1 << 24) as f32 - 0.5
    };
    // Sum of twelve uniforms: normal enough, to six times its size of 1 µm.
    let mut noise = move || 1e-6 * (0..12).map(|_| uniform()).sum::<f32>();
    let mut changed = 0;
    // Contact is unavoidable at 0.4 c beyond v² = 2·F/m·0.6·c − v·(delay): 0.134 m/s here. Half of it.
    let v = 0.067_f32;
    let rate = v / 8e-5;
    let mut angle = 0.0_f32;
    for i in 0..ticks {
        // Ellipses of all shapes, forward and backward, at the highest speed at their ends.
        let shape = ((i % 90_000) as f32 * (std::f32::consts::TAU / 90_000.0)).cos();
        angle = (angle + rate * 50e-6) % std::f32::consts::TAU;
        let position_m = [
            8e-5 * angle.cos() + noise(),
            shape * 8e-5 * angle.sin() + noise(),
        ];
        let levitation_n = [-4e5 * position_m[0], -4e5 * position_m[1]];
        let command = supervisor.tick(&Sample {
            levitation_n,
            ..sample(i, position_m)
        });
        let same = command.force_n.map(f32::to_bits) == levitation_n.map(f32::to_bits);
        changed += u32::from(!same || command.mode != Mode::Levitated || command.severity != 0.0);
    }
    changed
}

const IDLE_TICKS: u32 = 1_000_000;

/// Requirements: SR-06, SR-10
#[test]
fn an_idle_supervisor_changes_nothing() {
    assert_eq!(idle(IDLE_TICKS), 0);
}

/// The same for an hour and a half of operation.
#[test]
#[ignore = "takes half a minute"]
fn an_idle_supervisor_changes_nothing_for_long() {
    assert_eq!(idle(100 * IDLE_TICKS), 0);
}

/// A model that runs away within a few missed ticks, as that of a valid but absurd configuration does, is bounded
/// and goes on: what it leaves is a number, and so is everything that is reported.
#[test]
fn an_estimate_beyond_all_squares_comes_back() {
    let absurd = Config {
        mass_kg: 1e-4,
        stiffness_n_m: 1e10,
        sample_period_s: 9e-5,
        clearance_m: 1e-3,
        force_max_n: 1.0,
        axis_force_max_n: 1.0,
        continuous_force_n: 1.0,
        observer_pole_flight: 0.5,
        whirl_time_s: 0.1,
        speed_max_m_s: 1000.0,
        ..config()
    };
    let mut supervisor = Supervisor::<16>::new(&absurd).unwrap();
    // Two samples, four missed ticks, and on from there, to the wall and back.
    for (i, sequence) in [0, 1].into_iter().chain(6..200).enumerate() {
        let share = if i % 40 < 20 {
            0.49
        } else {
            0.9 + 0.01 * (i % 20) as f32
        };
        let position_m = [1e-3 * share, 1e-3 * (0.31 - 1e-4 * i as f32)];
        let command = supervisor.tick(&sample(sequence, position_m));
        assert!(
            !command.limits.contains(Limits::NOT_FINITE),
            "{i}: {command:?}"
        );
        assert!(command.severity.is_finite(), "{i}: {command:?}");
    }
    let report = supervisor.report();
    assert!(report.contact_ticks > 20, "{report:?}");
    let speeds = [report.impact_speed_max_m_s, report.backward_speed_max_m_s];
    assert!(speeds.iter().all(|v| v.is_finite()), "{report:?}");
    assert!(report.severity_index.is_finite(), "{report:?}");
}

/// The slew limit holds on the axis that is left; the force of the one that is lost is gone at once.
/// Requirements: SR-03, SR-04
#[test]
fn a_lost_axis_is_cut_at_once_and_the_other_goes_on_slowly() {
    // 5 N a tick.
    let with = Config {
        force_slew_n_s: 1e5,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut tick = |i: u32, lost: Status, levitation_n: [f32; 2]| {
        let now = sample(i, [1e-7 * i as f32, 0.0]);
        let status = now.status | lost;
        let command = supervisor.tick(&Sample {
            levitation_n,
            status,
            ..now
        });
        command.force_n
    };
    for i in 0..100 {
        tick(i, Status::empty(), [180.0, -240.0]);
    }
    for i in 1..=10_u32 {
        let [x, y] = tick(99 + i, Status::AXIS_X_LOST, [180.0, 0.0]);
        assert_eq!(x, 0.0);
        assert!((y + 240.0 - 5.0 * i as f32).abs() < 1e-2, "{y}");
    }
}
