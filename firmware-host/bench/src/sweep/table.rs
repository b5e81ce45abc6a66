//! Rows in columns, and their Parquet files: any number of rows, a group at a time.

use crate::run::columns::{Cell, Column, Kind};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::column::writer::ColumnWriterImpl;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;
use std::fs::File;
use std::io::Write;
use std::sync::Arc;

/// Cells of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    Number(Vec<Option<f64>>),
    /// Of whole numbers.
    Whole(Vec<Option<i64>>),
    /// Of truth values.
    Truth(Vec<Option<bool>>),
    Text(Vec<Option<String>>),
}

impl Cells {
    fn none(kind: Kind) -> Self {
        match kind {
            Kind::Number => Self::Number(Vec::new()),
            Kind::Whole => Self::Whole(Vec::new()),
            Kind::Truth => Self::Truth(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
        }
    }

    /// A cell as a number: truth as 1 or 0; `None` for a text, an empty cell and one that there is not.
    pub fn number(&self, row: usize) -> Option<f64> {
        match self {
            Self::Number(all) => *all.get(row)?,
            Self::Whole(all) => all.get(row)?.map(|x| x as f64),
            Self::Truth(all) => all.get(row)?.map(|x| f64::from(u8::from(x))),
            Self::Text(_) => None,
        }
    }

    /// A cell of texts.
    pub fn text(&self, row: usize) -> Option<&str> {
        match self {
            Self::Text(all) => all.get(row)?.as_deref(),
            _ => None,
        }
    }

    /// A cell as people read it; empty where there is nothing.
    pub fn shown(&self, row: usize) -> String {
        let shown = match self {
            Self::Number(all) => all.get(row).copied().flatten().map(|x| format!("{x:?}")),
            Self::Whole(all) => all.get(row).copied().flatten().map(|x| x.to_string()),
            Self::Truth(all) => all.get(row).copied().flatten().map(|x| x.to_string()),
            Self::Text(all) => all.get(row).cloned().flatten(),
        };
        shown.unwrap_or_default()
    }
}

/// Rows, column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    columns: Arc<[Column]>,
    cells: Vec<Cells>,
    len: usize,
}

impl Rows {
    /// None yet.
    pub fn new(columns: Arc<[Column]>) -> Self {
        Self {
            cells: columns.iter().map(|c| Cells::none(c.kind)).collect(),
            columns,
            len: 0,
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// One more, with a cell for each column; a cell of another kind is left empty.
    pub fn push(&mut self, row: Vec<Cell>) {
        let mut row = row.into_iter();
        for (cells, column) in self.cells.iter_mut().zip(self.columns.iter()) {
            let cell = row.next().unwrap_or(column.kind.empty());
            match (cells, cell) {
                (Cells::Number(all), cell) => all.push(match cell {
                    Cell::Number(x) => x,
                    _ => None,
                }),
                (Cells::Whole(all), cell) => all.push(match cell {
                    Cell::Whole(x) => x,
                    _ => None,
                }),
                (Cells::Truth(all), cell) => all.push(match cell {
                    Cell::Truth(x) => x,
                    _ => None,
                }),
                (Cells::Text(all), cell) => all.push(match cell {
                    Cell::Text(x) => x,
                    _ => None,
                }),
            }
        }
        self.len += 1;
    }

    /// Those of others behind these; they have the same columns.
    pub fn append(&mut self, other: Self) {
        for (cells, more) in self.cells.iter_mut().zip(other.cells) {
            match (cells, more) {
                (Cells::Number(all), Cells::Number(more)) => all.extend(more),
                (Cells::Whole(all), Cells::Whole(more)) => all.extend(more),
                (Cells::Truth(all), Cells::Truth(more)) => all.extend(more),
                (Cells::Text(all), Cells::Text(more)) => all.extend(more),
                _ => {}
            }
        }
        self.len += other.len;
    }

    /// The cells of a column.
    pub fn column(&self, name: &str) -> Option<&Cells> {
        let at = self.columns.iter().position(|c| c.name == name)?;
        self.cells.get(at)
    }
}

/// Rows as the bytes of a Parquet file.
///
/// # Errors
/// What the format refuses.
pub fn written(rows: &Rows) -> Result<Vec<u8>, ParquetError> {
    let mut bytes = Vec::new();
    let mut file = RowsFile::new(&mut bytes, &rows.columns)?;
    file.group(rows)?;
    file.end()?;
    Ok(bytes)
}

/// A file that is being written.
pub(crate) struct RowsFile<W: Write + Send>(SerializedFileWriter<W>);

impl<W: Write + Send> RowsFile<W> {
    /// Begins it.
    ///
    /// # Errors
    /// What the file system or the format refuses.
    pub(crate) fn new(sink: W, columns: &[Column]) -> Result<Self, ParquetError> {
        let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder("sweep")
            .with_fields(fields)
            .build()?;
        // As of traces.
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::None)
            .set_created_by("firmware-host".to_owned());
        for column in columns.iter().filter(|c| c.kind == Kind::Text) {
            let path = vec![column.name.clone()];
            properties = properties.set_column_dictionary_enabled(path.into(), true);
        }
        let properties = Arc::new(properties.build());
        SerializedFileWriter::new(sink, Arc::new(schema), properties).map(Self)
    }

    /// Writes rows as a group.
    ///
    /// # Errors
    /// What the file system or the format refuses.
    pub(crate) fn group(&mut self, rows: &Rows) -> Result<(), ParquetError> {
        let mut group = self.0.next_row_group()?;
        for cells in &rows.cells {
            let Some(mut column) = group.next_column()? else {
                break;
            };
            match cells {
                Cells::Number(all) => write::<DoubleType, _>(&mut column, all, |x| *x),
                Cells::Whole(all) => write::<Int64Type, _>(&mut column, all, |x| *x),
                Cells::Truth(all) => write::<BoolType, _>(&mut column, all, |x| *x),
                Cells::Text(all) => write::<ByteArrayType, _>(&mut column, all, |text| {
                    ByteArray::from(text.as_str())
                }),
            }?;
            column.close()?;
        }
        group.close().map(drop)
    }

    /// Ends it.
    ///
    /// # Errors
    /// What the file system or the format refuses.
    pub(crate) fn end(self) -> Result<(), ParquetError> {
        self.0.close().map(drop)
    }
}

fn field(column: &Column) -> Result<Arc<Type>, ParquetError> {
    let (physical, logical) = match column.kind {
        Kind::Number => (Physical::DOUBLE, None),
        Kind::Whole => (Physical::INT64, None),
        Kind::Truth => (Physical::BOOLEAN, None),
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    // Built, and not parsed: names have points and brackets.
    let field = Type::primitive_type_builder(&column.name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical)
        .build()?;
    Ok(Arc::new(field))
}

fn write<T: DataType, C>(
    column: &mut SerializedColumnWriter<'_>,
    cells: &[Option<C>],
    value: impl Fn(&C) -> T::T,
) -> Result<(), ParquetError> {
    let levels: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
    let values: Vec<T::T> = cells.iter().flatten().map(value).collect();
    let writer: &mut ColumnWriterImpl<'_, T> = column.typed::<T>();
    writer.write_batch(&values, Some(&levels), None).map(drop)
}

/// A file that is read.
pub(crate) struct RowsReader {
    file: SerializedFileReader<File>,
    columns: Arc<[Column]>,
}

impl RowsReader {
    /// Opens a file that has these columns.
    ///
    /// # Errors
    /// What the file system says, or what is no such file.
    pub(crate) fn open(file: File, columns: Arc<[Column]>) -> Result<Self, ParquetError> {
        let file = SerializedFileReader::new(file)?;
        let schema = file.metadata().file_metadata().schema_descr();
        let names = schema.columns().iter().map(|c| c.name());
        match names.eq(columns.iter().map(|c| c.name.as_str())) {
            true => Ok(Self { file, columns }),
            false => Err(ParquetError::General("has other columns".to_owned())),
        }
    }

    /// How many rows it has.
    pub(crate) fn len(&self) -> u64 {
        self.file
            .metadata()
            .file_metadata()
            .num_rows()
            .unsigned_abs()
    }

    /// Its groups, each read when it is asked for.
    pub(crate) fn groups(&self) -> impl Iterator<Item = Result<Rows, ParquetError>> + '_ {
        (0..self.file.num_row_groups()).map(|group| self.group(group))
    }

    fn group(&self, index: usize) -> Result<Rows, ParquetError> {
        let group = self.file.get_row_group(index)?;
        let len = usize::try_from(group.metadata().num_rows()).unwrap_or_default();
        let read = |column: usize| {
            Ok(match group.get_column_reader(column)? {
                ColumnReader::DoubleColumnReader(reader) => {
                    Cells::Number(read(reader, len, |x| x)?)
                }
                ColumnReader::Int64ColumnReader(reader) => Cells::Whole(read(reader, len, |x| x)?),
                ColumnReader::BoolColumnReader(reader) => Cells::Truth(read(reader, len, |x| x)?),
                ColumnReader::ByteArrayColumnReader(reader) => {
                    Cells::Text(read(reader, len, |bytes| {
                        String::from_utf8_lossy(bytes.data()).into_owned()
                    })?)
                }
                _ => {
                    return Err(ParquetError::General(
                        "has a column of another type".to_owned(),
                    ));
                }
            })
        };
        let cells = (0..self.columns.len())
            .map(read)
            .collect::<Result<_, ParquetError>>()?;
        Ok(Rows {
            columns: self.columns.clone(),
            cells,
            len,
        })
    }
}

fn read<T: DataType, C>(
    mut reader: ColumnReaderImpl<T>,
    len: usize,
    cell: impl Fn(T::T) -> C,
) -> Result<Vec<Option<C>>, ParquetError> {
    let (mut values, mut levels) = (Vec::with_capacity(len), Vec::with_capacity(len));
    while levels.len() < len {
        let (read, _, _) =
            reader.read_records(len - levels.len(), Some(&mut levels), None, &mut values)?;
        if read == 0 {
            return Err(ParquetError::General("ends before its last row".to_owned()));
        }
    }
    let mut values = values.into_iter();
    Ok((levels.iter())
        .map(|level| (*level > 0).then(|| values.next().map(&cell)).flatten())
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_as_they_were_written() {
        let kinds = [Kind::Number, Kind::Whole, Kind::Truth, Kind::Text];
        let columns: Arc<[Column]> = (kinds.iter().enumerate())
            .map(|(i, kind)| Column {
                name: format!("start.x[{i}]"),
                kind: *kind,
            })
            .collect();
        let mut rows = Rows::new(columns.clone());
        for i in 0..100 {
            let some = i % 3 != 0;
            rows.push(vec![
                Cell::Number(some.then_some(0.1 * f64::from(i))),
                Cell::Whole(Some(i64::MAX - i64::from(i))),
                Cell::Truth(some.then_some(i % 2 == 0)),
                Cell::Text(some.then(|| format!("ü {i}"))),
            ]);
        }
        let mut file = tempfile::tempfile().unwrap();
        let mut writer = RowsFile::new(&mut file, &columns).unwrap();
        writer.group(&rows).unwrap();
        writer.group(&rows).unwrap();
        writer.end().unwrap();
        let reader = RowsReader::open(file.try_clone().unwrap(), columns.clone()).unwrap();
        assert_eq!(reader.len(), 200);
        for group in reader.groups() {
            assert_eq!(group.unwrap(), rows);
        }
        assert!(RowsReader::open(file, columns[..3].into()).is_err());
    }
}
