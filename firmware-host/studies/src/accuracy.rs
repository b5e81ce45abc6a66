//! Error against run time: one scene without control, over tolerances and methods.

pub mod study;
pub mod wrong_runs;

use firmware_bench::device::loads::{self, Disturbance};
use firmware_bench::scene::Scene;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::ParamError;
use plant_model::{ContactMode, Method, Options, PlantError, V2, Work};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Tolerances that are tried.
const TOLERANCES: [f64; 9] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
/// Tolerance of the references.
pub(crate) const TIGHTEST: f64 = 1e-13;
/// A run is repeated for so long, and its best time counts; other work on the machine only adds.
const REPEAT_FOR: Duration = Duration::from_millis(60);
const REPEAT_AT_MOST: u32 = 50;

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Title of the scene.
    pub problem: String,
    /// `series` or `collocation`.
    pub method: &'static str,
    /// Tolerance of a contact step.
    pub rtol: f64,
    /// Distance of the end position from the reference, in clearances, of the plane that has the largest; `None` where the
    /// reference is not confirmed.
    pub error: Option<f64>,
    /// Best wall-clock time \[s\].
    pub seconds: f64,
    /// Evaluations of the right-hand side, or series computed, in contact.
    pub evaluations: u64,
    /// Accepted contact steps.
    pub steps: u64,
    pub mode_changes: u64,
}

/// What errors of one problem are measured against.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reference {
    /// Title of the scene.
    pub problem: String,
    /// The method that errors are measured against, and the one that confirms it.
    pub methods: [&'static str; 2],
    /// Distance of the end positions by the two reference methods at 1e-13, in clearances:
    /// errors below it mean nothing.
    pub uncertainty: f64,
    /// Whether both went through the same modes in the same order.
    pub same_modes: bool,
    /// Whether they do, and end closer to each other than `CONFIRMED_CLEARANCES`.
    pub confirmed: bool,
    /// Evaluations of both in contact: what runs of this problem cost.
    pub evaluations: u64,
}

impl Reference {
    /// How far it can be trusted.
    pub fn in_words(&self) -> String {
        let [one, other] = self.methods;
        let uncertainty = self.uncertainty;
        if self.confirmed {
            return format!(
                "reference: {one} at rtol 1e-13; {other} ends {uncertainty:.1e} c away, through the same modes"
            );
        }
        let modes = if self.same_modes { "the same" } else { "other" };
        format!(
            "{}: no errors, for the reference is not confirmed: at rtol 1e-13 {other} ends {uncertainty:.1e} c away from {one}, through {modes} modes",
            self.problem
        )
    }
}

/// References farther apart than this confirm nothing.
pub(crate) const CONFIRMED_CLEARANCES: f64 = 1e-3;

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AccuracyError {
    /// The machine's parameters are out of range.
    #[error(transparent)]
    Machine(#[from] ParamError),
    /// A run cannot be trusted any further.
    #[error("{method}, rtol {rtol:e}: {reason}")]
    Plant {
        /// The method that integrated contact.
        method: &'static str,
        /// Its tolerance.
        rtol: f64,
        /// Why.
        reason: PlantError,
    },
}

/// Where a run ends and how it came there.
pub(crate) struct Ending {
    /// Of each plane.
    pub(crate) positions_m: Vec<V2>,
    /// Each with its plane.
    pub(crate) modes: Vec<(usize, ContactMode)>,
    pub(crate) method: Method,
    work: Work,
}

/// Distance of two ends in clearances, of the plane that has the largest.
pub(crate) fn apart(scene: &Scene, a: &Ending, b: &Ending) -> f64 {
    let ends = a.positions_m.iter().zip(&b.positions_m).enumerate();
    ends.map(|(plane, (a, b))| (a - b).norm() / scene.clearance_m(plane))
        .fold(0.0, f64::max)
}

/// What a scene is held against: two methods of little in common at the tightest tolerance; what has no power series, by collocation
/// at two tolerances.
pub(crate) fn references(scene: &Scene) -> [(Method, f64); 2] {
    match scene.machine.method(Method::Series) {
        Ok(_) => [(Method::Series, TIGHTEST), (Method::Collocation, TIGHTEST)],
        Err(_) => [TIGHTEST, 10.0 * TIGHTEST].map(|rtol| (Method::Collocation, rtol)),
    }
}

/// Runs the scene's machine without control under every method and tolerance.
///
/// # Errors
/// [`AccuracyError`].
pub fn sweep(scene: &Scene) -> Result<(Vec<Row>, Reference), AccuracyError> {
    let [(one, tightest), (other, tight)] = references(scene);
    let first = run(scene, one, tightest)?;
    let second = run(scene, other, tight)?;
    let (uncertainty, same_modes) = (apart(scene, &first, &second), first.modes == second.modes);
    let reference = Reference {
        problem: scene.title.clone(),
        methods: [one, other].map(Method::name),
        uncertainty,
        same_modes,
        confirmed: same_modes && uncertainty < CONFIRMED_CLEARANCES,
        evaluations: first.work.evaluations + second.work.evaluations,
    };
    let mut rows = Vec::new();
    for method in [Method::Series, Method::Collocation] {
        if method == Method::Series && one != Method::Series {
            continue;
        }
        for rtol in TOLERANCES {
            let (seconds, ending) = timed(|| run(scene, method, rtol))?;
            rows.push(Row {
                problem: scene.title.clone(),
                method: method.name(),
                rtol,
                error: reference.confirmed.then(|| apart(scene, &ending, &first)),
                seconds,
                evaluations: ending.work.evaluations,
                steps: ending.work.steps,
                mode_changes: ending.modes.len() as u64,
            });
        }
    }
    Ok((rows, reference))
}

/// Best time \[s\] of a few runs, and the last of them.
fn timed(
    mut run: impl FnMut() -> Result<Ending, AccuracyError>,
) -> Result<(f64, Ending), AccuracyError> {
    let (mut best, mut repeats) = (f64::INFINITY, 0);
    let begun = Instant::now();
    loop {
        let started = Instant::now();
        let ending = run()?;
        best = best.min(started.elapsed().as_secs_f64());
        repeats += 1;
        if repeats >= REPEAT_AT_MOST || begun.elapsed() > REPEAT_FOR {
            return Ok((best, ending));
        }
    }
}

/// One run from edge to edge of the disturbances: no samples cut the integrator's steps.
pub(crate) fn run(scene: &Scene, method: Method, rtol: f64) -> Result<Ending, AccuracyError> {
    let options = Options {
        rtol,
        method,
        // There is one sample only.
        steps_per_sample: Options::default().steps,
        ..Options::default()
    };
    let loads: Vec<Disturbance> = scene.loads().collect();
    let params = scene.machine_with_loads();
    let mut machine = Machine::new(&params, &scene.start, options)?;
    let mut inputs = MachineInputs {
        commands_n: vec![V2::zeros(); params.magnets.len()],
        loads_n: vec![V2::zeros(); loads.len()],
    };
    let mut edges = scene.edges();
    edges.retain(|t| *t > 0.0 && *t < scene.duration_s);
    edges.push(scene.duration_s);
    let mut changes = scene.changes.iter().peekable();
    let (mut from, mut modes) = (0.0, Vec::new());
    for to in edges {
        while let Some(due) = changes.next_if(|c| c.at_s <= from) {
            machine.change(&due.change)?;
        }
        let parts = loads.iter().filter_map(|load| load.parts(from, to)).max();
        for [begin, middle, end] in loads::cuts((from, to), parts.unwrap_or(1)) {
            let halves = match parts {
                Some(_) => &[middle, end][..],
                None => &[end],
            };
            for (half, until_s) in halves.iter().enumerate() {
                for (held_n, load) in inputs.loads_n.iter_mut().zip(&loads) {
                    *held_n = load.halves_n(begin, end)[half];
                }
                let advanced = machine.advance(*until_s, &inputs, &mut |plane, now| {
                    modes.extend(now.planes().nth(plane).map(|now| (plane, now.mode)));
                });
                advanced.map_err(|reason| AccuracyError::Plant {
                    method: machine.method().name(),
                    rtol,
                    reason,
                })?;
            }
        }
        from = to;
    }
    Ok(Ending {
        positions_m: (machine.snapshot().planes())
            .map(|plane| plane.rotor.position)
            .collect(),
        modes,
        method: machine.method(),
        work: machine.work(),
    })
}
