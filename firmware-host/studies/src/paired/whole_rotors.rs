//! Whole rotors: rigid, gyroscopic, flexible, with bent shafts and with seals.

use super::configured::ONE_WRONG;
use super::events::{Event, OF_ANY_MACHINE, OF_ROTORS, Written};
use super::machines::MachineClass::{self, Rotor};
use super::pair::HOLDS_S;
use super::plan::{Axes, Case, Class, Plan, row_of, rows};
use super::row::{COLUMNS, ClassName, Row, table, values, worse};
use super::sensors::Sensors;
use crate::campaign::{Block, Chapter, Claim, Extent, Machines, Progress, Report, StudyError};
use crate::machines::rotors::Class as Kind;

/// Nothing was tuned on the rotors of this seed.
const SEED: u64 = 20_261_126;
/// What is claimed of.
const CLAIMED: [MachineClass; 3] = [
    Rotor(Kind::Rigid),
    Rotor(Kind::Gyroscopic),
    Rotor(Kind::Flexible),
];
const RIGID: &[MachineClass] = &[Rotor(Kind::Rigid)];
const BESIDE: [MachineClass; 3] = [Rotor(Kind::Bent), Rotor(Kind::Sealed), Rotor(Kind::InTurn)];

fn written(events: &[Written]) -> Vec<Event> {
    events.iter().copied().map(Event::Written).collect()
}

/// The classes of what is claimed.
pub fn claimed() -> Vec<Class> {
    Axes::new(&CLAIMED, written(&OF_ROTORS)).classes()
}

pub fn classes() -> Vec<Class> {
    let blow = [Written::OneEndBlow(130), Written::LoadAtOneEnd(160)];
    let declared = [
        Axes::new(RIGID, written(&OF_ANY_MACHINE)),
        Axes::new(&BESIDE, written(&OF_ROTORS)),
        Axes {
            sensors: &Sensors::FAILING,
            ..Axes::new(RIGID, written(&blow))
        },
        Axes {
            configured: ONE_WRONG,
            ..Axes::new(RIGID, written(&blow[..1]))
        },
    ];
    let more = declared.iter().flat_map(Axes::classes);
    claimed().into_iter().chain(more).collect()
}

/// Every class on three hundred rotors, or on eight.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    drawn(Machines::default(), extent, progress)
}

/// The same on other rotors.
///
/// # Errors
/// None.
pub fn drawn(of: Machines, extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let plan = Plan {
        seed: of.seed.unwrap_or(SEED),
        machines: of.number.unwrap_or(extent.pick(8, 300)),
        classes: classes(),
    };
    let cases = plan.run(progress);
    let claimed = claimed();
    let story = format!(
        "{} rotors of seed {} in each class: two magnets with a PD controller each, sensors up to 30 mm outside them, nothing configured of bending. Rotors that levitation alone does not hold for {HOLDS_S} s with nothing happening have a chapter of their own, and no claim is about them. Touches are those with the supervisor over those of levitation alone, summed where both recover. Struck on and on: twice the touches of levitation alone, and ten more.",
        plan.machines, plan.seed
    );
    let mut claims = Vec::new();
    let rows_of_all = rows(&cases);
    let mut chapters = vec![
        Chapter::new("What was run", vec![Block::text(story)]),
        worse(&rows_of_all),
    ];
    let of_kind = |kind: MachineClass| {
        let held = cases.iter().filter(|case| case.held);
        held.filter(move |case| case.class.machine == kind)
    };
    for kind in CLAIMED.into_iter().chain(BESIDE) {
        let all: Vec<Case> = of_kind(kind).cloned().collect();
        if CLAIMED.contains(&kind) {
            let counted = all.iter().filter(|case| claimed.contains(&case.class));
            claims.extend(claims_of(kind, &row_of(ClassName::default(), counted)));
        }
        let remarks = all.iter().filter_map(|case| case.remark(plan.seed));
        let blocks = vec![table(&rows(&all)), Block::List(remarks.collect())];
        chapters.push(Chapter::folded(kind.name(), blocks));
    }
    chapters.push(not_held(&cases));
    Ok(Report {
        title: "Whole rotors".to_owned(),
        claims,
        cases: cases.len() as u64,
        classes: values(&rows_of_all),
        chapters,
    })
}

/// What comes of rotors that levitation alone does not hold.
fn not_held(cases: &[Case]) -> Chapter {
    let row = |kind: MachineClass| {
        let of_kind = cases.iter().filter(|c| !c.held && c.class.machine == kind);
        row_of(ClassName::default(), of_kind).cells(kind.name())
    };
    Chapter::new(
        "Rotors that levitation alone does not hold",
        vec![Block::table(COLUMNS, CLAIMED.map(row))],
    )
}

fn claims_of(kind: MachineClass, all: &Row) -> Vec<Claim> {
    let name = kind.name();
    let share = |count: u64| count as f64 / (all.pairs + all.untrusted) as f64;
    let lost = match kind {
        Rotor(Kind::Flexible) => 0.002,
        _ => 0.0,
    };
    vec![
        Claim::at_most(
            format!("{name}: recoveries lost, share of pairs"),
            lost,
            share(all.lost),
        ),
        Claim::at_least(
            format!("{name}: recoveries, over levitation's"),
            1.0,
            all.recovery_ratio(),
        ),
        Claim::at_most(
            format!("{name}: touches over levitation's"),
            1.0,
            all.touch_ratio(),
        ),
        Claim::at_most(
            format!("{name}: struck on and on, share of pairs"),
            0.01,
            share(all.struck_on),
        ),
        Claim::at_most(
            format!("{name}: pairs that cannot be trusted"),
            0.0,
            all.untrusted as f64,
        ),
    ]
}
