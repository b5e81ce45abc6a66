//! `accuracy [SCENE]`: error against run time, and silently wrong runs, as tables, JSON and a plot.

mod show;

use crate::cli::error::{CommandError, pretty, print, say};
use crate::cli::load;
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use firmware_bench::scene::Scene;
use firmware_studies::accuracy::wrong_runs::{self, STARTS, WrongRow};
use firmware_studies::accuracy::{AccuracyError, Reference, Row, sweep};
use serde::Serialize;
use std::path::PathBuf;

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

/// Arguments of `accuracy`.
#[derive(Debug, Clone, clap::Args)]
#[command(mut_arg("threads", |threads| {
    threads.help("Threads of the search for wrong runs [default: all cores]. Results do not depend on it")
}))]
pub struct AccuracyArgs {
    /// Scene files, each run without control, from its start, with its disturbances [default: the
    /// benchmark problems B1, B2, B3a, B3b and B3c].
    pub scenes: Vec<PathBuf>,
    /// Whether to look for silently wrong runs from 400 start speeds.
    #[arg(long, value_name = "WHEN", default_value = "auto")]
    pub wrong_runs: When,
    /// Print JSON instead of the tables.
    #[arg(long)]
    pub json: bool,
    /// Folder for accuracy.json and the plot accuracy.svg; without it nothing is written.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// How many threads the search for wrong runs may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// When to sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum When {
    /// On problems that are short.
    Auto,
    /// On all problems.
    Always,
    /// On none.
    Never,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Accuracy {
    /// Error against run time.
    rows: Vec<Row>,
    /// One for each problem.
    references: Vec<Reference>,
    /// Silently wrong runs of the problems that were swept.
    wrong_runs: Vec<WrongRow>,
    /// Problems that were not swept, and why.
    not_swept: Vec<NotSwept>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct NotSwept {
    problem: String,
    reason: &'static str,
}

/// Sweeps tolerances, methods and starts.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &AccuracyArgs) -> Result<(), CommandError> {
    let scenes = match args.scenes.as_slice() {
        [] => (BENCHMARKS.iter())
            .map(|(name, text)| Scene::parse(name, text))
            .collect::<Result<Vec<_>, _>>()?,
        paths => (paths.iter())
            .map(|path| load(path))
            .collect::<Result<Vec<_>, _>>()?,
    };
    // Tables, plots and JSON tell problems by their titles.
    for (i, scene) in scenes.iter().enumerate() {
        if scenes[..i].iter().any(|other| other.title == scene.title) {
            return Err(CommandError::Numbers {
                message: format!("two scenes have the title \"{}\"", scene.title),
                help: "give each scene a title of its own".to_owned(),
            });
        }
    }
    if let Some(out) = &args.out {
        output::probe(out)?;
    }
    let found = measure(&scenes, args)?;
    for reference in found.references.iter().filter(|r| !r.confirmed) {
        say(format_args!("warning: {}", show::unconfirmed(reference)));
    }
    let json = pretty(&found, "formatting accuracy.json")?;
    if let Some(out) = &args.out {
        let staging = Staging::for_folder(out)?;
        let svg = show::figure(&found)?;
        staging.write("accuracy.json", &json)?;
        staging.write("accuracy.svg", svg)?;
        staging.publish()?;
    }
    if args.json {
        print(&(json + "\n"))
    } else {
        print(&show::tables(&found))
    }
}

fn measure(scenes: &[Scene], args: &AccuracyArgs) -> Result<Accuracy, CommandError> {
    let failed = |scene: &Scene, e: AccuracyError| {
        CommandError::other("accuracy", format!("\"{}\": {e}", scene.title))
    };
    let mut found = Accuracy {
        rows: Vec::new(),
        references: Vec::new(),
        wrong_runs: Vec::new(),
        not_swept: Vec::new(),
    };
    // Times first, while nothing else runs.
    let progress = LateProgress::new(scenes.len() as u64, "problems timed");
    for scene in scenes {
        let (rows, reference) = sweep(scene).map_err(|e| failed(scene, e))?;
        found.rows.extend(rows);
        found.references.push(reference);
        progress.add(1);
    }
    progress.finish();
    let mut swept = Vec::new();
    for (scene, reference) in scenes.iter().zip(&found.references) {
        let reason = match args.wrong_runs {
            When::Never => Some("not asked for"),
            _ if !wrong_runs::applies_to(scene) => Some("starts at rest"),
            When::Auto if reference.evaluations > SHORT => {
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
    let progress = LateProgress::new(swept.len() as u64 * u64::from(STARTS), "starts");
    let pool = args.threads.pool()?;
    for scene in swept {
        let rows = pool.install(|| wrong_runs::sweep(scene, &|| progress.add(1)));
        found.wrong_runs.extend(rows.map_err(|e| failed(scene, e))?);
    }
    progress.finish();
    Ok(found)
}
