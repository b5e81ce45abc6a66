//! How hard the rotor of the paper's onset rig may hit the wall under each policy.

use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::outcome::Outcome;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use plant_model::params::SpinParams;
use system_tests::{golden, scene};

/// The impact scene with the spin held, as a rig on its motor.
fn rig() -> Scene {
    let mut scene = scene("impact_at_40_hz");
    scene.machine.spin = SpinParams::Held;
    scene
}

/// Highest radial speed below the first that ends in whirl, upwards in 4 % steps.
fn highest_speed_m_s(scene: &Scene, policy: PolicyKind) -> f64 {
    let mut scene = scene.clone();
    let (mut speed, mut last) = (0.005, 0.0);
    while speed < 2.0 {
        scene.start.centre_velocity_m_s = V2::new(speed, 0.0);
        let (verdict, _) = run(&scene, policy, Keep::Verdict, &mut |_| {}).unwrap();
        if verdict.outcome == Outcome::Whirl {
            return last;
        }
        last = speed;
        speed *= 1.04;
    }
    panic!("no whirl below 2 m/s");
}

/// Requirement: SR-24
#[test]
fn policies_rank_as_promised() {
    let rig = rig();
    let natural = rig.plant(0).natural_frequency_rad_s().unwrap();
    assert!((rig.planes[0].whirl_speed_m_s / (3.0 * natural * 2e-4) - 1.0).abs() < 1e-3);
    let of = |policy| highest_speed_m_s(&rig, policy);
    let passive = of(PolicyKind::Passive);
    let radial = of(PolicyKind::Radial);
    let levitation = of(PolicyKind::Levitation);
    let supervisor = of(PolicyKind::Supervisor);

    let mut grid = Vec::new();
    for k_p in ["3e5", "1e6", "3e6", "1e7"] {
        for k_d in ["1000", "3000", "7000", "15000", "30000"] {
            let mut tuned = rig.clone();
            tuned.planes[0].levitation = Some(LevitationParams {
                proportional_n_m: k_p.parse().unwrap(),
                integral_n_m_s: 0.0,
                derivative_n_s_m: k_d.parse().unwrap(),
                derivative_filter_s: 0.0,
            });
            let speed = highest_speed_m_s(&tuned, PolicyKind::Levitation);
            grid.push((format!("pd_{k_p}_{k_d}"), speed));
        }
    }
    let best = grid.iter().map(|(_, s)| *s).fold(0.0, f64::max);
    let mut measured = vec![
        ("passive_m_s", passive),
        ("radial_m_s", radial),
        ("levitation_m_s", levitation),
        ("best_levitation_m_s", best),
        ("supervisor_m_s", supervisor),
        ("supervisor_over_passive", supervisor / passive),
        ("supervisor_over_best_levitation", supervisor / best),
    ];
    measured.extend(grid.iter().map(|(name, s)| (name.as_str(), *s)));
    golden::compare("recoverable_impact", &measured).unwrap_or_else(|e| panic!("{e}"));
    assert!(radial < passive && passive < levitation && levitation < supervisor);
}
