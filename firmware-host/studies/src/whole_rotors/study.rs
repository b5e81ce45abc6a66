//! What the supervisor does to whole rotors, as a study.

use super::compared::{COLUMNS, HOLDS_S, Sum, Tried, is_held, told_of};
use super::{Class, Event, Ran, RotorCase};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};

/// Nothing was tuned on the rotors of this seed.
const SEED: u64 = 20_261_126;

/// A pair, and what came of it.
struct Row {
    rotor: RotorCase,
    event: Event,
    held: bool,
    ran: Tried,
}

impl Row {
    /// What a list says of it.
    fn named(&self) -> Option<String> {
        let what = told_of(&self.ran)?;
        Some(format!(
            "{what}: {}; {}",
            self.rotor.text(),
            self.event.name()
        ))
    }
}

/// Every event on three hundred rotors of each class, or on eight.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let count = extent.pick(8, 300);
    let rotors: Vec<RotorCase> = (Class::ALL.iter())
        .flat_map(|class| (0..count).map(|number| RotorCase::new(SEED, *class, number)))
        .collect();
    let held = run_all(&rotors, progress, |rotor| {
        is_held(rotor.scene_for(Event::Idle, HOLDS_S))
    });
    let cases: Vec<(RotorCase, bool, Event)> = (rotors.into_iter().zip(held))
        .flat_map(|(rotor, held)| Event::ALL.map(|event| (rotor, held, event)))
        .collect();
    let ran = run_all(&cases, progress, |(rotor, _, event)| {
        Ran::new(rotor, *event)
    });
    let rows: Vec<Row> = (cases.into_iter().zip(ran))
        .map(|((rotor, held, event), ran)| Row {
            rotor,
            event,
            held,
            ran,
        })
        .collect();
    let story = format!(
        "{count} rotors of seed {SEED} in each class: two magnets with a PD controller each, magnets at the retainer bearings and sensors up to 30 mm outside them, nothing told of bending. Rotors that levitation alone does not hold for {HOLDS_S} s with nothing happening have a chapter of their own, and no claim is about them. Touches and impulse are those with the supervisor over those of levitation alone, summed where both recover. Struck on and on: twice the touches of levitation alone, and ten more."
    );
    let (mut claims, mut chapters) = (Vec::new(), Vec::new());
    chapters.push(Chapter::new("What was run", vec![Block::text(story)]));
    for class in Class::ALL {
        let of_class = || (rows.iter()).filter(move |row| row.held && row.rotor.class == class);
        let all = Sum::of(of_class().map(|row| &row.ran));
        claims.extend(claimed(class, &all));
        let mut table: Vec<[String; 9]> = (Event::ALL.iter())
            .map(|event| {
                let of_event = of_class().filter(|row| row.event == *event);
                Sum::of(of_event.map(|row| &row.ran)).cells(event.name())
            })
            .collect();
        table.push(all.cells("all".to_owned()));
        let named = of_class().filter_map(Row::named).collect();
        let blocks = vec![Block::table(COLUMNS, table), Block::List(named)];
        chapters.push(Chapter::new(class.name(), blocks));
    }
    chapters.push(not_held(&rows));
    Ok(Report {
        title: "Whole rotors".to_owned(),
        claims,
        cases: rows.len() as u64,
        chapters,
    })
}

/// What comes of rotors that levitation alone does not hold.
fn not_held(rows: &[Row]) -> Chapter {
    let of = || rows.iter().filter(|row| !row.held);
    let table = Class::ALL.map(|class| {
        let of_class = of().filter(|row| row.rotor.class == class);
        Sum::of(of_class.map(|row| &row.ran)).cells(class.name().to_owned())
    });
    let mut columns = COLUMNS;
    columns[0] = "class";
    let named = of().filter_map(Row::named).collect();
    Chapter::new(
        "Rotors that levitation alone does not hold",
        vec![Block::table(columns, table.to_vec()), Block::List(named)],
    )
}

fn claimed(class: Class, all: &Sum) -> Vec<Claim> {
    let name = class.name();
    let share = |count: u64| count as f64 / all.runs as f64;
    let lost = match class {
        Class::Flexible => 0.002,
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
            all.own as f64 / all.alone as f64,
        ),
        Claim::at_most(
            format!("{name}: touches over levitation's"),
            1.0,
            all.touched(),
        ),
        Claim::at_most(
            format!("{name}: struck on and on, share of pairs"),
            0.01,
            share(all.hammered),
        ),
        Claim::at_most(
            format!("{name}: pairs that cannot be trusted"),
            0.0,
            all.untrusted as f64,
        ),
    ]
}
