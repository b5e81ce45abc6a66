//! The recipes for other people's tools: Snakemake runs its own, SALib reads results, Dask's is read.

use super::{DRAWS, contents, succeeds, sweep, sweep_file};
use crate::own_controllers::python;
use std::path::Path;
use std::process::{Command, Output};
use system_tests::target::skipped;
use system_tests::{host, root};
use tempfile::TempDir;

/// The recipe on a sweep, in parts, as a user types it.
fn snakemake(tool: &Path, folder: &Path, (sweep, out): (&Path, &Path)) -> Output {
    let program = host();
    let programs = Path::new(program.get_program()).parent().unwrap();
    let path = std::env::var("PATH").unwrap_or_default();
    let mut command = Command::new(tool);
    command
        .args(["--cores", "2", "--snakefile"])
        .arg(root().join("firmware-host/scenes/sweeps/Snakefile"))
        .arg("--config")
        .arg(format!("sweep={}", sweep.display()))
        .arg(format!("folder={}", out.display()))
        .arg("parts=3");
    // What it keeps for itself goes there, too.
    command
        .env("PATH", format!("{}:{path}", programs.display()))
        .env("HOME", folder)
        .env("XDG_CACHE_HOME", folder)
        .current_dir(folder);
    command.output().unwrap()
}

#[test]
fn snakemake_makes_the_bytes_of_one_machine() {
    let tool = root().join("target/tests-venv/bin/snakemake");
    if !tool.is_file() {
        return skipped("snakemake is not there");
    }
    let folder = TempDir::new().unwrap();
    let file = sweep_file(folder.path(), DRAWS);
    let (parts, whole) = (folder.path().join("my parts"), folder.path().join("whole"));
    succeeds(&sweep(&file, &whole, &[]));

    let first = snakemake(&tool, folder.path(), (&file, &parts));
    let text = succeeds(&first) + &String::from_utf8_lossy(&first.stderr);
    // Three parts and the whole, for which nothing was left.
    assert!(text.contains("4 of 4 steps (100%) done"), "{text}");
    assert!(text.contains("nothing was left to run"), "{text}");
    assert!(contents(&parts) == contents(&whole));

    let again = snakemake(&tool, folder.path(), (&file, &parts));
    let text = succeeds(&again) + &String::from_utf8_lossy(&again.stderr);
    assert!(text.contains("Nothing to be done"), "{text}");
}

/// As the page has it.
#[test]
fn salib_reads_the_results() {
    let Some(python) = system_tests::python() else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let draws = "design = \"monte_carlo\"\nruns = 200\n\
        [[vary]]\nkey = \"start.velocity_m_s[0]\"\nuniform = [0.1, 0.5]\n\
        [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.2]\n";
    let file = sweep_file(folder.path(), draws);
    succeeds(&sweep(&file, &folder.path().join("runs/sweep"), &[]));

    let page = std::fs::read_to_string(root().join("docs/src/host/sweep.md")).unwrap();
    let (_, recipe) = page.split_once("```python\n").unwrap();
    let (recipe, _) = recipe.split_once("```").unwrap();
    // And of a figure that is known: all of it hangs on the first key.
    let known = "s = rbd_fast.analyze(problem, x, x[:, 0] ** 2)['S1']\nassert y.std() > 0 and s[0] > 0.9 and s[1] < 0.2, s\n";
    let ran = Command::new(python)
        .args(["-c", &format!("{recipe}{known}")])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let text = succeeds(&ran);
    assert!(text.contains("delta") && text.contains("S1"), "{text}");
}

#[test]
fn the_recipe_for_dask_is_python() {
    if !python() {
        return;
    }
    let recipe = root().join("firmware-host/scenes/sweeps/parts_by_dask.py");
    let parse = "import ast, sys; ast.parse(open(sys.argv[1]).read())";
    let parsed = Command::new("python3")
        .args(["-c", parse])
        .arg(recipe)
        .output()
        .unwrap();
    succeeds(&parsed);
}
