//! What the commands print for a person fits a terminal.

use std::path::{Path, PathBuf};
use std::process::Command;
use system_tests::target::skipped;
use system_tests::terminal::{assert_fits, tables};
use system_tests::{host, machine_scene_path, scene_path};
use tempfile::TempDir;

fn arguments(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

fn path(path: &Path) -> String {
    path.display().to_string()
}

/// Commands with tables, quick ones, each in a folder of its own. The others are looked at where they run anyway.
fn commands(folder: &Path) -> Vec<Vec<String>> {
    let here = |name: &str| path(&folder.join(name));
    let scene = path(&scene_path("impact_at_40_hz"));
    let overload = path(&scene_path("overload_then_release"));
    let [drop, magnets] = ["drop_of_both_ends", "overload_of_a_flexible_rotor"]
        .map(|name| path(&machine_scene_path(name)));
    let record = here("run/record_supervisor.bin");
    [
        &[
            "run",
            &scene,
            "--verify",
            "--no-trace",
            "--out",
            &here("run"),
        ][..],
        &["run", &drop, "--no-trace", "--out", &here("drop")],
        &["review", &record],
        &[
            "review",
            &record,
            "--scene",
            &scene,
            "--set",
            "supervisor.hold_share=0.5",
        ],
        &["sensitivity", &overload, "--draws", "1"],
        &["advise", &scene],
        &["advise", &magnets],
        &["modes", &drop],
    ]
    .map(arguments)
    .to_vec()
}

fn said(args: &[String]) -> String {
    let output = host().args(args).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// The same on a terminal of so many columns; `None` without a program that makes one.
fn on_a_terminal(args: &[String], columns: usize) -> Option<String> {
    let quoted: Vec<String> = args.iter().map(|arg| format!("'{arg}'")).collect();
    let program = host().get_program().to_string_lossy().into_owned();
    let command = format!(
        "stty cols {columns} rows 50; '{program}' {}",
        quoted.join(" ")
    );
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &command, "/dev/null"]);
    let Ok(output) = script.env("SHELL", "/bin/sh").output() else {
        skipped("script, of util-linux, is not installed");
        return None;
    };
    assert!(output.status.success(), "{output:?}");
    Some(String::from_utf8(output.stdout).unwrap().replace('\r', ""))
}

/// In a pipe or a file, whatever the terminal is.
#[test]
fn tables_fit_eighty_columns() {
    let folder = TempDir::new().unwrap();
    for args in commands(folder.path()) {
        let text = said(&args);
        assert_fits(&text, 80);
        assert!(args[0] == "advise" || tables(&text) > 0, "{args:?}: {text}");
    }
}

/// On a terminal sentences are broken between words, too.
#[test]
fn all_fits_the_terminal_and_uses_its_width() {
    let folder = TempDir::new().unwrap();
    let mut widest = 0;
    for args in commands(folder.path()) {
        for columns in [60, 80, 200] {
            let Some(text) = on_a_terminal(&args, columns) else {
                return;
            };
            let lines = text.lines().filter(|line| !line.contains("firmware-host "));
            // A path is one word, and stays whole.
            let words = |line: &&str| line.trim().contains(' ');
            for line in lines
                .filter(words)
                .filter(|line| !line.starts_with("report: "))
            {
                let width = line.chars().count();
                assert!(width <= columns, "{args:?}: {width} of {columns}: {line}");
                widest = widest.max(width);
            }
        }
    }
    assert!(widest > 80, "{widest}");
}

/// A table that is parted says in each part which row it is, and no figure is broken.
#[test]
fn a_narrow_terminal_loses_nothing() {
    let folder = TempDir::new().unwrap();
    let scene = path(&scene_path("impact_at_40_hz"));
    let out: PathBuf = folder.path().join("run");
    let run = arguments(&["run", &scene, "--no-trace", "--out", &path(&out)]);
    let whole = said(&run);
    let Some(narrow) = on_a_terminal(&run, 44) else {
        return;
    };
    assert!(tables(&narrow) > tables(&whole), "{narrow}");
    assert_fits(&narrow, 44);
    // The supervisor comes first, and every figure of its column is there.
    let rows = whole.lines().filter(|line| line.starts_with(' ')).skip(1);
    // How long it takes is never the same.
    let rows = rows.filter(|row| !row.starts_with(" run time") && !row.starts_with(" ratio"));
    for row in rows {
        let mut cells = row
            .split("  ")
            .map(str::trim)
            .filter(|cell| !cell.is_empty());
        let figure = cells.nth(1).unwrap();
        assert!(narrow.contains(figure), "{figure} in {narrow}");
    }
    let heading = whole.lines().find(|line| line.contains("policy")).unwrap();
    assert!(
        heading.find("supervisor").unwrap() < heading.find("passive").unwrap(),
        "{heading}"
    );
}
