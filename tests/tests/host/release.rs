//! What a release consists of: one version everywhere, changes of every crate, and the folder that `firmware-host/dist` makes.

use crate::licences::metadata;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use system_tests::ran::{Folder, ran};
use system_tests::{host, root};

/// The version of the workspace, which this crate has from there.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Crates that are not published: they are built or loaded from the project's folder alone.
const KEPT: [&str; 4] = [
    "board-machine",
    "firmware-python",
    "system-tests",
    "test-support",
];

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn toml_of(path: impl AsRef<Path>) -> toml::Table {
    read(path).parse().unwrap()
}

/// Files of the project that git knows, with this ending.
fn files(ending: &str) -> Vec<PathBuf> {
    let mut git = Command::new("git");
    git.args(["ls-files", "-z", &format!("*{ending}")]);
    let names = ran(git.current_dir(root())).good();
    names.split_terminator('\0').map(PathBuf::from).collect()
}

/// Versions in a text that are behind this name and a hyphen, as `name-1.2.3` has one.
fn versions_behind<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let ends = |rest: &'a str| {
        let version = rest.split(|c: char| !c.is_ascii_digit() && c != '.').next();
        version.unwrap_or_default().trim_end_matches('.')
    };
    let start = format!("{name}-");
    let behind = text.split(start.as_str()).skip(1).map(ends);
    behind.filter(|version| version.contains('.')).collect()
}

#[test]
fn there_is_one_version() {
    let metadata = metadata();
    let members: BTreeSet<&str> = metadata["workspace_members"]
        .as_array()
        .unwrap()
        .iter()
        .map(|id| id.as_str().unwrap())
        .collect();
    let packages = metadata["packages"].as_array().unwrap();
    let ours: Vec<_> = packages
        .iter()
        .filter(|p| members.contains(p["id"].as_str().unwrap()))
        .collect();
    assert_eq!(ours.len(), members.len());
    for package in &ours {
        let name = package["name"].as_str().unwrap();
        assert_eq!(package["version"], VERSION, "{name}");
        // `null` is any registry, an empty list none.
        let kept = package["publish"].is_array();
        assert_eq!(kept, KEPT.contains(&name), "{name}: publish");
        let dependencies = package["dependencies"].as_array().unwrap();
        for asked in dependencies.iter().filter(|d| d["path"].is_string()) {
            let (what, req) = (&asked["name"], asked["req"].as_str().unwrap());
            // What is not published is asked for without a version, and left out of what is packed.
            let without = KEPT.iter().any(|kept| what == kept);
            let wanted = match without {
                true => "*".to_owned(),
                false => format!("^{VERSION}"),
            };
            assert_eq!(req, wanted, "{name}: {what}");
        }
    }
    // Workspaces of their own: the boards have the version, what only tests has none.
    for manifest in files("Cargo.toml") {
        let table = toml_of(&manifest);
        let of = |table: &toml::Table| {
            table
                .get("version")
                .and_then(|v| v.as_str().map(str::to_owned))
        };
        let workspace = table.get("workspace").and_then(|w| w.as_table());
        let common = (workspace.and_then(|w| w.get("package"))).and_then(|p| of(p.as_table()?));
        let own = (table.get("package")).and_then(|p| of(p.as_table()?));
        for version in common.iter().chain(&own) {
            assert_eq!(version, VERSION, "{}", manifest.display());
        }
    }
    // Where people read it.
    let mut said = 0;
    for page in files(".md") {
        let text = read(&page);
        for package in &ours {
            for version in versions_behind(&text, package["name"].as_str().unwrap()) {
                assert_eq!(version, VERSION, "{}", page.display());
                said += 1;
            }
        }
    }
    assert!(said >= 3, "{said} pages name a package's file");
    let (minor, _) = VERSION.rsplit_once('.').unwrap();
    let cmake = format!("find_package(amb_supervisor {minor} REQUIRED)");
    assert!(read("docs/src/supervisor/c.md").contains(&cmake), "{cmake}");
    assert!(
        toml_of("firmware-host/python/pyproject.toml")["project"]["dynamic"]
            .as_array()
            .unwrap()
            .contains(&"version".into())
    );
    let program = host().arg("--version").output().unwrap();
    let says = String::from_utf8(program.stdout).unwrap();
    assert_eq!(says.trim(), format!("firmware-host {VERSION}"));
}

/// The newest entry is of this version, or what comes after it.
#[test]
fn every_list_of_changes_has_this_version() {
    let lists = files("CHANGELOG.md");
    assert_eq!(lists.len(), 5, "{lists:?}");
    let overview = read("CHANGELOG.md");
    for list in lists {
        let text = read(&list);
        let mut heads = text.lines().filter_map(|line| line.strip_prefix("## "));
        let newest = heads.find(|head| *head != "Unreleased").unwrap_or_default();
        let (version, date) = newest.split_once(' ').unwrap_or_default();
        assert_eq!(version, VERSION, "{}", list.display());
        let digits = |c: char| c.is_ascii_digit();
        let shape = date.replace(digits, "0");
        assert_eq!(shape, "(0000-00-00)", "{}: {date}", list.display());
        assert!(
            list == Path::new("CHANGELOG.md")
                || overview.contains(&format!("({})", list.display())),
            "{} is not named in CHANGELOG.md",
            list.display()
        );
    }
}

/// The script around what the tests have built: the folder is complete and summed, and the program runs where it is unpacked.
#[test]
fn a_release_is_whole_and_runs_where_it_is_unpacked() {
    let mut dist = Command::new(root().join("firmware-host/dist"));
    ran(dist.arg("--trial").current_dir(root())).good();
    let made = root().join(format!("target/dist/{VERSION}-trial"));
    let mut sums = Command::new("sha256sum");
    sums.args(["--check", "--strict", "SHA256SUMS"]);
    ran(sums.current_dir(&made)).good();
    let summed = read(made.join("SHA256SUMS"));
    let folder = Folder::fresh();
    let mut unpacked = Vec::new();
    for archive in ["firmware-host-", "amb_supervisor-"] {
        let name = (summed.lines().filter_map(|line| line.split_once("  ")))
            .map(|(_, name)| name)
            .find(|name| name.starts_with(&format!("{archive}{VERSION}")));
        let name = name.unwrap_or_else(|| panic!("{archive}: {summed}"));
        let mut tar = Command::new("tar");
        tar.arg("-xzf").arg(made.join(name));
        ran(tar.current_dir(folder.at("."))).good();
        unpacked.push(folder.at(name.trim_end_matches(".tar.gz")));
    }
    let [program, library] = &unpacked[..] else {
        panic!("two archives")
    };
    assert!(library.join("include/amb_supervisor.h").is_file());

    let run = || Command::new(program.join("bin/firmware-host"));
    let version = ran(run().arg("--version")).good();
    assert_eq!(version.trim(), format!("firmware-host {VERSION}"));
    let mut make = run();
    make.arg("fmu")
        .arg(program.join("scenes/impact_at_40_hz.toml"));
    ran(make.arg("--out").arg(folder.at("units"))).good();
    assert!(folder.at("units/supervisor.fmu").is_file());

    // Whose code it is: every crate with its licence, most with the text of it.
    let linked = read(program.join("licences/crates"));
    assert!(linked.lines().count() > 100, "{linked}");
    for line in linked.lines() {
        let (name, licence) = line.split_once('|').unwrap();
        assert!(!name.is_empty() && !licence.is_empty(), "{line}");
        assert!(
            !name.contains('/') && !name.starts_with("firmware-"),
            "{line}"
        );
    }
    let texts = std::fs::read_dir(program.join("licences")).unwrap().count();
    assert!(10 * texts > 8 * linked.lines().count(), "{texts} texts");
}
