//! What is refused, and what it says then.

use super::{DRAWS, SWEEP, contents, sweep_file, sweep_of};
use crate::refusals::all;
use std::fs;
use system_tests::ran::{Folder, edited, has};

#[test]
fn bad_sweeps_are_refused_with_file_key_and_expectation() {
    let folder = Folder::fresh();
    all("sweeps/draws", 24, DRAWS, |bad, row| {
        sweep_file(&folder, bad);
        let ran = folder.ran(SWEEP);
        assert_eq!(ran.code, Some(2), "{row:?}: {}", ran.said);
        has(&ran.said, &["sweep.toml"]);
        assert!(!folder.at("out").exists(), "{row:?}: something was written");
        ran.said
    });
    let said = folder.ran("sweep none.toml --out out").fails(2);
    has(&said, &["cannot read sweep"]);
    sweep_file(&folder, DRAWS);
    for shard in ["3/2", "slurm"] {
        folder.ran(&format!("{SWEEP} --shard {shard}")).fails(2);
    }
}

/// Results of a sweep as it was are not mixed with those of it as it is; what is only shown otherwise may change.
#[test]
fn a_changed_input_is_refused_by_its_name() {
    let few = DRAWS.replace("runs = 70", "runs = 4");
    let folder = sweep_of(&few);
    folder.ran(&format!("{SWEEP} --shard 1/2")).good();
    let before = contents(&folder, "out/chunks");
    let refused = |what: &str| {
        has(&folder.ran(SWEEP).fails(2), &[what, "--out", "put it back"]);
        assert_eq!(contents(&folder, "out/chunks"), before);
    };
    sweep_file(&folder, &few.replace("0.3]", "0.4]"));
    refused("vary of the sweep file was");
    sweep_file(&folder, &few.replace("seed = 7", "seed = 8"));
    refused("seed of the sweep file was 7, and is 8");
    sweep_file(&folder, &few);
    folder.put("short.toml", crate::run::short() + "# another\n");
    refused("short.toml has changed since");
    sweep_file(&folder, &few);
    let own = folder.text("out/sweep.json");
    let of_another = edited(&own, &[("\"sha256\": \"", "\"sha256\": \"0")]);
    folder.put("out/sweep.json", of_another);
    refused("the program has been built anew");
    folder.put("out/sweep.json", own);

    for (worst, says) in [(1, ""), (2, "nothing was left to run")] {
        sweep_file(&folder, &format!("worst = {worst}\n{few}"));
        has(&folder.ran(SWEEP).good(), &[says]);
        let mut kept = folder.names("out");
        kept.retain(|name| name.starts_with("worst"));
        assert_eq!(kept.len(), worst);
    }

    fs::create_dir_all(folder.at("strange/chunks")).unwrap();
    let refused = folder.ran("sweep sweep.toml --out strange").fails(2);
    has(&refused, &["no sweep.json"]);
}
