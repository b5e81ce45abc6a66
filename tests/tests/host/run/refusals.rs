//! What is refused, and what it says then.

use super::{RUN, short, short_scene};
use crate::refusals::all;
use std::fs;
use system_tests::ran::{Folder, edited, has};

/// What `run` says of a scene: of the line that the row has changed, with nothing left behind, and a guess only where there is one.
pub(super) fn refused(scene: &str, row: &[String]) -> String {
    let folder = Folder::fresh();
    folder.put("short.toml", scene);
    let last_key = row[2].rsplit('.').next().unwrap();
    let last_key = last_key.split('[').next().unwrap();
    let changed = |l: &str| row[1].lines().any(|t| !t.is_empty() && l.contains(t));
    let at = |l: &str| changed(l) && l.contains(last_key);
    let line = scene.lines().count() - scene.lines().rev().position(at).unwrap();
    let said = folder.ran(RUN).refused();
    let at_line = said.contains(&format!("short.toml:{line}:"));
    assert!(at_line, "{row:?}: not line {line} in\n{said}");
    let guess = "did you mean";
    let guessed = row.iter().any(|word| word.contains(guess));
    assert_eq!(said.contains(guess), guessed, "{row:?}\n{said}");
    assert_eq!(folder.names("."), ["short.toml"], "{row:?}");
    said
}

#[test]
fn bad_scenes_are_refused_with_file_line_key_and_expectation() {
    all("runs/refused", 49, &short(), refused);
}

/// What `[supervisor]` says is checked whether or not that policy is run, with the line: a slip of the pen
/// would otherwise show only once somebody adds the policy. A parameter that is derived from the scene is
/// no mistake there, as nobody asks for it.
#[test]
fn parameters_of_a_supervisor_that_is_not_run_are_checked_too() {
    let without = edited(&short(), &[(", \"supervisor\"]", "]")]);
    all("runs/without_the_supervisor", 5, &without, refused);
    // A lag that the supervisor could not take is no mistake of a scene without it.
    let slow = without.replacen("lag_s = 1.6e-4", "lag_s = 0.5", 1);
    for good in [without + "\n[supervisor]\nhold_share = 0.7\n", slow] {
        let folder = Folder::fresh();
        folder.put("short.toml", good);
        folder.ran(RUN).good();
    }
}

#[test]
fn missing_scenes_and_unwritable_folders_are_refused() {
    let folder = short_scene(&[]);
    let refused = |line: &str, says: &str| has(&folder.ran(line).refused(), &[says]);
    // A file where a folder should be stops everyone, also the superuser.
    for out in [
        "short.toml",
        "short.toml/below_a_file",
        "/proc/no_folder_here/out",
    ] {
        refused(
            &format!("run short.toml --out {out}"),
            "cannot write results",
        );
        assert_eq!(folder.names("."), ["short.toml"]);
    }
    // So does a folder where a file should be: nothing is written beside it.
    fs::create_dir_all(folder.at("out/report.html")).unwrap();
    refused(RUN, "report.html: is a directory");
    assert_eq!(folder.names("out"), ["report.html"]);
    // One byte of another encoding.
    folder.put("latin.toml", b"# a\ntitle = \"St\xf6rung\"\n");
    refused(
        "run latin.toml --out none",
        "latin.toml:2: is no UTF-8 text",
    );
}
