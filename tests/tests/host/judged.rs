//! What a run is said to have come to, at the edges of its definitions.

use crate::closed_loop::verdict;
use firmware_bench::device::axis::Axis;
use firmware_bench::device::loads::{Disturbance, TimedChange};
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::run::outcome::Outcome;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::params::SlidingFriction;
use plant_model::{Change, V2};
use system_tests::scene;

/// A rotor that slides round the wall without friction, pressed by the magnets, neither rests nor bounces.
#[test]
fn a_rotor_in_unbroken_contact_rubs() {
    let mut scene = scene("overload_then_release");
    scene.disturbances.clear();
    scene.machine.planes[0].friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    scene.planes[0].whirl_speed_m_s = 1.0;
    // In balance: (m·v²/r + |k|·r)/k_c deep.
    scene.start.centre_m = V2::new(2.0204e-4, 0.0);
    scene.start.centre_velocity_m_s = V2::new(0.0, 0.2);
    let mut after = |duration_s: f64| {
        scene.duration_s = duration_s;
        verdict(&scene, PolicyKind::Passive)
    };
    let long = after(0.05);
    assert_eq!((long.outcome, long.impacts), (Outcome::Rubbing, 0));
    assert!(!long.recovered && (long.contact_time_s - 0.05).abs() < 1e-9);
    // Too soon to tell.
    assert_eq!(after(0.004).outcome, Outcome::Bouncing);
}

/// A rotor that the magnets pull away from the middle is not back while it happens to be near it still.
#[test]
fn a_rotor_on_its_way_out_has_not_recovered() {
    let mut scene = scene("overload_then_release");
    scene.disturbances.clear();
    scene.start.centre_m = V2::new(1e-5, 0.0);
    scene.duration_s = 0.024;
    for kind in [PolicyKind::Passive, PolicyKind::Levitation] {
        let figures = verdict(&scene, kind);
        assert_eq!(figures.impacts, 0);
        let held = kind == PolicyKind::Levitation;
        assert_eq!(figures.recovered, held, "{figures:?}");
        assert_eq!(figures.outcome == Outcome::Diverging, !held);
        assert_eq!(figures.relevitation_time_s.is_some(), held);
    }
    // Too soon to tell; and when it has touched there is no doubt.
    scene.duration_s = 0.01;
    assert!(verdict(&scene, PolicyKind::Passive).recovered);
    scene.duration_s = 0.08;
    let touched = verdict(&scene, PolicyKind::Passive);
    assert!(touched.impacts > 0 && !touched.recovered, "{touched:?}");
}

/// The clock waits for what was there at a sample, and a change in the run.
#[test]
fn what_no_sample_sees_does_not_move_the_clock() {
    let mut scene = scene("overload_then_release");
    let clock_s = scene.clock_starts_s(0);
    let fault = |start_s: f64, duration_s: f64| Fault {
        start_s,
        duration_s,
        kind: FaultKind::Nan,
        axis: Axis::Both,
    };
    // Samples at 0.15 and 0.15005 s, the last at 0.19995 s.
    for (start_s, duration_s, seen) in [
        (0.150_01, 3.9e-5, false),
        (0.150_01, 4.1e-5, true),
        (0.15, 1e-6, true),
        (0.199_96, 1.0, false),
        (0.199_95, 1.0, true),
    ] {
        scene.planes[0].faults = vec![fault(start_s, duration_s)];
        let moved = scene.clock_starts_s(0) != clock_s;
        assert_eq!(moved, seen, "{start_s} s for {duration_s} s");
    }
    scene.planes[0].faults.clear();
    // 400.4 samples are 400: the rest is not run.
    scene.duration_s = 0.200_02;
    for (at_s, runs) in [(0.19, true), (0.200_01, false)] {
        let change = Change {
            eccentricity_m: Some(1e-6),
            ..Change::default()
        };
        scene.changes = vec![TimedChange { at_s, change }];
        assert_eq!(scene.clock_starts_s(0) == at_s, runs, "{at_s}");
    }
}

/// A rotor that never left the middle is back at once, at whatever sample the load ends.
#[test]
fn round_off_of_sample_times_is_no_time() {
    let mut scene = scene("overload_then_release");
    scene.machine.supports.clear();
    for i in 1..=100 {
        let start_s = 1e-3 * f64::from(i);
        scene.disturbances = vec![Disturbance {
            start_s,
            duration_s: 7e-4,
            force_n: V2::new(1e-6, 0.0),
            ..Disturbance::default()
        }];
        scene.duration_s = start_s + 8e-3;
        let verdict = verdict(&scene, PolicyKind::Passive);
        assert_eq!(verdict.outcome, Outcome::Recovered, "{start_s}");
        assert_eq!(verdict.relevitation_time_s, Some(0.0), "{start_s}");
    }
}
