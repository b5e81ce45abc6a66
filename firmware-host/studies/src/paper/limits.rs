//! Chapter: limits of sliding whirl by Black's condition with friction, against runs.

mod tables;

use super::whirl_runs::{fastest_hz, footnote_4, settled};
use super::{
    Axis, Chapter, Chart, Curve, Drawing, Extent, Figure, Kind, Mark, PaperError, Row, Stated,
    Table,
};
use plant_model::analysis::black::SteadyWhirl;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::f64::consts::TAU;

/// Upper end of the search \[Hz\].
const HIGHEST_HZ: f64 = 5000.0;
/// Spin of the runs at held spin \[Hz\].
const HELD_SPIN_HZ: f64 = 166.0;
/// Contact stiffnesses \[N/m\].
const STIFFNESSES_N_M: [f64; 5] = [3e8, 5e8, 1e9, 1e10, 1e11];

fn whirl(contact_stiffness_n_m: f64) -> Result<SteadyWhirl, PaperError> {
    let params = footnote_4(contact_stiffness_n_m.min(1e12));
    let mut whirl = SteadyWhirl::from_params(&params)
        .ok_or_else(|| PaperError::Missing("the stator is not isotropic".to_owned()))?;
    whirl.normal_compliance_m_n = 1.0 / contact_stiffness_n_m;
    Ok(whirl)
}

/// The same contact, as soft along the tangent as along the normal.
fn soft_along_tangent(contact_stiffness_n_m: f64) -> Result<SteadyWhirl, PaperError> {
    let mut whirl = whirl(contact_stiffness_n_m)?;
    whirl.tangential_compliance_m_n = whirl.normal_compliance_m_n;
    Ok(whirl)
}

/// One contact stiffness, run.
#[derive(Debug, Clone, Copy)]
struct Runs {
    stiffness_n_m: f64,
    held: super::whirl_runs::Settled,
    /// Fastest whirl of a spin-down from 40 Hz and 166 Hz \[Hz\].
    fastest_hz: [f64; 2],
}

fn runs(stiffness_n_m: f64) -> Result<Runs, PaperError> {
    let params = footnote_4(stiffness_n_m);
    Ok(Runs {
        stiffness_n_m,
        held: settled(&params, HELD_SPIN_HZ, 700.0, 0.3)?,
        fastest_hz: [
            fastest_hz(&params, 40.0, 0.1)?,
            fastest_hz(&params, 166.0, 0.1)?,
        ],
    })
}

/// Computes the chapter. Both extents give the same numbers; the chart has fewer points in a quick run.
pub(super) fn chapter(extent: Extent) -> Result<Chapter, PaperError> {
    let missing = |what: &str| PaperError::Missing(what.to_owned());
    let hard = whirl(f64::INFINITY)?;
    let onset = hard.onset(HIGHEST_HZ).ok_or_else(|| missing("no onset"))?;
    let limit = (hard.upper_limit(HIGHEST_HZ)).ok_or_else(|| missing("no upper limit"))?;
    let all = (STIFFNESSES_N_M.par_iter())
        .map(|k| runs(*k))
        .collect::<Result<Vec<Runs>, PaperError>>()?;
    let at_1e9 = (all.iter().find(|r| r.stiffness_n_m == 1e9)).ok_or_else(|| missing("1e9"))?;
    let coupled = |k: f64| -> Result<Option<f64>, PaperError> {
        Ok(whirl(k)?.coupled_frequencies_hz().first().copied())
    };
    let limit_hz = limit.frequency_hz();
    let (least, least_hz) = (hard.least_friction(1.0, HIGHEST_HZ))
        .ok_or_else(|| missing("no whirl at any friction"))?;
    let rows = vec![
        Row::new(
            ("Upper whirl limit", "Hz"),
            "Results, simulation",
            (Some(660.0), Some(limit_hz)),
            Kind::Predicted,
            "nothing but footnote 4 in it: neither k_c nor d_c, J_r, R_r, spin. Above the paper's computed maximum; why, the paper does not let us see",
        ),
        Row::new(
            ("First coupled natural frequency, joined rigidly", "Hz"),
            "Footnote 5",
            (Some(660.0), coupled(f64::INFINITY)?),
            Kind::Predicted,
            "misses: with these constants the maximum is not this frequency; damping lets friction drive only to the limit below it",
        ),
        Row::new(
            (
                "First coupled natural frequency, joined by k_c = 1e9 N/m",
                "Hz",
            ),
            "Footnote 5",
            (Some(660.0), coupled(1e9)?),
            Kind::Assumed,
            "misses too",
        ),
        Row::new(
            ("Plateau: fastest whirl from 166 Hz", "Hz"),
            "Fig. 7, simulation",
            (Some(660.0), Some(at_1e9.fastest_hz[1])),
            Kind::Assumed,
            format!(
                "k_c = 1e9 N/m; {:+.2} % from the limit",
                100.0 * (at_1e9.fastest_hz[1] / limit_hz - 1.0)
            ),
        ),
        Row::new(
            ("Fastest whirl at 40 Hz", "Hz"),
            "Results, test at 40 Hz",
            (Some(530.0), Some(at_1e9.fastest_hz[0])),
            Kind::Assumed,
            "k_c = 1e9 N/m; measured. The spin is used up before the limit is reached",
        ),
        Row::new(
            ("Whirl frequency at which whirl begins", "Hz"),
            "Results, test at 40 Hz",
            (Some(55.0), Some(onset.frequency_hz())),
            Kind::Predicted,
            "the lowest root is a lower bound: friction drives above it",
        )
        .stated(Stated::AtMost(55.0)),
        Row::new(
            ("Least μ − μ_r that keeps any sliding whirl", ""),
            "Footnote 4",
            (None, Some(least)),
            Kind::Predicted,
            format!("at {least_hz:.0} Hz; footnote 4 has 0.125"),
        ),
        Row::new(
            ("Driving friction with which the limit is 400 Hz", ""),
            "Results, test at 166 Hz",
            (None, hard.friction_needed(400.0 * TAU)),
            Kind::Predicted,
            "what melting must leave of μ − μ_r for the measured 400 Hz",
        ),
    ];
    Ok(Chapter {
        title: "Black's limits with friction",
        story: vec![
            "Steady sliding whirl in a circle: rotor and ring answer the contact force with their receptances α_r and α_s, the force stands at atan(μ − μ_r) to the normal, and the distance of the centres is c + N/k_c along the normal. That leaves Im[(α_r + α_s)(1 + i(μ − μ_r))] = 0 with N > 0.".to_owned(),
            "The roots do not depend on k_c or d_c; k_c decides which of them have a positive force. The lowest root is the onset (unstable); the next, where friction turns from driving to braking, is the upper whirl limit. For a soft contact the limit needs a pull and is no solution: whirl at held spin then grows through a resonance until it rolls.".to_owned(),
            "Counting the contact spring to the stator, as Black's receptances invite to, makes the contact soft along the tangent as well, and lowers the limit with k_c. Equations (2.1) to (2.9) have no such compliance: their runs meet the limit without it, and against the other one they seem to overshoot.".to_owned(),
        ],
        rows,
        tables: vec![
            tables::roots()?,
            tables::held(&all)?,
            tables::spin_down(&all)?,
            tables::rolling(&hard),
            tables::existence()?,
        ],
        figures: vec![needed_friction(extent, &hard)?],
    })
}

fn needed_friction(extent: Extent, hard: &SteadyWhirl) -> Result<Figure, PaperError> {
    let points = if extent == Extent::Quick { 400 } else { 2000 };
    let (low, high) = (40.0_f64, HIGHEST_HZ);
    let curve = |whirl: &SteadyWhirl| -> Vec<(f64, f64)> {
        (0..=points)
            .map(|i| low * (high / low).powf(f64::from(i) / f64::from(points)))
            .map(|hz| {
                let needed = whirl.friction_needed(hz * TAU).unwrap_or(f64::NAN);
                let shown = (1e-3..=1.0).contains(&needed);
                (hz, if shown { needed } else { f64::NAN })
            })
            .collect()
    };
    let mut curves = vec![Curve {
        name: "k_c = ∞".to_owned(),
        points: curve(hard),
        mark: Mark::Line,
        colour: 0,
    }];
    for (colour, k) in [(1, 1e9), (2, 3e8)] {
        curves.push(Curve {
            name: format!("k_c = {k:e} N/m, where it exists"),
            points: curve(&whirl(k)?),
            mark: Mark::Line,
            colour,
        });
    }
    let mu = hard.driving_friction;
    curves.push(Curve {
        name: format!("μ − μ_r = {mu:.3}: drives where it is above the curve"),
        points: vec![(low, mu), (high, mu)],
        mark: Mark::Dashed,
        colour: 3,
    });
    curves.push(Curve {
        name: "roots".to_owned(),
        points: (hard.sliding(1.0, HIGHEST_HZ).iter())
            .map(|c| (c.frequency_hz(), mu))
            .collect(),
        mark: Mark::Dots,
        colour: 3,
    });
    Ok(Figure {
        file: "limits-friction-needed",
        caption: "Friction that sliding whirl at a frequency needs. The three curves lie on each other; a softer contact only ends earlier.".to_owned(),
        drawing: Drawing::Chart(Chart {
            label: "Friction needed over whirl frequency".to_owned(),
            x: Axis {
                name: "Whirl frequency [Hz]".to_owned(),
                range: (low, high),
                log: true,
            },
            y: Axis {
                name: "Driving friction needed".to_owned(),
                range: (1e-3, 1.0),
                log: true,
            },
            curves,
        }),
    })
}
