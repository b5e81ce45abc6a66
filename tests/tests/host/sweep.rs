//! `sweep`: the same bytes however it is stopped, split and spread over threads, and rows that say what `run` says.

mod page;
mod refusals;
mod rows;
mod salib;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};
use system_tests::{host, root};
use tempfile::TempDir;

/// A sweep of a short scene, with these lines between its head and nothing else.
fn sweep_file(folder: &Path, lines: &str) -> PathBuf {
    fs::write(folder.join("short.toml"), crate::run::short()).expect("a writable folder");
    let path = folder.join("sweep.toml");
    let head = "scene = \"short.toml\"\npolicies = [\"levitation\", \"supervisor\"]\n";
    fs::write(&path, format!("{head}{lines}")).expect("a writable folder");
    path
}

/// Independent draws of friction, and of a word.
const DRAWS: &str = "design = \"monte_carlo\"\nruns = 70\nseed = 7\n\
    [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.3]\n\
    [[vary]]\nkey = \"run.method\"\nvalues = [\"series\", \"collocation\"]\n";

fn sweep_command(sweep: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = host();
    command
        .arg("sweep")
        .arg(sweep)
        .arg("--out")
        .arg(out)
        .args(more);
    command
}

fn sweep(sweep: &Path, out: &Path, more: &[&str]) -> Output {
    sweep_command(sweep, out, more)
        .output()
        .expect("the host starts")
}

fn succeeds(result: &Output) -> String {
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{error}");
    String::from_utf8(result.stdout.clone()).expect("text")
}

/// All that a sweep leaves in a folder, by name.
fn contents(out: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<(String, Vec<u8>)> = (fs::read_dir(out).expect("a folder"))
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, fs::read(&path).expect("a file"))
        })
        .collect();
    all.sort();
    all
}

fn chunks(out: &Path) -> usize {
    let files = fs::read_dir(out.join("chunks")).into_iter().flatten();
    let names = files.map(|entry| entry.unwrap().file_name());
    names
        .filter(|name| name.to_string_lossy().ends_with(".parquet"))
        .count()
}

#[test]
fn neither_threads_nor_parts_change_a_byte() {
    let folder = TempDir::new().unwrap();
    let file = sweep_file(folder.path(), DRAWS);
    let out = |name: &str| folder.path().join(name);
    let text = succeeds(&sweep(&file, &out("one"), &["--threads", "1"]));
    assert!(
        text.contains("70 runs, monte_carlo") && text.contains("140 rows"),
        "{text}"
    );
    let whole = contents(&out("one"));
    let names: Vec<&str> = whole.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names[..4],
        [
            "report.html",
            "results.parquet",
            "summary.json",
            "sweep.json"
        ]
    );
    assert_eq!(names.len(), 7, "three of the worst: {names:?}");
    succeeds(&sweep(&file, &out("three"), &["--threads", "3"]));
    assert!(whole == contents(&out("three")), "threads");

    // Parts in folders of their own, put together.
    for part in ["1/3", "2/3", "3/3"] {
        let shown = succeeds(&sweep(&file, &out(&part[..1]), &["--shard", part]));
        assert!(shown.contains("runs of this part are done"), "{shown}");
    }
    let missing = sweep(
        &file,
        &out("merged"),
        &["--merge", out("1").to_str().unwrap()],
    );
    assert_eq!(missing.status.code(), Some(2));
    let error = String::from_utf8_lossy(&missing.stderr);
    assert!(
        error.contains("chunks are in none of the folders"),
        "{error}"
    );
    let parts = ["1", "2", "3"].map(|part| out(part).display().to_string());
    let all = ["--merge", &parts[0], &parts[1], &parts[2]];
    succeeds(&sweep(&file, &out("merged"), &all));
    assert!(
        whole == contents(&out("merged")),
        "parts in folders of their own"
    );

    // Parts in one folder, as tasks of a job array, by the script that the documentation shows.
    let bin = out("bin");
    fs::create_dir(&bin).unwrap();
    std::os::unix::fs::symlink(host().get_program(), bin.join("firmware-host")).unwrap();
    for task in ["1", "2", "3"] {
        let mut job = Command::new("sh");
        let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
        job.arg(root().join("firmware-host/scenes/sweeps/slurm.sh"));
        job.arg(&file).arg(out("array")).env("PATH", path);
        job.env("SLURM_ARRAY_TASK_ID", task)
            .env("SLURM_ARRAY_TASK_MIN", "1");
        job.env("SLURM_ARRAY_TASK_COUNT", "3")
            .env("SLURM_CPUS_PER_TASK", "2");
        succeeds(&job.output().unwrap());
    }
    let last = succeeds(&sweep(&file, &out("array"), &[]));
    assert!(last.contains("nothing was left to run"), "{last}");
    assert!(whole == contents(&out("array")), "parts in one folder");
}

#[test]
fn killed_at_any_moment_it_goes_on_with_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let file = sweep_file(folder.path(), &DRAWS.replace("runs = 70", "runs = 300"));
    let (out, whole) = (folder.path().join("killed"), folder.path().join("whole"));
    let mut before = 0;
    for more in [5, 1, 9, 7, 3] {
        let mut child = sweep_command(&file, &out, &["--threads", "1"])
            .spawn()
            .unwrap();
        let begun = Instant::now();
        while chunks(&out) < before + more && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let now = chunks(&out);
        assert!(
            now >= before + more && !out.join("results.parquet").exists(),
            "{before}, {now}"
        );
        before = now;
    }
    // A chunk that a disk has lost is run again.
    let lost = fs::read_dir(out.join("chunks"))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let lost = lost
        .filter(|path| path.extension().is_some_and(|x| x == "parquet"))
        .min()
        .unwrap();
    fs::write(lost, []).unwrap();
    let text = succeeds(&sweep(&file, &out, &["--json"]));
    let done: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&done["runs"], &done["failed"]), (&300.into(), &0.into()));
    let now = done["runs_now"].as_u64().unwrap();
    assert!(
        now > 0 && now <= 300 - 4 * (before as u64 - 1),
        "{now} after {before} chunks of 4"
    );
    assert!(
        done["seconds"].as_f64().unwrap() > 0.0 && done["runs_per_second"].as_f64().unwrap() > 0.0
    );
    succeeds(&sweep(&file, &whole, &[]));
    assert!(contents(&out) == contents(&whole));
}
