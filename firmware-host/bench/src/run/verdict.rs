//! Outcome of a run: figures, how long it took, and what stands beside them.

use crate::run::figures::{Figures, Timing, Took};
use crate::run::overview::AxisTrack;
use crate::run::supervision::{Happenings, Supervision};
use crate::run::trace::Trace;
use crate::run::verify::Verification;
use crate::scene::Scene;
use serde::Serialize;
use std::time::Duration;

/// Figures of one policy on one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Its outcome.
    #[serde(flatten)]
    pub figures: Figures,
    /// How long it took.
    #[serde(flatten)]
    pub timing: Timing,
}

impl Verdict {
    /// Of a run of a scene to its end.
    pub fn new(figures: Figures, scene: &Scene, elapsed: Duration) -> Self {
        let simulated_s = scene.simulated_s();
        let took = Took {
            simulated_s,
            elapsed,
        };
        Self {
            figures,
            timing: Timing::new(&took),
        }
    }
}

/// One policy's run, as one plane saw it or as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicyRun {
    /// Name of the policy, e.g. `supervisor`.
    pub name: String,
    /// Its outcome.
    pub verdict: Verdict,
    /// What running it again with other means says, where that was asked for.
    pub verification: Option<Result<Verification, String>>,
    /// What the supervisor did, where one ran.
    pub supervision: Option<Supervision>,
    /// At which samples something happened to it.
    pub happenings: Happenings,
    /// Its rows, of a long run those that stand out.
    pub trace: Trace,
}

impl PolicyRun {
    /// What its checks say, where they were asked for and can be trusted.
    pub fn checked(&self) -> Option<&Verification> {
        self.verification.as_ref()?.as_ref().ok()
    }
}

/// One policy's run of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineRun {
    /// Its outcome as a whole; its rows are those of the planes.
    pub whole: PolicyRun,
    /// Its planes, each under the name of the policy.
    pub planes: Vec<PolicyRun>,
    /// The rotor's axis over time; empty of a rotor that is a point.
    pub axis: AxisTrack,
}

/// A policy whose run cannot be trusted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FailedRun {
    /// Name of the policy.
    pub name: String,
    /// The named error that ended it.
    pub error: String,
}

/// Outcome of a scene, policy by policy.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Results {
    /// Runs as a whole, in the scene's order.
    pub runs: Vec<PolicyRun>,
    /// Of each plane, the runs in that order.
    pub planes: Vec<Vec<PolicyRun>>,
    /// The axis of each run.
    pub axes: Vec<AxisTrack>,
    /// The others, in the scene's order.
    pub failed: Vec<FailedRun>,
}

impl Results {
    /// With one more run.
    pub fn push(&mut self, run: MachineRun) {
        self.planes.resize_with(run.planes.len(), Vec::new);
        for (runs, plane) in self.planes.iter_mut().zip(run.planes) {
            runs.push(plane);
        }
        self.runs.push(run.whole);
        self.axes.push(run.axis);
    }

    /// Why what cannot be trusted cannot: runs, and runs whose checks cannot. Each names its policy.
    pub fn untrusted(&self) -> Vec<&str> {
        let checks = self.runs.iter().filter_map(|run| run.verification.as_ref());
        (self.failed.iter().map(|failed| &failed.error))
            .chain(checks.filter_map(|checked| checked.as_ref().err()))
            .map(String::as_str)
            .collect()
    }
}

/// Which runs went so far into the wall that their figures from there on say nothing of a machine.
pub(crate) fn far_into_the_wall(runs: &[PolicyRun], clearance_m: f64) -> Option<String> {
    let is_far = |run: &&PolicyRun| run.verdict.figures.peak_penetration_m > clearance_m;
    let names: Vec<&str> = (runs.iter().filter(is_far))
        .map(|run| run.name.as_str())
        .collect();
    let who = names.join(", ");
    let note = "the wall gave way by more than the clearance: the model does not hold for any machine from there on";
    (!names.is_empty()).then(|| format!("{who}: {note}"))
}
