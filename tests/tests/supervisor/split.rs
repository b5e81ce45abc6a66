//! A supervisor in two halves: the same as the whole, and whatever comes between what.

use firmware_bench::record::file::RecordFile;
use firmware_bench::record::replay::replay;
use firmware_image::under_test::shaft;
use std::sync::atomic::{AtomicBool, Ordering};
use supervisor::{
    Command, Config, Core, Events, Prepared, Q, QueuedEvent, Reader, Record, Report,
    RotorSupervisor, Scalar, Stamp, Status, Supervisor,
};
use system_tests::per_unit::in_numbers;
use system_tests::rig::{LANDING_TICKS as LANDING, config, landing as way, sample};

const RECORD: usize = 64;

fn written<S: Scalar, const N: usize>(record: &Record<'_, S, N>) -> Vec<u8> {
    let sections = (0..).map_while(|i| record.section(i, &Stamp::default()));
    sections
        .flat_map(|mut section| section.seal().to_vec())
        .collect()
}

/// Whether it is of one of the last sixteen ticks; right after an event's of this one.
fn is_in_time(reports: &[Report], published: Option<Report>, after_an_event: bool) -> bool {
    let ticks = if after_an_event { 1 } else { 16 };
    (reports.iter().rev().take(ticks)).any(|report| published == Some(*report))
}

/// Takes everything there is.
fn taken<S: Scalar, const N: usize>(
    reader: &mut Reader<'_, S, N>,
    events: &mut Vec<QueuedEvent>,
    records: &mut Vec<Vec<u8>>,
) {
    while let Some(event) = reader.next_event() {
        events.push(event);
    }
    let record = reader.record().map(|record| written(&record));
    if let Some(record) = record {
        records.push(record);
        reader.rearm();
        assert!(reader.record().is_none());
    }
}

/// Requirement: SR-31
#[test]
fn halves_do_what_the_whole_does() {
    let mut whole = Supervisor::<RECORD>::new(&config()).unwrap();
    let mut parted = whole.clone();
    let (mut ticker, mut reader) = parted.split();
    let (mut events, mut records) = (Vec::new(), Vec::new());
    let mut of_whole = (Vec::new(), Vec::new());
    let (mut reports, mut happened) = (vec![whole.report()], false);
    for i in 0..3 * LANDING {
        if i == 1000 {
            let other = Config {
                clearance_m: 1.98e-4,
                ..config()
            };
            whole.reconfigure(&other).unwrap();
            ticker.reconfigure(&other).unwrap();
            reports.push(whole.report());
        }
        let at = sample(i, way(i));
        let command = whole.tick(&at);
        assert_eq!(ticker.tick(&at), command, "tick {i}");
        let published = reader.published();
        assert_eq!(published.mode(), command.mode, "tick {i}");
        reports.push(whole.report());
        let after = happened && command.events.is_empty();
        happened = !command.events.is_empty();
        assert!(is_in_time(&reports, published.report(), after), "tick {i}");
        taken(&mut reader, &mut events, &mut records);
        while let Some(event) = whole.next_event() {
            of_whole.0.push(event);
        }
        if let Some(record) = whole.record().map(|record| written(&record)) {
            of_whole.1.push(record);
            whole.rearm();
        }
    }
    assert_eq!(records.len(), 3);
    assert_eq!((events, records), of_whole);
}

/// What was given back while it was in halves is armed again when it is whole.
#[test]
fn a_whole_goes_on_where_its_halves_left_off() {
    let mut plane = Core::<Q, RECORD>::new(&Prepared::new(&config()).unwrap());
    let scaling = config().scaling();
    let samples = |i| in_numbers(&scaling.sample(&sample(i, way(i))));
    let (mut ticker, mut reader) = plane.split();
    for i in 0..LANDING {
        ticker.tick(&samples(i));
    }
    let first = written(&reader.record().expect("frozen"));
    reader.rearm();
    assert!(plane.record().is_none());
    for i in LANDING..2 * LANDING {
        plane.tick(&samples(i));
    }
    let second = written(&plane.record().expect("another one"));
    assert_ne!(first, second);
    let file = RecordFile::of(&second);
    assert!(file.is_intact());
    let replay = replay(&file.records.iter().collect::<Vec<_>>()).unwrap();
    assert_eq!(replay.differing, 0);
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
    let (mut told, mut reports) = (Vec::new(), 0_u32);
    std::thread::scope(|scope| {
        let ticks = scope.spawn(|| {
            let mut told: Vec<(u32, Command)> = Vec::new();
            let mut i = 0;
            while told.len() < 400 || i % LANDING != 0 {
                let command = ticker.tick(&sample(i, way(i)));
                if !command.events.is_empty() {
                    told.push((i, command));
                }
                i += 1;
                if i % LANDING == 0 {
                    // The other side has a turn where there is one processor.
                    std::thread::yield_now();
                }
            }
            over.store(true, Ordering::Release);
            told
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
        told = ticks.join().unwrap();
    });
    taken(&mut reader, &mut events, &mut records);
    assert!(reports > 0 && !records.is_empty(), "{reports}");
    for bytes in &records {
        let file = RecordFile::of(bytes);
        assert!(file.is_intact(), "{:?}", file.damage);
        let replay = replay(&file.records.iter().collect::<Vec<_>>()).unwrap();
        assert_eq!(replay.differing, 0);
    }
    // In order, each as it was told; where one was lost the next one says so.
    let mut told = told.into_iter();
    for event in events {
        let lost = event.events.contains(Events::QUEUE_FULL);
        let asked = event.events - Events::QUEUE_FULL - Events::RECORD_FROZEN;
        if asked.is_empty() {
            continue;
        }
        let (sequence, command) = if lost {
            told.find(|(sequence, _)| *sequence == event.sequence)
        } else {
            told.next()
        }
        .unwrap();
        assert_eq!(sequence, event.sequence);
        assert_eq!(command.events - Events::RECORD_FROZEN, asked);
    }
}

/// Requirement: SR-31
#[test]
fn halves_of_a_rotor_do_what_the_whole_does() {
    let mut whole = RotorSupervisor::<RECORD>::new(&shaft(&config()), &[config(); 2]).unwrap();
    let mut parted = whole.clone();
    let (mut ticker, mut reader) = parted.split();
    let mut files = (Vec::new(), Vec::new());
    let mut events = (Vec::new(), Vec::new());
    let mut reports = [0, 1].map(|end| vec![whole.plane(end).report()]);
    for i in 0..2 * LANDING {
        let quiet = sample(i, [1e-6 * (i % 3) as f32; 2]);
        let samples = [sample(i, way(i)), quiet];
        assert_eq!(ticker.tick(&samples), whole.tick(&samples), "tick {i}");
        for end in [0, 1] {
            reports[end].push(whole.plane(end).report());
            let published = reader.published(end).report();
            assert!(is_in_time(&reports[end], published, false), "tick {i}");
            events
                .0
                .extend(std::iter::from_fn(|| reader.next_event(end)));
            let more = std::iter::from_fn(|| whole.plane(end).next_event());
            events.1.extend(more);
        }
        let both = [0, 1].map(|end| reader.record(end).map(|record| written(&record)));
        if let [Some(first), Some(second)] = both {
            files.0.push([first, second].concat());
            reader.rearm();
        }
        let mut of_whole = Vec::new();
        whole.collect(|_, record| of_whole.extend(written(record)));
        files.1.extend((!of_whole.is_empty()).then_some(of_whole));
    }
    assert_eq!(files.0.len(), 2);
    assert_eq!(files.0, files.1);
    assert_eq!(events.0, events.1);
    for bytes in &files.0 {
        let file = RecordFile::of(bytes);
        let replay = replay(&file.records.iter().collect::<Vec<_>>()).unwrap();
        assert_eq!(replay.differing, 0);
    }
}

/// A record that nobody takes away holds up no tick, and what comes meanwhile is counted.
#[test]
fn a_reader_that_never_comes_costs_the_next_record_alone() {
    let mut plane = Supervisor::<RECORD>::new(&config()).unwrap();
    let (mut ticker, mut reader) = plane.split();
    for i in 0..3 * LANDING {
        let command = ticker.tick(&sample(i, way(i)));
        assert!(command.force_n.iter().all(|f| f.is_finite()));
    }
    let first = written(&reader.record().expect("of the first landing"));
    let file = RecordFile::of(&first);
    assert!(file.is_intact() && file.records[0].head.closed_at < LANDING);
    reader.rearm();
    for i in 3 * LANDING..4 * LANDING {
        let mut at = sample(i, way(i));
        at.status |= Status::SPIN_VALID;
        ticker.tick(&at);
    }
    let second = RecordFile::of(&written(&reader.record().unwrap()));
    assert_eq!(second.records[0].head.dropped, 2);
}
