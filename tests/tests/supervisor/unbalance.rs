//! A load that turns with the rotor, and a rotor that lies still: what the observer must not take for something
//! else.

use firmware_bench::device::loads::{Disturbance, TimedChange};
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::outcome::Outcome;
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::{Change, V2};
use std::f64::consts::TAU;
use std::fs;
use supervisor::Mode;
use system_tests::scene_path;

const CAP_N: f64 = 1000.0;
const LOST_AT_S: f64 = 0.01;

fn seen(scene: &Scene, policy: PolicyKind) -> (Figures, Trace) {
    run(scene, policy, Keep::Trace, &mut |_| {}).unwrap()
}

/// The AMB rotor of `overload_then_release` at another speed and rate of the loop, without its overload.
fn rotor_at(spin_hz: f64, rate_hz: u32) -> Scene {
    let text = fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let rate = format!("sample_rate_hz = {rate_hz}");
    let text = text.replace("sample_rate_hz = 20000", &rate);
    let mut scene = Scene::parse("overload_then_release", &text).unwrap();
    assert_eq!(scene.sample_rate_hz, f64::from(rate_hz));
    scene.disturbances.clear();
    scene.start.spin_rad_s = TAU * spin_hz;
    scene.duration_s = 0.4;
    scene
}

/// With a blade lost for good, whose unbalance asks for so many caps at this speed.
fn blade_lost(spin_hz: f64, caps: f64, rate_hz: u32) -> Scene {
    let mut scene = rotor_at(spin_hz, rate_hz);
    let rate = TAU * spin_hz;
    let change = Change {
        eccentricity_m: Some(caps * CAP_N / (10.0 * rate * rate)),
        ..Change::default()
    };
    scene.changes = vec![TimedChange {
        at_s: LOST_AT_S,
        change,
    }];
    scene
}

/// Ticks of a stretch of a run in which the supervisor was in this mode.
fn ticks_in(mode: Mode, rows: &[TraceRow]) -> usize {
    let in_mode = |row: &&TraceRow| row.supervisor_mode() == Some(mode);
    rows.iter().filter(in_mode).count()
}

/// Share of the last part of a run in which the levitation controller had the bearing.
fn levitated_at_the_end(trace: &Trace) -> f64 {
    let last = &trace.rows[trace.rows.len() / 2..];
    ticks_in(Mode::Levitated, last) as f64 / last.len() as f64
}

/// An unbalance beyond the cap needs no force where its circle has room: the supervisor leaves the rotor to it, or
/// gives it back soon, whichever way it spins.
#[test]
fn a_rotor_is_left_to_circle_round_its_mass_centre() {
    for (spin_hz, caps) in [(300.0, 1.3), (-300.0, 1.3), (500.0, 1.6), (500.0, 2.0)] {
        for rate_hz in [10_000, 20_000] {
            let scene = blade_lost(spin_hz, caps, rate_hz);
            let what = format!("{caps} caps at {spin_hz} Hz, {rate_hz} ticks/s");
            let (alone, _) = seen(&scene, PolicyKind::Levitation);
            let (own, trace) = seen(&scene, PolicyKind::Supervisor);
            assert!(own.impacts <= alone.impacts + 1, "{what}: {}", own.impacts);
            let touches = [Outcome::Bouncing, Outcome::Rubbing].contains(&own.outcome);
            assert!(!touches, "{what}: {:?}", own.outcome);
            let share = levitated_at_the_end(&trace);
            assert!(share > 0.99, "{what}: levitated for {share}");
        }
    }
}

/// The same with a spin that nobody tells: then it is a load, which the supervisor acts against until it sees that it comes
/// no farther. That is what the part of the observer is for: with the spin known it never comes to that.
#[test]
fn without_the_spin_it_is_a_load() {
    let handed_back = |valid: bool| {
        let mut scene = blade_lost(300.0, 1.3, 20_000);
        scene.spin_sensor.valid = valid;
        let (_, trace) = seen(&scene, PolicyKind::Supervisor);
        ticks_in(Mode::HandedBack, &trace.rows)
    };
    assert!(handed_back(false) > 100);
    assert_eq!(handed_back(true), 0);
}

/// A load that stands still is no unbalance: the supervisor acts against it as soon as it would with the spin
/// unknown.
#[test]
fn a_load_that_stands_still_is_seen_as_soon() {
    for spin_hz in [150.0, 200.0, 300.0, 500.0] {
        let mut scene = rotor_at(spin_hz, 20_000);
        scene.disturbances = vec![Disturbance {
            start_s: 0.02,
            duration_s: 0.05,
            force_n: V2::new(1.3 * CAP_N, 0.75 * CAP_N),
            ..Disturbance::default()
        }];
        let engaged_s = |known: bool| {
            let mut scene = scene.clone();
            scene.spin_sensor.valid = known;
            let (_, trace) = seen(&scene, PolicyKind::Supervisor);
            let acts = |row: &&TraceRow| row.supervisor_mode() != Some(Mode::Levitated);
            let first = trace.rows.iter().find(acts);
            first.expect("it has to act").plant.t_s
        };
        let later_s = engaged_s(true) - engaged_s(false);
        let period_s = 1.0 / scene.sample_rate_hz;
        assert!(later_s < 1.5 * period_s, "{spin_hz} Hz: {later_s} s later");
    }
}

/// The force that lifts a rotor off the bearing does not count as its speed, however slow a noisy sensor makes the
/// observer: what is left of the load after an overload is less than the push, and the rotor comes off.
#[test]
fn a_push_on_a_rotor_at_rest_is_no_speed() {
    for pole in [0.8, 0.9, 0.95] {
        let mut scene = rotor_at(200.0, 20_000);
        let load = |start_s, duration_s, caps| Disturbance {
            start_s,
            duration_s,
            force_n: V2::new(caps * CAP_N, 0.0),
            ..Disturbance::default()
        };
        scene.disturbances = vec![load(0.01, 0.05, 1.5), load(0.06, 0.44, 0.55)];
        scene.planes[0].sensor.noise_rms_m = 3e-6;
        let config = scene.planes[0].supervisor.as_mut().unwrap();
        config.observer_pole_contact = pole;
        config.observer_pole_flight = pole;
        config.sensor_step_m = 3e-6;
        let (own, trace) = seen(&scene, PolicyKind::Supervisor);
        assert_ne!(own.outcome, Outcome::Pinned, "pole {pole}");
        let overloaded = trace.rows.partition_point(|row| row.plant.t_s < 0.06);
        let before = ticks_in(Mode::Pinned, &trace.rows[..overloaded]);
        assert!(before > 100, "pole {pole}: the overload pins it");
        let after = trace.rows.partition_point(|row| row.plant.t_s <= 0.08);
        let still = ticks_in(Mode::Pinned, &trace.rows[after..]);
        assert_eq!(still, 0, "pole {pole}: pinned for {still} ticks");
    }
}
