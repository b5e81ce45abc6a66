//! The pages that say what the JSON has.

use super::AMB;
use serde_json::Value;
use std::collections::BTreeSet;
use system_tests::ran::{Folder, scene_text};
use system_tests::root;

/// Every key of an object, at any depth.
fn keys(json: &Value, found: &mut BTreeSet<String>) {
    match json {
        Value::Object(object) => {
            for (key, value) in object {
                found.insert(key.clone());
                keys(value, found);
            }
        }
        Value::Array(array) => array.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

/// Of plain numbers, and of a scene that has something in every key.
#[test]
fn the_page_has_every_key() {
    let page = std::fs::read_to_string(root().join("docs/src/supervisor/advise.md")).unwrap();
    let (_, listed) = page.split_once("\n## JSON\n").unwrap();
    let listed = listed.split("\n## ").next().unwrap();
    let folder = Folder::fresh();
    let own = scene_text("impact_at_40_hz") + "\n[supervisor]\nhold_share = 0.7\n";
    folder.put("own.toml", own);
    let mut found = BTreeSet::new();
    for of in [AMB, "own.toml"] {
        let json = folder.ran(&format!("advise {of} --json")).json();
        keys(&json, &mut found);
    }
    assert!(found.len() > 60, "{found:?}");
    for key in found {
        let names = ["", "[]"].map(|s| format!("`{key}{s}`"));
        assert!(names.iter().any(|name| listed.contains(name)), "{key}");
    }
}
