//! `run --set` and `run --seed`.

use super::{short, short_scene, stripped};
use crate::run::traces::parquet_rows;
use system_tests::ran::{Folder, edited, ran};

/// What a run has left, of traces their rows.
fn results(folder: &Folder, out: &str) -> Vec<(String, Vec<u8>)> {
    let mut all = stripped(folder, out);
    for (name, bytes) in &mut all {
        if name.ends_with(".parquet") {
            let rows = parquet_rows(&folder.at(&format!("{out}/{name}")));
            let rows = rows.iter().map(|row| format!("{row}\n"));
            *bytes = rows.collect::<String>().into_bytes();
        }
    }
    all
}

#[test]
fn a_value_that_is_set_is_as_one_that_is_written() {
    let folder = short_scene(&[]);
    let edits = [
        ("coefficient = 0.15", "coefficient = 0.3"),
        ("seed = 1", "seed = 9"),
        ("force_n = [1300.0, 750.0]", "force_n = [1300.0, 100.0]"),
    ];
    let written = edited(&short(), &edits) + "\n[supervisor]\nhold_share = 0.5\n";
    folder.put("edited.toml", written);
    folder.ran("run edited.toml --out edited").good();
    let settings = "--set friction.coefficient=0.3 --set disturbance[0].force_n[1]=100 --seed 9";
    let mut set = folder.command(&format!("run short.toml --out set {settings}"));
    ran(set.args(["--set", "supervisor.hold_share = 0.5"])).good();
    // Not assert_eq: a failure would print megabytes. Traces say which settings they are of.
    assert!(results(&folder, "edited") == results(&folder, "set"));
    assert_eq!(folder.text("short.toml"), short());
    folder.ran("run short.toml --out plain").good();
    assert!(results(&folder, "plain") != results(&folder, "set"));
}
