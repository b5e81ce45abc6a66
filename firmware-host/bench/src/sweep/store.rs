//! What a sweep has done so far, in a folder: a manifest, chunks of rows, and in the end one file of all rows. Every file appears
//! whole or not at all, so that a sweep may be stopped at any moment and goes on where it was.

use crate::sweep::error::SweepError;
use crate::sweep::plan::Plan;
use crate::sweep::table::{Rows, RowsFile, RowsReader};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Layout of the folder and of its files.
const FORMAT: u32 = 1;
/// Rows of a group of the results, at least.
const GROUP_ROWS: usize = 1 << 13;

const MANIFEST: &str = "sweep.json";
const CHUNKS: &str = "chunks";
/// Beginning of the names of files that are being written.
const UNFINISHED: &str = ".unfinished";
/// The file of all rows.
pub const RESULTS: &str = "results.parquet";

/// A program, as one that gives the same results is known.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    pub version: String,
    /// Digest of the program file.
    pub sha256: String,
}

/// What results hang on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Manifest {
    format: u32,
    program: Program,
    /// The sweep file, but for what is only shown otherwise.
    sweep: BTreeMap<String, serde_json::Value>,
    /// Digests of the other files.
    files: BTreeMap<String, String>,
    runs: u64,
    chunk_runs: u64,
}

impl Manifest {
    fn new(plan: &Plan, program: Program) -> Self {
        let settings = plan.file.settings.iter();
        Self {
            format: FORMAT,
            program,
            sweep: settings
                .map(|(key, value)| (key.clone(), serde_json::json!(value)))
                .collect(),
            files: plan.inputs.clone(),
            runs: plan.runs(),
            chunk_runs: plan.chunk_runs(),
        }
    }

    /// The first thing that was another when this was written.
    fn changed(&self, now: &Self) -> Option<String> {
        if self.program != now.program || self.format != now.format {
            let (old, new) = (&self.program.version, &now.program.version);
            return Some(match old == new {
                true => format!("the program has been built anew since (version {old} both times)"),
                false => format!("was begun by version {old} of the program, this is {new}"),
            });
        }
        if let Some(key) = differing(&self.files, &now.files) {
            return Some(
                match (self.files.contains_key(key), now.files.contains_key(key)) {
                    (true, true) => format!("{key} has changed since"),
                    (true, false) => format!("{key} was an input, and is none any more"),
                    _ => format!("{key} is an input now, and was none"),
                },
            );
        }
        if let Some(key) = differing(&self.sweep, &now.sweep) {
            let described = |of: &Self| of.sweep.get(key).map_or("not given".to_owned(), described);
            return Some(format!(
                "{key} of the sweep file was {}, and is {}",
                described(self),
                described(now)
            ));
        }
        (self != now).then(|| "has other runs".to_owned())
    }
}

/// A value of the sweep file, not longer than one reads.
fn described(value: &serde_json::Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(300) {
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or_default()),
        None => text,
    }
}

/// The first key of which two maps say something else.
fn differing<'a, T: PartialEq>(
    a: &'a BTreeMap<String, T>,
    b: &'a BTreeMap<String, T>,
) -> Option<&'a String> {
    a.keys()
        .chain(b.keys())
        .find(|key| a.get(*key) != b.get(*key))
}

/// A folder of a sweep.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
}

impl Store {
    /// The folder of a sweep that is begun there or goes on.
    ///
    /// # Errors
    /// [`SweepError`] for one that has another sweep, or this one as it was, and where nothing can be written.
    pub fn begin(folder: &Path, plan: &Plan, program: &Program) -> Result<Self, SweepError> {
        let store = Self {
            folder: folder.to_owned(),
        };
        let now = Manifest::new(plan, program.clone());
        // Parts may begin in one folder at once. The manifest is written first: who sees anything else then finds it.
        let has_results = store.chunks().exists() || store.results().exists();
        match store.manifest()? {
            Some(old) => store.same(&old, &now)?,
            None if has_results => {
                return Err(SweepError::Other {
                    folder: folder.to_owned(),
                    what: format!("has results of a sweep, and no {MANIFEST} that says of which"),
                    help: "give another folder with --out, or remove this one".to_owned(),
                });
            }
            None => {
                std::fs::create_dir_all(folder).map_err(SweepError::write(folder))?;
                let text = serde_json::to_string_pretty(&now).unwrap_or_default() + "\n";
                store.write(MANIFEST, text.as_bytes())?;
            }
        }
        Ok(store)
    }

    /// The folder of a part of a sweep that was run elsewhere.
    ///
    /// # Errors
    /// [`SweepError`] for one that has none, or one of another sweep.
    pub fn part(folder: &Path, plan: &Plan, program: &Program) -> Result<Self, SweepError> {
        let store = Self {
            folder: folder.to_owned(),
        };
        match store.manifest()? {
            Some(old) => store.same(&old, &Manifest::new(plan, program.clone()))?,
            None => {
                return Err(SweepError::Other {
                    folder: folder.to_owned(),
                    what: format!("has no sweep: there is no {MANIFEST}"),
                    help: "give folders that were filled by this sweep with --shard".to_owned(),
                });
            }
        }
        Ok(store)
    }

    fn manifest(&self) -> Result<Option<Manifest>, SweepError> {
        let path = self.folder.join(MANIFEST);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(SweepError::results(&path, error)),
        };
        serde_json::from_str(&text)
            .map(Some)
            .map_err(|error| SweepError::Other {
                folder: self.folder.clone(),
                what: format!("{MANIFEST} is not that of a sweep: {error}"),
                help: "give another folder with --out, or remove this one".to_owned(),
            })
    }

    fn same(&self, old: &Manifest, now: &Manifest) -> Result<(), SweepError> {
        match old.changed(now) {
            None => Ok(()),
            Some(what) => Err(SweepError::Other {
                folder: self.folder.clone(),
                what: format!("has results of this sweep as it was: {what}"),
                help: "put it back as it was to go on; to begin anew give another folder with --out, or remove this one"
                    .to_owned(),
            }),
        }
    }

    /// The file of all rows; it is there when all is done.
    pub fn results(&self) -> PathBuf {
        self.folder.join(RESULTS)
    }

    fn chunks(&self) -> PathBuf {
        self.folder.join(CHUNKS)
    }

    fn chunk(&self, chunk: u64) -> PathBuf {
        self.chunks().join(format!("{chunk:08}.parquet"))
    }

    /// Whether a file is there with so many rows. One that is not whole (a disk that lost it) is as if it were not there.
    fn whole(path: &Path, plan: &Plan, runs: u64) -> bool {
        let opened = File::open(path).ok();
        let reader = opened.and_then(|file| RowsReader::open(file, plan.columns()).ok());
        reader.is_some_and(|reader| reader.len() == runs * plan.policies().len() as u64)
    }

    /// Whether all is done.
    pub fn is_done(&self, plan: &Plan) -> bool {
        Self::whole(&self.results(), plan, plan.runs())
    }

    /// Whether a chunk is done.
    pub fn has(&self, plan: &Plan, chunk: u64) -> bool {
        let runs = plan.runs_of(chunk);
        Self::whole(&self.chunk(chunk), plan, runs.end - runs.start)
    }

    /// Keeps a chunk.
    ///
    /// # Errors
    /// [`SweepError`] where it cannot be written.
    pub fn keep(&self, plan: &Plan, chunk: u64, rows: &Rows) -> Result<(), SweepError> {
        let path = self.chunk(chunk);
        std::fs::create_dir_all(self.chunks()).map_err(SweepError::write(&path))?;
        let mut file = temporary(&self.chunks()).map_err(SweepError::write(&path))?;
        let mut write = || {
            let mut rows_file = RowsFile::new(file.as_file_mut(), &plan.columns())?;
            rows_file.group(rows)?;
            rows_file.end()
        };
        write().map_err(SweepError::written(&path))?;
        persist(file, &path)
    }

    /// Writes a file of the folder.
    ///
    /// # Errors
    /// [`SweepError`] where it cannot be written.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), SweepError> {
        let path = self.folder.join(name);
        let mut file = temporary(&self.folder).map_err(SweepError::write(&path))?;
        file.write_all(content).map_err(SweepError::write(&path))?;
        persist(file, &path)
    }

    /// Takes files of the folder away.
    ///
    /// # Errors
    /// [`SweepError`] where that is refused.
    pub fn remove(&self, is_old: impl Fn(&str) -> bool) -> Result<(), SweepError> {
        let remove = || {
            for entry in std::fs::read_dir(&self.folder)? {
                let entry = entry?;
                let old = entry.file_name().to_str().is_some_and(&is_old);
                if old && entry.file_type()?.is_file() {
                    std::fs::remove_file(entry.path())?;
                }
            }
            Ok(())
        };
        remove().map_err(SweepError::write(&self.folder))
    }

    /// Path of a file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Puts all chunks into one file, from this folder or the others, and takes those of this folder away.
    ///
    /// # Errors
    /// [`SweepError`] where a chunk is missing, and where nothing can be written.
    pub fn assemble(&self, plan: &Plan, others: &[Self]) -> Result<(), SweepError> {
        let missing =
            || (0..plan.chunks()).filter(|chunk| self.holder(plan, others, *chunk).is_none());
        if let Some(first) = missing().next() {
            let (runs, n) = (plan.runs_of(first), missing().count());
            return Err(SweepError::Other {
                folder: self.folder.clone(),
                what: format!(
                    "{n} of {} chunks are in none of the folders, the first of runs {} to {}",
                    plan.chunks(),
                    runs.start,
                    runs.end - 1
                ),
                help: "give all folders of the parts; or run the sweep without --merge, which runs what is missing".to_owned(),
            });
        }
        let path = self.results();
        let refused = SweepError::written(&path);
        let mut file = temporary(&self.folder).map_err(SweepError::write(&path))?;
        let mut results = RowsFile::new(file.as_file_mut(), &plan.columns()).map_err(&refused)?;
        let mut rows = Rows::new(plan.columns());
        for chunk in 0..plan.chunks() {
            let chunk_path = self
                .holder(plan, others, chunk)
                .unwrap_or(self)
                .chunk(chunk);
            rows.append(read(&chunk_path, plan)?);
            if rows.len() >= GROUP_ROWS || chunk + 1 == plan.chunks() {
                results.group(&rows).map_err(&refused)?;
                rows = Rows::new(plan.columns());
            }
        }
        results.end().map_err(&refused)?;
        persist(file, &path)?;
        self.tidy()
    }

    /// Whose a chunk is.
    fn holder<'a>(&'a self, plan: &Plan, others: &'a [Self], chunk: u64) -> Option<&'a Self> {
        [self]
            .into_iter()
            .chain(others)
            .find(|store| store.has(plan, chunk))
    }

    /// Takes chunks away that are in the results, and what was not finished.
    ///
    /// # Errors
    /// [`SweepError`] where that is refused.
    pub fn tidy(&self) -> Result<(), SweepError> {
        let chunks = self.chunks();
        match std::fs::remove_dir_all(&chunks) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(SweepError::write(&chunks)(error))
            }
            _ => self.remove(|name| name.starts_with(UNFINISHED)),
        }
    }
}

fn read(path: &Path, plan: &Plan) -> Result<Rows, SweepError> {
    let refused = |error: parquet::errors::ParquetError| SweepError::results(path, error);
    let file = File::open(path).map_err(|error| SweepError::results(path, error))?;
    let reader = RowsReader::open(file, plan.columns()).map_err(refused)?;
    let mut all = Rows::new(plan.columns());
    for group in reader.groups() {
        all.append(group.map_err(refused)?);
    }
    Ok(all)
}

fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED);
    // As other results: others of the group may merge them.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
    builder.tempfile_in(folder)
}

fn persist(file: NamedTempFile, path: &Path) -> Result<(), SweepError> {
    (file.persist(path).map(drop)).map_err(|error| SweepError::write(path)(error.error))
}
