//! Co-simulation units: valid, equal to the native run of their scene, and clear about what is wrong. FMPy is the importer.

mod import;
mod rotor;

use std::fs;
use std::path::Path;
use std::process::Command;
use system_tests::ran::{Folder, has, ran};
use system_tests::{python, root, scene_path};

pub(crate) fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

fn units(folder: &Folder, scene: &str, version: &str) {
    folder
        .ran(&format!("fmu {scene} --out . --fmi {version}"))
        .good();
}

/// Runs a Python program that fails where something does not hold.
pub(crate) fn checked(python: &Path, program: &str, arguments: &[&str]) -> String {
    let mut python = Command::new(python);
    ran(python.arg(root().join(program)).args(arguments)).good()
}

const CHECKS: &str = "tests/python/fmu_units.py";

/// Three units of both versions, of a scene of one plane and of one of two under the supervisor of the whole rotor.
#[test]
fn units_are_valid_and_their_closed_loop_is_the_native_run() {
    let Some(python) = python() else { return };
    let flexible = "@machines/overload_of_a_flexible_rotor";
    let point: [&[&str]; 3] = [&["3.0", "2.0"], &["supervisor", "passive"], &[""]];
    let rotor: [&[&str]; 3] = [&["3.0"], &["supervisor"], &["_far_end", "_coupling_end"]];
    for (scene, [versions, policies, planes]) in [("@impact_at_40_hz", point), (flexible, rotor)] {
        let folder = Folder::fresh();
        folder.ran(&format!("run {scene} --out .")).good();
        for version in versions {
            units(&folder, scene, version);
            let file = |name: &str| text(&folder.at(name));
            let all =
                ["plant", "supervisor", "closed_loop"].map(|name| file(&format!("{name}.fmu")));
            let [plant, supervisor, closed_loop] = all.each_ref().map(String::as_str);
            checked(&python, CHECKS, &["valid", plant, supervisor, closed_loop]);
            for policy in policies {
                let trace = |plane: &&str| file(&format!("trace_{policy}{plane}.parquet"));
                let traces: Vec<String> = planes.iter().map(trace).collect();
                let mut arguments = vec!["equal", closed_loop, policy];
                arguments.extend(traces.iter().map(String::as_str));
                let said = checked(&python, CHECKS, &arguments);
                has(&said, &["columns the same"]);
            }
        }
    }
}

/// Plant and supervisor as units with the user's PID between them, in Python, go where the native run of the same scene goes.
#[test]
fn plant_and_supervisor_close_with_a_controller_in_python() {
    let Some(python) = python() else { return };
    let folder = Folder::fresh();
    let file = |name: &str| text(&folder.at(name));
    units(&folder, "@controllers/pid_in_python", "3.0");
    folder.ran("run @controllers/pid_in_python --out .").good();
    // The closed loop starts the Python that travels with it.
    let (unit, trace) = (file("closed_loop.fmu"), file("trace_supervisor.parquet"));
    checked(&python, CHECKS, &["equal", &unit, "supervisor", &trace]);
    let example = "firmware-host/fmu/examples/own_controller.py";
    for (policy, more) in [("levitation", None), ("supervisor", Some("--supervised"))] {
        let out = file(".");
        let arguments: Vec<&str> = std::iter::once(&out[..]).chain(more).collect();
        folder.put("positions.csv", checked(&python, example, &arguments));
        let trace = file(&format!("trace_{policy}.parquet"));
        let arguments = ["positions", &file("positions.csv"), &trace];
        let said = checked(&python, CHECKS, &arguments);
        has(&said, &["2000 positions the same"]);
    }
}

#[test]
fn mistakes_end_in_errors_with_their_text_in_the_log() {
    let Some(python) = python() else { return };
    let folder = Folder::fresh();
    units(&folder, "@impact_at_40_hz", "3.0");
    let plant = text(&folder.at("plant.fmu"));
    checked(&python, CHECKS, &["errors", &plant]);
    let said = checked(&python, CHECKS, &["early", &plant]);
    has(&said, &["early returns"]);
}

/// Parameters that are set in a unit are those of `run --set`.
#[test]
fn parameters_of_a_unit_are_keys_of_its_scene() {
    let Some(python) = python() else { return };
    let folder = Folder::fresh();
    units(&folder, "@impact_at_40_hz", "3.0");
    let set = [
        "friction.coefficient=0.11",
        "supervisor.hold_share=0.31",
        "run.seed=5",
        "sensor.noise_rms_m=1e-6",
    ];
    let with = set.map(|one| format!(" --set {one}")).concat();
    folder
        .ran(&format!("run @impact_at_40_hz --out .{with}"))
        .good();
    let [unit, trace] =
        ["closed_loop.fmu", "trace_supervisor.parquet"].map(|name| text(&folder.at(name)));
    let mut arguments = vec!["equal", &unit, "supervisor", &trace];
    arguments.extend(set);
    checked(&python, CHECKS, &arguments);
}

/// The same scene gives the same bytes, files that it names travel along, and a scene that is wrong leaves nothing.
#[test]
fn archives_are_the_same_bytes_and_whole_or_not_there() {
    let [folder, again] = [Folder::fresh(), Folder::fresh()];
    let pid = "controllers/pid_in_python";
    for folder in [&folder, &again] {
        units(folder, &format!("@{pid}"), "3.0");
    }
    for name in ["plant.fmu", "supervisor.fmu", "closed_loop.fmu"] {
        let [a, b] = [&folder, &again].map(|folder| folder.bytes(name));
        assert!(a == b, "{name}");
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(a)).unwrap();
        let mut resource = |name: &str| {
            let file = archive.by_name(&format!("resources/{name}")).unwrap();
            std::io::read_to_string(file).unwrap()
        };
        has(&resource("scene.toml"), &["python = \"1_pid.py\""]);
        let own = fs::read_to_string(scene_path(pid).with_file_name("pid.py"));
        assert_eq!(resource("1_pid.py"), own.unwrap());
    }
    let wrong = [("mass_kg = 10.0", "mass_kg = -10.0")];
    folder.scene("wrong.toml", "impact_at_40_hz", &wrong);
    for (line, says) in [
        ("wrong.toml", "mass_kg"),
        (
            "@controllers/pid_in_python --library nowhere.so",
            "nowhere.so",
        ),
    ] {
        let said = folder.ran(&format!("fmu {line} --out none")).fails(2);
        has(&said, &[says]);
        assert!(!folder.at("none").exists());
    }
}
