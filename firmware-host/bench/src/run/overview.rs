//! The rows of a run that a report shows: all while they are few, and of a long run those that stand out.

use crate::run::trace::{AxisRow, Recorder, Trace, TraceRow};

/// So many rows are kept at most, some 0.3 KB each.
const MOST_ROWS: usize = 1 << 17;
/// Of so many rows in a row those are kept that stand out: at least three quarters go.
const BLOCK: usize = 128;

/// What rows stand out in: whatever a report draws over time or as an orbit.
const SHOWN: [fn(&TraceRow) -> f64; 8] = [
    |row| row.plant.position_m.x,
    |row| row.plant.position_m.y,
    |row| (row.plant.position_m - row.plant.inner_ring.position).norm(),
    |row| row.plant.normal_force_n,
    |row| row.plant.contact_tangential_speed_m_s,
    |row| row.plant.spin_rad_s,
    |row| row.plant.delivered_n.norm(),
    |row| row.commanded_n.norm(),
];

/// A run as far as a report needs it.
#[derive(Debug, Default)]
pub(crate) struct Overview {
    trace: Trace,
}

impl Overview {
    /// What is left of the run, in time order.
    pub(crate) fn into_trace(self) -> Trace {
        self.trace
    }

    fn thin(&mut self) {
        let rows = &mut self.trace.rows;
        let kept: Vec<TraceRow> = rows.chunks(BLOCK).flat_map(standing_out).collect();
        rows.clear();
        rows.extend(kept);
    }
}

impl Recorder for Overview {
    fn row(&mut self, row: &TraceRow) {
        if self.trace.rows.len() == MOST_ROWS {
            self.thin();
        }
        self.trace.rows.push(*row);
    }
}

/// The lowest and the highest of each quantity, and the first in each mode of rotor and supervisor.
fn standing_out(block: &[TraceRow]) -> impl Iterator<Item = TraceRow> {
    let mut stays = [false; BLOCK];
    for value in SHOWN {
        let values = || block.iter().map(value).enumerate();
        let by_value = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        for (i, _) in [values().min_by(by_value), values().max_by(by_value)]
            .into_iter()
            .flatten()
        {
            stays[i] = true;
        }
    }
    for (i, row) in block.iter().enumerate() {
        let (before, mode) = (&block[..i], row.supervisor_mode());
        stays[i] |= before.iter().all(|b| b.plant.mode != row.plant.mode)
            || before.iter().all(|b| b.supervisor_mode() != mode);
    }
    (block.iter().zip(stays)).filter_map(|(row, stays)| stays.then_some(*row))
}

/// The axis of a whole rotor as far as a report draws it: rows at equal times.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisTrack {
    /// In time order.
    pub rows: Vec<AxisRow>,
    /// Of so many samples one is kept.
    every: usize,
    samples: usize,
}

/// So many rows of an axis are kept at most.
const MOST_AXES: usize = 1 << 13;

impl Default for AxisTrack {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            every: 1,
            samples: 0,
        }
    }
}

impl Recorder<AxisRow> for AxisTrack {
    fn row(&mut self, row: &AxisRow) {
        if self.samples.is_multiple_of(self.every) {
            if self.rows.len() == MOST_AXES {
                let mut index = 0;
                self.rows.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.every *= 2;
            }
            if self.samples.is_multiple_of(self.every) {
                self.rows.push(row.clone());
            }
        }
        self.samples += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    /// 400,000 rows; one of them touches and another has a speed of its own.
    #[test]
    fn of_a_long_run_what_stands_out_is_kept_and_of_a_short_one_all() {
        let of = |rows: u32| {
            let mut overview = Overview::default();
            for i in 0..rows {
                let mut row = fixture::row(f64::from(i), i == 77_777);
                if i == 88_888 {
                    row.plant.contact_tangential_speed_m_s = -3.0;
                }
                overview.row(&row);
            }
            overview.into_trace().rows
        };
        assert_eq!(of(MOST_ROWS as u32).len(), MOST_ROWS);
        let long = of(400_000);
        assert!(long.len() <= MOST_ROWS);
        assert!(long.is_sorted_by(|a, b| a.plant.t_s < b.plant.t_s));
        let touching = long.iter().filter(|row| row.plant.mode.in_contact());
        assert_eq!(
            touching.map(|row| row.plant.t_s).collect::<Vec<_>>(),
            [77_777.0]
        );
        assert!(
            long.iter()
                .any(|row| row.plant.contact_tangential_speed_m_s == -3.0)
        );
        let ends = [long.first(), long.last()].map(|row| row.unwrap().plant.t_s);
        assert_eq!(ends, [0.0, 399_999.0]);
    }
}
