//! The supervisor on an emulated processor in a closed loop with the plant here; and the example firmware.

use firmware_studies::on_target::emulator::{EmulatorError, Time, output_of, version};
use firmware_studies::on_target::machines::{Build, MACHINES, Machine};
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use system_tests::root;
use system_tests::target::{build_some, skipped, target};

/// Samples, commands, plant and verdict are those of the host alone, bit for bit.
/// Requirement: SR-34
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

/// Level and text of each line.
type Log = Vec<(String, String)>;

/// What an image has logged, by what its file says of its log.
fn logged(image: &Path, bytes: &[u8]) -> Log {
    let mut decoder = Command::new("cargo")
        .args(["run", "--quiet", "--locked", "--manifest-path"])
        .arg(root().join("tests/log/Cargo.toml"))
        .arg("--target-dir")
        .arg(root().join("target/log"))
        .arg(image)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    decoder.stdin.take().unwrap().write_all(bytes).unwrap();
    let output = decoder.wait_with_output().unwrap();
    assert!(output.status.success());
    let lines = String::from_utf8(output.stdout).unwrap();
    (lines.lines())
        .map(|line| line.split_once(' ').unwrap())
        .map(|(level, text)| (level.to_owned(), text.to_owned()))
        .collect()
}

/// Log of the example firmware on all processors with an FPU, at 2^shift nanoseconds an instruction.
/// Floats in software take longer than a period: the background would never have its turn. `None`: skipped.
fn logs_of_the_example(shift: u8) -> Option<Vec<Log>> {
    if let Err(why @ EmulatorError::Missing) = version() {
        skipped(&why.to_string());
        return None;
    }
    let with_fpu = |m: &Machine| m.target.ends_with("eabihf") && m.build != Build::Bare;
    let mut logs = Vec::new();
    for machine in MACHINES.into_iter().filter(with_fpu) {
        let built = build_some(machine.target, &["timer-interrupt"], &[])?;
        assert!(built.status.success());
        let folder = root().join("target-fw").join(machine.target).join("fw");
        let image = folder.join("timer-interrupt");
        let folder = tempfile::tempdir().unwrap();
        let time = Time::Counted { shift };
        let limit = Duration::from_secs(60);
        let output = output_of(&machine, &image, folder.path(), time, limit).unwrap();
        logs.push(logged(&image, &output));
    }
    Some(logs)
}

/// The example firmware keeps its 19 kHz at 125 million instructions a second, sees the landing, logs all that happens
/// in its order, and picks up a record that is intact.
#[test]
fn the_example_firmware_records_a_landing() {
    for log in logs_of_the_example(3).unwrap_or_default() {
        let happened: Vec<&str> = (log.iter())
            .filter_map(|(_, text)| text.strip_prefix("tick ")?.split_once(": "))
            .map(|(_, text)| text)
            .collect();
        assert_eq!(
            happened,
            [
                "ENGAGED, Approach",
                "TOUCHED, Bounce",
                "WHIRL, BackwardWhirl",
                "COAST_DOWN, BackwardWhirl",
                "LIFTED_OFF, Bounce",
                "HANDOVER, Handover",
                "LEVITATED, Levitated",
                "RECORD_FROZEN, Levitated",
            ],
            "{log:?}"
        );
        let of_level = |level: &str| log.iter().filter(|(l, _)| l == level).count();
        assert_eq!((of_level("warn"), of_level("error")), (2, 0), "{log:?}");
        let [.., (_, record), (_, report)] = log.as_slice() else {
            panic!("{log:?}")
        };
        assert!(record.starts_with("record of version 4, "), "{record}");
        assert!(
            report.starts_with(
                "Report { landings: 1, nuisance_engagements: 0, handed_back: 0, impacts: 1, "
            ),
            "{report}"
        );
        assert!(report.contains("late_ticks: 0, "), "{report}");
        // Memory that nobody had written to: a bearing without landings, and then with one.
        let kept: Vec<&str> = (log.iter())
            .filter_map(|(_, text)| text.strip_prefix("bearing 1: "))
            .collect();
        assert_eq!(kept, ["0 landings so far", "1 landings"], "{log:?}");
    }
}

/// At a quarter of that pace the ticks of the landing last longer than a period: they are flagged as late and counted, their
/// events fill the queue, in which there is no room for those of the landing, and it is recorded all the same. Back at rest the
/// firmware keeps its pace.
#[test]
fn the_example_firmware_tells_that_it_is_late() {
    for log in logs_of_the_example(5).unwrap_or_default() {
        let [.., (_, record), (_, report)] = log.as_slice() else {
            panic!("{log:?}")
        };
        let logged = |event: &str| log.iter().any(|(_, text)| text.contains(event));
        assert!(logged("ENGAGED") && !logged("LIFTED_OFF"), "{log:?}");
        assert!(record.starts_with("record of version 4, "), "{record}");
        assert!(report.starts_with("Report { landings: 1, "), "{report}");
        let (_, late) = report.split_once("late_ticks: ").unwrap();
        let late: u32 = late.split(',').next().unwrap().parse().unwrap();
        // From the way to the wall to the end of the hand-over: 40, 120, 100 and 50 ticks.
        assert!((120..=420).contains(&late), "{report}");
    }
}
