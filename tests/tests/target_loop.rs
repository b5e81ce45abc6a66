//! The supervisor on an emulated processor in a closed loop with the plant here; and the example firmware.

use firmware_host::target::emulator::{EmulatorError, Time, run, version};
use firmware_host::target::images::Project;
use firmware_host::target::machines::{MACHINES, Machine};
use serde_json::Value;
use std::time::Duration;
use system_tests::root;
use system_tests::target::{build_images, skipped, target};

/// Samples, commands, plant and verdict are those of the host alone, bit for bit.
#[test]
fn a_processor_in_the_loop_changes_nothing() {
    let Some(output) = target(&["--loop", "--json", "--only", "M4F"]) else {
        return;
    };
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let loops = report["loops"].as_array().unwrap();
    assert_eq!(loops.len(), 3);
    for l in loops {
        assert_eq!(l["ticks"], 2000, "{l}");
        assert_eq!(l["bit_exact_ticks"], l["ticks"], "{l}");
        assert_eq!(l["same_plant"], true, "{l}");
    }
}

/// Fixed point is not put in the loop, and the command says so.
#[test]
fn a_processor_without_an_image_for_the_loop_is_named() {
    let Some(output) = target(&["--loop", "--only", "M0"]) else {
        return;
    };
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("M0 Q has no image for the loop"), "{error}");
}

/// The example firmware keeps its 20 kHz at 125 million instructions a second, sees the landing, and picks up a
/// record that is intact.
#[test]
fn the_example_firmware_records_a_landing() {
    if let Err(why @ EmulatorError::Missing) = version() {
        return skipped(&why.to_string());
    }
    // Floats in software take longer than a period: the background would never have its turn.
    let with_fpu = |m: &Machine| m.target.ends_with("eabihf");
    for machine in MACHINES.into_iter().filter(with_fpu) {
        let Some(output) = build_images(machine.target, &[]) else {
            return;
        };
        assert!(output.status.success());
        let project = Project::around(&root()).unwrap();
        let image = project.image(machine.target, "timer-interrupt");
        let folder = tempfile::tempdir().unwrap();
        // 8 ns an instruction.
        let time = Time::Counted { shift: 3 };
        let limit = Duration::from_secs(60);
        let said = run(&machine, &image, folder.path(), time, limit).unwrap();
        assert_eq!(said["landings"], "1", "{said:?}");
        assert_eq!(said["record_entries"], "512", "{said:?}");
        assert_eq!(said["record_intact"], "yes", "{said:?}");
    }
}
