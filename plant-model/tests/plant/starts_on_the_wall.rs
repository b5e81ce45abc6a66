//! Starts that are meant to be on the wall: what sine, cosine and a product leave of that decides nothing.

use crate::support::plants::onset_rig;
use plant_model::params::*;
use plant_model::{Inputs, Method, Options, Plant, V2, build};

const CLEARANCE_M: f64 = 2e-4;

/// Distance from the middle, speed outwards and along the wall, and load outwards, at an angle.
fn started(
    params: &PlantParams,
    angle: f64,
    distance_m: f64,
    [outwards, along]: [f64; 2],
    load_n: f64,
) -> Plant {
    let n = V2::new(angle.cos(), angle.sin());
    let from = Start {
        position_m: distance_m * n,
        velocity_m_s: outwards * n + along * V2::new(-n.y, n.x),
        spin_rad_s: 200.0,
        spin_phase_rad: 0.0,
    };
    let mut plant = build(params, &from, Options::default()).unwrap();
    let inputs = Inputs {
        external_n: load_n * n,
        ..Inputs::default()
    };
    plant.advance(1e-5, &inputs, &mut |_| {}).unwrap();
    plant
}

fn laws() -> [PlantParams; 2] {
    let hertz = HuntCrossley {
        stiffness_n_mn: 1e10,
        exponent: 1.5,
        damping_s_m: 1.0,
    };
    let mut hardening = onset_rig();
    hardening.contact.law = hertz.into();
    [onset_rig(), hardening]
}

/// Against the wall is an impact at its speed, at any angle.
#[test]
fn a_start_into_the_wall_is_an_impact() {
    for params in laws() {
        for i in 0..2000 {
            let angle = 0.013 * f64::from(i);
            for along in [0.0, 0.3] {
                let meters = started(&params, angle, CLEARANCE_M, [0.1, along], 0.0).meters();
                assert_eq!((meters.impacts, meters.hard_impacts), (1, 1), "{angle}");
                let speed = meters.peak_impact_speed_m_s;
                assert!((speed / 0.1 - 1.0).abs() < 1e-12, "{angle}: {speed}");
                assert!((meters.contact_time_s / 1e-5 - 1.0).abs() < 1e-9);
            }
        }
    }
}

/// Pressed on it by a load, or along it by the curve, is a contact and no impact, with one method at any angle.
#[test]
fn a_start_that_rests_on_the_wall_is_a_contact_and_no_impact() {
    for params in laws() {
        let method = match params.contact.law {
            ContactLaw::Linear(_) => Method::Series,
            ContactLaw::HuntCrossley(_) => Method::Collocation,
        };
        for i in 0..2000 {
            let angle = 0.013 * f64::from(i);
            for (along, load_n) in [(0.0, 500.0), (0.0, 200.0), (0.3, 0.0), (-0.3, 500.0)] {
                let plant = started(&params, angle, CLEARANCE_M, [0.0, along], load_n);
                let meters = plant.meters();
                assert_eq!(plant.method(), method, "{angle}");
                assert_eq!(meters.impacts, 0, "{angle}, {along} m/s, {load_n} N");
                assert!((meters.contact_time_s / 1e-5 - 1.0).abs() < 1e-3, "{angle}");
            }
        }
    }
}

/// The rule is for rounding only: a millionth of a millionth of the clearance off the wall is off it, and into it, in it.
#[test]
fn a_start_beside_the_wall_is_beside_it() {
    for params in laws() {
        for i in 0..200 {
            let angle = 0.13 * f64::from(i);
            let impacts = |off: f64, outwards: f64| {
                let distance_m = CLEARANCE_M * (1.0 + off);
                let plant = started(&params, angle, distance_m, [outwards, 0.0], 500.0);
                plant.meters().impacts
            };
            assert_eq!(impacts(-1e-12, 0.0), 1, "{angle}");
            assert_eq!(impacts(1e-12, 0.1), 0, "{angle}");
            // Away from it there is no contact at all, however the start is rounded.
            let plant = started(&params, angle, CLEARANCE_M, [-0.1, 0.0], 0.0);
            assert_eq!(
                (plant.meters().impacts, plant.meters().contact_time_s),
                (0, 0.0)
            );
        }
    }
}
