//! Walls of the house: a file imports only from files that its crate's `lib.rs` lists before it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Names in backticks or brackets after "above it:" in the crate's documentation, in order.
fn listed(lib: &str) -> Vec<String> {
    let doc: String = (lib.lines())
        .filter_map(|l| l.strip_prefix("//!"))
        .collect::<Vec<_>>()
        .join(" ");
    let list = doc
        .split("above it:")
        .nth(1)
        .expect("lib.rs lists its files");
    let list = list.split('.').next().unwrap_or(list);
    list.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

/// Top-level modules that a file's code refers to by `crate::`. (By `super` no file leaves the module that it is checked as.)
fn imports(text: &str) -> BTreeSet<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    let mut found = BTreeSet::new();
    for line in code.lines().filter(|l| !l.trim_start().starts_with("//")) {
        for part in line.split("crate::").skip(1) {
            if let Some(group) = part.strip_prefix('{') {
                let group = group.split('}').next().unwrap_or(group);
                for name in group.split(',') {
                    found.insert(name.split("::").next().unwrap_or("").trim().to_owned());
                }
            } else {
                let name = part
                    .split(|c: char| !(c.is_alphanumeric() || c == '_'))
                    .next();
                found.insert(name.unwrap_or("").to_owned());
            }
        }
    }
    found.remove("");
    found
}

/// Every source file in a folder and its folders.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

fn check(krate: &str) {
    let src = system_tests::root().join(krate).join("src");
    let lib = std::fs::read_to_string(src.join("lib.rs")).unwrap();
    let order = listed(&lib);
    let rank = |name: &str| order.iter().position(|n| n == name);
    let mut checked = 0;
    let mut visit = |path: &Path| {
        let module = path.strip_prefix(&src).unwrap().iter().next().unwrap();
        let module = Path::new(module).file_stem().unwrap().to_str().unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let here = rank(module)
            .unwrap_or_else(|| panic!("{} is not listed in {krate}/src/lib.rs", path.display()));
        for name in imports(&text) {
            // Items re-exported at the root of the crate (types, aliases) start with a capital.
            if name.starts_with(char::is_uppercase) {
                continue;
            }
            let there =
                rank(&name).unwrap_or_else(|| panic!("{}: {name} is not listed", path.display()));
            assert!(
                there <= here,
                "{} imports {name}, which is below it",
                path.display()
            );
        }
        checked += 1;
    };
    for path in files_below(&src) {
        if ![src.join("lib.rs"), src.join("main.rs")].contains(&path) {
            visit(&path);
        }
    }
    assert!(
        checked >= order.len(),
        "{krate}: {checked} files for {} names",
        order.len()
    );
}

#[test]
fn files_import_only_upwards() {
    check("supervisor");
    check("supervisor/capi");
    check("plant-model");
    check("firmware-host/bench");
    check("firmware-host/studies");
}

/// The plant knows no control, the supervisor no plant.
#[test]
fn crates_keep_their_distance() {
    let manifest = |krate: &str| {
        std::fs::read_to_string(system_tests::root().join(krate).join("Cargo.toml")).unwrap()
    };
    for above in ["firmware-studies", "firmware-host"] {
        assert!(!manifest("firmware-host/bench").contains(&format!("{above} =")));
    }
    assert!(!manifest("firmware-host/studies").contains("firmware-host ="));
    assert!(!manifest("plant-model").contains("supervisor ="));
    assert!(!manifest("supervisor").contains("plant-model"));
    let lib = std::fs::read_to_string(system_tests::root().join("supervisor/src/lib.rs")).unwrap();
    assert!(lib.contains("\n#![no_std]") && lib.contains("\n#![forbid(unsafe_code)]"));
}

/// Unsafe code is in the C interface and in the images, which talk to the linker, and nowhere else.
#[test]
fn unsafe_code_stays_at_the_border() {
    let root = system_tests::root();
    let mut folders: Vec<_> = [
        "supervisor/src",
        "plant-model",
        "firmware-host/src",
        "firmware-host/bench/src",
        "firmware-host/studies/src",
        "tests/src",
        "tests/tests",
    ]
    .map(|folder| root.join(folder))
    .to_vec();
    let word = "unsafe";
    let code = ["{", "fn", "extern", "impl"].map(|after| format!("{word} {after}"));
    let mut read = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let found = code.iter().any(|c| text.contains(c));
                assert!(
                    !found && !text.contains(&format!("{word}(")),
                    "{}",
                    path.display()
                );
                read += 1;
            }
        }
    }
    assert!(read > 100, "{read} files");
}
