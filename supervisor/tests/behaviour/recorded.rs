//! What the flight record keeps, and of which engagements.

use super::trust::{C_M, noise};
use supervisor::{Command, Entry, Events, Mode, Record, Stamp, Supervisor, crc_of};
use test_support::bench::Bench;
use test_support::records::{head, written};
use test_support::rig::{LANDING_TICKS as LANDING, asking, config, landing, sample, ticks_of};
use test_support::storm::Chance;

/// The record holds the ticks around the engagement, oldest first, and freezes once the levitation controller has the bearing
/// again; its sections are under a checksum that any other implementation of CRC-32 gives.
/// Requirement: SR-30
#[test]
fn recorder_freezes_around_the_engagement() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let ticks = (0..900_u32).map(|i| {
        let out = (3e-5 * i.saturating_sub(99) as f32).min(2.02e-4);
        let back = (2e-6 * i.saturating_sub(250) as f32).min(out);
        // A reading that does not change at all would be stuck.
        let noise = 2e-7 * (i % 3) as f32;
        let at_m = [out - back + noise, noise];
        // A controller that has no force to spare at the wall.
        supervisor.tick(&asking(i, at_m, [-5e6 * at_m[0], 0.0]))
    });
    let commands: Vec<Command> = ticks.collect();
    let last = |event| ticks_of(&commands, event).last().copied();
    assert!(last(Events::LEVITATED) > Some(250));
    assert_eq!(last(Events::RECORD_FROZEN), last(Events::LEVITATED));
    let record = supervisor.record().expect("frozen");
    let entries: Vec<Entry> = record.entries().collect();
    assert_eq!(entries.len(), 64);
    let in_order = |w: &[Entry]| w[1].sequence == w[0].sequence + 1;
    assert!(entries.windows(2).all(in_order));
    // A quarter before the trigger.
    assert_eq!(engaged_in(&record), Some(15));
    let (summary, report) = (record.summary(), supervisor.report());
    assert_eq!(summary.mode, Mode::Levitated as u32);
    assert_eq!(summary.landings, 1);
    assert_eq!(summary.touches, report.impacts);
    assert_eq!(summary.contact_ticks, report.contact_ticks);
    assert_eq!(summary.hardest_impact_m_s, report.impact_speed_max_m_s);
    assert_eq!(summary.severity, report.severity_index);
    let mut sections = 0;
    while let Some(mut section) = record.section(sections, &Stamp::default()) {
        let bytes = section.seal();
        let (of, crc) = bytes.split_last_chunk::<4>().unwrap();
        assert_eq!(bitwise_crc(of), u32::from_le_bytes(*crc));
        assert_eq!(crc_of(of), bitwise_crc(of));
        sections += 1;
    }
    assert!(sections > 8, "{sections}");
    // The published check value.
    assert_eq!(bitwise_crc(b"123456789"), 0xCBF4_3926);

    let events = std::iter::from_fn(|| supervisor.next_event());
    let seen = events.fold(Events::empty(), |seen, event| seen | event.events);
    assert!(seen.contains(Events::ENGAGED | Events::TOUCHED | Events::RECORD_FROZEN));
}

fn bitwise_crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |crc, byte| {
        let bit = |crc: u32| (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| bit(crc))
    })
}

/// Which of its entries has the engagement.
fn engaged_in(record: &Record<'_, f32, 64>) -> Option<usize> {
    let engages = |e: Entry| Events::from_bits_retain(e.events.into()).contains(Events::ENGAGED);
    record.entries().position(engages)
}

/// An engagement without a touch leaves the record to one with it, and is counted apart.
/// Requirement: SR-30
#[test]
fn an_engagement_without_contact_does_not_spend_the_record() {
    let mut bench = Bench::new(&config());
    let mut chance = Chance::new(13);
    let mut goes = |bench: &mut Bench, ticks: u32, radius: &dyn Fn(u32) -> f32| {
        let mut noise = || noise(&mut chance, 2e-7);
        let commands = (0..ticks).map(|i| bench.tick([radius(i) * C_M + noise(), noise()]));
        commands.collect::<Vec<_>>()
    };
    goes(&mut bench, 400, &|_| 0.0);
    // Towards the wall, and back before it.
    let towards = goes(&mut bench, 30, &|i| 0.03 * i as f32);
    assert_eq!(ticks_of(&towards, Events::ENGAGED).len(), 1);
    goes(&mut bench, 30, &|i| 0.03 * (29 - i) as f32);
    let back = goes(&mut bench, 4000, &|_| 0.0);
    assert!(back[2000..].iter().all(|c| c.mode == Mode::Levitated));
    let report = bench.supervisor.report();
    assert_eq!((report.nuisance_engagements, report.landings), (1, 0));
    assert!(bench.supervisor.record().is_none());
    goes(&mut bench, 60, &|i| (0.05 * i as f32).min(1.03));
    goes(&mut bench, 2000, &|_| 0.0);
    let report = bench.supervisor.report();
    assert_eq!((report.nuisance_engagements, report.landings), (1, 1));
    let record = bench.supervisor.record().expect("this one is worth it");
    // A quarter of the record lies before the touch.
    assert_eq!(engaged_in(&record), Some(15));
}

/// A record that nobody takes away does not change and holds up no tick; the events that come meanwhile are counted, and reported in
/// the next one.
#[test]
fn what_is_in_no_record_is_counted() {
    let mut plane = Supervisor::<64>::new(&config()).unwrap();
    for i in 0..3 * LANDING {
        plane.tick(&sample(i, landing(i)));
    }
    let first = head(&plane.record().unwrap());
    assert_eq!(first.dropped, 0);
    assert!(first.closed_at < LANDING);
    let bytes = written(&plane.record().unwrap());
    plane.reconfigure(&config()).unwrap();
    assert_eq!(written(&plane.record().unwrap()), bytes);
    plane.rearm();
    for i in 3 * LANDING..4 * LANDING {
        plane.tick(&sample(i, landing(i)));
    }
    let second = plane.record().unwrap();
    assert_eq!(head(&second).dropped, 2);
    assert_eq!(second.summary().touches, 1);
}
