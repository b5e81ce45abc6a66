//! A supervisor in two halves: the same as the whole, and whatever comes between what.

use supervisor::{Core, Prepared, Q, Report, Supervisor};
use test_support::in_numbers;
use test_support::records::{taken, written};
use test_support::rig::{
    LANDING_TICKS as LANDING, config, config_with, landing as way, new_rotor, quiet, sample,
};

const RECORD: usize = 64;

/// Whether it is of one of the last sixteen ticks; right after an event's of this one.
fn is_in_time(reports: &[Report], published: Option<Report>, after_an_event: bool) -> bool {
    let ticks = if after_an_event { 1 } else { 16 };
    (reports.iter().rev().take(ticks)).any(|report| published == Some(*report))
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
            let other = config_with(|c| c.clearance_m = 1.98e-4);
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
        of_whole.0.extend(std::iter::from_fn(|| whole.next_event()));
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
    let mut never_parted = plane.clone();
    let scaling = config().scaling();
    let samples = |i| in_numbers(&scaling.sample(&sample(i, way(i))));
    let (mut ticker, mut reader) = plane.split();
    for i in 0..LANDING {
        ticker.tick(&samples(i));
        never_parted.tick(&samples(i));
    }
    let first = written(&reader.record().expect("frozen"));
    assert_eq!(first, written(&never_parted.record().unwrap()));
    reader.rearm();
    never_parted.rearm();
    assert!(plane.record().is_none());
    for i in LANDING..2 * LANDING {
        plane.tick(&samples(i));
        never_parted.tick(&samples(i));
    }
    let second = written(&plane.record().expect("another one"));
    assert_ne!(first, second);
    assert_eq!(second, written(&never_parted.record().unwrap()));
}

/// Requirement: SR-31
#[test]
fn halves_of_a_rotor_do_what_the_whole_does() {
    let mut whole = new_rotor(&config());
    let mut parted = whole.clone();
    let (mut ticker, mut reader) = parted.split();
    let mut files = (Vec::new(), Vec::new());
    let mut events = (Vec::new(), Vec::new());
    let mut reports = [0, 1].map(|end| vec![whole.plane(end).report()]);
    for i in 0..2 * LANDING {
        let samples = [sample(i, way(i)), sample(i, quiet(i))];
        assert_eq!(ticker.tick(&samples), whole.tick(&samples), "tick {i}");
        for end in [0, 1] {
            reports[end].push(whole.plane(end).report());
            let published = reader.published(end).report();
            assert!(is_in_time(&reports[end], published, false), "tick {i}");
            (events.0).extend(std::iter::from_fn(|| reader.next_event(end)));
            (events.1).extend(std::iter::from_fn(|| whole.plane(end).next_event()));
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
}
