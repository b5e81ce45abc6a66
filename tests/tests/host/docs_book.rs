//! The documentation as a book: every page is in its table of contents, links lead somewhere, paragraphs stay short.

use firmware_bench::scene::keys::Key;
use firmware_bench::scene::tables::KEYS;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use system_tests::root;

/// Words of a paragraph, a list item or a quotation at most.
const WORDS: usize = 110;

/// A page without what stands between fences.
fn prose(path: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut fenced = false;
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
            lines.push(String::new());
        } else if !fenced {
            lines.push(line.to_owned());
        }
    }
    assert!(!fenced, "{}: an open fence", path.display());
    lines
}

/// All pages of the book, and the README.
fn pages() -> Vec<PathBuf> {
    let mut found = vec![root().join("README.md")];
    let mut folders = vec![root().join("docs/src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "md") {
                found.push(path);
            }
        }
    }
    found
}

/// Targets of the links of a line, `](here)`.
fn links(line: &str) -> impl Iterator<Item = &str> {
    (line.split("](").skip(1)).filter_map(|rest| rest.split_once(')').map(|(target, _)| target))
}

/// The anchors that mdBook and GitHub give to the headings of a page.
fn anchors(path: &Path) -> BTreeSet<String> {
    (prose(path).iter().filter(|l| l.starts_with('#')))
        .map(|heading| {
            let words = heading.trim_start_matches('#').trim().to_lowercase();
            (words.chars())
                .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
                .map(|c| if c == ' ' { '-' } else { c })
                .collect()
        })
        .collect()
}

#[test]
fn links_lead_somewhere() {
    let mut checked = 0;
    let mut broken = Vec::new();
    for page in pages() {
        for line in prose(&page) {
            for link in links(&line).filter(|l| !l.contains("://")) {
                let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
                let target = match file {
                    "" => page.clone(),
                    file => page.parent().unwrap().join(file),
                };
                let is_there =
                    target.exists() && (anchor.is_empty() || anchors(&target).contains(anchor));
                if !is_there {
                    broken.push(format!("{}: {link}", page.display()));
                }
                checked += 1;
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
    assert!(checked > 300, "{checked} links");
}

#[test]
fn every_page_is_in_the_table_of_contents_once() {
    let folder = root().join("docs/src");
    let summary = prose(&folder.join("SUMMARY.md"));
    let mut listed: Vec<PathBuf> = (summary.iter().flat_map(|l| links(l)))
        .map(|l| folder.join(l))
        .collect();
    let mut there: Vec<PathBuf> = (pages().into_iter())
        .filter(|p| p.starts_with(&folder) && !p.ends_with("SUMMARY.md"))
        .collect();
    listed.sort();
    there.sort();
    assert_eq!(listed, there);
}

#[test]
fn paragraphs_are_short() {
    let mut long = Vec::new();
    // What a study writes is the study's.
    let by_hand = |page: &PathBuf| !page.parent().is_some_and(|p| p.ends_with("measured"));
    for page in pages().into_iter().filter(by_hand) {
        let mut paragraph = Vec::new();
        let mut lines = prose(&page);
        lines.push(String::new());
        for line in &lines {
            let line = line.trim();
            let begins = line.starts_with("- ")
                || line
                    .split_once(". ")
                    .is_some_and(|(n, _)| n.parse::<u32>().is_ok());
            let ends = line.is_empty() || line.starts_with(['|', '#']);
            if begins || ends {
                if paragraph.len() > WORDS {
                    let start = paragraph[..8].join(" ");
                    long.push(format!(
                        "{}: {} words: {start}",
                        page.display(),
                        paragraph.len()
                    ));
                }
                paragraph.clear();
            }
            if !ends {
                paragraph.extend(line.split_whitespace().map(str::to_owned));
            }
        }
    }
    assert!(long.is_empty(), "{long:#?}");
}

/// What the page beside other tools says that a scene has, it has; and it has no key for what that page says is missing.
#[test]
fn what_the_comparison_says_of_scenes_is_so() {
    let page = std::fs::read_to_string(root().join("docs/src/comparison.md")).unwrap();
    let table = page
        .split("\n## ")
        .find(|part| part.starts_with("What a scene has"))
        .unwrap();
    let rows: Vec<&str> = table
        .lines()
        .filter(|line| line.starts_with("| "))
        .collect();
    let (missing, has) = rows.split_last().unwrap();
    let mut all = Vec::new();
    described("", KEYS, &mut all);
    let mut named = 0;
    for path in has.iter().flat_map(|row| row.split('`').skip(1).step_by(2)) {
        assert!(all.iter().any(|(known, _)| known == path), "{path}");
        named += 1;
    }
    assert!(named > 20 && missing.starts_with("| Not: |"), "{missing}");
    for word in missing.split('|').nth(2).unwrap().split(',') {
        let stem = word
            .trim()
            .trim_end_matches("ication")
            .trim_end_matches(" motion");
        for (path, help) in &all {
            let found = format!("{path} {help}").to_lowercase();
            let is_there = found
                .split(|c: char| !c.is_alphabetic())
                .any(|w| w.starts_with(stem));
            assert!(!is_there, "{stem} in {path}: {help}");
        }
    }
}

/// Every key with its path, and what is said of it.
fn described(above: &str, keys: &[Key], all: &mut Vec<(String, String)>) {
    for key in keys {
        let path = match above {
            "" => key.name.to_owned(),
            above => format!("{above}.{}", key.name),
        };
        described(&path, key.below(), all);
        all.push((path, key.help.to_owned()));
    }
}
