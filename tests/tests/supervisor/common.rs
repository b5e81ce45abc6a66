//! Plants of the catalogue, and runs of scenes.

use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::controller::Controller;
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_studies::machines::plants::{PlantCase, plants};
use firmware_studies::machines::tuned_gains::TunedGains;
use firmware_studies::overloads::contenders::{Contender, Task};

/// The usual control rate \[Hz\].
pub(crate) const RATE_HZ: f64 = 20_000.0;

/// A plant of the catalogue at the usual rate.
pub(crate) fn plant(name: &str) -> PlantCase {
    let mut all = plants(RATE_HZ).unwrap().into_iter();
    all.find(|plant| plant.name == name).unwrap()
}

/// What a controller makes of a scene.
pub(crate) fn ran(scene: &Scene, controller: Box<dyn Controller>, keep: Keep) -> (Figures, Trace) {
    run_policy(scene, (controller, "of a test"), keep, &mut |_| {}).unwrap()
}

/// What a contender makes of it, against impacts.
pub(crate) fn contend(
    contender: Contender,
    found: &TunedGains,
    scene: &Scene,
    keep: Keep,
) -> (Figures, Trace) {
    let controller = contender.controller(Task::Impact, found, scene);
    ran(scene, controller.unwrap(), keep)
}
