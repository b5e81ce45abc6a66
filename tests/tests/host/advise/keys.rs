//! The pages that say what the JSON has.

use super::{AMB, advise};
use serde_json::Value;
use std::collections::BTreeSet;
use system_tests::{root, scene_path};

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
    let folder = tempfile::TempDir::new().unwrap();
    let own = std::fs::read_to_string(scene_path("impact_at_40_hz")).unwrap();
    let path = folder.path().join("own.toml");
    std::fs::write(&path, own + "\n[supervisor]\nhold_share = 0.7\n").unwrap();
    let mut found = BTreeSet::new();
    for args in [
        &[&AMB[..], &["--json"]].concat()[..],
        &[path.to_str().unwrap(), "--json"],
    ] {
        let json = serde_json::from_slice(&advise(args).stdout).unwrap();
        keys(&json, &mut found);
    }
    assert!(found.len() > 60, "{found:?}");
    for key in found {
        assert!(
            ["", "[]"]
                .map(|s| format!("`{key}{s}`"))
                .iter()
                .any(|k| listed.contains(k)),
            "{key}"
        );
    }
}
