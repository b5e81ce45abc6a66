//! What is recorded of a run: a row at every control sample and at every change of mode.

use plant_model::{Mode, Snapshot, V2};

/// One row, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceRow {
    /// The plant as it was.
    pub plant: Snapshot,
    /// Position as the sensor last reported it \[m\].
    pub measured_m: V2,
    /// Force commanded by the policy, in effect at this instant \[N\].
    pub commanded_n: V2,
    /// Mode of the supervisor, where one runs.
    pub supervisor_mode: Option<supervisor::Mode>,
    /// Whether the row stands at a change of mode between two samples.
    pub mode_change: bool,
}

/// A run, in time order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// The rows.
    pub rows: Vec<TraceRow>,
}

impl Trace {
    /// Stretches of one plant mode: (mode, from \[s\], to \[s\]).
    pub fn mode_bands(&self) -> Vec<(Mode, f64, f64)> {
        let mut bands: Vec<(Mode, f64, f64)> = Vec::new();
        for row in &self.rows {
            let (mode, t) = (row.plant.mode, row.plant.t_s);
            match bands.last_mut() {
                Some(last) if last.0 == mode => last.2 = t,
                Some(last) => {
                    last.2 = t;
                    bands.push((mode, t, t));
                }
                None => bands.push((mode, t, t)),
            }
        }
        bands
    }
}
