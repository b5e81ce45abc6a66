//! The two sweeps: the hardest impact recovered from, and the fastest whirl arrested at take-over.

use super::case::{off_centre, seeded};
use super::contenders::{Contender, Task};
use super::impact::recoverable_m_s;
use super::takeover::{ARRESTED, arrest_of, take_over};
use crate::machines::plants::PlantCase;
use crate::machines::tuned_gains::TunedGains;
use firmware_bench::run::closed_loop::RunError;
use firmware_bench::scene::Scene;
use plant_model::V2;
use serde::Serialize;

/// One policy on one plant over its seeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepRow {
    pub plant: String,
    /// Control rate \[Hz\].
    pub rate_hz: f64,
    pub policy: &'static str,
    /// Hardest radial impact recovered from \[m/s\], one a seed, in order of size.
    pub impact_m_s: Vec<f64>,
    /// The same with the bearing 10 % of the clearance off the centre, not configured.
    pub offset_impact_m_s: Vec<f64>,
    /// Fastest whirl recovered from at take-over, as a share of v_lim, one a seed, in order of size.
    pub whirl_share: Vec<f64>,
    /// Time to arrest whirl of 0.85 v_lim \[s\], one a seed, in order; none where it is not.
    pub arrest_s: Vec<f64>,
    /// What the closed form says \[s\].
    pub closed_form_s: f64,
}

/// The middle one of sorted values; NaN of none.
pub fn median(sorted: &[f64]) -> f64 {
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

/// The middle one of values in any order; NaN of none.
pub(crate) fn median_of(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    all.sort_by(f64::total_cmp);
    median(&all)
}

/// Steps of the whirl sweep, in shares of v_lim.
const WHIRL_STEP: f64 = 0.01;
const FIRST_WHIRL: f64 = 0.30;
const LAST_WHIRL: f64 = 1.10;
/// Speed at which the time is taken.
pub(crate) const TIMED_SHARE: f64 = 0.85;

/// What one seed gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepPoint {
    impact_m_s: f64,
    offset_impact_m_s: Option<f64>,
    whirl_share: f64,
    arrest_s: Option<f64>,
}

/// Sweeps one policy with one seed.
///
/// # Errors
/// [`RunError`] of a run that cannot be trusted.
pub fn sweep(
    case: &PlantCase,
    found: &TunedGains,
    (contender, seed): (Contender, u64),
) -> Result<SweepPoint, RunError> {
    let scene = seeded(&case.scene, seed);
    let make = |task: Task| move |s: &Scene| contender.controller(task, found, s);
    let mut impact_m_s = recoverable_m_s(&scene, contender.name(), &make(Task::Impact))?;
    if contender == Contender::Clairvoyant {
        // A law that is best on the fine grid of its search need not be on this one, which asks for all lower speeds.
        let other = recoverable_m_s(&scene, contender.name(), &make(Task::Whirl))?;
        impact_m_s = impact_m_s.max(other);
    }
    let offset_impact_m_s = if matches!(contender, Contender::Tuned | Contender::Supervisor) {
        let mut off = scene.clone();
        off_centre(&mut off, 0.1 * scene.clearance_m(0) * V2::new(0.6, 0.8));
        Some(recoverable_m_s(
            &off,
            contender.name(),
            &make(Task::Impact),
        )?)
    } else {
        None
    };
    let (mut whirl_share, mut arrest_s) = (0.0, None);
    if let Some(arrest) = arrest_of(&scene, 0) {
        let run = |share: f64| {
            let policy = make(Task::Whirl)(&scene).ok_or(RunError::Incomplete {
                policy: contender.name(),
            })?;
            take_over(&scene, share * arrest.limit_m_s, (policy, contender.name()))
        };
        let mut share = FIRST_WHIRL;
        while share < LAST_WHIRL + 0.5 * WHIRL_STEP && run(share)?.recovered {
            whirl_share = share;
            share += WHIRL_STEP;
        }
        arrest_s = run(TIMED_SHARE)?.arrested_s;
    }
    Ok(SweepPoint {
        impact_m_s,
        offset_impact_m_s,
        whirl_share,
        arrest_s,
    })
}

/// The points of all seeds as a row.
pub fn row(case: &PlantCase, contender: Contender, points: &[SweepPoint]) -> SweepRow {
    let sorted = |value: &dyn Fn(&SweepPoint) -> Option<f64>| {
        let mut all: Vec<f64> = points.iter().filter_map(value).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let closed_form_s = arrest_of(&case.scene, 0).map_or(f64::NAN, |arrest| {
        let from = TIMED_SHARE * arrest.limit_m_s;
        arrest.time_s(from, ARRESTED)
    });
    SweepRow {
        plant: case.name.clone(),
        rate_hz: case.rate_hz,
        policy: contender.name(),
        impact_m_s: sorted(&|p| Some(p.impact_m_s)),
        offset_impact_m_s: sorted(&|p| p.offset_impact_m_s),
        whirl_share: sorted(&|p| Some(p.whirl_share)),
        arrest_s: sorted(&|p| p.arrest_s),
        closed_form_s,
    }
}
