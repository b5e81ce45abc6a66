//! One policy on one scene, as firmware would run it: sample, compute, and a command that takes
//! effect at the next sample.

mod sample_hold;
mod station;
pub mod stepwise;

use self::sample_hold::ClosedLoop;
use self::station::Station;
use crate::device::external::ControllerError;
use crate::run::controller::{Controller, Referred, controller_beside};
use crate::run::figures::Figures;
use crate::run::rig::Rig;
use crate::run::trace::{AxisRow, ReadOut, Recorder, Trace};
use crate::run::whole_clairvoyant::WholeReference;
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::params::ParamError;
use plant_model::{Options, PlantError};
use std::cell::Cell;

/// Why a run has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The machine's parameters are out of range.
    #[error(transparent)]
    Machine(#[from] ParamError),
    /// The simulation cannot be trusted any further.
    #[error("policy {policy}: {reason}")]
    Plant {
        /// The policy that was running.
        policy: &'static str,
        /// Why.
        reason: PlantError,
    },
    /// The user's levitation controller does not answer as it should.
    #[error("policy {policy}: {reason}")]
    Controller {
        /// The policy that was running.
        policy: &'static str,
        /// Why.
        reason: Box<ControllerError>,
    },
    /// The energy audit does not close: the run made or lost energy.
    #[error(
        "policy {policy}: the energy audit misses {residual:.1e} of the energy turned over, more than \
         {limit:.1e}; a smaller run.rtol may help, or the scene asks for more than the model can say"
    )]
    Energy {
        /// The policy that was running.
        policy: &'static str,
        /// Energy from nowhere over energy turned over.
        residual: f64,
        /// Largest residual that is trusted.
        limit: f64,
    },
    /// The run is fine, and what should confirm it is not.
    #[error("checked by {method} at rtol {rtol:e}: {reason}")]
    Check {
        /// Method of the check.
        method: &'static str,
        /// Its tolerance.
        rtol: f64,
        /// Why the check has no result.
        reason: Box<RunError>,
    },
    /// Rows are asked for, and there are too many of them.
    #[error(
        "policy {policy}: {samples} samples are too many to be kept in memory, at most {MOST_KEPT}; a shorter run.duration_s, or \
         `run`, which writes them as it goes"
    )]
    TooLong { policy: &'static str, samples: u64 },
    /// The scene lacks something that the policy needs.
    #[error("policy {policy} needs more than the scene gives")]
    Incomplete { policy: &'static str },
}

impl RunError {
    fn of_controller(policy: &'static str) -> impl Fn(ControllerError) -> Self {
        move |reason| Self::Controller {
            policy,
            reason: Box::new(reason),
        }
    }
}

/// A run whose energy residual exceeds this many tolerances is not trusted; random plants keep within 0.3 by the series, 50 by
/// the explicit pair, 300 where a hardening contact takes that. Below a millionth all are: what bounces for long without loss
/// turns over little and makes an error in each impact, and were the limit as fine as every tolerance, no finer one would
/// help. Beyond a thousandth none is.
const TRUSTED_TOLERANCES: f64 = 1e3;
const TRUSTED: (f64, f64) = (1e-6, 1e-3);

/// Steps of the plant for each sample that a run may take, where it is so long that [`Accuracy::steps`] is fewer.
const STEPS_PER_SAMPLE: u64 = 8;

/// Most samples of which rows are kept in memory, some 0.3 KB each.
const MOST_KEPT: u64 = 10_000_000;

/// Refuses to keep the rows of a run that is too long for that.
///
/// # Errors
/// [`RunError::TooLong`].
pub fn fits_in_memory(scene: &Scene, policy: &'static str) -> Result<(), RunError> {
    let samples = scene.samples().count();
    match samples > MOST_KEPT {
        true => Err(RunError::TooLong { policy, samples }),
        false => Ok(()),
    }
}

/// Whether a run keeps its rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Every row.
    Trace,
    /// Only the figures.
    Verdict,
    /// Only the figures, and the run ends as soon as nothing can change whether the rotor has recovered.
    Decision,
    /// As [`Keep::Decision`], with every row until then.
    TraceToDecision,
}

impl Keep {
    fn rows(self) -> bool {
        matches!(self, Self::Trace | Self::TraceToDecision)
    }
    fn recorders(self, first: &mut Trace) -> Recorders<'_> {
        Recorders {
            planes: match self.rows() {
                true => vec![first],
                false => Vec::new(),
            },
            axis: None,
        }
    }
    fn to_decision(self) -> bool {
        matches!(self, Self::Decision | Self::TraceToDecision)
    }
}

/// How much a run may cost, and how finely what is held is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Accuracy {
    /// Into so many times as many parts is cut what varies within a control period and is held part by part: loads, ramps.
    pub parts: u32,
    /// Steps of the plant in the whole run, beyond which it ends with [`PlantError::WorkLimit`].
    pub steps: u64,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            parts: 1,
            steps: Options::default().steps,
        }
    }
}

/// Runs one policy to the end of the scene. `on_tick` is called now and then with the number of ticks
/// done since its last call. What comes back are the figures of the machine and the trace of its first plane.
///
/// # Errors
/// [`RunError`]; there is no half-trusted result.
pub fn run(
    scene: &Scene,
    kind: PolicyKind,
    keep: Keep,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Trace), RunError> {
    if keep.rows() {
        fits_in_memory(scene, kind.name())?;
    }
    let task = Task::keeping(keep, kind.name());
    let mut trace = Trace::default();
    let sim = loop_of_policy(scene, kind, keep.recorders(&mut trace), task)?;
    let ended = sim.run_to_end(task, on_tick)?;
    of_machine(ended, trace, task)
}

/// Runs a controller that has been set up for the only plane of a scene, under the name of a policy.
///
/// # Errors
/// As [`run`]; [`RunError::Incomplete`] of a scene with more planes.
pub fn run_policy(
    scene: &Scene,
    (controller, policy): (Box<dyn Controller>, &'static str),
    keep: Keep,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Trace), RunError> {
    if keep.rows() {
        fits_in_memory(scene, policy)?;
    }
    let task = Task::keeping(keep, policy);
    let mut trace = Trace::default();
    let only = Cell::new(Some(controller));
    let mut sim = set_up(scene, (&|_| only.take(), keep.recorders(&mut trace)), task)?;
    sim.levitated_by(scene.levitation.as_ref(), policy)?;
    let ended = sim.run_to_end(task, on_tick)?;
    of_machine(ended, trace, task)
}

fn of_machine(
    mut ended: Vec<PlaneEnded>,
    mut trace: Trace,
    task: Task,
) -> Result<(Figures, Trace), RunError> {
    let policy = task.policy;
    trace.read_out = ended.first_mut().and_then(|(_, read_out)| read_out.take());
    let planes: Vec<Figures> = ended.into_iter().map(|(figures, _)| figures).collect();
    let figures = Figures::of_machine(&planes).ok_or(RunError::Incomplete { policy })?;
    Ok((figures, trace))
}

/// Who is given the rows of a run.
#[derive(Default)]
pub struct Recorders<'a> {
    /// Of each plane, in their order; of others no rows are asked for.
    pub planes: Vec<&'a mut dyn Recorder>,
    /// Of the rotor's axis, at control samples.
    pub axis: Option<&'a mut dyn Recorder<AxisRow>>,
}

impl<'a> Recorders<'a> {
    /// Of planes alone, one each.
    pub fn of_planes<R: Recorder>(all: &'a mut [R]) -> Self {
        let planes = all.iter_mut().map(|one| one as &mut dyn Recorder);
        Self {
            planes: planes.collect(),
            axis: None,
        }
    }
}

/// Outcome of one plane, and where its rows are recorded what its supervisor leaves behind.
pub type PlaneEnded = (Figures, Option<ReadOut>);

/// Runs one policy to the end of the scene, its rows given to recorders as they come. What comes back is of each plane.
///
/// # Errors
/// As [`run`].
pub fn record<'a>(
    scene: &'a Scene,
    kind: PolicyKind,
    recorders: Recorders<'a>,
    accuracy: Accuracy,
    on_tick: &mut dyn FnMut(u64),
) -> Result<Vec<PlaneEnded>, RunError> {
    let task = Task {
        accuracy,
        ..Task::keeping(Keep::Trace, kind.name())
    };
    loop_of_policy(scene, kind, recorders, task)?.run_to_end(task, on_tick)
}

fn loop_of_policy<'a>(
    scene: &'a Scene,
    kind: PolicyKind,
    recorders: Recorders<'a>,
    task: Task,
) -> Result<ClosedLoop<'a>, RunError> {
    let supervisor = match kind {
        PolicyKind::Supervisor => scene.supervisor(),
        _ => None,
    };
    let whole = supervisor.is_some();
    let controller = |plane: usize| controller_beside(kind, (scene, plane), whole);
    let mut sim = set_up(scene, (&controller, recorders), task)?;
    sim.levitated_by(scene.levitation.as_ref(), task.policy)?;
    sim.supervisor = supervisor.zip(scene.supervised());
    Ok(sim)
}

/// Runs a reference on a whole rotor; what comes back is of each plane. [`Keep`] says when it ends; no rows are kept.
///
/// # Errors
/// As [`run`].
pub fn run_reference(
    scene: &Scene,
    reference: &WholeReference,
    keep: Keep,
) -> Result<Vec<Figures>, RunError> {
    let task = Task::keeping(keep, "clairvoyant");
    let controller = |_: usize| -> Option<Box<dyn Controller>> { Some(Box::new(Referred)) };
    let mut sim = set_up(scene, (&controller, Recorders::default()), task)?;
    sim.reference = Some(reference);
    let ended = sim.run_to_end(task, &mut |_| {})?;
    Ok(ended.into_iter().map(|(figures, _)| figures).collect())
}

/// Sets up the controller of a plane; `None` where the plane lacks something.
type ControllerOf<'f> = &'f dyn Fn(usize) -> Option<Box<dyn Controller>>;

/// A scene in the loop, nobody holding it as a whole.
fn set_up<'a>(
    scene: &'a Scene,
    (controller_of, recorders): (ControllerOf<'_>, Recorders<'a>),
    task: Task,
) -> Result<ClosedLoop<'a>, RunError> {
    let options = Options {
        rtol: scene.rtol,
        method: scene.method,
        // A long run takes a step for each sample at least.
        steps: (task.accuracy.steps).max(STEPS_PER_SAMPLE * scene.samples().count()),
        ..Options::default()
    };
    let rig = Rig::new(scene, options)?;
    let mut of_planes = recorders.planes.into_iter();
    let mut stations = Vec::new();
    for plane in 0..scene.planes.len() {
        let controller = controller_of(plane).ok_or(RunError::Incomplete {
            policy: task.policy,
        })?;
        stations.push(Station::new(scene, plane, controller, of_planes.next()));
    }
    let mut sim = ClosedLoop::new(scene, rig, stations);
    sim.axis = recorders.axis;
    Ok(sim)
}

/// A run as it is asked for.
#[derive(Debug, Clone, Copy)]
struct Task {
    policy: &'static str,
    to_decision: bool,
    accuracy: Accuracy,
}

impl Task {
    fn keeping(keep: Keep, policy: &'static str) -> Self {
        Self {
            policy,
            to_decision: keep.to_decision(),
            accuracy: Accuracy::default(),
        }
    }
}
