//! Traces in other formats: the same numbers to the last bit, with units and the digest of their scene.

use crate::fmu::{checked, text};
use system_tests::ran::{Folder, has};
use system_tests::{python, scene_path};

#[test]
fn a_trace_is_the_same_in_every_format() {
    let Some(python) = python() else { return };
    let folder = Folder::fresh();
    let set = "--set friction.coefficient=0.12 --seed 3";
    folder
        .ran(&format!("run @impact_at_40_hz --out . {set}"))
        .good();
    for format in ["csv", "mcap"] {
        let line = format!("export trace_supervisor.parquet --to {format}");
        folder.ran(&line).good();
    }
    let digest = firmware_bench::sweep::plan::digest(&scene_path("impact_at_40_hz")).unwrap();
    let name = text(&folder.at("."));
    let arguments = [&name, "trace_supervisor", &digest];
    let said = checked(&python, "tests/python/exports.py", &arguments);
    has(&said, &["rows the same three times"]);
}
