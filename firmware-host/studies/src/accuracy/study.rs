//! Accuracy of the benchmark problems, or of scenes of one's own, as a study.

use super::wrong_runs::{self, STARTS, WrongRow};
use super::{AccuracyError, CONFIRMED_CLEARANCES, Reference, Row, sweep};
use crate::campaign::{
    Block, Chapter, Claim, Drawing, Extent, Figure, Page, Progress, Report, StudyError,
};
use firmware_bench::report::plot::chart::{Axis, Chart, Curve};
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use plant_model::Method;
use serde::Serialize;

/// The benchmark problems of the integrator, as `firmware-host/scenes` has them.
const BENCHMARKS: [(&str, &str); 5] = [
    (
        "benchmark_b1.toml",
        include_str!("../../scenes/benchmark_b1.toml"),
    ),
    (
        "benchmark_b2.toml",
        include_str!("../../scenes/benchmark_b2.toml"),
    ),
    (
        "benchmark_b3a.toml",
        include_str!("../../scenes/benchmark_b3a.toml"),
    ),
    (
        "benchmark_b3b.toml",
        include_str!("../../scenes/benchmark_b3b.toml"),
    ),
    (
        "benchmark_b3c.toml",
        include_str!("../../scenes/benchmark_b3c.toml"),
    ),
];
/// Problems whose references take more evaluations are swept only when asked to: with fewer, the sweep
/// takes some ten seconds at most.
const SHORT: u64 = 750_000;

/// When to look for silently wrong runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WrongRuns {
    /// On problems that are short.
    Auto,
    /// On all problems.
    Always,
    /// On none.
    Never,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Error against run time.
    pub rows: Vec<Row>,
    /// One for each problem.
    pub references: Vec<Reference>,
    /// Silently wrong runs of the problems that were swept.
    pub wrong_runs: Vec<WrongRow>,
    /// Problems that were not swept, and why.
    pub not_swept: Vec<NotSwept>,
}

/// A problem that was not swept for wrong runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NotSwept {
    /// Title of the scene.
    pub problem: String,
    /// Why.
    pub reason: &'static str,
}

/// A problem without an answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("\"{problem}\": {reason}")]
pub struct ProblemError {
    problem: String,
    reason: AccuracyError,
}

/// The benchmark problems as scenes.
///
/// # Errors
/// [`SceneError`] if a file of them is not valid.
pub fn benchmarks() -> Result<Vec<Scene>, SceneError> {
    (BENCHMARKS.iter())
        .map(|(name, text)| Scene::parse(name, text))
        .collect()
}

/// Sweeps tolerances and methods of every scene, one run at a time since they are timed, and then starts, on the threads of
/// the pool that it is called in.
///
/// # Errors
/// [`ProblemError`].
pub fn measure(
    scenes: &[Scene],
    when: WrongRuns,
    progress: &dyn Progress,
) -> Result<Accuracy, ProblemError> {
    let failed = |scene: &Scene, reason| ProblemError {
        problem: scene.title.clone(),
        reason,
    };
    let mut found = Accuracy {
        rows: Vec::new(),
        references: Vec::new(),
        wrong_runs: Vec::new(),
        not_swept: Vec::new(),
    };
    progress.begin(scenes.len() as u64, "problems timed");
    for scene in scenes {
        let (rows, reference) = sweep(scene).map_err(|e| failed(scene, e))?;
        found.rows.extend(rows);
        found.references.push(reference);
        progress.add(1);
    }
    let mut swept = Vec::new();
    for (scene, reference) in scenes.iter().zip(&found.references) {
        let reason = match when {
            WrongRuns::Never => Some("not asked for"),
            _ if !wrong_runs::applies_to(scene) => Some("starts at rest"),
            WrongRuns::Auto if reference.evaluations > SHORT => {
                Some("takes long: ask with --wrong-runs always")
            }
            _ => None,
        };
        match reason {
            None => swept.push(scene),
            Some(reason) => found.not_swept.push(NotSwept {
                problem: scene.title.clone(),
                reason,
            }),
        }
    }
    progress.begin(swept.len() as u64 * u64::from(STARTS), "starts");
    for scene in swept {
        let rows = wrong_runs::sweep(scene, &|| progress.add(1));
        found.wrong_runs.extend(rows.map_err(|e| failed(scene, e))?);
    }
    Ok(found)
}

/// Looser tolerances are for a first look, tighter ones are at what arithmetic can do.
const CLAIMED_RTOL: std::ops::RangeInclusive<f64> = 1e-11..=1e-4;

/// Problems of a quick run, by their titles.
const QUICK: [&str; 2] = ["B1:", "B3a:"];

/// The benchmark problems; quick: the two that take least.
///
/// # Errors
/// [`ProblemError`], [`SceneError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let mut scenes = benchmarks()?;
    scenes.retain(|scene| extent == Extent::Full || QUICK.iter().any(|q| scene.title.contains(q)));
    let when = extent.pick(WrongRuns::Never, WrongRuns::Auto);
    let found = measure(&scenes, when, progress)?;
    let mut chapters = chapters(&found);
    if let Some((_, problems)) = chapters.split_last_mut() {
        for problem in problems {
            (problem.folded, problem.in_docs) = (true, false);
        }
    }
    let runs_of_starts: u32 = found.wrong_runs.iter().map(|row| row.of).sum();
    Ok(Report {
        classes: Vec::new(),
        title: TITLE.to_owned(),
        claims: claims(&found),
        cases: (found.rows.len() as u64) + u64::from(runs_of_starts),
        chapters,
    })
}

const TITLE: &str = "Error against run time";

/// The documentation says 1.1, in two digits.
const ERROR_OVER_RTOL: f64 = 1.15;

fn claims(found: &Accuracy) -> Vec<Claim> {
    let mut claims = Vec::new();
    for reference in &found.references {
        let problem = &reference.problem;
        let name = format!("{problem}: two methods at 1e-13 apart [clearances]");
        claims.push(Claim::at_most(
            name,
            CONFIRMED_CLEARANCES,
            reference.uncertainty,
        ));
        let series = Method::Series.name();
        let of_series = (found.rows.iter())
            .filter(|row| row.problem == *problem && row.method == series)
            .filter(|row| CLAIMED_RTOL.contains(&row.rtol));
        let worst = of_series
            .map(|row| row.error.map_or(f64::INFINITY, |e| e / row.rtol))
            .fold(0.0, f64::max);
        let name = format!("{problem}: error of the series over rtol, 1e-4 to 1e-11");
        claims.push(Claim::at_most(name, ERROR_OVER_RTOL, worst));
    }
    let tight = found.wrong_runs.iter().filter(|row| row.rtol <= 1e-6);
    claims.extend(tight.map(|row| {
        let name = format!(
            "{}: silently wrong runs at rtol {:.0e}",
            row.problem, row.rtol
        );
        Claim::at_most(name, 0.0, f64::from(row.wrong))
    }));
    claims
}

/// The chapters as a page.
pub fn page(found: &Accuracy) -> Page {
    let sure = found.references.iter().filter(|r| r.confirmed).count();
    Page {
        title: TITLE.to_owned(),
        headline: format!(
            "{sure} of {} problems have a reference that two methods agree on; {} of {} runs of them are silently wrong.",
            found.references.len(),
            found.wrong_runs.iter().map(|row| row.wrong).sum::<u32>(),
            found.wrong_runs.iter().map(|row| row.of).sum::<u32>(),
        ),
        lead: Vec::new(),
        chapters: chapters(found),
    }
}

/// A chapter for each problem, and one of silently wrong runs.
pub fn chapters(found: &Accuracy) -> Vec<Chapter> {
    let mut chapters: Vec<Chapter> = (found.references.iter())
        .map(|reference| {
            let rows = found
                .rows
                .iter()
                .filter(|row| row.problem == reference.problem);
            let figure = reference.confirmed.then(|| figure(reference, rows.clone()));
            let blocks = vec![
                Block::text(reference.in_words()),
                Block::Figures(figure.into_iter().collect()),
                Block::table(ERROR_COLUMNS, rows.map(error_cells)),
            ];
            Chapter::new(&reference.problem, blocks)
        })
        .collect();
    let left_out = |not: &NotSwept| format!("{}: no search ({})", not.problem, not.reason);
    let mut blocks = vec![Block::List(found.not_swept.iter().map(left_out).collect())];
    if !found.wrong_runs.is_empty() {
        let rows = found.wrong_runs.iter().map(wrong_cells);
        blocks.insert(0, Block::table(WRONG_COLUMNS, rows));
    }
    let title = format!("Silently wrong runs, from {STARTS} start speeds each");
    chapters.push(Chapter::new(title, blocks));
    chapters
}

/// Times over errors, a curve a method.
fn figure<'a>(reference: &Reference, rows: impl Iterator<Item = &'a Row> + Clone) -> Figure {
    // Below the references' distance an error means nothing; it is drawn there.
    let floor = reference.uncertainty.max(1e-15);
    let points = |method: &str| {
        let point = |row: &Row| Some((row.error?.max(floor), row.seconds));
        let of_method = rows.clone().filter(|row| row.method == method);
        of_method.filter_map(point).collect::<Vec<_>>()
    };
    let curves: Vec<Curve> = (0..)
        .zip([Method::Series, Method::Collocation])
        .map(|(colour, method)| {
            Curve::line(method.name().to_owned(), points(method.name()), colour)
        })
        .collect();
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let positive = values.filter(|v| *v > 0.0);
        let (low, high) = positive.fold((1.0_f64, 1e-15_f64), |(a, b), v| (a.min(v), b.max(v)));
        (0.5 * low, 2.0 * high)
    };
    Figure {
        file: reference.problem.clone().into(),
        caption: format!("{}: run time over error.", reference.problem),
        drawing: Drawing::Chart(Chart {
            label: format!("{}: run time over error", reference.problem),
            x: Axis::log("error / clearance", range(&mut all().map(|p| p.0))),
            y: Axis::log("time / s", range(&mut all().map(|p| p.1))),
            curves: curves.clone(),
        }),
    }
}

const ERROR_COLUMNS: [&str; 7] = [
    "method",
    "rtol",
    "error [c]",
    "time [ms]",
    "steps",
    "evaluations",
    "mode changes",
];

fn error_cells(row: &Row) -> [String; ERROR_COLUMNS.len()] {
    [
        row.method.to_owned(),
        format!("{:.0e}", row.rtol),
        row.error.map_or("–".to_owned(), |e| format!("{e:.1e}")),
        format!("{:.3}", row.seconds * 1e3),
        row.steps.to_string(),
        row.evaluations.to_string(),
        row.mode_changes.to_string(),
    ]
}

const WRONG_COLUMNS: [&str; 7] = [
    "problem", "method", "rtol", "wrong", "failed", "of", "left out",
];

fn wrong_cells(row: &WrongRow) -> [String; WRONG_COLUMNS.len()] {
    [
        row.problem.clone(),
        row.method.to_owned(),
        format!("{:.0e}", row.rtol),
        row.wrong.to_string(),
        row.failed.to_string(),
        row.of.to_string(),
        row.left_out.to_string(),
    ]
}
