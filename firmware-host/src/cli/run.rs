//! `run SCENE.toml`: every policy of the scene, one table, traces and a report.

use crate::cli::error::{CommandError, Contradiction, pretty, print};
use crate::cli::load;
use crate::cli::output::{self, OutputError, Staging};
use crate::cli::progress::{LateProgress, Threads};
use firmware_bench::report::summary::summary;
use firmware_bench::report::{self, table};
use firmware_bench::run::recording::recorded;
use firmware_bench::run::verdict::{FailedRun, PolicyRun, Results};
use firmware_bench::run::verify::{self, Check};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::campaign::Progress;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::path::{Path, PathBuf};

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
    /// Write no traces; what else is written stays as it is.
    #[arg(long)]
    pub no_trace: bool,
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
/// [`CommandError`]; nothing is left behind then, except by [`CommandError::Contradicted`] and [`CommandError::Untrusted`].
pub fn execute(args: &RunArgs) -> Result<(), CommandError> {
    let scene = load(&args.scene)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&args.scene));
    // Before any work: a folder that cannot be written to is the user's to know at once.
    output::probe(&out)?;
    let staging = Staging::for_folder(&out)?;
    let results = run_all(&scene, args, &staging)?;
    let verdicts = table::json(&scene, &results);
    let verdicts = pretty(&verdicts, "formatting verdict.json")? + "\n";
    write_results(&staging, &scene, &results, &verdicts)?;
    let out = staging.publish_over(of_a_policy)?;
    let text = if args.json {
        verdicts
    } else {
        let report = out.join("report.html");
        format!(
            "{}\nreport: {}\n",
            table::text(&scene, &results),
            report.display()
        )
    };
    print(&text)?;
    let (untrusted, contradictions) = (results.untrusted(), contradictions(&results.runs));
    if !untrusted.is_empty() {
        let contradicted = contradictions.iter().map(Contradiction::to_string);
        let lines = untrusted.into_iter().map(str::to_owned).chain(contradicted);
        return Err(CommandError::Untrusted(lines.collect()));
    }
    match contradictions.is_empty() {
        true => Ok(()),
        false => Err(CommandError::Contradicted(contradictions)),
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
        let checks = run.checked().into_iter().flat_map(|v| &v.checks);
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

/// Every policy of the scene, in the scene's order whatever finishes first; traces are written meanwhile.
fn run_all(scene: &Scene, args: &RunArgs, staging: &Staging) -> Result<Results, CommandError> {
    let checks = match args.verify {
        true => verify::check_scenes(scene)?.to_vec(),
        false => Vec::new(),
    };
    let ticks = (scene.duration_s * scene.sample_rate_hz).round() as u64;
    let all = ticks * ((1 + checks.len()) * scene.policies.len()) as u64;
    let progress = LateProgress::new(all, "ticks");
    let one = |kind: &PolicyKind| {
        let name = trace_name(kind.name());
        let mut file = match args.no_trace {
            true => None,
            false => Some(staging.trace(&name)?),
        };
        let on_tick = &mut |ticks| progress.add(ticks);
        let ran = recorded(scene, *kind, &checks, file.as_mut(), on_tick);
        match (&ran, file) {
            (Ok(_), Some(file)) => staging.end_trace(&name, file)?,
            (Err(_), Some(_)) => staging.discard(&name)?,
            _ => {}
        }
        Ok(ran)
    };
    let all = args.threads.pool()?.install(|| {
        let all: Vec<_> = scene.policies.par_iter().map(one).collect();
        all.into_iter().collect::<Result<Vec<_>, OutputError>>()
    });
    progress.finish();
    let all = all?;
    if all.iter().all(Result::is_err) {
        // There is nothing to keep: the first error says it.
        all.into_iter().collect::<Result<Vec<_>, _>>()?;
        return Ok(Results::default());
    }
    let mut results = Results::default();
    for (kind, ran) in scene.policies.iter().zip(all) {
        match ran {
            Ok(run) => results.runs.push(run),
            Err(error) => results.failed.push(FailedRun {
                name: kind.name().to_owned(),
                error: error.to_string(),
            }),
        }
    }
    Ok(results)
}

fn write_results(
    staging: &Staging,
    scene: &Scene,
    results: &Results,
    verdicts: &str,
) -> Result<(), CommandError> {
    staging.write("verdict.json", verdicts)?;
    for run in &results.runs {
        let read_out = run.trace.read_out.as_ref();
        if let Some(record) = read_out.and_then(|read_out| read_out.flight_record.as_ref()) {
            staging.write(&record_name(&run.name), &record.entries)?;
        }
    }
    let html = report::html(&summary(scene), results)
        .map_err(|e| CommandError::other("drawing the report", e))?;
    staging.write("report.html", html)?;
    Ok(())
}
