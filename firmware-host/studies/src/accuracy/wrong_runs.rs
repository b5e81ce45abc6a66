//! Runs that end without an error and are wrong all the same: one scene without control, from many
//! start speeds.

use crate::accuracy::{AccuracyError, Ending, apart, references, run};
use crate::campaign::each;
use firmware_bench::scene::Scene;
use serde::Serialize;

/// Number of starts.
pub const STARTS: u32 = 400;
/// The start velocity of the scene is multiplied by factors from the first to the second, evenly spaced.
const FACTORS: (f64, f64) = (1.0 / 6.0, 1.5);
/// Tolerances that are tried.
pub const TOLERANCES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
/// An end so far off is no error of accuracy, in clearances.
const WRONG_CLEARANCES: f64 = 0.5;
/// Relative change of the start speed that a reference must survive …
const NUDGE: f64 = 1e-12;
/// … and tolerance of collocation that must confirm it.
const CONFIRM_AT: f64 = 1e-8;

/// Outcome of all starts at one tolerance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WrongRow {
    /// Title of the scene.
    pub problem: String,
    /// Method that the scene's `run.method` comes to.
    pub method: &'static str,
    /// Tolerance of a contact step.
    pub rtol: f64,
    /// Runs without an error that went through other modes than the reference, or end half a clearance
    /// away from it.
    pub wrong: u32,
    /// Runs that said so themselves: they ended with a named error.
    pub failed: u32,
    /// Runs that were looked at.
    pub of: u32,
    /// Starts without a reference: it changes its modes, or moves by half a clearance, when the start
    /// speed is changed by 1e-12 or the method is.
    pub left_out: u32,
}

/// Outcome of one start; `None` where it was left out.
type Start = Option<[Run; TOLERANCES.len()]>;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Run {
    Right,
    Wrong,
    Failed,
}

/// Whether starts differ at all: a scene that starts at rest has one only.
pub(crate) fn applies_to(scene: &Scene) -> bool {
    let start = &scene.start;
    [start.centre_velocity_m_s, start.tilt_rate_rad_s]
        .iter()
        .any(|v| v.norm() > 0.0)
}

/// Runs all starts in parallel; `on_start` is called after each. The rows do not depend on the threads.
///
/// # Errors
/// [`AccuracyError::Machine`].
pub fn sweep(scene: &Scene, on_start: &(dyn Fn() + Sync)) -> Result<Vec<WrongRow>, AccuracyError> {
    let numbers: Vec<_> = (0..STARTS).collect();
    let starts: Vec<Start> = each(&numbers, |i| {
        let share = f64::from(*i) / f64::from(STARTS - 1);
        let start = from_start(scene, FACTORS.0 + share * (FACTORS.1 - FACTORS.0));
        on_start();
        start
    });
    let looked_at: Vec<_> = starts.iter().flatten().collect();
    let row = |(i, rtol): (usize, f64)| {
        let count = |what: Run| looked_at.iter().filter(|runs| runs[i] == what).count() as u32;
        Ok(WrongRow {
            problem: scene.title.clone(),
            method: resolved(scene, rtol)?,
            rtol,
            wrong: count(Run::Wrong),
            failed: count(Run::Failed),
            of: looked_at.len() as u32,
            left_out: STARTS - looked_at.len() as u32,
        })
    };
    TOLERANCES.into_iter().enumerate().map(row).collect()
}

/// Name of the method that a scene comes to at a tolerance.
fn resolved(scene: &Scene, rtol: f64) -> Result<&'static str, AccuracyError> {
    let at_once = Scene {
        duration_s: f64::MIN_POSITIVE,
        disturbances: Vec::new(),
        base_motions: Vec::new(),
        changes: Vec::new(),
        ..scene.clone()
    };
    run(&at_once, scene.method, rtol).map(|ending| ending.method.name())
}

fn from_start(scene: &Scene, factor: f64) -> Start {
    let at = |factor: f64| {
        let mut moved = scene.clone();
        moved.start.centre_velocity_m_s *= factor;
        moved.start.tilt_rate_rad_s *= factor;
        moved
    };
    let moved = at(factor);
    let agree =
        |a: &Ending, b: &Ending| a.modes == b.modes && apart(scene, a, b) <= WRONG_CLEARANCES;
    let [(one, tightest), (other, _)] = references(scene);
    let reference = run(&moved, one, tightest).ok()?;
    let slower = run(&at(factor * (1.0 - NUDGE)), one, tightest).ok()?;
    let faster = run(&at(factor * (1.0 + NUDGE)), other, CONFIRM_AT).ok()?;
    if !(agree(&reference, &slower) && agree(&reference, &faster)) {
        return None;
    }
    Some(
        TOLERANCES.map(|rtol| match run(&moved, scene.method, rtol) {
            Ok(ending) if agree(&reference, &ending) => Run::Right,
            Ok(_) => Run::Wrong,
            Err(_) => Run::Failed,
        }),
    )
}
