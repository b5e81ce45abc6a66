//! Scenes of a whole rotor: the same as one plane where there is no more, what their files say, what is written of them.

mod bearings;
mod changes;
pub(crate) mod files;
mod in_turn;
mod levitated;
mod modes;
mod refusals;
mod seals;

use firmware_bench::run::closed_loop::{Accuracy, Keep, Recorders, record, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use system_tests::ran::{Folder, edited, has, lacks, list, number};
use system_tests::{machine_scene_names, scene};

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
    let inertias = "mass_kg = 10.0\ntransverse_inertia_kg_m2 = 0.3\npolar_inertia_kg_m2 = 0.05\n";
    let plane = "[[plane]]\nname = \"middle\"\nposition_m = 0.0\n[[disturbance]]";
    edited(
        ONE_PLANE,
        &[("mass_kg = 10.0\n", inertias), ("[[disturbance]]", plane)],
    )
}

fn machine(text: &str) -> Scene {
    Scene::parse("test", text).unwrap_or_else(|e| panic!("{e}"))
}

/// Figures and rows of each plane.
fn planes(scene: &Scene, kind: PolicyKind) -> Vec<(Figures, Trace)> {
    let mut traces = vec![Trace::default(); scene.planes.len()];
    let recorders = Recorders::of_planes(&mut traces);
    let ended = record(scene, kind, recorders, Accuracy::default(), &mut |_| {}).unwrap();
    let figures = ended.into_iter().map(|(figures, _)| figures);
    figures.zip(traces).collect()
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
    let (one, whole) = (machine(ONE_PLANE), machine(&as_machine()));
    let [of_whole, of_one] = [&whole, &one].map(|scene| &scene.planes[0]);
    assert_eq!(of_whole.nominal.mass_kg, of_one.nominal.mass_kg);
    assert_eq!(of_whole.nominal.load_n, of_one.nominal.load_n);
    assert_eq!(of_whole.supervisor, of_one.supervisor);
    // A force that a reading has rounded otherwise is another force.
    for (kind, most) in [
        (PolicyKind::Passive, 1e-10),
        (PolicyKind::Levitation, 1e-7),
        (PolicyKind::Supervisor, 1e-7),
    ] {
        let (figures, trace) = run(&one, kind, Keep::Trace, &mut |_| {}).unwrap();
        let (of_plane, rows) = planes(&whole, kind).pop().unwrap();
        let apart = apart(&trace, &rows);
        assert!(apart < most, "{}: {apart:e}", kind.name());
        assert!(figures.impacts > 0);
        let ended = |of: &Figures| (of.impacts, of.outcome);
        assert_eq!(ended(&figures), ended(&of_plane));
        let pushed = |of: &Figures| [of.peak_contact_force_n, of.contact_impulse_n_s];
        for (a, b) in pushed(&figures).iter().zip(pushed(&of_plane)) {
            assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
        }
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
    let moved = ended[1].1.rows.iter();
    let moved = moved.map(|row| row.plant.position_m.norm());
    assert!(moved.fold(0.0, f64::max) < 1e-11 * 2e-4);
    let inertias = "transverse_inertia_kg_m2 = 0.6\npolar_inertia_kg_m2 = 0.0\n";
    let lighter = "mass_kg = 6.0\ncontact_radius_m = 0.05";
    let (one_plane, _) = TWO_PLANES.split_once("[[plane]]").unwrap();
    let one_plane = edited(one_plane, &[("mass_kg = 10.0", lighter), (inertias, "")]);
    let alone = machine(&(one_plane + "[start]\nvelocity_m_s = [0.1, 0.02]\n"));
    let (_, trace) = run(&alone, PolicyKind::Passive, Keep::Trace, &mut |_| {}).unwrap();
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
    let folder = Folder::fresh();
    let other = "position_m = 0.1\n[[plane]]\nname = \"the other\"\nposition_m = -0.15";
    let edits = [
        ("position_m = 0.0", other),
        ("duration_s = 0.12", "duration_s = 0.11"),
    ];
    let text = edited(&as_machine(), &edits);
    folder.put("scene.toml", &text);
    let verdict = folder
        .ran("run scene.toml --out out --json --verify")
        .json();
    for policy in ["levitation", "supervisor"] {
        let of = &verdict["policies"][policy];
        let planes = list(&of["planes"]);
        let names = planes.iter().map(|p| p["name"].as_str().unwrap());
        assert!(names.eq(["middle", "the other"]));
        let sum: u64 = planes.iter().map(|p| p["impacts"].as_u64().unwrap()).sum();
        assert_eq!(of["impacts"], sum);
        assert!(number(&of["verification"]["estimated_error_clearances"]) < 1e-3);
        for plane in planes {
            assert!(plane["outcome"].is_string() && plane["run_time_s"].is_null());
            assert_eq!(plane["supervision"].is_object(), policy == "supervisor");
        }
        for file in ["trace_{}_middle", "trace_{}_the_other", "axis_{}"] {
            let file = file.replace("{}", policy);
            assert!(folder.at(&format!("out/{file}.parquet")).exists(), "{file}");
        }
    }
    let page = folder.text("out/report.html");
    for words in [
        "The event: supervisor",
        "Planes side by side: levitation",
        "Axis from the side",
        "Plane: the other",
        "<h3>Slope</h3>",
    ] {
        has(&page, &[words]);
    }
    lacks(&page, &["NaN"]);
    // What an earlier run left is not taken for this one's.
    folder.put("scene.toml", edited(&text, &[("\"levitation\", ", "")]));
    folder.ran("run scene.toml --out out").good();
    let left = folder.names("out").join(" ");
    lacks(&left, &["trace_levitation_middle", "axis_levitation"]);
}

#[test]
fn the_scenes_of_machines_run_and_are_confirmed() {
    for name in machine_scene_names() {
        let name = format!("machines/{name}");
        let scene = scene(&name);
        assert!(scene.planes.len() > 1, "{name}");
        assert_eq!(scene.warnings, [""; 0], "{name}");
        let line = format!("run @{name} --out out --verify --no-trace");
        Folder::fresh().ran(&line).good();
    }
}

/// The same overload on the same machine, seen ever more closely: the wall is struck less hard the more gives way, and the end that
/// is not struck takes part.
#[test]
fn one_machine_is_seen_in_three_ways() {
    let [point, rigid, flexible] = ["point_mass", "rigid", "flexible"].map(|name| {
        let scene = scene(&format!("one_machine/{name}"));
        assert_eq!(scene.warnings, [""; 0], "{name}");
        scene
    });
    let planes_of = [&point, &rigid, &flexible].map(|scene| scene.planes.len());
    assert_eq!(planes_of, [1, 2, 2]);
    // The point mass is what an impact at the coupling finds of the rigid rotor.
    let mass_kg = rigid.plant(1).rotor.mass_kg;
    let off = point.plant(0).rotor.mass_kg / mass_kg - 1.0;
    assert!(off.abs() < 1e-3, "{mass_kg}");
    for kind in [PolicyKind::Levitation, PolicyKind::Supervisor] {
        let alone = run(&point, kind, Keep::Verdict, &mut |_| {}).unwrap().0;
        let [rigid, flexible] = [&rigid, &flexible].map(|scene| planes(scene, kind));
        let struck = [&alone, &rigid[1].0, &flexible[1].0];
        let forces = struck.map(|figures| figures.peak_contact_force_n);
        assert!(forces.is_sorted_by(|a, b| a > b), "{kind:?} {forces:?}");
        let far = [&rigid, &flexible].map(|ends| ends[0].0.impacts > 0);
        assert_eq!(far, [kind == PolicyKind::Levitation; 2], "{kind:?}");
        let ended = rigid.iter().chain(&flexible).map(|(figures, _)| figures);
        assert!(ended.chain([&alone]).all(|figures| figures.recovered));
    }
}
