//! Error against run time: one scene without control, over tolerances and methods.

use crate::scene::{Disturbance, Scene};
use plant_model::{BuildError, Inputs, Method, Options, PlantError, V2, Work, build};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Tolerances that are tried.
const TOLERANCES: [f64; 9] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
/// Tolerance of the references.
const TIGHTEST: f64 = 1e-13;
/// A run is repeated for so long, and its best time counts; other work on the machine only adds.
const REPEAT_FOR: Duration = Duration::from_millis(60);
const REPEAT_AT_MOST: u32 = 50;

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Title of the scene.
    pub problem: String,
    /// `series`, `explicit` or `stiff`.
    pub method: &'static str,
    /// Tolerance of a contact step.
    pub rtol: f64,
    /// Distance of the end position from the reference, in clearances.
    pub error: f64,
    /// Best wall-clock time \[s\].
    pub seconds: f64,
    /// Evaluations of the right-hand side, or series computed, in contact.
    pub evaluations: u64,
    /// Accepted contact steps.
    pub steps: u64,
    /// Changes of mode.
    pub mode_changes: u64,
}

/// What the sweep gave.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// All runs.
    pub rows: Vec<Row>,
    /// How far the references of the two methods lie apart, in clearances: errors below it mean
    /// nothing.
    pub reference_uncertainty: f64,
    /// Whether both references went through the same number of modes.
    pub references_agree: bool,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AccuracyError {
    /// The plant's parameters are out of range.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A run cannot be trusted any further.
    #[error("rtol {rtol:e}: {reason}")]
    Plant {
        /// Its tolerance.
        rtol: f64,
        /// Why.
        reason: PlantError,
    },
}

struct Ending {
    position_m: V2,
    mode_changes: u64,
    work: Work,
}

/// Runs the scene's plant without control under every method and tolerance.
///
/// # Errors
/// [`AccuracyError`].
pub fn sweep(scene: &Scene) -> Result<Accuracy, AccuracyError> {
    let reference = run(scene, Method::Series, TIGHTEST)?;
    let second = run(scene, Method::Explicit, TIGHTEST)?;
    let clearance_m = scene.plant.contact.clearance_m;
    let apart = |a: &Ending, b: &Ending| (a.position_m - b.position_m).norm() / clearance_m;
    let mut rows = Vec::new();
    for method in [Method::Series, Method::Explicit, Method::Stiff] {
        // A pair of order five is not made for the tightest tolerances.
        let tolerances = if method == Method::Stiff {
            &TOLERANCES[..6]
        } else {
            &TOLERANCES
        };
        for &rtol in tolerances {
            let (mut best, mut repeats) = (f64::INFINITY, 0);
            let begun = Instant::now();
            let ending = loop {
                let started = Instant::now();
                let ending = run(scene, method, rtol)?;
                best = best.min(started.elapsed().as_secs_f64());
                repeats += 1;
                if repeats >= REPEAT_AT_MOST || begun.elapsed() > REPEAT_FOR {
                    break ending;
                }
            };
            rows.push(Row {
                problem: scene.title.clone(),
                method: method.name(),
                rtol,
                error: apart(&ending, &reference),
                seconds: best,
                evaluations: ending.work.evaluations,
                steps: ending.work.steps,
                mode_changes: ending.mode_changes,
            });
        }
    }
    Ok(Accuracy {
        rows,
        reference_uncertainty: apart(&reference, &second),
        references_agree: reference.mode_changes == second.mode_changes,
    })
}

/// One run from edge to edge of the disturbances: no samples cut the integrator's steps.
fn run(scene: &Scene, method: Method, rtol: f64) -> Result<Ending, AccuracyError> {
    let options = Options {
        rtol,
        method,
        // There is one sample only.
        steps_per_sample: Options::default().steps,
        ..Options::default()
    };
    let mut plant = build(&scene.plant, &scene.start, options)?;
    let mut edges: Vec<f64> = (scene.disturbances.iter())
        .flat_map(|d: &Disturbance| [d.start_s, d.end_s()])
        .filter(|t| *t > 0.0 && *t < scene.duration_s)
        .collect();
    edges.push(scene.duration_s);
    edges.sort_by(f64::total_cmp);
    let (mut from, mut mode_changes) = (0.0, 0);
    for to in edges {
        let inputs = Inputs {
            command_n: V2::zeros(),
            external_n: scene.external_n(from),
        };
        plant
            .advance(to, &inputs, &mut |_| mode_changes += 1)
            .map_err(|reason| AccuracyError::Plant { rtol, reason })?;
        from = to;
    }
    Ok(Ending {
        position_m: plant.snapshot().position_m,
        mode_changes,
        work: plant.work(),
    })
}
