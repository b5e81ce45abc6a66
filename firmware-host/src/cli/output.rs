//! Results appear whole or not at all.

use firmware_bench::run::trace_columns::Columns;
use firmware_bench::run::trace_file::{self, TraceFile};
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;

/// A folder that is filled in its final place, or beside it where that is not there yet, and whose files are moved there
/// at the end: both are the same file system.
#[derive(Debug)]
pub struct Staging {
    final_place: PathBuf,
    folder: TempDir,
    _begun: Begun,
}

/// Folders that are being filled.
static FILLED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// One of them.
#[derive(Debug)]
struct Begun(PathBuf);

impl Begun {
    fn new(folder: &Path) -> Self {
        filled(|all| all.push(folder.to_owned()));
        Self(folder.to_owned())
    }
}

impl Drop for Begun {
    fn drop(&mut self) {
        filled(|all| all.retain(|folder| *folder != self.0));
    }
}

fn filled(change: impl FnOnce(&mut Vec<PathBuf>)) {
    change(&mut FILLED.lock().unwrap_or_else(PoisonError::into_inner));
}

/// From now on Ctrl-C removes what was begun before it ends the program, with the exit code that shells give for that.
pub fn clean_up_on_interrupt() {
    // Where there can be no handler, Ctrl-C ends the program as it always does.
    let _set = ctrlc::set_handler(|| {
        filled(|all| {
            for folder in all.drain(..) {
                let _gone = std::fs::remove_dir_all(folder);
            }
            std::process::exit(130);
        });
    });
}

/// Why results could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write results to {}: {}", path.display(), described(reason))]
pub struct OutputError {
    /// The folder asked for.
    pub path: PathBuf,
    /// The system's message.
    pub reason: io::Error,
    /// The option that would name another place; none where that is the argument.
    pub option: Option<&'static str>,
}

/// The system's word without its number; what has no word of its own, whole.
fn described(reason: &io::Error) -> String {
    match reason.kind() {
        io::ErrorKind::Other => reason.to_string(),
        kind => kind.to_string(),
    }
}

impl miette::Diagnostic for OutputError {
    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        let with = self.option.map(|option| format!(" with {option}"));
        let with = with.unwrap_or_default();
        Some(Box::new(match self.reason.kind() {
            StorageFull | QuotaExceeded | FileTooLarge => {
                format!(
                    "free some space there, or give a folder on another disk{with}; nothing was written"
                )
            }
            _ if self.option.is_none() => {
                "give a file in a folder that is there and can be written to".to_owned()
            }
            _ => format!("give a folder that can be written to{with}"),
        }))
    }
}

impl OutputError {
    /// Of this place.
    pub(crate) fn at(path: &Path) -> impl Fn(io::Error) -> Self {
        move |reason| Self {
            path: path.to_owned(),
            reason,
            option: Some("--out"),
        }
    }
}

/// Finds out whether results could be written to a folder, and leaves nothing behind.
///
/// # Errors
/// [`OutputError`].
pub fn probe(final_place: &Path) -> Result<(), OutputError> {
    let refused = OutputError::at(final_place);
    // The nearest folder that exists: the others would be made in it.
    let mut place = final_place;
    loop {
        if place.is_dir() {
            return TempDir::with_prefix_in(".probe", place)
                .map(drop)
                .map_err(refused);
        }
        if place.exists() {
            return Err(refused(io::Error::from(io::ErrorKind::NotADirectory)));
        }
        place = match place.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
    }
}

impl Staging {
    /// Prepares a folder for what is to be in `final_place`.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn for_folder(final_place: &Path) -> Result<Self, OutputError> {
        let prepare = || {
            // A folder that is there may be a mount point, a link, or the only one that may be written to.
            if final_place.is_dir() {
                return TempDir::with_prefix_in(".results", final_place);
            }
            let parent = match final_place.parent() {
                Some(p) if !p.as_os_str().is_empty() => p,
                _ => Path::new("."),
            };
            std::fs::create_dir_all(parent)?;
            TempDir::with_prefix_in(".results", parent)
        };
        let folder = prepare().map_err(OutputError::at(final_place))?;
        Ok(Self {
            final_place: final_place.to_owned(),
            _begun: Begun::new(folder.path()),
            folder,
        })
    }

    /// Creates a file there and has it written; an error of either names the place where it was to go.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write_by(
        &self,
        name: &str,
        write: impl FnOnce(std::fs::File) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        (std::fs::File::create(self.path(name)).and_then(write))
            .map_err(OutputError::at(&self.final_place.join(name)))
    }

    /// Begins a trace there.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn trace<R: Clone>(
        &self,
        name: &str,
        columns: Columns<R>,
    ) -> Result<TraceFile<std::fs::File, R>, OutputError> {
        (std::fs::File::create(self.path(name)))
            .and_then(|file| TraceFile::new(file, columns).map_err(trace_file::reason))
            .map_err(OutputError::at(&self.final_place.join(name)))
    }

    /// Ends it.
    ///
    /// # Errors
    /// [`OutputError`], also of what was written before.
    pub fn end_trace<R: Clone>(
        &self,
        name: &str,
        file: TraceFile<std::fs::File, R>,
    ) -> Result<(), OutputError> {
        (file.end().map_err(trace_file::reason))
            .map_err(OutputError::at(&self.final_place.join(name)))
    }

    /// Takes a file away again.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn discard(&self, name: &str) -> Result<(), OutputError> {
        std::fs::remove_file(self.path(name)).map_err(OutputError::at(&self.final_place.join(name)))
    }

    /// Where to put a file for now.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file there.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), OutputError> {
        self.write_by(name, |mut file| file.write_all(content.as_ref()))
    }

    /// Moves everything to its place. Files of the same name are replaced one by one; others stay.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn publish(self) -> Result<PathBuf, OutputError> {
        self.publish_over(|_| false)
    }

    /// As [`Self::publish`]; but of the others those files are removed that are `stale` by their name.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn publish_over(self, stale: impl Fn(&str) -> bool) -> Result<PathBuf, OutputError> {
        let refused = OutputError::at(&self.final_place);
        let names = names_in(self.folder.path()).map_err(&refused)?;
        // All or nothing: a folder in the place of a file would stop half-way.
        for path in names.iter().map(|name| self.final_place.join(name)) {
            if path.is_dir() {
                return Err(OutputError::at(&path)(io::ErrorKind::IsADirectory.into()));
            }
        }
        let publish = || {
            std::fs::create_dir_all(&self.final_place)?;
            for name in &names {
                std::fs::rename(self.folder.path().join(name), self.final_place.join(name))?;
            }
            for entry in std::fs::read_dir(&self.final_place)? {
                let entry = entry?;
                let name = entry.file_name();
                let is_stale = name.to_str().is_some_and(&stale) && !names.contains(&name);
                if is_stale && entry.file_type()?.is_file() {
                    std::fs::remove_file(entry.path())?;
                }
            }
            Ok(())
        };
        publish().map_err(refused)?;
        Ok(self.final_place)
    }
}

/// What is in a folder, in the order of the names.
fn names_in(folder: &Path) -> io::Result<Vec<OsString>> {
    let entries = std::fs::read_dir(folder)?;
    let mut names: Vec<_> =
        (entries.map(|entry| entry.map(|e| e.file_name()))).collect::<io::Result<_>>()?;
    names.sort();
    Ok(names)
}
