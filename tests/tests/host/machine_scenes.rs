//! Scenes of a whole rotor: the same as one plane where there is no more, what their files say, what is written of them.

mod bearings;
mod changes;
mod files;
mod in_turn;
mod levitated;
mod modes;
mod refusals;
mod seals;

use firmware_bench::run::closed_loop::{Accuracy, Keep, Recorders, record, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::{Recorder, Trace};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use serde_json::Value;
use std::fs;
use system_tests::{machine_scene_names, machine_scene_path, root, run_scene};
use tempfile::TempDir;

/// A magnetic bearing with everything that one plane may have and a whole rotor as well.
const ONE_PLANE: &str = r#"
title = "One plane"
[run]
duration_s = 0.12
sample_rate_hz = 20000
policies = ["levitation", "supervisor"]
seed = 5
rtol = 1e-11
[rotor]
mass_kg = 10.0
eccentricity_m = 2e-6
contact_radius_m = 0.05
gravity_m_s2 = [0.0, -9.81]
[spin]
frequency_hz = 150.0
inertia_kg_m2 = 0.05
[start]
position_m = [1e-5, 0.0]
velocity_m_s = [0.0, 0.02]
spin_phase_rad = 0.4
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.6
[friction]
coefficient = 0.15
rolling_coefficient = 0.002
[retainer]
centre_offset_m = [2e-5, -1e-5]
[race]
inertia_kg_m2 = 1e-4
drag_n_m_s = 1e-5
[magnet]
force_max_n = 600.0
slew_n_s = 2e6
lag_s = 1.6e-4
negative_stiffness_n_m = 1e5
delay_samples = 2
force_measured = true
[sensor]
noise_rms_m = 1e-6
quantum_m = 1e-7
runout_m = 2e-6
runout_phase_rad = 1.0
[levitation]
proportional_n_m = 4e5
derivative_n_s_m = 900.0
integral_n_m_s = 1e6
derivative_filter_s = 1e-4
feed_forward_weight = true
[[disturbance]]
start_s = 0.02
duration_s = 0.01
force_n = [900.0, 300.0]
shape = "half_sine"
[[base_motion]]
start_s = 0.06
duration_s = 0.004
acceleration_m_s2 = [0.0, 60.0]
[[fault]]
start_s = 0.1
duration_s = 0.001
kind = "dropout"
[[outage]]
start_s = 0.105
duration_s = 0.002
known = true
"#;

/// The same as the only plane of a rotor, at its centre of mass.
fn as_machine() -> String {
    ONE_PLANE
        .replace(
            "mass_kg = 10.0\n",
            "mass_kg = 10.0\ntransverse_inertia_kg_m2 = 0.3\npolar_inertia_kg_m2 = 0.05\n",
        )
        .replace(
            "[[disturbance]]",
            "[[plane]]\nname = \"middle\"\nposition_m = 0.0\n[[disturbance]]",
        )
}

fn machine(text: &str) -> Scene {
    Scene::parse("test", text).unwrap_or_else(|e| panic!("{e}"))
}

/// Figures and rows of each plane.
fn planes(scene: &Scene, kind: PolicyKind) -> Vec<(Figures, Trace)> {
    let mut traces = vec![Trace::default(); scene.planes.len()];
    let recorders = Recorders {
        planes: traces.iter_mut().map(|t| t as &mut dyn Recorder).collect(),
        axis: None,
    };
    let ended = record(scene, kind, recorders, Accuracy::default(), &mut |_| {}).unwrap();
    ended
        .into_iter()
        .map(|(figures, _)| figures)
        .zip(traces)
        .collect()
}

/// Largest distance at a sample between two runs \[clearances\].
fn apart(a: &Trace, b: &Trace) -> f64 {
    let samples = |t: &Trace| {
        let rows = t.rows.iter().filter(|row| !row.mode_change);
        rows.map(|row| row.plant.position_m).collect::<Vec<_>>()
    };
    let (a, b) = (samples(a), samples(b));
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(&b)
        .map(|(a, b)| (a - b).norm() / 2e-4)
        .fold(0.0, f64::max)
}

/// Sensor, amplifier, loads, faults, controller, supervisor: all of a closed loop is the same around both plants.
#[test]
fn the_only_plane_of_a_rotor_is_a_scene_of_one_plane() {
    let (one, whole) = (
        Scene::parse("test", ONE_PLANE).unwrap(),
        machine(&as_machine()),
    );
    let [of_whole, of_one] = [&whole, &one].map(|scene| &scene.planes[0]);
    assert_eq!(of_whole.nominal.mass_kg, of_one.nominal.mass_kg);
    assert_eq!(of_whole.nominal.load_n, of_one.nominal.load_n);
    assert_eq!(of_whole.supervisor, of_one.supervisor);
    for kind in [
        PolicyKind::Passive,
        PolicyKind::Levitation,
        PolicyKind::Supervisor,
    ] {
        let (figures, trace) = run(&one, kind, Keep::Trace, &mut |_| {}).unwrap();
        let (of_plane, rows) = planes(&whole, kind).pop().unwrap();
        let apart = apart(&trace, &rows);
        // A force that a reading has rounded otherwise is another force.
        let most = if kind == PolicyKind::Passive {
            1e-10
        } else {
            1e-7
        };
        assert!(apart < most, "{}: {apart:e}", kind.name());
        assert!(figures.impacts > 0);
        assert_eq!(
            (figures.impacts, figures.outcome),
            (of_plane.impacts, of_plane.outcome)
        );
        let forces = [figures.peak_contact_force_n, of_plane.peak_contact_force_n];
        assert!((forces[0] / forces[1] - 1.0).abs() < 1e-5, "{forces:?}");
        let impulses = [figures.contact_impulse_n_s, of_plane.contact_impulse_n_s];
        assert!(
            (impulses[0] / impulses[1] - 1.0).abs() < 1e-5,
            "{impulses:?}"
        );
    }
}

/// Two planes of a rotor with I_t = m·a·b, one of them struck.
const TWO_PLANES: &str = r#"
title = "Two planes"
[run]
duration_s = 0.05
sample_rate_hz = 20000
policies = ["passive"]
[rotor]
mass_kg = 10.0
transverse_inertia_kg_m2 = 0.6
polar_inertia_kg_m2 = 0.0
[spin]
frequency_hz = 100.0
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.7
[friction]
coefficient = 0.15
[verdict]
whirl_speed_m_s = 1.0
[[plane]]
name = "struck end"
position_m = -0.2
contact_radius_m = 0.05
start_velocity_m_s = [0.1, 0.02]
[[plane]]
name = "other end"
position_m = 0.3
contact_radius_m = 0.03
start_position_m = [0.0, 0.0]
"#;

#[test]
fn ends_at_the_centres_of_percussion_do_not_feel_each_other() {
    let scene = machine(TWO_PLANES);
    // 1/(1/m + a²/I_t), with a² = 0.04.
    let mass_kg = scene.plant(0).rotor.mass_kg;
    assert!((mass_kg - 6.0).abs() < 1e-12, "{mass_kg}");
    let ended = planes(&scene, PolicyKind::Passive);
    assert!(ended[0].0.impacts > 3 && ended[1].0.impacts == 0);
    let moved = ended[1]
        .1
        .rows
        .iter()
        .map(|row| row.plant.position_m.norm());
    assert!(moved.fold(0.0, f64::max) < 1e-11 * 2e-4);
    let alone = TWO_PLANES
        .split("[[plane]]")
        .next()
        .unwrap()
        .replace("mass_kg = 10.0", "mass_kg = 6.0\ncontact_radius_m = 0.05")
        .replace(
            "transverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.0\n",
            "",
        )
        + "[start]\nvelocity_m_s = [0.1, 0.02]\n";
    let (_, trace) = run(
        &Scene::parse("test", &alone).unwrap(),
        PolicyKind::Passive,
        Keep::Trace,
        &mut |_| {},
    )
    .unwrap();
    let apart = apart(&trace, &ended[0].1);
    assert!(apart < 1e-7, "{apart:e}");
}

#[test]
fn a_start_may_be_given_by_planes_or_by_centre_and_tilt() {
    let by_planes = machine(TWO_PLANES).start;
    // (0.1, 0.02) at −0.2 and nothing at 0.3.
    let whole = TWO_PLANES
        .replace("start_velocity_m_s = [0.1, 0.02]\n", "")
        .replace("start_position_m = [0.0, 0.0]\n", "")
        + "[start]\nvelocity_m_s = [0.06, 0.012]\ntilt_rate_rad_s = [-0.2, -0.04]\n";
    let by_centre = machine(&whole).start;
    let close = |a: plant_model::V2, b: plant_model::V2| (a - b).norm() < 1e-12;
    assert!(close(
        by_planes.centre_velocity_m_s,
        by_centre.centre_velocity_m_s
    ));
    assert!(close(by_planes.tilt_rate_rad_s, by_centre.tilt_rate_rad_s));
    assert_eq!(by_planes.centre_m, by_centre.centre_m);
}

#[test]
fn what_is_written_and_printed_has_every_plane() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scene = folder.path().join("scene.toml");
    let text = as_machine().replace(
        "position_m = 0.0",
        "position_m = 0.1\n[[plane]]\nname = \"the other\"\nposition_m = -0.15",
    );
    fs::write(
        &scene,
        text.replace("duration_s = 0.12", "duration_s = 0.11"),
    )
    .unwrap();
    let result = run_scene(&scene, &out, &["--json", "--verify"]);
    let errors = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{errors}");
    let verdict: Value = serde_json::from_slice(&result.stdout).unwrap();
    for policy in ["levitation", "supervisor"] {
        let of = &verdict["policies"][policy];
        let planes = of["planes"].as_array().unwrap();
        let names: Vec<_> = planes.iter().map(|p| p["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["middle", "the other"]);
        let sum: u64 = planes.iter().map(|p| p["impacts"].as_u64().unwrap()).sum();
        assert_eq!(of["impacts"].as_u64().unwrap(), sum);
        assert!(
            of["verification"]["estimated_error_clearances"]
                .as_f64()
                .unwrap()
                < 1e-3
        );
        for plane in planes {
            assert!(plane["outcome"].is_string() && plane["run_time_s"].is_null());
            assert_eq!(plane["supervision"].is_object(), policy == "supervisor");
        }
        for plane in ["middle", "the_other"] {
            assert!(out.join(format!("trace_{policy}_{plane}.parquet")).exists());
        }
        assert!(out.join(format!("axis_{policy}.parquet")).exists());
    }
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for words in [
        "The event: supervisor",
        "Planes side by side: levitation",
        "Axis from the side",
        "Plane: the other",
        "<h3>Slope</h3>",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!page.contains("NaN"));
    // What an earlier run left is not taken for this one's.
    let alone = fs::read_to_string(&scene)
        .unwrap()
        .replace("\"levitation\", ", "");
    fs::write(&scene, alone).unwrap();
    assert!(run_scene(&scene, &out, &[]).status.success());
    assert!(!out.join("trace_levitation_middle.parquet").exists());
    assert!(!out.join("axis_levitation.parquet").exists());
}

#[test]
fn the_scenes_of_machines_run_and_are_confirmed() {
    for name in machine_scene_names() {
        let scene = Scene::load(&machine_scene_path(&name)).unwrap();
        assert!(scene.planes.len() > 1, "{name}");
        assert_eq!(scene.warnings, [""; 0], "{name}");
        let folder = TempDir::new().unwrap();
        let result = run_scene(
            &machine_scene_path(&name),
            folder.path(),
            &["--verify", "--no-trace"],
        );
        let errors = String::from_utf8_lossy(&result.stderr);
        assert!(result.status.success(), "{name}: {errors}");
    }
}

/// The same overload on the same machine, seen ever more closely: the wall is struck less hard the more gives way, and the end that
/// is not struck takes part.
#[test]
fn one_machine_is_seen_in_three_ways() {
    let path = |name: &str| root().join(format!("firmware-host/scenes/one_machine/{name}.toml"));
    let load = |name: &str| {
        let scene = Scene::load(&path(name)).unwrap();
        assert_eq!(scene.warnings, [""; 0], "{name}");
        scene
    };
    let [point, rigid, flexible] = ["point_mass", "rigid", "flexible"].map(load);
    let planes_of = [&point, &rigid, &flexible].map(|scene| scene.planes.len());
    assert_eq!(planes_of, [1, 2, 2]);
    // The point mass is what an impact at the coupling finds of the rigid rotor.
    let mass_kg = rigid.plant(1).rotor.mass_kg;
    assert!(
        (point.plant(0).rotor.mass_kg / mass_kg - 1.0).abs() < 1e-3,
        "{mass_kg}"
    );
    for kind in [PolicyKind::Levitation, PolicyKind::Supervisor] {
        let alone = run(&point, kind, Keep::Verdict, &mut |_| {}).unwrap().0;
        let [rigid, flexible] = [&rigid, &flexible].map(|scene| planes(scene, kind));
        let forces = [
            alone.peak_contact_force_n,
            rigid[1].0.peak_contact_force_n,
            flexible[1].0.peak_contact_force_n,
        ];
        assert!(
            forces[0] > forces[1] && forces[1] > forces[2],
            "{kind:?} {forces:?}"
        );
        let far = [&rigid, &flexible].map(|ends| ends[0].0.impacts > 0);
        assert_eq!(far, [kind == PolicyKind::Levitation; 2], "{kind:?}");
        let ended = rigid.iter().chain(&flexible).map(|(figures, _)| figures);
        assert!(ended.chain([&alone]).all(|figures| figures.recovered));
    }
}
