//! Set-downs: the levitation controller's reference goes elsewhere, announced or not.

use crate::instruments_and_events::{free_rotor, last, ridden};
use firmware_bench::device::levitation::SetDown;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::Spec;
use plant_model::V2;
use system_tests::scene_path;
use toml::{Table, Value};

fn set_down(start_s: f64, to_m: V2) -> SetDown {
    SetDown {
        start_s,
        duration_s: 0.05,
        to_m,
        announced: start_s < 0.1,
    }
}

/// The rotor follows the reference; a second one goes on from where the first ended, and says itself whether it is announced.
#[test]
fn the_rotor_follows_its_reference() {
    let mut scene = free_rotor();
    let away_m = V2::new(0.0, -1e-4);
    scene.planes[0].set_downs = vec![set_down(0.02, away_m), set_down(0.2, V2::zeros())];
    for (until_s, expected_m) in [(0.02, V2::zeros()), (0.15, away_m), (0.35, V2::zeros())] {
        scene.duration_s = until_s;
        let end_m = last(&ridden(&scene, PolicyKind::Levitation).1)
            .plant
            .position_m;
        let off_m = (end_m - expected_m).norm();
        assert!(off_m < 2e-6, "{until_s}: {end_m}");
    }
    assert!((scene.planes[0].reference_m(0.045) - 0.5 * away_m).norm() < 1e-12);
    let announced = [0.0, 0.02, 0.19, 0.3].map(|t_s| scene.planes[0].set_down_announced(t_s));
    assert_eq!(announced, [false, true, true, false]);
}

/// In clearances in a file; without a levitation controller of gains there is nothing to move.
#[test]
fn a_file_says_it_in_clearances() {
    let mut spec = Spec::load(&scene_path("overload_then_release")).unwrap();
    let table: Table = "start_s = 0.1\nduration_s = 0.05\nto = [0.0, -1.2]"
        .parse()
        .unwrap();
    let tables = Value::Array(vec![Value::Table(table)]);
    spec.set("set_down", tables.clone()).unwrap();
    spec.set("start.levitated_before", true).unwrap();
    let scene = spec.resolve().unwrap();
    assert!(scene.levitated_before && !scene.planes[0].set_downs[0].announced);
    assert!((scene.planes[0].set_downs[0].to_m.y + 2.4e-4).abs() < 1e-12);
    // Nobody levitates the rotor of this file.
    let mut without = Spec::load(&scene_path("benchmark_b1")).unwrap();
    without.set("set_down", tables).unwrap();
    let error = without.resolve().unwrap_err().to_string();
    assert!(error.contains("[levitation]"), "{error}");
}
