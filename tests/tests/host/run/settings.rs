//! `run --set` and `run --seed`.

use super::{short_scene, stripped};
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::fs;
use std::path::Path;
use system_tests::run_scene;
use tempfile::TempDir;

/// What a run has left, of traces their rows.
fn results(out: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = stripped(out);
    for (name, bytes) in &mut all {
        if name.ends_with(".parquet") {
            let file = fs::File::open(out.join(name)).unwrap();
            let reader = SerializedFileReader::new(file).unwrap();
            let rows = reader.get_row_iter(None).unwrap();
            *bytes = rows
                .map(|row| format!("{}\n", row.unwrap()))
                .collect::<String>()
                .into_bytes();
        }
    }
    all
}

#[test]
fn a_value_that_is_set_is_as_one_that_is_written() {
    let folder = TempDir::new().unwrap();
    let out = |name: &str| folder.path().join(name);
    let edited = short_scene(folder.path(), |text| {
        text.replace("coefficient = 0.15", "coefficient = 0.3")
            .replace("seed = 1", "seed = 9")
            .replace("force_n = [1300.0, 750.0]", "force_n = [1300.0, 100.0]")
            + "\n[supervisor]\nhold_share = 0.5\n"
    });
    assert!(run_scene(&edited, &out("edited"), &[]).status.success());
    let plain = short_scene(folder.path(), |text| text);
    let before = fs::read(&plain).unwrap();
    let settings = [
        "--set",
        "friction.coefficient=0.3",
        "--set",
        "supervisor.hold_share = 0.5",
        "--set",
        "disturbance[0].force_n[1]=100",
        "--seed",
        "9",
    ];
    let set = run_scene(&plain, &out("set"), &settings);
    assert!(
        set.status.success(),
        "{}",
        String::from_utf8_lossy(&set.stderr)
    );
    // Not assert_eq: a failure would print megabytes. Traces say which settings they are of.
    assert!(results(&out("edited")) == results(&out("set")));
    assert_eq!(fs::read(&plain).unwrap(), before);
    assert!(run_scene(&plain, &out("plain"), &[]).status.success());
    assert!(results(&out("plain")) != results(&out("set")));

    for (setting, shown) in [
        ("friction.coeficient=0.3", "did you mean `coefficient`"),
        ("friction.coefficient", "KEY=VALUE"),
        ("friction.coefficient=much", "KEY=VALUE"),
        ("friction.coefficient=-1", "friction.coefficient"),
        ("disturbance[3].force_n=[1.0, 0.0]", "none of this number"),
    ] {
        let refused = run_scene(&plain, &out("refused"), &["--set", setting]);
        let error = String::from_utf8_lossy(&refused.stderr);
        assert!(
            refused.status.code() == Some(2) && error.contains(shown),
            "{setting}: {error}"
        );
        assert!(!out("refused").exists());
    }
}
