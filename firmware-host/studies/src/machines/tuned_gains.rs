//! What the searches have found: gains of the baselines and weights of the reference, per plant and rate.

use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::run::clairvoyant::ClairvoyantLaw;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Result of the searches on one plant at one rate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TunedGains {
    /// The loop with the best impact result under the limits of [`tune`](crate::overloads::tune).
    pub tuned: LevitationParams,
    /// An ordinary loop.
    pub stiff: LevitationParams,
    /// The reference's weights for impacts.
    pub impact_law: ClairvoyantLaw,
    /// The reference's weights for established whirl.
    pub whirl_law: ClairvoyantLaw,
}

/// Results by plant and rate, as they are kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the plant.
    pub plant: String,
    /// Control rate \[Hz\].
    pub rate_hz: f64,
    /// What was found.
    pub found: TunedGains,
}

/// What is kept in the project, written by `overloads --search`.
const KEPT: &str = include_str!("../../scenes/plants/found.json");

/// All kept results; none if the file is not what it should be.
fn all_kept() -> &'static [Row] {
    static ROWS: LazyLock<Vec<Row>> =
        LazyLock::new(|| serde_json::from_str(KEPT).unwrap_or_default());
    &ROWS
}

/// The kept results of a plant at a rate.
pub fn stored(plant: &str, rate_hz: f64) -> Option<TunedGains> {
    let row = (all_kept().iter()).find(|row| row.plant == plant && row.rate_hz == rate_hz);
    row.map(|row| row.found)
}
