//! The catalogue's scenes on machines that nothing was tuned on, by how late their forces come.

use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use crate::machines::random::RandomMachine;
use crate::trials::Compared;
use firmware_bench::scene::diagnostic::SceneError;
use std::ops::Range;

/// From a sample to the middle of its force, in units of √(m·c/F).
const LATENESS: [Range<f64>; 3] = [0.0..0.4, 0.4..0.8, 0.8..10.0];

/// The scenes on the machines of these numbers, by how late their forces come.
///
/// # Errors
/// A machine that is no valid scene: a mistake of the draw.
fn by_lateness(numbers: Range<u64>, progress: &dyn Progress) -> Result<[Compared; 3], SceneError> {
    let machines = (numbers.map(RandomMachine::unseen)).collect::<Result<Vec<_>, _>>()?;
    let of_each = run_all(&machines, progress, |machine| match machine.gains() {
        Some(gains) => Compared::on(&machine.plant(), &gains, &machine.text),
        None => Compared::default(),
    });
    let all = || machines.iter().zip(&of_each);
    Ok(LATENESS.map(|late| {
        (all().filter(|(machine, _)| late.contains(&machine.lateness())))
            .fold(Compared::default(), |sum, (_, of)| sum.and(of.clone()))
    }))
}

/// Two hundred machines, or a dozen.
///
/// # Errors
/// A machine that is no valid scene: a mistake of the draw.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let classes = by_lateness(0..extent.pick(12, 200), progress)?;
    let name = |late: &Range<f64>| match late.end {
        end if end < 1.0 => format!("{} to {end}", late.start),
        _ => format!("above {}", late.start),
    };
    let mut claims = Vec::new();
    for (late, of) in LATENESS.iter().zip(&classes).filter(|(_, of)| of.runs > 0) {
        let late = name(late);
        let lost = of.lost.len() as f64 / of.runs as f64;
        claims.push(Claim::at_most(
            format!("late {late}: lost, share of runs"),
            0.02,
            lost,
        ));
        let over = of.own as f64 / of.alone as f64;
        claims.push(Claim::at_least(
            format!("late {late}: recovered, over levitation alone"),
            1.02,
            over,
        ));
    }
    let rows = LATENESS.iter().zip(&classes).map(|(late, of)| {
        [
            name(late),
            of.machines.to_string(),
            of.runs.to_string(),
            of.alone.to_string(),
            of.own.to_string(),
            of.lost.len().to_string(),
        ]
    });
    let blocks = vec![
        Block::text(
            "Late is the time from a sample to the middle of its force, delay and lag, over √(m·c/F). Lost are runs that only levitation alone recovers from. Each machine has the configuration that `advise` suggests, a levitation controller by a rule of thumb, and one seed.",
        ),
        Block::table(
            [
                "late",
                "machines",
                "runs",
                "levitation alone",
                "supervisor",
                "lost",
            ],
            rows,
        ),
        Block::List(
            classes
                .iter()
                .flat_map(|of| of.lost.iter().cloned())
                .collect(),
        ),
    ];
    Ok(Report {
        classes: Vec::new(),
        title: "Unseen machines".to_owned(),
        claims,
        cases: classes.iter().map(|of| of.runs as u64).sum(),
        chapters: vec![Chapter::new("Recovered, by how late forces come", blocks)],
    })
}
