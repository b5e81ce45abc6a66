//! One policy on one scene, as firmware would run it: sample, compute, and a command that takes
//! effect at the next sample.

use crate::device::actuator::Amplifier;
use crate::device::loads::{Loads, cuts};
use crate::device::modal_levitation::{ModalLevitation, any_holds};
use crate::device::sensor::Sensor;
use crate::device::sensor_fault::seen_until_s;
use crate::run::controller::{Controller, Force, Seen, controller, controller_below};
use crate::run::figures::{Ended, Figures};
use crate::run::judge::Judge;
use crate::run::rig::{OnePlane, Rig, WholeRotor};
use crate::run::trace::{AxisRow, ReadOut, Recorder, Said, Trace, TraceRow};
use crate::scene::Scene;
use crate::scene::machine::MachineScene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::machine::params::MachineError;
use plant_model::params::StatorParams;
use plant_model::{BuildError, Options, PlantError, Snapshot, V2};
use supervisor::{Events, Status};

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
    let task = Task {
        policy,
        to_decision: false,
        rigour,
    };
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
    let policy = kind.name();
    let task = Task {
        policy,
        to_decision: false,
        rigour,
    };
    let below = match scene.levitation {
        Some(_) => controller_below,
        None => controller,
    };
    let common = scene.common();
    let rig = WholeRotor::new(scene, options(common, rigour))?;
    let levitation = (scene.levitation.as_ref())
        .map(|params| ModalLevitation::new(params, 1.0 / common.sample_rate_hz));
    let mut recorders_of = recorders.planes.into_iter();
    let mut stations = Vec::new();
    for plane in &scene.planes {
        let controller = below(kind, &plane.scene).ok_or(RunError::Incomplete { policy })?;
        stations.push(Station::new(&plane.scene, controller, recorders_of.next()));
    }
    let loads = scene
        .loads
        .iter()
        .map(|load| Loads::new(V2::zeros(), vec![*load]));
    let bench = Bench::new(
        common,
        Box::new(rig),
        stations,
        (loads.collect(), scene.edges()),
    );
    Bench {
        levitation,
        axis: recorders.axis,
        ..bench
    }
    .ride(task, on_tick)
}

/// A run as it is asked for.
#[derive(Debug, Clone, Copy)]
struct Task {
    policy: &'static str,
    to_decision: bool,
    rigour: Rigour,
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
    let bench = Bench::new(scene, Box::new(rig), stations, loads);
    let ended = bench.ride(task, on_tick)?.pop();
    ended.ok_or(RunError::Incomplete {
        policy: task.policy,
    })
}

/// A bearing plane: what stands there, who drives its magnet, who watches.
struct Station<'a> {
    scene: &'a Scene,
    sensor: Sensor,
    controller: Box<dyn Controller>,
    amplifier: Amplifier,
    judge: Judge,
    recorder: Option<&'a mut dyn Recorder>,
    /// The last reading of the position \[m\].
    measured_m: V2,
    /// What the supervisor said to the last sample.
    said: Option<Said>,
}

impl<'a> Station<'a> {
    fn new(
        scene: &'a Scene,
        controller: Box<dyn Controller>,
        recorder: Option<&'a mut dyn Recorder>,
    ) -> Self {
        let period_s = 1.0 / scene.sample_rate_hz;
        let force_max_n = scene.plant.magnet.map_or(0.0, |m| m.force_max_n);
        Self {
            scene,
            sensor: Sensor::new(scene.sensor, &scene.faults, period_s, scene.seed),
            controller,
            amplifier: Amplifier::new(scene.amplifier, force_max_n, &scene.outages),
            judge: Judge::new(scene),
            recorder,
            measured_m: V2::zeros(),
            said: None,
        }
    }

    /// What firmware knows at a tick.
    fn see(&mut self, t_s: f64, sensed_m: V2, now: &Snapshot) -> Seen {
        let reading = (self.sensor).read(t_s, sensed_m, now.spin_rad_s);
        self.measured_m = reading.position_m;
        Seen {
            reading,
            spin_rad_s: self.scene.spin_sensor.gain * now.spin_rad_s,
            applied_n: if self.scene.amplifier.force_measured {
                // What is fed forward the supervisor does not know of: with the weight it is nothing.
                now.delivered_n - self.scene.feed_forward_n
            } else {
                V2::zeros()
            },
            status: self.status(seen_until_s(t_s, 1.0 / self.scene.sample_rate_hz)),
            levitation_n: V2::zeros(),
        }
    }

    fn answer(&mut self, tick: u64, seen: &Seen, now: &Snapshot) {
        let with_weight = |force_n: V2| force_n + self.scene.feed_forward_n;
        match self.controller.command(seen, now) {
            Force::Computed(force_n) => self.amplifier.command(tick, with_weight(force_n)),
            Force::AtOnce(force_n) => self.amplifier.command_at_once(with_weight(force_n)),
        }
        self.judge.sample(now);
        self.said = self.controller.said();
        self.record(now, false);
        // What happened at this sample is not to be read a second time.
        if let Some(said) = &mut self.said {
            said.events = Events::empty();
        }
    }

    /// What the firmware knows to be valid and ready at a time.
    fn status(&self, t_s: f64) -> Status {
        let mut status = Status::empty();
        status.set(Status::SPIN_VALID, self.scene.spin_sensor.valid);
        let measured = self.scene.amplifier.force_measured;
        status.set(Status::APPLIED_VALID, measured);
        let [x_off, y_off] = self.amplifier.known_off(t_s);
        status.set(Status::BEARING_ON, !(x_off && y_off));
        status.set(Status::AXIS_X_LOST, x_off);
        status.set(Status::AXIS_Y_LOST, y_off);
        status
    }

    fn record(&mut self, plant: &Snapshot, mode_change: bool) {
        let Some(recorder) = &mut self.recorder else {
            return;
        };
        recorder.row(&TraceRow {
            plant: *plant,
            measured_m: self.measured_m,
            commanded_n: self.amplifier.in_effect_n(),
            supervisor: self.said,
            mode_change,
        });
    }
}

struct Bench<'a> {
    /// What holds for all planes.
    scene: &'a Scene,
    rig: Box<dyn Rig + 'a>,
    stations: Vec<Station<'a>>,
    /// Who levitates the rotor as a whole.
    levitation: Option<ModalLevitation>,
    axis: Option<&'a mut dyn Recorder<AxisRow>>,
    /// What acts at each place for loads.
    loads: Vec<Loads>,
    edges_s: Vec<f64>,
    /// The next of them.
    edge_s: f64,
    /// Whether nothing varies up to there.
    steady: bool,
    /// Changes that lie behind.
    changes_done: usize,
    // Buffers: planes at a sample, what is seen and commanded there, forces that are held, changes of mode within an advance.
    now: Vec<Snapshot>,
    seen: Vec<Seen>,
    levitation_n: Vec<V2>,
    commands_n: [Vec<V2>; 2],
    loads_n: [Vec<V2>; 2],
    changes: Vec<(usize, Snapshot)>,
    axis_row: AxisRow,
}

impl<'a> Bench<'a> {
    fn new(
        scene: &'a Scene,
        rig: Box<dyn Rig + 'a>,
        stations: Vec<Station<'a>>,
        (loads, edges_s): (Vec<Loads>, Vec<f64>),
    ) -> Self {
        let (planes, places) = (stations.len(), loads.len());
        Self {
            scene,
            rig,
            stations,
            levitation: None,
            axis: None,
            loads,
            edges_s,
            edge_s: f64::NEG_INFINITY,
            steady: true,
            changes_done: 0,
            now: Vec::with_capacity(planes),
            seen: Vec::with_capacity(planes),
            levitation_n: vec![V2::zeros(); planes],
            commands_n: [vec![V2::zeros(); planes], vec![V2::zeros(); planes]],
            loads_n: [vec![V2::zeros(); places], vec![V2::zeros(); places]],
            changes: Vec::new(),
            axis_row: AxisRow::default(),
        }
    }

    /// To the end of the scene.
    fn ride(
        mut self,
        task: Task,
        on_tick: &mut dyn FnMut(u64),
    ) -> Result<Vec<PlaneEnded>, RunError> {
        const REPORT_EVERY: u64 = 1024;
        let ticks = self.scene.samples().count();
        for tick in 0..ticks {
            self.tick(tick, task)?;
            if (tick + 1) % REPORT_EVERY == 0 {
                on_tick(REPORT_EVERY);
            }
            if task.to_decision && self.decided() {
                break;
            }
        }
        on_tick(ticks % REPORT_EVERY);
        self.rig.read(&mut self.now);
        let mut ended = Vec::with_capacity(self.stations.len());
        for (plane, (station, last)) in self.stations.iter_mut().zip(&self.now).enumerate() {
            station.judge.sample(last);
            station.measured_m = station.scene.from_magnets_m(last.position_m);
            station.record(last, false);
            let run = Ended::new(station.scene, &station.judge, &*self.rig, (plane, last));
            ended.push((
                Figures::new(&run),
                (station.recorder.as_ref()).and_then(|_| station.controller.read_out()),
            ));
        }
        self.record_axis();
        let residual = self.rig.audit().residual();
        let limit = (TRUSTED_TOLERANCES * self.scene.rtol).clamp(TRUSTED.0, TRUSTED.1);
        if residual.is_nan() || residual > limit {
            return Err(RunError::Energy {
                policy: task.policy,
                residual,
                limit,
            });
        }
        Ok(ended)
    }

    /// Whether nothing can change any more of whether the rotor has recovered.
    fn decided(&self) -> bool {
        let stations = self.stations.iter().enumerate();
        let mut decided = stations.map(|(plane, s)| s.judge.decided(&self.rig.meters(plane)));
        decided.all(|decided| decided)
    }

    fn tick(&mut self, tick: u64, task: Task) -> Result<(), RunError> {
        let period = 1.0 / self.scene.sample_rate_hz;
        let (t, t_next) = (tick as f64 * period, (tick + 1) as f64 * period);
        self.rig.read(&mut self.now);
        self.seen.clear();
        for (plane, (station, now)) in self.stations.iter_mut().zip(&self.now).enumerate() {
            station.amplifier.begin(tick);
            let sensed_m = self.rig.sensed_m(plane, now);
            self.seen.push(station.see(t, sensed_m, now));
        }
        self.levitate();
        for (i, station) in self.stations.iter_mut().enumerate() {
            station.answer(tick, &self.seen[i], &self.now[i]);
        }
        self.record_axis();

        let mut from = t;
        while from < t_next {
            if from >= self.edge_s {
                self.pass_edges(from)?;
            }
            let to = self.edge_s.min(t_next);
            let parts = self.parts(from, to);
            let advanced = match parts {
                None => self.advance_steadily(from, to),
                Some(parts) => self.advance_by_parts((from, to), parts * task.rigour.parts),
            };
            advanced.map_err(|reason| RunError::Plant {
                policy: task.policy,
                reason,
            })?;
            from = to;
        }
        Ok(())
    }

    /// The levitation controller of the whole rotor, where there is one.
    fn levitate(&mut self) {
        let Some(levitation) = &mut self.levitation else {
            return;
        };
        let hold = any_holds(self.stations.iter().map(|s| s.controller.hint()));
        let readings = self.seen.iter().map(|seen| seen.reading.position_m);
        let spin_rad_s = self.seen.first().map_or(0.0, |seen| seen.spin_rad_s);
        levitation.forces_n(readings, spin_rad_s, hold, &mut self.levitation_n);
        for (seen, force_n) in self.seen.iter_mut().zip(&self.levitation_n) {
            seen.levitation_n = *force_n;
        }
    }

    /// Parts over whose halves what varies is to be held; `None` where nothing does.
    fn parts(&self, from_s: f64, to_s: f64) -> Option<u32> {
        let loads = match self.steady {
            true => None,
            false => self
                .loads
                .iter()
                .filter_map(|l| l.parts(from_s, to_s))
                .max(),
        };
        let ramps = self
            .stations
            .iter()
            .filter_map(|s| s.amplifier.parts(from_s));
        loads.max(ramps.max())
    }

    /// Makes the changes that are due, and looks at what acts up to the next edge.
    fn pass_edges(&mut self, t_s: f64) -> Result<(), RunError> {
        let next = self.edges_s.iter().find(|edge| **edge > t_s);
        self.edge_s = next.copied().unwrap_or(f64::INFINITY);
        self.steady = self.loads.iter().all(|l| l.parts(t_s, t_s).is_none());
        for (load, held_n) in self.loads.iter().zip(&mut self.loads_n[0]) {
            [*held_n, _] = load.halves_n(t_s, t_s);
        }
        while let Some(due) = self.scene.changes.get(self.changes_done)
            && due.at_s <= t_s
        {
            self.rig.change(&due.change)?;
            self.changes_done += 1;
        }
        Ok(())
    }

    fn advance_steadily(&mut self, from_s: f64, to_s: f64) -> Result<(), PlantError> {
        self.deliver(from_s, to_s);
        self.advance(to_s, 0, 0)
    }

    fn advance_by_parts(&mut self, stretch_s: (f64, f64), parts: u32) -> Result<(), PlantError> {
        for [begin, middle, end] in cuts(stretch_s, parts) {
            self.deliver(begin, end);
            let second = match self.steady {
                true => 0,
                false => {
                    self.hold_loads(begin, end);
                    1
                }
            };
            self.advance(middle, 0, 0)?;
            self.advance(end, 1, second)?;
        }
        Ok(())
    }

    /// What the amplifiers deliver over the halves of a stretch.
    fn deliver(&mut self, from_s: f64, to_s: f64) {
        for (i, station) in self.stations.iter_mut().enumerate() {
            let halves_n = station.amplifier.deliver(from_s, to_s);
            [self.commands_n[0][i], self.commands_n[1][i]] = halves_n;
        }
    }

    fn hold_loads(&mut self, from_s: f64, to_s: f64) {
        for (i, load) in self.loads.iter().enumerate() {
            [self.loads_n[0][i], self.loads_n[1][i]] = load.halves_n(from_s, to_s);
        }
    }

    /// With what was laid down for one of two halves.
    fn advance(&mut self, to_s: f64, commands: usize, loads: usize) -> Result<(), PlantError> {
        let (commands_n, loads_n) = (&self.commands_n[commands], &self.loads_n[loads]);
        (self.rig).advance(to_s, commands_n, loads_n, &mut self.changes)?;
        for (plane, snapshot) in self.changes.drain(..) {
            let station = &mut self.stations[plane];
            station.judge.change(&snapshot);
            station.record(&snapshot, true);
        }
        Ok(())
    }

    fn record_axis(&mut self) {
        if let Some(recorder) = &mut self.axis {
            self.rig.read_axis(&mut self.axis_row);
            recorder.row(&self.axis_row);
        }
    }
}
