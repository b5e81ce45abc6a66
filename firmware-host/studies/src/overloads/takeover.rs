//! Established backward whirl that the bearing is switched on into.

use firmware_bench::run::closed_loop::{Keep, RunError, run_policy};
use firmware_bench::run::controller::Controller;
use firmware_bench::run::trace::TraceRow;
use firmware_bench::scene::Scene;
use plant_model::V2;
use plant_model::analysis::arrest::{Arrest, circle_radius_m};
use plant_model::machine::params::MachineStart;

/// Whirl counts as arrested when the backward angular momentum about the centre has fallen to this share of the
/// start's.
pub(crate) const ARRESTED: f64 = 0.25;

/// Outcome of a take-over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TakeOver {
    /// Back in the middle in the end.
    pub recovered: bool,
    /// When the backward angular momentum fell to `ARRESTED` of the start's \[s\]; `None` if never.
    pub arrested_s: Option<f64>,
}

/// The start of a scene on the rotor's steady sliding circle at a backward speed \[m/s\], penetration in
/// balance.
pub fn whirling(scene: &Scene, speed_m_s: f64) -> MachineStart {
    let backward = -scene.start.spin_rad_s.signum();
    let radius_m = circle_radius_m(&scene.plant(0), speed_m_s);
    MachineStart {
        centre_m: scene.machine.planes[0].centre_m + V2::new(radius_m, 0.0),
        centre_velocity_m_s: V2::new(0.0, backward * speed_m_s),
        ..scene.start
    }
}

/// Speed in contact above which whirl that began at a speed \[m/s\] counts as held by nobody: half as fast again.
pub(crate) fn lost_beyond_m_s(speed_m_s: f64) -> f64 {
    1.5 * speed_m_s
}

/// Lets a scene begin [`whirling`]. Its limit of whirl gives way where the start is beyond it.
pub(crate) fn let_whirl(scene: &mut Scene, speed_m_s: f64) {
    scene.start = whirling(scene, speed_m_s);
    scene.levitated_before = true;
    let limit_m_s = &mut scene.planes[0].whirl_speed_m_s;
    *limit_m_s = limit_m_s.max(lost_beyond_m_s(speed_m_s));
}

/// What the whole cap of a plane's magnet can stop; `None` without a magnet or without friction.
pub(crate) fn arrest_of(scene: &Scene, plane: usize) -> Option<Arrest> {
    let plant = scene.plant(plane);
    Arrest::new(&plant, plant.magnet?.force_max_n)
}

/// Runs it.
///
/// # Errors
/// [`RunError`] of a run that cannot be trusted.
pub fn take_over(
    scene: &Scene,
    speed_m_s: f64,
    acting: (Box<dyn Controller>, &'static str),
) -> Result<TakeOver, RunError> {
    let mut scene = Scene {
        start: whirling(scene, speed_m_s),
        levitated_before: true,
        ..scene.clone()
    };
    scene.planes[0].whirl_speed_m_s = lost_beyond_m_s(speed_m_s);
    let backward = -scene.start.spin_rad_s.signum();
    let (verdict, trace) = run_policy(&scene, acting, Keep::TraceToDecision, &mut |_| {})?;
    // Per mass. On a soft wall the circle shrinks as the whirl slows: speed over the clearance would not do.
    let momentum_m2_s =
        |row: &TraceRow| backward * row.plant.position_m.perp(&row.plant.velocity_m_s);
    let radius_m = circle_radius_m(&scene.plant(0), speed_m_s);
    let arrested_m2_s = ARRESTED * speed_m_s * radius_m;
    // On the line between two rows: else every time would be late by up to a sample.
    let arrested_s = (trace.rows.array_windows())
        .find(|[_, row]| momentum_m2_s(row) < arrested_m2_s)
        .map(|[before, after]| {
            let (fast, slow) = (momentum_m2_s(before), momentum_m2_s(after));
            let part = ((fast - arrested_m2_s) / (fast - slow)).clamp(0.0, 1.0);
            before.plant.t_s + part * (after.plant.t_s - before.plant.t_s)
        });
    Ok(TakeOver {
        recovered: verdict.recovered,
        arrested_s,
    })
}
