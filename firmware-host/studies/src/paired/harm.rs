//! First do no harm: point masses, with sensors and configurations as they should be and as they are.

use super::configured::{MANY_WRONG, ONE_WRONG};
use super::events::{Event, OF_ANY_MACHINE, Point, Written};
use super::machines::MachineClass::{self, PointMass, ResilientMount};
use super::plan::{Axes, Case, Class, Plan, row_of, rows};
use super::row::{ClassName, Row, lists, table, values, worse};
use super::sensors::Sensors;
use crate::campaign::{Block, Chapter, Claim, Extent, Machines, Progress, Report, StudyError};

/// Nothing was tuned on the machines of this seed.
const SEED: u64 = 20_261_125;
const POINT: &[MachineClass] = &[PointMass];

fn points(events: &[Point]) -> Vec<Event> {
    events.iter().copied().map(Event::Point).collect()
}

/// Every event with all sensors that wear, hum or fail, and with many parameters wrong: what is claimed of.
pub fn claimed() -> Vec<Class> {
    let all = Axes {
        sensors: &Sensors::WORSE,
        ..Axes::new(POINT, points(&Point::ALL))
    };
    let wrong = Axes {
        configured: &[MANY_WRONG],
        ..Axes::new(POINT, points(&Point::ALL))
    };
    [all.classes(), wrong.classes()].concat()
}

pub fn classes() -> Vec<Class> {
    use Point::{Eccentric, Impact, Marginal, Overload, Shock, Whirl};
    let conical = Written::Rub { conical: true };
    let of_any = OF_ANY_MACHINE.into_iter().filter(|event| *event != conical);
    let mounts = [Impact, Marginal, Shock, Overload, Whirl];
    let failing = [Impact, Eccentric, Overload];
    let declared = [
        Axes::new(POINT, of_any.map(Event::Written).collect()),
        Axes::new(&[ResilientMount], points(&mounts)),
        Axes {
            sensors: &Sensors::FAILING,
            ..Axes::new(POINT, points(&failing))
        },
        Axes {
            configured: ONE_WRONG,
            ..Axes::new(POINT, points(&[Impact, Overload, Whirl]))
        },
    ];
    let more = declared.iter().flat_map(Axes::classes);
    claimed().into_iter().chain(more).collect()
}

/// Every class on two hundred machines, or on four.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    drawn(Machines::default(), extent, progress)
}

/// The same on other machines.
///
/// # Errors
/// None.
pub fn drawn(of: Machines, extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let plan = Plan {
        seed: of.seed.unwrap_or(SEED),
        machines: of.number.unwrap_or(extent.pick(4, 200)),
        classes: classes(),
    };
    let cases = plan.run(progress);
    let rows = rows(&cases);
    let story = format!(
        "{} machines of seed {} in every class: machine, event, sensors and configuration, what is as usual left out. Ratios are those of the supervisor over levitation alone, where both recover and levitation touches; touches are summed where both recover.",
        plan.machines, plan.seed
    );
    let blocks = vec![Block::text(story), table(&rows), Block::List(lists(&rows))];
    Ok(Report {
        title: "First do no harm".to_owned(),
        claims: claims(&cases),
        cases: cases.len() as u64,
        classes: values(&rows),
        chapters: vec![worse(&rows), Chapter::folded("By class", blocks)],
    })
}

fn claims(cases: &[Case]) -> Vec<Claim> {
    let claimed = claimed();
    let of = |counts: &dyn Fn(&Class) -> bool| {
        let cases = cases.iter().filter(|case| claimed.contains(&case.class));
        row_of(
            ClassName::default(),
            cases.filter(|case| counts(&case.class)),
        )
    };
    let is_pair = |class: &Class| class.sensors == Sensors::FaultPair;
    let sound = of(&Class::is_sound);
    let worse = of(&|class| !class.is_sound() && !is_pair(class));
    let pairs = of(&is_pair);
    let by_event: Vec<Row> = (Point::ALL.into_iter())
        .map(|event| of(&|class| class.is_sound() && class.event == Event::Point(event)))
        .collect();
    let worst = |of: fn(&Row) -> Option<f64>| by_event.iter().filter_map(of).fold(0.0, f64::max);
    vec![
        Claim::at_most("as configured: recoveries lost", 0.0, sound.lost as f64),
        Claim::at_least(
            "as configured: recoveries, over levitation's",
            1.0,
            sound.recovery_ratio(),
        ),
        Claim::at_most(
            "as configured: machines that touch with the supervisor alone",
            0.0,
            sound.new_touches as f64,
        ),
        Claim::at_most(
            "as configured: largest force over levitation's, worst event's median",
            1.02,
            worst(|r| r.force.median),
        ),
        Claim::at_most(
            "as configured: largest force over levitation's, worst event's 95th percentile",
            1.1,
            worst(|r| r.force.p95),
        ),
        Claim::at_most(
            "worse than configured: recoveries lost, share of runs",
            0.001,
            worse.lost as f64 / worse.pairs as f64,
        ),
        Claim::at_least(
            "worse than configured: recoveries, over levitation's",
            1.0,
            worse.recovery_ratio(),
        ),
        Claim::at_least(
            "pairs of faults: recoveries, over levitation's",
            1.0,
            pairs.recovery_ratio(),
        ),
    ]
}
