//! A log of a run of commissioning: columns of one plane by name, a row a tick.

use crate::commission::LogError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::HashMap;
use std::fs::File;
use std::path::Path;

/// A log, SI units.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// Time from row to row \[s\].
    pub period_s: f64,
    pub position_m: Vec<[f64; 2]>,
    /// Commands, with the stimulus in them.
    pub command_n: Vec<[f64; 2]>,
    pub stimulus_n: Vec<[f64; 2]>,
    pub spin_rad_s: Option<Vec<f64>>,
}

/// Names of columns, each pair for x and y.
const POSITION: [&str; 2] = ["measured_x_m", "measured_y_m"];
const COMMAND: [&str; 2] = ["commanded_x_n", "commanded_y_n"];
const STIMULUS: [&str; 2] = ["stimulus_x_n", "stimulus_y_n"];
const SPIN: &str = "spin_rad_s";
const TIME: &str = "t_s";
/// Rows that stand between two ticks, in traces of this program.
const BETWEEN: &str = "mode_change";

/// Largest deviation of a time from an even tick, as a share of it.
const UNEVEN: f64 = 0.01;

/// Columns of numbers by name.
struct Columns(HashMap<String, Vec<f64>>);

impl Log {
    /// Reads a Parquet file, or CSV with a line of names.
    ///
    /// # Errors
    /// [`LogError`]: which column is missing, or which row is no number.
    pub fn read(path: &Path) -> Result<Self, LogError> {
        let columns = Columns::read(path)?;
        let position_m = columns.pair(POSITION)?;
        let command_n = columns.pair(COMMAND)?;
        let stimulus_n = columns.pair(STIMULUS)?;
        Ok(Self {
            period_s: columns.period_s()?,
            position_m,
            command_n,
            stimulus_n,
            spin_rad_s: columns.0.get(SPIN).cloned(),
        })
    }

    /// Positions alone, of a walk round the retainer bearing.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn positions(path: &Path) -> Result<Vec<[f64; 2]>, LogError> {
        Columns::read(path)?.pair(POSITION)
    }
}

impl Columns {
    fn read(path: &Path) -> Result<Self, LogError> {
        let is_csv = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        let mut columns = match is_csv {
            true => Self::of_csv(path)?,
            false => Self::of_parquet(path)?,
        };
        for (name, values) in &columns.0 {
            if let Some(row) = values.iter().position(|value| !value.is_finite()) {
                return Err(LogError::new(
                    format!("{name} is no number in row {}", row + 1),
                    "give the log of a run in which a supervisor asked for its stimulus",
                ));
            }
        }
        if let Some(between) = columns.0.remove(BETWEEN) {
            for values in columns.0.values_mut() {
                let kept = values
                    .iter()
                    .zip(&between)
                    .filter(|(_, between)| **between == 0.0);
                *values = kept.map(|(value, _)| *value).collect();
            }
        }
        Ok(columns)
    }

    fn of_csv(path: &Path) -> Result<Self, LogError> {
        let text = std::fs::read_to_string(path).map_err(|e| unreadable(path, &e))?;
        let mut lines = text.lines();
        let names: Vec<&str> = lines
            .next()
            .unwrap_or_default()
            .split(',')
            .map(str::trim)
            .collect();
        let wanted: Vec<bool> = names.iter().map(|name| is_wanted(name)).collect();
        let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
        for (number, line) in lines
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty())
        {
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            for (place, name) in names.iter().enumerate().filter(|(place, _)| wanted[*place]) {
                let cell = cells.get(place).copied().unwrap_or_default();
                let value = match cell {
                    "true" => Some(1.0),
                    "false" => Some(0.0),
                    cell => cell.parse::<f64>().ok().filter(|value| value.is_finite()),
                };
                let value = value.ok_or_else(|| {
                    LogError::new(
                        format!(
                            "{}: line {}: {name} is {cell:?}, expected a number",
                            path.display(),
                            number + 2
                        ),
                        "write every tick with numbers in all of these columns",
                    )
                })?;
                columns[place].push(value);
            }
        }
        let named = names
            .iter()
            .zip(columns)
            .zip(wanted)
            .filter(|(_, wanted)| *wanted);
        Ok(Self(
            named
                .map(|((name, values), _)| ((*name).to_owned(), values))
                .collect(),
        ))
    }

    fn of_parquet(path: &Path) -> Result<Self, LogError> {
        let broken = |e: parquet::errors::ParquetError| unreadable(path, &e);
        let file = File::open(path).map_err(|e| unreadable(path, &e))?;
        let reader = SerializedFileReader::new(file).map_err(broken)?;
        let mut columns: HashMap<String, Vec<f64>> = HashMap::new();
        for row in reader.get_row_iter(None).map_err(broken)? {
            for (name, field) in row.map_err(broken)?.get_column_iter() {
                let value = match field {
                    Field::Double(x) => *x,
                    Field::Float(x) => f64::from(*x),
                    Field::Bool(x) => f64::from(*x),
                    _ => continue,
                };
                if is_wanted(name) {
                    columns.entry(name.clone()).or_default().push(value);
                }
            }
        }
        Ok(Self(columns))
    }

    fn one(&self, name: &str) -> Result<&[f64], LogError> {
        let column = self.0.get(name).filter(|column| column.len() > 1);
        column.map(Vec::as_slice).ok_or_else(|| {
            LogError::new(
                format!("no column {name}"),
                format!(
                    "a log has {TIME}, {}, {}, {} and perhaps {SPIN}: as Parquet, or as CSV with these names in its first line",
                    POSITION.join(", "),
                    COMMAND.join(", "),
                    STIMULUS.join(", ")
                ),
            )
        })
    }

    fn pair(&self, [x, y]: [&str; 2]) -> Result<Vec<[f64; 2]>, LogError> {
        Ok(self
            .one(x)?
            .iter()
            .zip(self.one(y)?)
            .map(|(x, y)| [*x, *y])
            .collect())
    }

    fn period_s(&self) -> Result<f64, LogError> {
        let times = self.one(TIME)?;
        let last = times.len() - 1;
        let period_s = (times[last] - times[0]) / last as f64;
        let uneven =
            (times.windows(2)).position(|w| ((w[1] - w[0]) / period_s - 1.0).abs() > UNEVEN);
        match uneven {
            None if period_s > 0.0 => Ok(period_s),
            at => Err(LogError::new(
                format!(
                    "{TIME} does not go on evenly, from row {} on",
                    at.unwrap_or(0) + 1
                ),
                "log every tick",
            )),
        }
    }
}

fn is_wanted(name: &str) -> bool {
    let pairs = [POSITION, COMMAND, STIMULUS];
    pairs.iter().flatten().any(|wanted| *wanted == name) || [SPIN, TIME, BETWEEN].contains(&name)
}

fn unreadable(path: &Path, reason: &dyn std::fmt::Display) -> LogError {
    LogError::new(
        format!("{}: {reason}", path.display()),
        "give a log as Parquet, or as .csv",
    )
}
