//! Whether a race keeps whirl from starting: the onset rig at held spin.

use super::runs::{inertia_for, with_race};
use super::{LIGHT_KG_M2, SOURCE};
use crate::paper::data::*;
use crate::paper::onset::{aim, impact};
use crate::paper::rotors::OnsetRig;
use plant_model::analysis::impact::{Criterion, Outcome, Search, critical_speed_m_s, run_impact};
use plant_model::analysis::onset::critical_tangential_speed_m_s;

/// Radial speed against the onset rig, about twice its critical one \[m/s\].
const IMPACT_M_S: f64 = 0.2;
/// Restitution of the onset rig.
const RESTITUTION: f64 = 0.7;
/// Contact stiffness that stands for a rigid wall \[N/m\].
const HARD_N_M: f64 = 1e11;

/// A race, or a bushing, with the lowest radial impact that ends in whirl \[m/s\].
struct Critical {
    inertia_kg_m2: Option<f64>,
    speed_m_s: Option<f64>,
}

/// Adds the rows and the table.
pub(super) fn add(chapter: &mut Chapter, extent: Extent) -> Result<()> {
    let rig = OnsetRig::solid_disc(RESTITUTION);
    let hard = rig.with(|rig| rig.contact_stiffness_n_m = HARD_N_M);
    let (rig, hard) = (rig.params()?, hard.params()?);
    let threshold_m_s = critical_tangential_speed_m_s(&rig).or_missing("no threshold")?;
    let closed = inertia_for(&rig, 2.0 * threshold_m_s).or_missing("no race for v_t,crit")?;
    let (criticals, lightest) = rayon::join(
        || criticals(extent, &rig),
        || each(&[rig, hard], lightest_that_whirls),
    );
    let (criticals, lightest) = (criticals?, lightest?);
    let critical_m_s = |inertia: Option<f64>| {
        let found = criticals.iter().find(|c| c.inertia_kg_m2 == inertia);
        found.and_then(|c| c.speed_m_s)
    };
    let ratio = (critical_m_s(Some(LIGHT_KG_M2)).zip(critical_m_s(None)))
        .map(|(race, bushing)| race / bushing);
    let hard = lightest[1];
    chapter.rows.extend(rows! {
        "Onset rig: lightest race that whirls after 0.2 m/s", "kg m²", SOURCE, Silent => lightest[0], Assumed,
            "held spin of 40 Hz, twice v_t,crit; the bound gives {closed:.2e} kg m². The contact is soft: friction acts further out than c";
        "The same with k_c = 1e11 N/m", "kg m²", SOURCE, Silent => hard, Assumed, "{:+.1} % from the bound", 100.0 * (hard / closed - 1.0);
        "Onset rig, race of 1e-3 kg m² over bushing: critical radial impact", "", SOURCE, Silent => ratio, Assumed,
            "friction is the same as long as it slips: a race that is not very light does not keep whirl from starting";
    });
    let named = |inertia: Option<f64>| inertia.map_or("bushing".to_owned(), |i| format!("{i:.1e}"));
    chapter.tables.push(table! {
        "Onset rig at a held spin of 40 Hz: lowest radial impact that ends in whirl (–: none up to twice what one impact needs)";
        for c in &criticals;
        "J_i [kg m²]" => "{}", named(c.inertia_kg_m2);
        "Critical impact [m/s]" => "{}", or_dash(c.speed_m_s, 4);
    });
    Ok(())
}

fn criticals(extent: Extent, rig: &PlantParams) -> Result<Vec<Critical>> {
    let inertias: &[f64] = match extent {
        Extent::Quick => &[LIGHT_KG_M2, 4.2e-4],
        Extent::Full => &[1e-2, 3e-3, LIGHT_KG_M2, 6e-4, 4.2e-4],
    };
    let races = inertias.iter().copied().map(Some);
    let all: Vec<Option<f64>> = [None].into_iter().chain(races).collect();
    // The rows need no more: a race moves the result by more than that or not at all.
    let search = Search {
        step: 0.02,
        tolerance: 1e-4,
    };
    each(&all, |inertia_kg_m2| {
        let params = with_race(rig, *inertia_kg_m2, 0.0);
        Ok(Critical {
            inertia_kg_m2: *inertia_kg_m2,
            speed_m_s: critical_speed_m_s(&params, aim(0.0), &search, &Criterion::default())?,
        })
    })
}

/// Lightest race \[kg m²\] with which the impact ends in twice v_t,crit, by bisection of runs.
fn lightest_that_whirls(rig: &PlantParams) -> Result<f64> {
    let whirls = |inertia_kg_m2: f64| -> Result<bool> {
        let params = with_race(rig, Some(inertia_kg_m2), 0.0);
        let after = run_impact(&params, &impact(IMPACT_M_S, 0.0), &Criterion::default())?;
        Ok(after.outcome == Outcome::Whirl)
    };
    let free = |logarithm: f64| Ok(!whirls(logarithm.exp())?);
    let ends = (1e-5_f64.ln(), 1e-1_f64.ln());
    if !free(ends.0)? || free(ends.1)? {
        return missing("a race between whirl and none");
    }
    Ok(halved(ends, |_| 1.001_f64.ln(), free)?.1.exp())
}
