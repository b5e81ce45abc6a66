//! What the supervisor does to whole rotors, as a study.

use super::compared::{COLUMNS, Sum};
use super::{Class, Event, Ran, RotorCase};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};

/// Nothing was tuned on the rotors of this seed.
const SEED: u64 = 20_261_126;

/// Every event on three hundred rotors of each class, or on eight.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let rotors = extent.pick(8, 300);
    let mut cases = Vec::new();
    for class in Class::ALL {
        for number in 0..rotors {
            let rotor = RotorCase::new(SEED, class, number);
            cases.extend(Event::ALL.map(|event| (rotor, event)));
        }
    }
    let ran = run_all(&cases, progress, |(rotor, event)| Ran::new(rotor, *event));
    let (mut claims, mut chapters) = (Vec::new(), Vec::new());
    for class in Class::ALL {
        let of_class =
            || (cases.iter().zip(&ran)).filter(move |((rotor, _), _)| rotor.class == class);
        let all = Sum::of(of_class().map(|(_, ran)| ran));
        claims.extend(claimed(class, &all));
        let mut rows: Vec<[String; 9]> = (Event::ALL.iter())
            .map(|event| {
                let of_event = of_class().filter(|((_, of), _)| of == event);
                Sum::of(of_event.map(|(_, ran)| ran)).cells(event.name())
            })
            .collect();
        rows.push(all.cells("all".to_owned()));
        let named = of_class().filter_map(|((rotor, event), ran)| {
            let ran = ran.as_ref()?;
            let what = match (ran.is_lost(), ran.is_hammered()) {
                (true, _) => "lost",
                (false, true) => "struck on and on",
                _ => return None,
            };
            Some(format!("{what}: {}; {}", rotor.text(), event.name()))
        });
        let blocks = vec![Block::table(COLUMNS, rows), Block::List(named.collect())];
        chapters.push(Chapter::new(class.name(), blocks));
    }
    let story = format!(
        "{rotors} rotors of seed {SEED} in each class: two magnets with a PD controller each, magnets at the retainer bearings and sensors up to 30 mm outside them, nothing told of bending. Touches and impulse are those with the supervisor over those of levitation alone, summed where both recover. Struck on and on: twice the touches of levitation alone, and ten more."
    );
    chapters.insert(0, Chapter::new("What was run", vec![Block::text(story)]));
    Ok(Report {
        title: "Whole rotors".to_owned(),
        claims,
        cases: cases.len() as u64,
        chapters,
    })
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
