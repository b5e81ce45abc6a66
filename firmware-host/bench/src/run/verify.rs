//! A run's own estimate of its global error: the closed loop once more at a tighter tolerance, and
//! once more by another method.

use crate::run::closed_loop::{Accuracy, Recorders, RunError, record};
use crate::run::figures::Figures;
use crate::run::outcome::Outcome;
use crate::run::trace::{Recorder, TraceRow};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::{ContactMode, Method, V2};
use serde::Serialize;

/// Number of checks of a run.
pub const CHECKS: usize = 2;
/// Distance above which runs count as different, in clearances.
pub(crate) const THRESHOLD_CLEARANCES: f64 = 1e-3;
/// The check by the run's own method is so much tighter than the run.
const TIGHTER: f64 = 1e-2;
/// Tolerance of the check by another method, whose error at a given tolerance may be far larger than
/// the run's; below it there is only round-off.
const TIGHTEST: f64 = 1e-13;
/// Loads that vary and ramps of the amplifier are held over parts, which no tolerance mends. Over parts so much shorter the
/// error of loads is a 256th, that of ramps a quarter or less, so that checks see it.
const FINER_PARTS: u32 = 4;
/// Steps of the plant that a check may take, and more for each control sample: about a second of work for every 5000 samples,
/// and four times what checks of the scenes that come with this program need. A check that is not done then ends with
/// [`plant_model::PlantError::WorkLimit`].
const STEPS: u64 = 200_000;
const STEPS_PER_SAMPLE: u64 = 100;

/// The run once more, by one method at one tolerance, against the run itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Method that integrated contact.
    pub method: &'static str,
    /// Its tolerance.
    pub rtol: f64,
    /// How it ended.
    pub outcome: Outcome,
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
    pub checks: Vec<Check>,
}

/// Scenes that check a scene: its own method at a tighter tolerance, and the other one. What has no series leaves no other, and
/// is looked at a third time by the same, as tightly as it can.
///
/// # Errors
/// [`RunError::Machine`].
pub fn check_scenes(scene: &Scene) -> Result<[Scene; CHECKS], RunError> {
    let own = scene.machine.method(scene.method)?;
    let other = match scene.machine.method(Method::Series) {
        Ok(Method::Series) if own == Method::Collocation => Method::Series,
        Ok(_) | Err(_) => Method::Collocation,
    };
    let check = |method: Method, rtol: f64| Scene {
        method,
        rtol: rtol.max(TIGHTEST).min(scene.rtol),
        ..scene.clone()
    };
    Ok([check(own, scene.rtol * TIGHTER), check(other, TIGHTEST)])
}

/// Where a rotor was in a run, and in which modes: what checks are held against.
#[derive(Debug, Clone, Default)]
pub struct Track {
    /// Positions at control samples, which stand at the same times in every run of a scene \[m\].
    positions_m: Vec<V2>,
    /// Modes in the order in which they were entered.
    modes: Vec<ContactMode>,
}

impl Recorder for Track {
    fn row(&mut self, row: &TraceRow) {
        match row.mode_change {
            true => self.modes.push(row.plant.mode),
            false => self.positions_m.push(row.plant.position_m),
        }
    }
}

/// A check while it runs beside a run that is known.
struct Comparison<'a> {
    run: &'a Track,
    clearance_m: f64,
    samples: usize,
    mode_changes: usize,
    same_modes: bool,
    last: f64,
    largest: f64,
    differs_from_s: Option<f64>,
}

impl Recorder for Comparison<'_> {
    fn row(&mut self, row: &TraceRow) {
        if row.mode_change {
            self.same_modes &= self.run.modes.get(self.mode_changes) == Some(&row.plant.mode);
            self.mode_changes += 1;
        } else if let Some(position_m) = self.run.positions_m.get(self.samples) {
            self.samples += 1;
            self.last = (position_m - row.plant.position_m).norm() / self.clearance_m;
            self.largest = self.largest.max(self.last);
            if self.last > THRESHOLD_CLEARANCES {
                self.differs_from_s.get_or_insert(row.plant.t_s);
            }
        }
    }
}

impl<'a> Comparison<'a> {
    fn new(run: &'a Track, clearance_m: f64) -> Self {
        Self {
            run,
            clearance_m,
            samples: 0,
            mode_changes: 0,
            same_modes: true,
            last: 0.0,
            largest: 0.0,
            differs_from_s: None,
        }
    }

    fn ended(self, figures: &Figures, rtol: f64) -> Check {
        Check {
            method: figures.method,
            rtol,
            outcome: figures.outcome,
            mode_changes: self.mode_changes as u64,
            same_modes: self.same_modes && self.mode_changes == self.run.modes.len(),
            end_difference_clearances: self.last,
            largest_difference_clearances: self.largest,
            differs_from_s: self.differs_from_s,
        }
    }
}

fn accuracy(scene: &Scene) -> Accuracy {
    Accuracy {
        parts: FINER_PARTS,
        steps: STEPS + STEPS_PER_SAMPLE * scene.samples().count(),
    }
}

fn untrusted(scene: &Scene) -> impl Fn(RunError) -> RunError {
    let (method, rtol) = (scene.method.name(), scene.rtol);
    move |reason| RunError::Check {
        method,
        rtol,
        reason: Box::new(reason),
    }
}

/// Runs a policy of one of [`check_scenes`] and holds each of its planes against the run itself.
///
/// # Errors
/// [`RunError::Check`].
pub fn check(
    scene: &Scene,
    kind: PolicyKind,
    tracks: &[Track],
    on_tick: &mut dyn FnMut(u64),
) -> Result<Vec<Check>, RunError> {
    let mut comparisons: Vec<Comparison> = (tracks.iter().enumerate())
        .map(|(plane, run)| Comparison::new(run, scene.clearance_m(plane)))
        .collect();
    let recorders = Recorders::of_planes(&mut comparisons);
    let ended = record(scene, kind, recorders, accuracy(scene), on_tick);
    let ended = ended.map_err(untrusted(scene))?;
    Ok((comparisons.into_iter().zip(&ended))
        .map(|(comparison, (figures, _))| comparison.ended(figures, scene.rtol))
        .collect())
}

/// What the checks of a run say together.
pub fn verification(figures: &Figures, run: &Track, checks: Vec<Check>) -> Verification {
    let largest = |of: fn(&Check) -> f64| checks.iter().map(of).fold(0.0, f64::max);
    Verification {
        same_outcome: checks.iter().all(|c| c.outcome == figures.outcome),
        same_modes: checks.iter().all(|c| c.same_modes),
        mode_changes: run.modes.len() as u64,
        estimated_error_clearances: largest(|c| c.end_difference_clearances),
        largest_difference_clearances: largest(|c| c.largest_difference_clearances),
        threshold_clearances: THRESHOLD_CLEARANCES,
        differs_from_s: (checks.iter().filter_map(|c| c.differs_from_s)).reduce(f64::min),
        checks,
    }
}

/// What the planes of a machine say together: the worst of each.
pub(crate) fn worst(planes: &[&Verification]) -> Verification {
    let largest = |of: fn(&Verification) -> f64| planes.iter().map(|v| of(v)).fold(0.0, f64::max);
    Verification {
        same_outcome: planes.iter().all(|v| v.same_outcome),
        same_modes: planes.iter().all(|v| v.same_modes),
        mode_changes: planes.iter().map(|v| v.mode_changes).sum(),
        estimated_error_clearances: largest(|v| v.estimated_error_clearances),
        largest_difference_clearances: largest(|v| v.largest_difference_clearances),
        threshold_clearances: THRESHOLD_CLEARANCES,
        differs_from_s: (planes.iter().filter_map(|v| v.differs_from_s)).reduce(f64::min),
        checks: planes.iter().flat_map(|v| v.checks.clone()).collect(),
    }
}
