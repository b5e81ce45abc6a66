//! The supervisor on emulated processors: the same bits as here, and figures within their budgets.

use serde_json::Value;
use system_tests::target::target;
use system_tests::{host, root};

fn parsed(stdout: &[u8]) -> Value {
    serde_json::from_slice(stdout).unwrap()
}

/// Every tick of the short streams, which have every mode and every way between modes.
/// And the same ticks cost the same instructions, run for run.
/// Requirements: SR-34, SR-36
#[test]
fn every_processor_gives_the_bits_of_the_host_within_its_budgets() {
    let Some(output) = target(&["--quick", "--json"]) else {
        return;
    };
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let report = parsed(&output.stdout);
    let streams = report["streams"].as_array().unwrap();
    for (stream, number) in streams.iter().zip(["f32", "Q"]) {
        assert_eq!(stream["number"], number);
        assert_eq!(stream["ticks"], 100_000);
        assert_eq!(stream["missing_ways"], Value::Array(Vec::new()));
        assert_eq!(stream["unknown_ways"], Value::Array(Vec::new()));
        let modes = stream["modes"].as_array().unwrap();
        assert_eq!(modes.len(), 8);
        for mode in modes {
            assert!(mode["ticks"].as_u64().unwrap() >= 100, "{mode}");
        }
    }
    let targets = report["targets"].as_array().unwrap();
    let names: Vec<_> = targets
        .iter()
        .map(|t| (t["name"].as_str().unwrap(), t["number"].as_str().unwrap()))
        .collect();
    let expected = [
        ("M3", "f32"),
        ("M3", "Q"),
        ("M0", "Q"),
        ("M4F", "f32"),
        ("M4F-bare", "f32"),
        ("M7", "f32"),
    ];
    assert_eq!(names, expected);
    for t in targets {
        let mut of_its_number = streams.iter().filter(|s| s["number"] == t["number"]);
        let stream = of_its_number.next().unwrap();
        if t["name"] == "M4F-bare" {
            // The host has the parts that it lacks: its self-test says that it computes as it should.
            assert_eq!(t["bit_exact_ticks"], Value::Null);
        } else {
            assert_eq!(t["bit_exact_ticks"], 100_000, "{t}");
            assert_eq!(t["hash"], stream["hash"], "{t}");
            assert_eq!(t["read_outs"], stream["read_outs"], "{t}");
        }
        // A count that lost its meaning would show here: between nothing and a thousand flops in software.
        let [min, median, worst] =
            ["min", "median", "worst"].map(|x| t[format!("{x}_instructions")].as_u64().unwrap());
        assert!(
            100 < min && min < median && median < worst && worst < 100_000,
            "{t}"
        );
        assert_eq!(
            t["modes"].as_array().unwrap().len(),
            8,
            "all are counted: {t}"
        );
    }
    let again = target(&["--quick", "--json", "--only", "M4F"]).unwrap();
    let again = parsed(&again.stdout);
    let first = targets.iter().find(|t| t["name"] == "M4F").unwrap();
    assert_eq!(again["targets"], Value::Array(vec![first.clone()]));
}

/// Without the emulator the command says what to install.
#[test]
fn a_missing_emulator_is_named() {
    let output = host()
        .current_dir(root())
        .env("PATH", "")
        .args(["target", "--quick"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(
        error.contains("qemu-system-arm is not installed"),
        "{error}"
    );
    assert!(error.contains("apt-get install"), "{error}");
    assert!(output.stdout.is_empty());
}
