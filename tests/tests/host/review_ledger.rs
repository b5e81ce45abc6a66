//! `review --ledger`: how many landings a retainer bearing may still bear, and what is said of a ledger that is none.

use firmware_bench::run::controller as bench;
use serde_json::Value;
use supervisor::{LEDGER_BYTES, Ledger, Record, RotorSupervisor, Stamp, Supervisor};
use system_tests::ran::{Folder, has, lacks, list, number, scene_text};
use system_tests::rig::{LANDING_TICKS, config, landing, sample, shaft};

/// The retainer bearings that `--json` has, and the text without.
fn told(folder: &Folder, more: &str) -> (Vec<Value>, String) {
    let line = format!("review landing.bin {more}");
    let json = folder.ran(&format!("{line} --json")).json();
    (list(&json["bearings"]).to_vec(), folder.ran(&line).good())
}

fn written<const N: usize>(record: &Record<'_, f32, N>) -> Vec<u8> {
    bench::written(record, &Stamp::default())
}

/// A landing as firmware keeps it, and its severity.
fn landed(folder: &Folder, ledger: &mut Ledger) -> f64 {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    (0..LANDING_TICKS).for_each(|i| _ = supervisor.tick(&sample(i, landing(i))));
    let record = supervisor.record().unwrap();
    assert!(ledger.take_in(&record));
    folder.put("landing.bin", written(&record));
    record.summary().severity.into()
}

/// Requirement: SR-39
#[test]
fn what_is_left_is_what_the_rule_says() {
    let folder = Folder::fresh();
    let mut ledger = Ledger::new(7, 20.0);
    let severity = landed(&folder, &mut ledger);
    assert!(severity > 0.0);

    // Without a ledger: what the supervisor has counted, against the limit of its configuration.
    let (bearings, text) = told(&folder, "");
    let [bearing] = &bearings[..] else {
        panic!("{bearings:?}")
    };
    let allowed = f64::from(config().severity_limit);
    assert_eq!(bearing["counted_by"], "record");
    assert!(bearing["bearing"].is_null() && bearing["left_like_the_worst"].is_null());
    let like_this = number(&bearing["left_like_this"]);
    assert!((like_this - (allowed - severity) / severity).abs() <= 1.0);
    let room = format!("Room for landings: {like_this} like the mean, {like_this} like this one.");
    has(
        &text,
        &[&room, "since the supervisor was made: 1 landing has used"],
    );
    has(&text, &["Nothing speaks against running on"]);

    // Twenty more before this one, a worst among them: 40 − 9 − s are left.
    let mut before = Ledger::new(7, 40.0);
    let events = [6.5].into_iter().chain([2.5 / 19.0; 19]);
    let mut index = 0.0;
    for (landings, severity) in (1..).zip(events) {
        index += severity;
        let summary = supervisor::Summary {
            landings,
            severity_index: index,
            ..Default::default()
        };
        before.add(&summary, 0);
    }
    before.begin_run();
    landed(&folder, &mut before);
    folder.put("ledger.bin", before.to_bytes());
    let with_ledger = |more: &str| told(&folder, &format!("--ledger ledger.bin {more}"));
    let (bearings, text) = with_ledger("");
    let bearing = &bearings[0];
    assert_eq!(bearing["counted_by"], "ledger");
    for (key, is) in [
        ("bearing", 7.into()),
        ("landings", 21.into()),
        ("has_this_event", Value::Bool(true)),
    ] {
        assert_eq!(bearing[key], is, "{key}");
    }
    assert!(severity < 6.5, "{severity}");
    let left = 31.0 - severity;
    let like = |key: &str| number(&bearing[key]);
    assert!((like("severity_sum") - 9.0 - severity).abs() < 1e-4);
    assert_eq!(like("left_like_the_worst"), (left / 6.5).floor());
    assert!((like("left_like_the_mean") - left / ((9.0 + severity) / 21.0)).abs() <= 1.0);
    assert!((like("left_like_this") - left / severity).abs() <= 1.0);
    let used = format!(
        "Retainer bearing 7: 21 landings have used {:.0} % of what it is allowed (severity {:.2} of 40",
        (9.0 + severity) / 0.4,
        9.0 + severity
    );
    has(&text, &[&used, "this event is the last one in it"]);

    // What the user allows counts before all; and where it is used up the verdict says so.
    let (bearings, text) = with_ledger("--allowance 20");
    let left = ((11.0 - severity) / 6.5).floor();
    assert_eq!(number(&bearings[0]["left_like_the_worst"]), left);
    has(
        &text,
        &["More than half of what the retainer bearing may bear"],
    );
    lacks(&text, &["Nothing speaks against"]);
    let (bearings, text) = with_ledger("--allowance 3");
    assert_eq!(number(&bearings[0]["left_like_this"]), 0.0);
    has(&text, &["inspect it before the machine runs on"]);

    // One of another event, and one without any.
    before.closed_at = 1;
    folder.put("ledger.bin", before.to_bytes());
    let (bearings, text) = with_ledger("");
    assert_eq!(bearings[0]["has_this_event"], false);
    has(&text, &["its last event is another one than this"]);
    folder.put("ledger.bin", Ledger::new(8, 20.0).to_bytes());
    let (bearings, text) = with_ledger("");
    assert_eq!(bearings[0]["landings"], 0);
    assert_eq!(bearings[0]["has_this_event"], false);
    let none =
        "Retainer bearing 8: 0 landings have used 0 % of what it is allowed (severity 0.00 of 20";
    has(&text, &[none]);
}

/// Each plane of a rotor has a bearing of its own.
#[test]
fn a_rotor_has_two_ledgers() {
    let folder = Folder::fresh();
    let mut rotor = RotorSupervisor::<64>::new(&shaft(&config()), &[config(); 2]).unwrap();
    for i in 0..LANDING_TICKS {
        rotor.tick(&[sample(i, landing(i)), sample(i, [1e-6 * (i % 3) as f32; 2])]);
    }
    let mut ledgers = [Ledger::new(1, 20.0), Ledger::new(2, 10.0)];
    let records = [0, 1].map(|end| rotor.record(end).unwrap());
    for (ledger, record) in ledgers.iter_mut().zip(&records) {
        ledger.take_in(record);
    }
    folder.put("landing.bin", records.each_ref().map(written).concat());
    folder.put("ledger.bin", ledgers.map(|l| l.to_bytes()).as_flattened());
    let (bearings, text) = told(&folder, "--ledger ledger.bin");
    let landings = bearings.iter().map(|b| (&b["bearing"], &b["landings"]));
    assert!(landings.eq([(&1.into(), &1.into()), (&2.into(), &0.into())]));
    has(&text, &["Plane 1. Retainer bearing 2: 0 landings"]);
    folder.put("ledger.bin", ledgers[0].to_bytes());
    let refused = folder.ran("review landing.bin --ledger ledger.bin");
    has(&refused.fails(2), &["it has 48 bytes"]);
}

/// Requirement: SR-39
#[test]
fn a_ledger_that_is_none_gives_an_error_and_no_figure() {
    let folder = Folder::fresh();
    let mut ledger = Ledger::new(7, 20.0);
    landed(&folder, &mut ledger);
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
    let refused = |more: &str, wanted: &str| {
        for json in ["", "--json"] {
            let refused = folder.ran(&format!("review landing.bin {more} {json}"));
            lacks(&refused.printed, &["Room for", "left_like"]);
            has(&refused.fails(2), &[wanted]);
        }
    };
    for (bytes, wanted) in cases {
        folder.put("ledger.bin", bytes);
        refused("--ledger ledger.bin", wanted);
    }
    refused("--ledger none.bin", "none.bin");
    for allowance in ["0", "-3", "NaN", "inf"] {
        refused(
            &format!("--allowance {allowance}"),
            "expected a severity above 0",
        );
    }
    folder.put("landing.bin", [1; 64]);
    refused("--allowance 5", "no section of a flight record");
}

/// What a bearing may bear: the command line before the scene, that before the ledger, and that before the configuration.
#[test]
fn the_allowance_is_the_first_that_is_given() {
    let folder = Folder::fresh();
    let text = scene_text("overload_then_release");
    folder.put(
        "told.toml",
        format!("{text}\n[retainer]\nseverity_allowed = 3.0\n"),
    );
    folder
        .ran("run told.toml --no-trace --quiet --out .")
        .good();
    folder.put("landing.bin", folder.bytes("record_supervisor.bin"));
    folder.put("ledger.bin", Ledger::new(7, 11.0).to_bytes());
    let both = "--ledger ledger.bin --scene told.toml";
    let set = format!("{both} --set retainer.severity_allowed=4");
    for (more, allowed) in [
        ("", 20.0),
        ("--ledger ledger.bin", 11.0),
        ("--scene @overload_then_release", 20.0),
        ("--scene told.toml", 3.0),
        (both, 3.0),
        (&set, 4.0),
        (&format!("{set} --allowance 5"), 5.0),
    ] {
        let (bearings, _) = told(&folder, more);
        assert_eq!(bearings[0]["severity_allowed"], allowed, "{more}");
    }
    has(&told(&folder, both).1, &["(severity 0.00 of 3,"]);
}
