//! Records that were taken while ticks went on, or kept for later: whole, and replayed to the bit by the host.

use firmware_bench::record::file::RecordFile;
use firmware_bench::record::replay::NoReplay;
use std::sync::atomic::{AtomicBool, Ordering};
use supervisor::{
    Archive, Command, Core, Events, Prepared, Q, RotorArchive, RotorSupervisor, Supervisor,
};
use system_tests::parameters;
use system_tests::rig::{LANDING_TICKS as LANDING, config, landing, sample, shaft};
use test_support::in_numbers;
use test_support::records::{taken, written};

const RECORD: usize = 64;

/// Events of a file in which nothing is damaged that are replayed, each to the bit: all of which there is a state.
fn replayed(bytes: &[u8]) -> usize {
    let file = RecordFile::of(bytes);
    assert_eq!(file.damage, []);
    let events = file.events();
    let replays = events.iter().filter(|event| match event.replay {
        Ok(replay) => replay.differing == 0 || panic!("{replay:?}"),
        Err(NoReplay::Missing) => {
            assert!(event.records.iter().all(|record| record.state.is_none()));
            false
        }
        Err(other) => panic!("{other}"),
    });
    replays.count()
}

/// Given back in each tick of a landing: a record has no state only if the supervisor engages in the tick that goes on
/// recording, or had.
#[test]
fn of_what_begins_with_the_event_there_is_a_state() {
    let without = (0..LANDING).filter(|back| {
        let mut plane = Supervisor::<RECORD>::new(&config()).unwrap();
        let given_back = LANDING + back;
        let mut engaged = false;
        for i in 0..3 * LANDING {
            if i == given_back {
                plane.rearm();
            }
            let acts = plane.tick(&sample(i, landing(i))).mode.is_engaged();
            engaged |= acts && i == given_back;
        }
        let replays = replayed(&written(&plane.record().unwrap()));
        assert!(engaged || replays == 1, "{back}");
        replays == 0
    });
    assert!((1..LANDING / 2).contains(&(without.count() as u32)));
}

/// Two processors that see the same memory: one ticks as fast as it can, the other reads as fast as it can.
/// Requirement: SR-31
#[test]
fn nothing_is_torn_where_both_run_at_once() {
    let mut plane = Supervisor::<RECORD>::new(&config()).unwrap();
    let (mut ticker, mut reader) = plane.split();
    let published = reader.published();
    let over = AtomicBool::new(false);
    let (mut events, mut records) = (Vec::new(), Vec::new());
    let (mut ticked, mut reports) = (Vec::new(), 0_u32);
    std::thread::scope(|scope| {
        let ticks = scope.spawn(|| {
            let mut ticked: Vec<(u32, Command)> = Vec::new();
            let mut i = 0;
            while ticked.len() < 400 || i % LANDING != 0 {
                let command = ticker.tick(&sample(i, landing(i)));
                if !command.events.is_empty() {
                    ticked.push((i, command));
                }
                i += 1;
                if i % LANDING == 0 {
                    // The other side has a turn where there is one processor.
                    std::thread::yield_now();
                }
            }
            over.store(true, Ordering::Release);
            ticked
        });
        scope.spawn(|| {
            let mut last = 0;
            while !over.load(Ordering::Acquire) {
                if let Some(report) = published.report() {
                    // Of one tick: each landing here has one touch.
                    assert!(report.landings == report.impacts && report.landings >= last);
                    last = report.landings;
                    reports += 1;
                }
                std::thread::yield_now();
            }
        });
        while !over.load(Ordering::Acquire) {
            taken(&mut reader, &mut events, &mut records);
        }
        ticked = ticks.join().unwrap();
    });
    taken(&mut reader, &mut events, &mut records);
    let replays: usize = records.iter().map(|bytes| replayed(bytes)).sum();
    assert!(reports > 0 && replays > 0, "{reports} {replays}");
    // In order, each as it was published; where one was lost the next one says so.
    let mut ticked = ticked.into_iter();
    for event in events {
        let lost = event.events.contains(Events::QUEUE_FULL);
        let asked = event.events - Events::QUEUE_FULL - Events::RECORD_FROZEN;
        if asked.is_empty() {
            continue;
        }
        let mut skipped = ticked
            .by_ref()
            .skip_while(|(i, _)| lost && *i != event.sequence);
        let (sequence, command) = skipped.next().unwrap();
        assert_eq!(sequence, event.sequence);
        assert_eq!(command.events - Events::RECORD_FROZEN, asked);
    }
}

/// Of a core in fixed point, and of both planes of a rotor.
#[test]
fn what_an_archive_kept_is_replayed() {
    let mut core = Core::<Q, RECORD>::new(&Prepared::new(&config()).unwrap());
    let mut rotor = RotorSupervisor::<RECORD>::new(&shaft(&config()), &[config(); 2]).unwrap();
    let scaling = config().scaling();
    let ((mut of_core, mut core), (mut of_rotor, mut rotor)) = (core.split(), rotor.split());
    let mut records = Archive::<Q, RECORD, 2>::new();
    let mut pairs = RotorArchive::<RECORD, 2>::new();
    for i in 0..3 * LANDING {
        let at = sample(i, landing(i));
        of_core.tick(&in_numbers(&scaling.sample(&at)));
        of_rotor.tick(&[at, sample(i, [1e-6 * (i % 3) as f32; 2])]);
        records.take(&mut core);
        pairs.take(&mut rotor);
    }
    let (mut of_core, mut of_rotor) = (Vec::new(), Vec::new());
    while let Some(record) = records.oldest() {
        of_core.extend(written(&record));
        records.discard();
    }
    while pairs.count() > 0 {
        let both = [0, 1].map(|end| written(&pairs.oldest(end).unwrap()));
        of_rotor.extend(both.concat());
        pairs.discard();
    }
    assert_eq!([replayed(&of_core), replayed(&of_rotor)], [2, 2]);
    let both = RecordFile::of(&of_rotor).records;
    assert!(both.iter().all(|record| record.shaft.is_some()));
}

/// As the page on records has it.
#[test]
fn an_event_takes_as_much_as_the_page_says() {
    parameters::check(parameters::RECORDS);
}
