//! What a scene of a whole rotor is refused for, and what it says then.

use super::{TWO_PLANES, as_machine, machine};
use crate::refusals::{all, parsed};
use firmware_bench::scene::Scene;

#[test]
fn contradictions_are_refused_with_line_key_and_rule() {
    all("scenes/two_planes", 23, TWO_PLANES, parsed);
    // A bore out of round is taken, but not by series.
    let oval = TWO_PLANES.replace(
        "contact_radius_m = 0.03",
        "contact_radius_m = 0.03\nretainer = { ellipticity = 0.1 }",
    );
    machine(&oval);
    all("scenes/out_of_round", 1, &oval, parsed);
    all("scenes/middle_plane", 2, &as_machine(), parsed);
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
