//! `sweep`: the same bytes however it is stopped, split and spread over threads, and rows that say what `run` says.

mod page;
mod refusals;
mod rows;
mod salib;

use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};
use system_tests::ran::{Folder, has, number, ran};
use system_tests::{host, root};

/// A sweep of a short scene, with these lines between its head and nothing else, in `sweep.toml`.
fn sweep_file(folder: &Folder, lines: &str) {
    folder.put("short.toml", crate::run::short());
    let head = "scene = \"short.toml\"\npolicies = [\"levitation\", \"supervisor\"]\n";
    folder.put("sweep.toml", format!("{head}{lines}"));
}

/// The same in a folder of its own.
fn sweep_of(lines: &str) -> Folder {
    let folder = Folder::fresh();
    sweep_file(&folder, lines);
    folder
}

const SWEEP: &str = "sweep sweep.toml --out out";

/// Independent draws of friction, and of a word.
const DRAWS: &str = "design = \"monte_carlo\"\nruns = 70\nseed = 7\n\
    [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.3]\n\
    [[vary]]\nkey = \"run.method\"\nvalues = [\"series\", \"collocation\"]\n";

/// All that a sweep leaves in a folder, by name.
fn contents(folder: &Folder, out: &str) -> Vec<(String, Vec<u8>)> {
    let names = folder.names(out).into_iter();
    names
        .map(|name| (name.clone(), folder.bytes(&format!("{out}/{name}"))))
        .collect()
}

fn chunks(folder: &Folder) -> Vec<String> {
    let mut names = match folder.at("out/chunks").exists() {
        true => folder.names("out/chunks"),
        false => Vec::new(),
    };
    names.retain(|name| name.ends_with(".parquet"));
    names
}

#[test]
fn neither_threads_nor_parts_change_a_byte() {
    let folder = sweep_of(DRAWS);
    let sweep = |out: &str, more: &str| folder.ran(&format!("sweep sweep.toml --out {out} {more}"));
    let text = sweep("one", "--threads 1").good();
    has(&text, &["70 runs, monte_carlo", "140 rows"]);
    let whole = contents(&folder, "one");
    let names = folder.names("one");
    let first = [
        "report.html",
        "results.parquet",
        "summary.json",
        "sweep.json",
    ];
    assert_eq!(names[..4], first);
    assert_eq!(names.len(), 7, "three of the worst: {names:?}");
    sweep("three", "--threads 3").good();
    assert!(whole == contents(&folder, "three"), "threads");

    // Parts in folders of their own, put together.
    for part in ["1", "2", "3"] {
        let said = sweep(part, &format!("--shard {part}/3")).good();
        has(&said, &["runs of this part are done"]);
    }
    let missing = sweep("merged", "--merge 1").fails(2);
    has(&missing, &["chunks are in none of the folders"]);
    sweep("merged", "--merge 1 2 3").good();
    assert!(
        whole == contents(&folder, "merged"),
        "parts in folders of their own"
    );

    // Parts in one folder, as tasks of a job array, by the script that the documentation shows.
    fs::create_dir(folder.at("bin")).unwrap();
    std::os::unix::fs::symlink(host().get_program(), folder.at("bin/firmware-host")).unwrap();
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", folder.at("bin").display());
    for task in ["1", "2", "3"] {
        let mut job = Command::new("sh");
        job.arg(root().join("firmware-host/scenes/sweeps/slurm.sh"));
        job.arg(folder.at("sweep.toml")).arg(folder.at("array"));
        job.env("PATH", &path).env("SLURM_CPUS_PER_TASK", "2");
        job.env("SLURM_ARRAY_TASK_ID", task);
        job.env("SLURM_ARRAY_TASK_MIN", "1");
        ran(job.env("SLURM_ARRAY_TASK_COUNT", "3")).good();
    }
    has(&sweep("array", "").good(), &["nothing was left to run"]);
    assert!(whole == contents(&folder, "array"), "parts in one folder");
}

#[test]
fn killed_at_any_moment_it_goes_on_with_the_same_bytes() {
    let folder = sweep_of(&DRAWS.replace("runs = 70", "runs = 300"));
    let mut before = 0;
    for more in [5, 1, 9, 7, 3] {
        let mut child = folder
            .command(&format!("{SWEEP} --threads 1"))
            .spawn()
            .unwrap();
        let begun = Instant::now();
        while chunks(&folder).len() < before + more && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let now = chunks(&folder).len();
        assert!(now >= before + more, "{before}, {now}");
        assert!(!folder.at("out/results.parquet").exists());
        before = now;
    }
    // A chunk that a disk has lost is run again.
    folder.put(&format!("out/chunks/{}", chunks(&folder)[0]), "");
    let done = folder.ran(&format!("{SWEEP} --json")).json();
    assert_eq!((&done["runs"], &done["failed"]), (&300.into(), &0.into()));
    let now = done["runs_now"].as_u64().unwrap();
    let most = 300 - 4 * (before as u64 - 1);
    assert!(now > 0 && now <= most, "{now} after {before} chunks of 4");
    assert!(number(&done["seconds"]) > 0.0 && number(&done["runs_per_second"]) > 0.0);
    folder.ran("sweep sweep.toml --out whole").good();
    assert!(contents(&folder, "out") == contents(&folder, "whole"));
}
