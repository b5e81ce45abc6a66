//! CSV: the table, and beside it its metadata as the W3C's CSV on the Web has them.

use super::table::{Kind, Trace, number};
use crate::cli::error::CommandError;
use parquet::record::Field;
use serde_json::{Map, Value, json};
use std::fs::File;
use std::io::{self, BufWriter, Write};

/// Writes the table; how many rows it has, or why it cannot be read, goes to `rows`.
pub(super) fn write(
    trace: &Trace,
    file: File,
    rows: &mut Result<u64, CommandError>,
) -> io::Result<()> {
    let mut out = BufWriter::new(file);
    let names: Vec<&str> = trace.columns.iter().map(|c| c.name.as_str()).collect();
    writeln!(out, "{}", names.join(","))?;
    let all = match trace.rows() {
        Ok(all) => all,
        Err(error) => {
            *rows = Err(error);
            return Ok(());
        }
    };
    let mut count = 0;
    for row in all {
        let row = match row {
            Ok(row) => row,
            Err(reason) => {
                *rows = Err(trace.broken(reason));
                return Ok(());
            }
        };
        for (i, (_, field)) in row.get_column_iter().enumerate() {
            if i > 0 {
                out.write_all(b",")?;
            }
            cell(&mut out, field)?;
        }
        out.write_all(b"\n")?;
        count += 1;
    }
    *rows = Ok(count);
    out.flush()
}

/// A cell; numbers are the shortest that are read back the same.
fn cell(out: &mut impl Write, field: &Field) -> io::Result<()> {
    match (number(field), field) {
        (Some(x), _) => write!(out, "{x:?}"),
        (None, Field::Null) => Ok(()),
        (None, Field::Str(text)) if text.contains([',', '"', '\n', '\r']) => {
            write!(out, "\"{}\"", text.replace('"', "\"\""))
        }
        (None, Field::Str(text)) => out.write_all(text.as_bytes()),
        (None, other) => write!(out, "{other}"),
    }
}

/// What stands beside the table.
pub(super) fn metadata(trace: &Trace, name: &str) -> String {
    let column = |column: &super::table::Column| {
        let mut described = Map::new();
        described.insert("name".to_owned(), column.name.as_str().into());
        let datatype = match column.kind {
            Kind::Number => "double",
            Kind::Whole => "integer",
            Kind::Truth => "boolean",
            Kind::Text => "string",
        };
        described.insert("datatype".to_owned(), datatype.into());
        if let Some(unit) = &column.unit {
            described.insert("schema:unitText".to_owned(), unit.as_str().into());
        }
        Value::from(described)
    };
    let columns: Vec<Value> = trace.columns.iter().map(column).collect();
    let mut all = json!({
        "@context": ["http://www.w3.org/ns/csvw", { "@language": "en" }],
        "url": name,
        "tableSchema": { "columns": columns },
    });
    if !trace.about.is_empty() {
        all["notes"] = json!([trace.about]);
    }
    format!("{all:#}\n")
}
