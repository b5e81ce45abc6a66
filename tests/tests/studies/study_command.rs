//! `study`: every study by its name, its claims for programs, its part of a page.

use firmware_studies::STUDIES;
use firmware_studies::campaign::Study;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use system_tests::ran::{Folder, Ran, has, lacks, list, number};
use system_tests::root;
use system_tests::terminal::assert_fits;

fn study(words: &str) -> Ran {
    Folder::fresh().ran(&format!("study {words}"))
}

#[test]
fn the_list_names_every_study() {
    let json = study("list --json").json();
    let names = list(&json["names"])
        .iter()
        .map(|name| name.as_str().unwrap());
    assert!(names.eq(STUDIES.iter().map(|study| study.name)), "{json}");
    let text = study("list").good();
    for known in STUDIES {
        has(&text, &[known.about]);
    }
    has(&study("weather").fails(2), &["unseen-machines"]);
}

/// Claims have the keys that programs know, and hold or not by their own numbers; a claim that does not hold is an error
/// only where asked for, and results are printed all the same.
#[test]
fn claims_for_programs() {
    let strict = study("unseen-machines --quick --strict --json");
    let json: Value = serde_json::from_str(&strict.printed).unwrap();
    let said = strict.fails(1);
    let claims = list(&json["claims"]);
    assert!(json["cases"].as_u64().unwrap() > 1000 && number(&json["seconds"]) > 0.0);
    for claim in claims {
        let keys: BTreeSet<&String> = claim.as_object().unwrap().keys().collect();
        assert!(
            keys.iter()
                .eq(&["bound", "holds", "measured", "name", "side"])
        );
        let [bound, measured] = ["bound", "measured"].map(|key| number(&claim[key]));
        let holds = match claim["side"].as_str().unwrap() {
            "at_least" => measured >= bound,
            "at_most" => measured <= bound,
            other => panic!("{other}"),
        };
        assert_eq!(claim["holds"], holds, "{claim}");
    }
    nothing_is_lost_that_levitation_alone_recovers_from(claims);
    // Forces that come late are beyond what is promised.
    let broken = claims.iter().find(|claim| claim["holds"] == false).unwrap();
    has(&said, &[broken["name"].as_str().unwrap()]);

    let json = study("rub --quick --machines 1 --json").json();
    assert!(json["rows"][0]["pairs"].is_u64(), "{json}");

    let folder = Folder::fresh();
    let text = folder.ran("study rub --quick --machines 1 --out .").good();
    assert!(folder.at("rub.html").is_file());
    assert_fits(&text, 80);
    let (_, last) = text.trim_end().rsplit_once('\n').unwrap();
    let (kept, of) = last.split_once(" of ").unwrap();
    has(of, &[" claims hold; "]);
    assert!(!of.starts_with(&format!("{kept} ")), "{last}");
}

/// On machines that nothing was tuned on: whatever levitation alone recovers from, the supervisor does, and from more, as long as
/// a force comes within 0.8 of the time in which the cap crosses the clearance.
fn nothing_is_lost_that_levitation_alone_recovers_from(claims: &[Value]) {
    for late in ["0 to 0.4", "0.4 to 0.8"] {
        let measured = |what: &str| {
            let name = format!("late {late}: {what}");
            let claim = claims.iter().find(|claim| claim["name"] == name);
            claim.unwrap_or_else(|| panic!("no {name}"))["measured"].as_f64()
        };
        assert_eq!(measured("lost, share of runs"), Some(0.0), "{late}");
        let over = measured("recovered, over levitation alone");
        assert!(over > Some(1.02), "{late}: {over:?}");
    }
}

/// A study writes between its marks, and nothing else of the page changes.
#[test]
fn the_page_of_a_study() {
    let folder = Folder::fresh();
    let write = |study_name: &str| {
        let text = format!(
            "# Title\n\nBy hand.\n\n<!-- study {study_name}: by command -->\nof before\n<!-- end -->\n\nMore.\n"
        );
        folder.put("page.md", text);
        folder.ran("study accuracy --quick --page page.md")
    };
    write("accuracy").good();
    let page = folder.text("page.md");
    let marked = "# Title\n\nBy hand.\n\n<!-- study accuracy: by command -->\n\n## Claims\n";
    assert!(page.starts_with(marked), "{page}");
    assert!(page.ends_with("\n<!-- end -->\n\nMore.\n"), "{page}");
    has(&page, &["| claim | bound | measured | holds |"]);
    lacks(&page, &["of before"]);

    has(&write("harm").fails(2), &["<!-- study accuracy: "]);
    has(&folder.text("page.md"), &["of before"]);
}

/// Every study has a page in the documentation, written by it, and the table of contents has that.
#[test]
fn every_study_has_a_page() {
    let docs = root().join("docs/src");
    let contents = fs::read_to_string(docs.join("SUMMARY.md")).unwrap();
    for Study { name, .. } in STUDIES {
        let file = format!("measured/{name}.md");
        let page = fs::read_to_string(docs.join(&file)).unwrap_or_default();
        let mark = format!(
            "<!-- study {name}: written by `cargo run --release -- study {name} --page docs/src/{file}` -->\n\n## Claims\n"
        );
        assert!(page.contains(&mark), "{file}");
        assert!(contents.contains(&format!("({file})")), "{file}");
    }
}
