//! The ledger of landings: what it adds up, what it says is left, and what it makes of bytes that are none of its own.

use supervisor::{
    Core, LEDGER_BYTES, Ledger, LedgerError, Prepared, Q, Summary, Supervisor, crc_of,
};
use test_support::in_numbers;
use test_support::rig::{LANDING_TICKS as LANDING, config, landing, new_rotor, quiet, sample};

/// Totals since the supervisor was made, as the record of an event has them.
fn totals(landings: u32, severity_index: f32) -> Summary {
    Summary {
        landings,
        severity_index,
        hardest_impact_m_s: 0.1 * severity_index,
        ..Summary::default()
    }
}

/// What landings come to in the ledger is what the supervisor reports of them, over any number of boots.
/// Requirement: SR-39
#[test]
fn a_ledger_goes_on_where_the_supervisor_begins_anew() {
    let mut kept = Ledger::new(7, 20.0).to_bytes();
    let (mut landings, mut severity, mut hardest) = (0, 0.0_f64, 0.0_f32);
    for boot in 1..4 {
        let mut ledger = Ledger::from_bytes(&kept).unwrap();
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        for i in 0..boot * LANDING {
            supervisor.tick(&sample(i, landing(i)));
            if let Some(record) = supervisor.record() {
                assert!(ledger.take_in(&record));
                assert!(!ledger.take_in(&record), "the same record once more");
                assert_eq!(ledger.updates, ledger.landings, "one at a time");
                kept = ledger.to_bytes();
                supervisor.rearm();
            }
        }
        let report = supervisor.report();
        assert_eq!(report.landings, boot);
        landings += report.landings;
        severity += f64::from(report.severity_index);
        hardest = hardest.max(report.impact_speed_max_m_s);
    }
    let ledger = Ledger::from_bytes(&kept).unwrap();
    assert_eq!((ledger.bearing, ledger.landings), (7, landings));
    assert!(severity > 0.01 && hardest > 0.01, "{severity} {hardest}");
    let off = f64::from(ledger.severity_sum()) - severity;
    assert!(off.abs() < 1e-5, "{off}");
    assert_eq!(ledger.hardest_impact_m_s, hardest);
    // All of them were alike.
    let worst = f64::from(ledger.worst_severity);
    assert!((worst - severity / f64::from(landings)).abs() < 0.2 * worst);
}

/// Events that found a record frozen are in none, and in the ledger all the same.
#[test]
fn landings_without_a_record_are_in_the_ledger() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut ledger = Ledger::new(7, 20.0);
    for i in 0..4 * LANDING {
        supervisor.tick(&sample(i, landing(i)));
        // The record of the first waits until the third is over.
        if i + 1 >= 3 * LANDING
            && let Some(record) = supervisor.record()
        {
            ledger.take_in(&record);
            supervisor.rearm();
        }
    }
    assert_eq!((ledger.landings, ledger.updates), (4, 2));
    let sum = supervisor.report().severity_index;
    assert!((ledger.severity_sum() - sum).abs() < 1e-5, "{ledger:?}");
    // Three landings at once pass for one: on the safe side.
    assert!(ledger.worst_severity > 0.6 * sum);
}

/// Of cores without floating point, and of the planes of a rotor.
#[test]
fn every_kind_of_record_can_be_added() {
    let mut core = Core::<Q, 64>::new(&Prepared::new(&config()).unwrap());
    let scaling = config().scaling();
    let mut rotor = new_rotor(&config());
    for i in 0..LANDING {
        let at = sample(i, landing(i));
        core.tick(&in_numbers(&scaling.sample(&at)));
        rotor.tick(&[at, sample(i, quiet(i))]);
    }
    let mut ledgers = [1, 2, 3].map(|bearing| Ledger::new(bearing, 20.0));
    let [of_core, first, second] = &mut ledgers;
    assert!(of_core.take_in(&core.record().unwrap()));
    assert!(first.take_in(&rotor.record(0).unwrap()));
    assert!(!second.take_in(&rotor.record(1).unwrap()), "no touch there");
    assert_eq!(ledgers.map(|ledger| ledger.landings), [1, 1, 0]);
}

#[test]
fn what_is_left_is_the_allowance_less_the_sum() {
    let mut ledger = Ledger::new(7, 20.0);
    assert_eq!(ledger.landings_left(0.5), Some(40));
    // The worst is none yet.
    let none_yet = ledger.worst_severity;
    let left = [none_yet, f32::NAN, -1.0, f32::INFINITY, 1e-6].map(|s| ledger.landings_left(s));
    assert_eq!(left, [None, None, None, Some(0), Some(20_000_000)]);
    assert!(ledger.add(&totals(1, 0.5), 11) && ledger.add(&totals(2, 2.0), 12));
    assert_eq!((ledger.worst_severity, ledger.closed_at), (1.5, 12));
    assert_eq!((ledger.severity_sum(), ledger.severity_left()), (2.0, 18.0));
    let left = [0.5, 1.5].map(|s| ledger.landings_left(s));
    assert_eq!(left, [Some(36), Some(12)]);
    // What a change of units makes of the last bits is no new supervisor.
    assert!(!ledger.add(&totals(2, 2.0 - 1e-6), 13));
    // One that was made anew is noticed by counting less.
    assert!(ledger.add(&totals(1, 0.25), 14));
    assert_eq!((ledger.landings, ledger.severity_sum()), (3, 2.25));
    assert!(ledger.add(&totals(2, 30.0), 15));
    let left = (ledger.severity_left(), ledger.landings_left(1e-3));
    assert_eq!(left, (0.0, Some(0)));
}

/// A sum of `f32` would stand still here: 10⁵ landings of 10⁻³ on top of 2¹⁶.
#[test]
fn light_landings_count_however_large_the_sum_is() {
    let mut ledger = Ledger::new(7, 2e5);
    ledger.add(&totals(1, 65_536.0), 0);
    for landing in 0..100_000 {
        ledger.begin_run();
        assert!(ledger.add(&totals(1, 1e-3), landing));
    }
    assert_eq!(ledger.severity_millionths, 65_636_000_000);
}

/// Any values of the fields, and any bits, give bytes and figures without a panic.
#[test]
fn nothing_overflows() {
    let infinities = [f32::INFINITY, -f32::INFINITY];
    let odd = [&infinities[..], &[f32::NAN, -1.0, 0.0, f32::MAX, 1e-40]].concat();
    for &allowed in &odd {
        for &index in &odd {
            let mut ledger = Ledger {
                updates: u32::MAX,
                landings: u32::MAX,
                severity_millionths: u64::MAX - 1,
                ..Ledger::new(1, allowed)
            };
            ledger.add(&totals(1, index), u32::MAX);
            ledger.add(&totals(u32::MAX, index), 0);
            assert_eq!(ledger.landings, u32::MAX);
            assert!((0.0..2e-6).contains(&ledger.severity_left()), "{ledger:?}");
            let read = Ledger::from_bytes(&ledger.to_bytes()).unwrap();
            assert_eq!(read.severity_millionths, ledger.severity_millionths);
            ledger.severity_allowed = allowed;
            let _ = (ledger.landings_left(index), ledger.severity_sum());
        }
    }
}

fn sample_ledger() -> Ledger {
    let mut ledger = Ledger::new(4711, 20.0);
    ledger.add(&totals(3, 1.25), 90_210);
    ledger
}

/// Every one of 384 bits, every pair of them, and every run of up to 32: none passes for figures.
/// Requirement: SR-39
#[test]
fn damage_is_named_and_never_a_figure() {
    let whole = sample_ledger().to_bytes();
    let flipped = |bits: &[usize]| {
        let mut bytes = whole;
        bits.iter().for_each(|bit| bytes[bit / 8] ^= 1 << (bit % 8));
        Ledger::from_bytes(&bytes)
    };
    let named = [LedgerError::Damaged, LedgerError::Letters];
    let bits = 8 * LEDGER_BYTES;
    for first in 0..bits {
        for second in first..bits {
            let ends = flipped(&[first, second][usize::from(first == second)..]);
            assert!(named.map(Err).contains(&ends), "bits {first}, {second}");
            if second < first + 32 {
                let run = flipped(&(first..=second).collect::<Vec<_>>());
                assert!(named.map(Err).contains(&run), "bits {first} to {second}");
            }
        }
    }
    for length in (0..LEDGER_BYTES).chain([LEDGER_BYTES + 1]) {
        let mut cut = whole.to_vec();
        cut.resize(length, 0);
        assert_eq!(Ledger::from_bytes(&cut), Err(LedgerError::Length));
    }
    // A write that was cut: the rest is blank, or what was there before.
    let before = Ledger::new(4711, 20.0).to_bytes();
    for length in 1..LEDGER_BYTES {
        for rest in [[0; LEDGER_BYTES], [0xFF; LEDGER_BYTES], before] {
            let mut cut = whole;
            cut[length..].copy_from_slice(&rest[length..]);
            let read = Ledger::from_bytes(&cut);
            let known = cut == whole || cut == before || read.is_err();
            assert!(known, "{length}: {read:?}");
        }
    }
}

/// Requirement: SR-39
#[test]
fn a_fresh_ledger_is_told_from_a_lost_one() {
    let fresh = Ledger::from_bytes(&Ledger::new(7, 20.0).to_bytes()).unwrap();
    assert_eq!((fresh.landings, fresh.updates), (0, 0));
    for blank in [[0; LEDGER_BYTES], [0xFF; LEDGER_BYTES]] {
        assert_eq!(Ledger::from_bytes(&blank), Err(LedgerError::Blank));
    }
    let mut other = sample_ledger().to_bytes();
    other[4] = 2;
    let crc = crc_of(&other[..LEDGER_BYTES - 4]);
    other[LEDGER_BYTES - 4..].copy_from_slice(&crc.to_le_bytes());
    assert_eq!(Ledger::from_bytes(&other), Err(LedgerError::Version));
    // Whole, but by somebody who writes what no ledger has.
    let odd = Ledger {
        worst_severity: f32::NAN,
        ..fresh
    };
    let read = Ledger::from_bytes(&odd.to_bytes());
    assert_eq!(read, Err(LedgerError::Damaged));
}

/// Of two copies that are written in turn one is whole at any time, wherever a write is cut.
#[test]
fn two_copies_outlive_a_cut() {
    let mut places = [Ledger::new(7, 20.0).to_bytes(); 2];
    let mut ledger = Ledger::new(7, 20.0);
    for landing in 1..5 {
        let (newer, other) = Ledger::newer([&places[0], &places[1]]).unwrap();
        assert_eq!((newer.updates, other), (landing - 1, None));
        ledger.add(&totals(landing, landing as f32), landing);
        let next = ledger.to_bytes();
        let place = ledger.updates as usize & 1;
        for length in 0..LEDGER_BYTES {
            let mut cut = places;
            cut[place][..length].copy_from_slice(&next[..length]);
            let (found, other) = Ledger::newer([&cut[0], &cut[1]]).unwrap();
            let done = cut[place] == next;
            let updates = landing - u32::from(!done);
            assert_eq!(found.updates, updates, "{landing}, {length}");
            assert_eq!(other.is_some(), cut[place] != places[place] && !done);
        }
        places[place] = next;
    }
    // Counts go round.
    let [old, new] = [u32::MAX, 0].map(|updates| Ledger { updates, ..ledger }.to_bytes());
    for pair in [[old, new], [new, old]] {
        assert_eq!(Ledger::newer([&pair[0], &pair[1]]).unwrap().0.updates, 0);
    }
    let another = Ledger::new(8, 20.0).to_bytes();
    assert_eq!(Ledger::newer([&new, &another]), Err(LedgerError::Bearings));
    let blank = [0xFF; LEDGER_BYTES];
    assert_eq!(Ledger::newer([&blank, &blank]), Err(LedgerError::Blank));
}
