//! What crosses the supervisor's border besides positions: caps, slew limit, applied force, planes.

use proptest::prelude::*;
use supervisor::{Command, Config, Limits, Mode, Status, Supervisor};
use test_support::bounds::{Bounds, per_unit};
use test_support::rig::{
    RADIUS_M, WHIRL_STEP, asking, config, config_with, length, new_supervisor, on_circle, sample,
    sample_with, whirl,
};
use test_support::storm::Chance;

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

/// Within ±1, and zeros of either sign.
fn share() -> impl Strategy<Value = f32> {
    prop_oneof![8 => -1.0..1.0_f32, 1 => Just(0.0), 1 => Just(-0.0)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// In the middle a levitation command within every limit goes through bit for bit, signed zeros included, and nothing is said
    /// to bind: where it may change at will, and where the magnet binds in every way.
    /// Requirement: SR-06
    #[test]
    fn levitation_within_the_limits_is_transparent(
        ticks in prop::collection::vec(([share(), share()], [share(), share()]), 1..80),
    ) {
        let (mut free, mut slow) = (Supervisor::<16>::new(&config()).unwrap(), Supervisor::<16>::new(&bound()).unwrap());
        let (mut at_m, mut slow_n) = ([0.0_f32; 2], [0.0_f32; 2]);
        for (i, (to, shares)) in ticks.into_iter().enumerate() {
            // An orbit that a sensor could see.
            at_m = [0, 1].map(|k| at_m[k] + 0.01 * (2e-5 * to[k] - at_m[k]));
            slow_n = [0, 1].map(|k| (slow_n[k] + 90.0 * shares[k]).clamp(-200.0, 200.0));
            for (supervisor, levitation_n) in [(&mut free, shares.map(|x| 700.0 * x)), (&mut slow, slow_n)] {
                let command = supervisor.tick(&asking(i as u32, at_m, levitation_n));
                prop_assert_eq!(command.mode, Mode::Levitated);
                prop_assert_eq!(command.force_n.map(f32::to_bits), levitation_n.map(f32::to_bits));
                prop_assert_eq!(command.limits, Limits::empty());
            }
        }
    }
}

/// All modes go by, and every limit holds and is named.
/// Requirement: SR-02
#[test]
fn limits_hold_and_are_named_through_a_whirl() {
    let with = bound();
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut bounds = Bounds::in_newtons(&with);
    let mut seen = Limits::empty();
    for command in whirl(&mut supervisor, 0..2000, Status::empty()) {
        let checked = bounds.check(&per_unit(&with.scaling(), &command), Status::empty());
        checked.unwrap();
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
        let with = config_with(|c| c.axis_force_max_n = axis_force_max_n);
        let mut supervisor = Supervisor::new(&with).unwrap();
        whirl(&mut supervisor, 0..400, Status::empty()).split_off(200)
    };
    for (free, boxed) in run(1000.0).iter().zip(run(750.0)) {
        let [a, b] = [free.force_n, boxed.force_n].map(|f| f.map(f64::from));
        let sine = (a[0] * b[1] - a[1] * b[0]) / (length(free.force_n) * length(boxed.force_n));
        assert!(sine.abs() < 0.01, "{free:?} {boxed:?}");
        let largest = b[0].abs().max(b[1].abs());
        let used = largest > 749.0 || length(boxed.force_n) > 999.0;
        assert!(used, "{boxed:?}");
    }
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
            let command = supervisor.tick(&sample_with(i, p.map(|x| x as f32), |s| {
                s.applied_n = force.map(|f| f as f32);
                s.levitation_n = [3500.0, 0.0];
                s.status.set(Status::APPLIED_VALID, measured);
            }));
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
        let follows = measured < 2e-3 && modelled > 5.0 * measured;
        assert!(follows, "{measured} {modelled}");
    }
}

/// An applied force that is no number or longer than two caps is not believed: the model goes on, to the
/// bit.
#[test]
fn an_implausible_applied_force_is_not_believed() {
    let run = |status: Status, applied_n: [f32; 2]| {
        let mut supervisor = new_supervisor();
        let commands = (0..300_u32).map(|i| {
            let at = on_circle(RADIUS_M, WHIRL_STEP * i as f32);
            supervisor.tick(&sample_with(i, at, |s| {
                (s.status, s.applied_n) = (s.status | status, applied_n);
            }))
        });
        commands.map(|c| c.force_n).collect::<Vec<_>>()
    };
    let model = run(Status::empty(), [500.0, 0.0]);
    let infinite = [0.0, f32::INFINITY];
    for implausible in [[f32::NAN, 0.0], infinite, [1500.0, 1500.0], [f32::MAX, 0.0]] {
        assert_eq!(run(Status::APPLIED_VALID, implausible), model);
    }
    assert_ne!(run(Status::APPLIED_VALID, [1500.0, 0.0]), model);
}

/// Positions are those at the retainer bearing: a sensor at half the leverage with twice the ratio is
/// the same sensor, in commands and in the record.
#[test]
fn positions_are_carried_to_the_plane_of_the_retainer_bearing() {
    let run = |ratio: f32| {
        let step_m = 1e-6 / ratio;
        let with = config_with(|c| (c.retainer_plane_ratio, c.sensor_step_m) = (ratio, step_m));
        let mut supervisor = Supervisor::<64>::new(&with).unwrap();
        // A record is frozen once the event is over.
        let ticks = (0..1000_u32).map(|i| {
            let share = 1.0 - (i.saturating_sub(400) as f32 / 100.0).min(0.99);
            let at = on_circle(share * RADIUS_M, WHIRL_STEP * i as f32);
            supervisor.tick(&sample(i, at.map(|x| x / ratio)))
        });
        let commands: Vec<Command> = ticks.collect();
        let record = supervisor.record().unwrap();
        let record: Vec<[u32; 2]> = record.entries().map(|e| e.position).collect();
        (commands, record)
    };
    assert_eq!(run(1.0), run(2.0));
}

/// Runs `ticks` on orbits within 0.4 c at the share of the speed, with noise; counts what is not the
/// levitation command to the bit.
fn idle(ticks: u32) -> u32 {
    // The pole that the host suggests for this noise.
    let with = config_with(|c| c.observer_pole_flight = 0.71);
    let mut supervisor = Supervisor::<64>::new(&with).unwrap();
    let mut chance = Chance::new(1);
    // Sum of twelve uniforms: normal enough, to six times its size of 1 µm.
    let mut noise = move || 1e-6 * (0..12).map(|_| chance.share() - 0.5).sum::<f32>();
    let mut changed = 0;
    // Contact is unavoidable at 0.4 c beyond v² = 2·F/m·0.6·c − v·(delay): 0.134 m/s here. Half of it.
    let v = 0.067_f32;
    let rate = v / 8e-5;
    let mut angle = 0.0_f32;
    for i in 0..ticks {
        // Ellipses of all shapes, forward and backward, at the highest speed at their ends.
        let shape = ((i % 90_000) as f32 * (std::f32::consts::TAU / 90_000.0)).cos();
        angle = (angle + rate * 50e-6) % std::f32::consts::TAU;
        let (x, y) = (8e-5 * angle.cos(), shape * 8e-5 * angle.sin());
        let position_m = [x + noise(), y + noise()];
        let levitation_n = [-4e5 * position_m[0], -4e5 * position_m[1]];
        let command = supervisor.tick(&asking(i, position_m, levitation_n));
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
        let share = [0.49, 0.9 + 0.01 * (i % 20) as f32][i / 20 % 2];
        let position_m = [1e-3 * share, 1e-3 * (0.31 - 1e-4 * i as f32)];
        let command = supervisor.tick(&sample(sequence, position_m));
        let named = command.limits.contains(Limits::NOT_FINITE);
        assert!(!named && command.severity.is_finite(), "{i}: {command:?}");
    }
    let report = supervisor.report();
    assert!(report.contact_ticks > 20, "{report:?}");
    let [impact, backward] = [report.impact_speed_max_m_s, report.backward_speed_max_m_s];
    let numbers = [impact, backward, report.severity_index];
    assert!(numbers.iter().all(|v| v.is_finite()), "{report:?}");
}
