//! `completions`: what a shell completes commands and options by.

use crate::cli::error::{CommandError, print};
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Debug, Clone, clap::Args)]
pub struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Prints the script for a shell.
///
/// # Errors
/// [`CommandError`] if nothing can be printed.
pub fn execute(args: &CompletionsArgs, command: &clap::Command) -> Result<(), CommandError> {
    const NAME: &str = "firmware-host";
    // What is hidden in help would be offered.
    let shown = command.get_subcommands().filter(|c| !c.is_hide_set());
    let mut shown = clap::Command::new(NAME)
        .args(command.get_arguments())
        .subcommands(shown);
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut shown, NAME, &mut script);
    print(&String::from_utf8_lossy(&script))
}
