//! `advise --format c` is a configuration that C firmware can take as it is.

use crate::library::{Target, built, good, host_program};
use std::fs;
use system_tests::{host, scene_path};
use tempfile::TempDir;

#[test]
fn an_advised_configuration_is_c() {
    let Some(library) = built(Target::Host, "") else {
        return;
    };
    let advised = |more: &str| {
        let mut advise = host();
        advise
            .arg("advise")
            .arg(scene_path("overload_then_release"));
        good(&advise.args(more.split(' ')).output().unwrap())
    };
    let config = advised("--format c");
    let folder = TempDir::new().unwrap();
    let source = folder.path().join("config.c");
    let program = folder.path().join("config");
    let main = "int main(void) { static amb_supervisor plane;\n\
                for (int i = 0; i < AMB_PARAMETERS; i++) printf(\"%.9g\\n\", (double)config[i]);\n\
                return amb_init(&plane, sizeof plane, config, AMB_PARAMETERS) != AMB_OK; }\n";
    let text = format!("#include <stdio.h>\n#include \"amb_supervisor.h\"\n{config}{main}");
    fs::write(&source, text).unwrap();
    let Some(compiled) = host_program(&[source], &library, &program) else {
        return;
    };
    good(&compiled);
    let printed = good(&std::process::Command::new(&program).output().unwrap());
    let printed: Vec<f32> = printed.lines().map(|line| line.parse().unwrap()).collect();

    let advice: serde_json::Value = serde_json::from_str(&advised("--json")).unwrap();
    let suggested = advice["parameters"].as_array().unwrap();
    let suggested: Vec<f32> = (suggested.iter())
        .map(|p| p["value"].as_f64().unwrap() as f32)
        .collect();
    assert_eq!(printed, suggested);
}
