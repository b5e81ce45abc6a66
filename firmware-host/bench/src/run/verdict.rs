//! What a run came to: one outcome and the figures behind it.

use crate::run::supervision::Supervision;
use serde::Serialize;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Back in the middle (r < 0.3 c, held) and not touching again.
    Recovered,
    /// Free vibration without contact.
    Decayed,
    /// Touching still, without whirl and without speed.
    Resting,
    /// Held on the stator by a load that is still on.
    Pinned,
    /// In unbroken contact for longer than a rotor takes to settle, moving, without whirl.
    Rubbing,
    /// Still hitting the stator when the run ended, without whirl.
    Bouncing,
    /// Backward whirl: the contact speed passed the scene's limit.
    Whirl,
}

/// Figures of one policy on one scene, SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// How it ended.
    pub outcome: Outcome,
    /// True for recovered or decayed.
    pub recovered: bool,
    /// Number of touches.
    pub impacts: u64,
    /// Time in contact \[s\].
    pub contact_time_s: f64,
    /// Impulse of the normal force, ∫ f_n dt \[N s\].
    pub contact_impulse_n_s: f64,
    /// Number of touches with a normal speed above 20 mm/s.
    pub contacts_over_20_mm_s: u64,
    /// When it touched first \[s\]; `None` if never.
    pub first_contact_s: Option<f64>,
    /// Largest penetration of the clearance circle by the contact \[m\].
    pub peak_penetration_m: f64,
    /// Largest normal force \[N\].
    pub peak_contact_force_n: f64,
    /// Largest friction torque on the spin \[N m\].
    pub peak_friction_torque_n_m: f64,
    /// Spin lost from start to end \[Hz\].
    pub spin_lost_hz: f64,
    /// Largest backward tangential speed in contact \[m/s\].
    pub peak_backward_speed_m_s: f64,
    /// Largest backward whirl frequency over 1 ms of continuous contact \[Hz\]; `None` without such a contact.
    pub max_backward_whirl_hz: Option<f64>,
    /// From the end of the disturbance to the beginning of the stay in the middle \[s\]; `None` if never.
    pub relevitation_time_s: Option<f64>,
    /// Energy-audit residual: energy from nowhere over energy turned over.
    pub energy_residual: f64,
    /// Method that integrated contact: `series`, `explicit` or `stiff`.
    pub method: &'static str,
    /// Wall-clock time of the run \[s\].
    pub run_time_s: f64,
    /// Simulated time over wall-clock time.
    pub real_time_ratio: f64,
}

/// The run once more, by one method at one tolerance, against the run itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Method that integrated contact.
    pub method: &'static str,
    /// Its tolerance.
    pub rtol: f64,
    /// How it ended.
    pub outcome: Outcome,
    /// Changes of mode.
    pub mode_changes: u64,
    /// Whether the modes follow each other as in the run.
    pub same_modes: bool,
    /// Distance of the end positions, in clearances.
    pub end_difference_clearances: f64,
    /// Largest distance at a control sample, in clearances.
    pub largest_difference_clearances: f64,
    /// First control sample more than the threshold apart \[s\]; `None` if there is none.
    pub differs_from_s: Option<f64>,
}

/// What the checks say of a run: the worst of each.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verification {
    /// Whether all checks end with the outcome of the run.
    pub same_outcome: bool,
    /// Whether the modes follow each other as in the run in all checks.
    pub same_modes: bool,
    /// Changes of mode of the run.
    pub mode_changes: u64,
    /// Estimated global error: largest distance of the end position from a check's, in clearances.
    pub estimated_error_clearances: f64,
    /// Largest distance from a check at a control sample, in clearances.
    pub largest_difference_clearances: f64,
    /// Distance above which runs count as different, in clearances.
    pub threshold_clearances: f64,
    /// First control sample at which a check is farther away \[s\]; `None`: they agree to the end.
    pub differs_from_s: Option<f64>,
    /// The checks.
    pub checks: Vec<Check>,
}

/// One policy's run.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicyRun {
    /// Name of the policy, e.g. `supervisor`.
    pub name: String,
    /// What it came to.
    pub verdict: Verdict,
    /// What running it again with other means says, where that was asked for.
    pub verification: Option<Verification>,
    /// What the supervisor did, where one ran.
    pub supervision: Option<Supervision>,
    /// What happened.
    pub trace: crate::run::trace::Trace,
}

/// Something that happens to the rotor, its magnet or its sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbed {
    /// What, in words.
    pub what: String,
    /// Beginning \[s\].
    pub from_s: f64,
    /// End \[s\]; the beginning for a change that stays.
    pub to_s: f64,
}

/// What a report needs to know of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneSummary {
    /// Title of the scene, one line.
    pub title: String,
    /// Its story, a few sentences of plain text.
    pub story: String,
    /// Clearance c \[m\].
    pub clearance_m: f64,
    /// Ellipticity and direction of the longer axis \[rad\] of a bearing that is out of round.
    pub out_of_round: Option<(f64, f64)>,
    /// Force cap of the magnet \[N\], if there is one.
    pub force_max_n: Option<f64>,
    /// Backward contact speed above which a run counts as whirl \[m/s\].
    pub whirl_speed_m_s: f64,
    /// What was simulated, in words: name and value.
    pub facts: Vec<(&'static str, String)>,
    /// What the scene says and hardly means.
    pub warnings: Vec<String>,
    /// What happens to the rotor, its magnet or its sensor.
    pub disturbances: Vec<Disturbed>,
    /// Duration of the run \[s\].
    pub duration_s: f64,
}

/// Which runs went so far into the wall that their figures from there on say nothing of a machine.
pub fn far_into_the_wall(runs: &[PolicyRun], clearance_m: f64) -> Option<String> {
    let is_far = |run: &&PolicyRun| run.verdict.peak_penetration_m > clearance_m;
    let names: Vec<&str> = (runs.iter().filter(is_far))
        .map(|run| run.name.as_str())
        .collect();
    let who = names.join(", ");
    let note =
        "the wall gave way by more than the clearance: figures from there on are of no machine";
    (!names.is_empty()).then(|| format!("{who}: {note}"))
}
