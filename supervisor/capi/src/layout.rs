//! What the header says, read where this crate is compiled: if the two disagree on a size, an offset or
//! the version, it does not compile.

/// The header.
pub const HEADER: &str = include_str!("../include/amb_supervisor.h");

/// Layout of a struct of the header.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// Its name there.
    pub name: &'static str,
    /// Size in bytes.
    pub size: usize,
    /// Name, offset and size of each field, in bytes.
    pub fields: &'static [(&'static str, usize, usize)],
}

/// Number that the header defines under this name, as `#define NAME 123`, perhaps followed by `u`.
///
/// # Panics
/// At compile time, if there is none.
#[expect(clippy::panic, reason = "runs at compile time alone")]
pub(crate) const fn defined(name: &str) -> usize {
    let header = HEADER.as_bytes();
    let mut i = 0;
    while i < header.len() {
        if starts_with(header, i, b"#define ") {
            let after = i + b"#define ".len();
            let value = after + name.len();
            if starts_with(header, after, name.as_bytes()) && at(header, value) == b' ' {
                return number(header, value);
            }
        }
        i += 1;
    }
    panic!("the header does not define this name");
}

const fn at(text: &[u8], i: usize) -> u8 {
    if i < text.len() { text[i] } else { 0 }
}

const fn starts_with(text: &[u8], from: usize, start: &[u8]) -> bool {
    let mut i = 0;
    while i < start.len() {
        if at(text, from + i) != start[i] {
            return false;
        }
        i += 1;
    }
    true
}

const fn number(text: &[u8], mut i: usize) -> usize {
    while at(text, i) == b' ' {
        i += 1;
    }
    assert!(at(text, i).is_ascii_digit(), "a number was expected");
    let mut value = 0;
    while at(text, i).is_ascii_digit() {
        value = value * 10 + (at(text, i) - b'0') as usize;
        i += 1;
    }
    value
}

const _: () = {
    assert!(defined("AMB_ABI") == crate::version::ABI as usize);
    assert!(
        defined("AMB_PARAMETERS") == supervisor::PARAMETERS.len(),
        "run `cargo run --release -p system-tests --bin parameters -- --write`: the header has other parameters"
    );
    assert!(defined("AMB_RECORD_VERSION") == supervisor::RECORD_VERSION as usize);
    assert!(defined("AMB_SECTION_BYTES") == supervisor::SECTION_BYTES);
    assert!(defined("AMB_LEDGER_VERSION") == supervisor::LEDGER_VERSION as usize);
    assert!(defined("AMB_LEDGER_BYTES") == supervisor::LEDGER_BYTES);
};
