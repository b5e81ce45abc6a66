//! Columns of numbers by name, from logs as other programs write them: CSV, Parquet, MAT and MCAP.

use matfile::{MatFile, NumericData};
use mcap::MessageStream;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs::File;
use std::path::Path;
use std::str::FromStr;

/// Why a log tells nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct LogError {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl LogError {
    pub(crate) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: help.into(),
        }
    }
}

/// A column under the name that it has here: `NAME=COLUMN`, or `NAME=COLUMN*FACTOR` where its unit is another.
#[derive(Debug, Clone, PartialEq)]
pub struct Renamed {
    /// Name that is looked for.
    name: String,
    /// What stands behind it.
    of: String,
}

impl Renamed {
    /// Name in the log, and what its numbers are multiplied by, where that is a number.
    fn scaled(&self) -> Option<(&str, f64)> {
        let (column, factor) = self.of.rsplit_once('*')?;
        let factor = factor.trim().parse::<f64>().ok()?;
        (factor.is_finite() && factor != 0.0).then_some((column.trim(), factor))
    }
}

impl FromStr for Renamed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text
            .split_once('=')
            .map(|(name, of)| (name.trim(), of.trim()));
        match parts {
            Some((name, of)) if !name.is_empty() && !of.is_empty() => Ok(Self {
                name: name.to_owned(),
                of: of.to_owned(),
            }),
            _ => Err(format!(
                "{text}: expected NAME=COLUMN or NAME=COLUMN*FACTOR"
            )),
        }
    }
}

/// Numbers of a column; NaN where there is none.
#[derive(Debug, Clone, Default, PartialEq)]
struct Column {
    values: Vec<f64>,
    /// The first line with something that is no number.
    wrong: Option<(u64, String)>,
}

/// A log, column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFile {
    columns: BTreeMap<String, Column>,
    /// Names that are given to columns that it does not have.
    lacking: BTreeMap<String, String>,
}

/// Names of columns, each pair for x and y, as traces of this program have them.
pub(crate) const TIME: &str = "t_s";
pub(crate) const POSITION: [&str; 2] = ["measured_x_m", "measured_y_m"];
pub(crate) const COMMAND: [&str; 2] = ["commanded_x_n", "commanded_y_n"];
pub(crate) const SPIN: &str = "spin_rad_s";
/// Rows that stand between two ticks there.
const BETWEEN: &str = "mode_change";

/// Largest deviation of a time from an even course, as a share of the period.
const UNEVEN: f64 = 0.01;
/// Largest part of a tick that a row may lie beside one.
const OFF_TICK: f64 = 0.25;

impl LogFile {
    /// Reads a file by its ending, `.csv`, `.mat`, `.mcap` or `.parquet`, with columns under other names.
    ///
    /// # Errors
    /// [`LogError`]: why it cannot be read.
    pub fn read(path: &Path, renamed: &[Renamed]) -> Result<Self, LogError> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let read = match ending.to_str().unwrap_or_default() {
            "csv" | "txt" => of_csv(path),
            "mat" => of_mat(path),
            "mcap" => of_mcap(path),
            _ => of_parquet(path),
        };
        let columns = read.map_err(|reason| {
            let help = "give a log as .csv with names in its first line, .parquet, .mat of version 5 to 7, or .mcap with messages in JSON";
            LogError::new(reason, help)
        })?;
        let lacking = BTreeMap::new();
        let mut log = Self { columns, lacking };
        for to in renamed {
            // A star may be part of a name.
            let whole = log.columns.contains_key(&to.of);
            let scaled = to.scaled().filter(|_| !whole);
            let (column, factor) = scaled.unwrap_or((&to.of, 1.0));
            match log.columns.get(column).cloned() {
                Some(mut found) => {
                    found.values.iter_mut().for_each(|x| *x *= factor);
                    log.columns.insert(to.name.clone(), found);
                }
                None => {
                    log.lacking.insert(to.name.clone(), column.to_owned());
                }
            }
        }
        Ok(log)
    }

    /// The same of ticks: without the rows that stand between two of them in traces of this program.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub(crate) fn of_ticks(path: &Path, renamed: &[Renamed]) -> Result<Self, LogError> {
        let mut log = Self::read(path, renamed)?;
        log.without(BETWEEN);
        Ok(log)
    }

    /// Whether there is a log at this path, by its ending.
    pub fn is_at(path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default();
        ["csv", "mat", "mcap", "parquet", "txt"]
            .iter()
            .any(|known| ending.eq_ignore_ascii_case(known))
    }

    fn raw(&self, name: &str) -> Result<&Column, LogError> {
        self.columns.get(name).ok_or_else(|| {
            let names: Vec<&str> = self.columns.keys().map(String::as_str).collect();
            let help = match names.is_empty() {
                true => "a log has a column of numbers under each name".to_owned(),
                false => format!(
                    "it has {}; where one of them is meant, name it",
                    names.join(", ")
                ),
            };
            let name = self.lacking.get(name).map_or(name, String::as_str);
            LogError::new(format!("no column {name}"), help)
        })
    }

    /// Whether there is a column of this name, or one was said to be.
    pub fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name) || self.lacking.contains_key(name)
    }

    /// Numbers of a column, NaN where a row has none.
    ///
    /// # Errors
    /// [`LogError`] where there is no such column, or something in it that is no number.
    pub fn column(&self, name: &str) -> Result<&[f64], LogError> {
        let column = self.raw(name)?;
        match &column.wrong {
            None => Ok(&column.values),
            Some((line, cell)) => Err(LogError::new(
                format!("line {line}: {name} is {cell:?}, expected a number"),
                "leave a cell empty where there is no number",
            )),
        }
    }

    /// The same of one that has as many rows as another: vectors of a MAT file need not.
    ///
    /// # Errors
    /// As [`Self::column`], and where it has not.
    pub fn beside(&self, other: &str, name: &str) -> Result<&[f64], LogError> {
        let (rows, column) = (self.column(other)?.len(), self.column(name)?);
        match column.len() == rows {
            true => Ok(column),
            false => Err(LogError::new(
                format!("{name} has {} rows and {other} {rows}", column.len()),
                "give columns of one log, a row a tick",
            )),
        }
    }

    /// The same of a column that a log may lack.
    ///
    /// # Errors
    /// As [`Self::beside`], of one that is there or was said to be.
    pub(crate) fn beside_if_there(
        &self,
        other: &str,
        name: &str,
    ) -> Result<Option<&[f64]>, LogError> {
        let there = self.has(name);
        there.then(|| self.beside(other, name)).transpose()
    }

    /// Columns for x and y, with as many rows as another.
    ///
    /// # Errors
    /// As [`Self::beside`].
    pub fn pair(&self, other: &str, [x, y]: [&str; 2]) -> Result<Vec<[f64; 2]>, LogError> {
        let rows = self.beside(other, x)?.iter().zip(self.beside(other, y)?);
        Ok(rows.map(|(x, y)| [*x, *y]).collect())
    }

    /// Time from row to row, by a column of times.
    ///
    /// # Errors
    /// [`LogError`] where they do not go on evenly.
    pub fn period_s(&self, time: &str) -> Result<f64, LogError> {
        let times = self.column(time)?;
        let last = times.len().saturating_sub(1);
        let all_s = times
            .last()
            .zip(times.first())
            .map_or(f64::NAN, |(b, a)| b - a);
        let period_s = all_s / last as f64;
        // Against the whole course: times are often rounded to fewer places than a period has.
        let is_even =
            |w: &[f64]| (w[1] - w[0] - period_s).abs() <= UNEVEN * period_s + 2.0 * rounding(w[1]);
        let uneven = times.windows(2).position(|w| !is_even(w));
        match uneven {
            None if period_s > 0.0 && period_s.is_finite() => Ok(period_s),
            at => Err(LogError::new(
                format!(
                    "{time} does not go on evenly, from row {} on",
                    at.unwrap_or(0) + 1
                ),
                "log every tick, with its time",
            )),
        }
    }

    /// Time from tick to tick, and each row's number of ticks since the first: rows may be missing, or stand twice.
    ///
    /// # Errors
    /// [`LogError`] where rows do not lie on ticks.
    pub fn ticks(&self, time: &str) -> Result<(f64, Vec<u32>), LogError> {
        let times = self.column(time)?;
        let mut apart: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        apart.sort_by(f64::total_cmp);
        let usual_s = apart.get(apart.len() / 2).copied().unwrap_or(f64::NAN);
        let first_s = times.first().copied().unwrap_or(f64::NAN);
        // What a period is off by adds up over a long log: from the whole of it where no row is missing.
        let period_s = self.period_s(time).unwrap_or(usual_s);
        if !(period_s > 0.0 && period_s.is_finite()) {
            return Err(LogError::new(
                format!("{time} does not rise from row to row"),
                "give every row its time",
            ));
        }
        let mut number = 0.0;
        let mut ticks = Vec::with_capacity(times.len());
        for (row, t_s) in times.iter().enumerate() {
            let before_s = if row == 0 { first_s } else { times[row - 1] };
            let steps = (t_s - before_s) / period_s;
            let off = (steps - steps.round()).abs();
            if !(steps >= 0.0 && off <= OFF_TICK + rounding(*t_s) / period_s) {
                return Err(LogError::new(
                    format!(
                        "{time} in row {} is not on a tick of {period_s:.3e} s",
                        row + 1
                    ),
                    "log every tick with its time; rows may be missing",
                ));
            }
            number += steps.round();
            ticks.push(number as u32);
        }
        Ok((period_s, ticks))
    }

    /// Leaves out rows in which a column is not zero.
    fn without(&mut self, name: &str) {
        let Some(marks) = self.columns.remove(name) else {
            return;
        };
        for column in self.columns.values_mut() {
            let mut rows = marks.values.iter();
            column
                .values
                .retain(|_| rows.next().is_none_or(|mark| *mark == 0.0));
        }
    }
}

/// What times of this size are known to in single precision, in which some loggers keep them.
fn rounding(time_s: f64) -> f64 {
    time_s.abs() * f64::from(f32::EPSILON)
}

type Columns = BTreeMap<String, Column>;

fn reason(path: &Path) -> impl Fn(&dyn Display) -> String {
    move |reason| format!("{}: {reason}", path.display())
}

/// Cells between commas, semicolons or tabs, whichever the first line has.
fn of_csv(path: &Path) -> Result<Columns, String> {
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
                cell => cell.parse().unwrap_or_else(|_| {
                    column.wrong.get_or_insert((line, cell.to_owned()));
                    f64::NAN
                }),
            };
            column.values.push(value);
        }
    }
    Ok(names.iter().map(str::to_owned).zip(columns).collect())
}

fn of_parquet(path: &Path) -> Result<Columns, String> {
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
                Field::Int(x) => f64::from(*x),
                Field::Long(x) => *x as f64,
                Field::Null => f64::NAN,
                _ => continue,
            };
            match columns.get_mut(name) {
                Some(column) => column.values.push(value),
                None => {
                    let values = vec![value];
                    columns.insert(
                        name.clone(),
                        Column {
                            values,
                            wrong: None,
                        },
                    );
                }
            }
        }
    }
    Ok(columns)
}

/// Vectors by their names; of matrices each column, numbered from 1 on as MATLAB does.
fn of_mat(path: &Path) -> Result<Columns, String> {
    let refused = reason(path);
    let file = File::open(path).map_err(|e| refused(&e))?;
    let mat = MatFile::parse(file)
        .map_err(|e| format!("{} (version 7.3 is another format)", refused(&e)))?;
    let mut columns = Columns::new();
    for array in mat.arrays() {
        let values = doubles(array.data());
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
            let values = values.to_vec();
            columns.insert(
                name,
                Column {
                    values,
                    wrong: None,
                },
            );
        }
    }
    Ok(columns)
}

fn doubles(data: &NumericData) -> Vec<f64> {
    fn wide<T: Copy + Into<f64>>(all: &[T]) -> Vec<f64> {
        all.iter().map(|x| (*x).into()).collect()
    }
    match data {
        NumericData::Int8 { real, .. } => wide(real),
        NumericData::UInt8 { real, .. } => wide(real),
        NumericData::Int16 { real, .. } => wide(real),
        NumericData::UInt16 { real, .. } => wide(real),
        NumericData::Int32 { real, .. } => wide(real),
        NumericData::UInt32 { real, .. } => wide(real),
        NumericData::Int64 { real, .. } => real.iter().map(|x| *x as f64).collect(),
        NumericData::UInt64 { real, .. } => real.iter().map(|x| *x as f64).collect(),
        NumericData::Single { real, .. } => wide(real),
        NumericData::Double { real, .. } => real.clone(),
    }
}

/// Time of a message where it has no column of its own.
const LOG_TIME: &str = "log_time_s";

/// Fields of messages in JSON, those below others behind a dot; before it the topic where there are several.
fn of_mcap(path: &Path) -> Result<Columns, String> {
    let refused = reason(path);
    let bytes = std::fs::read(path).map_err(|e| refused(&e))?;
    /// Columns in the order of fields, and how many messages were read.
    type Topic = (Vec<(String, Column)>, usize);
    let mut topics: BTreeMap<String, Topic> = BTreeMap::new();
    for message in MessageStream::new(&bytes).map_err(|e| refused(&e))? {
        let message = message.map_err(|e| refused(&e))?;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str, renamed: &[&str]) -> Result<LogFile, LogError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let renamed: Vec<Renamed> = renamed.iter().map(|text| text.parse().unwrap()).collect();
        LogFile::read(&path, &renamed)
    }

    #[test]
    fn columns_are_found_by_name_or_renamed_with_their_unit() {
        let text = "\u{feff}# of a machine, once\ntime;x um;\"y*2\";mode\n0.0;1;2;up\n0.1;;4;down\n0.2;5;6;up\n";
        let renamed = ["t_s=time", "x_m=x um*0.5", "y_m=y*2"];
        let log = read("log.csv", text, &renamed).unwrap();
        assert_eq!(log.column("t_s").unwrap(), [0.0, 0.1, 0.2]);
        let x = log.column("x_m").unwrap();
        assert!((x[0], x[2]) == (0.5, 2.5) && x[1].is_nan());
        assert_eq!(log.column("y_m").unwrap(), [2.0, 4.0, 6.0]);
        let error = log.column("mode").unwrap_err();
        assert!(
            error.message.contains("line 3") && error.message.contains("up"),
            "{error}"
        );
        let error = log.column("z").unwrap_err();
        assert!(error.help.contains("x um"), "{}", error.help);
        // A column that was named and is not there is missed where it is asked for.
        let log = read("log.csv", text, &["t_s=zeit"]).unwrap();
        assert!(log.has("t_s") && log.column("t_s").unwrap_err().message.contains("zeit"));
    }

    #[test]
    fn rows_lie_on_ticks_and_may_be_missing() {
        let log = |times: &[f64]| {
            let rows: Vec<String> = times.iter().map(f64::to_string).collect();
            read("log.csv", &format!("t_s\n{}\n", rows.join("\n")), &[]).unwrap()
        };
        let (period_s, ticks) = log(&[5.0, 5.1, 5.2, 5.4, 5.4, 5.5]).ticks("t_s").unwrap();
        assert!((period_s - 0.1).abs() < 1e-9);
        assert_eq!(ticks, [0, 1, 2, 4, 4, 5]);
        assert!(log(&[5.0, 5.1, 5.2, 5.4]).period_s("t_s").is_err());
        for wrong in [
            &[0.0, 0.1, 0.2, 0.35][..],
            &[0.0, 0.1, 0.05],
            &[1.0, 1.0],
            &[1.0],
        ] {
            assert!(log(wrong).ticks("t_s").is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn what_is_no_log_says_so() {
        for (name, text) in [
            ("a.mat", "nonsense"),
            ("a.mcap", "nonsense"),
            ("a.parquet", "x"),
        ] {
            let error = read(name, text, &[]).unwrap_err();
            assert!(error.message.contains(name), "{error}");
        }
        assert!("a".parse::<Renamed>().is_err() && "=b".parse::<Renamed>().is_err());
    }
}
