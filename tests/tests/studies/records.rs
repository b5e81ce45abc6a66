//! Records of random events, in closed loops with faults: written down, read and replayed.

use firmware_bench::record::file::RecordFile;
use firmware_bench::run::closed_loop::{Accuracy, Keep, Recorders, record, run};
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::campaign::run_all;
use firmware_studies::machines::rotors::RotorCase;
use firmware_studies::paired::machines::MachineClass;
use firmware_studies::paired::{harm, whole_rotors};
use supervisor::Mode;

/// What came of a run with a record.
struct Ran {
    name: String,
    record: Option<Vec<u8>>,
    /// Back in the middle, by the plant; where the event of the record is the only one.
    recovered: Option<bool>,
}

/// All ticks from the state on are replayed, to the last bit; and how many of the events that are told to have ended in levitation did.
fn check(ran: &[Ran], planes: usize) -> (usize, usize, usize) {
    let (mut records, mut told, mut right) = (0, 0, 0);
    for Ran {
        name,
        record,
        recovered,
    } in ran
    {
        let Some(bytes) = record else { continue };
        let file = RecordFile::of(bytes);
        assert_eq!(file.damage, [], "{name}");
        let events = file.events();
        let [event] = &events[..] else {
            panic!("{name}: {} events", events.len())
        };
        let replay = event.replay.unwrap_or_else(|why| panic!("{name}: {why}"));
        assert_eq!(replay.differing, 0, "{name}: {replay:?}");
        // Three quarters of a record are after the trigger.
        assert!(replay.ticks >= planes * 384, "{name}: {replay:?}");
        records += 1;
        if let Some(recovered) = recovered {
            let summary = event.records[0].summary;
            let summary = summary.unwrap_or_else(|| panic!("{name}: no summary"));
            // What is handed back is levitation's to bring in or not.
            if summary.mode == Mode::Levitated as u32 {
                told += 1;
                right += usize::from(*recovered);
            }
        }
    }
    (records, told, right)
}

/// Hundreds of one plane: every kind of event with every kind of sensors, at the rates that machines have.
#[test]
fn records_of_closed_loops_replay_to_the_bit() {
    let mut jobs = Vec::new();
    for number in 0..5 {
        jobs.extend(harm::claimed().into_iter().map(|class| (class, number)));
    }
    let ran = run_all(&jobs, &(), |(class, number)| {
        let (scene, _) = class.scene(20_261_126, *number).unwrap();
        let ran = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {});
        let (recovered, read_out) = match ran {
            Ok((figures, trace)) => (Some(figures.recovered), trace.read_out),
            Err(_) => (None, None),
        };
        let report = read_out.as_ref().map(|r| r.report);
        let only = report.is_some_and(|r| r.landings + r.nuisance_engagements == 1);
        Ran {
            name: scene.title.clone(),
            record: read_out.and_then(|r| r.flight_record),
            recovered: recovered.filter(|_| only),
        }
    });
    let (records, told, right) = check(&ran, 1);
    assert!(records >= 250, "{records} records of {}", ran.len());
    // Sensors that lie, in pairs too, are among them: of four times as many nine of some 790 are told to levitate and do not come in.
    assert!(
        told >= 125 && 1000 * right >= 985 * told,
        "{right} of {told} outcomes are those of the plant"
    );
}

/// Both planes of a rotor, from what both remembered.
#[test]
fn records_of_rotors_replay_to_the_bit() {
    let mut jobs = Vec::new();
    for number in 0..4 {
        let classes = whole_rotors::claimed().into_iter();
        jobs.extend(classes.map(|class| (class, number)));
    }
    let ran = run_all(&jobs, &(), |(class, number)| {
        let MachineClass::Rotor(kind) = class.machine else {
            unreachable!("a rotor")
        };
        let rotor = RotorCase::new(20_261_126, kind, *number);
        let (mut scene, _) = class.scene(20_261_126, *number).unwrap();
        // Told, so that what is kept apart is replayed as well.
        for plane in &mut scene.planes {
            if let (Some(config), Some(hz)) = (&mut plane.supervisor, rotor.bending_hz()) {
                config.bending_first_hz = hz as f32;
            }
        }
        // A supervisor is read out where somebody listens.
        let mut traces = vec![Trace::default(); 2];
        let recorders = Recorders::of_planes(&mut traces);
        let (kind_of, rigour) = (PolicyKind::Supervisor, Accuracy::default());
        let ran = record(&scene, kind_of, recorders, rigour, &mut |_| {});
        let planes = ran.unwrap_or_default();
        let records: Option<Vec<Vec<u8>>> = (planes.into_iter())
            .map(|(_, read_out)| read_out?.flight_record)
            .collect();
        Ran {
            name: format!("{} {number}, {}", kind.name(), class.event.name()),
            record: records.filter(|r| !r.is_empty()).map(|r| r.concat()),
            recovered: None,
        }
    });
    let (records, ..) = check(&ran, 2);
    assert!(records >= 40, "{records} records of {}", ran.len());
}
