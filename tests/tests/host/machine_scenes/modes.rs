//! Modes of scenes, and rotors that are described by their shaft.

use super::{TWO_PLANES, machine};
use crate::refusals::{all, parsed};
use firmware_bench::scene::Scene;
use serde_json::Value;
use std::fs;
use std::process::Output;
use system_tests::{host, machine_scene_path, scene_path};
use tempfile::TempDir;

fn modes(args: &[&str]) -> Output {
    host()
        .arg("modes")
        .args(args)
        .output()
        .expect("the host starts")
}

fn json(args: &[&str]) -> Value {
    let output = modes(&[args, &["--json"]].concat());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A translation moves every place alike, a tilt as its distance; friction holds whirl from above the slowest backward mode.
#[test]
fn a_scene_has_shapes_and_whirl_that_friction_holds() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.toml");
    let springs = [-0.2, 0.2]
        .map(|z| {
            format!("[[support]]\nposition_m = {z}\nstiffness_n_m = 1e6\ndamping_n_s_m = 10.0\n")
        })
        .concat();
    fs::write(&path, TWO_PLANES.to_owned() + &springs).unwrap();
    let name = path.to_str().unwrap();
    let found = json(&[name, "--points", "2"]);
    let numbers = |value: &Value| -> Vec<f64> {
        value
            .as_array()
            .unwrap()
            .iter()
            .map(|x| x.as_f64().unwrap())
            .collect()
    };
    let places = numbers(&found["shape_positions_m"]);
    assert_eq!(places, [-0.2, 0.2, 0.3]);
    let shapes = found["mode_shapes"].as_array().unwrap();
    assert_eq!(shapes.len(), 4);
    for shape in shapes {
        let tau = std::f64::consts::TAU;
        let translates = shape["frequency_hz"].as_f64().unwrap() * tau > 0.5 * 2e5_f64.sqrt() * 1.7;
        let (along, across) = (numbers(&shape["along"]), numbers(&shape["across"]));
        for (z, (a, b)) in places.iter().zip(along.iter().zip(&across)) {
            let expected = if translates { 1.0 } else { z / 0.3 };
            assert!((a - expected).abs() < 1e-6 && b.abs() < 1e-6, "{z} {a} {b}");
        }
    }
    let held = found["held_whirl"].as_array().unwrap();
    let of = |range: &&Value, count: usize| range["planes"].as_array().unwrap().len() == count;
    let slowest = held
        .iter()
        .filter(|range| of(range, 1))
        .map(|r| numbers(&r["rates_rad_s"])[0]);
    let tilt = (2e6 * 0.04 / 0.6_f64).sqrt();
    assert!(slowest.clone().count() >= 2);
    assert!(slowest.fold(f64::INFINITY, f64::min) > tilt);
    assert!(held.iter().any(|range| of(&range, 2)));
    // Walls that hold the rotor leave no clearance to whirl in.
    assert!(json(&[name, "--points", "2", "--contact"])["held_whirl"].is_null());
    let text = String::from_utf8(modes(&[name]).stdout).unwrap();
    assert!(
        text.contains("backward whirl that friction can hold at 100 Hz"),
        "{text}"
    );
}

/// Two springs under a rigid rotor: translation at √(2k/m) both ways, the tilt apart by the spin.
#[test]
fn a_scene_has_the_modes_of_its_rotor() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.toml");
    let springs = [-0.2, 0.2]
        .map(|z| format!("[[support]]\nposition_m = {z}\nstiffness_n_m = 1e6\n"))
        .concat();
    let text = TWO_PLANES.replace("polar_inertia_kg_m2 = 0.0", "polar_inertia_kg_m2 = 0.5");
    fs::write(
        &path,
        text + &springs + "[[unbalance]]\nposition_m = 0.0\nmoment_kg_m = 1e-5\n",
    )
    .unwrap();
    let found = json(&[path.to_str().unwrap(), "--to-hz", "100", "--points", "2"]);
    let tau = std::f64::consts::TAU;
    let at = |spin: f64, whirl: &str| {
        let modes = found["modes"].as_array().unwrap().iter();
        let near = |m: &&Value| (m["spin_rad_s"].as_f64().unwrap() - spin).abs() < 1e-9;
        let mut rates: Vec<f64> = modes
            .filter(near)
            .filter(|m| m["whirl"] == whirl)
            .map(|m| tau * m["frequency_hz"].as_f64().unwrap())
            .collect();
        rates.sort_by(f64::total_cmp);
        rates
    };
    let (spin, translation) = (100.0 * tau, (2e6_f64 / 10.0).sqrt());
    let half = 0.5 * spin * 0.5 / 0.6;
    let root = (half * half + 2e6 * 0.04 / 0.6).sqrt();
    for (whirl, tilt) in [("forward", root + half), ("backward", root - half)] {
        let mut expected = [translation, tilt];
        expected.sort_by(f64::total_cmp);
        let found = at(spin, whirl);
        assert_eq!(found.len(), 2, "{found:?}");
        for (a, b) in found.iter().zip(expected) {
            assert!(
                (a / b - 1.0).abs() < 1e-9,
                "{whirl}: {found:?}, {expected:?}"
            );
        }
    }
    for (a, b) in at(0.0, "forward").iter().zip(at(0.0, "backward")) {
        assert!((a / b - 1.0).abs() < 1e-9);
    }
    assert_eq!(at(0.0, "forward").len(), 2);
    // U·Ω²/|k − m·Ω²| in every plane: it does not tilt.
    let response = &found["unbalance_response"][1]["planes_m"];
    let expected = 1e-5 * spin * spin / (2e6 - 10.0 * spin * spin).abs();
    for plane in response.as_array().unwrap() {
        assert!((plane.as_f64().unwrap() / expected - 1.0).abs() < 1e-9);
    }
    let mass = found["effective_mass_kg"][0].as_f64().unwrap();
    assert!((mass - 6.0).abs() < 1e-9);
}

#[test]
fn the_command_draws_its_page() {
    let folder = TempDir::new().unwrap();
    let page = folder.path().join("page.html");
    let flexible = machine_scene_path("overload_of_a_flexible_rotor");
    let output = modes(&[
        flexible.to_str().unwrap(),
        "--levitated",
        "--html",
        page.to_str().unwrap(),
    ]);
    assert!(output.status.success());
    let table = String::from_utf8(output.stdout).unwrap();
    for words in ["critical speed [Hz]", "forward", "coupling end struck"] {
        assert!(table.contains(words), "{table}");
    }
    let page = fs::read_to_string(page).unwrap();
    // Without unbalance there is no response to it.
    assert!(page.contains("Campbell diagram") && page.matches("<svg").count() == 3);
}

/// A rotor that the gains hold and one that lags too far behind: said by the command, in numbers and on its own.
#[test]
fn a_loop_is_judged() {
    let rigid = scene_path("one_machine/rigid");
    let found = json(&[rigid.to_str().unwrap(), "--levitated", "--points", "2"]);
    assert_eq!(found["stable"], true);
    assert_eq!(found["range"]["held"], "levitated");
    for axis in found["sensitivity"].as_array().unwrap() {
        let number = |key: &str| axis[key].as_f64().unwrap();
        assert!((number("peak_db") - 20.0 * number("peak").log10()).abs() < 1e-9);
        assert_eq!(axis["zone"] == "A", number("peak") < 3.0, "{axis}");
    }
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("late.toml");
    let late = fs::read_to_string(&rigid)
        .unwrap()
        .replace("lag_s = 1.6e-4", "lag_s = 1.6e-2");
    fs::write(&path, late).unwrap();
    let name = path.to_str().unwrap();
    let found = json(&[name, "--levitated", "--points", "2"]);
    assert_eq!(found["stable"], false);
    let growing = |mode: &Value| mode["growth_1_s"].as_f64().unwrap() > 1.0;
    assert!(found["loop_modes"].as_array().unwrap().iter().any(growing));
    for command in [
        &["modes"][..],
        &["run", "--quiet", "--out", "out"],
        &["advise"],
    ] {
        let output = host()
            .current_dir(folder.path())
            .args(command)
            .arg(name)
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            errors.contains("makes a loop that is not stable"),
            "{errors}"
        );
    }
    // A point mass has a loop, and no other modes.
    let one = scene_path("shock_15_g_on_amb");
    let found = json(&[one.to_str().unwrap(), "--levitated"]);
    assert_eq!(found["sensitivity"][0]["axis"], "x");
}

/// A uniform shaft between two planes.
const SHAFT: &str = "[[shaft]]\nlength_m = 0.5\nouter_diameter_m = 0.06\n[[shaft]]\nlength_m = 0.5\nouter_diameter_m = 0.06\n";

fn shaft() -> String {
    TWO_PLANES
        .replace(
            "mass_kg = 10.0\ntransverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.0\n",
            "bending_to_hz = 1000.0\n",
        )
        .replace("position_m = -0.2", "position_m = 0.1")
        .replace("position_m = 0.3\n", "position_m = 1.0\n")
        + SHAFT
}

#[test]
fn a_shaft_is_the_rotor_that_it_weighs() {
    let scene = machine(&shaft());
    let rotor = &scene.machine.rotor;
    let mass = 7850.0 * std::f64::consts::PI * 0.03 * 0.03;
    assert!((rotor.rigid().mass_kg / mass - 1.0).abs() < 1e-12);
    assert_eq!(rotor.bending().len(), 2);
    // From the left end in the file, from the centre of mass in the machine.
    let places: Vec<f64> = scene.machine.planes.iter().map(|p| p.position_m).collect();
    assert!(
        (places[0] + 0.4).abs() < 1e-12 && (places[1] - 0.5).abs() < 1e-12,
        "{places:?}"
    );
    // What the other modes give way makes the contact softer.
    for plane in &scene.machine.planes {
        let stiffness = plane.contact.law.linear().unwrap().stiffness_n_m;
        assert!(stiffness > 0.5e8 && stiffness < 0.99e8, "{stiffness:e}");
    }
    let rigid = machine(&shaft().replace("bending_to_hz = 1000.0", "bending_to_hz = 0.0"));
    assert!(rigid.machine.rotor.bending().is_empty());
    let start = |scene: &Scene| scene.start;
    assert_eq!(start(&rigid), start(&scene));
}

#[test]
fn what_is_no_shaft_is_refused_with_its_key() {
    all("scenes/shaft", 5, &shaft(), parsed);
}

#[test]
fn advice_is_for_every_plane_or_for_one() {
    let flexible = machine_scene_path("overload_of_a_flexible_rotor");
    let advise = |args: &[&str]| {
        let mut command = host();
        command.arg("advise").arg(&flexible).args(args);
        command.output().expect("the host starts")
    };
    let all: Value = serde_json::from_slice(&advise(&["--json"]).stdout).unwrap();
    assert_eq!(all["planes"].as_array().unwrap().len(), 2);
    assert_eq!(
        all["coupling"]["effective_mass_kg"]
            .as_array()
            .unwrap()
            .len(),
        2
    );
    let one: Value =
        serde_json::from_slice(&advise(&["--plane", "far end", "--json"]).stdout).unwrap();
    assert_eq!(one["parameters"], all["planes"][0]["parameters"]);
    let text = String::from_utf8(advise(&[]).stdout).unwrap();
    assert!(
        text.contains("coupling end struck") && text.contains("\nfar end\n"),
        "{text}"
    );
}

/// A slender shaft gives way by more than a magnet pulls: what pulls outwards stays what it is.
#[test]
fn negative_stiffness_is_not_turned_by_a_soft_shaft() {
    let text = TWO_PLANES
        .replace(
            "mass_kg = 10.0\ntransverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.0\n",
            "bending_to_hz = 0.0\n",
        )
        .replace("position_m = -0.2", "position_m = 0.3")
        .replace(
            "position_m = 0.3\ncontact_radius_m = 0.03",
            "position_m = 0.7\ncontact_radius_m = 0.03",
        )
        + "[[shaft]]\nlength_m = 1.0\nouter_diameter_m = 0.02\n[magnet]\nforce_max_n = 100.0\nnegative_stiffness_n_m = 5e6\n";
    let scene = machine(&text);
    let pulls: Vec<f64> = scene
        .machine
        .supports
        .iter()
        .map(|s| s.stiffness_n_m.x)
        .collect();
    assert_eq!(pulls, [-5e6; 2]);
}
