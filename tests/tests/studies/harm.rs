//! First do no harm: on machines drawn at random, the supervisor beside levitation alone. A sample of what
//! `firmware-host harm` runs in full.

use firmware_studies::harm::compared::Pair;
use firmware_studies::harm::conditions::Condition;
use firmware_studies::harm::events::Event;
use firmware_studies::harm::page::{Row, rows};
use firmware_studies::harm::plan::{Plan, Run};

/// Nothing was tuned on it.
const SEED: u64 = 20_261_124;

fn ran(machines: u64, events: &[Event], conditions: &[Condition]) -> Vec<Run> {
    Plan::new(SEED, machines, events, conditions).run(&())
}

fn sum(rows: &[Row], of: impl Fn(&Row) -> usize) -> usize {
    rows.iter().map(of).sum()
}

/// Where nothing happens the supervisor is not noticed, whatever the sensors are: no touch, and hardly a tick of its own.
#[test]
fn idle_machines_do_not_notice_it() {
    let runs = ran(10, &[Event::Idle], &Condition::ALL);
    for row in rows(&runs) {
        let name = &row.sensors;
        assert_eq!(row.new_touches, Vec::<u64>::new(), "{name}");
        assert_eq!(row.lost, Vec::<u64>::new(), "{name}");
        assert!(row.engaged_mean <= 0.02, "{name}: {}", row.engaged_mean);
    }
}

/// With sensors as told it gains recoveries and loses none, and contacts that both recover from are no harder.
#[test]
fn with_sensors_as_told_contacts_are_no_harder() {
    let events = [
        Event::Impact,
        Event::Marginal,
        Event::Eccentric,
        Event::Shock,
        Event::Overload,
        Event::Whirl,
    ];
    let rows = rows(&ran(40, &events, &[Condition::Told]));
    assert_eq!(sum(&rows, |r| r.lost.len()), 0, "{rows:?}");
    assert!(sum(&rows, |r| r.gained) >= 15, "{rows:?}");
    for row in rows.iter().filter(|row| row.event != Event::Whirl.name()) {
        let (median, p95) = (row.force.median.unwrap(), row.force.p95.unwrap());
        assert!(median <= 1.02 && p95 <= 1.25, "{row:?}");
        assert!(row.impulse.median.unwrap() <= 1.06, "{row:?}");
    }
}

/// With sensors that are worse than told nothing is lost but by chance: as many as are gained at most.
#[test]
fn with_sensors_as_they_are_nothing_is_lost() {
    let events = [
        Event::Impact,
        Event::Eccentric,
        Event::Shock,
        Event::Overload,
    ];
    let rows = rows(&ran(6, &events, &Condition::ALL));
    let (lost, gained) = (sum(&rows, |r| r.lost.len()), sum(&rows, |r| r.gained));
    assert!(lost <= 2 && lost <= gained, "{lost} lost, {gained} gained");
}

/// What comes out does not depend on how many threads there are.
#[test]
fn threads_do_not_matter() {
    let pairs = |threads| -> Vec<Option<Pair>> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let runs = pool.install(|| ran(2, &[Event::Shock], &[Condition::Spikes, Condition::Told]));
        runs.into_iter().map(|run| run.pair).collect()
    };
    assert_eq!(pairs(1), pairs(3));
}
