//! One policy on one scene, as firmware would run it: sample, compute, and a command that takes
//! effect at the next sample.

use crate::device::actuator::Amplifier;
use crate::device::loads::cuts;
use crate::device::sensor::Sensor;
use crate::device::sensor_fault::seen_until_s;
use crate::run::controller::{Controller, Force, Seen, controller};
use crate::run::figures::{Ended, Figures};
use crate::run::judge::Judge;
use crate::run::trace::{ReadOut, Recorder, Said, Trace, TraceRow};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::params::StatorParams;
use plant_model::{BuildError, Inputs, Options, Plant, PlantError, Snapshot, V2};
use supervisor::{Events, Status};

/// Why a run has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The plant's parameters are out of range.
    #[error(transparent)]
    Build(#[from] BuildError),
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
    let (figures, read_out) = ride(
        scene,
        acting,
        (recorder, keep.to_decision()),
        Rigour::default(),
        on_tick,
    )?;
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
    ride(
        scene,
        (acting, policy),
        (Some(recorder), false),
        rigour,
        on_tick,
    )
}

fn ride<'a>(
    scene: &'a Scene,
    (controller, policy): (Box<dyn Controller>, &'static str),
    (recorder, to_decision): (Option<&'a mut dyn Recorder>, bool),
    rigour: Rigour,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Figures, Option<ReadOut>), RunError> {
    const REPORT_EVERY: u64 = 1024;
    let options = Options {
        rtol: scene.rtol,
        method: scene.method,
        steps: rigour.steps,
        ..Options::default()
    };
    let rigid = matches!(
        scene.plant.stator,
        StatorParams::Rigid | StatorParams::RigidEllipse(_)
    );
    if !scene.base_motions.is_empty() && !rigid {
        return Err(RunError::BaseMotionOnRings);
    }
    let plant = scene.build(options)?;
    let period_s = 1.0 / scene.sample_rate_hz;
    let force_max_n = scene.plant.magnet.map_or(0.0, |m| m.force_max_n);
    let mut bench = Bench {
        scene,
        policy_name: policy,
        finer: rigour.parts,
        plant,
        sensor: Sensor::new(scene.sensor, &scene.faults, period_s, scene.seed),
        controller,
        amplifier: Amplifier::new(scene.amplifier, force_max_n, &scene.outages),
        judge: Judge::new(scene),
        recorder,
        edges_s: scene.edges(),
        edge_s: f64::NEG_INFINITY,
        steady_n: None,
        changes_done: 0,
        changes: Vec::new(),
        said: None,
    };
    let ticks = scene.samples().count();
    for tick in 0..ticks {
        bench.tick(tick)?;
        if (tick + 1) % REPORT_EVERY == 0 {
            on_tick(REPORT_EVERY);
        }
        if to_decision && bench.judge.decided(bench.plant.as_ref()) {
            break;
        }
    }
    on_tick(ticks % REPORT_EVERY);
    let last = bench.plant.snapshot();
    bench.judge.sample(&last);
    bench.record(&last, scene.from_magnets_m(last.position_m), false);
    let figures = Figures::new(&Ended::new(scene, &bench.judge, bench.plant.as_ref()));
    let residual = figures.energy_residual;
    let limit = (TRUSTED_TOLERANCES * scene.rtol).clamp(TRUSTED.0, TRUSTED.1);
    if residual.is_nan() || residual > limit {
        return Err(RunError::Energy {
            policy,
            residual,
            limit,
        });
    }
    let read_out = bench.recorder.and_then(|_| bench.controller.read_out());
    Ok((figures, read_out))
}

struct Bench<'a> {
    scene: &'a Scene,
    policy_name: &'static str,
    /// As [`Rigour::parts`].
    finer: u32,
    plant: Box<dyn Plant>,
    sensor: Sensor,
    controller: Box<dyn Controller>,
    amplifier: Amplifier,
    judge: Judge,
    recorder: Option<&'a mut dyn Recorder>,
    edges_s: Vec<f64>,
    /// The next of them.
    edge_s: f64,
    /// External force up to there, where it does not vary \[N\].
    steady_n: Option<V2>,
    /// Changes that lie behind.
    changes_done: usize,
    /// Changes of mode within an advance: a buffer.
    changes: Vec<Snapshot>,
    /// What the supervisor said to the last sample.
    said: Option<Said>,
}

impl Bench<'_> {
    fn tick(&mut self, tick: u64) -> Result<(), RunError> {
        let period = 1.0 / self.scene.sample_rate_hz;
        let (t, t_next) = (tick as f64 * period, (tick + 1) as f64 * period);
        self.amplifier.begin(tick);
        let now = self.plant.snapshot();
        let reading = (self.sensor).read(t, self.scene.from_magnets_m(now.position_m));
        let seen = Seen {
            reading,
            spin_rad_s: self.scene.spin_sensor.gain * now.spin_rad_s,
            applied_n: if self.scene.amplifier.force_measured {
                // What is fed forward the supervisor does not know of: with the weight it is nothing.
                now.delivered_n - self.scene.feed_forward_n
            } else {
                V2::zeros()
            },
            status: self.status(seen_until_s(t, period)),
        };
        let with_weight = |force_n: V2| force_n + self.scene.feed_forward_n;
        match self.controller.command(&seen, &now) {
            Force::Computed(force_n) => self.amplifier.command(tick, with_weight(force_n)),
            Force::AtOnce(force_n) => self.amplifier.command_at_once(with_weight(force_n)),
        }
        self.judge.sample(&now);
        self.said = self.controller.said();
        self.record(&now, reading.position_m, false);
        // What happened at this sample is not to be read a second time.
        if let Some(said) = &mut self.said {
            said.events = Events::empty();
        }

        let mut from = t;
        while from < t_next {
            if from >= self.edge_s {
                self.pass_edges(from)?;
            }
            let to = self.edge_s.min(t_next);
            let loads = match self.steady_n {
                Some(_) => None,
                None => self.scene.parts(from, to),
            };
            let measured_m = reading.position_m;
            let advanced = match loads.max(self.amplifier.parts(from)) {
                None => self.advance_steadily((from, to), measured_m),
                Some(parts) => self.advance_by_parts((from, to), parts * self.finer, measured_m),
            };
            advanced.map_err(|reason| RunError::Plant {
                policy: self.policy_name,
                reason,
            })?;
            from = to;
        }
        Ok(())
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

    /// Makes the changes that are due, and looks at what acts up to the next edge.
    fn pass_edges(&mut self, t_s: f64) -> Result<(), RunError> {
        let next = self.edges_s.iter().find(|edge| **edge > t_s);
        self.edge_s = next.copied().unwrap_or(f64::INFINITY);
        let [now_n, _] = self.scene.external_n(t_s, t_s);
        self.steady_n = (self.scene.parts(t_s, t_s).is_none()).then_some(now_n);
        while let Some(due) = self.scene.changes.get(self.changes_done)
            && due.at_s <= t_s
        {
            self.plant.change(&due.change).map_err(BuildError::Param)?;
            self.changes_done += 1;
        }
        Ok(())
    }

    fn advance_steadily(
        &mut self,
        (from_s, to_s): (f64, f64),
        measured_m: V2,
    ) -> Result<(), PlantError> {
        let [command_n, _] = self.amplifier.deliver(from_s, to_s);
        let external_n = self.steady_n.unwrap_or_default();
        self.advance(to_s, (command_n, external_n), measured_m)
    }

    fn advance_by_parts(
        &mut self,
        stretch_s: (f64, f64),
        parts: u32,
        measured_m: V2,
    ) -> Result<(), PlantError> {
        for [begin, middle, end] in cuts(stretch_s, parts) {
            let commands_n = self.amplifier.deliver(begin, end);
            let external_n = match self.steady_n {
                Some(steady_n) => [steady_n; 2],
                None => self.scene.external_n(begin, end),
            };
            self.advance(middle, (commands_n[0], external_n[0]), measured_m)?;
            self.advance(end, (commands_n[1], external_n[1]), measured_m)?;
        }
        Ok(())
    }

    fn advance(
        &mut self,
        to_s: f64,
        (command_n, external_n): (V2, V2),
        measured_m: V2,
    ) -> Result<(), PlantError> {
        let inputs = Inputs {
            command_n,
            external_n,
        };
        let mut changes = std::mem::take(&mut self.changes);
        (self.plant).advance(to_s, &inputs, &mut |snapshot| changes.push(*snapshot))?;
        for snapshot in changes.drain(..) {
            self.judge.change(&snapshot);
            self.record(&snapshot, measured_m, true);
        }
        self.changes = changes;
        Ok(())
    }

    fn record(&mut self, plant: &Snapshot, measured_m: V2, mode_change: bool) {
        let Some(recorder) = &mut self.recorder else {
            return;
        };
        recorder.row(&TraceRow {
            plant: *plant,
            measured_m,
            commanded_n: self.amplifier.in_effect_n(),
            supervisor: self.said,
            mode_change,
        });
    }
}
