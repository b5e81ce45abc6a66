//! How results for people reach the terminal.

use crate::cli::error::{CommandError, print};
use anstream::{AutoStream, ColorChoice};
use firmware_bench::report::lines::{set_width, width, wrapped};
use firmware_bench::report::tone::set_colours;
use std::io::{IsTerminal, stdout};

/// Tables are made as wide as the terminal, and verdicts in its colours; before any is.
pub fn prepare() {
    if let Some((columns, _)) = terminal_size::terminal_size_of(stdout()) {
        set_width(columns.0.into());
    }
    // Whatever CLICOLOR_FORCE says, for a terminal alone: what a script reads or a file keeps has no colours.
    if stdout().is_terminal() && AutoStream::choice(&stdout()) != ColorChoice::Never {
        set_colours();
    }
}

/// Prints a command's result for a person.
///
/// # Errors
/// As of [`print()`].
pub(crate) fn print_wrapped(text: &str) -> Result<(), CommandError> {
    // For a terminal alone: what a script reads or searches must not depend on how long a path is.
    if !stdout().is_terminal() {
        return print(text);
    }
    print(&text.split_inclusive('\n').map(narrow).collect::<String>())
}

/// A sentence, broken between its words; a command stays whole, to be copied.
fn narrow(line: &str) -> String {
    if line.contains("firmware-host ") {
        return line.to_owned();
    }
    let sentence = line.trim_start_matches([' ', '-']);
    let indent = " ".repeat(line.len() - sentence.len());
    wrapped(line, &indent, width())
}
