//! A levitation controller that hardly asks for anything in the middle gets the bearing all the same.

use crate::common::ran;
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::device::loads::Disturbance;
use firmware_bench::run::closed_loop::Keep;
use firmware_bench::run::controller::controller;
use firmware_bench::run::trace::TraceRow;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::machines::plants::plants;
use plant_model::V2;
use supervisor::Mode;

/// On a shaft that centres the rotor a damper alone levitates. A blow engages the supervisor; when it is
/// over the rotor stands in the middle, and noise of 1 µm must not keep it from the hand-over, whatever the seed.
/// Requirement: SR-26
#[test]
fn noise_in_the_middle_does_not_hold_the_hand_over_up() {
    let all = plants(20_000.0).unwrap().into_iter();
    for plant in all.filter(|plant| plant.name.starts_with("P1")) {
        for seed in 0..5 {
            // Beyond what shaft and magnet stop before the wall.
            let mut scene = plant.scene.clone();
            let mass_kg = scene.machine.rotor.rigid().mass_kg;
            let blow_n = 1e3 * mass_kg * 2.0 * scene.planes[0].nominal.force_speed_m_s();
            scene.duration_s = 0.25;
            scene.planes[0].seed = seed;
            scene.planes[0].levitation = Some(LevitationParams {
                proportional_n_m: 0.0,
                integral_n_m_s: 0.0,
                derivative_n_s_m: 500.0,
                derivative_filter_s: 2e-4,
            });
            scene.disturbances = vec![Disturbance {
                start_s: 0.1,
                duration_s: 0.001,
                force_n: V2::new(blow_n, 0.0),
                ..Disturbance::default()
            }];
            let policy = controller(PolicyKind::Supervisor, &scene, 0).unwrap();
            let (_, trace) = ran(&scene, policy, Keep::Trace);
            let modes = trace.rows.iter().filter_map(TraceRow::supervisor_mode);
            let modes: Vec<Mode> = modes.collect();
            let engaged = modes.iter().filter(|m| **m != Mode::Levitated).count();
            // At 20 kHz.
            let what = format!("{}, seed {seed}: engaged for {engaged} ticks", plant.name);
            assert!((1..600).contains(&engaged), "{what}");
            assert_eq!(modes.last(), Some(&Mode::Levitated), "{what}");
        }
    }
}
