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

/// Paths below `crate` that a file's code refers to, as lists of names.
fn paths(text: &str, here: &[String]) -> Vec<Vec<String>> {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let code: String = (code.lines())
        .filter(|l| !l.trim_start().starts_with("//"))
        .map(|l| format!("{l}\n"))
        .collect();
    let name = |part: &str| -> String {
        part.chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect()
    };
    let mut found = Vec::new();
    let parent = &here[..here.len() - 1];
    for (word, from) in [("crate::", &[][..]), ("super::", parent)] {
        for (at, _) in code.match_indices(word) {
            // A part of a longer path, as `super::super::`, is found with its beginning.
            if code[..at].ends_with([':', '_']) {
                continue;
            }
            let mut path = from.to_vec();
            let mut rest = &code[at + word.len()..];
            loop {
                if let Some(deeper) = rest.strip_prefix("super::") {
                    path.pop();
                    rest = deeper;
                    continue;
                }
                if let Some(group) = rest.strip_prefix('{') {
                    let group = group.split('}').next().unwrap_or(group);
                    for item in group.split(',') {
                        let mut each = path.clone();
                        each.push(name(item.trim_start()));
                        found.push(each);
                    }
                    break;
                }
                let part = name(rest);
                rest = &rest[part.len()..];
                path.push(part);
                match rest.strip_prefix("::") {
                    Some(deeper) => rest = deeper,
                    None => {
                        found.push(path);
                        break;
                    }
                }
            }
        }
    }
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

/// A file's module, as a list of names.
fn module_path(path: &Path, src: &Path) -> Vec<String> {
    let below = path.strip_prefix(src).unwrap().with_extension("");
    let names = below.iter().map(|part| part.to_str().unwrap().to_owned());
    names.collect()
}

fn check(krate: &str) {
    let src = system_tests::root().join(krate).join("src");
    let lib = std::fs::read_to_string(src.join("lib.rs")).unwrap();
    let order = listed(&lib);
    // A folder may be listed as one, or file by file, as `folder/file`.
    let rank = |path: &[String]| {
        let file = path.get(..2).map(|two| two.join("/"));
        let file = file.and_then(|file| order.iter().position(|name| *name == file));
        file.or_else(|| order.iter().position(|name| *name == path[0]))
    };
    let mut checked = 0;
    let mut visit = |path: &Path| {
        let module = module_path(path, &src);
        let text = std::fs::read_to_string(path).unwrap();
        let here = rank(&module)
            .unwrap_or_else(|| panic!("{} is not listed in {krate}/src/lib.rs", path.display()));
        let imports: BTreeSet<Vec<String>> = (paths(&text, &module).into_iter())
            .filter(|path| path.first().is_some_and(|name| !name.is_empty()))
            .collect();
        for import in imports {
            // Items re-exported at the root of the crate (types, aliases) start with a capital.
            if import[0].starts_with(char::is_uppercase) {
                continue;
            }
            let name = import.join("::");
            let there =
                rank(&import).unwrap_or_else(|| panic!("{}: {name} is not listed", path.display()));
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
    check("firmware-host/controller");
    check("firmware-host/bench");
    check("firmware-host/studies");
    check("firmware-host/python");
    check("firmware-host/fmu");
}

/// The page that says how the supervisor works draws the stages of a tick as its crate does.
#[test]
fn the_page_draws_the_stages_of_the_crate() {
    let stages = |path: &str| {
        let text = std::fs::read_to_string(system_tests::root().join(path)).unwrap();
        let mut lines = text.lines().map(|l| l.trim_start_matches("//! "));
        let line = lines.find(|l| l.starts_with("Sample ─► "));
        line.expect("stages of a tick").to_owned()
    };
    assert_eq!(
        stages("docs/src/supervisor/how-it-works.md"),
        stages("supervisor/src/lib.rs")
    );
}

/// Neighbours in a folder that import each other, directly or through others: one circle, if there is any. A folder
/// counts as one with all that is in it, and with the file that has its name.
fn circle(krate: &str) -> Option<Vec<String>> {
    let src = system_tests::root().join(krate).join("src");
    let mut modules: Vec<(Vec<String>, String)> = Vec::new();
    for path in files_below(&src) {
        let here = module_path(&path, &src);
        if here != ["lib"] && here != ["main"] {
            modules.push((here, std::fs::read_to_string(&path).unwrap()));
        }
    }
    let mut known: BTreeSet<Vec<String>> = modules.iter().map(|(m, _)| m.clone()).collect();
    // A folder without a file of its name is one, too.
    known.extend(modules.iter().map(|(m, _)| m[..m.len() - 1].to_vec()));
    // From neighbour to neighbour: what two paths have in common, and one name more of each.
    let mut edges: BTreeSet<(Vec<String>, Vec<String>)> = BTreeSet::new();
    for (here, text) in &modules {
        for path in paths(text, here) {
            let common = here.iter().zip(&path).take_while(|(a, b)| a == b).count();
            if common == here.len() || common == path.len() {
                continue;
            }
            let (from, to) = (here[..=common].to_vec(), path[..=common].to_vec());
            if known.contains(&to) {
                edges.insert((from, to));
            }
        }
    }
    assert!(edges.len() > 5, "{krate}: {} imports", edges.len());
    // What nobody imports, or what imports nothing, is in no circle.
    loop {
        let before = edges.len();
        let (from, to): (BTreeSet<_>, BTreeSet<_>) = edges.iter().cloned().unzip();
        edges.retain(|(a, b)| to.contains(a) && from.contains(b));
        if edges.len() == before {
            break;
        }
    }
    let (from, _) = edges.first()?;
    let mut way = vec![from.clone()];
    loop {
        let last = way.last().unwrap().clone();
        let (_, next) = edges.iter().find(|(a, _)| *a == last)?;
        if let Some(begin) = way.iter().position(|m| m == next) {
            let names = way[begin..].iter().map(|m| m.join("::"));
            return Some(names.collect());
        }
        way.push(next.clone());
    }
}

#[test]
fn no_modules_import_each_other_in_circles() {
    for krate in [
        "supervisor",
        "plant-model",
        "firmware-host/bench",
        "firmware-host/studies",
        "firmware-host",
    ] {
        assert_eq!(circle(krate), None, "{krate}");
    }
}

/// The plant knows no control, the supervisor no plant.
/// Requirement: SR-33
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

/// Unsafe code is in the C interface, in the images, which talk to the linker, in the file that calls shared libraries of
/// the user's, and where the example for Embassy switches its interrupt on, and nowhere else.
/// Requirement: SR-33
#[test]
fn unsafe_code_stays_at_the_border() {
    let root = system_tests::root();
    let word = "unsafe";
    let code = ["{", "fn", "extern", "impl"].map(|after| format!("{word} {after}"));
    let mut read = 0;
    for folder in [
        "supervisor/src",
        "supervisor/tests",
        "plant-model",
        "firmware-host/src",
        "firmware-host/controller/src",
        "firmware-host/bench/src",
        "firmware-host/studies/src",
        "firmware-host/board-machine/src",
        "firmware-host/boards/stm32g4-rtic/src",
        "firmware-host/python/src",
        "tests/src",
        "tests/support/src",
        "tests/tests",
    ] {
        for path in files_below(&root.join(folder)) {
            if path.ends_with("controller/src/library.rs") {
                continue;
            }
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
    assert!(read > 100, "{read} files");
}

/// Names of functions, constants and statics that the code of a crate makes public.
fn public_names(text: &str) -> impl Iterator<Item = &str> {
    let after = |line: &'_ str| -> Option<usize> {
        let rest = line.trim_start().strip_prefix("pub ")?;
        let kinds = ["const fn ", "fn ", "const ", "static "];
        let kind = kinds.into_iter().find(|kind| rest.starts_with(kind))?;
        Some(line.len() - rest.len() + kind.len())
    };
    (text.lines()).filter_map(move |line| {
        let name = &line[after(line)?..];
        let end = name.find(|c: char| !c.is_alphanumeric() && c != '_');
        Some(&name[..end.unwrap_or(name.len())])
    })
}

/// What no other crate names is no crate's business: functions and constants are public where somebody outside calls them.
#[test]
fn what_nobody_else_names_is_private() {
    let root = system_tests::root();
    let words = |text: &str| -> BTreeSet<String> {
        let all = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        all.map(str::to_owned).collect()
    };
    let folders = ["supervisor", "plant-model", "firmware-host", "tests"];
    let files: Vec<(PathBuf, String)> = folders
        .into_iter()
        .flat_map(|folder| files_below(&root.join(folder)))
        .map(|path| (path.clone(), std::fs::read_to_string(path).unwrap()))
        .collect();
    let named: Vec<BTreeSet<String>> = files.iter().map(|(_, text)| words(text)).collect();
    let mut unused = Vec::new();
    for krate in [
        "supervisor/src",
        "plant-model/src",
        "firmware-host/bench/src",
        "firmware-host/studies/src",
    ] {
        let own = root.join(krate);
        let outside: BTreeSet<&str> = (files.iter().zip(&named))
            .filter(|((path, _), _)| !path.starts_with(&own))
            .flat_map(|(_, words)| words.iter().map(String::as_str))
            .collect();
        for (path, text) in files.iter().filter(|(path, _)| path.starts_with(&own)) {
            let names = public_names(text).filter(|name| !outside.contains(name));
            unused.extend(names.map(|name| format!("{}: {name}", path.display())));
        }
    }
    assert!(unused.is_empty(), "make these private: {unused:#?}");
}
