//! One policy on one scene, as firmware would run it: sample, compute, and a command that takes
//! effect at the next sample.

mod bench;
mod station;
pub mod stepwise;

use self::bench::Bench;
use self::station::Station;
use crate::device::external::ControllerError;
use crate::device::loads::Loads;
use crate::run::controller::{Controller, Referred, controller, controller_of_plane};
use crate::run::figures::Figures;
use crate::run::rig::{ChangeError, OnePlane, WholeRotor};
use crate::run::trace::{AxisRow, ReadOut, Recorder, Trace};
use crate::run::whole_clairvoyant::WholeReference;
use crate::scene::Scene;
use crate::scene::machine::MachineScene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::machine::params::MachineError;
use plant_model::params::StatorParams;
use plant_model::{BuildError, Options, PlantError, V2};

/// Why a run has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The plant's parameters are out of range.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A machine's parameters are out of range.
    #[error(transparent)]
    Machine(#[from] MachineError),
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
    /// Rings would feel a base motion too, and the model has no such force.
    #[error("base motion needs a rigid stator")]
    BaseMotionOnRings,
    /// The scene lacks something that the policy needs.
    #[error("policy {policy} needs more than the scene gives")]
    Incomplete {
        /// The policy.
        policy: &'static str,
    },
}

impl From<ChangeError> for RunError {
    fn from(error: ChangeError) -> Self {
        match error {
            ChangeError::OnePlane(error) => Self::Build(error.into()),
            ChangeError::Machine(error) => Self::Machine(error),
        }
    }
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
    fn to_decision(self) -> bool {
        matches!(self, Self::Decision | Self::TraceToDecision)
    }
}

/// How much a run may cost, and how finely what is held is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rigour {
    /// Into so many times as many parts is cut what varies within a control period and is held part by part: loads, ramps.
    pub parts: u32,
    /// Steps of the plant in the whole run, beyond which it ends with [`PlantError::WorkLimit`].
    pub steps: u64,
}

impl Default for Rigour {
    fn default() -> Self {
        Self {
            parts: 1,
            steps: Options::default().steps,
        }
    }
}

/// Runs one policy to the end of the scene. `on_tick` is called now and then with the number of ticks
/// done since its last call.
///
/// # Errors
/// [`RunError`]; there is no half-trusted result.
pub fn run(
    scene: &Scene,
    kind: PolicyKind,
    keep: Keep,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Trace), RunError> {
    let policy = kind.name();
    let acting = controller(kind, scene).ok_or(RunError::Incomplete { policy })?;
    run_policy(scene, (acting, policy), keep, on_tick)
}

/// Runs a controller that has been set up, under the name of a policy.
///
/// # Errors
/// As [`run`].
pub fn run_policy(
    scene: &Scene,
    acting: (Box<dyn Controller>, &'static str),
    keep: Keep,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Trace), RunError> {
    let mut trace = Trace::default();
    let recorder: Option<&mut dyn Recorder> = match keep.rows() {
        true => Some(&mut trace),
        false => None,
    };
    let (controller, policy) = acting;
    let task = Task {
        policy,
        to_decision: keep.to_decision(),
        rigour: Rigour::default(),
    };
    let (figures, read_out) = ride_one(scene, controller, recorder, task, on_tick)?;
    trace.read_out = read_out;
    Ok((figures, trace))
}

/// Runs one policy to the end of the scene, its rows given to a recorder as they come.
///
/// # Errors
/// As [`run`].
pub fn record(
    scene: &Scene,
    kind: PolicyKind,
    recorder: &mut dyn Recorder,
    rigour: Rigour,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Option<ReadOut>), RunError> {
    let policy = kind.name();
    let acting = controller(kind, scene).ok_or(RunError::Incomplete { policy })?;
    let task = Task::to_the_end(policy, rigour);
    ride_one(scene, acting, Some(recorder), task, on_tick)
}

/// Who is given the rows of a machine's run.
pub struct MachineRecorders<'a> {
    /// Of each plane, in their order.
    pub planes: Vec<&'a mut dyn Recorder>,
    /// Of the rotor's axis, at control samples.
    pub axis: Option<&'a mut dyn Recorder<AxisRow>>,
}

/// What one plane of a machine came to, and what its supervisor leaves behind.
pub type PlaneEnded = (Figures, Option<ReadOut>);

/// Runs one policy on a whole rotor to the end of its scene, a controller for each plane; rows go to the recorders as they
/// come. What comes back is of each plane.
///
/// # Errors
/// As [`run`].
pub fn record_machine<'a>(
    scene: &'a MachineScene,
    kind: PolicyKind,
    recorders: MachineRecorders<'a>,
    rigour: Rigour,
    on_tick: &mut dyn FnMut(u64),
) -> Result<Vec<PlaneEnded>, RunError> {
    let task = Task::to_the_end(kind.name(), rigour);
    bench_of_machine(scene, kind, recorders, task)?.ride(task, on_tick)
}

fn bench_of_machine<'a>(
    scene: &'a MachineScene,
    kind: PolicyKind,
    recorders: MachineRecorders<'a>,
    task: Task,
) -> Result<Bench<'a>, RunError> {
    let policy = task.policy;
    let supervisor = match kind {
        PolicyKind::Supervisor => scene.supervisor(),
        _ => None,
    };
    let whole = (scene.levitation.is_some(), supervisor.is_some());
    let controller = |plane: &Scene| controller_of_plane(kind, plane, whole);
    let mut bench = machine_bench(scene, (&controller, recorders.planes), task)?;
    bench.levitated_by(scene.levitation.as_ref(), policy)?;
    bench.supervisor = supervisor.zip(scene.supervised());
    bench.axis = recorders.axis;
    Ok(bench)
}

/// Runs a reference on a whole rotor; what comes back is of each plane. [`Keep`] says when it ends; no rows are kept.
///
/// # Errors
/// As [`run`].
pub fn refer_machine(
    scene: &MachineScene,
    reference: &WholeReference,
    keep: Keep,
) -> Result<Vec<Figures>, RunError> {
    let task = Task {
        policy: "clairvoyant",
        to_decision: keep.to_decision(),
        rigour: Rigour::default(),
    };
    let controller = |_: &Scene| -> Option<Box<dyn Controller>> { Some(Box::new(Referred)) };
    let mut bench = machine_bench(scene, (&controller, Vec::new()), task)?;
    bench.reference = Some(reference);
    let ended = bench.ride(task, &mut |_| {})?;
    Ok(ended.into_iter().map(|(figures, _)| figures).collect())
}

/// Sets up the controller of a plane; `None` where the plane lacks something.
type ControllerOf<'f> = &'f dyn Fn(&Scene) -> Option<Box<dyn Controller>>;

/// A whole rotor in the loop, nobody holding it as a whole.
fn machine_bench<'a>(
    scene: &'a MachineScene,
    (controller_of, recorders): (ControllerOf<'_>, Vec<&'a mut dyn Recorder>),
    task: Task,
) -> Result<Bench<'a>, RunError> {
    let common = scene.common();
    let rig = WholeRotor::new(scene, options(common, task.rigour))?;
    let mut recorders = recorders.into_iter();
    let mut stations = Vec::new();
    for plane in &scene.planes {
        let controller = controller_of(&plane.scene).ok_or(RunError::Incomplete {
            policy: task.policy,
        })?;
        let mut station = Station::new(&plane.scene, controller, recorders.next());
        station.seal = plane.seal;
        stations.push(station);
    }
    let loads = (scene.loads.iter()).map(|load| Loads::new(V2::zeros(), vec![*load]));
    Ok(Bench::new(
        common,
        Box::new(rig),
        stations,
        (loads.collect(), scene.edges()),
    ))
}

/// A run as it is asked for.
#[derive(Debug, Clone, Copy)]
struct Task {
    policy: &'static str,
    to_decision: bool,
    rigour: Rigour,
}

impl Task {
    fn to_the_end(policy: &'static str, rigour: Rigour) -> Self {
        Self {
            policy,
            to_decision: false,
            rigour,
        }
    }
}

fn options(scene: &Scene, rigour: Rigour) -> Options {
    Options {
        rtol: scene.rtol,
        method: scene.method,
        steps: rigour.steps,
        ..Options::default()
    }
}

fn ride_one<'a>(
    scene: &'a Scene,
    controller: Box<dyn Controller>,
    recorder: Option<&'a mut dyn Recorder>,
    task: Task,
    on_tick: &mut dyn FnMut(u64),
) -> Result<PlaneEnded, RunError> {
    let bench = bench_of_one(scene, controller, recorder, task)?;
    let ended = bench.ride(task, on_tick)?.pop();
    ended.ok_or(RunError::Incomplete {
        policy: task.policy,
    })
}

fn bench_of_one<'a>(
    scene: &'a Scene,
    controller: Box<dyn Controller>,
    recorder: Option<&'a mut dyn Recorder>,
    task: Task,
) -> Result<Bench<'a>, RunError> {
    let rigid = matches!(
        scene.plant.stator,
        StatorParams::Rigid | StatorParams::RigidEllipse(_)
    );
    if !scene.base_motions.is_empty() && !rigid {
        return Err(RunError::BaseMotionOnRings);
    }
    let rig = OnePlane::new(scene, options(scene, task.rigour))?;
    let stations = vec![Station::new(scene, controller, recorder)];
    let loads = (vec![scene.external()], scene.edges());
    let mut bench = Bench::new(scene, Box::new(rig), stations, loads);
    bench.levitated_by(scene.controller.as_ref(), task.policy)?;
    Ok(bench)
}
