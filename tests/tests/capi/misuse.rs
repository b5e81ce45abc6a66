//! Every documented misuse, from C.

use crate::library::{Target, beside, built, capi, good, host_program};
use std::process::Command;
use supervisor_capi::{Code, code::CODES};

/// One plane, a rotor in two, a ledger, and an archive.
const SOURCES: [&str; 4] = [
    "misuse.c",
    "misuse_rotor.c",
    "misuse_ledger.c",
    "misuse_archive.c",
];

/// Requirements: SR-28, SR-37
#[test]
fn every_misuse_gives_its_error_and_text() {
    let Some(library) = built(Target::Host, "") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("misuse");
    for source in SOURCES {
        let sources = [beside(source), capi().join("examples/rig.c")];
        let Some(output) = host_program(&sources, &library, &program) else {
            return;
        };
        good(&output);
        let said = good(&Command::new(&program).output().unwrap());
        assert!(said.ends_with(" checks, 0 failures\n"), "{said}");
    }
}

/// No code was forgotten.
/// Requirement: SR-37
#[test]
fn every_code_is_provoked() {
    let text = SOURCES.map(|source| std::fs::read_to_string(beside(source)).unwrap());
    let text = text.concat();
    for row in CODES {
        let name = format!("AMB_{}", row.name);
        assert!(text.contains(&name), "{name} is in no check");
        let said = row.text.to_str().unwrap();
        // Success needs no text of its own.
        assert!(
            row.code == Code::OK || text.contains(&format!("\"{said}\"")),
            "the text of {name} is in no check"
        );
    }
}
