//! A log of a run of commissioning: columns by name, a row a tick; of two planes in one log each behind the name of its plane and a dot.

use crate::log_file::{COMMAND, LogError, LogFile, POSITION, Renamed, SPIN, TIME};
use std::path::Path;

/// A log, SI units.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Log {
    /// Time from row to row, and of the first \[s\].
    pub period_s: f64,
    pub from_s: f64,
    pub position_m: Vec<[f64; 2]>,
    /// Commands, with the stimulus in them.
    pub command_n: Vec<[f64; 2]>,
    pub stimulus_n: Vec<[f64; 2]>,
    pub spin_rad_s: Option<Vec<f64>>,
}

/// For x and y.
const STIMULUS: [&str; 2] = ["stimulus_x_n", "stimulus_y_n"];

impl Log {
    /// Reads a log with these columns, or others that are renamed to them.
    ///
    /// # Errors
    /// [`LogError`]: which column is missing, or which row is no number.
    pub fn read(path: &Path, renamed: &[Renamed]) -> Result<Self, LogError> {
        let log = LogFile::of_ticks(path, renamed)?;
        log.expect(&known(&[""]))?;
        Self::of_plane(&log, "")
    }

    /// Reads both planes out of one log; `None` where its columns do not begin with names of planes.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn of_planes(
        path: &Path,
        renamed: &[Renamed],
        [first, second]: &[String; 2],
    ) -> Result<Option<[Self; 2]>, LogError> {
        let log = LogFile::of_ticks(path, renamed)?;
        let prefixes = [format!("{first}."), format!("{second}.")];
        let there = |prefix: &String| log.has(&format!("{prefix}{}", POSITION[0]));
        if !prefixes.iter().any(there) {
            return Ok(None);
        }
        let [first, second] = prefixes.each_ref().map(String::as_str);
        log.expect(&known(&[first, second]))?;
        let [first, second] = [Self::of_plane(&log, first)?, Self::of_plane(&log, second)?];
        Ok(Some([first, second]))
    }

    /// Whether rows of two logs are of the same times.
    ///
    /// # Errors
    /// [`LogError`] where they are not.
    pub fn goes_with(&self, other: &Self) -> Result<(), LogError> {
        let rows = [self, other].map(|log| log.position_m.len());
        let periods_s = [self, other].map(|log| log.period_s);
        let [first_s, second_s] = [self, other].map(|log| log.from_s);
        let together = (first_s - second_s).abs() < 0.5 * self.period_s;
        let alike = (periods_s[0] / periods_s[1] - 1.0).abs() < 1e-6;
        match rows[0] == rows[1] && together && alike {
            true => Ok(()),
            false => Err(LogError::new(
                format!(
                    "has {} rows of {:.6e} s from {second_s} s on, the log of the other plane {} of {:.6e} s from {first_s} s on",
                    rows[1], periods_s[1], rows[0], periods_s[0]
                ),
                "give logs of both planes over the same ticks",
            )),
        }
    }

    fn of_plane(log: &LogFile, prefix: &str) -> Result<Self, LogError> {
        let named = |names: [&str; 2]| names.map(|name| format!("{prefix}{name}"));
        let [position, _] = named(POSITION);
        let pair = |names: [&str; 2]| {
            let [x, y] = named(names);
            whole(log, &position, [&x, &y])
        };
        let spin_rad_s = log.beside_if_there(&position, SPIN)?;
        // One without numbers is none.
        let spin_rad_s = spin_rad_s.filter(|spin| spin.iter().all(|s| s.is_finite()));
        // A column that is missing says more than times that are odd.
        let (position_m, command_n, stimulus_n) =
            (pair(POSITION)?, pair(COMMAND)?, pair(STIMULUS)?);
        Ok(Self {
            position_m,
            command_n,
            stimulus_n,
            spin_rad_s: spin_rad_s.map(<[f64]>::to_vec),
            period_s: log.period_s(TIME)?,
            from_s: log.column(TIME)?[0],
        })
    }

    /// Positions alone, of a walk round the retainer bearing; of what is renamed them alone.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn positions(path: &Path, renamed: &[Renamed]) -> Result<Vec<[f64; 2]>, LogError> {
        let renamed: Vec<Renamed> = (renamed.iter())
            .filter(|to| POSITION.contains(&to.name()))
            .cloned()
            .collect();
        whole(&LogFile::of_ticks(path, &renamed)?, POSITION[0], POSITION)
    }
}

/// Names that are looked for, of planes whose columns begin so.
fn known(prefixes: &[&str]) -> Vec<String> {
    let of_planes = [POSITION, COMMAND, STIMULUS].concat();
    let of_planes = (prefixes.iter())
        .flat_map(|prefix| of_planes.iter().map(move |name| format!("{prefix}{name}")));
    let all = [TIME, SPIN].map(str::to_owned).into_iter().chain(of_planes);
    all.collect()
}

/// A pair of columns without a gap.
fn whole(log: &LogFile, beside: &str, names: [&str; 2]) -> Result<Vec<[f64; 2]>, LogError> {
    let all = log.pair(beside, names)?;
    let gap = all
        .iter()
        .position(|pair| !pair.iter().all(|x| x.is_finite()));
    match gap {
        None => Ok(all),
        Some(row) => Err(LogError::new(
            format!(
                "{} or {} is no number in row {}",
                names[0],
                names[1],
                row + 1
            ),
            "give the log of a run in which a supervisor asked for its stimulus",
        )),
    }
}
