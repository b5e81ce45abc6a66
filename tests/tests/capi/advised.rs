//! `advise --format c` is a configuration that firmware in C or C++ can take as it is, all of it or in nine numbers.

use crate::library::{Target, built, good, includes, tool};
use std::fs;
use std::path::Path;
use std::process::Command;
use system_tests::{host, root, scene_path};
use tempfile::TempDir;

/// All warnings, as errors.
const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];

/// Shows the values of both forms, and makes a supervisor of each.
const MAIN: &str = "
int main(void) {
    static amb_supervisor plane;
    float values[AMB_PARAMETERS];
    if (configure(values) != AMB_OK) return 1;
    for (int i = 0; i < AMB_PARAMETERS; i++) printf(\"%.9g %.9g\\n\", (double)config[i], (double)values[i]);
    if (amb_init(&plane, sizeof plane, config, AMB_PARAMETERS) != AMB_OK) return 2;
    return amb_init(&plane, sizeof plane, values, AMB_PARAMETERS) != AMB_OK;
}
";

fn advised(scene: &Path, more: &str) -> String {
    let mut advise = host();
    advise.arg("advise").arg(scene).args(more.split(' '));
    good(&advise.output().unwrap())
}

/// What a program of this text says, compiled as this language.
fn printed(compiler: &str, standard: &str, text: &str, library: &Path) -> Option<String> {
    let folder = TempDir::new().unwrap();
    let extension = if compiler == "cc" { "c" } else { "cpp" };
    let source = folder.path().join("config").with_extension(extension);
    let program = folder.path().join("config");
    fs::write(&source, text).unwrap();
    let mut compile = tool(compiler)?;
    compile.arg(standard).args(WARNINGS).args(includes(library));
    compile
        .arg(&source)
        .arg(library.join("libsupervisor_capi.a"));
    compile
        .args(["-lpthread", "-ldl", "-lm", "-o"])
        .arg(&program);
    good(&compile.output().unwrap());
    Some(good(&Command::new(&program).output().unwrap()))
}

/// A scene as it comes, and one that knows and sets more: a range, steps, a cap of the axes, a slew limit, a contact that hardens.
#[test]
fn an_advised_configuration_is_c_and_cpp() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let own = folder.path().join("own.toml");
    let text = fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let text = text
        .replacen(
            "stiffness_n_m = 1e9",
            "stiffness_n_mn = 1e13\nrestitution_speed_m_s = 0.3",
            1,
        )
        .replacen(
            "[magnet]",
            "[magnet]\naxis_force_max_n = 800.0\nslew_n_s = 2e7",
            1,
        )
        .replacen("[sensor]", "[sensor]\nrange_m = 8e-4", 1);
    fs::write(&own, text + "\n[supervisor]\nhold_share = 0.625\n").unwrap();
    let plant = root().join("firmware-host/scenes/plants/p4.toml");
    for scene in [scene_path("overload_then_release"), plant, own] {
        let (all, short) = (
            advised(&scene, "--format c"),
            advised(&scene, "--format c --short"),
        );
        assert!(all.is_ascii() && short.is_ascii(), "{all}\n{short}");
        assert_eq!(short.matches("f, ").count(), 9, "{short}");
        let text = format!("#include <stdio.h>\n#include \"amb_supervisor.h\"\n{all}{short}{MAIN}");

        let advice: serde_json::Value = serde_json::from_str(&advised(&scene, "--json")).unwrap();
        // What a simulated machine need not confirm, a real one has to.
        let of_firmware = |p: &serde_json::Value| match p["name"].as_str() {
            Some("check_first") => Some(1.0),
            _ => p["replaced_by"].as_f64().or(p["value"].as_f64()),
        };
        let in_use: Vec<f32> = (advice["parameters"].as_array().unwrap().iter())
            .map(|p| of_firmware(p).unwrap() as f32)
            .collect();
        for (compiler, standard) in [("cc", "-std=c99"), ("g++", "-std=c++17")] {
            // C++ is not needed by anything else: without a compiler there is nothing to check.
            if compiler == "g++" && Command::new(compiler).arg("--version").output().is_err() {
                eprintln!("not checked as C++: g++ is missing");
                continue;
            }
            let Some(printed) = printed(compiler, standard, &text, &library) else {
                continue;
            };
            let printed = printed.lines().map(|line| {
                let (all, short) = line.split_once(' ').unwrap();
                (all.parse::<f32>().unwrap(), short.parse::<f32>().unwrap())
            });
            let (all, short): (Vec<f32>, Vec<f32>) = printed.unzip();
            assert_eq!((&all, &short), (&in_use, &in_use), "{}", scene.display());
        }
    }
}

/// Of a rotor in two planes: the shaft, and both configurations as those of each plane alone.
#[test]
fn an_advised_rotor_is_c_and_cpp() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let scene = root().join("firmware-host/scenes/one_machine/flexible.toml");
    let all = advised(&scene, "--format c");
    let main = "
int main(void) {
    static amb_rotor rotor;
    for (int i = 0; i < 2 * AMB_PARAMETERS; i++) printf(\"%.9g\\n\", (double)config[i]);
    return amb_rotor_init(&rotor, sizeof rotor, &shaft, config, 2 * AMB_PARAMETERS) != AMB_OK;
}
";
    let text = format!("#include <stdio.h>\n#include \"amb_supervisor.h\"\n{all}{main}");
    for (compiler, standard) in [("cc", "-std=c99"), ("g++", "-std=c++17")] {
        if compiler == "g++" && Command::new(compiler).arg("--version").output().is_err() {
            eprintln!("not checked as C++: g++ is missing");
            continue;
        }
        let Some(printed) = printed(compiler, standard, &text, &library) else {
            continue;
        };
        let advice: serde_json::Value = serde_json::from_str(&advised(&scene, "--json")).unwrap();
        let mut values = printed.lines().map(|line| line.parse::<f32>().unwrap());
        for plane in advice["planes"].as_array().unwrap() {
            for p in plane["parameters"].as_array().unwrap() {
                let of_plane = match p["name"].as_str() {
                    Some("check_first") => Some(1.0),
                    _ => p["replaced_by"].as_f64().or(p["value"].as_f64()),
                };
                assert_eq!(values.next(), of_plane.map(|v| v as f32), "{}", p["name"]);
            }
        }
        assert_eq!(values.next(), None);
    }
}
