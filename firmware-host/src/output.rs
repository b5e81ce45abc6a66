//! Results appear whole or not at all.

use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder that is filled beside its final place and moved there at the end.
#[derive(Debug)]
pub struct Staging {
    final_place: PathBuf,
    folder: TempDir,
}

/// Why results could not be written.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("cannot write results to {}: {reason}", path.display())]
#[diagnostic(help("give a folder that can be written to with --out"))]
pub struct OutputError {
    /// The folder asked for.
    pub path: PathBuf,
    /// What the system said.
    pub reason: io::Error,
}

impl Staging {
    /// Prepares a folder for `final_place`; fails before any work is done if that cannot be written.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn beside(final_place: &Path) -> Result<Self, OutputError> {
        let prepare = || {
            if final_place.exists() && !final_place.is_dir() {
                return Err(io::Error::from(io::ErrorKind::NotADirectory));
            }
            let parent = match final_place.parent() {
                Some(p) if !p.as_os_str().is_empty() => p,
                _ => Path::new("."),
            };
            std::fs::create_dir_all(parent)?;
            if final_place.is_dir() {
                // An existing folder may be read-only although its parent is not.
                drop(TempDir::with_prefix_in(".probe", final_place)?);
            }
            TempDir::with_prefix_in(".results", parent)
        };
        let folder = prepare().map_err(|reason| OutputError {
            path: final_place.to_owned(),
            reason,
        })?;
        Ok(Self {
            final_place: final_place.to_owned(),
            folder,
        })
    }

    /// Where to put a file for now.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Moves everything to its place. Files of the same name are replaced one by one; others stay.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn publish(self) -> Result<PathBuf, OutputError> {
        let publish = || {
            std::fs::create_dir_all(&self.final_place)?;
            let mut names: Vec<_> = std::fs::read_dir(self.folder.path())?
                .map(|entry| entry.map(|e| e.file_name()))
                .collect::<io::Result<_>>()?;
            names.sort();
            for name in names {
                std::fs::rename(self.folder.path().join(&name), self.final_place.join(&name))?;
            }
            Ok(())
        };
        publish().map_err(|reason| OutputError {
            path: self.final_place.clone(),
            reason,
        })?;
        Ok(self.final_place)
    }
}
