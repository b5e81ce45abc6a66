//! The crates as they are packed for firmware that vendors them: complete, and built where nothing else of the project is.

use crate::library::{finished, good, tool};
use std::path::{Path, PathBuf};
use std::process::Command;
use system_tests::root;

/// Folder in the project and name of each crate that is packed.
const CRATES: [(&str, &str); 3] = [
    ("supervisor", "supervisor"),
    ("supervisor/capi", "supervisor-capi"),
    ("plant-model", "plant-model"),
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
    pack.arg("--target-dir").arg(here.join("target"));
    good(&pack.output().unwrap());
    CRATES
        .map(|(folder, name)| {
            let name = format!("{name}-{}", env!("CARGO_PKG_VERSION"));
            let file = here.join(format!("target/package/{name}.crate"));
            // As of now and not of the archive's time: cargo takes a source that is older than what was built for built.
            let mut tar = tool("tar").expect("every system has it");
            good(
                &tar.arg("-xzmf")
                    .arg(file)
                    .current_dir(here)
                    .output()
                    .unwrap(),
            );
            (root().join(folder), here.join(name))
        })
        .to_vec()
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
        assert!(read(package.join("README.md")) == read(source.join("README.md")));
        let manifest = read(package.join("Cargo.toml"));
        for part in [
            "rust-version = \"",
            "license = \"MIT OR Apache-2.0\"",
            "readme = ",
            "keywords = ",
            "categories = ",
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
        others.retain(|name| {
            !["src", "include", "examples", "tests", "build.rs"]
                .iter()
                .any(|known| name == known)
        });
        // Three of those above, and three that cargo writes; one more where the sources are in a repository.
        let count = others
            .iter()
            .filter(|name| *name != ".cargo_vcs_info.json")
            .count();
        assert_eq!(count, 6, "{others:?}");
    }

    // As the README of the C interface says: a folder beside it, and what cargo has to know.
    let [(_, supervisor), (_, capi), _] = packed.as_slice() else {
        panic!("three crates")
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
