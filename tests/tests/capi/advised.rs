//! `advise --format c` is a configuration that firmware in C or C++ can take as it is, all of it or in nine numbers.

use crate::library::{STRICT, Target, built, cpp, includes, linked_with, tool};
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use system_tests::ran::{Folder, edited, list, number, ran, scene_text};

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

fn advised(folder: &Folder, scene: &str, more: &str) -> String {
    folder.ran(&format!("advise {scene} {more}")).good()
}

/// What is in use of a plane that is advised. What a simulated machine need not confirm, a real one has to.
fn in_use(plane: &Value) -> Vec<f32> {
    let of_firmware = |p: &Value| match p["name"].as_str() {
        Some("check_first") => 1.0,
        _ => number(
            p.get("replaced_by")
                .filter(|x| !x.is_null())
                .unwrap_or(&p["value"]),
        ) as f32,
    };
    list(&plane["parameters"]).iter().map(of_firmware).collect()
}

/// What programs of this text say, as C and as C++, line by line.
fn said(text: &str, library: &Path) -> Vec<Vec<String>> {
    let folder = Folder::fresh();
    let text = format!("#include <stdio.h>\n#include \"amb_supervisor.h\"\n{text}");
    let compilers = [
        (tool("cc"), "-std=c99", "config.c"),
        (cpp(), "-std=c++17", "config.cpp"),
    ];
    let mut all = Vec::new();
    for (compiler, standard, source) in compilers {
        let Some(mut compile) = compiler else {
            continue;
        };
        compile
            .arg(standard)
            .args(&STRICT[1..])
            .args(includes(library));
        compile
            .arg(folder.put(source, &text))
            .args(linked_with(library));
        ran(compile.arg("-o").arg(folder.at("config"))).good();
        let said = ran(&mut Command::new(folder.at("config"))).good();
        all.push(said.lines().map(str::to_owned).collect());
    }
    all
}

/// A scene as it comes, and one that knows and sets more: a range, steps, a cap of the axes, a slew limit, a contact that hardens.
#[test]
fn an_advised_configuration_is_c_and_cpp() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let folder = Folder::fresh();
    let hardens = "stiffness_n_mn = 1e13\nrestitution_speed_m_s = 0.3";
    let limits = "[magnet]\naxis_force_max_n = 800.0\nslew_n_s = 2e7";
    let edits = [
        ("stiffness_n_m = 1e9", hardens),
        ("[magnet]", limits),
        ("[sensor]", "[sensor]\nrange_m = 8e-4"),
    ];
    let text = edited(&scene_text("overload_then_release"), &edits);
    folder.put("own.toml", text + "\n[supervisor]\nhold_share = 0.625\n");
    for scene in ["@overload_then_release", "@plants/p4", "own.toml"] {
        let [all, short] =
            ["--format c", "--format c --short"].map(|more| advised(&folder, scene, more));
        assert!(all.is_ascii() && short.is_ascii(), "{all}\n{short}");
        assert_eq!(short.matches("f, ").count(), 9, "{short}");
        let advice: Value = serde_json::from_str(&advised(&folder, scene, "--json")).unwrap();
        let in_use = in_use(&advice);
        for printed in said(&format!("{all}{short}{MAIN}"), &library) {
            let printed = printed.iter().map(|line| {
                let (all, short) = line.split_once(' ').unwrap();
                (all.parse::<f32>().unwrap(), short.parse::<f32>().unwrap())
            });
            let (all, short): (Vec<f32>, Vec<f32>) = printed.unzip();
            assert_eq!((&all, &short), (&in_use, &in_use), "{scene}");
        }
    }
}

/// Of a rotor in two planes: the shaft, and both configurations as those of each plane alone.
#[test]
fn an_advised_rotor_is_c_and_cpp() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let (folder, scene) = (Folder::fresh(), "@one_machine/flexible");
    let all = advised(&folder, scene, "--format c");
    let main = "
int main(void) {
    static amb_rotor rotor;
    for (int i = 0; i < 2 * AMB_PARAMETERS; i++) printf(\"%.9g\\n\", (double)config[i]);
    return amb_rotor_init(&rotor, sizeof rotor, &shaft, config, 2 * AMB_PARAMETERS) != AMB_OK;
}
";
    let advice: Value = serde_json::from_str(&advised(&folder, scene, "--json")).unwrap();
    let of_planes: Vec<f32> = list(&advice["planes"]).iter().flat_map(in_use).collect();
    for printed in said(&format!("{all}{main}"), &library) {
        let values = printed.iter().map(|line| line.parse::<f32>().unwrap());
        assert_eq!(values.collect::<Vec<f32>>(), of_planes);
    }
}
