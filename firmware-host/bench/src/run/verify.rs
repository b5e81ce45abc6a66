//! A run's own estimate of its global error: the closed loop once more at a tighter tolerance, and
//! once more by another method.

use crate::run::closed_loop::{Keep, RunError, run};
use crate::run::figures::Figures;
use crate::run::outcome::Outcome;
use crate::run::trace::{Trace, TraceRow};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::{Method, Mode, Options};
use serde::Serialize;

/// Number of checks of a run.
pub const CHECKS: usize = 2;
/// Distance above which runs count as different, in clearances.
pub const THRESHOLD_CLEARANCES: f64 = 1e-3;
/// The check by the run's own method is so much tighter than the run.
const TIGHTER: f64 = 1e-2;
/// Tolerance of the check by another method, whose error at a given tolerance may be far larger than
/// the run's; below it there is only round-off.
const TIGHTEST: f64 = 1e-13;

/// The run once more, by one method at one tolerance, against the run itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Method that integrated contact.
    pub method: &'static str,
    /// Its tolerance.
    pub rtol: f64,
    /// How it ended.
    pub outcome: Outcome,
    /// Changes of mode.
    pub mode_changes: u64,
    /// Whether the modes follow each other as in the run.
    pub same_modes: bool,
    /// Distance of the end positions, in clearances.
    pub end_difference_clearances: f64,
    /// Largest distance at a control sample, in clearances.
    pub largest_difference_clearances: f64,
    /// First control sample more than the threshold apart \[s\]; `None` if there is none.
    pub differs_from_s: Option<f64>,
}

/// What the checks say of a run: the worst of each.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verification {
    /// Whether all checks end with the outcome of the run.
    pub same_outcome: bool,
    /// Whether the modes follow each other as in the run in all checks.
    pub same_modes: bool,
    /// Changes of mode of the run.
    pub mode_changes: u64,
    /// Estimated global error: largest distance of the end position from a check's, in clearances.
    pub estimated_error_clearances: f64,
    /// Largest distance from a check at a control sample, in clearances.
    pub largest_difference_clearances: f64,
    /// Distance above which runs count as different, in clearances.
    pub threshold_clearances: f64,
    /// First control sample at which a check is farther away \[s\]; `None`: they agree to the end.
    pub differs_from_s: Option<f64>,
    /// The checks.
    pub checks: Vec<Check>,
}

/// Scenes that check a scene: its own method at a tighter tolerance, and an independent method.
///
/// # Errors
/// [`RunError::Build`].
pub fn check_scenes(scene: &Scene) -> Result<[Scene; CHECKS], RunError> {
    let options = Options {
        rtol: scene.rtol,
        method: scene.method,
        ..Options::default()
    };
    let own = scene.build(options)?.method();
    let check = |method: Method, rtol: f64| Scene {
        method,
        rtol: rtol.max(TIGHTEST).min(scene.rtol),
        ..scene.clone()
    };
    let other = match (own, scene.plant.has_series()) {
        (Method::Series, _) => Method::Explicit,
        (_, true) => Method::Series,
        // Without a power series: the one pair checks the other.
        (Method::Stiff, false) => Method::Explicit,
        (_, false) => Method::Stiff,
    };
    Ok([check(own, scene.rtol * TIGHTER), check(other, TIGHTEST)])
}

/// Runs a policy of one of [`check_scenes`].
///
/// # Errors
/// [`RunError::Check`].
pub fn run_check(
    check: &Scene,
    kind: PolicyKind,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Trace), RunError> {
    run(check, kind, Keep::Trace, on_tick).map_err(|reason| RunError::Check {
        method: check.method.name(),
        rtol: check.rtol,
        reason: Box::new(reason),
    })
}

/// Holds a check's run against the run itself.
pub fn compare(check: &Scene, trace: &Trace, (figures, check_trace): (&Figures, &Trace)) -> Check {
    let clearance_m = check.plant.contact.clearance_m;
    let pairs = || samples(trace).zip(samples(check_trace));
    let apart = |(a, b): (&TraceRow, &TraceRow)| {
        let distance = (a.plant.position_m - b.plant.position_m).norm() / clearance_m;
        (a.plant.t_s, distance)
    };
    Check {
        method: figures.method,
        rtol: check.rtol,
        outcome: figures.outcome,
        mode_changes: modes(check_trace).count() as u64,
        same_modes: modes(trace).eq(modes(check_trace)),
        end_difference_clearances: pairs().map(apart).last().map_or(0.0, |(_, d)| d),
        largest_difference_clearances: pairs().map(apart).fold(0.0, |m, (_, d)| m.max(d)),
        differs_from_s: (pairs().map(apart))
            .find(|(_, d)| *d > THRESHOLD_CLEARANCES)
            .map(|(t, _)| t),
    }
}

/// What the checks of a run say together.
pub fn verification(figures: &Figures, trace: &Trace, checks: Vec<Check>) -> Verification {
    let largest = |of: fn(&Check) -> f64| checks.iter().map(of).fold(0.0, f64::max);
    Verification {
        same_outcome: checks.iter().all(|c| c.outcome == figures.outcome),
        same_modes: checks.iter().all(|c| c.same_modes),
        mode_changes: modes(trace).count() as u64,
        estimated_error_clearances: largest(|c| c.end_difference_clearances),
        largest_difference_clearances: largest(|c| c.largest_difference_clearances),
        threshold_clearances: THRESHOLD_CLEARANCES,
        differs_from_s: (checks.iter().filter_map(|c| c.differs_from_s)).reduce(f64::min),
        checks,
    }
}

/// Rows at control samples; they stand at the same times in every run of a scene.
fn samples(trace: &Trace) -> impl Iterator<Item = &TraceRow> {
    trace.rows.iter().filter(|r| !r.mode_change)
}

/// Modes in the order in which they were entered.
fn modes(trace: &Trace) -> impl Iterator<Item = Mode> {
    trace
        .rows
        .iter()
        .filter(|r| r.mode_change)
        .map(|r| r.plant.mode)
}
