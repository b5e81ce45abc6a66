//! The catalogue's scenes and unseen machines with each datum of the machine configured wrong.

use super::{configured_right, misjudged};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use crate::machines::plants::plants;
use crate::machines::random::RandomMachine;
use crate::machines::tuned_gains::stored;
use crate::overloads::contenders::Contender;
use crate::overloads::results::ResultRow;
use crate::trials::Trial;

const RATE_HZ: f64 = 20_000.0;
/// Of the draws in which all data are configured wrong at once.
const SEED: u64 = 1;
/// AssumedMachine less force than there is, the supervisor uses less: no error of judgement.
const LESS_FORCE: &str = "force cap × 0.8";

/// Outcome of the trials with something configured wrong.
#[derive(Debug, Clone)]
pub struct ConfiguredWrong {
    /// What is configured wrong.
    pub text: String,
    pub recovered: usize,
    /// AssumedMachine so, the supervisor would not have started.
    pub refused: usize,
    /// Of those that levitation alone recovers from.
    pub lost_to_levitation: Vec<String>,
    /// Of those that the supervisor recovers from when it is configured right.
    pub lost_to_right: usize,
    /// Largest contact force over that of the one configured right, the 95th percentile.
    pub force_95: f64,
}

impl ConfiguredWrong {
    /// From the runs configured wrong (none where refused), with levitation alone, and configured right.
    fn new(
        text: &str,
        wrong: &[Option<ResultRow>],
        alone: &[ResultRow],
        right: &[ResultRow],
    ) -> Self {
        let mut row = Self {
            text: text.to_owned(),
            recovered: 0,
            refused: 0,
            lost_to_levitation: Vec::new(),
            lost_to_right: 0,
            force_95: f64::NAN,
        };
        let mut forces = Vec::new();
        for ((wrong, alone), right) in wrong.iter().zip(alone).zip(right) {
            let Some(wrong) = wrong else {
                row.refused += 1;
                continue;
            };
            row.recovered += usize::from(wrong.recovered());
            row.lost_to_right += usize::from(right.recovered() && !wrong.recovered());
            if alone.recovered() && !wrong.recovered() {
                let name = format!("{}: {}", wrong.plant, wrong.scene);
                row.lost_to_levitation.push(name);
            }
            forces.push(force_n(wrong) / force_n(right));
        }
        forces.retain(|ratio| ratio.is_finite());
        forces.sort_by(f64::total_cmp);
        if let Some(force) = forces.get(forces.len() * 95 / 100) {
            row.force_95 = *force;
        }
        row
    }
}

/// Largest contact force \[N\].
fn force_n(row: &ResultRow) -> f64 {
    (row.metrics.as_ref()).map_or(f64::NAN, |m| m.peak_contact_force_n)
}

/// Outcome of trials configured wrong in every way of a width.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Recovered with levitation alone.
    pub alone: usize,
    /// Recovered with the supervisor configured right.
    pub right: usize,
    /// AssumedMachine wrong.
    pub wrong: Vec<ConfiguredWrong>,
    pub runs: u64,
}

/// Trials with levitation alone, configured right, and with each datum put off by errors of a width, and all of them `draws`
/// times.
///
/// # Errors
/// A trial that has nothing to supervise.
pub fn configured_wrong(
    trials: &[Trial],
    (width, draws): (f64, u32),
    progress: &dyn Progress,
) -> Result<Outcome, StudyError> {
    let right = (trials.iter())
        .map(
            |trial| Ok(trial.with(configured_right(&trial.case.scene).map_err(|e| e.to_string())?)),
        )
        .collect::<Result<Vec<Trial>, String>>()?;
    let alone = run_all(trials, progress, |trial| trial.run(Contender::Tuned));
    let right = run_all(&right, progress, |trial| trial.run(Contender::Supervisor));
    let mut runs = 2 * trials.len();
    let wrong = (misjudged(width, draws, SEED).iter())
        .map(|misjudged| {
            let pairs: Vec<(&Trial, &ResultRow)> = trials.iter().zip(&right).collect();
            let wrong = run_all(&pairs, progress, |(trial, right)| {
                match misjudged.applied_to(&trial.case.scene) {
                    Ok(Some(wrong)) => Some(trial.with(wrong).run(Contender::Supervisor)),
                    Ok(None) => Some((*right).clone()),
                    Err(_) => None,
                }
            });
            runs += wrong.len();
            ConfiguredWrong::new(&misjudged.text, &wrong, &alone, &right)
        })
        .collect();
    let recovered = |rows: &[ResultRow]| rows.iter().filter(|row| row.recovered()).count();
    Ok(Outcome {
        alone: recovered(&alone),
        right: recovered(&right),
        wrong,
        runs: runs as u64,
    })
}

/// The scenes on plants of the catalogue, those whose name begins so.
///
/// # Errors
/// A plant of the catalogue that is not valid.
pub fn of_the_catalogue(name: &str) -> Result<Vec<Trial>, StudyError> {
    let plants = plants(RATE_HZ)?;
    let wanted = plants.iter().filter(|plant| plant.name.starts_with(name));
    Ok(wanted
        .filter_map(|plant| Some(Trial::on(plant, &stored(&plant.name, RATE_HZ)?)))
        .flatten()
        .collect())
}

fn of_unseen_machines(count: u64) -> Result<Vec<Trial>, StudyError> {
    let machines = (0..count)
        .map(RandomMachine::unseen)
        .collect::<Result<Vec<_>, _>>()?;
    Ok(machines
        .iter()
        .filter(|machine| machine.lateness() < 0.8)
        .filter_map(|machine| Some(Trial::on(&machine.plant(), &machine.gains()?)))
        .flatten()
        .collect())
}

/// Every plant of the catalogue and unseen machines, errors as usual and twice as wide; quick: P2 with the usual ones.
///
/// # Errors
/// See [`configured_wrong`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let trials = match extent {
        Extent::Quick => of_the_catalogue("P2")?,
        Extent::Full => [of_the_catalogue("")?, of_unseen_machines(16)?].concat(),
    };
    let widths: &[f64] = extent.pick(&[1.0], &[1.0, 2.0]);
    let (mut claims, mut chapters, mut cases) = (Vec::new(), Vec::new(), 0);
    for width in widths {
        let outcome = configured_wrong(&trials, (*width, extent.pick(0, 8)), progress)?;
        cases += outcome.runs;
        if *width == 1.0 {
            claims.extend(
                outcome
                    .wrong
                    .iter()
                    .filter(|t| t.text != LESS_FORCE)
                    .map(|t| {
                        let name = format!("{}: lost to levitation alone", t.text);
                        Claim::at_most(name, 0.0, t.lost_to_levitation.len() as f64)
                    }),
            );
        }
        chapters.push(chapter(&outcome, *width, trials.len()));
    }
    Ok(Report {
        classes: Vec::new(),
        title: "How well it must know its machine".to_owned(),
        claims,
        cases,
        chapters,
    })
}

fn chapter(outcome: &Outcome, width: f64, runs: usize) -> Chapter {
    let rows = outcome.wrong.iter().map(|t| {
        [
            t.text.clone(),
            t.recovered.to_string(),
            t.refused.to_string(),
            t.lost_to_levitation.len().to_string(),
            t.lost_to_right.to_string(),
            format!("{:.2}", t.force_95),
        ]
    });
    let story = format!(
        "{runs} runs for each row, one seed. Levitation alone recovers from {}, the supervisor configured right from {}. Lost are runs that levitation alone, or the supervisor configured right, recovers from and the one configured wrong does not; force is the 95th percentile of the largest contact force over that of the one configured right.",
        outcome.alone, outcome.right
    );
    Chapter::new(
        format!("Errors of width {width}"),
        vec![
            Block::text(story),
            Block::table(
                [
                    "configured",
                    "recovered",
                    "refused",
                    "lost to levitation",
                    "lost to configured right",
                    "force",
                ],
                rows,
            ),
        ],
    )
}
