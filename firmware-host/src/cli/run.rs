//! `run SCENE.toml`: every policy of the scene, one table, traces and a report.

use crate::cli::error::{CommandError, Contradiction, pretty, print};
use crate::cli::load;
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use firmware_bench::report::summary::summary;
use firmware_bench::report::{self, table};
use firmware_bench::run::closed_loop::{Keep, RunError, run};
use firmware_bench::run::supervision::Supervision;
use firmware_bench::run::verdict::{PolicyRun, Verdict};
use firmware_bench::run::verify::Check;
use firmware_bench::run::{trace_file, verify};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::campaign::Progress;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `run`.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArgs {
    /// Scene file, e.g. firmware-host/scenes/impact_at_40_hz.toml.
    pub scene: PathBuf,
    /// Folder for verdict.json, the traces and report.html [default: runs/ and the name of the scene file].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Run each policy twice more, tighter and by another method, and say how far the runs lie apart.
    #[arg(long)]
    pub verify: bool,
    /// Print the verdicts as JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// Runs the scene and writes its results.
///
/// # Errors
/// [`CommandError`]; nothing is left behind then, except by [`CommandError::Contradicted`].
pub fn execute(args: &RunArgs) -> Result<(), CommandError> {
    let scene = load(&args.scene)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&args.scene));
    // Before any work: a folder that cannot be written to is the user's to know at once.
    output::probe(&out)?;
    let runs = run_all(&scene, args)?;
    let verdicts = table::json(&scene, &runs);
    let verdicts = pretty(&verdicts, "formatting verdict.json")? + "\n";
    let staging = Staging::for_folder(&out)?;
    write_results(&staging, &scene, &runs, &verdicts)?;
    let out = staging.publish_over(of_a_policy)?;
    let text = if args.json {
        verdicts
    } else {
        let report = out.join("report.html");
        format!(
            "{}\nreport: {}\n",
            table::text(&scene, &runs),
            report.display()
        )
    };
    print(&text)?;
    let contradictions = contradictions(&runs);
    if contradictions.is_empty() {
        Ok(())
    } else {
        Err(CommandError::Contradicted(contradictions))
    }
}

/// Whether a file is a run's of one policy: an earlier one may have had policies that this one has not, and what they
/// left would be taken for results of this scene.
fn of_a_policy(file: &str) -> bool {
    let of = |policy| file == trace_name(policy) || file == record_name(policy);
    PolicyKind::ALL.iter().any(|kind| of(kind.name()))
}

fn trace_name(policy: &str) -> String {
    format!("trace_{policy}.parquet")
}

fn record_name(policy: &str) -> String {
    format!("record_{policy}.bin")
}

/// Checks that end with another outcome than their run.
fn contradictions(runs: &[PolicyRun]) -> Vec<Contradiction> {
    let of_run = |run: &PolicyRun| {
        let checks = run.verification.iter().flat_map(|v| &v.checks);
        let other = checks.filter(|c| c.outcome != run.verdict.figures.outcome);
        let contradiction = |c: &Check| Contradiction {
            policy: run.name.clone(),
            outcome: run.verdict.figures.outcome.name(),
            method: c.method,
            rtol: c.rtol,
            other: c.outcome.name(),
        };
        other.map(contradiction).collect::<Vec<_>>()
    };
    runs.iter().flat_map(of_run).collect()
}

fn default_folder(scene: &Path) -> PathBuf {
    Path::new("runs").join(scene.file_stem().unwrap_or(scene.as_os_str()))
}

/// Every policy of the scene, in the scene's order whatever finishes first.
fn run_all(scene: &Scene, args: &RunArgs) -> Result<Vec<PolicyRun>, CommandError> {
    let mut scenes = vec![scene.clone()];
    if args.verify {
        scenes.extend(verify::check_scenes(scene)?);
    }
    // A policy's run and its checks, one policy after the other.
    let jobs: Vec<(PolicyKind, usize)> = (scene.policies.iter())
        .flat_map(|kind| (0..scenes.len()).map(move |of| (*kind, of)))
        .collect();
    let ticks = (scene.duration_s * scene.sample_rate_hz).round() as u64;
    let progress = LateProgress::new(ticks * jobs.len() as u64, "ticks");
    let one = |(kind, of): &(PolicyKind, usize)| {
        let on_tick = &mut |ticks| progress.add(ticks);
        let started = Instant::now();
        let (figures, trace) = match of {
            0 => run(scene, *kind, Keep::Trace, on_tick),
            _ => verify::run_check(&scenes[*of], *kind, on_tick),
        }?;
        Ok((figures, trace, started.elapsed()))
    };
    let results = args.threads.pool()?.install(|| {
        let all: Vec<_> = jobs.par_iter().map(one).collect();
        // The first error in the order of the jobs, whoever came first.
        all.into_iter().collect::<Result<Vec<_>, RunError>>()
    });
    progress.finish();
    let mut results = results?.into_iter();
    let mut runs = Vec::with_capacity(scene.policies.len());
    for kind in &scene.policies {
        let Some((figures, trace, elapsed)) = results.next() else {
            break;
        };
        let checks: Vec<Check> = (scenes[1..].iter().zip(results.by_ref()))
            .map(|(check, (figures, other, _))| verify::compare(check, &trace, (&figures, &other)))
            .collect();
        runs.push(PolicyRun {
            name: kind.name().to_owned(),
            verification: args
                .verify
                .then(|| verify::verification(&figures, &trace, checks)),
            verdict: Verdict::new(figures, scene, elapsed),
            supervision: Supervision::of(&trace),
            trace,
        });
    }
    Ok(runs)
}

fn write_results(
    staging: &Staging,
    scene: &Scene,
    runs: &[PolicyRun],
    verdicts: &str,
) -> Result<(), CommandError> {
    staging.write("verdict.json", verdicts)?;
    for run in runs {
        staging.write_by(&trace_name(&run.name), |file| {
            trace_file::write(&run.trace, file).map_err(trace_file::reason)
        })?;
        let read_out = run.trace.read_out.as_ref();
        if let Some(record) = read_out.and_then(|read_out| read_out.flight_record.as_ref()) {
            staging.write(&record_name(&run.name), &record.entries)?;
        }
    }
    let html = report::html(&summary(scene), runs)
        .map_err(|e| CommandError::other("drawing the report", e))?;
    staging.write("report.html", html)?;
    Ok(())
}
