//! What is refused is data, in `refusals/`: what of something good is replaced, by what, and what is said of it then.

use firmware_bench::scene::Scene;
use std::collections::BTreeMap;
use std::fs;
use system_tests::ran::{Folder, lacks};
use system_tests::root;

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
    let folder = Folder::fresh();
    let said = folder.ran(line).refused();
    lacks(&said, &["tip:"]);
    assert_eq!(folder.names("."), [""; 0], "{line}");
    said
}

#[test]
fn what_is_asked_wrongly_is_answered_with_code_2() {
    all("command_lines/each", 26, "", command_line);
}
