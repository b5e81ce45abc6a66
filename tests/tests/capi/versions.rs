//! A header against a library of another version.

use crate::library::{Target, beside, built, capi, host_program};
use std::path::PathBuf;

struct Attempt {
    succeeded: bool,
    stderr: String,
}

/// Compiles and links a program with a header that speaks `header`, where the library's version file
/// says `library`. The library itself speaks the version of this source.
fn attempt(header: u32, library: u32) -> Option<Attempt> {
    let built = built(Target::Host)?;
    let folder = tempfile::tempdir().unwrap();
    let text = supervisor_capi::layout::HEADER;
    let version = format!("#define AMB_ABI {}\n", supervisor_capi::ABI);
    assert!(text.contains(&version));
    let changed = text.replace(&version, &format!("#define AMB_ABI {header}\n"));
    std::fs::write(folder.path().join("amb_supervisor.h"), changed).unwrap();
    let version = format!("#define AMB_LIBRARY_ABI {library}\n");
    std::fs::write(folder.path().join("amb_supervisor_abi.h"), version).unwrap();
    let archive = "libsupervisor_capi.a";
    std::fs::copy(built.join(archive), folder.path().join(archive)).unwrap();
    // The compiler looks beside a source first: there the other header is.
    let sources: [PathBuf; 2] = ["rig.c", "replay.c"].map(|name| folder.path().join(name));
    let example = capi().join("examples");
    std::fs::copy(example.join("rig.h"), folder.path().join("rig.h")).unwrap();
    std::fs::copy(example.join("rig.c"), &sources[0]).unwrap();
    std::fs::copy(beside("replay.c"), &sources[1]).unwrap();
    let output = host_program(&sources, folder.path(), &folder.path().join("program"))?;
    Some(Attempt {
        succeeded: output.status.success(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    })
}

#[test]
fn the_same_version_compiles_and_links() {
    let own = supervisor_capi::ABI;
    if let Some(attempt) = attempt(own, own) {
        assert!(attempt.succeeded, "{}", attempt.stderr);
    }
}

/// Requirement: SR-38
#[test]
fn another_version_does_not_compile() {
    let own = supervisor_capi::ABI;
    // A newer header, and a newer library.
    for (header, library) in [(own + 1, own), (own, own + 1)] {
        let Some(attempt) = attempt(header, library) else {
            return;
        };
        assert!(!attempt.succeeded);
        let says = attempt.stderr.contains("are of different versions");
        assert!(says, "{}", attempt.stderr);
    }
}

/// Where the version file was not taken from beside the library, the linker finds out.
/// Requirement: SR-38
#[test]
fn another_version_does_not_link() {
    let other = supervisor_capi::ABI + 1;
    let Some(attempt) = attempt(other, other) else {
        return;
    };
    assert!(!attempt.succeeded);
    let missing = format!("amb_tick_abi{other}");
    assert!(attempt.stderr.contains(&missing), "{}", attempt.stderr);
}

/// The build says of the library what the library says of itself.
/// Requirement: SR-38
#[test]
fn the_version_is_beside_the_library() {
    for target in [Target::Host, Target::CortexM4F] {
        let Some(library) = built(target) else {
            return;
        };
        let text = std::fs::read_to_string(library.join("amb_supervisor_abi.h")).unwrap();
        let version = format!("#define AMB_LIBRARY_ABI {}\n", supervisor_capi::ABI);
        assert!(text.ends_with(&version), "{text}");
    }
}
