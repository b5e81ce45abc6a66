//! Co-simulation units: valid, equal to the native run of their scene, and clear about what is wrong. FMPy is the importer.

mod import;
mod rotor;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use system_tests::{host, machine_scene_path, python, root, run_scene, scene_path};
use tempfile::TempDir;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn fmu(scene: &Path, out: &Path, more: &[&str]) -> Output {
    let mut fmu = host();
    fmu.arg("fmu").arg(scene).arg("--out").arg(out).args(more);
    fmu.output().unwrap()
}

fn units(scene: &Path, out: &Path, version: &str) {
    let output = fmu(scene, out, &["--fmi", version]);
    let shown = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{shown}");
}

/// Runs a Python program that fails where something does not hold.
pub(crate) fn checked(python: &Path, program: &str, arguments: &[&str]) -> String {
    let program = root().join(program);
    let output = Command::new(python)
        .arg(program)
        .args(arguments)
        .output()
        .unwrap();
    let shown = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}\n{shown}");
    String::from_utf8(output.stdout).unwrap()
}

const CHECKS: &str = "tests/python/fmu_units.py";

/// Three units of both versions, of a scene of one plane and of one of two under the supervisor of the whole rotor.
#[test]
fn units_are_valid_and_their_closed_loop_is_the_native_run() {
    let Some(python) = python() else { return };
    let machine = machine_scene_path("overload_of_a_flexible_rotor");
    let cases = [
        (
            scene_path("impact_at_40_hz"),
            ["3.0", "2.0"].as_slice(),
            ["supervisor", "passive"].as_slice(),
            [""].as_slice(),
        ),
        (
            machine,
            &["3.0"],
            &["supervisor"],
            &["_far_end", "_coupling_end"],
        ),
    ];
    for (scene, versions, policies, planes) in cases {
        let folder = TempDir::new().unwrap();
        let ran = run_scene(&scene, folder.path(), &[]);
        assert!(ran.status.success());
        for version in versions {
            units(&scene, folder.path(), version);
            let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
            let all =
                ["plant", "supervisor", "closed_loop"].map(|name| file(&format!("{name}.fmu")));
            let [plant, supervisor, closed_loop] = all.each_ref().map(String::as_str);
            checked(&python, CHECKS, &["valid", plant, supervisor, closed_loop]);
            for policy in policies {
                let trace = |plane: &&str| file(&format!("trace_{policy}{plane}.parquet"));
                let traces: Vec<String> = planes.iter().map(trace).collect();
                let mut arguments = vec!["equal", closed_loop, policy];
                arguments.extend(traces.iter().map(String::as_str));
                let shown = checked(&python, CHECKS, &arguments);
                assert!(shown.contains("columns the same"), "{shown}");
            }
        }
    }
}

/// Plant and supervisor as units with the user's PID between them, in Python, go where the native run of the same scene goes.
#[test]
fn plant_and_supervisor_close_with_a_controller_in_python() {
    let Some(python) = python() else { return };
    let scene = scene_path("controllers/pid_in_python");
    let folder = TempDir::new().unwrap();
    let out = text(folder.path());
    units(&scene, folder.path(), "3.0");
    let ran = run_scene(&scene, folder.path(), &[]);
    assert!(ran.status.success());
    // The closed loop starts the Python that travels with it.
    let file = |name: &str| folder.path().join(name);
    let (unit, trace) = (file("closed_loop.fmu"), file("trace_supervisor.parquet"));
    let arguments = ["equal", text(&unit), "supervisor", text(&trace)];
    checked(&python, CHECKS, &arguments);
    let example = "firmware-host/fmu/examples/own_controller.py";
    for (policy, more) in [("levitation", None), ("supervisor", Some("--supervised"))] {
        let arguments: Vec<&str> = std::iter::once(out).chain(more).collect();
        let positions = checked(&python, example, &arguments);
        let csv = folder.path().join("positions.csv");
        fs::write(&csv, positions).unwrap();
        let trace = folder.path().join(format!("trace_{policy}.parquet"));
        let arguments = ["positions", text(&csv), text(&trace)];
        let shown = checked(&python, CHECKS, &arguments);
        assert!(shown.contains("2000 positions the same"), "{shown}");
    }
}

#[test]
fn mistakes_end_in_errors_with_their_text_in_the_log() {
    let Some(python) = python() else { return };
    let folder = TempDir::new().unwrap();
    units(&scene_path("impact_at_40_hz"), folder.path(), "3.0");
    let plant = folder.path().join("plant.fmu");
    checked(&python, CHECKS, &["errors", text(&plant)]);
    let shown = checked(&python, CHECKS, &["early", text(&plant)]);
    assert!(shown.contains("early returns"), "{shown}");
}

/// Parameters that are set in a unit are those of `run --set`.
#[test]
fn parameters_of_a_unit_are_keys_of_its_scene() {
    let Some(python) = python() else { return };
    let scene = scene_path("impact_at_40_hz");
    let folder = TempDir::new().unwrap();
    units(&scene, folder.path(), "3.0");
    let set = [
        "friction.coefficient=0.11",
        "supervisor.hold_share=0.31",
        "run.seed=5",
        "sensor.noise_rms_m=1e-6",
    ];
    let with: Vec<&str> = set.iter().flat_map(|one| ["--set", one]).collect();
    assert!(run_scene(&scene, folder.path(), &with).status.success());
    let (unit, trace) = (
        folder.path().join("closed_loop.fmu"),
        folder.path().join("trace_supervisor.parquet"),
    );
    let mut arguments = vec!["equal", text(&unit), "supervisor", text(&trace)];
    arguments.extend(set);
    checked(&python, CHECKS, &arguments);
}

/// The same scene gives the same bytes, files that it names travel along, and a scene that is wrong leaves nothing.
#[test]
fn archives_are_the_same_bytes_and_whole_or_not_there() {
    let folder = TempDir::new().unwrap();
    let scene = scene_path("controllers/pid_in_python");
    let (first, second) = (folder.path().join("a"), folder.path().join("b"));
    units(&scene, &first, "3.0");
    units(&scene, &second, "3.0");
    for name in ["plant.fmu", "supervisor.fmu", "closed_loop.fmu"] {
        let [a, b] = [&first, &second].map(|folder| fs::read(folder.join(name)).unwrap());
        assert!(a == b, "{name}");
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(a)).unwrap();
        let mut resource = |name: &str| {
            let file = archive.by_name(&format!("resources/{name}")).unwrap();
            std::io::read_to_string(file).unwrap()
        };
        assert!(resource("scene.toml").contains("python = \"1_pid.py\""));
        let pid = scene.with_file_name("pid.py");
        assert_eq!(resource("1_pid.py"), fs::read_to_string(pid).unwrap());
    }
    let wrong = folder.path().join("wrong.toml");
    let of = fs::read_to_string(scene_path("impact_at_40_hz")).unwrap();
    fs::write(&wrong, of.replace("mass_kg = 10.0", "mass_kg = -10.0")).unwrap();
    let nowhere = folder.path().join("c");
    let output = fmu(&wrong, &nowhere, &[]);
    assert_eq!(output.status.code(), Some(2));
    let shown = String::from_utf8_lossy(&output.stderr);
    assert!(shown.contains("mass_kg") && !nowhere.exists(), "{shown}");
    let output = fmu(&scene, &nowhere, &["--library", "nowhere.so"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!nowhere.exists());
}
