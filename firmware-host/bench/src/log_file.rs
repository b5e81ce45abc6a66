//! Columns of numbers by name, from logs as other programs write them: CSV, Parquet, MAT and MCAP.

mod column;
mod formats;

use self::column::{Column, Step, Wrong};
use self::formats::{Columns, of_csv, of_mat, of_mcap, of_parquet};
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
    /// The name that it gives.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The column that it is of, in its unit.
    fn find(&self, columns: &Columns) -> Result<Column, LogError> {
        let refused = |message: String, help: String| {
            let message = format!("--column {}={}: {message}", self.name, self.of);
            LogError::new(message, help)
        };
        // A star may be part of a name.
        let whole = columns.contains_key(&self.of);
        let scaled = self.of.rsplit_once('*').filter(|_| !whole);
        let (column, factor) = scaled.map_or((self.of.as_str(), "1"), |(column, factor)| {
            (column.trim(), factor.trim())
        });
        let found = columns
            .get(column)
            .ok_or_else(|| refused(format!("no column {column}"), names(columns)))?;
        let number = factor.parse().ok();
        let number = number.filter(|x: &f64| x.is_finite() && *x != 0.0);
        let number = number.ok_or_else(|| {
            let help = "give what turns its unit into that of the name, as 1e-6 for µm";
            let message = format!("the factor is {factor}, expected a finite number that is not 0");
            refused(message, help.to_owned())
        })?;
        Ok(found.clone().times(number))
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

/// A log, column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFile {
    columns: Columns,
    /// Names that were given to its columns.
    given: Vec<Renamed>,
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
/// Largest part of a tick that a row may lie beside one: by itself, and with the step of its time.
const OFF_TICK: (f64, f64) = (0.25, 0.45);
/// Largest step of times, as a share of the period, by which it shows whether a row is missing.
const COARSE: f64 = 0.26;
/// Rates of control loops \[Hz\].
const LOOP_RATES_HZ: (f64, f64) = (100.0, 1e6);

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
        let mut columns = read.map_err(|reason| {
            let help = "give a log as .csv with names in its first line, .parquet, .mat of version 5 to 7, or .mcap with messages in JSON";
            LogError::new(reason, help)
        })?;
        // All of what the file has, before any is in another's place.
        let mut found = Vec::new();
        for (i, to) in renamed.iter().enumerate() {
            if renamed[..i].iter().any(|other| other.name == to.name) {
                let message = format!("--column {}={}: it has a column already", to.name, to.of);
                return Err(LogError::new(message, "give each name one column"));
            }
            found.push((to.name.clone(), to.find(&columns)?));
        }
        columns.extend(found);
        let given = renamed.to_vec();
        Ok(Self { columns, given })
    }

    /// Refuses a name that was given to a column and that nobody looks for.
    ///
    /// # Errors
    /// [`LogError`] with those that are looked for.
    pub(crate) fn expect(&self, known: &[String]) -> Result<(), LogError> {
        match self.given.iter().find(|to| !known.contains(&to.name)) {
            None => Ok(()),
            Some(Renamed { name, of }) => Err(LogError::new(
                format!("--column {name}={of}: {name} is no column that is looked for"),
                format!("expected one of {}", known.join(", ")),
            )),
        }
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
        self.columns
            .get(name)
            .ok_or_else(|| LogError::new(format!("no column {name}"), names(&self.columns)))
    }

    /// Whether there is a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name)
    }

    /// Numbers of a column, NaN where a row has none.
    ///
    /// # Errors
    /// [`LogError`] where there is no such column, or something in it that is no number.
    pub fn column(&self, name: &str) -> Result<&[f64], LogError> {
        let column = self.raw(name)?;
        match &column.wrong {
            None => Ok(&column.values),
            Some(Wrong::Cell(line, cell)) => Err(LogError::new(
                format!("line {line}: {name} is {cell:?}, expected a number"),
                "leave a cell empty where there is no number",
            )),
            Some(Wrong::Complex) => Err(LogError::new(
                format!("{name} is of complex numbers, expected real ones"),
                "write its real and imaginary part as columns of their own",
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
    /// As [`Self::beside`], of one that is there.
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

    /// Two times and more, none of them before another.
    fn times(&self, time: &str) -> Result<(&[f64], Step), LogError> {
        let times = self.column(time)?;
        let refused = |message: String, help: &str| Err(LogError::new(message, help));
        if times.len() < 2 {
            let rows = times.len();
            let message = format!("has too few rows, {rows}, expected two at least");
            return refused(
                message,
                "log every tick, from before the event to behind it",
            );
        }
        if let Some(row) = times.iter().position(|t| !t.is_finite()) {
            let message = format!("{time} is no number in row {}", row + 1);
            return refused(message, "give every row its time");
        }
        if let Some(row) = times.windows(2).position(|w| w[1] < w[0]) {
            let message = format!("{time} goes back in row {}", row + 2);
            return refused(
                message,
                "give the rows in the order in which they were logged",
            );
        }
        Ok((times, self.raw(time)?.step()))
    }

    /// Time from row to row, by a column of times.
    ///
    /// # Errors
    /// [`LogError`] where they do not go on evenly.
    pub fn period_s(&self, time: &str) -> Result<f64, LogError> {
        let (times, step) = self.times(time)?;
        even_period_s(time, times, step)
    }

    /// Time from tick to tick, and each row's number of ticks since the first: rows may be missing, or stand twice.
    ///
    /// # Errors
    /// [`LogError`] where rows do not lie on ticks.
    pub fn ticks(&self, time: &str) -> Result<(f64, Vec<u32>), LogError> {
        let (times, step) = self.times(time)?;
        // What a period is off by adds up over a long log: from the whole of it where no row is missing.
        let even_s = even_period_s(time, times, step).ok();
        let period_s = of_a_loop(time, even_s.unwrap_or_else(|| usual(times)))?;
        let twice = times.windows(2).any(|w| w[0] == w[1]);
        if even_s.is_none() && step.size > COARSE * period_s && (twice || !step.decimal) {
            return Err(coarse(time, step, period_s));
        }
        let allowed = (OFF_TICK.0 + step.size / period_s).min(OFF_TICK.1);
        let mut number = 0.0;
        let mut ticks = vec![0];
        for (row, w) in times.windows(2).enumerate() {
            let steps = (w[1] - w[0]) / period_s;
            if (steps - steps.round()).abs() > allowed {
                return Err(LogError::new(
                    format!(
                        "{time} in row {} is not on a tick of {period_s:.3e} s",
                        row + 2
                    ),
                    "log every tick with its time; rows may be missing",
                ));
            }
            number += steps.round();
            ticks.push(number as u32);
        }
        let whole_s = times[times.len() - 1] - times[0];
        Ok((whole_s / f64::max(number, 1.0), ticks))
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

/// What is there, where something is not.
fn names(columns: &Columns) -> String {
    let names: Vec<&str> = columns.keys().map(String::as_str).collect();
    match names.is_empty() {
        true => "a log has a column of numbers under each name".to_owned(),
        false => format!(
            "it has {}; where one of them is meant, name it",
            names.join(", ")
        ),
    }
}

/// Time from row to row, where they go on evenly.
fn even_period_s(time: &str, times: &[f64], step: Step) -> Result<f64, LogError> {
    let rows = (times.len() - 1) as f64;
    let period_s = (times[times.len() - 1] - times[0]) / rows;
    // Against the whole course: times are often rounded to fewer places than a period has.
    let allowed_s = UNEVEN * period_s + step.size.min(COARSE * period_s);
    let is_even = |w: &[f64]| (w[1] - w[0] - period_s).abs() <= allowed_s;
    match times.windows(2).position(|w| !is_even(w)) {
        None => of_a_loop(time, period_s),
        Some(_) if step.size > COARSE * period_s && !step.decimal => {
            Err(coarse(time, step, period_s))
        }
        Some(row) => Err(LogError::new(
            format!("{time} does not go on evenly, from row {} on", row + 1),
            "log every tick, with its time",
        )),
    }
}

/// The time that most rows are apart: a mean over these, so that rounding goes out of it.
fn usual(times: &[f64]) -> f64 {
    let mut apart: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    apart.sort_by(f64::total_cmp);
    let middle = apart[apart.len() / 2];
    let near = |x: &&f64| (0.7 * middle..=1.3 * middle).contains(*x);
    let near: Vec<f64> = apart.iter().filter(near).copied().collect();
    near.iter().sum::<f64>() / near.len() as f64
}

/// A period, where a control loop may have it.
fn of_a_loop(time: &str, period_s: f64) -> Result<f64, LogError> {
    if period_s <= 0.0 {
        let message = format!("{time} does not rise from row to row");
        return Err(LogError::new(
            message,
            "give every row its time, with all its digits",
        ));
    }
    let (slowest, fastest) = LOOP_RATES_HZ;
    match (slowest..=fastest).contains(&(1.0 / period_s)) {
        true => Ok(period_s),
        false => Err(LogError::new(
            format!("rows are {period_s:e} s apart by {time}: no control loop is so slow or fast"),
            "turn its unit into s: --column t_s=t_s*1e-3, where it is ms, 1e-6 for µs, 1e-9 for ns",
        )),
    }
}

fn coarse(time: &str, step: Step, period_s: f64) -> LogError {
    LogError::new(
        format!(
            "{time} is known in steps of {:.1e} s where it is largest, and rows are {period_s:.1e} s apart: which are missing does not show",
            step.size
        ),
        "write times with more digits, in double precision, or counted from the first row",
    )
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
        // Two that change places.
        let swapped = ["x um=y*2", "y*2=x um"];
        let log = read("log.csv", text, &swapped).unwrap();
        assert_eq!(log.column("x um").unwrap()[0], 2.0);
        assert_eq!(log.column("y*2").unwrap()[0], 1.0);
    }

    #[test]
    fn a_name_without_a_column_or_a_factor_is_refused() {
        let text = "t_s,x\n0,1\n1,2\n";
        for (renamed, says) in [
            ("t_s=nope", "no column nope"),
            ("x=nope*1e-6", "no column nope"),
            ("x=x*0", "the factor is 0"),
            ("x=x*nan", "the factor is nan"),
            ("x=x*1e400", "the factor is 1e400"),
            ("x=x*mm", "the factor is mm"),
        ] {
            let error = read("log.csv", text, &[renamed]).unwrap_err();
            let named = error.message.contains(renamed) && error.message.contains(says);
            assert!(named, "{error}");
        }
        let error = read("log.csv", text, &["x=x", "x=t_s"]).unwrap_err();
        assert!(error.message.contains("already"), "{error}");
        let log = read("log.csv", text, &["foo=x"]).unwrap();
        assert!(log.expect(&["foo".to_owned()]).is_ok());
        let error = log.expect(&["t_s".to_owned()]).unwrap_err();
        assert!(error.message.contains("foo") && error.help.contains("t_s"));
    }

    fn log(times: &[f64]) -> LogFile {
        let rows: Vec<String> = times.iter().map(f64::to_string).collect();
        read("log.csv", &format!("t_s\n{}\n", rows.join("\n")), &[]).unwrap()
    }

    #[test]
    fn rows_lie_on_ticks_and_may_be_missing() {
        let (period_s, ticks) = log(&[5.0, 5.001, 5.002, 5.0041, 5.0041, 5.005])
            .ticks("t_s")
            .unwrap();
        assert!((period_s - 0.001).abs() < 1e-9);
        assert_eq!(ticks, [0, 1, 2, 4, 4, 5]);
        assert!(log(&[5.0, 5.001, 5.002, 5.004]).period_s("t_s").is_err());
        for (wrong, says) in [
            (&[0.0, 0.001, 0.002, 0.0035][..], "row 4 is not on a tick"),
            (&[0.0, 0.001, 0.0005], "goes back in row 3"),
            (&[1.0, 1.0], "does not rise"),
            (&[0.0, f64::NAN, 0.001], "no number in row 2"),
            (&[0.0, 1.0, 2.0], "no control loop"),
            (&[1.0], "too few rows, 1"),
            (&[], "too few rows, 0"),
        ] {
            let error = log(wrong).ticks("t_s").unwrap_err();
            assert!(error.message.contains(says), "{says}: {error}");
            let error = log(wrong).period_s("t_s").unwrap_err();
            assert!(
                says.contains("tick") || error.message.contains(says),
                "{error}"
            );
        }
    }

    /// Rows of 20 kHz from some time on, a tenth of them missing: to be detected where the file holds times finely enough.
    #[test]
    fn rows_that_are_missing_show_at_any_time() {
        let from = |first_s: f64| -> Vec<f64> {
            (0..4000)
                .filter(|i| i % 10 != 7)
                .map(|i| first_s + 5e-5 * f64::from(i))
                .collect()
        };
        for first_s in [0.0, 1e3, 1e6, 1.7e9] {
            let log = log(&from(first_s));
            assert!(log.period_s("t_s").is_err(), "{first_s}");
            let (period_s, ticks) = log.ticks("t_s").unwrap();
            assert!(
                (period_s / 5e-5 - 1.0).abs() < 1e-3,
                "{first_s}: {period_s}"
            );
            assert_eq!(ticks.last(), Some(&3999));
        }
        // Times of single precision, written out, and those of few digits.
        let single = |first_s| -> Vec<f64> {
            (from(first_s).iter())
                .map(|t| f64::from(*t as f32))
                .collect()
        };
        let (period_s, ticks) = log(&single(100.0)).ticks("t_s").unwrap();
        assert!((period_s / 5e-5 - 1.0).abs() < 1e-4, "{period_s}");
        assert_eq!(ticks.last(), Some(&3999));
        let few = |first_s| -> Vec<f64> {
            (from(first_s).iter())
                .map(|t| (1e4 * t).round() / 1e4)
                .collect()
        };
        for coarse in [single(1e3), few(1e3)] {
            let error = log(&coarse).ticks("t_s").unwrap_err();
            assert!(error.message.contains("is known in steps of"), "{error}");
            assert!(log(&coarse).period_s("t_s").is_err());
        }
        // Counts, of a unit that is not s.
        let text = "n\n0\n1\n2\n4\n5\n";
        let log = read("log.csv", text, &["t_s=n*5e-5"]).unwrap();
        assert_eq!(log.ticks("t_s").unwrap().1, [0, 1, 2, 4, 5]);
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
        // Lengths of records that no file has.
        let path = tempfile::tempdir().unwrap();
        let path = path.path().join("far.mcap");
        let bytes = [&b"\x89MCAP0\r\n"[..], &[0xff; 100]].concat();
        std::fs::write(&path, bytes).unwrap();
        let error = LogFile::read(&path, &[]).unwrap_err();
        assert!(error.message.contains("far.mcap"), "{error}");
        assert!("a".parse::<Renamed>().is_err() && "=b".parse::<Renamed>().is_err());
    }
}
