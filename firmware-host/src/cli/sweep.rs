//! `sweep SWEEP.toml`: a scene again and again with keys that vary, into one file.

mod shard;
mod show;

use self::shard::Shard;
use crate::cli::error::{CommandError, pretty, print, say};
use crate::cli::progress::{RunProgress, Threads};
use crate::cli::screen::print_wrapped;
use crate::cli::warn;
use firmware_bench::sweep::error::SweepError;
use firmware_bench::sweep::page::{self, PAGE};
use firmware_bench::sweep::plan::{Plan, digest};
use firmware_bench::sweep::store::{Program, Store};
use firmware_bench::sweep::summary::Summary;
use firmware_bench::sweep::table::Rows;
use firmware_bench::sweep::worst;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Arguments of `sweep`.
#[derive(Debug, Clone, clap::Args)]
pub struct SweepArgs {
    /// Sweep file, e.g. firmware-host/scenes/sweeps/impact.toml.
    pub sweep: PathBuf,
    /// Folder for results.parquet, report.html, summary.json and the worst runs [default: runs/ and the name of the sweep file]. A sweep
    /// that was stopped goes on there.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Run one part of N alone, I from 1 to N; `slurm`: that of this task of a Slurm job array.
    #[arg(long, value_name = "I/N", value_parser = shard::parse)]
    pub shard: Option<Shard>,
    /// Run nothing: put together what parts in these folders have done.
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "shard")]
    pub merge: Vec<PathBuf>,
    /// Print what was done as JSON instead of the summary.
    #[arg(long)]
    pub json: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// What was done, for programs.
#[derive(Debug, Serialize)]
struct Done {
    /// Runs of the sweep, or of the part, each under every policy.
    runs: u64,
    /// Rows without figures, of a part those of this call.
    failed: u64,
    /// What this call took \[s\].
    seconds: f64,
    /// Of the runs that this call has run.
    runs_per_second: f64,
    /// The others had been run before.
    runs_now: u64,
    /// Chunks of the whole sweep that are in the folder, of a part.
    #[serde(skip_serializing_if = "Option::is_none")]
    chunks: Option<[u64; 2]>,
    folder: PathBuf,
    #[serde(skip_serializing_if = "Option::is_none")]
    results: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    page: Option<PathBuf>,
    worst: Vec<PathBuf>,
}

/// Runs what is missing of a sweep, and reports its outcome.
///
/// # Errors
/// [`CommandError`]; what has been done is kept.
pub fn execute(args: &SweepArgs) -> Result<(), CommandError> {
    let started = Instant::now();
    let plan = Plan::load(&args.sweep)?;
    warn(plan.warnings());
    let shard = args.shard.unwrap_or_default();
    let shard = shard.resolve(|name| std::env::var(name).ok())?;
    let folder = (args.out.clone()).unwrap_or_else(|| {
        Path::new("runs").join(args.sweep.file_stem().unwrap_or(args.sweep.as_os_str()))
    });
    let program = program()?;
    let parts = (args.merge.iter())
        .map(|folder| Store::part(folder, &plan, &program))
        .collect::<Result<Vec<_>, _>>()?;
    let store = Store::begin(&folder, &plan, &program)?;
    let mut ran = Ran::default();
    if !store.is_done(&plan) {
        if parts.is_empty() {
            ran = run_missing(&plan, &store, shard, args.threads)?;
        }
        if args.shard.is_none() {
            store.assemble(&plan, &parts)?;
        }
    }
    let seconds = started.elapsed().as_secs_f64();
    let mut done = Done {
        runs: shard.chunks(&plan).map(|chunk| runs_in(&plan, chunk)).sum(),
        failed: ran.failed,
        seconds,
        runs_per_second: ran.runs as f64 / seconds,
        runs_now: ran.runs,
        chunks: None,
        folder,
        results: None,
        summary: None,
        page: None,
        worst: Vec::new(),
    };
    if !store.is_done(&plan) {
        let there = (0..plan.chunks()).filter(|chunk| store.has(&plan, *chunk));
        let chunks = [there.count() as u64, plan.chunks()];
        done.chunks = Some(chunks);
        return match args.json {
            true => print(&(pretty(&done, FORMATTING)? + "\n")),
            false => print_wrapped(&show::part(&args.sweep, &done, chunks)),
        };
    }
    store.tidy()?;
    let summary = Summary::new(&plan, &store)?;
    worst::keep(&plan, &store, &summary)?;
    let text = pretty(&summary, FORMATTING)? + "\n";
    store.write("summary.json", text.as_bytes())?;
    let text = page::html(&summary).map_err(|e| CommandError::other("drawing the page", e))?;
    store.write(PAGE, text.as_bytes())?;
    done.page = Some(store.path(PAGE));
    (done.runs, done.failed) = (plan.runs(), summary.failed);
    (done.results, done.summary) = (Some(store.results()), Some(store.path("summary.json")));
    done.worst = (summary.worst.iter())
        .map(|worst| store.path(&worst.file))
        .collect();
    match args.json {
        true => print(&(pretty(&done, FORMATTING)? + "\n"))?,
        false => print_wrapped(&show::all(&plan, &summary, &done))?,
    }
    match summary.failed == plan.runs() * plan.policies().len() as u64 {
        true => Err(CommandError::Untrusted(summary.errors)),
        false => Ok(()),
    }
}

const FORMATTING: &str = "formatting what was done";

/// This program.
fn program() -> Result<Program, CommandError> {
    let file =
        std::env::current_exe().map_err(|e| CommandError::other("finding the program", e))?;
    Ok(Program {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        sha256: digest(&file)?,
    })
}

fn runs_in(plan: &Plan, chunk: u64) -> u64 {
    let runs = plan.runs_of(chunk);
    runs.end - runs.start
}

/// What was run.
#[derive(Debug, Default)]
struct Ran {
    runs: u64,
    /// Rows without figures.
    failed: u64,
}

/// Runs the chunks of a shard that are not there. Each thread takes the next, so that none waits for another, and at most a
/// chunk a thread is lost when all is stopped.
fn run_missing(
    plan: &Plan,
    store: &Store,
    shard: shard::Part,
    threads: Threads,
) -> Result<Ran, CommandError> {
    let total = shard.chunks(plan).map(|chunk| runs_in(plan, chunk)).sum();
    let progress = RunProgress::new(total);
    let (next, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let work = || -> Result<Ran, SweepError> {
        let mut ran = Ran::default();
        while !stop.load(Ordering::Relaxed) {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= plan.chunks() {
                break;
            }
            if !shard.has(chunk) {
                continue;
            }
            if store.has(plan, chunk) {
                progress.skip(runs_in(plan, chunk));
                continue;
            }
            let mut rows = Rows::new(plan.columns());
            for run in plan.runs_of(chunk) {
                plan.run(run, &mut rows);
                ran.runs += 1;
                progress.add();
            }
            let errors = rows.column("error");
            let failed = (0..rows.len()).filter(|i| errors.is_some_and(|e| e.text(*i).is_some()));
            ran.failed += failed.count() as u64;
            store.keep(plan, chunk, &rows)?;
        }
        Ok(ran)
    };
    let all = threads.pool()?.broadcast(|_| {
        let ran = work();
        // The others end with the chunk that they are at.
        stop.fetch_or(ran.is_err(), Ordering::Relaxed);
        ran
    });
    progress.finish();
    let mut sum = Ran::default();
    for ran in all {
        let Ran { runs, failed } = ran?;
        sum.runs += runs;
        sum.failed += failed;
    }
    if sum.failed > 0 {
        say(format_args!(
            "{} rows have an error in the place of figures",
            sum.failed
        ));
    }
    Ok(sum)
}
