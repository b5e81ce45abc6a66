//! Runs of the catalogue and what they measured.

use super::case::{Case, seeded};
use super::contenders::Contender;
use crate::machines::tuned_gains::TunedGains;
use firmware_bench::run::closed_loop::{Keep, run, run_policy};
use firmware_bench::run::figures::Figures;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use serde::Serialize;

/// Group of the user's own scenes.
const OWN: &str = "own scenes";

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResultRow {
    /// Kind of overload.
    pub group: &'static str,
    pub scene: String,
    pub plant: String,
    /// Control rate \[Hz\].
    pub rate_hz: f64,
    pub policy: &'static str,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// What was measured; `None` where the run cannot be trusted.
    #[serde(flatten)]
    pub metrics: Option<Figures>,
    /// Why not.
    pub error: Option<String>,
}

impl ResultRow {
    /// Whether it is a run of a scene of the user's own.
    pub(crate) fn is_own(&self) -> bool {
        self.group == OWN
    }

    /// Whether the rotor came back.
    pub fn recovered(&self) -> bool {
        self.metrics.as_ref().is_some_and(|m| m.recovered)
    }
}

/// Whether a run is better than another: it recovers where the other does not, or its hardest touch is softer.
fn better(one: &Option<Figures>, other: &Option<Figures>) -> bool {
    match (one, other) {
        (Some(a), Some(b)) if a.recovered == b.recovered => {
            a.peak_contact_force_n < b.peak_contact_force_n
        }
        (Some(a), Some(_)) => a.recovered,
        (Some(_), None) => true,
        (None, _) => false,
    }
}

/// Runs a case under a policy. A run that cannot be trusted is a row with its error.
pub(crate) fn run_case(
    case: &Case,
    (plant, rate_hz): (&str, f64),
    (contender, seed): (Contender, u64),
    found: &TunedGains,
) -> ResultRow {
    let scene = seeded(&case.scene, seed);
    let run = |policy| match run_policy(
        &scene,
        (policy, contender.name()),
        Keep::Verdict,
        &mut |_| {},
    ) {
        Ok((figures, _)) => (Some(figures), None),
        Err(error) => (None, Some(error.to_string())),
    };
    let none = (
        None,
        Some("the policy needs more than the scene gives".to_owned()),
    );
    let (metrics, error) = (contender.candidates(found, &scene).into_iter().map(run))
        .reduce(|best, next| if better(&next.0, &best.0) { next } else { best })
        .unwrap_or(none);
    ResultRow {
        group: case.group,
        scene: case.name.clone(),
        plant: plant.to_owned(),
        rate_hz,
        policy: contender.name(),
        seed,
        metrics,
        error,
    }
}

/// Runs a user's own scene under one of its policies.
pub(crate) fn run_own(scene: &Scene, kind: PolicyKind, seed: u64) -> ResultRow {
    let outcome = run(&seeded(scene, seed), kind, Keep::Verdict, &mut |_| {});
    let (metrics, error) = match outcome {
        Ok((figures, _)) => (Some(figures), None),
        Err(error) => (None, Some(error.to_string())),
    };
    ResultRow {
        group: OWN,
        scene: scene.title.clone(),
        plant: "own".to_owned(),
        rate_hz: scene.sample_rate_hz,
        policy: kind.name(),
        seed,
        metrics,
        error,
    }
}
