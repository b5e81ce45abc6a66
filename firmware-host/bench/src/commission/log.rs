//! A log of a run of commissioning: columns of one plane by name, a row a tick.

use crate::log_file::{COMMAND, LogError, LogFile, POSITION, Renamed, SPIN, TIME};
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

/// For x and y.
const STIMULUS: [&str; 2] = ["stimulus_x_n", "stimulus_y_n"];

impl Log {
    /// Reads a log with these columns, or others that are renamed to them.
    ///
    /// # Errors
    /// [`LogError`]: which column is missing, or which row is no number.
    pub fn read(path: &Path, renamed: &[Renamed]) -> Result<Self, LogError> {
        let log = LogFile::of_ticks(path, renamed)?;
        let known = [[TIME, SPIN], POSITION, COMMAND, STIMULUS];
        log.expect(
            &known
                .concat()
                .iter()
                .map(|name| (*name).to_owned())
                .collect::<Vec<_>>(),
        )?;
        let spin_rad_s = log.beside_if_there(POSITION[0], SPIN)?;
        // One without numbers is none.
        let spin_rad_s = spin_rad_s.filter(|spin| spin.iter().all(|s| s.is_finite()));
        Ok(Self {
            position_m: whole(&log, POSITION)?,
            command_n: whole(&log, COMMAND)?,
            stimulus_n: whole(&log, STIMULUS)?,
            spin_rad_s: spin_rad_s.map(<[f64]>::to_vec),
            period_s: log.period_s(TIME)?,
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
        whole(&LogFile::of_ticks(path, &renamed)?, POSITION)
    }
}

/// A pair of columns without a gap.
fn whole(log: &LogFile, names: [&str; 2]) -> Result<Vec<[f64; 2]>, LogError> {
    let all = log.pair(POSITION[0], names)?;
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
