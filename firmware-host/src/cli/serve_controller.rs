//! `serve-controller LIBRARY`, which no person types: the process that a run starts for a controller in a shared library.

use crate::cli::error::CommandError;
use firmware_bench::device::external::serve_libraries_by;
use firmware_controller::serve::serve;
use std::path::PathBuf;

/// Arguments of `serve-controller`.
#[derive(Debug, Clone, clap::Args)]
pub struct ServeArgs {
    /// The shared library.
    pub library: PathBuf,
}

/// Serves the library to whoever is at the other end of standard input.
///
/// # Errors
/// [`CommandError`] where there is nobody who asks as a run does.
pub fn execute(args: &ServeArgs) -> Result<(), CommandError> {
    serve(&args.library).map_err(|error| CommandError::other("serving a controller", error))
}

/// Has runs start this program for it.
pub fn by_this_program() {
    if let Ok(program) = std::env::current_exe() {
        serve_libraries_by(program);
    }
}
