//! What is refused is data, in `refusals/`: what of something good is replaced, by what, and what is said of it then.

use firmware_bench::scene::Scene;
use std::collections::BTreeMap;
use std::fs;
use std::process::Stdio;
use system_tests::{host, root, scene_path};
use tempfile::TempDir;

/// Rows of a table, "file/table". They are counted: one that is lost would be missed by nobody.
pub(crate) fn rows(table: &str, count: usize) -> Vec<Vec<String>> {
    let (file, name) = table.split_once('/').unwrap();
    let path = root().join(format!("tests/tests/host/refusals/{file}.toml"));
    let text = fs::read_to_string(path).unwrap();
    let mut tables: BTreeMap<String, Vec<Vec<String>>> = toml::from_str(&text).unwrap();
    let rows = tables.remove(name).unwrap_or_default();
    assert_eq!(rows.len(), count, "{table}");
    rows
}

/// Changes a good text by each row of a table; `said` has it refused, with the row at hand, and gives what is said.
pub(crate) fn all(table: &str, count: usize, good: &str, said: impl Fn(&str, &[String]) -> String) {
    for row in rows(table, count) {
        let (old, new, says) = (&row[0], &row[1], &row[2..]);
        assert!(good.contains(old), "{table}: {old}");
        let bad = match old.as_str() {
            "" => new.clone(),
            old => good.replacen(old, new, 1),
        };
        assert!(bad != good && !says.is_empty(), "{table}: {row:?}");
        let said = said(&bad, &row);
        for word in says {
            let is_said = !word.is_empty() && said.contains(word);
            assert!(is_said, "{table}: {new}: no \"{word}\" in\n{said}");
        }
    }
}

/// What the parser says of a scene.
pub(crate) fn parsed(scene: &str, _: &[String]) -> String {
    let error = Scene::parse("scene.toml", scene).expect_err(scene);
    let said = error.to_string();
    assert!(said.starts_with("scene.toml:"), "{said}");
    said
}

/// What the program says of a command line, in which `@` begins the name of a scene. It leaves nothing behind.
pub(crate) fn command_line(line: &str, _: &[String]) -> String {
    let folder = TempDir::new().unwrap();
    let words = line
        .split_whitespace()
        .map(|word| match word.strip_prefix('@') {
            Some(name) => scene_path(name).into_os_string(),
            None => word.into(),
        });
    let mut command = host();
    command.args(words).current_dir(folder.path());
    let output = command.stdin(Stdio::null()).output().unwrap();
    let said = flat(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}: {said}");
    assert!(output.stdout.is_empty(), "{line}");
    assert!(!said.contains("tip:"), "{line}: {said}");
    let left = fs::read_dir(folder.path()).unwrap();
    assert_eq!(left.count(), 0, "{line}");
    said
}

/// In one line: what is said is wrapped to the terminal's width.
pub(crate) fn flat(said: &[u8]) -> String {
    let text = String::from_utf8_lossy(said).replace('│', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_is_asked_wrongly_is_answered_with_code_2() {
    all("command_lines/each", 26, "", command_line);
}
