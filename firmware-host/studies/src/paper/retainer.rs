//! Chapter: retainer bearing. The same impact against a bushing and against ball bearings whose race
//! spins up.

mod figures;
mod runs;
mod tables;

use self::runs::{Run, lightest_that_whirls, most_whirl_m_s, race, run};
use super::rotors::OnsetRig;
use super::whirl_runs::footnote_4;
use super::{Chapter, Extent, Kind, PaperError, Row};
use plant_model::analysis::onset::critical_tangential_speed_m_s;
use plant_model::params::{PlantParams, SpinParams};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::f64::consts::TAU;

/// Contact stiffness of footnote 4 \[N/m\].
const STIFFNESS_N_M: f64 = 1e9;
/// Spin at the start \[Hz\].
const SPIN_HZ: f64 = 40.0;
/// Radial speed at the wall \[m/s\].
const IMPACT_M_S: f64 = 0.4;
/// Radial speed against the onset rig, about twice its critical one \[m/s\].
const ONSET_IMPACT_M_S: f64 = 0.2;
/// Restitution of the onset rig.
const RESTITUTION: f64 = 0.7;
/// Contact stiffness that stands for a rigid wall \[N/m\].
const HARD_N_M: f64 = 1e11;
/// Races from heavy to light \[kg m²\]; the first of a quick run are those of the rows.
const INERTIAS_KG_M2: [f64; 9] = [1e-1, 1e-2, 3e-3, 1e-3, 3e-4, 3e-2, 6e-3, 2e-3, 1e-4];
/// Race of the rows and of the table of drags \[kg m²\].
const LIGHT_KG_M2: f64 = 1e-3;

/// Footnote 4 against a race, or a bushing.
fn rotor(inertia_kg_m2: Option<f64>) -> PlantParams {
    PlantParams {
        race: inertia_kg_m2.and_then(|inertia| race(inertia, 0.0)),
        ..footnote_4(STIFFNESS_N_M)
    }
}

/// One retainer bearing, run.
struct Tried {
    /// `None` for a bushing.
    inertia_kg_m2: Option<f64>,
    params: PlantParams,
    run: Run,
}

fn tried(extent: Extent) -> Result<Vec<Tried>, PaperError> {
    let number = if extent == Extent::Quick { 5 } else { 9 };
    let mut inertias = INERTIAS_KG_M2[..number].to_vec();
    inertias.sort_by(|a, b| b.total_cmp(a));
    let mut all = vec![None];
    all.extend(inertias.into_iter().map(Some));
    (all.par_iter())
        .map(|inertia_kg_m2| {
            let params = rotor(*inertia_kg_m2);
            Ok(Tried {
                inertia_kg_m2: *inertia_kg_m2,
                params,
                run: run(&params, (IMPACT_M_S, SPIN_HZ), 0.5)?,
            })
        })
        .collect()
}

/// The onset rig, spin held.
fn onset_rig() -> Result<PlantParams, PaperError> {
    OnsetRig::solid_disc(RESTITUTION).params()
}

/// Computes the chapter. Both extents give the same rows; a quick run has fewer races.
pub(super) fn chapter(extent: Extent) -> Result<Chapter, PaperError> {
    let (all, (drags, (onset, free))) = rayon::join(
        || tried(extent),
        || {
            rayon::join(
                || tables::drags(extent),
                || rayon::join(|| onset(extent), without_shaft),
            )
        },
    );
    let (all, drags, onset, free) = (all?, drags?, onset?, free?);
    let mut rows = whirl_rows(&all)?;
    rows.extend(onset.rows);
    rows.extend(free);
    rows.extend(drags.rows);
    Ok(Chapter {
        title: "Retainer bearing",
        story: story(),
        rows,
        tables: vec![tables::inertias(&all), drags.table, onset.table],
        figures: figures::all(&all),
    })
}

fn story() -> Vec<String> {
    vec![
        "The paper recommends ball bearings as retainer bearings, to lower the friction between rotor and stator, and gives no number. Here the ring's surface is a race with an inertia J_i and a viscous drag b: J_i·dΩ_i/dt = −R_i·s − b·Ω_i. Rotor and stator of footnote 4 with k_c = 1e9 N/m, J_r = 0.05 kg m², R_r = 0.1 m; start at the wall with 0.4 m/s outwards, 40 Hz, no drive; race at rest. Constants of races are assumed; balls, cage, preload and load-dependent friction are not modelled.".to_owned(),
        "What it does: friction takes slip away from the race's side, and what has turned the race cannot drive the whirl. An impulse I gives κ·I/m to the whirl (κ = 1 − μ_r/μ) and takes I·(R²/J_r + R_i²/J_i + κ/m) off the slip, so sliding takes the whirl to v = κ·ΩR/(κ + m·(R²/J_r + R_i²/J_i)) at most, whatever the impact. Then the rotor rolls on the race, friction holds only what the drag asks for, and rolling friction and shaft damping end the whirl.".to_owned(),
        "What it does not: a race hardly raises the impact that starts a whirl, unless it is so light that this bound lies near v_t,crit; a race as heavy as the rotor lets the whirl come near the stator's limit, as a bushing does; without shaft stiffness nothing lifts the rotor off and it rolls on; and with a drive that holds the spin, a drag above the torque that μ·N gives at v_t,crit keeps a rolling whirl alive for good.".to_owned(),
    ]
}

fn of_race(all: &[Tried], inertia_kg_m2: Option<f64>) -> Result<&Tried, PaperError> {
    (all.iter().find(|t| t.inertia_kg_m2 == inertia_kg_m2))
        .ok_or_else(|| PaperError::Missing(format!("no race of {inertia_kg_m2:?} kg m²")))
}

const SOURCE: &str = "Conclusions and recommendations";

fn row(what: &str, unit: &'static str, computed: Option<f64>, note: impl Into<String>) -> Row {
    Row::new((what, unit), SOURCE, (None, computed), Kind::Assumed, note)
}

fn whirl_rows(all: &[Tried]) -> Result<Vec<Row>, PaperError> {
    let bushing = of_race(all, None)?;
    let (heavy, middle) = (of_race(all, Some(1e-1))?, of_race(all, Some(1e-2))?);
    let light = of_race(all, Some(LIGHT_KG_M2))?;
    let ms = |s: Option<f64>| s.map(|s| 1e3 * s);
    let ratio = |of: &Tried, what: fn(&Run) -> Option<f64>| {
        what(&of.run)
            .zip(what(&bushing.run))
            .map(|(race, bushing)| race / bushing)
    };
    let fastest = |run: &Run| run.fastest_hz;
    let force = |run: &Run| Some(run.whirl_force_n);
    let bound_hz = |of: &Tried| {
        let c = of.params.contact.clearance_m;
        most_whirl_m_s(&of.params, SPIN_HZ) / c / TAU
    };
    Ok(vec![
        row(
            "Fastest whirl in a bushing",
            "Hz",
            bushing.run.fastest_hz,
            "the stator's limit",
        ),
        row(
            "Race of 1e-3 kg m² over bushing: fastest whirl",
            "",
            ratio(light, fastest),
            "paper: ball bearings seem a good way; no number",
        ),
        row(
            "Race of 1e-3 kg m² over bushing: largest normal force in whirl",
            "",
            ratio(light, force),
            "the impact itself is the same",
        ),
        row(
            "Race of 1e-3 kg m²: fastest whirl over the bound κ·ΩR/(κ + m·(R²/J_r + R_i²/J_i))",
            "",
            light.run.fastest_hz.map(|hz| hz / bound_hz(light)),
            format!(
                "bound {:.0} Hz; shaft, damping and the motion of the stator are left out of it",
                bound_hz(light)
            ),
        ),
        row(
            "Race of 1e-2 kg m² over bushing: fastest whirl",
            "",
            ratio(middle, fastest),
            format!(
                "the bound, {:.0} Hz, is above the stator's limit; slip ends before the whirl gets there",
                bound_hz(middle)
            ),
        ),
        row(
            "Race of 1e-2 kg m² over bushing: largest normal force in whirl",
            "",
            ratio(middle, force),
            "",
        ),
        row(
            "Race of 1e-1 kg m² over bushing: fastest whirl",
            "",
            ratio(heavy, fastest),
            "twice the rotor's inertia: hardly helps",
        ),
        row(
            "Bushing: until the rotor lifts off for good",
            "ms",
            ms(bushing.run.dies_s),
            "the whirl takes the whole spin of a rotor without drive",
        ),
        row(
            "Race of 1e-3 kg m²: until sliding ends",
            "ms",
            ms(light.run.slip_ends_s),
            "",
        ),
        row(
            "Race of 1e-3 kg m²: until the whirl dies",
            "ms",
            ms(light.run.dies_s),
            "rolling, braked by μ_r and shaft damping, at a fraction of the force",
        ),
        row(
            "Race of 1e-3 kg m²: spin left to the rotor when the whirl dies",
            "%",
            tables::spin_left(&light.run).map(|hz| 100.0 * hz / SPIN_HZ),
            format!(
                "bushing: {:.0} %",
                tables::spin_left(&bushing.run).map_or(f64::NAN, |hz| 100.0 * hz / SPIN_HZ)
            ),
        ),
    ])
}

/// Rows with a table of their own.
struct Part {
    rows: Vec<Row>,
    table: super::Table,
}

/// Whether a race keeps whirl from starting: the onset rig at held spin.
fn onset(extent: Extent) -> Result<Part, PaperError> {
    let rig = onset_rig()?;
    let threshold = critical_tangential_speed_m_s(&rig)
        .ok_or_else(|| PaperError::Missing("no threshold".to_owned()))?;
    let mut hard = OnsetRig::solid_disc(RESTITUTION);
    hard.contact_stiffness_n_m = HARD_N_M;
    let hard = hard.params()?;
    let (criticals, (lightest, lightest_hard)) = rayon::join(
        || tables::critical_impacts(extent, &rig),
        || {
            rayon::join(
                || lightest_that_whirls(&rig, (ONSET_IMPACT_M_S, SPIN_HZ)),
                || lightest_that_whirls(&hard, (ONSET_IMPACT_M_S, SPIN_HZ)),
            )
        },
    );
    let (criticals, lightest, lightest_hard) = (criticals?, lightest?, lightest_hard?);
    let closed = runs::inertia_for(&rig, SPIN_HZ, 2.0 * threshold);
    let ratio = criticals.at(LIGHT_KG_M2).zip(criticals.bushing());
    Ok(Part {
        rows: vec![
            row(
                "Onset rig: lightest race that whirls after 0.2 m/s",
                "kg m²",
                Some(lightest),
                format!(
                    "held spin of 40 Hz, twice v_t,crit; the bound gives {:.2e} kg m². The contact is soft: friction acts further out than c",
                    closed.unwrap_or(f64::NAN)
                ),
            ),
            row(
                "The same with k_c = 1e11 N/m",
                "kg m²",
                Some(lightest_hard),
                format!(
                    "{:+.1} % from the bound",
                    100.0 * (lightest_hard / closed.unwrap_or(f64::NAN) - 1.0)
                ),
            ),
            row(
                "Onset rig, race of 1e-3 kg m² over bushing: critical radial impact",
                "",
                ratio.map(|(race, bushing)| race / bushing),
                "friction is the same as long as it slips: a race that is not very light does not keep whirl from starting",
            ),
        ],
        table: criticals.table(),
    })
}

/// Without shaft stiffness nothing lifts the rotor off: 1/v grows by μ_r·t/c.
fn without_shaft() -> Result<Vec<Row>, PaperError> {
    const END_S: f64 = 0.5;
    let of = |inertia_kg_m2: Option<f64>| {
        let mut params = rotor(inertia_kg_m2);
        params.rotor.stiffness_n_m = 0.0;
        run(&params, (IMPACT_M_S, SPIN_HZ), END_S)
    };
    let light = of(Some(LIGHT_KG_M2))?;
    let fastest = light.fastest_hz;
    Ok(vec![
        row(
            "No shaft stiffness, race of 1e-3 kg m²: fastest whirl",
            "Hz",
            fastest,
            "as with a shaft: the bound does not know it",
        ),
        row(
            "No shaft stiffness, race of 1e-3 kg m²: whirl left after 0.5 s",
            "Hz",
            light.last_hz,
            "not over: rolling friction brakes as 1/t only, and nothing lifts the rotor off",
        ),
    ])
}

/// The rotor of footnote 4 with its spin held.
fn driven(inertia_kg_m2: f64, drag_n_m_s: f64) -> PlantParams {
    PlantParams {
        spin: SpinParams::Held,
        race: race(inertia_kg_m2, drag_n_m_s),
        ..footnote_4(STIFFNESS_N_M)
    }
}
