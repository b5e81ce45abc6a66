//! Parameters of a whole rotor that change during a run.

use super::{apart, machine, planes};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use system_tests::ran::edited;

/// A rotor on springs that is braked, thrown against its bearings.
const BRAKED: &str = r#"
title = "Braked"
[run]
duration_s = 0.06
sample_rate_hz = 20000
policies = ["passive"]
[rotor]
mass_kg = 10.0
transverse_inertia_kg_m2 = 0.6
polar_inertia_kg_m2 = 0.03
ECCENTRIC
[spin]
frequency_hz = 100.0
inertia_kg_m2 = 0.03
DRIVE
[start]
velocity_m_s = [0.15, 0.0]
spin_phase_rad = 0.5
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.7
[friction]
coefficient = MU
[verdict]
whirl_speed_m_s = 5.0
[[support]]
position_m = 0.0
stiffness_n_m = 4e5
damping_n_s_m = 50.0
[[plane]]
name = "a"
position_m = -0.2
contact_radius_m = 0.05
[[plane]]
name = "b"
position_m = 0.3
contact_radius_m = 0.03
"#;

fn braked(eccentric: &str, drive: &str, mu: &str, more: &str) -> Scene {
    let text = BRAKED
        .replace("ECCENTRIC", eccentric)
        .replace("DRIVE", drive);
    machine(&(text.replace("MU", mu) + more))
}

/// What changes at the first instant is as if it had been written so, to the last bit.
#[test]
fn a_change_at_the_start_is_what_the_scene_could_have_said() {
    let unbalance = "position_m = 0.1\nmoment_kg_m = 2e-4\nangle_rad = 1.5\n";
    let (eccentric, brake) = ("eccentricity_m = 1e-5", "drive_torque_n_m = -4.0");
    let so = braked(
        eccentric,
        brake,
        "0.1",
        &format!("[[unbalance]]\n{unbalance}"),
    );
    let change = format!(
        "[[change]]\nat_s = 0.0\nfriction_coefficient = 0.1\n{brake}\n[change.unbalance]\n{unbalance}"
    );
    let becomes = braked(eccentric, "", "0.2", &change);
    let ended = [so, becomes].map(|scene| planes(&scene, PolicyKind::Passive));
    for (a, b) in ended[0].iter().zip(&ended[1]) {
        assert!(a.0.impacts > 0);
        assert!(a.0.spin_lost_hz > 0.0);
        // The sum of unbalances is another in its last place.
        assert!(apart(&a.1, &b.1) < 1e-9);
        assert!((a.0.spin_lost_hz / b.0.spin_lost_hz - 1.0).abs() < 1e-9);
    }
}

/// A new eccentricity replaces the old one, more or less, at the centre of mass.
#[test]
fn an_eccentricity_is_replaced() {
    let change = |e: &str| format!("[[change]]\nat_s = 0.0\neccentricity_m = {e}\n");
    for (from, to) in [("1e-5", "4e-5"), ("4e-5", "1e-5"), ("4e-5", "0.0")] {
        let of = |e: &str, more: &str| {
            let scene = braked(&format!("eccentricity_m = {e}"), "", "0.1", more);
            planes(&scene, PolicyKind::Passive).remove(0).1
        };
        let off = apart(&of(to, ""), &of(from, &change(to)));
        assert!(off < 1e-9, "{from} to {to}: {off:e}");
        assert!(apart(&of(to, ""), &of(from, "")) > 1e-3);
    }
}

/// In the middle of a run, while the spin falls: rotor and blade together have the momentum that the spring gives them.
#[test]
fn a_blade_is_lost_at_its_time_and_place() {
    let (lost_s, moment) = (0.020_003, 3e-4);
    let change = format!(
        "[[change]]\nat_s = {lost_s}\n[change.unbalance]\nposition_m = 0.1\nmoment_kg_m = {moment:e}\n"
    );
    // Wide enough not to be touched, and no spring.
    let text = |change: &str| {
        let text = BRAKED
            .replace("ECCENTRIC", "")
            .replace("DRIVE", "drive_torque_n_m = -4.0")
            .replace("MU", "0.1")
            .replace("clearance_m = 2e-4", "clearance_m = 2e-2")
            .replace("stiffness_n_m = 4e5\ndamping_n_s_m = 50.0", "");
        machine(&(text + change))
    };
    let end = |scene: &Scene| {
        let ended = planes(scene, PolicyKind::Passive);
        let last = |plane: usize| *ended[plane].1.rows.last().unwrap();
        let [a, b] = [last(0).plant.position_m, last(1).plant.position_m];
        (0.6 * a + 0.4 * b, last(0).plant.t_s)
    };
    let scene = text(&change);
    let (with, end_s) = end(&scene);
    let (without, _) = end(&text(""));
    let rate = |t: f64| 200.0 * std::f64::consts::PI - 4.0 / 0.03 * t;
    let angle = |t: f64| 0.5 + 200.0 * std::f64::consts::PI * t - 0.5 * 4.0 / 0.03 * t * t;
    let arm = |t: f64| moment / 10.0 * V2::new(angle(t).cos(), angle(t).sin());
    let at = arm(lost_s);
    let across = V2::new(-at.y, at.x);
    let moved = at + rate(lost_s) * (end_s - lost_s) * across - arm(end_s);
    let off = (with - without - moved).norm() / moved.norm();
    assert!(off < 1e-9, "{off:e}");
    // The clock of the verdict starts there.
    assert_eq!(scene.edges(), [lost_s]);
    assert_eq!(scene.clock_starts_s(0), lost_s);
}

/// Places of a rotor by its shaft count from its left end, those of changes as well.
#[test]
fn places_count_as_the_scene_has_them() {
    let body =
        "mass_kg = 10.0\ntransverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.03\nECCENTRIC";
    let edits = [
        (body, ""),
        ("DRIVE", ""),
        ("MU", "0.1"),
        ("position_m = -0.2", "position_m = 0.1"),
        ("position_m = 0.0", "position_m = 0.4"),
    ];
    let shaft = "[[shaft]]\nlength_m = 0.8\nouter_diameter_m = 0.05\n";
    let change = "[[change]]\nat_s = 0.01\nunbalance = { position_m = 0.6, moment_kg_m = 1e-5 }\n";
    let scene = machine(&(edited(BRAKED, &edits) + shaft + change));
    let changed = scene.changes[0].change.unbalance.unwrap();
    assert!((changed.position_m - 0.2).abs() < 1e-12, "{changed:?}");
    planes(&scene, PolicyKind::Passive);
}
