//! Every fault of sensor and drive in every mode: idle, approach, bounce, whirl, hand-over.

use super::case::Case;
use super::contenders::Contender;
use super::situations::Situation;
use crate::machines::plants::PlantCase;
use firmware_bench::device::actuator::{Delivers, Outage};
use firmware_bench::device::axis::Axis;
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::scene::Scene;
use supervisor::Mode;

/// Group of the sensor's faults …
pub const SENSOR_FAULTS: &str = "sensor faults";
/// … and of the drive's.
pub(crate) const DRIVE_FAULTS: &str = "drive faults";

/// Faults last so long, but for dropouts \[s\].
const LASTS_S: f64 = 0.01;
/// What is left to come back in \[s\].
const AFTER_S: f64 = 0.15;

/// The faults: name, kind, axis, duration \[s\].
fn faults(clearance_m: f64, period_s: f64) -> Vec<(String, FaultKind, Axis, f64)> {
    let c = clearance_m;
    let mut all: Vec<(String, FaultKind, Axis, f64)> = Vec::new();
    let mut add = |name: &str, kind: FaultKind, axis: Axis, lasts_s: f64| {
        all.push((name.to_owned(), kind, axis, lasts_s));
    };
    add("not a number", FaultKind::Nan, Axis::X, LASTS_S);
    add("not a number along y", FaultKind::Nan, Axis::Y, LASTS_S);
    add("infinity", FaultKind::Infinity, Axis::Y, LASTS_S);
    add("zero", FaultKind::Zero, Axis::Both, LASTS_S);
    add("at the rail", FaultKind::Rail, Axis::X, LASTS_S);
    add("at the rail along y", FaultKind::Rail, Axis::Y, LASTS_S);
    add("stuck", FaultKind::Stuck, Axis::Both, LASTS_S);
    for share in [0.2, -0.2, 0.5, -0.5] {
        let name = format!("offset {:+.0} % of c", 100.0 * share);
        add(&name, FaultKind::Offset(share * c), Axis::X, LASTS_S);
        let name = name + " along y";
        add(&name, FaultKind::Offset(share * c), Axis::Y, LASTS_S);
    }
    for gain in [0.8, 1.2] {
        add(
            &format!("gain {gain}"),
            FaultKind::Gain(gain),
            Axis::Both,
            LASTS_S,
        );
    }
    add("inverted", FaultKind::Inverted, Axis::Both, LASTS_S);
    add("axes swapped", FaultKind::Swapped, Axis::Both, LASTS_S);
    add("noise × 10", FaultKind::Noise(10.0), Axis::Both, LASTS_S);
    let spikes = FaultKind::Spikes {
        rate_hz: 1000.0,
        size_m: c,
    };
    add("spikes", spikes, Axis::Both, LASTS_S);
    for samples in [1, 5, 50, 500] {
        let lasts_s = f64::from(samples) * period_s;
        add(
            &format!("dropout of {samples}"),
            FaultKind::Dropout,
            Axis::Both,
            lasts_s,
        );
    }
    for samples in 1..=5 {
        add(
            &format!("late by {samples}"),
            FaultKind::Delay(samples),
            Axis::Both,
            LASTS_S,
        );
    }
    add("8 bits", FaultKind::Bits(8), Axis::Both, LASTS_S);
    let oscillation = FaultKind::Oscillation {
        frequency_hz: 300.0,
        amplitude_m: 0.2 * c,
    };
    add("oscillation", oscillation, Axis::Both, LASTS_S);
    all
}

/// Drives that do not do what is commanded, and which nobody knows of: name, what they do instead, axis.
const DRIVES: [(&str, Delivers, Axis); 6] = [
    ("dead along x", Delivers::Nothing, Axis::X),
    ("dead along y", Delivers::Nothing, Axis::Y),
    ("inverted along x", Delivers::Inverted, Axis::X),
    ("inverted along y", Delivers::Inverted, Axis::Y),
    ("inverted", Delivers::Inverted, Axis::Both),
    ("swapped", Delivers::Swapped, Axis::Both),
];

/// The matrix on a plant; the supervisor against levitation alone.
pub fn cases(plant: &PlantCase, situations: &[Situation]) -> Vec<Case> {
    let period_s = 1.0 / plant.rate_hz;
    let clearance_m = plant.scene.clearance_m(0);
    let mut cases = Vec::new();
    for situation in situations.iter().filter(|s| s.mode != Mode::Pinned) {
        let start_s = situation.at_s;
        let mut add = |group, fault: &str, duration_s, edit: &dyn Fn(&mut Scene)| {
            let mut scene = situation.scene.clone();
            scene.duration_s = start_s + duration_s + AFTER_S;
            edit(&mut scene);
            cases.push(Case {
                group,
                name: format!("{fault} while in {}", situation.name),
                scene,
                contenders: &[Contender::Tuned, Contender::Supervisor],
            });
        };
        for (name, kind, axis, duration_s) in faults(clearance_m, period_s) {
            add(
                SENSOR_FAULTS,
                &format!("sensor {name}"),
                duration_s,
                &|scene| {
                    scene.planes[0].faults = vec![Fault {
                        start_s,
                        duration_s,
                        kind,
                        axis,
                    }];
                },
            );
        }
        // What is measured of the force tells the supervisor what the drive really does.
        for (measured, suffix) in [(false, ""), (true, ", force measured")] {
            for (name, delivers, axis) in DRIVES {
                let name = format!("drive {name}{suffix}");
                add(DRIVE_FAULTS, &name, LASTS_S, &|scene| {
                    let plane = &mut scene.planes[0];
                    plane.amplifier.force_measured = measured;
                    plane.outages = vec![Outage {
                        start_s,
                        duration_s: LASTS_S,
                        delivers,
                        axis,
                        known: false,
                    }];
                });
            }
        }
    }
    cases
}
