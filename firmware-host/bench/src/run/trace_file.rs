//! Traces as Parquet: one column a quantity, SI units in the column names; written while the run goes on, a group of rows at
//! a time.

use crate::run::trace::Recorder;
use crate::run::trace_columns::Columns;
use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use std::io::{self, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Key of a file under which the units of its columns of numbers stand, a JSON object; "1" of a plain number.
pub const UNITS: &str = "units";

/// Rows of a group; so many are in memory before they are written.
const GROUP_ROWS: usize = 1 << 16;

/// What a file says of itself: keys and values.
fn key_values<R>(columns: &Columns<R>) -> Vec<KeyValue> {
    let units: serde_json::Map<String, serde_json::Value> = (columns.numbers.iter())
        .map(|number| (number.name.clone(), number.unit.into()))
        .collect();
    let units = (UNITS, serde_json::Value::from(units).to_string());
    let about = columns.about.iter().cloned().chain([units]);
    about
        .map(|(key, value)| KeyValue::new(key.to_owned(), value))
        .collect()
}

/// A trace file that is being written.
pub struct TraceFile<W: Write + Send, R: 'static> {
    file: SerializedFileWriter<W>,
    columns: Columns<R>,
    rows: Vec<R>,
    /// The first thing that went wrong; nothing is written after it.
    broken: Option<ParquetError>,
    took: Duration,
}

impl<W: Write + Send, R: Clone> TraceFile<W, R> {
    /// Begins a file.
    ///
    /// # Errors
    /// What the file system or the format refuses.
    pub fn new(sink: W, columns: Columns<R>) -> Result<Self, ParquetError> {
        let mut message = String::from("message trace {\n");
        for number in &columns.numbers {
            message += &format!("  required double {};\n", number.name);
        }
        for (name, _) in columns.texts {
            message += &format!("  required binary {name} (utf8);\n");
        }
        for (name, _) in columns.flags {
            message += &format!("  required boolean {name};\n");
        }
        message += "}";
        let schema = Arc::new(parse_message_type(&message)?);
        // Numbers hardly repeat: a dictionary of them is work for nothing, and larger than they are. Of names there are few.
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::None)
            .set_key_value_metadata(Some(key_values(&columns)))
            .set_created_by("firmware-host".to_owned());
        for (name, _) in columns.texts {
            properties = properties.set_column_dictionary_enabled((*name).into(), true);
        }
        let properties = properties.build();
        Ok(Self {
            file: SerializedFileWriter::new(sink, schema, Arc::new(properties))?,
            columns,
            rows: Vec::new(),
            broken: None,
            took: Duration::ZERO,
        })
    }

    /// Time spent on writing so far.
    pub fn took(&self) -> Duration {
        self.took
    }

    /// Writes what is left and ends the file.
    ///
    /// # Errors
    /// What the file system or the format has refused.
    pub fn end(mut self) -> Result<(), ParquetError> {
        if self.broken.is_none() && !self.rows.is_empty() {
            self.write_group()?;
        }
        match self.broken {
            Some(error) => Err(error),
            None => self.file.close().map(drop),
        }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for number in &self.columns.numbers {
            let column: Vec<f64> = self.rows.iter().map(&number.value).collect();
            column_of(&mut group, |c| {
                c.typed::<DoubleType>().write_batch(&column, None, None)
            })?;
        }
        for (_, value) in self.columns.texts {
            let column: Vec<ByteArray> = (self.rows.iter())
                .map(|r| ByteArray::from(value(r).into_bytes()))
                .collect();
            column_of(&mut group, |c| {
                c.typed::<ByteArrayType>().write_batch(&column, None, None)
            })?;
        }
        for (_, value) in self.columns.flags {
            let column: Vec<bool> = self.rows.iter().map(value).collect();
            column_of(&mut group, |c| {
                c.typed::<BoolType>().write_batch(&column, None, None)
            })?;
        }
        group.close()?;
        self.rows.clear();
        Ok(())
    }
}

impl<W: Write + Send, R: Clone> Recorder<R> for TraceFile<W, R> {
    fn row(&mut self, row: &R) {
        if self.broken.is_some() {
            return;
        }
        self.rows.push(row.clone());
        if self.rows.len() == GROUP_ROWS {
            let started = Instant::now();
            self.broken = self.write_group().err();
            self.took += started.elapsed();
        }
    }
}

/// Why a trace could not be written, in the words of the system where it is the reason.
pub fn reason(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(reason) => *reason,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

type ColumnWriter<'a> = parquet::file::writer::SerializedColumnWriter<'a>;

/// Writes the next column of a group.
fn column_of<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    fill: impl FnOnce(&mut ColumnWriter<'_>) -> Result<usize, ParquetError>,
) -> Result<(), ParquetError> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General(
            "more columns than the schema has".to_owned(),
        ));
    };
    fill(&mut column)?;
    column.close()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    #[test]
    fn the_first_refusal_is_the_one_that_is_told() {
        /// A disk with room for the first bytes.
        struct Full;
        impl Write for Full {
            fn write(&mut self, _bytes: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let begun = TraceFile::new(Full, Columns::of_plane());
        let done = begun.and_then(|mut file| {
            (0..GROUP_ROWS).for_each(|i| file.row(&fixture::row(i as f64, false)));
            file.end()
        });
        assert_eq!(reason(done.unwrap_err()).kind(), io::ErrorKind::StorageFull);
    }
}
