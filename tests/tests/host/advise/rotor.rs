//! Advice for a supervisor of both planes: nutation, and bending modes under its force.

use firmware_bench::advise::{Advice, RotorAdvice};
use firmware_bench::scene::Scene;
use serde_json::Value;
use supervisor::Config;
use system_tests::{host, root};

/// Of a plant of the catalogue, with the displacement at both magnets times a factor.
fn of(plant: &str, at_magnets: f64) -> RotorAdvice {
    let path = root().join(format!("firmware-host/scenes/rotors/{plant}.toml"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut scene = Scene::parse(plant, &text).unwrap();
    let magnets: Vec<f64> = scene.machine.magnets.iter().map(|m| m.position_m).collect();
    if let plant_model::machine::params::Rotor::Modal { bending, .. } = &mut scene.machine.rotor {
        for (z, displacement) in bending.iter_mut().flat_map(|mode| &mut mode.shape) {
            if magnets.iter().any(|magnet| (magnet - *z).abs() < 1e-6) {
                *displacement *= at_magnets;
            }
        }
    }
    let configs: Vec<_> = scene.planes.iter().map(|p| p.supervisor.unwrap()).collect();
    RotorAdvice::new(&scene, &configs).unwrap()
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
    let text = std::fs::read_to_string(root().join("firmware-host/scenes/rotors/p5.toml")).unwrap();
    let text = (text.replacen("[spin]", &mode, 1))
        .replacen(
            "position_m = -0.2\n",
            "position_m = -0.2\nsensor = { position_m = -0.23 }\n",
            1,
        )
        .replacen(
            "position_m = 0.2\n",
            "position_m = 0.2\nsensor = { position_m = 0.23 }\n",
            1,
        );
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
    assert!(
        !scene.warnings.iter().any(|w| w.contains("flight")),
        "{:?}",
        scene.warnings
    );
}

/// A mode that the force would drive is configured where that suffices, unless the scene says otherwise.
#[test]
fn a_mode_is_configured_where_that_suffices() {
    let scene = bends(ALIKE, 1500.0, "");
    let both = configs(&scene);
    assert_eq!(both.map(|c| c.bending_first_hz), [1500.0; 2]);
    assert_eq!(both.map(|c| c.acts_in_flight), [1.0; 2]);
    let role = scene.role(&both);
    assert!(
        role.name == "full" && role.reason.contains("1500.0 Hz configured"),
        "{role:?}"
    );

    let by_hand = bends(ALIKE, 1500.0, "bending_first_hz = 0\nacts_in_flight = 1\n");
    let both = configs(&by_hand);
    assert_eq!(both.map(|c| c.bending_first_hz), [0.0; 2]);
    assert_eq!(both.map(|c| c.acts_in_flight), [1.0; 2]);
    let warned = |w: &String| w.contains("1500.0 Hz") && w.contains('%');
    assert!(
        by_hand.warnings.iter().any(warned),
        "{:?}",
        by_hand.warnings
    );
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
    assert!(
        scene
            .warnings
            .iter()
            .any(|w| w.contains("backward whirl only"))
    );
    assert!(role.reason.contains("200.0 Hz"), "{role:?}");
    let advice = RotorAdvice::new(&scene, &both).unwrap();
    assert!(advice.text().contains("whirl only"), "{}", advice.text());
    assert!(advice.bending_over_clearance.unwrap() > 0.0);
    let plane = &scene.planes[0];
    let of_plane = Advice::of_plane("end", &plane.nominal, &plane.decided, &plane.overrides);
    let table = of_plane.unwrap().supervisor_table;
    assert!(table.contains("acts_in_flight = 0 "), "{table}");
}

/// Of a mode that the force would drive it is advised to tell it where that helps; told, it is not driven any more.
#[test]
fn a_mode_is_told_where_that_helps() {
    let bends = "[[rotor.bending]]\nfrequency_hz = 1200.0\ndamping_ratio = 0.003\npositions_m = [-0.25, 0.0, 0.25]\ndisplacements = [0.6, -0.4, 0.6]\n\n[spin]";
    let path = root().join("firmware-host/scenes/rotors/p5.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replacen("[spin]", bends, 1);
    let advised = |text: &str| {
        let scene = Scene::parse("bends", text).unwrap();
        let configs: Vec<_> = (scene.planes.iter())
            .map(|p| p.supervisor.unwrap())
            .collect();
        RotorAdvice::new(&scene, &configs).unwrap()
    };
    let before = advised(&format!(
        "{text}\n[supervisor]\nbending_first_hz = 0\nacts_in_flight = 1\n"
    ));
    let promised = before.modes[0].told_damping_ratio.unwrap();
    assert!(before.modes[0].grows() && promised > before.modes[0].added_damping_ratio);
    assert!(
        before.text().contains("bending_first_hz = 1200"),
        "{}",
        before.text()
    );
    let after = advised(&format!("{text}\n[supervisor]\nbending_first_hz = 1200\n"));
    assert!((after.modes[0].added_damping_ratio / promised - 1.0).abs() < 1e-6);
    assert!(
        !after.modes[0].grows() && !after.text().contains("do:"),
        "{}",
        after.text()
    );
}

#[test]
fn it_is_printed_and_has_keys() {
    let scene = "firmware-host/scenes/rotors/p7.toml";
    let run = |more: &[&str]| {
        let output = host()
            .args(["advise", scene])
            .args(more)
            .current_dir(root())
            .output()
            .unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    let text = run(&[]);
    assert!(
        text.contains("Nutation") && text.contains("Bending modes"),
        "{text}"
    );
    let json: Value = serde_json::from_str(&run(&["--json"])).unwrap();
    let rotor = &json["rotor"];
    assert!((rotor["nutation_hz"].as_f64().unwrap() - 10.0).abs() < 0.01);
    assert!(rotor["modes"][0]["added_damping_ratio"].as_f64().unwrap() > 0.0);
    assert!(
        rotor["modes"][0]["damping_by_force_percent"]
            .as_f64()
            .unwrap()
            > 0.0
    );
    assert!(rotor["bending_over_clearance"].as_f64().unwrap() > 0.0);
    assert_eq!(rotor["role"]["name"], "full");
    assert!(!rotor["role"]["reason"].as_str().unwrap().is_empty());
    assert_eq!(rotor["modes"][1]["at_sensors"].as_array().unwrap().len(), 2);
}
