//! Readers of files, by their format.

use super::column::{Column, Held, Wrong};
use matfile::{MatFile, NumericData};
use mcap::sans_io::{LinearReaderOptions, MessageReadEvent, MessageReader};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs::File;
use std::path::Path;

pub(super) type Columns = BTreeMap<String, Column>;

fn reason(path: &Path) -> impl Fn(&dyn Display) -> String {
    move |reason| format!("{}: {reason}", path.display())
}

/// Cells between commas, semicolons or tabs, whichever the first line has.
pub(super) fn of_csv(path: &Path) -> Result<Columns, String> {
    let refused = reason(path);
    let bytes = std::fs::read(path).map_err(|e| refused(&e))?;
    // As spreadsheets begin a file.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let mut lines = text.split(|byte| *byte == b'\n');
    let head = (lines.find(|line| !line.starts_with(b"#"))).unwrap_or_default();
    let between = [b';', b'\t'].into_iter().find(|mark| head.contains(mark));
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(between.filter(|_| !head.contains(&b',')).unwrap_or(b','))
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text);
    let names = reader.headers().map_err(|e| refused(&e))?.clone();
    let mut columns = vec![Column::default(); names.len()];
    for cells in reader.records() {
        let cells = cells.map_err(|e| refused(&e))?;
        let line = cells.position().map_or(0, csv::Position::line);
        for (column, cell) in columns.iter_mut().zip(&cells) {
            let value = match cell {
                "" => f64::NAN,
                "true" => 1.0,
                "false" => 0.0,
                cell => match cell.parse() {
                    Ok(value) => {
                        column.held = column.held.with_cell(cell);
                        value
                    }
                    Err(_) => {
                        let wrong = || Wrong::Cell(line, cell.to_owned());
                        column.wrong.get_or_insert_with(wrong);
                        f64::NAN
                    }
                },
            };
            column.values.push(value);
        }
    }
    Ok(names.iter().map(str::to_owned).zip(columns).collect())
}

pub(super) fn of_parquet(path: &Path) -> Result<Columns, String> {
    let refused = reason(path);
    let file = File::open(path).map_err(|e| refused(&e))?;
    let reader = SerializedFileReader::new(file).map_err(|e| refused(&e))?;
    let mut columns = Columns::new();
    for row in reader.get_row_iter(None).map_err(|e| refused(&e))? {
        for (name, field) in row.map_err(|e| refused(&e))?.get_column_iter() {
            let value = match field {
                Field::Double(x) => *x,
                Field::Float(x) => f64::from(*x),
                Field::Bool(x) => f64::from(*x),
                Field::Byte(x) => f64::from(*x),
                Field::Short(x) => f64::from(*x),
                Field::Int(x) => f64::from(*x),
                Field::UByte(x) => f64::from(*x),
                Field::UShort(x) => f64::from(*x),
                Field::UInt(x) => f64::from(*x),
                Field::ULong(x) => *x as f64,
                // Stamps as they are counted, in whatever unit: those of nanoseconds come as mere integers.
                Field::Long(x) | Field::TimestampMillis(x) | Field::TimestampMicros(x) => *x as f64,
                Field::Null => f64::NAN,
                _ => continue,
            };
            if !columns.contains_key(name) {
                columns.insert(name.clone(), Column::default());
            }
            if let Some(column) = columns.get_mut(name) {
                column.values.push(value);
                if matches!(field, Field::Float(_)) {
                    column.held = Held::Single;
                }
            }
        }
    }
    Ok(columns)
}

/// Vectors by their names; of matrices each column, numbered from 1 on as MATLAB does.
pub(super) fn of_mat(path: &Path) -> Result<Columns, String> {
    let refused = reason(path);
    let file = File::open(path).map_err(|e| refused(&e))?;
    let mat = MatFile::parse(file)
        .map_err(|e| format!("{} (version 7.3 is another format)", refused(&e)))?;
    let mut columns = Columns::new();
    for array in mat.arrays() {
        let (values, complex) = doubles(array.data());
        let held = match array.data() {
            NumericData::Single { .. } => Held::Single,
            _ => Held::Double,
        };
        let rows = match array.size()[..] {
            [1, n] | [n, 1] => n,
            [rows, _] => rows,
            _ => continue,
        };
        let several = values.len() > rows;
        for (i, values) in values.chunks(rows.max(1)).enumerate() {
            let name = match several {
                true => format!("{}_{}", array.name(), i + 1),
                false => array.name().to_owned(),
            };
            let mut column = Column::new(values.to_vec(), held);
            column.wrong = complex.then_some(Wrong::Complex);
            columns.insert(name, column);
        }
    }
    Ok(columns)
}

/// Real parts, and whether there are others.
fn doubles(data: &NumericData) -> (Vec<f64>, bool) {
    macro_rules! wide {
        ($($kind:ident),*) => {
            match data {
                $(NumericData::$kind { real, imag } => (
                    real.iter().map(|x| *x as f64).collect(),
                    imag.iter().flatten().any(|x| *x as f64 != 0.0),
                ),)*
            }
        };
    }
    wide!(
        Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Single, Double
    )
}

/// A record of a compressed chunk may be longer than the file. Without a limit the reader adds to whatever length a file claims.
const LONGEST_RECORD: usize = 1 << 26;
/// Time of a message where it has no column of its own.
const LOG_TIME: &str = "log_time_s";

/// Fields of messages in JSON, those below others behind a dot; before it the topic where there are several.
pub(super) fn of_mcap(path: &Path) -> Result<Columns, String> {
    let refused = reason(path);
    let bytes = std::fs::read(path).map_err(|e| refused(&e))?;
    /// Columns in the order of fields, and how many messages were read.
    type Topic = (Vec<(String, Column)>, usize);
    let mut topics: BTreeMap<String, Topic> = BTreeMap::new();
    let longest = bytes.len().max(LONGEST_RECORD);
    let options = LinearReaderOptions::default().with_record_length_limit(longest);
    let mut reader = MessageReader::new_with_options(options);
    let mut rest = &bytes[..];
    while let Some(event) = reader.next_event() {
        let message = match event.map_err(|e| refused(&e))? {
            MessageReadEvent::Message(message) => message,
            MessageReadEvent::ReadRequest(needed) => {
                let (next, behind) = rest.split_at(needed.min(rest.len()));
                reader.insert(next.len()).copy_from_slice(next);
                reader.notify_read(next.len());
                rest = behind;
                continue;
            }
        };
        if message.channel.message_encoding != "json" {
            continue;
        }
        let value = serde_json::from_slice(&message.data).map_err(|e| refused(&e))?;
        let mut fields = vec![(LOG_TIME.to_owned(), 1e-9 * message.log_time as f64)];
        numbers("", &value, &mut fields);
        let topic = message.channel.topic.clone();
        let (columns, rows) = topics.entry(topic).or_default();
        for (place, (name, value)) in fields.into_iter().enumerate() {
            // Messages of a topic have their fields in one order, mostly.
            let at = match columns.get(place) {
                Some((known, _)) if *known == name => place,
                _ => {
                    let known = columns.iter().position(|(known, _)| *known == name);
                    known.unwrap_or_else(|| {
                        columns.push((name, Column::default()));
                        columns.len() - 1
                    })
                }
            };
            let values = &mut columns[at].1.values;
            values.resize(*rows, f64::NAN);
            values.push(value);
        }
        *rows += 1;
    }
    if topics.is_empty() {
        return Err(refused(&"has no messages in JSON"));
    }
    let several = topics.len() > 1;
    let named = topics.into_iter().flat_map(|(topic, (columns, rows))| {
        columns.into_iter().map(move |(name, mut column)| {
            column.values.resize(rows, f64::NAN);
            match several {
                true => (format!("{topic}.{name}"), column),
                false => (name, column),
            }
        })
    });
    Ok(named.collect())
}

fn numbers(above: &str, value: &serde_json::Value, into: &mut Vec<(String, f64)>) {
    use serde_json::Value;
    let below = |name: &str| match above {
        "" => name.to_owned(),
        above => format!("{above}.{name}"),
    };
    match value {
        Value::Object(fields) => fields
            .iter()
            .for_each(|(name, value)| numbers(&below(name), value, into)),
        Value::Array(all) => (0..)
            .zip(all)
            .for_each(|(i, value): (u32, _)| numbers(&below(&i.to_string()), value, into)),
        Value::Number(x) => into.push((above.to_owned(), x.as_f64().unwrap_or(f64::NAN))),
        Value::Bool(x) => into.push((above.to_owned(), f64::from(*x))),
        // As numbers that are not finite are written in JSON.
        Value::Null => into.push((above.to_owned(), f64::NAN)),
        Value::String(_) => {}
    }
}
