//! Outcome with unbalance, where it is not monotone over the impact speed.

use super::linear;
use super::outcomes::{changes, figure, shade};
use crate::paper::rotors::OnsetRig;
use crate::paper::{Axis, Extent, Figure, Kind, PaperError, Row, Table};
use plant_model::analysis::impact::{Criterion, Impact, Outcome, run_impact};
use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use std::f64::consts::TAU;

/// What unbalance does.
pub(super) struct Fringe {
    pub(super) figures: Vec<Figure>,
    pub(super) row: Row,
    pub(super) table: Table,
}

/// Unbalance \[µm\] and spin \[Hz\] of each line of the table; those with a name are drawn.
const CASES: [(f64, f64, Option<&str>); 8] = [
    (0.0, 40.0, None),
    (2.0, 40.0, None),
    (5.0, 40.0, None),
    (10.0, 40.0, None),
    (20.0, 40.0, Some("maps_outcome_unbalance_40_hz")),
    (10.0, 20.0, None),
    (10.0, 100.0, Some("maps_outcome_unbalance_100_hz")),
    (2.0, 100.0, None),
];
const SPEEDS_M_S: (f64, f64) = (0.04, 0.14);

/// Outcomes over speed (columns) and phase of the unbalance (rows), and runs that stayed undecided.
fn outcomes(
    rig: &OnsetRig,
    spin_hz: f64,
    (columns, rows): (u32, u32),
) -> Result<(Vec<Vec<f64>>, usize), PaperError> {
    let params = rig.params()?;
    let runs: Vec<Vec<(f64, bool)>> = (0..rows)
        .into_par_iter()
        .map(|j| {
            (0..columns)
                .map(|i| {
                    let impact = Impact {
                        speed_m_s: linear(SPEEDS_M_S, (f64::from(i) + 0.5) / f64::from(columns)),
                        inclination_rad: 0.0,
                        spin_rad_s: TAU * spin_hz,
                        spin_phase_rad: TAU * (f64::from(j) + 0.5) / f64::from(rows),
                    };
                    let run = run_impact(&params, &impact, &Criterion::default())?;
                    Ok((shade(&run), run.outcome == Outcome::Undecided))
                })
                .collect()
        })
        .collect::<Result<_, PaperError>>()?;
    let undecided = runs.iter().flatten().filter(|(_, u)| *u).count();
    let cells = runs
        .into_iter()
        .map(|row| row.into_iter().map(|(value, _)| value).collect())
        .collect();
    Ok((cells, undecided))
}

pub(super) fn unbalanced(rig: &OnsetRig, extent: Extent) -> Result<Fringe, PaperError> {
    let grid = if extent == Extent::Full {
        (150, 72)
    } else {
        (50, 12)
    };
    let speed = |i: usize| linear(SPEEDS_M_S, (i as f64 + 0.5) / f64::from(grid.0));
    let (mut figures, mut lines, mut most) = (Vec::new(), Vec::new(), 0);
    for (unbalance_um, spin_hz, file) in CASES {
        let rig = OnsetRig {
            eccentricity_m: 1e-6 * unbalance_um,
            ..*rig
        };
        let (cells, undecided) = outcomes(&rig, spin_hz, grid)?;
        let whirls = |i: usize| cells.iter().map(move |row| !row[i].is_nan());
        let columns = grid.0 as usize;
        let first = (0..columns).find(|&i| whirls(i).any(|w| w));
        let always = (0..columns).rev().find(|&i| whirls(i).any(|w| !w));
        let changed = cells.iter().map(|row| changes(row)).max().unwrap_or(0);
        most = most.max(changed);
        let optional =
            |i: Option<usize>| i.map_or("–".to_owned(), |i| format!("{:.4}", speed(i)));
        lines.push(vec![
            format!("{unbalance_um}"),
            format!("{spin_hz}"),
            optional(first),
            optional(always),
            changed.to_string(),
            undecided.to_string(),
        ]);
        if let Some(file) = file {
            let caption = format!(
                "Outcome with an unbalance of {unbalance_um} µm at {spin_hz} Hz over impact speed and phase of \
                 the unbalance at the touch: whirl and no whirl alternate. Colour is the number of impacts \
                 until v_t,crit; white is no whirl within 3 s."
            );
            let phase = Axis {
                name: "phase of the unbalance [°]".to_owned(),
                range: (0.0, 360.0),
                log: false,
            };
            figures.push(figure(file, caption, (SPEEDS_M_S, phase), cells));
        }
    }
    let columns = [
        "Unbalance ε [µm]",
        "Spin [Hz]",
        "Lowest speed with whirl [m/s]",
        "Highest speed without [m/s]",
        "Changes over speed at one phase: most",
        "Undecided runs",
    ];
    Ok(Fringe {
        figures,
        row: Row::new(
            (
                "Changes of the outcome over impact speed, unbalanced: most",
                "",
            ),
            "Results, onset phase",
            (Some(1.0), Some(most as f64)),
            Kind::Assumed,
            "unbalance assumed, up to 20 µm; the paper leaves it out of its onset and reports a sharp limit",
        ),
        table: Table {
            caption: format!(
                "Outcome over {} impact speeds and {} phases of the unbalance, radial impact",
                grid.0, grid.1
            ),
            columns: columns.map(str::to_owned).to_vec(),
            rows: lines,
        },
    })
}
