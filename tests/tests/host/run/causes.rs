//! Errors that name the cause, the key with its table, and what to give.

use super::refusals::refused;
use super::{RUN, short};
use crate::refusals::{all, rows};
use system_tests::ran::{Folder, has};

/// The policy whose default needs a magnet that can lift is not to blame for one that cannot, nor is its key.
#[test]
fn a_magnet_that_cannot_lift_is_named_with_the_policy_damping_too() {
    let damped = short().replace("\"radial\"", "\"damping\"");
    all("runs/with_damping", 2, &damped, refused);
}

/// Every key that a scene cannot do without is named with its table, in its line, and what to give is said.
#[test]
fn what_is_missing_is_named_with_its_table_and_unit() {
    let more = "
[stator.inner]\nmass_kg = 12.0 # inner\nstiffness_n_m = 1e9 # inner\ndamping_n_s_m = 1e4 # inner
[race]\ninertia_kg_m2 = 1e-3
[[outage]]\nstart_s = 0.01 # outage\nduration_s = 0.001 # outage
[[disturbance]]\nstart_s = 0.02 # second\nduration_s = 0.001 # second\nforce_n = [1.0, 0.0] # second
[[change]]\nat_s = 0.01\neccentricity_m = 0.0\n";
    let folder = Folder::fresh();
    let refused = |text: &str| {
        folder.put("short.toml", text);
        let ran = folder.ran(RUN);
        assert_eq!(ran.code, Some(2), "{}", ran.said);
        ran.said
    };
    let all = short() + more;
    for row in rows("runs/missing", 17) {
        let [line, key, help] = &row[..] else {
            panic!("{row:?}")
        };
        let kept = all.lines().filter(|l| !l.starts_with(line));
        let text = kept.collect::<Vec<_>>().join("\n");
        let error = refused(&text);
        let is_missing = [": is missing", " is missing"].map(|m| format!(": {key}{m}"));
        let named = is_missing.iter().any(|m| error.contains(m));
        assert!(named, "{line}: {error}");
        has(error.split("help: ").nth(1).unwrap_or_default(), &[help]);
        // The line of the table's heading.
        let heading = key.rsplit_once('.').map(|(table, _)| table);
        let heading = heading.map_or("", |table| table.split('[').next().unwrap());
        let number = error.split("short.toml:").nth(1).unwrap();
        let number: usize = number.split(':').next().unwrap().parse().unwrap();
        has(text.lines().nth(number - 1).unwrap(), &[heading]);
    }
    // A whole table.
    let (before, rest) = all.split_once("[friction]").unwrap();
    let text = format!("{before}\n{}", &rest[rest.find("\n[").unwrap()..]);
    has(
        &refused(&text),
        &["friction is missing", "add a table [friction]"],
    );
}
