//! What is refused, and what it says then.

use super::{DRAWS, contents, succeeds, sweep, sweep_file};
use crate::refusals::all;
use std::fs;
use tempfile::TempDir;

#[test]
fn bad_sweeps_are_refused_with_file_key_and_expectation() {
    let folder = TempDir::new().unwrap();
    all("sweeps/draws", 24, DRAWS, |bad, row| {
        let file = sweep_file(folder.path(), bad);
        let out = folder.path().join("out");
        let refused = sweep(&file, &out, &[]);
        let error = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{row:?}: {error}");
        assert!(error.contains("sweep.toml"), "{row:?}: {error}");
        assert!(!out.exists(), "{row:?}: something was written");
        error
    });
    let refused = sweep(
        &folder.path().join("none.toml"),
        &folder.path().join("out"),
        &[],
    );
    let error = String::from_utf8_lossy(&refused.stderr);
    assert!(
        refused.status.code() == Some(2) && error.contains("cannot read sweep"),
        "{error}"
    );
    for shard in ["3/2", "slurm"] {
        let file = sweep_file(folder.path(), DRAWS);
        let refused = sweep(&file, &folder.path().join("out"), &["--shard", shard]);
        assert_eq!(refused.status.code(), Some(2), "{shard}");
    }
}

/// Results of a sweep as it was are not mixed with those of it as it is; what is only shown otherwise may change.
#[test]
fn a_changed_input_is_refused_by_its_name() {
    let folder = TempDir::new().unwrap();
    let few = DRAWS.replace("runs = 70", "runs = 4");
    let file = sweep_file(folder.path(), &few);
    let out = folder.path().join("out");
    succeeds(&sweep(&file, &out, &["--shard", "1/2"]));
    let before = contents_of_chunks(&out);
    let refused = |what: &str| {
        let refused = sweep(&file, &out, &[]);
        let error = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{error}");
        for word in [what, "--out", "put it back"] {
            assert!(error.contains(word), "{word} is not in\n{error}");
        }
        assert_eq!(contents_of_chunks(&out), before);
    };
    sweep_file(folder.path(), &few.replace("0.3]", "0.4]"));
    refused("vary of the sweep file was");
    sweep_file(folder.path(), &few.replace("seed = 7", "seed = 8"));
    refused("seed of the sweep file was 7, and is 8");
    sweep_file(folder.path(), &few);
    let scene = folder.path().join("short.toml");
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(&scene, format!("{text}# another\n")).unwrap();
    refused("short.toml has changed since");
    fs::write(&scene, &text).unwrap();
    let manifest = out.join("sweep.json");
    let of_another =
        fs::read_to_string(&manifest)
            .unwrap()
            .replacen("\"sha256\": \"", "\"sha256\": \"0", 1);
    let own = fs::read(&manifest).unwrap();
    fs::write(&manifest, of_another).unwrap();
    refused("the program has been built anew");
    fs::write(&manifest, own).unwrap();

    sweep_file(folder.path(), &format!("worst = 1\n{few}"));
    succeeds(&sweep(&file, &out, &[]));
    assert_eq!(
        contents(&out)
            .iter()
            .filter(|(name, _)| name.starts_with("worst"))
            .count(),
        1
    );
    sweep_file(folder.path(), &format!("worst = 2\n{few}"));
    let text = succeeds(&sweep(&file, &out, &[]));
    assert!(text.contains("nothing was left to run"), "{text}");
    assert_eq!(
        contents(&out)
            .iter()
            .filter(|(name, _)| name.starts_with("worst"))
            .count(),
        2
    );

    let strange = folder.path().join("strange");
    fs::create_dir_all(strange.join("chunks")).unwrap();
    let refused = sweep(&file, &strange, &[]);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("no sweep.json"));
    assert_eq!(refused.status.code(), Some(2));
}

fn contents_of_chunks(out: &std::path::Path) -> Vec<(String, Vec<u8>)> {
    contents(&out.join("chunks"))
}
