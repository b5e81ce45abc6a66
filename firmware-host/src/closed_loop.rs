//! One policy on one scene, as firmware would run it: sample, compute, and a command that takes
//! effect at the next sample.

use crate::instruments::Sensor;
use crate::judge::Judge;
use crate::policies::Policy;
use crate::policy_kind::PolicyKind;
use crate::scene::Scene;
use crate::trace::{Trace, TraceRow};
use crate::verdict::Verdict;
use plant_model::{BuildError, Inputs, Options, Plant, PlantError, Snapshot, V2, build};
use std::time::Instant;

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
    /// The scene lacks something that the policy needs.
    #[error("policy {policy} needs more than the scene gives")]
    Incomplete {
        /// The policy.
        policy: &'static str,
    },
}

/// A run whose energy residual exceeds this many tolerances is not trusted. Runs keep within ten.
const TRUSTED_RESIDUAL: f64 = 1e3;

/// Whether a run keeps its rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Every row.
    Trace,
    /// Only the verdict.
    Verdict,
    /// Only the verdict, and the run ends as soon as nothing can change whether the rotor has recovered.
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
) -> Result<(Verdict, Trace), RunError> {
    let policy = Policy::new(kind, scene).ok_or(RunError::Incomplete {
        policy: kind.name(),
    })?;
    run_policy(scene, (policy, kind.name()), keep, on_tick)
}

/// Runs a policy that has been set up, under a name.
///
/// # Errors
/// As [`run`].
pub fn run_policy(
    scene: &Scene,
    (acting, policy): (Policy, &'static str),
    keep: Keep,
    on_tick: &mut dyn FnMut(u64),
) -> Result<(Verdict, Trace), RunError> {
    const REPORT_EVERY: u64 = 1024;
    let started = Instant::now();
    let options = Options {
        rtol: scene.rtol,
        method: scene.method,
        ..Options::default()
    };
    let plant = build(&scene.plant, &scene.start, options)?;
    let mut bench = Bench {
        scene,
        plant,
        sensor: Sensor::new(scene.sensor, scene.seed),
        policy: acting,
        register_n: V2::zeros(),
        judge: Judge::new(scene),
        keep,
        trace: Trace::default(),
        edges_s: edges(scene),
    };
    let ticks = (scene.duration_s * scene.sample_rate_hz).round().max(1.0) as u64;
    for tick in 0..ticks {
        bench
            .tick(tick)
            .map_err(|reason| RunError::Plant { policy, reason })?;
        if (tick + 1) % REPORT_EVERY == 0 {
            on_tick(REPORT_EVERY);
        }
        if keep.to_decision() && bench.judge.decided(bench.plant.as_ref()) {
            break;
        }
    }
    on_tick(ticks % REPORT_EVERY);
    let last = bench.plant.snapshot();
    bench.judge.sample(&last);
    bench.record(&last, last.position_m, false);
    let verdict = bench
        .judge
        .verdict(scene, bench.plant.as_ref(), started.elapsed());
    let (residual, limit) = (verdict.energy_residual, TRUSTED_RESIDUAL * scene.rtol);
    if residual.is_nan() || residual > limit {
        return Err(RunError::Energy {
            policy,
            residual,
            limit,
        });
    }
    Ok((verdict, bench.trace))
}

/// Times at which the external force changes \[s\], in order.
fn edges(scene: &Scene) -> Vec<f64> {
    let mut edges: Vec<f64> = (scene.disturbances.iter())
        .flat_map(|d| [d.start_s, d.end_s()])
        .collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}

struct Bench<'a> {
    scene: &'a Scene,
    plant: Box<dyn Plant>,
    sensor: Sensor,
    policy: Policy,
    /// Command computed at the last sample, in effect from this one.
    register_n: V2,
    judge: Judge,
    keep: Keep,
    trace: Trace,
    edges_s: Vec<f64>,
}

impl Bench<'_> {
    fn tick(&mut self, tick: u64) -> Result<(), PlantError> {
        let period = 1.0 / self.scene.sample_rate_hz;
        let (t, t_next) = (tick as f64 * period, (tick + 1) as f64 * period);
        let now = self.plant.snapshot();
        let measured_m = self.sensor.read(now.position_m);
        let next_n = self.policy.tick(measured_m, now.spin_rad_s);
        let truth_n = self.policy.of_truth(&now);
        self.register_n = truth_n.unwrap_or(self.register_n);
        self.judge.sample(&now);
        self.record(&now, measured_m, false);

        let mut from = t;
        while from < t_next {
            let edge = self.edges_s.iter().copied().find(|e| *e > from);
            let to = edge.map_or(t_next, |e| e.min(t_next));
            self.advance(from, to, measured_m)?;
            from = to;
        }
        self.register_n = next_n;
        Ok(())
    }

    fn advance(&mut self, from_s: f64, to_s: f64, measured_m: V2) -> Result<(), PlantError> {
        let inputs = Inputs {
            command_n: self.register_n + self.scene.feed_forward_n,
            external_n: self.scene.external_n(from_s),
        };
        let mut changes: [Option<Snapshot>; 8] = [None; 8];
        let mut extra = Vec::new();
        let mut count = 0;
        self.plant.advance(to_s, &inputs, &mut |snapshot| {
            match changes.get_mut(count) {
                Some(slot) => *slot = Some(*snapshot),
                None => extra.push(*snapshot),
            }
            count += 1;
        })?;
        for snapshot in changes.iter().flatten().chain(&extra) {
            self.judge.change(snapshot);
            self.record(snapshot, measured_m, true);
        }
        Ok(())
    }

    fn record(&mut self, plant: &Snapshot, measured_m: V2, mode_change: bool) {
        if !self.keep.rows() {
            return;
        }
        self.trace.rows.push(TraceRow {
            plant: *plant,
            measured_m,
            commanded_n: self.register_n + self.scene.feed_forward_n,
            supervisor_mode: self.policy.supervisor_mode(),
            mode_change,
        });
    }
}
