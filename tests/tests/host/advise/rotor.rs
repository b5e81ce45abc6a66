//! Advice for a supervisor of both planes: nutation, and bending modes under its force.

use super::advise;
use firmware_bench::advise::{Advice, RotorAdvice};
use firmware_bench::scene::Scene;
use supervisor::Config;
use system_tests::ran::{edited, has, lacks, list, number, scene_text};
use system_tests::scene;

/// Of a plant of the catalogue, with the displacement at both magnets times a factor.
fn of(plant: &str, at_magnets: f64) -> RotorAdvice {
    let mut scene = scene(&format!("rotors/{plant}"));
    let magnets: Vec<f64> = scene.machine.magnets.iter().map(|m| m.position_m).collect();
    if let plant_model::machine::params::Rotor::Modal { bending, .. } = &mut scene.machine.rotor {
        for (z, displacement) in bending.iter_mut().flat_map(|mode| &mut mode.shape) {
            if magnets.iter().any(|magnet| (magnet - *z).abs() < 1e-6) {
                *displacement *= at_magnets;
            }
        }
    }
    RotorAdvice::new(&scene, &configs(&scene)).unwrap()
}

#[test]
fn nutation_is_the_inertias_share_of_the_spin() {
    let advice = of("p6", 1.0);
    assert!((advice.nutation_hz / (1.3 * 300.0) - 1.0).abs() < 1e-6);
    // One and a half samples at 20 kHz, and the lag.
    let late_s = 1.5 / 20e3 + 8e-5;
    let turn = std::f64::consts::TAU * advice.nutation_hz * late_s;
    assert!((advice.nutation_turn_rad / turn - 1.0).abs() < 1e-6);
    let spin_hz = advice.spin_of_most_turn_hz.unwrap();
    assert!((spin_hz / 300.0 * turn / 1.25 - 1.0).abs() < 1e-6);
    assert!(advice.modes.is_empty());
}

/// A node between sensor and magnet turns what damps into what drives, as strongly; a mode that moves the magnet twice as
/// much is damped twice as much.
#[test]
fn a_node_between_sensor_and_magnet_turns_the_sign() {
    let (same, opposite, twice) = (of("p7", 1.0), of("p7", -1.0), of("p7", 2.0));
    assert_eq!(same.modes.len(), 2);
    for ((a, b), c) in same.modes.iter().zip(&opposite.modes).zip(&twice.modes) {
        assert!(a.added_damping_ratio > 0.0 && !a.grows());
        assert!((b.added_damping_ratio / a.added_damping_ratio + 1.0).abs() < 1e-6);
        assert!((c.added_damping_ratio / a.added_damping_ratio - 2.0).abs() < 1e-6);
    }
    assert!(opposite.modes[0].grows() && opposite.text().contains("it would grow"));
}

/// A rotor of the catalogue that bends so, and what its `[supervisor]` sets.
fn bends(displacements: [f64; 7], hz: f64, set: &str) -> Scene {
    let mode = format!(
        "[[rotor.bending]]\nfrequency_hz = {hz}\ndamping_ratio = 0.003\npositions_m = [-0.25, -0.23, -0.2, 0.0, 0.2, 0.23, 0.25]\ndisplacements = {displacements:?}\n\n[spin]"
    );
    let at = |z: &str| format!("position_m = {z}\nsensor = {{ position_m = {z}3 }}\n");
    let edits = [
        ("[spin]", &mode[..]),
        ("position_m = -0.2\n", &at("-0.2")),
        ("position_m = 0.2\n", &at("0.2")),
    ];
    let text = edited(&scene_text("rotors/p5"), &edits);
    Scene::parse("bends", &format!("{text}\n[supervisor]\n{set}")).unwrap()
}

fn configs(scene: &Scene) -> [Config; 2] {
    [0, 1].map(|plane| scene.planes[plane].supervisor.unwrap())
}

/// Sensors and magnets on the same side of every node, and with a node between them.
const ALIKE: [f64; 7] = [0.6, 0.6, 0.5, -0.4, 0.5, 0.6, 0.6];
const NODE_BETWEEN: [f64; 7] = [-0.9, -0.9, 0.9, 0.2, 0.9, -0.9, -0.9];

/// A mode that the force damps leaves the configuration as it is.
#[test]
fn a_damped_mode_changes_nothing() {
    let scene = bends(ALIKE, 250.0, "");
    let [config, _] = configs(&scene);
    assert_eq!((config.bending_first_hz, config.acts_in_flight), (0.0, 1.0));
    assert!(scene.planes.iter().all(|plane| plane.decided.is_empty()));
    assert_eq!(scene.role(&configs(&scene)).name, "full");
    lacks(&scene.warnings.join("\n"), &["flight"]);
}

/// A mode that the force would drive is configured where that suffices, unless the scene says otherwise.
#[test]
fn a_mode_is_configured_where_that_suffices() {
    for (set, told_hz) in [
        ("", 1500.0),
        ("bending_first_hz = 0\nacts_in_flight = 1\n", 0.0),
    ] {
        let scene = bends(ALIKE, 1500.0, set);
        let both = configs(&scene);
        assert_eq!(both.map(|c| c.bending_first_hz), [told_hz; 2]);
        assert_eq!(both.map(|c| c.acts_in_flight), [1.0; 2]);
        let role = scene.role(&both);
        match told_hz > 0.0 {
            true => assert_eq!(role.name, "full", "{role:?}"),
            false => has(&scene.warnings.join("\n"), &["1500.0 Hz", "%"]),
        }
        assert!(told_hz == 0.0 || role.reason.contains("1500.0 Hz configured"));
    }
}

/// Where it does not, levitation keeps the rotor in the air; whoever sets it overrules that.
#[test]
fn a_mode_that_is_driven_all_the_same_leaves_flight_to_levitation() {
    let scene = bends(NODE_BETWEEN, 200.0, "");
    let both = configs(&scene);
    let role = scene.role(&both);
    assert_eq!(role.name, "whirl only", "{role:?}");
    assert_eq!(both.map(|c| c.acts_in_flight), [0.0; 2]);
    let by_hand = configs(&bends(NODE_BETWEEN, 200.0, "acts_in_flight = 1\n"));
    assert_eq!(by_hand.map(|c| c.acts_in_flight), [1.0; 2]);
    has(&scene.warnings.join("\n"), &["backward whirl only"]);
    has(&role.reason, &["200.0 Hz"]);
    let advice = RotorAdvice::new(&scene, &both).unwrap();
    has(&advice.text(), &["whirl only"]);
    assert!(advice.bending_over_clearance.unwrap() > 0.0);
    let plane = &scene.planes[0];
    let of_plane = Advice::of_plane("end", &plane.nominal, &plane.decided, &plane.overrides);
    has(
        &of_plane.unwrap().supervisor_table,
        &["acts_in_flight = 0 "],
    );
}

/// Of a mode that the force would drive it is advised to tell it where that helps; told, it is not driven any more.
#[test]
fn a_mode_is_told_where_that_helps() {
    let bends = "[[rotor.bending]]\nfrequency_hz = 1200.0\ndamping_ratio = 0.003\npositions_m = [-0.25, 0.0, 0.25]\ndisplacements = [0.6, -0.4, 0.6]\n\n[spin]";
    let text = edited(&scene_text("rotors/p5"), &[("[spin]", bends)]);
    let advised = |set: &str| {
        let scene = Scene::parse("bends", &format!("{text}\n[supervisor]\n{set}")).unwrap();
        RotorAdvice::new(&scene, &configs(&scene)).unwrap()
    };
    let before = advised("bending_first_hz = 0\nacts_in_flight = 1\n");
    let promised = before.modes[0].told_damping_ratio.unwrap();
    assert!(before.modes[0].grows() && promised > before.modes[0].added_damping_ratio);
    has(&before.text(), &["bending_first_hz = 1200"]);
    let after = advised("bending_first_hz = 1200\n");
    assert!((after.modes[0].added_damping_ratio / promised - 1.0).abs() < 1e-6);
    assert!(!after.modes[0].grows());
    lacks(&after.text(), &["do:"]);
}

#[test]
fn it_is_printed_and_has_keys() {
    let text = advise("@rotors/p7").good();
    has(&text, &["Nutation", "Bending modes"]);
    let json = advise("@rotors/p7 --json").json();
    let rotor = &json["rotor"];
    assert!((number(&rotor["nutation_hz"]) - 10.0).abs() < 0.01);
    assert!(number(&rotor["modes"][0]["added_damping_ratio"]) > 0.0);
    assert!(number(&rotor["modes"][0]["damping_by_force_percent"]) > 0.0);
    assert!(number(&rotor["bending_over_clearance"]) > 0.0);
    assert_eq!(rotor["role"]["name"], "full");
    assert_ne!(rotor["role"]["reason"].as_str().unwrap(), "");
    assert_eq!(list(&rotor["modes"][1]["at_sensors"]).len(), 2);
}
