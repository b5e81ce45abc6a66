//! Records of several events in memory of the background's.

use supervisor::{
    Archive, ArchiveIn, ArchivePlace, Core, Prepared, Q, RotorArchive, Scalar, Supervisor,
};
use test_support::in_numbers;
use test_support::records::{head, written};
use test_support::rig::{LANDING_TICKS as LANDING, config, landing, new_rotor, quiet, sample};

const RECORD: usize = 64;

/// What an archive gives, oldest first, is what would have been written down at once, but for the count of those that are gone.
fn drained<S: Scalar, const N: usize, const E: usize>(
    archive: &mut Archive<S, N, E>,
) -> Vec<Vec<u8>> {
    let mut records = Vec::new();
    while let Some(record) = archive.oldest().map(|record| written(&record)) {
        records.push(record);
        archive.discard();
    }
    records
}

/// Requirement: SR-40
#[test]
fn each_event_is_kept_as_it_froze() {
    let mut supervisor = Supervisor::<RECORD>::new(&config()).unwrap();
    let mut alone = supervisor.clone();
    let (mut ticker, mut reader) = supervisor.split();
    let mut archive = Archive::<f32, RECORD, 4>::new();
    let mut at_once = Vec::new();
    for i in 0..3 * LANDING {
        let at = sample(i, landing(i));
        assert_eq!(ticker.tick(&at), alone.tick(&at), "tick {i}");
        assert_eq!(archive.take(&mut reader), alone.record().is_some());
        if let Some(record) = alone.record() {
            at_once.push(written(&record));
            alone.rearm();
        }
    }
    assert_eq!((archive.count(), at_once.len()), (3, 3));
    assert_eq!(drained(&mut archive), at_once);
    assert!(archive.oldest().is_none() && archive.count() == 0);
    archive.discard();
    assert!(!archive.take(&mut reader), "nothing has frozen");
}

/// The oldest goes first, and the next that is written down says so.
/// Requirement: SR-40
#[test]
fn the_oldest_goes_first_and_is_counted() {
    let mut core = Core::<Q, RECORD>::new(&Prepared::new(&config()).unwrap());
    let scaling = config().scaling();
    let (mut ticker, mut reader) = core.split();
    let mut archive = Archive::<Q, RECORD, 2>::new();
    let mut dropped = Vec::new();
    for event in 1..=9_u32 {
        for i in (event - 1) * LANDING..event * LANDING {
            ticker.tick(&in_numbers(&scaling.sample(&sample(i, landing(i)))));
            // The fourth and fifth find the third frozen.
            if !(3..=5).contains(&event) {
                archive.take(&mut reader);
            }
        }
        while event % 3 == 0
            && event > 3
            && let Some(record) = archive.oldest()
        {
            dropped.push((record.summary().landings, head(&record).dropped));
            archive.discard();
        }
    }
    // Of six: 1 and 2 are gone, 4 and 5 in no record. Of the three after them one is gone.
    let wanted = [(3, 2), (6, 2), (8, 1), (9, 0)];
    assert_eq!(dropped, wanted);
}

/// Both planes of an event stay together, in an archive's own places and in those that it borrows; without one nothing is kept.
/// Requirement: SR-40
#[test]
fn of_a_rotor_both_planes_are_kept() {
    let mut rotor = new_rotor(&config());
    let (mut other, mut third) = (rotor.clone(), rotor.clone());
    let (mut ticker, mut reader) = rotor.split();
    let ((mut also, mut reads), (mut too, mut reads_none)) = (other.split(), third.split());
    let mut archive = RotorArchive::<RECORD, 2>::new();
    let mut places = [const { [const { ArchivePlace::<RECORD>::new() }; 2] }; 2];
    let [first, second] = &mut places;
    let mut borrowed = [ArchiveIn::new(first), ArchiveIn::new(second)];
    let mut none = [ArchiveIn::<RECORD>::new(&mut []), ArchiveIn::new(&mut [])];
    let mut at_once = Vec::new();
    for i in 0..3 * LANDING {
        let samples = [sample(i, landing(i)), sample(i, quiet(i))];
        let command = ticker.tick(&samples);
        assert_eq!([also.tick(&samples), too.tick(&samples)], [command; 2]);
        let both = [0, 1].map(|end| reader.record(end).map(|record| written(&record)));
        let took = both[0].is_some();
        assert_eq!(archive.take(&mut reader), took);
        assert_eq!(ArchiveIn::take_rotor(borrowed.each_mut(), &mut reads), took);
        assert!(!ArchiveIn::take_rotor(none.each_mut(), &mut reads_none));
        at_once.extend(took.then_some(both));
    }
    assert_eq!(at_once.len(), 3);
    for (left, dropped) in [(2, 1), (1, 0)] {
        assert_eq!(archive.count(), left);
        for (end, borrowed) in borrowed.iter_mut().enumerate() {
            assert_eq!(borrowed.count(), left);
            let record = archive.oldest(end).unwrap();
            assert_eq!(head(&record).dropped, dropped);
            // But for the count of those that are gone.
            let is_the_same = Some(written(&record)) == at_once[3 - left][end];
            assert_eq!(is_the_same, dropped == 0);
            let same = borrowed.oldest().map(|record| written(&record));
            assert_eq!(same, Some(written(&record)));
            borrowed.discard();
        }
        archive.discard();
    }
    assert_eq!(archive.count(), 0);
    for archive in borrowed.iter_mut().chain(&mut none) {
        archive.discard();
        assert!(archive.count() == 0 && archive.oldest().is_none());
    }
}
