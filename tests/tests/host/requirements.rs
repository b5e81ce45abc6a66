//! Requirements, the tests that verify them, and the safety manual: what is numbered is there, once, and nothing refers to a
//! number that is not.

use std::collections::BTreeSet;
use system_tests::requirements::{all, listed, page, table, verifies, with_table};
use system_tests::root;

/// Names in a text that begin so and end with digits.
fn named(text: &str, prefix: &str) -> Vec<String> {
    let starts = text.match_indices(prefix).map(|(at, _)| &text[at..]);
    let names = starts.map(|rest| {
        let digits = rest[prefix.len()..].chars();
        let digits: String = digits.take_while(char::is_ascii_digit).collect();
        format!("{prefix}{digits}")
    });
    names.collect()
}

/// Names of the rows of a page's tables that begin so.
fn rows(page: &str, prefix: &str) -> Vec<String> {
    let rows = page.lines().filter_map(|line| line.strip_prefix("| "));
    let first = rows.filter(|row| row.starts_with(prefix));
    first
        .flat_map(|row| named(row, prefix).into_iter().take(1))
        .collect()
}

/// 01, 02, and so on.
fn counted(prefix: &str, count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("{prefix}{i:02}")).collect()
}

#[test]
fn every_requirement_has_a_test_and_every_tag_a_requirement() {
    let listed = listed(&page().unwrap());
    assert_eq!(
        listed,
        counted("SR-", listed.len()),
        "one number after the other"
    );
    let verifies = all().unwrap();
    let known: BTreeSet<&String> = listed.iter().collect();
    let tagged: BTreeSet<&String> = verifies.iter().flat_map(|v| &v.requirements).collect();
    assert_eq!(tagged, known, "tags, and what the page lists");
}

#[test]
fn the_table_is_what_the_tests_say() {
    let page = page().unwrap();
    let table = table(&listed(&page), &all().unwrap());
    assert!(
        with_table(&page, &table).unwrap() == page,
        "docs/src/supervisor/requirements.md: write it with `cargo run --release -p system-tests --bin requirements -- --write`"
    );
}

/// A tag that would count for nothing is an error.
#[test]
fn a_tag_above_no_test_is_found() {
    let test = "/// Sound.\n/// Requirements: SR-01, SR-02\n#[test]\nfn holds() {\n";
    let found = verifies(test, "a::b").unwrap();
    assert_eq!(found[0].test, "a::b::holds");
    assert_eq!(found[0].requirements, ["SR-01", "SR-02"]);
    for wrong in [
        test.replace("#[test]\n", ""),
        test.replace("#[test]\n", "#[test]\n#[ignore = \"long\"]\n"),
        test.replace("fn holds", "const HOLDS"),
    ] {
        assert!(verifies(&wrong, "a::b").is_err(), "{wrong}");
    }
}

/// What the safety manual numbers is numbered without a gap, and what it refers to is there; so is what other pages refer to.
#[test]
fn the_safety_manual_refers_to_what_is_there() {
    let docs = root().join("docs/src/supervisor");
    let manual = std::fs::read_to_string(docs.join("safety-manual.md")).unwrap();
    let mut known: BTreeSet<String> = listed(&page().unwrap()).into_iter().collect();
    for prefix in ["AoU-", "FM-"] {
        let here = rows(&manual, prefix);
        assert!(
            here.len() > 10 && here == counted(prefix, here.len()),
            "{here:?}"
        );
        known.extend(here);
    }
    for entry in std::fs::read_dir(docs).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        for name in ["SR-", "AoU-", "FM-"]
            .iter()
            .flat_map(|prefix| named(&text, prefix))
        {
            assert!(known.contains(&name), "{}: {name}", path.display());
        }
    }
}
