//! Established whirl: spin-down by both laws, and held spin against Black's limit.

use super::{matched_at_force, matched_at_impact, with_law};
use crate::paper::established::rig::{IMPACT_M_S, Violence, violence};
use crate::paper::whirl_runs::{Settled, footnote_4, settled};
use crate::paper::{Extent, Kind, PaperError, Row, Table};
use plant_model::analysis::black::{Circle, SteadyWhirl};
use plant_model::params::{HuntCrossley, PlantParams};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};

/// Spin of the runs at held spin \[Hz\].
const HELD_SPIN_HZ: f64 = 166.0;
/// Upper end of the search \[Hz\].
const HIGHEST_HZ: f64 = 5000.0;
/// Contact stiffness of the linear law \[N/m\], and one with which it has no upper limit.
const STIFFNESS_N_M: f64 = 1e9;
const SOFT_N_M: f64 = 3e8;

/// Normal force \[N\] of a steady whirl whose force is `hard` without deformation: with R = c/N_hard the
/// distance per force, N·R = c + (N/k_h)^(1/n). Its left side overtakes the right one once, for n > 1
/// whatever k_h.
fn steady_force_n(hard: &Circle, clearance_m: f64, law: &HuntCrossley) -> f64 {
    let per_force = clearance_m / hard.normal_force_n;
    let short =
        |n: f64| n * per_force < clearance_m + (n / law.stiffness_n_mn).powf(1.0 / law.exponent);
    let mut high = hard.normal_force_n;
    while short(high) && high.is_finite() {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if short(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

fn held(params: &PlantParams) -> Result<Settled, PaperError> {
    settled(params, HELD_SPIN_HZ, 700.0, 0.3)
}

/// Rows and tables.
pub(super) fn compare(extent: Extent) -> Result<(Vec<Row>, Vec<Table>), PaperError> {
    let missing = |what: &str| PaperError::Missing(what.to_owned());
    let linear = footnote_4(STIFFNESS_N_M);
    let mut black =
        SteadyWhirl::from_params(&linear).ok_or_else(|| missing("no isotropic stator"))?;
    black.normal_compliance_m_n = 0.0;
    let limit = (black.upper_limit(HIGHEST_HZ)).ok_or_else(|| missing("no upper limit"))?;
    let steady = held(&linear)?;
    let at_impact = matched_at_impact(&linear, IMPACT_M_S)?;
    let at_force = matched_at_force(&linear, steady.normal_force_n)?;
    let soft = footnote_4(SOFT_N_M);
    let soft_law = matched_at_impact(&soft, IMPACT_M_S)?;
    let clearance_m = linear.contact.clearance_m;

    let laws = [
        ("linear, k_c = 1e9 N/m", linear, None),
        (
            "matched at the impact",
            with_law(&linear, at_impact),
            Some(at_impact),
        ),
        (
            "matched at the plateau",
            with_law(&linear, at_force),
            Some(at_force),
        ),
    ];
    let spins_hz: &[f64] = match extent {
        Extent::Quick => &[40.0, 166.0],
        Extent::Full => &[40.0, 80.0, 166.0],
    };
    let tasks: Vec<_> = (laws.iter())
        .flat_map(|(name, params, _)| spins_hz.iter().map(move |hz| (*name, params, *hz)))
        .collect();
    let downs = (tasks.par_iter())
        .map(|(name, params, hz)| Ok((*name, violence(params, *hz, 0.4)?)))
        .collect::<Result<Vec<(&str, Violence)>, PaperError>>()?;
    let circles: Vec<(&str, PlantParams, Option<HuntCrossley>)> = (laws.into_iter())
        .chain([
            ("linear, k_c = 3e8 N/m", soft, None),
            (
                "matched to it at the impact",
                with_law(&soft, soft_law),
                Some(soft_law),
            ),
        ])
        .collect();
    let ends = (circles.par_iter())
        .map(|(name, params, law)| {
            let force_n = law.map(|law| steady_force_n(&limit, clearance_m, &law));
            Ok((*name, held(params)?, force_n))
        })
        .collect::<Result<Vec<(&str, Settled, Option<f64>)>, PaperError>>()?;

    let find = |law: usize, hz: f64| {
        (downs.iter())
            .find(|(name, v)| *name == circles[law].0 && v.spin_hz == hz)
            .map(|(_, v)| *v)
            .ok_or_else(|| missing("no spin-down"))
    };
    let (plain, slow, fast) = (find(0, 166.0)?, find(1, 40.0)?, find(1, 166.0)?);
    let plain_slow = find(0, 40.0)?;
    let assumed = |what: &str, unit, source, (paper, computed), note: String| {
        Row::new(
            (what, unit),
            source,
            (paper, Some(computed)),
            Kind::Assumed,
            note,
        )
    };
    let end = &ends[1].1;
    let rows = vec![
        Row::new(
            ("Whirl at held spin, Hunt and Crossley", "Hz"),
            "Results, on Black's theory",
            (None, Some(end.whirl_hz)),
            Kind::Predicted,
            format!(
                "matched at the impact; Black's limit {:.1} Hz, in which only f_n matters; linear {:.1} Hz",
                limit.frequency_hz(),
                ends[0].1.whirl_hz
            ),
        ),
        Row::new(
            ("Its normal force", "kN"),
            "Results, on Black's theory",
            (None, Some(1e-3 * end.normal_force_n)),
            Kind::Predicted,
            format!(
                "closed form {:.3} kN; linear {:.3} kN. Matched at the impact the contact gives way less under such a force",
                1e-3 * ends[1].2.unwrap_or(f64::NAN),
                1e-3 * ends[0].1.normal_force_n
            ),
        ),
        assumed(
            "Plateau: fastest whirl from 166 Hz, Hunt and Crossley",
            "Hz",
            "figure 7, simulation",
            (Some(660.0), fast.whirl_hz),
            format!(
                "matched at the impact of {IMPACT_M_S} m/s; linear {:.1} Hz",
                plain.whirl_hz
            ),
        ),
        assumed(
            "Fastest whirl from 40 Hz, Hunt and Crossley",
            "Hz",
            "Results, test at 40 Hz",
            (Some(530.0), slow.whirl_hz),
            format!("the same; linear {:.1} Hz", plain_slow.whirl_hz),
        ),
        assumed(
            "Outer ring from 166 Hz, Hunt and Crossley",
            "mm",
            "Results, test at 40 Hz",
            (Some(0.05), 1e3 * fast.displacement_m[2]),
            format!("linear {:.4} mm", 1e3 * plain.displacement_m[2]),
        ),
        assumed(
            "Peak force from 166 Hz, Hunt and Crossley",
            "kN",
            "footnote 2",
            (None, 1e-3 * fast.force_n),
            format!("linear {:.1} kN", 1e-3 * plain.force_n),
        ),
    ];
    Ok((
        rows,
        vec![spin_down(&downs), held_spin(&ends, limit.frequency_hz())],
    ))
}

fn spin_down(downs: &[(&str, Violence)]) -> Table {
    Table {
        caption: "Spin-down of footnote 4 from 0.4 m/s by contact law (Hertz's exponent, λ matched as well)".to_owned(),
        columns: [
            "Law",
            "From [Hz]",
            "Fastest whirl [Hz]",
            "Peak force [kN]",
            "Outer ring [mm]",
            "Standstill [ms]",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: (downs.iter())
            .map(|(name, v)| {
                vec![
                    (*name).to_owned(),
                    format!("{:.0}", v.spin_hz),
                    format!("{:.1}", v.whirl_hz),
                    format!("{:.1}", 1e-3 * v.force_n),
                    format!("{:.4}", 1e3 * v.displacement_m[2]),
                    format!("{:.2}", 1e3 * v.standstill_s),
                ]
            })
            .collect(),
    }
}

fn held_spin(ends: &[(&str, Settled, Option<f64>)], limit_hz: f64) -> Table {
    Table {
        caption: format!(
            "Whirl at a held spin of {HELD_SPIN_HZ} Hz after 0.3 s; Black's limit {limit_hz:.2} Hz"
        ),
        columns: ["Law", "Whirl [Hz]", "", "N [kN]", "N closed form [kN]"]
            .map(str::to_owned)
            .to_vec(),
        rows: (ends.iter())
            .map(|(name, end, force_n)| {
                vec![
                    (*name).to_owned(),
                    format!("{:.2}", end.whirl_hz),
                    if end.rolls { "rolls" } else { "slides" }.to_owned(),
                    format!("{:.2}", 1e-3 * end.normal_force_n),
                    force_n.map_or("–".to_owned(), |n| format!("{:.2}", 1e-3 * n)),
                ]
            })
            .collect(),
    }
}
