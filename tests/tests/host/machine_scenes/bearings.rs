//! Ball bearings by their data, their drag and their heat, and amplifiers of second order.

use super::{ONE_PLANE, as_machine, machine, planes};
use crate::refusals::{all, parsed};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::contact::ball_bearing::BallBearing;
use plant_model::params::ContactLaw;
use serde_json::Value;
use system_tests::{machine_scene_path, run_scene};
use tempfile::TempDir;

const STIFFNESS: &str = "stiffness_n_m = 1e8\nrestitution = 0.6\n";
const BALLS: &str = "restitution = 0.6\nrestitution_speed_m_s = 0.1\nballs = { count = 14, diameter_m = 7.144e-3, contact_angle_deg = 15.0 }\n";

fn with(contact: &str) -> String {
    let text = ONE_PLANE.replace(STIFFNESS, contact);
    assert_ne!(text, ONE_PLANE);
    text
}

fn law(text: &str) -> (f64, f64) {
    let scene = Scene::parse("test", text).unwrap_or_else(|e| panic!("{e}"));
    match scene.machine.planes[0].contact.law {
        ContactLaw::HuntCrossley(law) => (law.stiffness_n_mn, law.exponent),
        ContactLaw::Linear(_) => panic!("linear"),
    }
}

#[test]
fn balls_and_a_curve_give_the_law_that_follows_from_them() {
    let bearing = BallBearing {
        balls: 14,
        ball_diameter_m: 7.144e-3,
        contact_angle_rad: 15.0_f64.to_radians(),
    };
    assert_eq!(law(&with(BALLS)), (bearing.stiffness_n_mn(), 1.5));
    let curve = "deflections_m = [1e-6, 1e-5, 4e-5]\nforces_n = [10.0, 316.3, 2529.0]\n";
    let (k, n) = law(&with(curve));
    assert!((n - 1.5).abs() < 1e-3, "{n}");
    assert!((k * 1e-5_f64.powf(n) / 316.3 - 1.0).abs() < 1e-3);
}

#[test]
fn contradictions_are_named() {
    all("scenes/one_plane", 9, ONE_PLANE, parsed);
    // With a plane and without, and not by series.
    for (from, to, key) in [
        (
            "lag_s = 1.6e-4",
            "lag_s = 1.6e-4\nlag_damping_ratio = 0.7",
            "magnet.lag_damping_ratio",
        ),
        (
            "drag_n_m_s = 1e-5",
            "drag_n_m_s = 1e-5\nload_drag_m = 1e-5",
            "race.load_drag_m",
        ),
        (
            "centre_offset_m = [2e-5, -1e-5]",
            "centre_offset_m = [2e-5, -1e-5]\nheat = { capacity_j_k = 90.0 }",
            "retainer.heat",
        ),
    ] {
        for text in [ONE_PLANE, &as_machine()] {
            let text = text.replace(from, to);
            machine(&text);
            let series = text.replace("[run]", "[run]\nmethod = \"series\"");
            let refused = Scene::parse("scene.toml", &series);
            match key {
                "retainer.heat" => assert!(refused.is_ok()),
                "magnet.lag_damping_ratio" => {
                    let message = refused.unwrap_err().to_string();
                    assert!(message.contains("run.method"), "{message}");
                }
                key => {
                    let message = refused.unwrap_err().to_string();
                    assert!(message.contains(key), "{message}");
                }
            }
        }
    }
}

/// At ζ far above 1 an amplifier of second order is one of first order with 2ζτ.
#[test]
fn an_overdamped_amplifier_is_one_of_first_order() {
    let quiet = as_machine()
        .replace("noise_rms_m = 1e-6\n", "")
        .replace("quantum_m = 1e-7\n", "");
    let slow = quiet.replace("lag_s = 1.6e-4", "lag_s = 4e-6\nlag_damping_ratio = 20.0");
    assert_ne!(slow, quiet);
    let of = |text: &str| {
        let (figures, trace) = planes(&machine(text), PolicyKind::Levitation).remove(0);
        (figures.method, trace)
    };
    let (first, second) = (of(&quiet), of(&slow));
    assert_eq!((first.0, second.0), ("series", "collocation"));
    let ends = |trace: &firmware_bench::run::trace::Trace| {
        let row = trace.rows.iter().rev().find(|row| row.plant.t_s < 0.019);
        row.map(|row| row.plant.position_m).unwrap()
    };
    let off = (ends(&first.1) - ends(&second.1)).norm() / 2e-4;
    assert!(off < 1e-4, "{off:e}");
}

/// What the table and the JSON say of bearings with heat.
#[test]
fn a_warm_bearing_is_told() {
    let folder = TempDir::new().unwrap();
    let path = machine_scene_path("coast_down_on_ball_bearings");
    let result = run_scene(&path, folder.path(), &["--json", "--no-trace"]);
    let json: Value = serde_json::from_slice(&result.stdout).unwrap();
    let planes = json["policies"]["passive"]["planes"].as_array().unwrap();
    assert_eq!(planes.len(), 2);
    for plane in planes {
        let bearing = &plane["bearing"];
        let number = |key: &str| bearing[key].as_f64().unwrap();
        let (heat_j, rise_k) = (number("heat_j"), number("temperature_rise_k"));
        assert!(heat_j > 1.0);
        // 90 J/K, and next to nothing has leaked.
        assert!((rise_k * 90.0 / heat_j - 1.0).abs() < 0.01, "{rise_k}");
        let want = 2e-4 + 2e-7 * rise_k;
        assert!((number("clearance_m") / want - 1.0).abs() < 1e-9);
    }
    assert_eq!(json["policies"]["passive"].get("bearing"), None);
}
