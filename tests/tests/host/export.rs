//! Traces in other formats: the same numbers to the last bit, with units and the digest of their scene.

use crate::fmu::checked;
use std::path::Path;
use std::process::Output;
use system_tests::{host, python, run_scene, scene_path};
use tempfile::TempDir;

fn export(trace: &Path, more: &[&str]) -> Output {
    let mut export = host();
    export.arg("export").arg(trace).args(more);
    export.output().unwrap()
}

#[test]
fn a_trace_is_the_same_in_every_format() {
    let Some(python) = python() else { return };
    let folder = TempDir::new().unwrap();
    let scene = scene_path("impact_at_40_hz");
    let set = ["--set", "friction.coefficient=0.12", "--seed", "3"];
    assert!(run_scene(&scene, folder.path(), &set).status.success());
    let trace = folder.path().join("trace_supervisor.parquet");
    for format in ["csv", "mcap"] {
        let output = export(&trace, &["--to", format]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{text}");
    }
    let digest = firmware_bench::sweep::plan::digest(&scene).unwrap();
    let name = folder.path().to_str().unwrap();
    let arguments = [name, "trace_supervisor", digest.as_str()];
    let text = checked(&python, "tests/python/exports.py", &arguments);
    assert!(text.contains("rows the same three times"), "{text}");
}
