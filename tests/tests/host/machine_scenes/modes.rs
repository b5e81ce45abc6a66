//! Modes of scenes, and rotors that are described by their shaft.

use super::{TWO_PLANES, machine};
use crate::refusals::{all, parsed};
use serde_json::Value;
use std::f64::consts::TAU;
use system_tests::ran::{Folder, edited, has, list, number, ran};

/// What is said of a scene in JSON.
fn json(folder: &Folder, words: &str) -> Value {
    folder.ran(&format!("modes --json {words}")).json()
}

fn numbers(value: &Value) -> Vec<f64> {
    list(value).iter().map(number).collect()
}

/// A translation moves every place alike, a tilt as its distance; friction holds whirl from above the slowest backward mode.
#[test]
fn a_scene_has_shapes_and_whirl_that_friction_holds() {
    let folder = Folder::fresh();
    let spring = |z: f64| {
        format!("[[support]]\nposition_m = {z}\nstiffness_n_m = 1e6\ndamping_n_s_m = 10.0\n")
    };
    folder.put(
        "scene.toml",
        TWO_PLANES.to_owned() + &[-0.2, 0.2].map(spring).concat(),
    );
    let found = json(&folder, "scene.toml --points 2");
    let places = numbers(&found["shape_positions_m"]);
    assert_eq!(places, [-0.2, 0.2, 0.3]);
    let shapes = list(&found["mode_shapes"]);
    assert_eq!(shapes.len(), 4);
    for shape in shapes {
        let translates = number(&shape["frequency_hz"]) * TAU > 0.5 * 2e5_f64.sqrt() * 1.7;
        let (along, across) = (numbers(&shape["along"]), numbers(&shape["across"]));
        for (z, (a, b)) in places.iter().zip(along.iter().zip(&across)) {
            let expected = if translates { 1.0 } else { z / 0.3 };
            assert!((a - expected).abs() < 1e-6 && b.abs() < 1e-6, "{z} {a} {b}");
        }
    }
    let held = list(&found["held_whirl"]).iter();
    let of = |count: usize| {
        held.clone()
            .filter(move |r| list(&r["planes"]).len() == count)
    };
    let slowest = of(1).map(|r| numbers(&r["rates_rad_s"])[0]);
    let tilt = (2e6 * 0.04 / 0.6_f64).sqrt();
    assert!(slowest.clone().count() >= 2);
    assert!(slowest.fold(f64::INFINITY, f64::min) > tilt);
    assert!(of(2).count() > 0);
    // Walls that hold the rotor leave no clearance to whirl in.
    let walled = json(&folder, "scene.toml --points 2 --contact");
    assert!(walled["held_whirl"].is_null());
    let text = folder.ran("modes scene.toml").good();
    has(&text, &["backward whirl that friction can hold at 100 Hz"]);
}

/// Two springs under a rigid rotor: translation at √(2k/m) both ways, the tilt apart by the spin.
#[test]
fn a_scene_has_the_modes_of_its_rotor() {
    let folder = Folder::fresh();
    let spring = |z: f64| format!("[[support]]\nposition_m = {z}\nstiffness_n_m = 1e6\n");
    let polar = ("polar_inertia_kg_m2 = 0.0", "polar_inertia_kg_m2 = 0.5");
    let unbalance = "[[unbalance]]\nposition_m = 0.0\nmoment_kg_m = 1e-5\n";
    let springs = [-0.2, 0.2].map(spring).concat();
    folder.put(
        "scene.toml",
        edited(TWO_PLANES, &[polar]) + &springs + unbalance,
    );
    let found = json(&folder, "scene.toml --to-hz 100 --points 2");
    let at = |spin: f64, whirl: &str| {
        let modes = list(&found["modes"]).iter();
        let near = |m: &&Value| (number(&m["spin_rad_s"]) - spin).abs() < 1e-9;
        let mut rates: Vec<f64> = modes
            .filter(near)
            .filter(|m| m["whirl"] == whirl)
            .map(|m| TAU * number(&m["frequency_hz"]))
            .collect();
        rates.sort_by(f64::total_cmp);
        assert_eq!(rates.len(), 2, "{rates:?}");
        rates
    };
    let (spin, translation) = (100.0 * TAU, (2e6_f64 / 10.0).sqrt());
    let half = 0.5 * spin * 0.5 / 0.6;
    let root = (half * half + 2e6 * 0.04 / 0.6).sqrt();
    let alike = |a: &[f64], b: &[f64]| {
        let off = a.iter().zip(b).map(|(a, b)| (a / b - 1.0).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9, "{a:?}, {b:?}");
    };
    for (whirl, tilt) in [("forward", root + half), ("backward", root - half)] {
        let mut expected = [translation, tilt];
        expected.sort_by(f64::total_cmp);
        alike(&at(spin, whirl), &expected);
    }
    alike(&at(0.0, "forward"), &at(0.0, "backward"));
    // U·Ω²/|k − m·Ω²| in every plane: it does not tilt.
    let response = numbers(&found["unbalance_response"][1]["planes_m"]);
    let expected = 1e-5 * spin * spin / (2e6 - 10.0 * spin * spin).abs();
    alike(&response, &vec![expected; response.len()]);
    alike(&numbers(&found["effective_mass_kg"])[..1], &[6.0]);
}

#[test]
fn the_command_draws_its_page() {
    let folder = Folder::fresh();
    let line = "modes @machines/overload_of_a_flexible_rotor --levitated --html page.html";
    let table = folder.ran(line).good();
    has(
        &table,
        &["critical speed [Hz]", "forward", "coupling end struck"],
    );
    let page = folder.text("page.html");
    // Without unbalance there is no response to it.
    assert!(page.contains("Campbell diagram") && page.matches("<svg").count() == 3);
}

/// A rotor that the gains hold and one that lags too far behind: said by the command, in numbers and on its own.
#[test]
fn a_loop_is_judged() {
    let folder = Folder::fresh();
    let found = json(&folder, "@one_machine/rigid --levitated --points 2");
    assert_eq!(found["stable"], true);
    assert_eq!(found["range"]["held"], "levitated");
    for axis in list(&found["sensitivity"]) {
        let [peak_db, peak] = ["peak_db", "peak"].map(|key| number(&axis[key]));
        assert!((peak_db - 20.0 * peak.log10()).abs() < 1e-9);
        assert_eq!(axis["zone"] == "A", peak < 3.0, "{axis}");
    }
    let late = [("lag_s = 1.6e-4", "lag_s = 1.6e-2")];
    folder.scene("late.toml", "one_machine/rigid", &late);
    let found = json(&folder, "late.toml --levitated --points 2");
    assert_eq!(found["stable"], false);
    let mut growth = list(&found["loop_modes"])
        .iter()
        .map(|m| number(&m["growth_1_s"]));
    assert!(growth.any(|growth| growth > 1.0));
    for command in ["modes", "run --quiet --out out", "advise"] {
        let said = folder.ran(&format!("{command} late.toml")).said;
        has(&said, &["makes a loop that is not stable"]);
    }
    // A point mass has a loop, and no other modes.
    let found = json(&folder, "@shock_15_g_on_amb --levitated");
    assert_eq!(found["sensitivity"][0]["axis"], "x");
}

/// A uniform shaft between two planes.
const INERTIAS: &str =
    "mass_kg = 10.0\ntransverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.0\n";

fn shaft() -> String {
    let edits = [
        (INERTIAS, "bending_to_hz = 1000.0\n"),
        ("position_m = -0.2", "position_m = 0.1"),
        ("position_m = 0.3\n", "position_m = 1.0\n"),
    ];
    let section = "[[shaft]]\nlength_m = 0.5\nouter_diameter_m = 0.06\n";
    edited(TWO_PLANES, &edits) + section + section
}

#[test]
fn a_shaft_is_the_rotor_that_it_weighs() {
    let scene = machine(&shaft());
    let rotor = &scene.machine.rotor;
    let mass = 7850.0 * std::f64::consts::PI * 0.03 * 0.03;
    assert!((rotor.rigid().mass_kg / mass - 1.0).abs() < 1e-12);
    assert_eq!(rotor.bending().len(), 2);
    // From the left end in the file, from the centre of mass in the machine.
    for (plane, place) in scene.machine.planes.iter().zip([-0.4, 0.5]) {
        assert!((plane.position_m - place).abs() < 1e-12, "{plane:?}");
        // What the other modes give way makes the contact softer.
        let stiffness = plane.contact.law.linear().unwrap().stiffness_n_m;
        assert!(stiffness > 0.5e8 && stiffness < 0.99e8, "{stiffness:e}");
    }
    let rigid = machine(&edited(&shaft(), &[("to_hz = 1000.0", "to_hz = 0.0")]));
    assert!(rigid.machine.rotor.bending().is_empty());
    assert_eq!(rigid.start, scene.start);
}

#[test]
fn what_is_no_shaft_is_refused_with_its_key() {
    all("scenes/shaft", 5, &shaft(), parsed);
}

#[test]
fn advice_is_for_every_plane_or_for_one() {
    let folder = Folder::fresh();
    let line = "advise @machines/overload_of_a_flexible_rotor";
    let all = folder.ran(&format!("{line} --json")).json();
    assert_eq!(list(&all["planes"]).len(), 2);
    assert_eq!(list(&all["coupling"]["effective_mass_kg"]).len(), 2);
    let mut one = folder.command(&format!("{line} --json"));
    let one = ran(one.args(["--plane", "far end"])).json();
    assert_eq!(one["parameters"], all["planes"][0]["parameters"]);
    has(
        &folder.ran(line).good(),
        &["coupling end struck", "\nfar end\n"],
    );
}

/// A slender shaft gives way by more than a magnet pulls: what pulls outwards stays what it is.
#[test]
fn negative_stiffness_is_not_turned_by_a_soft_shaft() {
    let edits = [
        (INERTIAS, "bending_to_hz = 0.0\n"),
        ("position_m = 0.3\n", "position_m = 0.7\n"),
        ("position_m = -0.2", "position_m = 0.3"),
    ];
    let more = "[[shaft]]\nlength_m = 1.0\nouter_diameter_m = 0.02\n[magnet]\nforce_max_n = 100.0\nnegative_stiffness_n_m = 5e6\n";
    let scene = machine(&(edited(TWO_PLANES, &edits) + more));
    let pulls = scene.machine.supports.iter().map(|s| s.stiffness_n_m.x);
    assert_eq!(pulls.collect::<Vec<f64>>(), [-5e6; 2]);
}
