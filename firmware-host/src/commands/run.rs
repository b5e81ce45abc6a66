//! `run SCENE.toml`: every policy of the scene, one table, traces and a report.

use crate::closed_loop::{Keep, RunError, run};
use crate::commands::error::{CommandError, print};
use crate::output::{self, OutputError, Staging};
use crate::policy_kind::PolicyKind;
use crate::scene::Scene;
use crate::verdict::{PolicyRun, SceneSummary};
use crate::{report, table, trace_file};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Arguments of `run`.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArgs {
    /// Scene file, e.g. firmware-host/scenes/impact_at_40_hz.toml.
    pub scene: PathBuf,
    /// Folder for verdict.json, the traces and report.html [default: runs/ and the name of the scene file].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Print the verdicts as JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// Threads to use [default: all cores]. Results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// Runs the scene and writes its results.
///
/// # Errors
/// [`CommandError`]; nothing is left behind then.
pub fn execute(args: &RunArgs) -> Result<(), CommandError> {
    let scene = Scene::load(&args.scene)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&args.scene));
    // Before any work: a folder that cannot be written to is the user's to know at once.
    output::probe(&out)?;
    let runs = run_all(&scene, args.threads)?;
    let verdicts = table::json(&scene, &runs);
    let pretty = serde_json::to_string_pretty(&verdicts)
        .map_err(|e| CommandError::other("formatting verdict.json", e))?;
    let staging = Staging::beside(&out)?;
    write_results(&staging, &scene, &runs, &pretty)?;
    let out = staging.publish()?;
    let text = if args.json {
        format!("{pretty}\n")
    } else {
        let report = out.join("report.html");
        format!(
            "{}\nreport: {}\n",
            table::text(&scene, &runs),
            report.display()
        )
    };
    print(&text)
}

fn default_folder(scene: &Path) -> PathBuf {
    Path::new("runs").join(scene.file_stem().unwrap_or(scene.as_os_str()))
}

/// Every policy of the scene, in the scene's order whatever finishes first.
fn run_all(scene: &Scene, threads: Option<u16>) -> Result<Vec<PolicyRun>, CommandError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .build()
        .map_err(|e| CommandError::other("starting threads", e))?;
    let progress = LateProgress::new(scene);
    let one = |kind: &PolicyKind| {
        let (verdict, trace) = run(scene, *kind, Keep::Trace, &mut |ticks| progress.add(ticks))?;
        Ok::<_, RunError>(PolicyRun {
            name: kind.name().to_owned(),
            verdict,
            trace,
        })
    };
    let runs = pool.install(|| {
        scene
            .policies
            .par_iter()
            .map(one)
            .collect::<Result<Vec<_>, _>>()
    });
    progress.bar.finish_and_clear();
    Ok(runs?)
}

fn write_results(
    staging: &Staging,
    scene: &Scene,
    runs: &[PolicyRun],
    verdicts: &str,
) -> Result<(), CommandError> {
    let in_file = |path: &Path| {
        let path = path.to_owned();
        move |reason| OutputError { path, reason }
    };
    let path = staging.path("verdict.json");
    std::fs::write(&path, format!("{verdicts}\n")).map_err(in_file(&path))?;
    for run in runs {
        let path = staging.path(&format!("trace_{}.parquet", run.name));
        let file = std::fs::File::create(&path).map_err(in_file(&path))?;
        trace_file::write(&run.trace, file)
            .map_err(|e| CommandError::other("writing a trace", e))?;
    }
    let html = report::html(&summary(scene), runs)
        .map_err(|e| CommandError::other("drawing the report", e))?;
    let path = staging.path("report.html");
    std::fs::write(&path, html).map_err(in_file(&path))?;
    Ok(())
}

fn summary(scene: &Scene) -> SceneSummary {
    SceneSummary {
        title: scene.title.clone(),
        story: scene.story.clone(),
        clearance_m: scene.plant.contact.clearance_m,
        force_max_n: scene.plant.magnet.map(|m| m.force_max_n),
        whirl_speed_m_s: scene.whirl_speed_m_s,
        disturbances_s: scene
            .disturbances
            .iter()
            .map(|d| (d.start_s, d.end_s()))
            .collect(),
        duration_s: scene.duration_s,
    }
}

/// A progress bar that shows itself only when the work takes longer than a second.
struct LateProgress {
    bar: ProgressBar,
    started: Instant,
}

impl LateProgress {
    fn new(scene: &Scene) -> Self {
        let ticks = (scene.duration_s * scene.sample_rate_hz).round() as u64;
        let bar = ProgressBar::with_draw_target(
            Some(ticks * scene.policies.len() as u64),
            ProgressDrawTarget::hidden(),
        );
        if let Ok(style) =
            ProgressStyle::with_template("{bar:40} {percent:>3} % of ticks, {eta} left")
        {
            bar.set_style(style);
        }
        Self {
            bar,
            started: Instant::now(),
        }
    }

    fn add(&self, ticks: u64) {
        self.bar.inc(ticks);
        if self.bar.is_hidden() && self.started.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}
