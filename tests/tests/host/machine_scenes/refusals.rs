//! What a scene of a whole rotor is refused for, and what it says then.

use super::{TWO_PLANES, as_machine, machine};
use firmware_bench::scene::Scene;

/// What is changed in a good scene, what the error must name, and what it must say.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        "transverse_inertia_kg_m2 = 0.6\n",
        "",
        "rotor.transverse_inertia_kg_m2: is missing",
        "missing",
    ),
    (
        "polar_inertia_kg_m2 = 0.0\n",
        "",
        "rotor.polar_inertia_kg_m2: is missing",
        "missing",
    ),
    (
        "polar_inertia_kg_m2 = 0.0",
        "polar_inertia_kg_m2 = 1.3",
        "rotor.polar_inertia_kg_m2",
        "a thin disc has just that",
    ),
    (
        "name = \"other end\"",
        "name = \"Struck_End\"",
        "plane[1].name",
        "that of plane[0]",
    ),
    (
        "name = \"other end\"",
        "name = \" \"",
        "plane[1].name",
        "a name in one line",
    ),
    (
        "name = \"other end\"\n",
        "",
        "plane[1].name: is missing",
        "missing",
    ),
    (
        "position_m = 0.3",
        "position_m = -0.2",
        "plane[0].start_velocity_m_s",
        "both planes stand at one place",
    ),
    (
        "[verdict]",
        "[start]\ntilt_rad = [1e-4, 0.0]\n[verdict]",
        "plane[0].start_velocity_m_s",
        "what [start] says as well",
    ),
    (
        "contact_radius_m = 0.03\n",
        "",
        "plane[1].contact_radius_m: is missing",
        "missing",
    ),
    (
        "contact_radius_m = 0.03",
        "contact_radius_m = -0.03",
        "plane[1].contact_radius_m",
        "greater than 0",
    ),
    (
        "contact_radius_m = 0.03",
        "contact_radius_m = 0.03\ncolour = 3",
        "colour",
        "unknown key",
    ),
    (
        "contact_radius_m = 0.03",
        "contact_radius_m = 0.03\nretainer = { centre_offset_m = [3e-4, 0.0] }",
        "plane[1].retainer.centre_offset_m",
        "below contact.clearance_m",
    ),
    (
        "policies = [\"passive\"]",
        "policies = [\"levitation\"]",
        "run.policies",
        "needs a magnet",
    ),
    (
        "[verdict]",
        "[[change]]\nat_s = 0.01\n[verdict]",
        "change[0]",
        "changes nothing",
    ),
    (
        "[verdict]",
        "[[change]]\nat_s = 0.01\nunbalance = { position_m = 0.1, moment_kg_m = -1e-5 }\n[verdict]",
        "change[0].unbalance.moment_kg_m",
        "0 or greater",
    ),
    (
        "[verdict]",
        "[[rotor.bending]]\nfrequency_hz = 300.0\npositions_m = [-0.3, 0.3]\ndisplacements = [1.0, 1.0]\n[[change]]\nat_s = 0.01\nunbalance = { position_m = 0.35, moment_kg_m = 1e-5 }\n[verdict]",
        "change[0].unbalance.position_m",
        "within the shape of every bending mode",
    ),
    (
        "[verdict]",
        "[[change]]\nat_s = 0.01\ndrive_torque_n_m = 1.0\n[verdict]",
        "change[0].drive_torque_n_m",
        "while the speed is held",
    ),
    (
        "contact_radius_m = 0.03",
        "contact_radius_m = 0.03\nseal = true",
        "plane[1].start_position_m",
        "this plane is a seal",
    ),
    (
        "contact_radius_m = 0.03",
        "contact_radius_m = 0.03\nseal = true\nsensor = { noise_rms_m = 1e-6 }",
        "plane[1].sensor",
        "this plane is a seal",
    ),
    (
        "[verdict]",
        "[[rotor.bending]]\nfrequency_hz = 300.0\npositions_m = [-0.3, 0.2]\ndisplacements = [1.0, 1.0]\n[verdict]",
        "plane[1].position_m",
        "within the shape of every bending mode",
    ),
    (
        "[verdict]",
        "[[rotor.bending]]\nfrequency_hz = 300.0\npositions_m = [-0.3, 0.4]\ndisplacements = [1.0]\n[verdict]",
        "rotor.bending[0].displacements",
        "for 2 places",
    ),
    (
        "[verdict]",
        "[[support]]\nposition_m = 0.0\ndamping_n_s_m = -1.0\n[verdict]",
        "support[0].damping_n_s_m",
        "0 or greater",
    ),
    (
        "frequency_hz = 100.0",
        "frequency_hz = 100.0\ninertia_kg_m2 = 0.01\n",
        "spin.inertia_kg_m2",
        "polar inertia",
    ),
];

#[test]
fn contradictions_are_refused_with_line_key_and_rule() {
    let refused = |text: &str| {
        let error = Scene::parse("scene.toml", text).expect_err(text);
        error.to_string()
    };
    for (from, to, key, says) in CASES {
        let mut text = TWO_PLANES.replacen(from, to, 1);
        if to.contains("0.01") && key.starts_with("spin") {
            text = text.replace("polar_inertia_kg_m2 = 0.0", "polar_inertia_kg_m2 = 0.05");
        }
        assert_ne!(text, TWO_PLANES, "{from}");
        let message = refused(&text);
        assert!(message.starts_with("scene.toml:"), "{message}");
        assert!(
            message.contains(key) && message.contains(says),
            "{key}, {says}: {message}"
        );
    }
    // A bore out of round is taken, but not by series.
    let oval = TWO_PLANES.replace(
        "contact_radius_m = 0.03",
        "contact_radius_m = 0.03\nretainer = { ellipticity = 0.1 }",
    );
    Scene::parse("scene.toml", &oval).unwrap();
    let series = oval.replace("[run]", "[run]\nmethod = \"series\"");
    let message = refused(&series);
    assert!(
        message.contains("run.method: series does not go with retainer.ellipticity"),
        "{message}"
    );
    let many: String = (0..4)
        .map(|i| format!("[[plane]]\nname = \"n{i}\"\nposition_m = 0.1\n"))
        .collect();
    let message = refused(&(as_machine() + &many));
    assert!(
        message.contains("plane: is 5") || message.contains("at most four"),
        "{message}"
    );
}

/// A scene without [[plane]] takes all that is of a rotor; off the centre of mass its inertias are asked for.
#[test]
fn a_scene_without_planes_takes_what_is_of_a_whole_rotor() {
    let tilting = TWO_PLANES.split("[[plane]]").next().unwrap();
    let tilting = tilting.replace("mass_kg = 10.0", "mass_kg = 10.0\ncontact_radius_m = 0.05");
    let inertias = "transverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.0\n";
    let point = tilting.replace(inertias, "");
    assert!(machine(&tilting).has_axis() && !machine(&point).has_axis());
    for more in [
        "[[support]]\nposition_m = 0.1\nstiffness_n_m = 1e5\n",
        "[[unbalance]]\nposition_m = 0.1\nmoment_kg_m = 1e-5\n",
        "[start]\ntilt_rad = [1e-4, 0.0]\n",
        "[sensor]\nposition_m = 0.1\n",
        "[[disturbance]]\nstart_s = 0.0\nduration_s = 0.01\nforce_n = [1.0, 0.0]\nposition_m = 0.1\n",
        "[[change]]\nat_s = 0.01\nunbalance = { position_m = 0.1, moment_kg_m = 1e-5 }\n",
    ] {
        assert_ne!(machine(&(tilting.clone() + more)), machine(&tilting));
        let error = Scene::parse("scene.toml", &(point.clone() + more)).unwrap_err();
        let message = error.to_string();
        let key = "rotor.transverse_inertia_kg_m2: is missing";
        assert!(message.contains(key), "{more}: {message}");
    }
}

/// A spring of the rotor is a support at its centre of mass.
#[test]
fn a_rotor_in_planes_takes_a_spring() {
    let by_rotor = TWO_PLANES.replace("mass_kg = 10.0", "mass_kg = 10.0\nstiffness_n_m = 1e6");
    let by_support = TWO_PLANES.to_owned() + "[[support]]\nposition_m = 0.0\nstiffness_n_m = 1e6\n";
    assert_eq!(machine(&by_rotor).machine, machine(&by_support).machine);
}
