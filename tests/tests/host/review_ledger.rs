//! `review --ledger`: how many landings a retainer bearing may still bear, and what is said of a ledger that is none.

use firmware_bench::run::controller as bench;
use serde_json::Value;
use std::path::PathBuf;
use std::process::Output;
use supervisor::{LEDGER_BYTES, Ledger, Record, RotorSupervisor, Stamp, Supervisor};
use system_tests::rig::{LANDING_TICKS, config, landing, sample, shaft};
use system_tests::{host, scene_path};
use tempfile::TempDir;

struct Files {
    folder: TempDir,
}

impl Files {
    fn new() -> Self {
        Self {
            folder: TempDir::new().unwrap(),
        }
    }

    fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    fn review(&self, more: &[&str]) -> Output {
        let mut host = host();
        host.current_dir(self.folder.path());
        host.args(["review", "landing.bin"]).args(more);
        host.output().unwrap()
    }

    /// The retainer bearings that `--json` has, and the text without.
    fn reviewed(&self, more: &[&str]) -> (Vec<Value>, String) {
        let json = self.review(&[&["--json"], more].concat());
        assert!(json.status.success(), "{json:?}");
        let json: Value = serde_json::from_slice(&json.stdout).unwrap();
        let text = self.review(more);
        assert!(text.status.success(), "{text:?}");
        let bearings = json["bearings"].as_array().unwrap().clone();
        (bearings, String::from_utf8(text.stdout).unwrap())
    }
}

fn written<const N: usize>(record: &Record<'_, f32, N>) -> Vec<u8> {
    bench::written(record, &Stamp::default())
}

/// A landing as firmware keeps it, and its severity.
fn landed(files: &Files, ledger: &mut Ledger) -> f64 {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    (0..LANDING_TICKS).for_each(|i| _ = supervisor.tick(&sample(i, landing(i))));
    let record = supervisor.record().unwrap();
    assert!(ledger.take_in(&record));
    files.put("landing.bin", &written(&record));
    record.summary().severity.into()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Requirement: SR-39
#[test]
fn what_is_left_is_what_the_rule_says() {
    let files = Files::new();
    let mut ledger = Ledger::new(7, 20.0);
    let severity = landed(&files, &mut ledger);
    assert!(severity > 0.0);

    // Without a ledger: what the supervisor has counted, against the limit of its configuration.
    let (bearings, text) = files.reviewed(&[]);
    let [bearing] = &bearings[..] else {
        panic!("{bearings:?}")
    };
    let allowed = f64::from(config().severity_limit);
    assert_eq!(bearing["counted_by"], "record");
    assert!(bearing["bearing"].is_null() && bearing["left_like_the_worst"].is_null());
    let like_this = number(&bearing["left_like_this"]);
    assert!((like_this - (allowed - severity) / severity).abs() <= 1.0);
    assert!(
        text.contains(&format!(
            "Room for landings: {like_this} like the mean, {like_this} like this one."
        )),
        "{text}"
    );
    assert!(
        text.contains("since the supervisor was made: 1 landing has used"),
        "{text}"
    );
    assert!(text.contains("Nothing speaks against running on"), "{text}");

    // Twenty more before this one, a worst among them: 40 − 9 − s are left.
    let mut before = Ledger::new(7, 40.0);
    let events = [6.5].into_iter().chain([2.5 / 19.0; 19]);
    let mut index = 0.0;
    for (landings, severity) in (1..).zip(events) {
        index += severity;
        before.add(
            &supervisor::Summary {
                landings,
                severity_index: index,
                ..Default::default()
            },
            0,
        );
    }
    before.begin_run();
    landed(&files, &mut before);
    files.put("ledger.bin", &before.to_bytes());
    let (bearings, text) = files.reviewed(&["--ledger", "ledger.bin"]);
    let bearing = &bearings[0];
    assert_eq!(
        (&bearing["counted_by"], &bearing["bearing"]),
        (&"ledger".into(), &7.into())
    );
    assert_eq!(
        (&bearing["landings"], &bearing["has_this_event"]),
        (&21.into(), &true.into())
    );
    assert!(severity < 6.5, "{severity}");
    let left = 31.0 - severity;
    let like = |key: &str| number(&bearing[key]);
    assert!((like("severity_sum") - 9.0 - severity).abs() < 1e-4);
    assert_eq!(like("left_like_the_worst"), (left / 6.5).floor());
    assert!((like("left_like_the_mean") - left / ((9.0 + severity) / 21.0)).abs() <= 1.0);
    assert!((like("left_like_this") - left / severity).abs() <= 1.0);
    assert!(
        text.contains(&format!(
            "Retainer bearing 7: 21 landings have used {:.0} % of what it is allowed (severity {:.2} of 40",
            (9.0 + severity) / 0.4,
            9.0 + severity
        )),
        "{text}"
    );
    assert!(text.contains("this event is the last one in it"), "{text}");

    // What the user allows counts before all; and where it is used up the verdict says so.
    let (bearings, text) = files.reviewed(&["--ledger", "ledger.bin", "--allowance", "20"]);
    let left = ((11.0 - severity) / 6.5).floor();
    assert_eq!(number(&bearings[0]["left_like_the_worst"]), left);
    assert!(
        text.contains("More than half of what the retainer bearing may bear"),
        "{text}"
    );
    assert!(!text.contains("Nothing speaks against"), "{text}");
    let (bearings, text) = files.reviewed(&["--ledger", "ledger.bin", "--allowance", "3"]);
    assert_eq!(number(&bearings[0]["left_like_this"]), 0.0);
    assert!(
        text.contains("inspect it before the machine runs on"),
        "{text}"
    );

    // One of another event, and one without any.
    before.closed_at = 1;
    files.put("ledger.bin", &before.to_bytes());
    let (bearings, text) = files.reviewed(&["--ledger", "ledger.bin"]);
    assert_eq!(bearings[0]["has_this_event"], false);
    assert!(
        text.contains("its last event is another one than this"),
        "{text}"
    );
    files.put("ledger.bin", &Ledger::new(8, 20.0).to_bytes());
    let (bearings, text) = files.reviewed(&["--ledger", "ledger.bin"]);
    assert_eq!(
        (&bearings[0]["landings"], &bearings[0]["has_this_event"]),
        (&0.into(), &false.into())
    );
    assert!(
        text.contains("Retainer bearing 8: 0 landings have used 0 % of what it is allowed (severity 0.00 of 20"),
        "{text}"
    );
}

/// Each plane of a rotor has a bearing of its own.
#[test]
fn a_rotor_has_two_ledgers() {
    let files = Files::new();
    let mut rotor = RotorSupervisor::<64>::new(&shaft(&config()), &[config(); 2]).unwrap();
    for i in 0..LANDING_TICKS {
        rotor.tick(&[sample(i, landing(i)), sample(i, [1e-6 * (i % 3) as f32; 2])]);
    }
    let mut ledgers = [Ledger::new(1, 20.0), Ledger::new(2, 10.0)];
    let records = [0, 1].map(|end| rotor.record(end).unwrap());
    for (ledger, record) in ledgers.iter_mut().zip(&records) {
        ledger.take_in(record);
    }
    files.put("landing.bin", &records.each_ref().map(written).concat());
    files.put("ledger.bin", ledgers.map(|l| l.to_bytes()).as_flattened());
    let (bearings, text) = files.reviewed(&["--ledger", "ledger.bin"]);
    let landings: Vec<_> = bearings
        .iter()
        .map(|b| (&b["bearing"], &b["landings"]))
        .collect();
    assert_eq!(landings, [(&1.into(), &1.into()), (&2.into(), &0.into())]);
    assert!(
        text.contains("Plane 1. Retainer bearing 2: 0 landings"),
        "{text}"
    );
    files.put("ledger.bin", &ledgers[0].to_bytes());
    let refused = files.review(&["--ledger", "ledger.bin"]);
    let shown = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{shown}");
    assert!(shown.contains("it has 48 bytes"), "{shown}");
}

/// Requirement: SR-39
#[test]
fn a_ledger_that_is_none_gives_an_error_and_no_figure() {
    let files = Files::new();
    let mut ledger = Ledger::new(7, 20.0);
    landed(&files, &mut ledger);
    let whole = ledger.to_bytes();
    let mut damaged = whole;
    damaged[20] ^= 4;
    let cases: [(&[u8], &str); 5] = [
        (&damaged, "plane 0: the ledger is damaged"),
        (&[0xFF; LEDGER_BYTES], "nothing was ever written there"),
        (&[7; LEDGER_BYTES], "no ledger begins there"),
        (&whole[..40], "it has 40 bytes"),
        (&[], "it has 0 bytes"),
    ];
    let refused = |more: &[&str], wanted: &str| {
        for json in [&[][..], &["--json"]] {
            let output = files.review(&[more, json].concat());
            // Lines are wrapped to the terminal's width.
            let shown = String::from_utf8_lossy(&output.stderr);
            let shown = shown
                .replace('│', " ")
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" ");
            assert_eq!(output.status.code(), Some(2), "{shown}");
            assert!(shown.contains(wanted), "{wanted}: {shown}");
            let stdout = String::from_utf8_lossy(&output.stdout);
            assert!(
                !stdout.contains("Room for") && !stdout.contains("left_like"),
                "{stdout}"
            );
        }
    };
    for (bytes, wanted) in cases {
        files.put("ledger.bin", bytes);
        refused(&["--ledger", "ledger.bin"], wanted);
    }
    refused(&["--ledger", "none.bin"], "none.bin");
    for allowance in ["0", "-3", "NaN", "inf"] {
        refused(&["--allowance", allowance], "expected a severity above 0");
    }
    files.put("landing.bin", &[1; 64]);
    refused(&["--allowance", "5"], "no section of a flight record");
}

/// What a bearing may bear: the command line before the scene, that before the ledger, and that before the configuration.
#[test]
fn the_allowance_is_the_first_that_is_given() {
    let files = Files::new();
    let text = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let limited = text.clone() + "\n[retainer]\nseverity_allowed = 3.0\n";
    files.put("with.toml", limited.as_bytes());
    files.put("without.toml", text.as_bytes());
    let run = ["run", "with.toml", "--no-trace", "--quiet", "--out", "run"];
    let ran = host().current_dir(files.folder.path()).args(run).output();
    assert!(ran.unwrap().status.success());
    let run = files.folder.path().join("run/record_supervisor.bin");
    std::fs::copy(run, files.folder.path().join("landing.bin")).unwrap();
    files.put("ledger.bin", &Ledger::new(7, 11.0).to_bytes());
    let allowed = |more: &[&str]| number(&files.reviewed(more).0[0]["severity_allowed"]);
    let (ledger, scene) = (["--ledger", "ledger.bin"], ["--scene", "with.toml"]);
    assert_eq!(allowed(&[]), 20.0);
    assert_eq!(allowed(&ledger), 11.0);
    assert_eq!(allowed(&["--scene", "without.toml"]), 20.0);
    assert_eq!(allowed(&scene), 3.0);
    let both = [&ledger[..], &scene].concat();
    assert_eq!(allowed(&both), 3.0);
    let set = [&both[..], &["--set", "retainer.severity_allowed=4"]].concat();
    assert_eq!(allowed(&set), 4.0);
    let all = [&set[..], &["--allowance", "5"]].concat();
    assert_eq!(allowed(&all), 5.0);
    let (_, text) = files.reviewed(&both);
    assert!(text.contains("(severity 0.00 of 3,"), "{text}");
}
