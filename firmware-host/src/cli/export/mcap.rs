//! MCAP: a message in JSON a row, with a schema that has the units, and a metadata record.

use super::table::{Kind, Trace, number};
use crate::cli::error::CommandError;
use ::mcap::records::{MessageHeader, Metadata};
use ::mcap::{McapError, WriteOptions};
use parquet::record::{Field, Row};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter};

/// Nanoseconds of a second: the time of messages counts them.
const NS: f64 = 1e9;

/// The schema of a row: names, types, and units as descriptions.
fn schema(trace: &Trace) -> Value {
    let property = |column: &super::table::Column| {
        let kind = match column.kind {
            Kind::Number => "number",
            Kind::Whole => "integer",
            Kind::Truth => "boolean",
            Kind::Text => "string",
        };
        let described = match &column.unit {
            Some(unit) => json!({ "type": kind, "description": unit }),
            None => json!({ "type": kind }),
        };
        (column.name.clone(), described)
    };
    let properties: Map<String, Value> = trace.columns.iter().map(property).collect();
    json!({ "type": "object", "properties": properties })
}

/// JSON has no numbers that are not finite: they are null there.
fn value(field: &Field) -> Value {
    match (number(field), field) {
        (Some(x), _) => json!(x),
        (None, Field::Bool(x)) => json!(x),
        (None, Field::Int(x)) => json!(x),
        (None, Field::Long(x)) => json!(x),
        (None, Field::Str(text)) => json!(text),
        _ => Value::Null,
    }
}

/// Writes the messages; how many rows there are, or why they cannot be read, goes to `rows`.
pub(super) fn write(
    trace: &Trace,
    file: File,
    rows: &mut Result<u64, CommandError>,
) -> io::Result<()> {
    match messages(trace, file) {
        Ok(counted) => {
            *rows = counted;
            Ok(())
        }
        Err(McapError::Io(reason)) => Err(reason),
        Err(other) => Err(io::Error::other(other)),
    }
}

fn messages(trace: &Trace, file: File) -> Result<Result<u64, CommandError>, McapError> {
    let program = concat!("firmware-host ", env!("CARGO_PKG_VERSION"));
    let mut writer = WriteOptions::new()
        .compression(None)
        .library(program)
        .create(BufWriter::new(file))?;
    writer.write_metadata(&Metadata {
        name: "run".to_owned(),
        metadata: trace.about.clone(),
    })?;
    let schema = writer.add_schema("trace", "jsonschema", schema(trace).to_string().as_bytes())?;
    let topic = match (trace.about.get("policy"), trace.about.get("plane")) {
        (Some(policy), Some(plane)) => format!("/{policy}/{plane}"),
        (Some(policy), None) => format!("/{policy}"),
        _ => "/trace".to_owned(),
    };
    let channel = writer.add_channel(schema, &topic, "json", &BTreeMap::new())?;
    let all = match trace.rows() {
        Ok(all) => all,
        Err(error) => return Ok(Err(error)),
    };
    let mut count = 0_u64;
    for row in all {
        let row: Row = match row {
            Ok(row) => row,
            Err(reason) => return Ok(Err(trace.broken(reason))),
        };
        let t_s = row.get_column_iter().nth(trace.time);
        let t_s = t_s.and_then(|(_, field)| number(field)).unwrap_or_default();
        let fields = row.get_column_iter();
        let message: Map<String, Value> = fields
            .map(|(name, field)| (name.clone(), value(field)))
            .collect();
        let time = (t_s * NS).round() as u64;
        let header = MessageHeader {
            channel_id: channel,
            sequence: count as u32,
            log_time: time,
            publish_time: time,
        };
        writer.write_to_known_channel(&header, Value::from(message).to_string().as_bytes())?;
        count += 1;
    }
    writer.finish()?;
    Ok(Ok(count))
}
