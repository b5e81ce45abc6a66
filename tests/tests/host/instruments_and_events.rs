//! What scenes can ask of instruments and amplifier, and what can happen during a run: each against a
//! closed form or an exact expectation.

mod axes;
mod changes;
mod faults;
mod loads;
mod magnet;
mod refusals;
mod set_down;

use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use system_tests::scene;

/// A free rotor in the middle of a clearance that it does not reach: no stiffness, no weight, an ideal
/// sensor, a magnet with a lag of 0.16 ms, 20 kHz.
fn free_rotor() -> Scene {
    let mut scene = scene("overload_then_release");
    scene.disturbances.clear();
    scene.machine.supports.clear();
    scene.machine.planes[0].contact.clearance_m = 1.0;
    scene.planes[0].sensor = Default::default();
    scene
}

fn ridden(scene: &Scene, kind: PolicyKind) -> (Figures, Trace) {
    let (verdict, trace) = run(scene, kind, Keep::Trace, &mut |_| {}).unwrap();
    let residual = verdict.energy_residual;
    assert!(residual < 1e-8, "{residual}");
    (verdict, trace)
}

/// Rows at control samples.
fn samples(trace: &Trace) -> Vec<TraceRow> {
    let rows = trace.rows.iter().filter(|r| !r.mode_change);
    rows.copied().collect()
}

fn last(trace: &Trace) -> TraceRow {
    *trace.rows.last().unwrap()
}

fn near(what: &str, found: f64, expected: f64, relative: f64) {
    let most = relative * expected.abs().max(f64::MIN_POSITIVE);
    let same = (found - expected).abs() <= most;
    assert!(same, "{what}: {found:e}, expected {expected:e}");
}

fn apart(a: V2, b: V2) -> f64 {
    (a - b).norm()
}
