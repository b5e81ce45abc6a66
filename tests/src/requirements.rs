//! Requirements of the supervisor, and the tests that verify them: a line `/// Requirement: SR-07` (or `SR-07, SR-12`) in the
//! documentation of a test names what it verifies. The page of the requirements has a table that is made of these lines.

use crate::root;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

/// What stands before and behind the table of tests in the page.
const TABLE: [&str; 2] = ["<!-- from the tests -->\n", "<!-- to here -->"];
/// Folders with tests, and what a test's name begins with there.
const FOLDERS: [(&str, &str); 3] = [
    ("tests/tests", ""),
    ("supervisor/tests", ""),
    ("supervisor/capi/tests", "supervisor-capi::"),
];
/// What a line with names of requirements begins with.
const TAGS: [&str; 2] = ["Requirement: ", "Requirements: "];

/// The page of the requirements.
pub fn page_path() -> PathBuf {
    root().join("docs/src/supervisor/requirements.md")
}

/// The page of the requirements.
///
/// # Errors
/// Of reading it.
pub fn page() -> io::Result<String> {
    std::fs::read_to_string(page_path())
}

/// Names of the requirements that a page lists, one a row of a table, in order.
pub fn listed(page: &str) -> Vec<String> {
    let before = page.split(TABLE[0]).next().unwrap_or(page);
    let rows = before.lines().filter_map(|line| line.strip_prefix("| SR-"));
    rows.map(|row| format!("SR-{}", row.split(' ').next().unwrap_or_default()))
        .collect()
}

/// A test and the requirements that it verifies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verifies {
    /// Name of the test, with its binary and module.
    pub test: String,
    /// Names of requirements, as they are written.
    pub requirements: Vec<String>,
}

/// The tests of a source text that name requirements, in order.
///
/// # Errors
/// A line that names requirements and is not above a test that the usual run of tests has.
pub fn verifies(text: &str, module: &str) -> Result<Vec<Verifies>, String> {
    let mut found = Vec::new();
    let (mut requirements, mut is_test, mut is_ignored) = (Vec::new(), false, false);
    for line in text.lines().map(str::trim) {
        if let Some(comment) = line.strip_prefix("/// ") {
            let names = TAGS.iter().find_map(|tag| comment.strip_prefix(tag));
            requirements.extend(names.iter().flat_map(|n| n.split(", ")).map(str::to_owned));
        } else if line == "#[test]" {
            is_test = true;
        } else if line.starts_with("#[ignore") {
            is_ignored = true;
        } else if !line.starts_with("///") && !line.starts_with("#[") {
            let name = line
                .strip_prefix("fn ")
                .and_then(|rest| rest.split('(').next());
            match name {
                _ if requirements.is_empty() => {}
                Some(name) if is_test && !is_ignored => found.push(Verifies {
                    test: format!("{module}::{name}"),
                    requirements: std::mem::take(&mut requirements),
                }),
                _ => return Err(format!("{module}: {requirements:?} above no test: {line}")),
            }
            (is_test, is_ignored) = (false, false);
        }
    }
    Ok(found)
}

/// All tests that name requirements, in the order of their names.
///
/// # Errors
/// As [`verifies`], and of reading the sources.
pub fn all() -> Result<Vec<Verifies>, String> {
    let mut found = Vec::new();
    for (folder, crate_name) in FOLDERS {
        let folder = root().join(folder);
        for path in sources(&folder).map_err(|e| format!("{}: {e}", folder.display()))? {
            let text = std::fs::read_to_string(&path).map_err(|e| e.to_string())?;
            let below = path.strip_prefix(&folder).unwrap_or(&path);
            let names: Vec<_> = (below.with_extension("").iter())
                .map(|part| part.to_string_lossy().into_owned())
                .collect();
            found.extend(verifies(
                &text,
                &format!("{crate_name}{}", names.join("::")),
            )?);
        }
    }
    found.sort_by(|a, b| a.test.cmp(&b.test));
    Ok(found)
}

fn sources(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(sources(&path)?);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    Ok(files)
}

/// The table of the page: each requirement with its tests.
pub fn table(listed: &[String], verifies: &[Verifies]) -> String {
    let mut tests: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for one in verifies {
        for name in &one.requirements {
            tests.entry(name).or_default().push(&one.test);
        }
    }
    let mut table = String::from("| Requirement | Tests |\n|---|---|\n");
    for name in listed {
        let tests = tests.get(name.as_str()).cloned().unwrap_or_default();
        let tests: Vec<_> = tests.iter().map(|test| format!("`{test}`")).collect();
        let _ = writeln!(table, "| {name} | {} |", tests.join(", "));
    }
    table
}

/// The page with this table in the place of its own; `None` where it has no place for one.
pub fn with_table(page: &str, table: &str) -> Option<String> {
    let (before, rest) = page.split_once(TABLE[0])?;
    let (_, after) = rest.split_once(TABLE[1])?;
    Some(format!(
        "{before}{}\n{table}\n{}{after}",
        TABLE[0], TABLE[1]
    ))
}
