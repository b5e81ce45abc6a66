//! A header against a library of another version.

use crate::library::{Target, beside, built, capi, host_program};
use supervisor_capi::layout::HEADER;
use system_tests::ran::{Folder, Ran, edited, has};

/// Compiles and links a program with a header that speaks `header`, where the library's version file
/// says `library`. The library itself speaks the version of this source.
fn attempt(header: u32, library: u32) -> Option<Ran> {
    let built = built(Target::Host)?;
    let folder = Folder::fresh();
    let version = |abi: u32| format!("#define AMB_ABI {abi}\n");
    let own = version(supervisor_capi::ABI);
    let changed = edited(HEADER, &[(&own, &version(header))]);
    folder.put("amb_supervisor.h", changed);
    let version = format!("#define AMB_LIBRARY_ABI {library}\n");
    folder.put("amb_supervisor_abi.h", version);
    // The compiler looks beside a source first: there the other header is.
    let example = capi().join("examples");
    for file in [
        built.join("libsupervisor_capi.a"),
        example.join("rig.h"),
        example.join("rig.c"),
        beside("replay.c"),
    ] {
        let name = file.file_name().unwrap().to_str().unwrap();
        std::fs::copy(&file, folder.at(name)).unwrap();
    }
    let sources = ["rig.c", "replay.c"].map(|name| folder.at(name));
    host_program(&sources, &folder.at("."), &folder.at("program"))
}

#[test]
fn the_same_version_compiles_and_links() {
    let own = supervisor_capi::ABI;
    if let Some(attempt) = attempt(own, own) {
        attempt.good();
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
        has(&attempt.fails(1), &["are of different versions"]);
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
    has(&attempt.fails(1), &[&format!("amb_tick_abi{other}")]);
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
