//! Sweeps whose design is made for indices, on a scene.

use super::{contents, succeeds, sweep, sweep_file};
use serde_json::Value;
use tempfile::TempDir;

/// What decides, what has next to nothing to say, and what does not count at all: a key of a policy that is not run.
const KEYS: &str = "[[vary]]\nkey = \"disturbance[0].force_n[0]\"\nuniform = [600, 1700]\n\
    [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.12, 0.13]\n\
    [[vary]]\nkey = \"radial.band\"\nuniform = [0.5, 0.9]\n";

fn number(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap()
}

/// Parts, threads and one call give one page and one table of indices, which are those of the scene.
#[test]
fn designs_for_indices_rank_the_keys_of_a_scene() {
    let cases = [
        (
            "saltelli",
            "samples = 32",
            32 * 5,
            "total_order",
            "total order",
        ),
        (
            "morris",
            "trajectories = 12\nlevels = 6",
            12 * 4,
            "mean_magnitude",
            "magnitude",
        ),
    ];
    for (design, size, runs, index, heading) in cases {
        let folder = TempDir::new().unwrap();
        let lines = format!("design = \"{design}\"\n{size}\nseed = 3\n{KEYS}");
        let file = sweep_file(folder.path(), &lines);
        let out = |name: &str| folder.path().join(name);
        let done = succeeds(&sweep(&file, &out("one"), &["--json", "--threads", "1"]));
        let done: Value = serde_json::from_str(&done).unwrap();
        for key in ["runs", "failed", "seconds", "runs_per_second"] {
            assert!(done[key].is_number(), "{design}: {key}");
        }
        assert_eq!((&done["runs"], &done["failed"]), (&runs.into(), &0.into()));
        let indices = &done["indices"];
        assert_eq!(indices["design"], design);
        assert_eq!(indices["whole_blocks"], indices["blocks"]);
        let keys = indices["keys"].as_array().unwrap();
        let sizes: Vec<(&str, f64)> = (keys.iter())
            .map(|of| (of["key"].as_str().unwrap(), number(&of["figure"], index)))
            .collect();
        assert_eq!(
            sizes[0].0, "disturbance[0].force_n[0]",
            "{design}: {sizes:?}"
        );
        assert!(sizes[0].1 > 2.0 * sizes[1].1, "{design}: {sizes:?}");
        // Common seeds: what changes nothing has an influence of exactly 0, whatever the noise is.
        let idle = sizes.iter().find(|(key, _)| *key == "radial.band");
        assert_eq!(idle.unwrap().1, 0.0, "{design}");

        let parts = ["1", "2", "3"].map(|part| {
            let shard = format!("{part}/3");
            succeeds(&sweep(&file, &out(part), &["--shard", &shard]));
            out(part).display().to_string()
        });
        let all = ["--merge", &parts[0], &parts[1], &parts[2]];
        let said = succeeds(&sweep(&file, &out("merged"), &all));
        assert!(
            said.contains(heading) && said.contains("report.html"),
            "{said}"
        );
        assert!(
            contents(&out("one")) == contents(&out("merged")),
            "{design}"
        );
    }
}
