//! Every documented misuse, from C.

use crate::library::{beside, said_with_rig};
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
    for source in SOURCES {
        let Some(output) = said_with_rig(source) else {
            return;
        };
        assert!(output.ends_with(" checks, 0 failures\n"), "{output}");
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
        let message = row.text.to_str().unwrap();
        // Success needs no text of its own.
        assert!(
            row.code == Code::OK || text.contains(&format!("\"{message}\"")),
            "the text of {name} is in no check"
        );
    }
}
