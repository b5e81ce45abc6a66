//! What is refused, and what it says then.

use super::{DRAWS, contents, succeeds, sweep, sweep_file};
use std::fs;
use tempfile::TempDir;

/// Sweep files: what is put in the place of what, the key that the error must name, and what it must say.
#[test]
fn bad_sweeps_are_refused_with_file_key_and_expectation() {
    let folder = TempDir::new().unwrap();
    let uniform = "uniform = [0.05, 0.3]";
    let cases = [
        (
            "\"friction.coefficient\"",
            "\"friction.coeficient\"",
            "vary[0].key",
            "did you mean `coefficient`",
        ),
        (
            uniform,
            "uniform = [0.3, 0.05]",
            "vary[0].uniform",
            "the lower first",
        ),
        (
            uniform,
            "log_uniform = [0.0, 0.3]",
            "vary[0].log_uniform",
            "two positive numbers",
        ),
        (uniform, "", "vary[0]", "give values, linspace"),
        (
            uniform,
            "values = [0.1]\nuniform = [0.1, 0.2]",
            "vary[0].uniform",
            "together with values",
        ),
        (
            uniform,
            "values = [\"slippery\"]",
            "vary[0].values",
            "expected a number",
        ),
        (
            uniform,
            "normal = { mean = 0.1, low = 0, high = 1 }",
            "sweep.toml:8",
            "standard_deviation",
        ),
        (
            "\"run.method\"",
            "\"friction.coefficient\"",
            "vary[1].key",
            "varies in vary[0] already",
        ),
        (
            "\"run.method\"",
            "\"run.policies\"",
            "vary[1].key",
            "give policies",
        ),
        (
            "\"collocation\"]",
            "\"exact\"]",
            "vary[1].values",
            "run.method",
        ),
        (
            "\"monte_carlo\"",
            "\"montecarlo\"",
            "sweep.toml:3",
            "did you mean `monte_carlo`",
        ),
        (
            "\"monte_carlo\"",
            "\"grid\"",
            "runs",
            "as many runs as combinations",
        ),
        (
            "\"monte_carlo\"\nruns = 70",
            "\"grid\"",
            "vary[0].uniform",
            "values, linspace or logspace",
        ),
        (
            "\"monte_carlo\"\nruns = 70",
            "\"sobol\"\nruns = 100000",
            "runs",
            "from 1 to 65536",
        ),
        ("runs = 70", "", "runs is missing", "runs = 1000"),
        (
            "\"monte_carlo\"",
            "\"saltelli\"",
            "design",
            "\"sobol\" or \"monte_carlo\"",
        ),
        (
            "seed = 7",
            "seed = 7\nmaps = [[\"run.method\", \"friction.coeficient\"]]",
            "maps",
            "did you mean `friction.coefficient`",
        ),
        (
            "seed = 7",
            "seed = 7\nmaps = [[\"run.method\", \"run.method\"]]",
            "maps",
            "give two keys that vary",
        ),
        ("runs = 70", "runs = 0", "runs", "from 1"),
        (
            "runs = 70",
            "runs = 70\nrepeats = 2",
            "repeats",
            "goes with grid, and not with monte_carlo",
        ),
        (
            "seed = 7",
            "seed = 7\nworst_by = \"severity\"",
            "worst_by",
            "severity_index",
        ),
        (
            "seed = 7",
            "seed = 7\nworst_policy = \"passive\"",
            "worst_policy",
            "levitation, supervisor",
        ),
        (
            "seed = 7",
            "sead = 7",
            "sweep.toml:5",
            "did you mean `seed`",
        ),
        // Last: of whole numbers no part is drawn.
        (
            uniform,
            "uniform = [1, 3]\n[[vary]]\nkey = \"magnet.delay_samples\"\nuniform = [1, 3]",
            "vary[1].uniform",
            "whole number",
        ),
    ];
    for (from, to, at, expected) in cases {
        assert!(DRAWS.contains(from), "{from}");
        let file = sweep_file(folder.path(), &DRAWS.replacen(from, to, 1));
        let out = folder.path().join("out");
        let refused = sweep(&file, &out, &[]);
        let error = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{to}: {error}");
        for word in ["sweep.toml", at, expected] {
            assert!(error.contains(word), "{to}: {word} is not in\n{error}");
        }
        assert!(!out.exists(), "{to}: something was written");
    }
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
