//! Ball bearings by their data, their drag and their heat, and amplifiers of second order.

use super::{ONE_PLANE, as_machine, machine, planes};
use crate::refusals::{all, parsed};
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::contact::ball_bearing::BallBearing;
use plant_model::params::ContactLaw;
use system_tests::ran::{Folder, edited, has, list, number};

const STIFFNESS: &str = "stiffness_n_m = 1e8\nrestitution = 0.6\n";
const BALLS: &str = "restitution = 0.6\nrestitution_speed_m_s = 0.1\nballs = { count = 14, diameter_m = 7.144e-3, contact_angle_deg = 15.0 }\n";

fn with(contact: &str) -> String {
    edited(ONE_PLANE, &[(STIFFNESS, contact)])
}

fn law(text: &str) -> (f64, f64) {
    match machine(text).machine.planes[0].contact.law {
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
    for (after, key, refused) in [
        ("lag_s = 1.6e-4", "lag_damping_ratio = 0.7", "run.method"),
        (
            "drag_n_m_s = 1e-5",
            "load_drag_m = 1e-5",
            "race.load_drag_m",
        ),
        ("[retainer]", "heat = { capacity_j_k = 90.0 }", ""),
    ] {
        for text in [ONE_PLANE, &as_machine()] {
            let text = edited(text, &[(after, &format!("{after}\n{key}"))]);
            machine(&text);
            let series = edited(&text, &[("[run]", "[run]\nmethod = \"series\"")]);
            match refused {
                "" => _ = machine(&series),
                refused => has(&parsed(&series, &[]), &[refused]),
            }
        }
    }
}

/// At ζ far above 1 an amplifier of second order is one of first order with 2ζτ.
#[test]
fn an_overdamped_amplifier_is_one_of_first_order() {
    let ideal = [("noise_rms_m = 1e-6\n", ""), ("quantum_m = 1e-7\n", "")];
    let quiet = edited(&as_machine(), &ideal);
    let slow = ("lag_s = 1.6e-4", "lag_s = 4e-6\nlag_damping_ratio = 20.0");
    let ends = |text: &str, method: &str| {
        let (figures, trace) = planes(&machine(text), PolicyKind::Levitation).remove(0);
        assert_eq!(figures.method, method);
        let row = trace.rows.iter().rev().find(|row| row.plant.t_s < 0.019);
        row.unwrap().plant.position_m
    };
    let first = ends(&quiet, "series");
    let second = ends(&edited(&quiet, &[slow]), "collocation");
    let off = (first - second).norm() / 2e-4;
    assert!(off < 1e-4, "{off:e}");
}

/// What the table and the JSON say of bearings with heat.
#[test]
fn a_warm_bearing_is_told() {
    let line = "run @machines/coast_down_on_ball_bearings --out out --json --no-trace";
    let json = Folder::fresh().ran(line).json();
    let planes = list(&json["policies"]["passive"]["planes"]);
    assert_eq!(planes.len(), 2);
    for plane in planes {
        let of = |key: &str| number(&plane["bearing"][key]);
        let (heat_j, rise_k) = (of("heat_j"), of("temperature_rise_k"));
        assert!(heat_j > 1.0);
        // 90 J/K, and next to nothing has leaked.
        assert!((rise_k * 90.0 / heat_j - 1.0).abs() < 0.01, "{rise_k}");
        let said = 2e-4 + 2e-7 * rise_k;
        assert!((of("clearance_m") / said - 1.0).abs() < 1e-9);
    }
    assert_eq!(json["policies"]["passive"].get("bearing"), None);
}
