//! The folder for those without Rust: what uses it, and that the same sources give the same bytes in another folder.

use crate::library::{STRICT, capi, host_tuple, tool};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use system_tests::ran::{Folder, Ran, flat, has, ran};
use system_tests::root;

/// Builds the folder for one target from sources that lie here, and says what the compiler said. The project's own are compiled
/// once for all tests, those that lie elsewhere apart from them.
fn build(sources: &Path, out: &Path, target: &str) -> String {
    let mut script = Command::new(sources.join("supervisor/capi/prebuilt/build"));
    script.arg(out).arg(target);
    if sources != root() {
        let apart = root().join("target-fw/prebuilt-test");
        script.env("CARGO_BUILD_BUILD_DIR", apart);
    }
    let Ran {
        code,
        said,
        printed,
    } = ran(&mut script);
    assert_eq!(code, Some(0), "{printed}{said}");
    said
}

/// What pkg-config says of the library, for the compiler.
fn flags(lib: &Path) -> Option<Vec<String>> {
    let mut pkg_config = tool("pkg-config")?;
    pkg_config.env("PKG_CONFIG_PATH", lib.join("pkgconfig"));
    pkg_config.args(["--static", "--cflags", "--libs", "amb_supervisor >= 0.1"]);
    let said = ran(&mut pkg_config).good();
    Some(said.split_whitespace().map(str::to_owned).collect())
}

#[test]
fn it_is_used_without_rust_and_has_the_same_bytes_from_elsewhere() {
    let folder = Folder::fresh();
    let (out, host) = (folder.at("amb_supervisor"), host_tuple());
    build(&root(), &out, &host);
    let lib = out.join("lib").join(&host);
    let two_planes = capi().join("examples/two_planes.c");

    let mut sums = tool("sha256sum").unwrap();
    sums.args(["--check", "--strict", "--quiet", "SHA256SUMS"]);
    ran(sums.current_dir(&out)).good();
    for licence in [
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "licences/heapless-0.9.3/LICENSE-MIT",
    ] {
        assert!(out.join(licence).exists(), "{licence}");
    }

    let mut said = Vec::new();
    if let (Some(mut cc), Some(flags)) = (tool("cc"), flags(&lib)) {
        let program = folder.at("two_planes");
        cc.args(STRICT).arg(&two_planes).args(flags);
        ran(cc.args(["-lm", "-o"]).arg(&program)).good();
        let mut run = Command::new(&program);
        said.push(ran(run.env("LD_LIBRARY_PATH", &lib).arg("7")).good());
    }
    if tool("cmake").is_some() {
        let project = format!(
            "cmake_minimum_required(VERSION 3.20)\nproject(check C)\nfind_package(amb_supervisor {1}.{2} REQUIRED)\n\
             add_executable(static {0})\ntarget_link_libraries(static amb_supervisor::amb_supervisor m)\n\
             add_executable(shared {0})\ntarget_link_libraries(shared amb_supervisor::shared m)\n",
            two_planes.display(),
            env!("CARGO_PKG_VERSION_MAJOR"),
            env!("CARGO_PKG_VERSION_MINOR"),
        );
        folder.put("CMakeLists.txt", project);
        let prefix = format!("-DCMAKE_PREFIX_PATH={}", out.display());
        let cmake = |arguments: &[&str]| {
            let mut cmake = Command::new("cmake");
            ran(cmake.current_dir(folder.at(".")).args(arguments))
        };
        cmake(&["-B", "build", &prefix]).good();
        cmake(&["--build", "build"]).good();
        for program in ["build/static", "build/shared"] {
            said.push(ran(Command::new(folder.at(program)).arg("7")).good());
        }
        // A target that is not there is named with those that are.
        let nowhere = "-DAMB_SUPERVISOR_TARGET=nowhere";
        let wrong = cmake(&["-B", "wrong", &prefix, nowhere]);
        has(&flat(&wrong.said), &["nowhere", &host]);
    }
    for text in &said {
        assert_eq!(text, &said[0]);
        has(text, &["touches"]);
    }

    python(&folder.at(""), &host);
    same_bytes_from_elsewhere(&folder.at(""), &out, &host);
}

/// The example in Python, in a folder that has the library.
fn python(folder: &Path, host: &str) {
    let Some(mut python) = tool("python3") else {
        return;
    };
    let script = std::fs::read_to_string(capi().join("examples/ctypes_tick.py")).unwrap();
    let script = script.replace("x86_64-unknown-linux-gnu", host);
    python.args(["-c", &script]).current_dir(folder);
    let said = ran(&mut python).good();
    let lines: Vec<_> = said.lines().collect();
    assert_eq!(lines[0], "0 levitated -12.5 N 25.0 N");
    assert!(lines[9].starts_with("9 approach -"), "{said}");
}

fn same_bytes_from_elsewhere(folder: &Path, out: &Path, target: &str) {
    let sources = folder.join("another/folder");
    std::fs::create_dir_all(sources.join("tests")).unwrap();
    for part in [
        "Cargo.toml",
        "Cargo.lock",
        ".cargo",
        "rust-toolchain.toml",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "supervisor",
        "plant-model",
        "firmware-host",
        "tests/Cargo.toml",
        "tests/src",
        "tests/support",
    ] {
        let mut copy = Command::new("cp");
        copy.arg("-r").arg(root().join(part));
        ran(copy.arg(sources.join(part))).good();
    }
    let again = folder.join("again");
    let said = build(&sources, &again, target);
    // Compiled there, and not found where the first ones were.
    let version = env!("CARGO_PKG_VERSION");
    let compiled = format!("Compiling amb-supervisor v{version} ({}", sources.display());
    has(&said, &[&compiled]);
    let sums = |folder: &Path| -> BTreeSet<String> {
        let sums = std::fs::read_to_string(folder.join("SHA256SUMS")).unwrap();
        sums.lines().map(str::to_owned).collect()
    };
    let (first, second) = (sums(out), sums(&again));
    let apart: Vec<_> = first.symmetric_difference(&second).collect();
    assert!(apart.is_empty() && first.len() > 20, "{apart:#?}");
}
