//! A levitation controller that hardly asks for anything in the middle gets the bearing all the same.

use firmware_bench::device::axis::Axis;
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::controller::controller;
use firmware_bench::run::trace::TraceRow;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::machines::plants::plants;
use supervisor::Mode;

/// On a shaft that centres the rotor a damper alone levitates. A jump of the sensor engages the supervisor; when it is
/// over the rotor stands in the middle, and noise of 1 µm must not keep it from the hand-over, whatever the seed.
/// Requirement: SR-26
#[test]
fn noise_in_the_middle_does_not_hold_the_hand_over_up() {
    for plant in plants(20_000.0).unwrap() {
        if !plant.name.starts_with("P1") {
            continue;
        }
        for seed in 0..5 {
            let clearance_m = plant.scene.plant.contact.clearance_m;
            let damper = LevitationParams {
                proportional_n_m: 0.0,
                integral_n_m_s: 0.0,
                derivative_n_s_m: 500.0,
                derivative_filter_s: 2e-4,
            };
            let scene = Scene {
                seed,
                duration_s: 0.15,
                levitation: Some(damper),
                faults: vec![Fault {
                    start_s: 0.02,
                    duration_s: 0.01,
                    kind: FaultKind::Offset(0.2 * clearance_m),
                    axis: Axis::X,
                }],
                ..plant.scene.clone()
            };
            let policy = controller(PolicyKind::Supervisor, &scene).unwrap();
            let acting = (policy, "supervisor");
            let (_, trace) = run_policy(&scene, acting, Keep::Trace, &mut |_| {}).unwrap();
            let modes = trace.rows.iter().filter_map(TraceRow::supervisor_mode);
            let modes: Vec<Mode> = modes.collect();
            let engaged = modes.iter().filter(|m| **m != Mode::Levitated).count();
            // 10 ms of fault, and at most as long to come back; at 20 kHz.
            let what = format!("{}, seed {seed}: engaged for {engaged} ticks", plant.name);
            assert!((1..600).contains(&engaged), "{what}");
            assert_eq!(modes.last(), Some(&Mode::Levitated), "{what}");
        }
    }
}
