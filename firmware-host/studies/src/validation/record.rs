//! A record of the rig: columns by name, a row a sample.

use plant_model::V2;
use std::ops::Range;
use std::path::Path;

/// Names of the columns; others are not read.
const COLUMNS: [&str; 4] = ["time_s", "exciter_force_x_n", "disc_x_m", "disc_y_m"];
/// Largest deviation of a time from an even sample, as a share of it.
const UNEVEN: f64 = 0.02;

/// Why there is no record, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct RecordError {
    pub message: String,
    pub help: String,
}

impl RecordError {
    pub(super) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: help.into(),
        }
    }
}

/// What was measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// Time from sample to sample \[s\].
    pub period_s: f64,
    /// Force of the exciter along x \[N\].
    pub exciter_n: Vec<f64>,
    /// Centre of the disc \[m\].
    pub disc_m: Vec<V2>,
}

impl Record {
    /// Reads a file of CSV with a line of names.
    ///
    /// # Errors
    /// [`RecordError`]: what is missing, or which line is no number.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        let text = std::fs::read_to_string(path).map_err(|error| {
            let help = "give a file of CSV that can be read";
            RecordError::new(format!("{}: {error}", path.display()), help)
        })?;
        Self::parse(&text).map_err(|error| RecordError {
            message: format!("{}: {}", path.display(), error.message),
            ..error
        })
    }

    /// The same of a text.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &str) -> Result<Self, RecordError> {
        let mut lines = (text.lines().enumerate()).filter(|(_, line)| !line.trim().is_empty());
        let names: Vec<&str> = (lines.next()).map_or(Vec::new(), |(_, line)| {
            line.split(',').map(str::trim).collect()
        });
        let mut places = [0; 4];
        for (place, name) in places.iter_mut().zip(COLUMNS) {
            *place = names.iter().position(|n| *n == name).ok_or_else(|| {
                let help = format!("the first line names the columns: {}", COLUMNS.join(","));
                RecordError::new(format!("no column {name}"), help)
            })?;
        }
        let mut rows = Vec::new();
        for (number, line) in lines {
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let mut row = [0.0; 4];
            for ((value, place), name) in row.iter_mut().zip(places).zip(COLUMNS) {
                let cell = cells.get(place).copied().unwrap_or_default();
                let number_of_cell = cell.parse().ok().filter(|x: &f64| x.is_finite());
                *value = number_of_cell.ok_or_else(|| {
                    let message = format!("line {}: {name} is {cell:?}", number + 1);
                    RecordError::new(message, "give a number in every row of these columns")
                })?;
            }
            rows.push((number + 1, row));
        }
        let (Some((_, first)), Some((_, last))) = (rows.first(), rows.last()) else {
            return Err(RecordError::new("no rows", "give the samples in order"));
        };
        let begin_s = first[0];
        let period_s = (last[0] - begin_s) / (rows.len() - 1) as f64;
        for (sample, (line, row)) in rows.iter().enumerate() {
            let off_s = row[0] - begin_s - sample as f64 * period_s;
            // One row has no period: what is no number is not even.
            let is_even = off_s.abs() <= UNEVEN * period_s;
            if !is_even {
                let message = format!("line {line}: time_s is {}, not one sample on", row[0]);
                let help = "give samples at an even rate, in order and without gaps";
                return Err(RecordError::new(message, help));
            }
        }
        Ok(Self {
            period_s,
            exciter_n: rows.iter().map(|(_, row)| row[1]).collect(),
            disc_m: rows
                .iter()
                .map(|(_, row)| V2::new(row[2], row[3]))
                .collect(),
        })
    }

    /// Some of its samples.
    #[must_use]
    pub fn part(&self, samples: Range<usize>) -> Self {
        Self {
            period_s: self.period_s,
            exciter_n: self.exciter_n[samples.clone()].to_vec(),
            disc_m: self.disc_m[samples].to_vec(),
        }
    }

    /// Samples before a time.
    pub fn samples_to(&self, t_s: f64) -> usize {
        ((t_s / self.period_s).round() as usize).min(self.disc_m.len())
    }
}

#[cfg(test)]
mod tests {
    use super::Record;

    const HEAD: &str = "time_s,more,exciter_force_x_n,disc_x_m,disc_y_m\n";

    #[test]
    fn a_record_by_names() {
        let text = format!("{HEAD}0,7,1.5,1e-3,-2e-3\n0.001, 7, 2.5, 0, 0\n\n0.002,7,3,0,4e-3\n");
        let record = Record::parse(&text).unwrap();
        assert_eq!(record.exciter_n, [1.5, 2.5, 3.0]);
        assert_eq!(record.disc_m[0].y, -2e-3);
        assert!((record.period_s - 1e-3).abs() < 1e-12);
        assert_eq!([record.samples_to(0.002), record.samples_to(1.0)], [2, 3]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let error = |text: &str| Record::parse(text).unwrap_err().message;
        assert_eq!(error(""), "no column time_s");
        assert_eq!(error(&HEAD.replace("disc_x_m", "x")), "no column disc_x_m");
        assert_eq!(error(HEAD), "no rows");
        let row = |text: &str| error(&format!("{HEAD}0,7,1,0,0\n{text}\n0.002,7,1,0,0\n"));
        assert_eq!(
            row("0.001,7,one,0,0"),
            "line 3: exciter_force_x_n is \"one\""
        );
        assert_eq!(
            row("0.001,7,NaN,0,0"),
            "line 3: exciter_force_x_n is \"NaN\""
        );
        assert_eq!(row("0.001,7,1,0"), "line 3: disc_y_m is \"\"");
        let uneven = row("0.0015,7,1,0,0");
        assert_eq!(uneven, "line 3: time_s is 0.0015, not one sample on");
        assert!(error(&format!("{HEAD}0,7,1,0,0\n")).contains("not one sample on"));
    }
}
