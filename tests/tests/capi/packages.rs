//! The crates as they are packed for a registry, and for firmware that vendors them: complete, and built where nothing else of the
//! project is.

use crate::library::{finished, tool};
use std::path::{Path, PathBuf};
use std::process::Command;
use system_tests::ran::{Ran, ran};
use system_tests::root;

/// Folder in the project and name of each crate that is packed.
const CRATES: [(&str, &str); 9] = [
    ("supervisor", "amb-supervisor"),
    ("supervisor/capi", "supervisor-capi"),
    ("plant-model", "plant-model"),
    ("firmware-host", "firmware-host"),
    ("firmware-host/controller", "firmware-controller"),
    ("firmware-host/image", "firmware-image"),
    ("firmware-host/bench", "firmware-bench"),
    ("firmware-host/studies", "firmware-studies"),
    ("firmware-host/fmu", "firmware-fmu"),
];

/// What a package has at its top, beside what cargo writes and what every crate has.
const OTHERS: [&str; 8] = [
    "src",
    "include",
    "examples",
    "tests",
    "scenes",
    "build.rs",
    "panic_free.x",
    "CHANGELOG.md",
];

fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Packs the crates and unpacks them here, each in a folder of its name and version.
fn unpacked(here: &Path) -> Vec<(PathBuf, PathBuf)> {
    let mut pack = cargo();
    pack.current_dir(root());
    pack.args(["package", "--no-verify", "--offline", "--allow-dirty"]);
    pack.args(CRATES.map(|(_, name)| format!("-p={name}")));
    let Ran { code, said, .. } = ran(pack.arg("--target-dir").arg(here.join("target")));
    assert_eq!(code, Some(0), "{said}");
    // Tests of a crate stay with its sources.
    let is_known = |line: &str| line.starts_with("warning: ignoring test `");
    let mut others = said.lines().filter(|line| !is_known(line));
    assert!(!others.any(|line| line.contains("warning")), "{said}");
    CRATES
        .map(|(folder, name)| {
            let name = format!("{name}-{}", env!("CARGO_PKG_VERSION"));
            let file = here.join(format!("target/package/{name}.crate"));
            // As of now and not of the archive's time: cargo takes a source that is older than what was built for built.
            let mut tar = tool("tar").expect("every system has it");
            ran(tar.arg("-xzmf").arg(file).current_dir(here)).good();
            (root().join(folder), here.join(name))
        })
        .to_vec()
}

/// Files that the sources below a folder name to have their text compiled in.
fn included(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(included(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let named = text.split("include_str!(\"").skip(1);
            found.extend(named.map(|rest| folder.join(rest.split('"').next().unwrap())));
        }
    }
    found
}

#[test]
fn packed_crates_are_complete_and_build_alone() {
    let folder = tempfile::tempdir().unwrap();
    let packed = unpacked(folder.path());
    let read = |path: PathBuf| {
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    for (source, package) in &packed {
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(
                read(package.join(licence)) == read(root().join(licence)),
                "{}",
                package.display()
            );
        }
        let manifest = read(package.join("Cargo.toml"));
        // The crates of the host share its own.
        let readme = [source.as_path(), source.parent().unwrap()]
            .map(|folder| folder.join("README.md"))
            .into_iter()
            .find(|readme| readme.exists());
        assert!(read(package.join("README.md")) == read(readme.unwrap()));
        for file in included(&package.join("src")) {
            assert!(file.exists(), "{}", file.display());
        }
        for part in [
            "rust-version = \"",
            "license = \"MIT OR Apache-2.0\"",
            "readme = ",
            "keywords = ",
            "categories = ",
            "documentation = ",
        ] {
            assert!(manifest.contains(part), "{}: {part}", package.display());
        }
        for part in ["workspace", "path = \"..", "publish"] {
            assert!(!manifest.contains(part), "{}: {part}", package.display());
        }
        let mut others: Vec<_> = std::fs::read_dir(package)
            .unwrap()
            .map(|e| e.unwrap().file_name())
            .collect();
        others.retain(|name| !OTHERS.iter().any(|known| name == known));
        // Three of those above, and three that cargo writes; one more where the sources are in a repository.
        let count = others
            .iter()
            .filter(|name| *name != ".cargo_vcs_info.json")
            .count();
        assert_eq!(count, 6, "{others:?}");
    }

    // As the README of the C interface says: a folder beside it, and what cargo has to know.
    let [(_, supervisor), (_, capi), ..] = packed.as_slice() else {
        panic!("CRATES begins with these")
    };
    let vendor = folder.path().join("vendor");
    std::fs::create_dir_all(folder.path().join(".cargo")).unwrap();
    std::fs::create_dir(&vendor).unwrap();
    std::fs::rename(supervisor, vendor.join(supervisor.file_name().unwrap())).unwrap();
    let readme = read(capi.join("README.md"));
    let config = readme
        .split("```toml\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    std::fs::write(folder.path().join(".cargo/config.toml"), config.unwrap()).unwrap();
    let command = readme.lines().find_map(|line| line.strip_prefix("cargo "));
    let mut build = cargo();
    build
        .args(command.unwrap().split(' '))
        .arg("--offline")
        .current_dir(capi);
    // What others wrote is compiled once for this and the tests of the C library.
    build.env("CARGO_BUILD_BUILD_DIR", root().join("target-fw"));
    if finished(build).is_some() {
        let library = capi.join("target/thumbv7em-none-eabihf/fw/libsupervisor_capi.a");
        assert!(library.exists(), "{}", library.display());
    }
}
