//! Tables over inertia and drag of the race.

use super::super::{Extent, PaperError, Row, Table};
use super::runs::{Run, most_whirl_m_s, race, run, sustained_hz, sustaining_drag_n_m_s};
use super::{IMPACT_M_S, LIGHT_KG_M2, Part, SPIN_HZ, Tried, driven, row};
use plant_model::analysis::impact::{Criterion, Search, critical_speed_m_s};
use plant_model::params::PlantParams;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::f64::consts::TAU;

fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |x| format!("{x:.digits$}"))
}

fn columns(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn named(inertia_kg_m2: Option<f64>) -> String {
    inertia_kg_m2.map_or_else(|| "bushing".to_owned(), |inertia| format!("{inertia:.0e}"))
}

/// Spin of the rotor when the whirl dies, or at the end of the run \[Hz\].
pub(super) fn spin_left(run: &Run) -> Option<f64> {
    let end_s = run.dies_s.unwrap_or(f64::INFINITY);
    run.course.at(end_s).map(|s| s.spin_hz)
}

/// The impact of footnote 4 against every race.
pub(super) fn inertias(all: &[Tried]) -> Table {
    let cells = |t: &Tried| {
        let (run, c) = (&t.run, t.params.contact.clearance_m);
        let end_s = run.dies_s.unwrap_or(f64::INFINITY);
        vec![
            named(t.inertia_kg_m2),
            format!("{:.0}", most_whirl_m_s(&t.params, SPIN_HZ) / c / TAU),
            or_dash(run.fastest_hz, 0),
            format!("{:.2}", 1e-3 * run.whirl_force_n),
            or_dash(run.slip_ends_s.map(|s| 1e3 * s), 2),
            run.dies_s
                .map_or_else(|| "not in 500".to_owned(), |s| format!("{:.0}", 1e3 * s)),
            or_dash(spin_left(run), 1),
            or_dash(run.course.at(end_s).map(|s| s.race_spin_hz), 1),
        ]
    };
    Table {
        caption:
            "Footnote 4 from 40 Hz, 0.4 m/s at the wall, no drive, no drag: one race after another"
                .to_owned(),
        columns: columns(&[
            "J_i [kg m²]",
            "Bound of the whirl [Hz]",
            "Fastest whirl [Hz]",
            "Force in whirl [kN]",
            "Sliding ends [ms]",
            "Whirl dies [ms]",
            "Rotor's spin then [Hz]",
            "Race's spin then [Hz]",
        ]),
        rows: all.iter().map(cells).collect(),
    }
}

/// Drag at held spin: which drag keeps the whirl alive.
pub(super) fn drags(extent: Extent) -> Result<Part, PaperError> {
    let least = sustaining_drag_n_m_s(&driven(LIGHT_KG_M2, 0.0), SPIN_HZ)
        .ok_or_else(|| PaperError::Missing("no threshold".to_owned()))?;
    let mut all = vec![0.0, 0.8 * least, 1.25 * least, 1e-2];
    if extent == Extent::Full {
        all.extend([2e-3, 5e-3, 2e-2, 5e-2]);
        all.sort_by(f64::total_cmp);
    }
    const END_S: f64 = 0.8;
    let runs = (all.par_iter())
        .map(|drag| {
            let params = driven(LIGHT_KG_M2, *drag);
            let run = run(&params, (IMPACT_M_S, SPIN_HZ), END_S)?;
            Ok((*drag, params, run))
        })
        .collect::<Result<Vec<_>, PaperError>>()?;
    let cells = |(drag, params, run): &(f64, PlantParams, Run)| {
        vec![
            format!("{drag:.2e}"),
            or_dash(run.fastest_hz, 0),
            format!("{:.2}", 1e-3 * run.whirl_force_n),
            run.dies_s
                .map_or_else(|| "lives on".to_owned(), |s| format!("{:.0}", 1e3 * s)),
            or_dash(run.last_hz, 1),
            or_dash(sustained_hz(params, SPIN_HZ), 1),
        ]
    };
    let table = Table {
        caption: "Race of 1e-3 kg m² with drag, spin held at 40 Hz, 0.4 m/s at the wall (a bushing whirls on at the stator's limit)".to_owned(),
        columns: columns(&[
            "b [N m s]",
            "Fastest whirl [Hz]",
            "Force in whirl [kN]",
            "Whirl dies [ms]",
            "Whirl after 0.8 s [Hz]",
            "closed form, rigid stator [Hz]",
        ]),
        rows: runs.iter().map(cells).collect(),
    };
    let bore = driven(LIGHT_KG_M2, 0.0).bore_radius_m();
    let torque = least * SPIN_HZ * TAU;
    let lasting = (runs.iter()).find(|(drag, ..)| *drag == 1e-2);
    let mut rows: Vec<Row> = vec![row(
        "Held spin: drag torque at 40 Hz above which rolling whirl lives on",
        "N m",
        Some(torque),
        format!(
            "closed form, b = {least:.2e} N m s; runs at 0.8 and 1.25 times that: table. Bore of {:.0} mm",
            2e3 * bore
        ),
    )];
    if let Some((_, params, run)) = lasting {
        rows.push(row(
            "Held spin, race of 1e-3 kg m² with b = 1e-2 N m s: whirl that lives on",
            "Hz",
            run.last_hz,
            format!(
                "closed form on a rigid stator {:.1} Hz; a bushing stays at the stator's limit",
                sustained_hz(params, SPIN_HZ).unwrap_or(f64::NAN)
            ),
        ));
    }
    Ok(Part { rows, table })
}

/// Critical impacts of the onset rig by race.
pub(super) struct Criticals(Vec<(Option<f64>, Option<f64>)>);

pub(super) fn critical_impacts(extent: Extent, rig: &PlantParams) -> Result<Criticals, PaperError> {
    let mut inertias = vec![None, Some(LIGHT_KG_M2), Some(4.2e-4)];
    if extent == Extent::Full {
        inertias.splice(1..1, [Some(1e-2), Some(3e-3)]);
        inertias.insert(4, Some(6e-4));
    }
    // The rows need no more: a race moves the result by more than that or not at all.
    let search = Search {
        step: 0.02,
        tolerance: 1e-4,
    };
    let found = (inertias.par_iter())
        .map(|inertia| {
            let mut params = *rig;
            params.race = inertia.and_then(|inertia| race(inertia, 0.0));
            let criterion = Criterion::default();
            let speed = critical_speed_m_s(&params, (0.0, SPIN_HZ * TAU), &search, &criterion)?;
            Ok((*inertia, speed))
        })
        .collect::<Result<Vec<_>, PaperError>>()?;
    Ok(Criticals(found))
}

impl Criticals {
    fn of(&self, inertia_kg_m2: Option<f64>) -> Option<f64> {
        let (_, speed) = self.0.iter().find(|(of, _)| *of == inertia_kg_m2)?;
        *speed
    }

    /// With a race \[m/s\].
    pub(super) fn at(&self, inertia_kg_m2: f64) -> Option<f64> {
        self.of(Some(inertia_kg_m2))
    }

    /// With a bushing \[m/s\].
    pub(super) fn bushing(&self) -> Option<f64> {
        self.of(None)
    }

    pub(super) fn table(&self) -> Table {
        Table {
            caption: "Onset rig at a held spin of 40 Hz: lowest radial impact that ends in whirl (–: none up to twice what one impact needs)".to_owned(),
            columns: columns(&["J_i [kg m²]", "Critical impact [m/s]"]),
            rows: (self.0.iter())
                .map(|(inertia, speed)| {
                    let name = inertia.map_or_else(|| named(None), |i| format!("{i:.1e}"));
                    vec![name, or_dash(*speed, 4)]
                })
                .collect(),
        }
    }
}
