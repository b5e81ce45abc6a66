//! First do no harm, as a study.

use super::conditions::Condition;
use super::events::Event;
use super::page::{Row, lists, rows, table};
use super::plan::Plan;
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError};

/// Nothing was tuned on the machines of this seed.
const SEED: u64 = 20_261_125;

/// Every event with every kind of sensors on two hundred machines, or on four.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let machines = extent.pick(4, 200);
    let runs = Plan::new(SEED, machines, &Event::ALL, &Condition::ALL).run(progress);
    let rows = rows(&runs);
    let story = format!(
        "{machines} machines of seed {SEED} in every class, an event with sensors of a kind; ratios are those of the supervisor over levitation alone, where both recover and levitation touches."
    );
    let mut blocks = vec![Block::text(story), table(&rows)];
    blocks.push(Block::List(lists(&rows)));
    Ok(Report {
        title: "First do no harm".to_owned(),
        claims: claims(&rows),
        cases: runs.len() as u64,
        chapters: vec![Chapter::new("By event and sensors", blocks)],
    })
}

fn claims(rows: &[Row]) -> Vec<Claim> {
    let as_told = Condition::Told.name();
    let pairs = Condition::FaultPair.name();
    let told = || rows.iter().filter(|row| row.sensors == as_told);
    let worse = || {
        rows.iter()
            .filter(|row| row.sensors != as_told && row.sensors != pairs)
    };
    let of_pairs = || rows.iter().filter(|row| row.sensors == pairs);
    let worst = |of: fn(&Row) -> Option<f64>| told().filter_map(of).fold(0.0, f64::max);
    vec![
        Claim::at_most(
            "sensors as told: recoveries lost",
            0.0,
            told().map(lost).sum(),
        ),
        Claim::at_least(
            "sensors as told: recoveries, over levitation's",
            1.0,
            over(told()),
        ),
        Claim::at_most(
            "sensors as told: machines that touch with the supervisor alone",
            0.0,
            told().map(|r| r.new_touches.len() as f64).sum(),
        ),
        Claim::at_most(
            "sensors as told: largest force over levitation's, worst event's median",
            1.02,
            worst(|r| r.force.median),
        ),
        Claim::at_most(
            "sensors as told: largest force over levitation's, worst event's 95th percentile",
            1.1,
            worst(|r| r.force.p95),
        ),
        Claim::at_most(
            "sensors worse than told: recoveries lost, share of runs",
            0.001,
            worse().map(lost).sum::<f64>() / worse().map(|r| r.runs as f64).sum::<f64>(),
        ),
        Claim::at_least(
            "sensors worse than told: recoveries, over levitation's",
            1.0,
            over(worse()),
        ),
        Claim::at_least(
            "pairs of faults: recoveries, over levitation's",
            1.0,
            over(of_pairs()),
        ),
    ]
}

fn lost(row: &Row) -> f64 {
    row.lost.len() as f64
}

fn over<'a>(rows: impl Iterator<Item = &'a Row>) -> f64 {
    let (own, alone) = rows.fold((0, 0), |(own, alone), row| {
        (own + row.own, alone + row.alone)
    });
    own as f64 / alone as f64
}
