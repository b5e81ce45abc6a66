//! Why a sweep could not be run.

use crate::scene::diagnostic::SceneError;
use parquet::errors::ParquetError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a sweep could not be run.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum SweepError {
    /// The sweep file or its scene is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Content(#[from] SceneError),
    /// A file could not be read.
    #[error("cannot read {what} {}: {reason}", path.display())]
    #[diagnostic(help("{help}"))]
    Read {
        /// Which file.
        what: &'static str,
        path: PathBuf,
        /// The system's message.
        reason: String,
        /// What to do.
        help: &'static str,
    },
    /// A folder has results of another sweep, or of this one as it was.
    #[error("{}: {what}", folder.display())]
    #[diagnostic(help("{help}"))]
    Other {
        folder: PathBuf,
        /// What is another.
        what: String,
        /// What to do.
        help: String,
    },
    /// Results could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    #[diagnostic(help(
        "free some space there, or give a folder that can be written to with --out; what is done is kept, and the same command goes on"
    ))]
    Write {
        /// What was to be written.
        path: PathBuf,
        /// The system's message.
        reason: String,
    },
}

impl SweepError {
    pub(crate) fn write(path: &Path) -> impl Fn(io::Error) -> Self {
        move |reason| Self::Write {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }

    pub(crate) fn written(path: &Path) -> impl Fn(ParquetError) -> Self {
        move |error| Self::write(path)(crate::run::trace_file::reason(error))
    }

    pub(crate) fn results(path: &Path, reason: impl std::fmt::Display) -> Self {
        Self::Read {
            what: "results",
            path: path.to_owned(),
            reason: reason.to_string(),
            help: "remove this file, and run the sweep again: only what is missing is run",
        }
    }
}
