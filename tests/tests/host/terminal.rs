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
            "--set",
            "run.duration_s=0.1",
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

fn stdout(args: &[String]) -> String {
    let output = host().args(args).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// The same on a terminal of so many columns, without its colours; `None` without a program that makes one.
fn on_a_terminal(args: &[String], columns: usize) -> Option<String> {
    let text = on_a_terminal_with(args, columns, &[])?;
    // All sequences that this program writes end in `m`.
    let parts = text.split("\u{1b}[").enumerate();
    let bare = parts.map(|(i, part)| match i {
        0 => part,
        _ => part.split_once('m').unwrap().1,
    });
    Some(bare.collect())
}

/// As it comes, with some variables of the environment.
fn on_a_terminal_with(
    args: &[String],
    columns: usize,
    environment: &[(&str, &str)],
) -> Option<String> {
    let quoted: Vec<String> = args.iter().map(|arg| format!("'{arg}'")).collect();
    let program = host().get_program().to_string_lossy().into_owned();
    let command = format!(
        "stty cols {columns} rows 50; '{program}' {}",
        quoted.join(" ")
    );
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &command, "/dev/null"]);
    script.env("SHELL", "/bin/sh").env("TERM", "xterm-256color");
    for name in COLOUR_VARIABLES {
        script.env_remove(name);
    }
    let Ok(output) = script.envs(environment.iter().copied()).output() else {
        skipped("script, of util-linux, is not installed");
        return None;
    };
    assert!(output.status.success(), "{output:?}");
    Some(String::from_utf8(output.stdout).unwrap().replace('\r', ""))
}

/// What decides elsewhere whether there are colours.
const COLOUR_VARIABLES: [&str; 4] = ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "CI"];

/// In a pipe or a file, whatever the terminal is.
#[test]
fn tables_fit_eighty_columns() {
    let folder = TempDir::new().unwrap();
    for args in commands(folder.path()) {
        let text = stdout(&args);
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
    let whole = stdout(&run);
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

/// Verdicts have colours on a terminal, and nowhere else: not where the user or the terminal has none, not in pipes and files, and
/// never in JSON.
#[test]
fn verdicts_have_colours_on_a_terminal_alone() {
    const ESCAPE: char = '\u{1b}';
    const GOOD: &str = "\u{1b}[1m\u{1b}[32m";
    const BAD: &str = "\u{1b}[1m\u{1b}[31m";
    let folder = TempDir::new().unwrap();
    let scene = path(&scene_path("impact_at_40_hz"));
    let out = path(&folder.path().join("run"));
    let run = arguments(&["run", &scene, "--no-trace", "--out", &out]);
    let record = path(&folder.path().join("run/record_supervisor.bin"));
    let json = |args: &[String]| [args, &arguments(&["--json"])].concat();

    let Some(text) = on_a_terminal_with(&run, 100, &[]) else {
        return;
    };
    for word in [format!("{GOOD}recovered"), format!("{BAD}whirl")] {
        assert!(text.contains(&word), "{word} in {text}");
    }
    // The supervisor's word is the first of them.
    assert!(text.find(GOOD) < text.find(BAD), "{text}");
    let review = arguments(&["review", &record]);
    let reviewed = on_a_terminal_with(&review, 100, &[]).unwrap();
    let verdict = format!("{GOOD}Nothing speaks against running on.\u{1b}[0m");
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&reviewed).contains(&verdict), "{reviewed}");

    for args in [&run, &review] {
        for without in [("NO_COLOR", "1"), ("TERM", "dumb"), ("CLICOLOR", "0")] {
            let text = on_a_terminal_with(args, 100, &[without]).unwrap();
            assert!(!text.contains(ESCAPE), "{without:?}: {text}");
        }
        let text = on_a_terminal_with(&json(args), 100, &[]).unwrap();
        assert!(!text.contains(ESCAPE), "{text}");
        let mut piped = host();
        piped.args(args).env("TERM", "xterm-256color");
        let piped = piped.env("CLICOLOR_FORCE", "1").output().unwrap();
        assert!(!piped.stdout.contains(&(ESCAPE as u8)), "{piped:?}");
    }
    for file in ["verdict.json", "report.html"] {
        let written = std::fs::read(folder.path().join("run").join(file)).unwrap();
        assert!(!written.contains(&(ESCAPE as u8)), "{file}");
    }
}
