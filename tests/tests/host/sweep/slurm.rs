//! The job script on a real Slurm of two nodes, one of which is lost on the way.

use super::{contents, succeeds, sweep, sweep_file};
use std::collections::BTreeMap;
use std::fs;
use std::process::Output;
use std::time::{Duration, Instant};
use system_tests::slurm::{Cluster, available};
use system_tests::target::skipped;
use system_tests::{host, root};
use tempfile::TempDir;

fn stdout(output: &Output) -> String {
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Node and state of every task that has not ended, by name.
fn queue(cluster: &Cluster) -> Vec<(String, String, String)> {
    let mut squeue = cluster.command("squeue");
    squeue.args(["--noheader", "--array", "--format=%i %T %N"]);
    let text = stdout(&squeue.output().unwrap());
    let line = |line: &str| {
        let mut words = line.split_whitespace().map(str::to_owned);
        let (name, state) = (words.next()?, words.next()?);
        Some((name, state, words.next().unwrap_or_default()))
    };
    text.lines().filter_map(line).collect()
}

/// What Slurm remembers of each task: how often it was started again, and how it ended.
fn ends(cluster: &Cluster) -> BTreeMap<String, (u32, String)> {
    let mut scontrol = cluster.command("scontrol");
    scontrol.args(["--oneliner", "show", "job"]);
    let text = stdout(&scontrol.output().unwrap());
    let value = |line: &str, key: &str| {
        let words = line.split_whitespace();
        words
            .filter_map(|word| word.strip_prefix(key))
            .map(str::to_owned)
            .next()
    };
    let task = |line: &str| {
        let restarts = value(line, "Restarts=")?.parse().ok()?;
        Some((
            value(line, "ArrayTaskId=")?,
            (restarts, value(line, "JobState=")?),
        ))
    };
    text.lines().filter_map(task).collect()
}

const RUNS: usize = 6_400;
const TASKS: usize = 16;

#[test]
fn an_array_that_loses_a_node_merges_to_the_bytes_of_one_machine() {
    if let Err(missing) = available() {
        return skipped(&missing);
    }
    let folder = TempDir::new().unwrap();
    let lines = format!(
        "design = \"monte_carlo\"\nruns = {RUNS}\nseed = 3\nworst = 2\n\
        [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.3]\n"
    );
    let file = sweep_file(folder.path(), &lines);
    let (parts, whole) = (folder.path().join("parts"), folder.path().join("whole"));
    succeeds(&sweep(&file, &whole, &[]));

    let mut cluster = Cluster::start().unwrap();
    // The script calls the program by its name, and asks for more than these nodes have.
    let program = host();
    let programs = std::path::Path::new(program.get_program())
        .parent()
        .unwrap();
    let path = std::env::var("PATH").unwrap_or_default();
    let mut sbatch = cluster.command("sbatch");
    sbatch
        .env("PATH", format!("{}:{path}", programs.display()))
        .current_dir(folder.path())
        .args([
            "--parsable",
            "--cpus-per-task=1",
            "--mem=0",
            "--output=%a.log",
        ])
        .arg(format!("--array=1-{TASKS}"))
        .arg(root().join("firmware-host/scenes/sweeps/slurm.sh"))
        .args([&file, &parts]);
    stdout(&sbatch.output().unwrap());

    // Some tasks are done, and one runs on the node that is lost: once that is frozen it cannot end any more.
    let until = Instant::now() + Duration::from_secs(240);
    let late = |cluster: &Cluster| {
        let logs = (1..=TASKS).map(|i| {
            fs::read_to_string(folder.path().join(format!("{i}.log"))).unwrap_or_default()
        });
        format!(
            "{:?}\n{}\n{}",
            queue(cluster),
            cluster.logs(),
            logs.collect::<String>()
        )
    };
    let on_two = |cluster: &Cluster| {
        let tasks = queue(cluster);
        let left = tasks.len();
        let mut tasks = tasks.into_iter();
        let (name, ..) = tasks.find(|(_, state, node)| state == "RUNNING" && node == "two")?;
        Some((name, left))
    };
    let lost = loop {
        assert!(Instant::now() < until, "{}", late(&cluster));
        if let Some((name, _)) = on_two(&cluster).filter(|(_, left)| *left <= TASKS - 4) {
            cluster.freeze("two", true);
            // What was said of its end before has arrived by then.
            std::thread::sleep(Duration::from_millis(500));
            if on_two(&cluster).is_some_and(|(still, _)| still == name) {
                break name;
            }
            cluster.freeze("two", false);
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    cluster.lose("two");
    while !queue(&cluster).is_empty() {
        assert!(Instant::now() < until, "{}", late(&cluster));
        std::thread::sleep(Duration::from_millis(200));
    }
    let ends = ends(&cluster);
    assert_eq!(ends.len(), TASKS);
    assert!(
        ends.values().all(|(_, state)| state == "COMPLETED"),
        "{ends:?}"
    );
    let (_, task) = lost.rsplit_once('_').unwrap();
    assert_eq!(ends[task].0, 1, "task {task} was started again: {ends:?}");

    succeeds(&sweep(&file, &parts, &[]));
    assert_eq!(contents(&parts), contents(&whole));
}
