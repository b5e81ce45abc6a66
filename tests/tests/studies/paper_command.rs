//! `paper` as a person uses it: the text, the page, the JSON, and that none depends on the number of threads.

use firmware_studies::campaign::html;
use firmware_studies::paper::{self, Chapter};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;
use system_tests::browser::Browser;
use system_tests::host;
use system_tests::terminal::{assert_fits, tables};
use tempfile::TempDir;

fn run(out: &Path, more: &[&str]) -> Output {
    (host().args(["paper", "--out"]).arg(out).args(more))
        .output()
        .expect("the host starts")
}

/// Promised keys, their types and the kinds.
fn check_rows(json: &Value) {
    let top = json.as_object().expect("an object");
    assert_eq!(top.keys().collect::<Vec<_>>(), ["rows"]);
    let rows = json["rows"].as_array().expect("a list");
    assert!(rows.len() > 60, "{}", rows.len());
    let mut names = Vec::new();
    for row in rows {
        for key in ["item", "source", "unit", "chapter", "note"] {
            assert!(row[key].is_string(), "{key} of {row}");
        }
        assert!(!row["item"].as_str().unwrap().is_empty(), "{row}");
        assert!(!row["source"].as_str().unwrap().is_empty(), "{row}");
        for key in ["paper", "computed", "deviation"] {
            let value = row.get(key).unwrap_or_else(|| panic!("no {key} in {row}"));
            assert!(value.is_number() || value.is_null(), "{key} of {row}");
        }
        let kind = row["kind"].as_str().expect("a kind");
        assert!(["fitted", "predicted", "assumed"].contains(&kind), "{kind}");
        // A miss says why.
        if row["holds"] == false {
            assert!(!row["note"].as_str().unwrap().is_empty(), "{row}");
        }
        names.push((row["chapter"].to_string(), row["item"].to_string()));
    }
    names.sort();
    names.dedup();
    assert_eq!(
        names.len(),
        rows.len(),
        "no two rows of a chapter are alike"
    );
}

/// What the command prints and writes on two threads is of the chapters that one has computed.
pub(crate) fn page_and_json_do_not_depend_on_threads(chapters: &[Chapter]) {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let result = run(&out, &["--quick", "--threads", "2"]);
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{error}");
    let mut names: Vec<_> = (fs::read_dir(&out).unwrap())
        .map(|e| e.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["paper.html", "paper.json"]);
    let json = fs::read(out.join("paper.json")).unwrap();
    let page = fs::read_to_string(out.join("paper.html")).unwrap();
    let other = serde_json::to_string_pretty(&paper::json(chapters)).unwrap();
    assert!(
        json == (other + "\n").as_bytes(),
        "JSON differs between threads"
    );
    let other = html(&paper::page(chapters)).unwrap();
    assert!(page == other, "the page differs between threads");
    let said = String::from_utf8_lossy(&result.stdout);
    assert_fits(&said, 80);
    assert!(tables(&said) > 2, "{said}");
    let (other, link) = (paper::text(chapters), out.join("paper.html"));
    assert_eq!(said, format!("{other}\npage: {}\n", link.display()));
    if let Some(browser) = Browser::found() {
        browser.check("chapters.mjs", &[&out.join("paper.html")]);
    }
    // Nothing but the folder: no temporary name is left.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);

    check_rows(&serde_json::from_slice(&json).unwrap());
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
    for word in [
        "<nav",
        "Rows that miss, and why",
        "predicted (nothing was chosen for them)",
        "<svg",
        "<p class=\"headline\">The model meets ",
    ] {
        assert!(page.contains(word), "{word}");
    }
    for outside in ["<script", "src=", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Every link inside the page has a target, and no target is there twice.
    for link in page.split("href=\"#").skip(1) {
        let id = link.split('"').next().unwrap();
        assert_eq!(page.matches(&format!("id=\"{id}\"")).count(), 1, "{id}");
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_at_once() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let result = run(&file, &["--quick"]);
    assert_eq!(result.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&result.stderr).contains("cannot write results"));
    assert!(result.stdout.is_empty());
}
