//! Runs of the catalogue and what they measured.

use super::case::Case;
use super::seats::{Seat, tries};
use crate::machines::tuned_gains::TunedGains;
use firmware_bench::run::closed_loop::{Keep, run, run_policy};
use firmware_bench::run::verdict::{Outcome, Verdict};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use serde::Serialize;

/// What a run measured: all of its [`Verdict`] but times of the machine that it ran on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Metrics {
    /// How it ended.
    pub outcome: Outcome,
    /// Recovered or decayed.
    pub recovered: bool,
    /// Number of touches.
    pub impacts: u64,
    /// Touches with a normal speed above 20 mm/s.
    pub contacts_over_20_mm_s: u64,
    /// When it touched first \[s\]; `None` if never.
    pub first_contact_s: Option<f64>,
    /// Time in contact \[s\].
    pub contact_time_s: f64,
    /// ∫ N dt \[N s\].
    pub contact_impulse_n_s: f64,
    /// Largest penetration of the clearance circle by the contact \[m\].
    pub peak_penetration_m: f64,
    /// Largest normal force \[N\].
    pub peak_contact_force_n: f64,
    /// Largest friction torque \[N m\].
    pub peak_friction_torque_n_m: f64,
    /// Largest backward speed in contact \[m/s\].
    pub peak_backward_speed_m_s: f64,
    /// Largest backward whirl frequency over 1 ms of continuous contact \[Hz\]; `None` without such a contact.
    pub max_backward_whirl_hz: Option<f64>,
    /// Spin lost \[Hz\].
    pub spin_lost_hz: f64,
    /// Energy from nowhere over energy turned over.
    pub energy_residual: f64,
    /// Method that integrated contact.
    pub method: &'static str,
    /// From the end of the disturbance to the stay in the middle \[s\].
    pub relevitation_time_s: Option<f64>,
}

impl From<&Verdict> for Metrics {
    fn from(v: &Verdict) -> Self {
        Self {
            outcome: v.outcome,
            recovered: v.recovered,
            impacts: v.impacts,
            contacts_over_20_mm_s: v.contacts_over_20_mm_s,
            first_contact_s: v.first_contact_s,
            contact_time_s: v.contact_time_s,
            contact_impulse_n_s: v.contact_impulse_n_s,
            peak_penetration_m: v.peak_penetration_m,
            peak_contact_force_n: v.peak_contact_force_n,
            peak_friction_torque_n_m: v.peak_friction_torque_n_m,
            peak_backward_speed_m_s: v.peak_backward_speed_m_s,
            max_backward_whirl_hz: v.max_backward_whirl_hz,
            spin_lost_hz: v.spin_lost_hz,
            energy_residual: v.energy_residual,
            method: v.method,
            relevitation_time_s: v.relevitation_time_s,
        }
    }
}

/// Group of the user's own scenes.
const OWN: &str = "own scenes";

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResultRow {
    /// Kind of overload.
    pub group: &'static str,
    /// Scene.
    pub scene: String,
    /// Plant.
    pub plant: String,
    /// Control rate \[Hz\].
    pub rate_hz: f64,
    /// Policy.
    pub policy: &'static str,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// What was measured; `None` where the run cannot be trusted.
    #[serde(flatten)]
    pub metrics: Option<Metrics>,
    /// Why not.
    pub error: Option<String>,
}

impl ResultRow {
    /// Whether it is a run of a scene of the user's own.
    pub fn is_own(&self) -> bool {
        self.group == OWN
    }

    /// Whether the rotor came back.
    pub fn recovered(&self) -> bool {
        self.metrics.as_ref().is_some_and(|m| m.recovered)
    }
}

/// Whether a run is better than another: it recovers where the other does not, or its hardest touch is softer.
fn better(one: &Option<Metrics>, other: &Option<Metrics>) -> bool {
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
pub fn run_case(
    case: &Case,
    (plant, rate_hz): (&str, f64),
    (seat, seed): (Seat, u64),
    found: &TunedGains,
) -> ResultRow {
    let scene = Scene {
        seed,
        ..case.scene.clone()
    };
    let run = |policy| match run_policy(&scene, (policy, seat.name()), Keep::Verdict, &mut |_| {}) {
        Ok((verdict, _)) => (Some(Metrics::from(&verdict)), None),
        Err(error) => (None, Some(error.to_string())),
    };
    let none = (
        None,
        Some("the policy needs more than the scene gives".to_owned()),
    );
    let (metrics, error) = (tries(seat, found, &scene).into_iter().map(run))
        .reduce(|best, next| if better(&next.0, &best.0) { next } else { best })
        .unwrap_or(none);
    ResultRow {
        group: case.group,
        scene: case.name.clone(),
        plant: plant.to_owned(),
        rate_hz,
        policy: seat.name(),
        seed,
        metrics,
        error,
    }
}

/// Runs a user's own scene under one of its policies.
pub fn run_own(scene: &Scene, kind: PolicyKind, seed: u64) -> ResultRow {
    let seeded = Scene {
        seed,
        ..scene.clone()
    };
    let outcome = run(&seeded, kind, Keep::Verdict, &mut |_| {});
    let (metrics, error) = match outcome {
        Ok((verdict, _)) => (Some(Metrics::from(&verdict)), None),
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
