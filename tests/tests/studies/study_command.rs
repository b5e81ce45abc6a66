//! `study`: every study by its name, its claims for programs, its part of a page.

use firmware_studies::STUDIES;
use firmware_studies::campaign::Study;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::process::Output;
use system_tests::terminal::assert_fits;
use system_tests::{host, root};

fn study(args: &[&str]) -> Output {
    host().arg("study").args(args).output().unwrap()
}

fn utf8(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn the_list_names_every_study() {
    let list = study(&["list", "--json"]);
    let json: Value = serde_json::from_slice(&list.stdout).unwrap();
    let names: Vec<&str> = (json["names"].as_array().unwrap().iter())
        .map(|name| name.as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        STUDIES.iter().map(|study| study.name).collect::<Vec<_>>()
    );
    let text = utf8(&study(&["list"]).stdout);
    for known in STUDIES {
        assert!(text.contains(known.about), "{}", known.name);
    }
    let unknown = study(&["weather"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(utf8(&unknown.stderr).contains("unseen-machines"));
}

/// Claims have the keys that programs know, and hold or not by their own numbers; a claim that does not hold is an error
/// only where asked for, and results are printed all the same.
#[test]
fn claims_for_programs() {
    let strict = study(&["unseen-machines", "--quick", "--strict", "--json"]);
    assert_eq!(strict.status.code(), Some(1));
    let json: Value = serde_json::from_slice(&strict.stdout).unwrap();
    let claims = json["claims"].as_array().unwrap();
    assert!(json["cases"].as_u64().unwrap() > 1000 && json["seconds"].as_f64().unwrap() > 0.0);
    for claim in claims {
        let keys: BTreeSet<&str> = claim
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        assert_eq!(keys, ["bound", "holds", "measured", "name", "side"].into());
        let (bound, measured) = (
            &claim["bound"].as_f64().unwrap(),
            &claim["measured"].as_f64().unwrap(),
        );
        let holds = match claim["side"].as_str().unwrap() {
            "at_least" => measured >= bound,
            "at_most" => measured <= bound,
            other => panic!("{other}"),
        };
        assert_eq!(claim["holds"].as_bool().unwrap(), holds, "{claim}");
    }
    nothing_is_lost_that_levitation_alone_recovers_from(claims);
    // Forces that come late are beyond what is promised.
    let broken = claims
        .iter()
        .find(|claim| !claim["holds"].as_bool().unwrap())
        .unwrap();
    assert!(utf8(&strict.stderr).contains(broken["name"].as_str().unwrap()));

    let rows = study(&["rub", "--quick", "--machines", "1", "--json"]);
    let json: Value = serde_json::from_slice(&rows.stdout).unwrap();
    assert!(json["rows"][0]["pairs"].is_u64(), "{json}");

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let lenient = study(&["rub", "--quick", "--machines", "1", "--out", out]);
    assert!(lenient.status.success());
    assert!(folder.path().join("rub.html").is_file());
    let text = utf8(&lenient.stdout);
    assert_fits(&text, 80);
    let (_, last) = text.trim_end().rsplit_once('\n').unwrap();
    let (kept, of) = last.split_once(" of ").unwrap();
    assert!(
        of.contains(" claims hold; ") && !of.starts_with(&format!("{kept} ")),
        "{last}"
    );
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
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.md");
    let write = |study_name: &str| {
        let text = format!(
            "# Title\n\nBy hand.\n\n<!-- study {study_name}: by command -->\nof before\n<!-- end -->\n\nMore.\n"
        );
        fs::write(&path, text).unwrap();
        study(&["accuracy", "--quick", "--page", path.to_str().unwrap()])
    };
    let output = write("accuracy");
    assert!(output.status.success(), "{output:?}");
    let page = fs::read_to_string(&path).unwrap();
    let marked = "# Title\n\nBy hand.\n\n<!-- study accuracy: by command -->\n\n## Claims\n";
    assert!(page.starts_with(marked), "{page}");
    assert!(page.ends_with("\n<!-- end -->\n\nMore.\n") && !page.contains("of before"));
    assert!(page.contains("| claim | bound | measured | holds |"));

    let refused = write("harm");
    assert_eq!(refused.status.code(), Some(2));
    assert!(utf8(&refused.stderr).contains("<!-- study accuracy: "));
    assert!(fs::read_to_string(&path).unwrap().contains("of before"));
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
