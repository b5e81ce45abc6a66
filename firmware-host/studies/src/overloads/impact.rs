//! The hardest radial impact that a policy recovers from.

use firmware_bench::run::closed_loop::{Keep, RunError, run_policy};
use firmware_bench::run::controller::Controller;
use firmware_bench::scene::Scene;
use plant_model::V2;

/// Speeds grow by this factor.
pub const STEP: f64 = 1.05;
/// First speed \[m/s\].
pub(crate) const FIRST_M_S: f64 = 0.05;
/// A policy that passes this speed is not searched further \[m/s\].
const LAST_M_S: f64 = 5.0;

/// The hardest radial impact from the middle \[m/s\] that is recovered from, on the grid `FIRST · STEP^i`, all
/// slower ones being recovered from too; 0 if the first is not.
///
/// # Errors
/// [`RunError`] of the first run that cannot be trusted.
pub fn recoverable_m_s(
    scene: &Scene,
    name: &'static str,
    make: &dyn Fn(&Scene) -> Option<Box<dyn Controller>>,
) -> Result<f64, RunError> {
    recoverable_from(scene, name, make, FIRST_M_S)
}

/// As [`recoverable_m_s`], taking slower impacts than `from_m_s` for granted: for searches, whose results
/// are checked from the first.
///
/// # Errors
/// As [`recoverable_m_s`].
pub(crate) fn recoverable_from(
    scene: &Scene,
    name: &'static str,
    make: &dyn Fn(&Scene) -> Option<Box<dyn Controller>>,
    from_m_s: f64,
) -> Result<f64, RunError> {
    let mut scene = Scene {
        levitated_before: true,
        ..scene.clone()
    };
    let skipped = (from_m_s / FIRST_M_S).ln() / STEP.ln();
    let mut step = skipped.floor().max(0.0) as i32;
    let mut last = 0.0;
    loop {
        let speed = FIRST_M_S * STEP.powi(step);
        scene.start.centre_velocity_m_s = V2::new(speed, 0.0);
        let policy = make(&scene).ok_or(RunError::Incomplete { policy: name })?;
        let (verdict, _) = run_policy(&scene, (policy, name), Keep::Decision, &mut |_| {})?;
        if !verdict.recovered || speed > LAST_M_S {
            return Ok(last);
        }
        last = speed;
        step += 1;
    }
}
