//! A whole rotor that is levitated: by mode, and by magnets with poles.

use super::{apart, machine, planes};
use crate::refusals::{all, parsed};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;

/// A gyroscopic rotor in two magnetic bearings.
pub(super) const LEVITATED: &str = r#"
title = "Levitated"
[run]
duration_s = 0.4
sample_rate_hz = 20000
policies = ["levitation"]
[rotor]
mass_kg = 20.0
transverse_inertia_kg_m2 = 0.4
polar_inertia_kg_m2 = 0.3
gravity_m_s2 = [0.0, -9.81]
[spin]
frequency_hz = 150.0
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.7
[friction]
coefficient = 0.15
[magnet]
force_max_n = 1000.0
lag_s = 1e-4
negative_stiffness_n_m = 2e5
[levitation]
proportional_n_m = 1.4e6
integral_n_m_s = 4e6
derivative_n_s_m = 3000.0
derivative_filter_s = 1e-4
feed_forward_weight = true
[levitation.tilt]
proportional_n_m_rad = 3e4
derivative_n_m_s_rad = 60.0
cross_feedback = CROSS
[[plane]]
name = "A"
position_m = -0.2
contact_radius_m = 0.03
start_position_m = [6e-5, 0.0]
[[plane]]
name = "B"
position_m = 0.25
contact_radius_m = 0.03
start_position_m = [-6e-5, 0.0]
"#;

/// A controller by mode holds the whole rotor, carries its weight by the lever rule, and its cross feedback calms the nutation
/// that the gains alone leave.
#[test]
fn levitation_by_mode_holds_translation_and_tilt() {
    let swing = |cross: &str| {
        let scene = machine(&LEVITATED.replace("CROSS", cross));
        let weights: Vec<f64> = (scene.planes.iter()).map(|p| p.weight_n.y).collect();
        assert!((weights.iter().sum::<f64>() + 20.0 * 9.81).abs() < 1e-9);
        let moment = weights[0] * -0.2 + weights[1] * 0.25;
        assert!(moment.abs() < 1e-9, "{weights:?}");
        let ended = planes(&scene, PolicyKind::Levitation);
        for (figures, _) in &ended {
            assert_eq!(figures.impacts, 0);
            assert!(figures.recovered, "cross {cross}: {:?}", figures.outcome);
        }
        let rows = ended.iter().flat_map(|(_, trace)| &trace.rows);
        let late = rows.filter(|row| row.plant.t_s > 0.03 && row.plant.t_s < 0.06);
        late.map(|row| row.plant.position_m.norm())
            .fold(0.0, f64::max)
    };
    let [without, with] = ["0.0", "0.8"].map(swing);
    assert!(
        with < 0.5 * without,
        "{with:e} m, and {without:e} m without cross feedback"
    );
}

/// Poles in the place of a force and its negative stiffness: near the middle the loop is the same, and beside it they pull harder.
#[test]
fn magnets_with_poles_levitate_as_their_linear_ones_near_the_middle() {
    let linear = LEVITATED
        .replace("CROSS", "0.5")
        .replace("duration_s = 0.4", "duration_s = 0.03");
    // 1000 N at 4 A of 4 A over 5 mm: the stiffness of 2e5 N/m.
    let poles = linear.replace(
        "negative_stiffness_n_m = 2e5",
        "poles = { bias_current_a = 4.0, air_gap_m = 5e-3 }",
    );
    let ended = [&linear, &poles].map(|text| planes(&machine(text), PolicyKind::Levitation));
    for (a, b) in ended[0].iter().zip(&ended[1]) {
        assert!(a.0.impacts == 0 && b.0.impacts == 0);
        let off = apart(&a.1, &b.1);
        // (x/s_0)² is 1.4e-4 at the start.
        assert!(off < 5e-3 && off > 1e-5, "{off:e} clearances");
    }
    let scene = machine(&poles);
    let design = |scene: &Scene| scene.plant(0).rotor;
    let (a, b) = (design(&scene), design(&machine(&linear)));
    assert!(
        (a.stiffness_n_m / b.stiffness_n_m - 1.0).abs() < 1e-12,
        "{a:?} {b:?}"
    );

    all("scenes/poles", 4, &poles, parsed);
}
