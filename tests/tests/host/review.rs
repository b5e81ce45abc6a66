//! `review`: from the memory of a supervisor to what a person reads, of files that are whole and of those that are not.

mod damage;
mod lies;
pub(crate) mod logs;

use firmware_bench::record::file::{PlaneRecord, RecordFile};
use firmware_bench::record::identify::Estimate;
use firmware_bench::record::narrative::Event;
use firmware_bench::record::replay::replay;
use firmware_bench::run::controller as bench;
use serde_json::Value;
use supervisor::{
    Config, Core, Events, NO_STATE, Prepared, Q, RotorSupervisor, Scalar, Stamp, Status, Supervisor,
};
use system_tests::ran::{Folder, has, list};
use system_tests::rig::{config, landing, sample, shaft};
use system_tests::storm::{AnyBits, Chance, Storm};
use test_support::records::written;

/// A landing of one plane, of a core without floating point, and of a rotor.
fn landings() -> [Vec<u8>; 3] {
    let mut plane = Supervisor::<64>::new(&config()).unwrap();
    let prepared = Prepared::<Q>::new(&config()).unwrap();
    let mut core = Core::<Q, 64>::new(&prepared);
    let mut rotor = RotorSupervisor::<64>::new(&shaft(&config()), &[config(); 2]).unwrap();
    let scaling = config().scaling();
    for i in 0..900 {
        let at = sample(i, landing(i));
        plane.tick(&at);
        core.tick(&test_support::in_numbers(&scaling.sample(&at)));
        rotor.tick(&[at, sample(i, [1e-6 * (i % 3) as f32; 2])]);
    }
    let both = [0, 1].map(|end| written(&rotor.record(end).unwrap()));
    [
        written(&plane.record().unwrap()),
        written(&core.record().unwrap()),
        both.concat(),
    ]
}

#[test]
fn what_was_written_is_read_and_replays() {
    for (bytes, planes) in landings().iter().zip([1, 1, 2]) {
        let file = RecordFile::of(bytes);
        assert_eq!(file.damage, []);
        assert_eq!(file.records.len(), planes);
        let events = file.events();
        let [event] = &events[..] else {
            panic!("{} events", events.len())
        };
        let replay = event.replay.unwrap();
        assert_eq!(replay.differing, 0);
        assert!(replay.ticks > planes * 48, "{replay:?}");
        let told = event.narrative().unwrap();
        assert_eq!(
            (told.outcome, told.touches, told.landings),
            ("levitated", Some(1), 1)
        );
        // A tick that was told something else is found.
        let mut wrong = file.clone();
        let entry = wrong.records[0].entries.get_mut(&40).unwrap();
        entry.position[0] ^= 1 << 16;
        let of: Vec<&PlaneRecord> = wrong.records.iter().collect();
        let differs = replay_of(&of);
        assert!(differs.0 > 0, "{differs:?}");
        let after = wrong.records[0].entries[&40].sequence..;
        assert!(after.contains(&differs.1.unwrap()), "{differs:?}");
    }
}

fn replay_of(records: &[&PlaneRecord]) -> (usize, Option<u32>) {
    let replay = replay(records).unwrap();
    (replay.differing, replay.first_difference)
}

/// What is found out of whatever a file has is a number in its interval, and a contact ends after it began.
fn finds_sound_figures(file: &RecordFile, name: &str) {
    for found in file.events().iter().filter_map(Event::findings) {
        let told = &found.identified;
        let all = [
            told.friction_coefficient,
            told.restitution,
            told.load_x_n,
            told.load_y_n,
            told.eccentricity_m,
            told.clearance_m,
        ];
        for Estimate { value, low, high } in all.into_iter().flatten() {
            assert!(low <= value && value <= high, "{name}: {told:?}");
        }
        for contact in &found.contacts {
            assert!(contact.from_tick <= contact.to_tick, "{name}: {contact:?}");
        }
    }
}

/// A core and its samples.
trait Stormed: Scalar + AnyBits {}
impl Stormed for f32 {}
impl Stormed for Q {}

/// Records of streams with arbitrary bits in them, gaps and faults.
fn storms<S: Stormed>(seeds: std::ops::Range<u64>) -> usize {
    let mut records = 0;
    for seed in seeds {
        let mut chance = Chance::new(seed ^ 0xF00D);
        let with = Config {
            handover_dwell_s: 5e-4 * chance.share(),
            ..config()
        };
        let mut core = Core::<S, 64>::new(&Prepared::new(&with).unwrap());
        let mut storm = Storm::new(seed);
        for _ in 0..4000 {
            core.tick(&storm.next_sample::<S>());
            let Some(record) = core.record() else {
                continue;
            };
            let file = RecordFile::of(&written(&record));
            assert_eq!(file.damage, [], "{seed}");
            finds_sound_figures(&file, &seed.to_string());
            let of: Vec<&PlaneRecord> = file.records.iter().collect();
            // One that began before there was a tick to keep the state after has none.
            match replay(&of) {
                Ok(replay) => {
                    assert_eq!(replay.differing, 0, "{seed}");
                    records += 1;
                }
                Err(why) => assert_eq!(file.records[0].head.state_at, NO_STATE, "{seed}: {why}"),
            }
            core.rearm();
        }
    }
    records
}

#[test]
fn records_of_arbitrary_samples_replay_to_the_bit() {
    let records = [storms::<f32>(0..150), storms::<Q>(0..150)];
    assert!(records.iter().all(|n| *n > 100), "{records:?}");
}

/// Whatever ends an event is said, and no verdict is given that it does not bear.
#[test]
fn a_bearing_that_is_switched_off_is_no_recovery() {
    let mut plane = Supervisor::<64>::new(&config()).unwrap();
    for i in 0..400 {
        let mut at = sample(i, landing(i.min(140)));
        if i > 200 {
            at.status -= Status::BEARING_ON;
        }
        plane.tick(&at);
    }
    let file = RecordFile::of(&written(&plane.record().unwrap()));
    let told = file.events()[0].narrative().unwrap();
    assert_eq!(told.outcome, "bearing off");
    assert!(
        told.paragraph(0.0).contains("Look at the machine"),
        "{}",
        told.paragraph(0.0)
    );
    // One plane of two says nothing of the machine.
    let [.., rotor] = landings();
    let half = RecordFile::of(&rotor[..rotor.len() / 2]);
    assert!(half.is_intact() && half.events()[0].narrative().is_none());
}

/// A change of the configuration on the way ends the replay before it: the record has the one of the beginning.
#[test]
fn a_replay_ends_where_the_configuration_changes() {
    let mut plane = Supervisor::<64>::new(&config()).unwrap();
    for i in 0..900 {
        if i == 110 {
            let other = Config {
                friction_coefficient: 0.3,
                ..config()
            };
            plane.reconfigure(&other).unwrap();
        }
        plane.tick(&sample(i, landing(i)));
    }
    let file = RecordFile::of(&written(&plane.record().unwrap()));
    let [record] = &file.records[..] else {
        panic!()
    };
    assert_eq!(record.config.unwrap().friction_coefficient, 0.15);
    let changed = (record.entries.iter())
        .find(|(_, e)| u32::from(e.events) & Events::RECONFIGURED.bits() != 0);
    let (at, _) = changed.unwrap();
    let replay = replay(&[record]).unwrap();
    assert_eq!(replay.differing, 0);
    assert_eq!(replay.ticks, at - record.head.state_at as usize);
}

/// A run leaves a record; a person reads what happened, and a program the same.
#[test]
fn a_person_and_a_program_read_what_happened() {
    let folder = Folder::fresh();
    folder.ran("run @overload_then_release --out .").good();
    let review = |more: &str| folder.ran(&format!("review record_supervisor.bin {more}"));
    let text = review("").good();
    for word in [
        "touch",
        "the levitation controller has the bearing again",
        "Nothing speaks against running on",
        "all to the last bit",
        "ENGAGED",
        "[ms]",
        "[µm]",
        "[N]",
        "to the end of the event",
    ] {
        has(&text, &[word]);
    }
    let told = review("--json").json();
    assert_eq!(
        (&told["intact"], &told["format"]),
        (&true.into(), &3.into())
    );
    assert_eq!(told["summary"]["outcome"], "levitated");
    assert_eq!(told["summary"]["coast_down"], false);
    assert_eq!(told["replay"]["differing"], 0);
    assert!(told["replay"]["ticks"].as_u64() > Some(300));
    let verdict = folder.json("verdict.json");
    let supervision = &verdict["policies"]["supervisor"]["supervision"];
    assert_eq!(told["summary"]["landings"], supervision["landings"]);
    let ticks = list(&told["planes"][0]["ticks"]);
    assert_eq!(review("--csv").good().lines().count(), 1 + ticks.len());

    // Damaged: what is whole is shown, and the exit code is that of bad input.
    let mut bytes = folder.bytes("record_supervisor.bin");
    let at = bytes.len() / 2;
    bytes[at] ^= 1;
    folder.put("record_supervisor.bin", &bytes);
    let shown = review("");
    has(&shown.printed, &["ENGAGED"]);
    has(&shown.fails(2), &["are of no whole section"]);
    let json = review("--json");
    let told: Value = serde_json::from_str(&json.printed).unwrap();
    json.fails(2);
    assert_eq!(told["intact"], false);
    has(told["error"].as_str().unwrap(), &["bytes"]);
}

/// A stamp comes back.
#[test]
fn a_stamp_comes_back() {
    let mut plane = Supervisor::<64>::new(&config()).unwrap();
    for i in 0..900 {
        plane.tick(&sample(i, landing(i)));
    }
    let record = plane.record().unwrap();
    let stamp = Stamp {
        firmware: 77,
        time_us: 0x1_2345_6789,
        at_sequence: 899,
    };
    let bytes = bench::written(&record, &stamp);
    let head = RecordFile::of(&bytes).records[0].head;
    assert_eq!(
        (head.firmware, head.time_us, head.at_sequence),
        (stamp.firmware, stamp.time_us, stamp.at_sequence)
    );
}
