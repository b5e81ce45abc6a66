//! `review` of a record of version 2, which is its entries and nothing else: files of earlier firmware.

use firmware_bench::record::ticks::PER_UNIT;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;
use supervisor::{Command, Entry, Events, Mode, Supervisor, crc_of};
use system_tests::host;
use system_tests::rig::{config, sample};
use tempfile::TempDir;

/// A landing, and the commands that answered it: the record as earlier firmware has written it down, and its checksum.
fn landing(first: u32) -> (Vec<u8>, u32, Vec<Command>) {
    let mut supervisor = Supervisor::<64>::new(&config()).expect("valid");
    let commands: Vec<Command> = (0..900)
        .map(|i: u16| {
            let outwards = (3e-5 * (f32::from(i) - 99.0)).clamp(0.0, 2.02e-4);
            let back = (2e-6 * (f32::from(i) - 250.0)).clamp(0.0, outwards);
            // The last digits of a sensor.
            let noise = 4e-7 * f32::from(i % 3);
            supervisor.tick(&sample(
                first.wrapping_add(i.into()),
                [outwards - back + noise, noise],
            ))
        })
        .collect();
    let record = supervisor.record().expect("frozen");
    let bytes: Vec<u8> = record.entries().flat_map(|e| version_2(&e)).collect();
    let crc = crc_of(&bytes);
    (bytes, crc, commands)
}

/// An entry as version 2 had it: position and force in 1/4096 of clearance and cap.
fn version_2(entry: &Entry) -> [u8; 16] {
    let short = |bits: u32| (f64::from(f32::from_bits(bits)) * PER_UNIT).round() as i16;
    let (position, force) = (entry.position.map(short), entry.force.map(short));
    let mut bytes = [0; 16];
    bytes[..4].copy_from_slice(&entry.sequence.to_le_bytes());
    for (i, x) in position.into_iter().chain(force).enumerate() {
        bytes[4 + 2 * i..6 + 2 * i].copy_from_slice(&x.to_le_bytes());
    }
    (bytes[12], bytes[13]) = (entry.mode, entry.limits);
    bytes[14..].copy_from_slice(&entry.events.to_le_bytes());
    bytes
}

fn show(file: &Path, more: &[&str]) -> Output {
    let mut command = host();
    command.arg("review").arg(file).args(more);
    command.output().expect("the host starts")
}

fn json(file: &Path, more: &[&str]) -> Value {
    let output = show(file, &[more, &["--json"]].concat());
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Every tick comes back as the supervisor answered it, in the units that were given; also where the sequence numbers
/// begin anew on the way.
#[test]
fn what_was_recorded_is_what_is_shown() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    for first in [0, 0xFFFF_FF90] {
        let (bytes, crc, commands) = landing(first);
        fs::write(&file, bytes).unwrap();
        let units = ["--clearance-m", "2e-4", "--force-max-n", "1000"];
        let rate = ["--sample-rate-hz", "20000", "--crc", &format!("{crc:#x}")];
        let record = json(&file, &[units, rate].concat());
        assert_eq!(record["crc"], crc);
        assert_eq!(
            (&record["missing"], &record["whole"]),
            (&0.into(), &true.into())
        );
        let ticks = record["ticks"].as_array().unwrap();
        assert_eq!(ticks.len(), 64);
        let engaged = commands
            .iter()
            .position(|c| c.events.contains(Events::ENGAGED));
        let engaged = engaged.expect("it has to act") as i64;
        for tick in ticks {
            let after = tick["tick"].as_i64().unwrap();
            let command = &commands[(engaged + after) as usize];
            assert_eq!(tick["mode"], command.mode.name());
            assert_eq!(tick["time_s"], after as f64 / 20_000.0);
            for axis in 0..2 {
                let shown = tick["force_n"][axis].as_f64().unwrap();
                let real = f64::from(command.force_n[axis]);
                let half_a_step = 0.51 * 1000.0 / 4096.0;
                assert!((shown - real).abs() < half_a_step, "{shown} N, {real} N");
            }
            let recorded = Events::from_bits_truncate(command.events.bits() & 0xFFFF);
            let events: Vec<_> = recorded.iter_names().map(|(name, _)| name).collect();
            assert_eq!(tick["events"], serde_json::json!(events));
        }
        assert_eq!(ticks[0]["tick"], -15, "a quarter before the engagement");
        // The stretches say the same as the ticks.
        let stretches = record["stretches"].as_array().unwrap();
        let sum: u64 = stretches.iter().map(|s| s["ticks"].as_u64().unwrap()).sum();
        assert_eq!(
            (sum, &stretches[0]["mode"]),
            (64, &Mode::Levitated.name().into())
        );
    }
}

/// The tables for a person have every event and the units, and every tick is a line of CSV.
#[test]
fn a_person_sees_what_happened() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    fs::write(&file, landing(7).0).unwrap();
    let text = |more: &[&str]| {
        let output = show(&file, more);
        assert!(output.status.success());
        String::from_utf8(output.stdout).unwrap()
    };
    let bare = text(&[]);
    for word in [
        "ENGAGED",
        "TOUCHED",
        "levitated",
        "[ticks]",
        "[c]",
        "[caps]",
    ] {
        assert!(bare.contains(word), "{word} is not in\n{bare}");
    }
    let units = [
        "--clearance-m",
        "2e-4",
        "--force-max-n",
        "1e3",
        "--sample-rate-hz",
        "2e4",
    ];
    let in_si = text(&units);
    for word in ["-0.750", "[ms]", "[µm]", "202.8", "[N]"] {
        assert!(in_si.contains(word), "{word} is not in\n{in_si}");
    }
    let csv = text(&["--csv"]);
    assert_eq!(csv.lines().count(), 1 + 64);
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(columns.iter().all(|n| *n == 14), "{columns:?}");
}

/// What is no record, or not the one that was meant, is said with exit code 2.
#[test]
fn what_is_no_record_is_refused() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    let (bytes, crc, _) = landing(0);
    let refused = |bytes: &[u8], more: &[&str], word: &str| {
        fs::write(&file, bytes).unwrap();
        let output = show(&file, more);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(output.stdout.is_empty());
        assert!(said.contains(word), "{word} is not in\n{said}");
    };
    refused(&bytes[..1000], &[], "1000 bytes");
    refused(&[], &[], "0 bytes");
    refused(&[0; 16 * 64], &[], "none of its 64 entries");
    let mut damaged = bytes.clone();
    damaged[16 * 3 + 12] = 8;
    refused(&damaged, &[], "entry 3");
    refused(&bytes, &["--crc", &(crc ^ 1).to_string()], "checksum");
    refused(&bytes, &["--crc", "0xnothing"], "--crc");
    refused(&bytes, &["--clearance-m", "0"], "--clearance-m");
    // In another order it is another checksum.
    let turned: Vec<u8> = bytes.chunks(16).rev().flatten().copied().collect();
    refused(&turned, &["--crc", &crc.to_string()], "checksum");
    let output = show(&folder.path().join("nothing.bin"), &[]);
    assert_eq!(output.status.code(), Some(2));
}

/// A checksum as a debugger shows it is understood, and eight decimal digits are not taken for another one.
#[test]
fn a_checksum_may_come_without_0x() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    // Until one has a letter, which no decimal number has.
    let (bytes, crc, _) = (0..)
        .map(landing)
        .find(|(_, crc, _)| format!("{crc:08x}").contains(|c: char| c.is_ascii_alphabetic()))
        .unwrap();
    fs::write(&file, bytes).unwrap();
    for text in [
        format!("{crc:08x}"),
        format!("{crc:08X}"),
        format!("{crc:#x}"),
        crc.to_string(),
    ] {
        assert!(show(&file, &["--crc", &text]).status.success(), "{text}");
    }
    for text in [
        format!("{:08x}", crc ^ 1),
        format!("{crc:x}0"),
        "12345678".to_owned(),
    ] {
        let output = show(&file, &["--crc", &text]);
        assert_eq!(output.status.code(), Some(2), "{text}");
    }
}

/// Entries have steps of 1/4096: no digit is shown that is finer, so a force at the cap is not shown above it.
#[test]
fn no_digit_is_finer_than_what_is_recorded() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    let at_cap = Entry {
        sequence: 1,
        force: [2896.0_f64, 2897.0].map(|x| ((x / PER_UNIT) as f32).to_bits()),
        ..Entry::default()
    };
    fs::write(&file, version_2(&at_cap)).unwrap();
    for (cap, shown) in [("1000", " 1000 "), ("40", " 40.00 "), ("0.5", " 0.500 ")] {
        let output = show(&file, &["--force-max-n", cap]);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(said.contains(shown), "{said}");
    }
}

/// A ring that was written down as it lies in memory, from the other end, twice or in part is told without a checksum, too.
#[test]
fn what_is_not_the_record_from_oldest_to_newest_is_told() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    let (bytes, ..) = landing(100);
    let entries: Vec<&[u8]> = bytes.chunks(16).collect();
    let mut others = vec![
        entries.iter().rev().copied().collect::<Vec<_>>().concat(),
        bytes.repeat(2),
    ];
    others.extend((1..64).map(|at| [&bytes[16 * at..], &bytes[..16 * at]].concat()));
    others.extend((1..64).map(|entries| bytes[..16 * entries].to_vec()));
    others.extend((1..64).map(|lost| bytes[16 * lost..].to_vec()));
    for other in others {
        fs::write(&file, &other).unwrap();
        let shown = show(&file, &[]);
        let said = String::from_utf8(shown.stdout).unwrap();
        assert!(shown.status.success());
        assert!(said.contains("from oldest to newest"), "{said}");
    }
    fs::write(&file, &bytes).unwrap();
    let said = String::from_utf8(show(&file, &[]).stdout).unwrap();
    assert!(!said.contains("from oldest to newest"), "{said}");
}

/// A record that began soon after the last: what was never written is left out, and a gap is counted.
#[test]
fn empty_entries_and_gaps_are_told() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("record.bin");
    let (mut bytes, ..) = landing(100);
    bytes[..16 * 4].fill(0);
    // The tick after the tenth is another's.
    bytes.drain(16 * 10..16 * 12);
    fs::write(&file, &bytes).unwrap();
    let record = json(&file, &[]);
    assert_eq!(
        (&record["empty"], &record["missing"]),
        (&4.into(), &2.into())
    );
    assert_eq!(record["ticks"].as_array().unwrap().len(), 64 - 4 - 2);
}
