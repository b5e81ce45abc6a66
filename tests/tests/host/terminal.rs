//! What the commands print for a person fits a terminal.

use std::process::Command;
use system_tests::ran::{Folder, has, lacks, ran};
use system_tests::target::skipped;
use system_tests::terminal::{assert_fits, tables};

/// Commands with tables, quick ones, in a folder. The others are looked at where they run anyway.
const COMMANDS: [&str; 8] = [
    "run @impact_at_40_hz --verify --set run.duration_s=0.1 --no-trace --out run",
    "run @machines/drop_of_both_ends --no-trace --out drop",
    "review run/record_supervisor.bin",
    "review run/record_supervisor.bin --scene @impact_at_40_hz --set supervisor.hold_share=0.5",
    "sensitivity @overload_then_release --draws 1",
    "advise @impact_at_40_hz",
    "advise @machines/overload_of_a_flexible_rotor",
    "modes @machines/drop_of_both_ends",
];
const RUN: &str = "run @impact_at_40_hz --no-trace --out run";

/// The same on a terminal of so many columns, without its colours; `None` without a program that makes one.
fn on_a_terminal(folder: &Folder, line: &str, columns: usize) -> Option<String> {
    let text = on_a_terminal_with(folder, line, columns, &[])?;
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
    folder: &Folder,
    line: &str,
    columns: usize,
    environment: &[(&str, &str)],
) -> Option<String> {
    let command = folder.command(line);
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let quoted: Vec<String> = words.map(|word| format!("'{}'", word.display())).collect();
    let command = format!("stty cols {columns} rows 50; {}", quoted.join(" "));
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &command, "/dev/null"]);
    script.env("SHELL", "/bin/sh").env("TERM", "xterm-256color");
    for name in COLOUR_VARIABLES {
        script.env_remove(name);
    }
    script.current_dir(folder.at("."));
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
    let folder = Folder::fresh();
    for line in COMMANDS {
        let text = folder.ran(line).good();
        assert_fits(&text, 80);
        assert!(
            line.starts_with("advise") || tables(&text) > 0,
            "{line}: {text}"
        );
    }
}

/// On a terminal sentences are broken between words, too.
#[test]
fn all_fits_the_terminal_and_uses_its_width() {
    let folder = Folder::fresh();
    let mut widest = 0;
    for command in COMMANDS {
        for columns in [60, 80, 200] {
            let Some(text) = on_a_terminal(&folder, command, columns) else {
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
                assert!(width <= columns, "{command}: {width} of {columns}: {line}");
                widest = widest.max(width);
            }
        }
    }
    assert!(widest > 80, "{widest}");
}

/// A table that is parted says in each part which row it is, and no figure is broken.
#[test]
fn a_narrow_terminal_loses_nothing() {
    let folder = Folder::fresh();
    let whole = folder.ran(RUN).good();
    let Some(narrow) = on_a_terminal(&folder, RUN, 44) else {
        return;
    };
    assert!(tables(&narrow) > tables(&whole), "{narrow}");
    assert_fits(&narrow, 44);
    // The supervisor comes first, and every figure of its column is there.
    let rows = whole.lines().filter(|line| line.starts_with(' ')).skip(1);
    // How long it takes is never the same.
    let rows = rows.filter(|row| !row.starts_with(" run time") && !row.starts_with(" ratio"));
    for row in rows {
        let cells = row.split("  ").map(str::trim);
        has(
            &narrow,
            &[cells.filter(|cell| !cell.is_empty()).nth(1).unwrap()],
        );
    }
    let heading = whole.lines().find(|line| line.contains("policy")).unwrap();
    let [first, second] = ["supervisor", "passive"].map(|policy| heading.find(policy).unwrap());
    assert!(first < second, "{heading}");
}

/// Verdicts have colours on a terminal, and nowhere else: not where the user or the terminal has none, not in pipes and files, and
/// never in JSON.
#[test]
fn verdicts_have_colours_on_a_terminal_alone() {
    const ESCAPE: &str = "\u{1b}";
    const GOOD: &str = "\u{1b}[1m\u{1b}[32m";
    const BAD: &str = "\u{1b}[1m\u{1b}[31m";
    let folder = Folder::fresh();
    let Some(text) = on_a_terminal_with(&folder, RUN, 100, &[]) else {
        return;
    };
    has(
        &text,
        &[&format!("{GOOD}recovered"), &format!("{BAD}whirl")],
    );
    // The supervisor's word is the first of them.
    assert!(text.find(GOOD) < text.find(BAD), "{text}");
    let review = "review run/record_supervisor.bin";
    let reviewed = on_a_terminal_with(&folder, review, 100, &[]).unwrap();
    let verdict = format!("{GOOD}Nothing speaks against running on.\u{1b}[0m");
    let words = reviewed.split_whitespace().collect::<Vec<_>>();
    has(&words.join(" "), &[&verdict]);

    for line in [RUN, review] {
        for without in [("NO_COLOR", "1"), ("TERM", "dumb"), ("CLICOLOR", "0")] {
            let text = on_a_terminal_with(&folder, line, 100, &[without]).unwrap();
            lacks(&text, &[ESCAPE]);
        }
        let json = format!("{line} --json");
        let text = on_a_terminal_with(&folder, &json, 100, &[]).unwrap();
        lacks(&text, &[ESCAPE]);
        let mut piped = folder.command(line);
        piped.env("TERM", "xterm-256color");
        lacks(&ran(piped.env("CLICOLOR_FORCE", "1")).printed, &[ESCAPE]);
    }
    for file in ["run/verdict.json", "run/report.html"] {
        lacks(&folder.text(file), &[ESCAPE]);
    }
}
