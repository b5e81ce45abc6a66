//! Errors that name the cause, the key with its table, and what to give.

use super::refusals::refused;
use super::{short, short_scene};
use crate::refusals::{all, rows};
use std::fs;
use system_tests::run_scene;
use tempfile::TempDir;

/// The policy whose default needs a magnet that can lift is not to blame for one that cannot, nor is its key.
#[test]
fn a_magnet_that_cannot_lift_is_named_with_the_policy_damping_too() {
    let damped = short().replace("\"radial\"", "\"damping\"");
    all("runs/with_damping", 2, &damped, refused);
}

/// Every key that a scene cannot do without is named with its table, in its line, and what to give is said.
#[test]
fn what_is_missing_is_named_with_its_table_and_unit() {
    let folder = TempDir::new().unwrap();
    let more = "
[stator.inner]\nmass_kg = 12.0 # inner\nstiffness_n_m = 1e9 # inner\ndamping_n_s_m = 1e4 # inner
[race]\ninertia_kg_m2 = 1e-3
[[outage]]\nstart_s = 0.01 # outage\nduration_s = 0.001 # outage
[[disturbance]]\nstart_s = 0.02 # second\nduration_s = 0.001 # second\nforce_n = [1.0, 0.0] # second
[[change]]\nat_s = 0.01\neccentricity_m = 0.0\n";
    for row in rows("runs/missing", 17) {
        let [line, key, help] = &row[..] else {
            panic!("{row:?}")
        };
        let scene = short_scene(folder.path(), |t| {
            let text = t + more;
            let kept = text.lines().filter(|l| !l.starts_with(line));
            kept.collect::<Vec<_>>().join("\n")
        });
        let text = fs::read_to_string(&scene).unwrap();
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        assert_eq!(result.status.code(), Some(2), "{line}: {error}");
        let is_missing = [
            format!(": {key}: is missing"),
            format!(": {key} is missing"),
        ];
        assert!(
            is_missing.iter().any(|m| error.contains(m)),
            "{line}: {error}"
        );
        let helps = error.split("help: ").nth(1).unwrap_or_default();
        assert!(helps.contains(help), "{line}: {error}");
        // The line of the table's heading.
        let heading = key.rsplit_once('.').map(|(table, _)| table);
        let heading = heading.map(|table| table.split('[').next().unwrap());
        let number = error.split("short.toml:").nth(1).unwrap();
        let number: usize = number.split(':').next().unwrap().parse().unwrap();
        let at = text.lines().nth(number - 1).unwrap();
        assert!(
            heading.is_none_or(|table| at.contains(table)),
            "{line}: {at}"
        );
    }
    // A whole table.
    let scene = short_scene(folder.path(), |t| {
        let (before, rest) = t.split_once("[friction]").unwrap();
        format!("{before}\n{}", &rest[rest.find("\n[").unwrap()..])
    });
    let result = run_scene(&scene, &folder.path().join("out"), &[]);
    let error = String::from_utf8(result.stderr).unwrap();
    assert!(error.contains("friction is missing"), "{error}");
    assert!(error.contains("add a table [friction]"), "{error}");
}
