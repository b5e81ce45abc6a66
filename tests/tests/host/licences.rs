//! What is depended on: its licences are those that `deny.toml` allows, and what firmware links is under MIT or Apache-2.0.

use serde_json::Value;
use spdx::{Expression, ParseMode};
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use system_tests::ran::ran;
use system_tests::root;

/// Packages of the workspace and what they depend on, on this machine.
pub(crate) fn metadata() -> Value {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args("metadata --format-version 1 --offline --locked".split(' '));
    let host = ran(Command::new("rustc").args(["--print", "host-tuple"])).good();
    cargo.args(["--filter-platform", host.trim()]);
    ran(cargo.current_dir(root())).json()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

/// Whether one of the choices that a licence gives is allowed. As cargo does, a slash is taken for an OR.
fn is_allowed(licence: &str, allowed: &BTreeSet<&str>) -> bool {
    let expression = Expression::parse_mode(licence, ParseMode::LAX);
    expression.is_ok_and(|e| e.evaluate(|asked| allowed.contains(asked.to_string().as_str())))
}

#[test]
fn licences_are_on_the_list() {
    let list = std::fs::read_to_string(root().join("deny.toml")).unwrap();
    let list: toml::Value = toml::from_str(&list).unwrap();
    let allowed = list["licenses"]["allow"].as_array().unwrap();
    let allowed: BTreeSet<&str> = allowed.iter().filter_map(toml::Value::as_str).collect();
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    for package in packages {
        let (name, licence) = (text(package, "name"), text(package, "license"));
        assert!(
            is_allowed(licence, &allowed),
            "{name}: {licence:?} is not in deny.toml"
        );
    }
    assert!(packages.len() > 50, "{} packages", packages.len());
    assert!(!is_allowed("GPL-3.0-only", &allowed) && !is_allowed("", &allowed));
    assert!(!is_allowed("MIT AND GPL-3.0-only", &allowed) && is_allowed("MIT/GPL-3.0", &allowed));
}

/// What the supervisor and its C interface link; not what runs while they are compiled.
#[test]
fn firmware_links_mit_and_apache_alone() {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    let by_id: BTreeMap<&str, &Value> = packages.iter().map(|p| (text(p, "id"), p)).collect();
    let nodes = metadata["resolve"]["nodes"].as_array().unwrap();
    let is_linked = |dependency: &&Value| {
        let kinds = dependency["dep_kinds"].as_array().unwrap();
        let runs_later = kinds.iter().any(|kind| kind["kind"].is_null());
        let targets = by_id[text(dependency, "pkg")]["targets"]
            .as_array()
            .unwrap();
        let is_macro = targets.iter().any(|t| t["kind"][0] == "proc-macro");
        runs_later && !is_macro
    };
    let root_id = packages
        .iter()
        .find(|p| text(p, "name") == "supervisor-capi");
    let (mut linked, mut new) = (BTreeSet::new(), vec![text(root_id.unwrap(), "id")]);
    while let Some(id) = new.pop() {
        if linked.insert(id) {
            let node = nodes.iter().find(|n| text(n, "id") == id).unwrap();
            let dependencies = node["deps"].as_array().unwrap().iter();
            new.extend(dependencies.filter(is_linked).map(|d| text(d, "pkg")));
        }
    }
    let allowed = BTreeSet::from(["MIT", "Apache-2.0"]);
    for id in &linked {
        let licence = text(by_id[id], "license");
        assert!(is_allowed(licence, &allowed), "{id}: {licence:?}");
    }
    assert!((8..30).contains(&linked.len()), "{linked:#?}");
}
