//! Onset: the lowest radial impact that ends in whirl.

use super::{linear_impact, linear_of, matched_at_impact, with_law};
use crate::paper::rotors::OnsetRig;
use crate::paper::{Extent, Kind, PaperError, Row, Table};
use plant_model::analysis::impact::{
    Criterion, Impact, Outcome, Search, critical_speed_m_s, run_impact,
};
use plant_model::contact::hunt_crossley::damping_for_restitution;
use plant_model::params::{HuntCrossley, PlantParams};
use rayon::prelude::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};

/// Restitution of the linear contact; near what the chapter on onset fits.
const RESTITUTION: f64 = 0.7;

/// One configuration: name, damping ratio, inclination \[rad\], measured \[m/s\].
type Configuration = (&'static str, f64, f64, f64);
const CONFIGURATIONS: [Configuration; 4] = [
    ("solid disc, 0.3 %", 0.003, 0.0, 0.093),
    ("inclined 30°", 0.003, std::f64::consts::FRAC_PI_6, 0.064),
    ("solid disc, 3.5 %", 0.035, 0.0, 0.137),
    (
        "inclined 50°",
        0.003,
        50.0 / 180.0 * std::f64::consts::PI,
        0.056,
    ),
];

/// The critical speeds of a configuration \[m/s\] by both laws, and the restitution of the nonlinear one
/// at its own.
struct Critical {
    linear_m_s: f64,
    hardening_m_s: f64,
    restitution: f64,
}

/// The solid disc with the restitution of this chapter.
pub(super) fn rig(damping_ratio: f64) -> Result<PlantParams, PaperError> {
    OnsetRig {
        damping_ratio,
        ..OnsetRig::solid_disc(RESTITUTION)
    }
    .params()
}

fn critical_m_s(params: &PlantParams, inclination_rad: f64) -> Result<f64, PaperError> {
    let search = Search::default();
    let at = (inclination_rad, OnsetRig::SPIN_RAD_S);
    critical_speed_m_s(params, at, &search, &Criterion::default())?
        .ok_or_else(|| PaperError::Missing("no impact speed that ends in whirl".to_owned()))
}

fn critical((_, ratio, inclination, _): &Configuration) -> Result<Critical, PaperError> {
    let params = rig(*ratio)?;
    let linear_m_s = critical_m_s(&params, *inclination)?;
    // What meets the wall is the radial part.
    let law = matched_at_impact(&params, linear_m_s * inclination.cos())?;
    let hardening_m_s = critical_m_s(&with_law(&params, law), *inclination)?;
    Ok(Critical {
        linear_m_s,
        hardening_m_s,
        restitution: law.restitution(hardening_m_s * inclination.cos()),
    })
}

/// The law whose v_r,crit is the measured one for the first configuration: its restitution at that speed,
/// and what it predicts for another configuration.
struct Fit {
    restitution: f64,
    law: HuntCrossley,
}

/// Fits λ on the first configuration by bisection of the restitution at the measured speed, k_h kept.
fn fit() -> Result<Fit, PaperError> {
    let (_, ratio, inclination, measured_m_s) = CONFIGURATIONS[0];
    let params = rig(ratio)?;
    let base = matched_at_impact(&params, measured_m_s)?;
    let law_of = |e: f64| {
        damping_for_restitution(e, measured_m_s)
            .map(|damping_s_m| HuntCrossley {
                damping_s_m,
                ..base
            })
            .ok_or_else(|| PaperError::Missing(format!("no restitution: {e}")))
    };
    // v_r,crit falls with e; whirl at the measured speed says that it lies below.
    let (mut low, mut high) = (0.02, RESTITUTION);
    let impact = Impact {
        speed_m_s: measured_m_s,
        inclination_rad: inclination,
        spin_rad_s: OnsetRig::SPIN_RAD_S,
        spin_phase_rad: 0.0,
    };
    while high - low > 1e-3 * high {
        let middle = 0.5 * (low + high);
        let tried = with_law(&params, law_of(middle)?);
        if run_impact(&tried, &impact, &Criterion::default())?.outcome == Outcome::Whirl {
            high = middle;
        } else {
            low = middle;
        }
    }
    let restitution = 0.5 * (low + high);
    Ok(Fit {
        restitution,
        law: law_of(restitution)?,
    })
}

fn fitted_rows(used: &[Configuration]) -> Result<Vec<Row>, PaperError> {
    let fit = fit()?;
    (used.par_iter().enumerate())
        .map(|(i, (name, ratio, inclination, measured))| {
            let params = with_law(&rig(*ratio)?, fit.law);
            let found = critical_m_s(&params, *inclination)?;
            let kind = if i == 0 {
                Kind::Fitted
            } else {
                Kind::Predicted
            };
            Ok(Row::new(
                (format!("v_r,crit, {name}, Hunt and Crossley fitted"), "m/s"),
                "Results, onset phase; Fig. 3",
                (Some(*measured), Some(found)),
                kind,
                format!(
                    "λ = {:.2} s/m chosen for the first configuration: e = {:.3} at {} m/s",
                    fit.law.damping_s_m, fit.restitution, CONFIGURATIONS[0].3
                ),
            ))
        })
        .collect()
}

/// Rows and table of the critical speeds.
pub(super) fn compare(extent: Extent) -> Result<(Vec<Row>, Table), PaperError> {
    let number = if extent == Extent::Quick { 2 } else { 4 };
    let used = &CONFIGURATIONS[..number];
    let all = (used.par_iter())
        .map(critical)
        .collect::<Result<Vec<_>, _>>()?;
    let pairs = || used.iter().zip(&all);
    let mut rows: Vec<Row> = pairs()
        .map(|((name, _, _, measured), c)| {
            Row::new(
                (format!("v_r,crit, {name}, Hunt and Crossley"), "m/s"),
                "Results, onset phase; Fig. 3",
                (Some(*measured), Some(c.hardening_m_s)),
                Kind::Assumed,
                format!(
                    "e = {RESTITUTION} and depth as the linear law at its own v_r,crit, {:.4} m/s; {:+.1} % from it",
                    c.linear_m_s,
                    100.0 * (c.hardening_m_s / c.linear_m_s - 1.0)
                ),
            )
        })
        .collect();
    rows.extend(fitted_rows(used)?);
    let table = Table {
        caption: format!(
            "Lowest radial impact that ends in whirl; k_c = 1e8 N/m, linear e = {RESTITUTION}"
        ),
        columns: [
            "Configuration",
            "Linear [m/s]",
            "Hunt and Crossley [m/s]",
            "its e there",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: pairs()
            .map(|((name, ..), c)| {
                vec![
                    (*name).to_owned(),
                    format!("{:.4}", c.linear_m_s),
                    format!("{:.4}", c.hardening_m_s),
                    format!("{:.3}", c.restitution),
                ]
            })
            .collect(),
    };
    Ok((rows, table))
}

/// Restitution of the linear law of a plant.
pub(super) fn linear_restitution(params: &PlantParams) -> Result<f64, PaperError> {
    Ok(linear_impact(&linear_of(params)?, params.contact_mass_kg()).2)
}
