//! First do no harm: on machines drawn at random, the supervisor beside levitation alone. A sample of what
//! `firmware-host harm` runs in full.

use firmware_studies::paired::configured::{MANY_WRONG, ONE_WRONG};
use firmware_studies::paired::events::{Event, Point, Written};
use firmware_studies::paired::machines::MachineClass::{self, PointMass};
use firmware_studies::paired::pair::Tried;
use firmware_studies::paired::plan::{Axes, Case, Class, Plan, rows};
use firmware_studies::paired::row::Row;
use firmware_studies::paired::sensors::Sensors;
use firmware_studies::paired::{harm, whole_rotors};

/// Nothing was tuned on it.
const SEED: u64 = 20_261_124;
const POINT: &[MachineClass] = &[PointMass];

fn ran(machines: u64, classes: Vec<Class>) -> Vec<Case> {
    let plan = Plan {
        seed: SEED,
        machines,
        classes,
    };
    plan.run(&())
}

/// Classes of point masses, every event with all sensors.
fn classes(events: &[Point], sensors: &[Sensors]) -> Vec<Class> {
    let events: Vec<Event> = events.iter().copied().map(Event::Point).collect();
    let all = Axes {
        sensors,
        ..Axes::new(POINT, events.clone())
    };
    let wrong = Axes {
        configured: &[MANY_WRONG],
        ..Axes::new(POINT, events)
    };
    match sensors.len() {
        1 => all.classes(),
        _ => [all.classes(), wrong.classes()].concat(),
    }
}

fn sum(rows: &[Row], of: impl Fn(&Row) -> u64) -> u64 {
    rows.iter().map(of).sum()
}

/// Where nothing happens the supervisor is not noticed, whatever the sensors are: no touch, and hardly a tick of its own.
#[test]
fn idle_machines_do_not_notice_it() {
    let runs = ran(10, classes(&[Point::Idle], &Sensors::WORSE));
    for row in rows(&runs) {
        let name = row.class.text(false);
        assert_eq!(row.new_touch_numbers, Vec::<u64>::new(), "{name}");
        assert_eq!(row.lost_numbers, Vec::<u64>::new(), "{name}");
        // One machine in ten with a coarse converter is held for long.
        let most = if name.contains("coarse") { 0.06 } else { 0.02 };
        assert!(row.engaged_mean <= most, "{name}: {}", row.engaged_mean);
    }
}

/// With sensors as configured it gains recoveries and loses none, and contacts that both recover from are no harder.
#[test]
fn with_sensors_as_configured_contacts_are_no_harder() {
    let events = [
        Point::Impact,
        Point::Marginal,
        Point::Eccentric,
        Point::Shock,
        Point::Overload,
        Point::Whirl,
    ];
    let rows = rows(&ran(40, classes(&events, &[Sensors::AsConfigured])));
    assert_eq!(sum(&rows, |r| r.lost), 0, "{rows:?}");
    assert!(sum(&rows, |r| r.gained) >= 15, "{rows:?}");
    for row in rows
        .iter()
        .filter(|row| row.class.event != Point::Whirl.name())
    {
        let (median, p95) = (row.force.median.unwrap(), row.force.p95.unwrap());
        assert!(median <= 1.02 && p95 <= 1.25, "{row:?}");
        assert!(row.impulse.median.unwrap() <= 1.06, "{row:?}");
    }
}

/// With sensors that are worse than configured nothing is lost but by chance: as many as are gained at most.
#[test]
fn with_sensors_as_they_are_nothing_is_lost() {
    let events = [
        Point::Impact,
        Point::Eccentric,
        Point::Shock,
        Point::Overload,
    ];
    let rows = rows(&ran(6, classes(&events, &Sensors::WORSE)));
    let (lost, gained) = (sum(&rows, |r| r.lost), sum(&rows, |r| r.gained));
    assert!(lost <= 2 && lost <= gained, "{lost} lost, {gained} gained");
}

/// What comes out does not depend on how many threads there are.
#[test]
fn threads_do_not_matter() {
    let pairs = |threads| -> Vec<Tried> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let sensors = [Sensors::Spikes, Sensors::AsConfigured];
        let cases = pool.install(|| ran(2, classes(&[Point::Shock], &sensors)));
        cases.into_iter().map(|case| case.tried).collect()
    };
    assert_eq!(pairs(1), pairs(3));
}

/// Every class that is declared makes scenes, and none is declared twice.
#[test]
fn every_class_makes_scenes() {
    for classes in [harm::classes(), whole_rotors::classes()] {
        for (i, class) in classes.iter().enumerate() {
            assert!(!classes[..i].contains(class), "{:?}", class.name());
            for number in 0..3 {
                if let Err(why) = class.scene(SEED, number) {
                    panic!("{:?}: {why}", class.name());
                }
            }
        }
    }
}

/// A rotor that is set down lies on its bearing in the end, and no configuration that is refused counts as lost.
#[test]
fn set_downs_end_on_the_bearing_and_refusals_are_no_losses() {
    let set_down = Event::Written(Written::SetDown {
        spins: false,
        announced: true,
    });
    let row = &rows(&ran(4, Axes::new(POINT, vec![set_down]).classes()))[0];
    // Of one the run ends before the rotor lies still.
    assert!(row.pairs == 4 && row.levitation >= 3, "{row:?}");
    let pole = ONE_WRONG.iter().find(|c| c.name == "observer pole × 1.05");
    let wrong = Axes {
        configured: &[*pole.unwrap()],
        ..Axes::new(POINT, vec![Event::Point(Point::Idle)])
    };
    let row = &rows(&ran(6, wrong.classes()))[0];
    assert_eq!((row.pairs + row.refused, row.lost), (6, 0), "{row:?}");
}
