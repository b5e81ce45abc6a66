//! Outcome over impact speed and one more parameter, for the balanced rotor.

use super::{FRICTION, INCLINATION, Varied, axis, linear};
use crate::paper::rotors::OnsetRig;
use crate::paper::{Axis, Drawing, Extent, Figure, HeatMap, Kind, PaperError, Row};
use plant_model::analysis::impact::{Criterion, Impact, ImpactOutcome, Outcome, run_impact};
use rayon::prelude::{IntoParallelIterator, ParallelIterator};

/// Impacts shown with the darkest colour.
const MOST_IMPACTS: f64 = 10.0;

/// Number of impacts until v_t,crit for whirl; not a number otherwise.
pub(super) fn shade(run: &ImpactOutcome) -> f64 {
    match run.outcome {
        Outcome::Whirl => run.impacts_to_threshold.map_or(f64::NAN, f64::from),
        Outcome::Free | Outcome::Undecided => f64::NAN,
    }
}

/// How often the outcome changes between whirl and not whirl along a row.
pub(super) fn changes(row: &[f64]) -> usize {
    row.windows(2)
        .filter(|pair| pair[0].is_nan() != pair[1].is_nan())
        .count()
}

/// A map of outcomes over the impact speed.
pub(super) fn figure(
    file: &'static str,
    caption: String,
    (speed_m_s, y): ((f64, f64), Axis),
    cells: Vec<Vec<f64>>,
) -> Figure {
    Figure {
        file,
        drawing: Drawing::Map(HeatMap {
            label: caption.clone(),
            x: Axis {
                name: "impact speed [m/s]".to_owned(),
                range: speed_m_s,
                log: false,
            },
            y,
            names: Default::default(),
            cells,
            scale: (
                1.0,
                MOST_IMPACTS,
                "impacts until whirl (10: or more; white: no whirl)".to_owned(),
            ),
        }),
        caption,
    }
}

/// The maps, and the row that says how often the outcome changes over the speed.
pub(super) fn balanced(rig: &OnsetRig, extent: Extent) -> Result<([Figure; 2], Row), PaperError> {
    let (columns, rows) = if extent == Extent::Full {
        (150, 90)
    } else {
        (50, 24)
    };
    let mut most = 0;
    let mut draw = |file, varied: Varied, speeds: (f64, f64)| -> Result<Figure, PaperError> {
        let cells: Vec<Vec<f64>> = (0..rows)
            .into_par_iter()
            .map(|j| {
                let (mut rig, mut inclination_rad) = (*rig, 0.0);
                let value = linear(varied.range, (f64::from(j) + 0.5) / f64::from(rows));
                (varied.set)(&mut rig, &mut inclination_rad, value);
                let params = rig.params()?;
                (0..columns)
                    .map(|i| {
                        let impact = Impact {
                            speed_m_s: linear(speeds, (f64::from(i) + 0.5) / f64::from(columns)),
                            inclination_rad,
                            spin_rad_s: OnsetRig::SPIN_RAD_S,
                            spin_phase_rad: 0.0,
                        };
                        Ok(shade(&run_impact(&params, &impact, &Criterion::default())?))
                    })
                    .collect()
            })
            .collect::<Result<_, PaperError>>()?;
        most = most.max(cells.iter().map(|row| changes(row)).max().unwrap_or(0));
        let caption = format!(
            "Outcome over impact speed and {}: colour is whirl and the impacts until v_t,crit, white is no whirl.",
            varied.name
        );
        Ok(figure(file, caption, (speeds, axis(&varied)), cells))
    };
    let figures = [
        draw("maps_outcome_inclination", INCLINATION, (0.02, 0.25))?,
        draw("maps_outcome_friction", FRICTION, (0.02, 0.3))?,
    ];
    let row = Row::new(
        (
            "Changes of the outcome over impact speed, balanced: most",
            "",
        ),
        "Results, onset phase",
        (Some(1.0), Some(most as f64)),
        Kind::Predicted,
        "both maps of outcomes; the paper: unambiguous and reproducible",
    );
    Ok((figures, row))
}
