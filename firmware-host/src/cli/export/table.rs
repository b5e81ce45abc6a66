//! A trace as it is read.

use crate::cli::error::CommandError;
use firmware_bench::run::trace_file::UNITS;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Number,
    Whole,
    Truth,
    Text,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// "1" of a plain number, nothing where the file says none.
    pub(super) unit: Option<String>,
}

/// A Parquet file with a column of times.
pub(super) struct Trace {
    path: PathBuf,
    reader: SerializedFileReader<File>,
    pub(super) columns: Vec<Column>,
    /// Where the time stands among them.
    pub(super) time: usize,
    /// What the file says of itself, but for the units.
    pub(super) about: BTreeMap<String, String>,
}

fn refused(path: &Path, reason: impl std::fmt::Display) -> CommandError {
    CommandError::Numbers {
        message: format!("{}: {reason}", path.display()),
        help: "give a trace that run has written, as runs/impact_at_40_hz/trace_supervisor.parquet"
            .to_owned(),
    }
}

impl Trace {
    /// Opens a file.
    ///
    /// # Errors
    /// [`CommandError`] where it is no such file.
    pub(super) fn open(path: &Path) -> Result<Self, CommandError> {
        let file = File::open(path).map_err(|reason| refused(path, reason))?;
        let reader = SerializedFileReader::new(file).map_err(|reason| refused(path, reason))?;
        let metadata = reader.metadata().file_metadata();
        let pairs = metadata.key_value_metadata().into_iter().flatten();
        let mut about: BTreeMap<String, String> = pairs
            .filter_map(|pair| Some((pair.key.clone(), pair.value.clone()?)))
            .collect();
        let units: BTreeMap<String, String> = (about.remove(UNITS))
            .and_then(|units| serde_json::from_str(&units).ok())
            .unwrap_or_default();
        let mut columns = Vec::new();
        for column in metadata.schema_descr().columns() {
            use parquet::basic::Type;
            let name = column.path().string();
            let kind = match column.physical_type() {
                Type::DOUBLE | Type::FLOAT => Kind::Number,
                Type::INT32 | Type::INT64 => Kind::Whole,
                Type::BOOLEAN => Kind::Truth,
                Type::BYTE_ARRAY => Kind::Text,
                other => return Err(refused(path, format!("{name} is of type {other}"))),
            };
            columns.push(Column {
                unit: units.get(&name).cloned(),
                name,
                kind,
            });
        }
        let time = (columns.iter()).position(|c| c.name == "t_s" && c.kind == Kind::Number);
        let time = time.ok_or_else(|| refused(path, "has no column t_s of times"))?;
        Ok(Self {
            path: path.to_owned(),
            reader,
            columns,
            time,
            about,
        })
    }

    /// Its rows, a group of them in memory at a time.
    pub(super) fn rows(
        &self,
    ) -> Result<impl Iterator<Item = Result<Row, ParquetError>> + '_, CommandError> {
        let rows = self.reader.get_row_iter(None);
        rows.map_err(|reason| refused(&self.path, reason))
    }

    /// A row that cannot be read.
    pub(super) fn broken(&self, reason: ParquetError) -> CommandError {
        refused(&self.path, reason)
    }
}

/// A number or nothing.
pub(super) fn number(field: &Field) -> Option<f64> {
    match field {
        Field::Double(x) => Some(*x),
        Field::Float(x) => Some(f64::from(*x)),
        _ => None,
    }
}
