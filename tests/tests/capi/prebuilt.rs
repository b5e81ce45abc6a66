//! The folder for those without Rust: what uses it, and that the same sources give the same bytes in another folder.

use crate::library::{STRICT, capi, good, tool};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
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
    let output = script.output().unwrap();
    good(&output);
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn host() -> String {
    let rustc = Command::new("rustc")
        .args(["--print", "host-tuple"])
        .output();
    good(&rustc.unwrap()).trim().to_owned()
}

/// What pkg-config says of the library, for the compiler.
fn flags(lib: &Path) -> Option<Vec<String>> {
    let mut pkg_config = tool("pkg-config")?;
    pkg_config.env("PKG_CONFIG_PATH", lib.join("pkgconfig"));
    let output = pkg_config
        .args(["--static", "--cflags", "--libs", "amb_supervisor >= 0.1"])
        .output();
    Some(
        good(&output.unwrap())
            .split_whitespace()
            .map(str::to_owned)
            .collect(),
    )
}

#[test]
fn it_is_used_without_rust_and_has_the_same_bytes_from_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let (out, host) = (folder.path().join("amb_supervisor"), host());
    build(&root(), &out, &host);
    let (lib, two_planes) = (
        out.join("lib").join(&host),
        capi().join("examples/two_planes.c"),
    );

    let mut sums = tool("sha256sum").unwrap();
    good(
        &sums
            .args(["--check", "--strict", "--quiet", "SHA256SUMS"])
            .current_dir(&out)
            .output()
            .unwrap(),
    );
    for licence in [
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "licences/heapless-0.9.3/LICENSE-MIT",
    ] {
        assert!(out.join(licence).exists(), "{licence}");
    }

    let mut shown = Vec::new();
    if let (Some(mut cc), Some(flags)) = (tool("cc"), flags(&lib)) {
        let program = folder.path().join("two_planes");
        cc.args(STRICT)
            .arg(&two_planes)
            .args(flags)
            .arg("-lm")
            .arg("-o")
            .arg(&program);
        good(&cc.output().unwrap());
        let library_path = Command::new(&program)
            .env("LD_LIBRARY_PATH", &lib)
            .arg("7")
            .output();
        shown.push(good(&library_path.unwrap()));
    }
    if let Some(mut cmake) = tool("cmake") {
        let project = format!(
            "cmake_minimum_required(VERSION 3.20)\nproject(check C)\nfind_package(amb_supervisor {1}.{2} REQUIRED)\n\
             add_executable(static {0})\ntarget_link_libraries(static amb_supervisor::amb_supervisor m)\n\
             add_executable(shared {0})\ntarget_link_libraries(shared amb_supervisor::shared m)\n",
            two_planes.display(),
            env!("CARGO_PKG_VERSION_MAJOR"),
            env!("CARGO_PKG_VERSION_MINOR"),
        );
        let sources = folder.path().join("cmake");
        std::fs::create_dir(&sources).unwrap();
        std::fs::write(sources.join("CMakeLists.txt"), project).unwrap();
        let prefix = format!("-DCMAKE_PREFIX_PATH={}", out.display());
        good(
            &cmake
                .current_dir(&sources)
                .args(["-B", "build", &prefix])
                .output()
                .unwrap(),
        );
        good(
            &tool("cmake")
                .unwrap()
                .current_dir(&sources)
                .args(["--build", "build"])
                .output()
                .unwrap(),
        );
        for program in ["build/static", "build/shared"] {
            shown.push(good(
                &Command::new(sources.join(program))
                    .arg("7")
                    .output()
                    .unwrap(),
            ));
        }
        // A target that is not there is named with those that are.
        let mut wrong = tool("cmake").unwrap();
        wrong.current_dir(&sources).args([
            "-B",
            "wrong",
            &prefix,
            "-DAMB_SUPERVISOR_TARGET=nowhere",
        ]);
        let wrong = String::from_utf8_lossy(&wrong.output().unwrap().stderr).replace("\n", " ");
        assert!(
            wrong.contains("nowhere") && wrong.contains(&host),
            "{wrong}"
        );
    }
    assert!(
        shown
            .iter()
            .all(|text| text == &shown[0] && text.contains("touches")),
        "{shown:?}"
    );

    python(folder.path(), &host);
    same_bytes_from_elsewhere(folder.path(), &out, &host);
}

/// The example in Python, in a folder that has the library.
fn python(folder: &Path, host: &str) {
    let Some(mut python) = tool("python3") else {
        return;
    };
    let script = std::fs::read_to_string(capi().join("examples/ctypes_tick.py")).unwrap();
    let script = script.replace("x86_64-unknown-linux-gnu", host);
    let shown = good(
        &python
            .arg("-c")
            .arg(script)
            .current_dir(folder)
            .output()
            .unwrap(),
    );
    let lines: Vec<_> = shown.lines().collect();
    assert_eq!(lines[0], "0 levitated -12.5 N 25.0 N");
    assert!(lines[9].starts_with("9 approach -"), "{shown}");
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
        copy.arg("-r")
            .arg(root().join(part))
            .arg(sources.join(part));
        good(&copy.output().unwrap());
    }
    let again = folder.join("again");
    let shown = build(&sources, &again, target);
    // Compiled there, and not found where the first ones were.
    let compiled = format!(
        "Compiling amb-supervisor v{} ({}",
        env!("CARGO_PKG_VERSION"),
        sources.display()
    );
    assert!(shown.contains(&compiled), "{shown}");
    let sums = |folder: &Path| -> BTreeSet<String> {
        let sums = std::fs::read_to_string(folder.join("SHA256SUMS")).unwrap();
        sums.lines().map(str::to_owned).collect()
    };
    let (first, second) = (sums(out), sums(&again));
    let apart: Vec<_> = first.symmetric_difference(&second).collect();
    assert!(apart.is_empty() && first.len() > 20, "{apart:#?}");
}
