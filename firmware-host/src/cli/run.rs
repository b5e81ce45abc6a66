//! `run SCENE.toml`: every policy of the scene, one table, traces and a report.

use crate::cli::error::{CommandError, Contradiction, pretty, print};
use crate::cli::load_changed;
use crate::cli::output::{self, OutputError, Staging};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_bench::report::{self, table};
use firmware_bench::run::closed_loop::RunError;
use firmware_bench::run::recording::{TraceFiles, recorded};
use firmware_bench::run::trace_columns::Columns;
use firmware_bench::run::verdict::{FailedRun, MachineRun, PolicyRun, Results};
use firmware_bench::run::verify::{self, Check};
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::Setting;
use firmware_bench::scene::{PlaneScene, Scene};
use firmware_bench::sweep::plan::digest;
use firmware_studies::campaign::{Progress, each};
use std::fs::File;
use std::path::{Path, PathBuf};

/// Arguments of `run`.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArgs {
    /// Scene file, e.g. firmware-host/scenes/impact_at_40_hz.toml.
    pub scene: PathBuf,
    /// Folder for verdict.json, the traces and report.html [default: runs/ and the name of the scene file].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Put a value in the place of the scene's, as friction.coefficient=0.2 or supervisor.hold_share=0.5; any number of times.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Setting>,
    /// The same as --set run.seed=NUMBER.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(i64).range(0..))]
    pub seed: Option<i64>,
    /// Run each policy twice more, tighter and by another method, and say how far the runs lie apart.
    #[arg(long)]
    pub verify: bool,
    /// Write no traces; what else is written stays as it is.
    #[arg(long)]
    pub no_trace: bool,
    /// Print the verdicts as JSON instead of the table.
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
    /// Print no results, which are in the folder; warnings about the scene and errors are told as ever.
    #[arg(long, short)]
    pub quiet: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

impl RunArgs {
    /// What a trace says of itself.
    fn about(
        &self,
        scene: &Scene,
        policy: &str,
        plane: Option<&str>,
    ) -> Vec<(&'static str, String)> {
        let file = self.scene.file_name().unwrap_or(self.scene.as_os_str());
        let mut set: Vec<String> = self.set.iter().map(Setting::to_string).collect();
        set.extend(self.seed.map(|seed| format!("run.seed={seed}")));
        let program = concat!("firmware-host ", env!("CARGO_PKG_VERSION"));
        let all = [
            ("program", Some(program.to_owned())),
            ("scene", Some(file.to_string_lossy().into_owned())),
            ("scene_title", Some(scene.title.clone())),
            // It has just been read: what cannot be read again has no digest.
            ("scene_sha256", digest(&self.scene).ok()),
            ("set", (!set.is_empty()).then(|| set.join("; "))),
            ("policy", Some(policy.to_owned())),
            ("plane", plane.map(str::to_owned)),
        ];
        let given = all
            .into_iter()
            .filter_map(|(key, value)| Some((key, value?)));
        given.collect()
    }
}

/// Runs the scene and writes its results.
///
/// # Errors
/// [`CommandError`]; nothing is left behind then, except by [`CommandError::Contradicted`] and [`CommandError::Untrusted`].
pub fn execute(args: &RunArgs) -> Result<(), CommandError> {
    let scene = load_changed(&args.scene, |spec| {
        let set = args
            .set
            .iter()
            .map(|setting| (setting.path.as_str(), setting.value.clone()));
        let seed = args.seed.map(|seed| ("run.seed", seed.into()));
        spec.set_all(&set.chain(seed).collect::<Vec<_>>())
    })?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| default_folder(&args.scene));
    let rows = scene.simulated_s() * scene.sample_rate_hz * scene.policies.len() as f64;
    if rows > MOST_ROWS && !args.no_trace {
        let gigabytes = BYTES_OF_ROW * rows * scene.planes.len() as f64 * 1e-9;
        return Err(CommandError::Numbers {
            message: format!(
                "{}: traces of {rows:e} rows would have some {gigabytes:.0} GB",
                args.scene.display()
            ),
            help: "give --no-trace: figures, report and flight records stay as they are".to_owned(),
        });
    }
    // Before any work: a folder that cannot be written to is the user's to know at once.
    output::probe(&out)?;
    let staging = Staging::for_folder(&out)?;
    let ran = ran(&scene, args, &staging)?;
    let out = staging.publish_over(of_a_policy)?;
    if args.json && !args.quiet {
        print(&ran.verdicts)?;
    } else if !args.quiet {
        let report = out.join("report.html");
        print_wrapped(&format!("{}\nreport: {}\n", ran.table, report.display()))?;
    }
    if !ran.untrusted.is_empty() {
        let contradicted = ran.contradictions.iter().map(Contradiction::to_string);
        let lines = ran.untrusted.into_iter().chain(contradicted);
        return Err(CommandError::Untrusted(lines.collect()));
    }
    match ran.contradictions.is_empty() {
        true => Ok(()),
        false => Err(CommandError::Contradicted(ran.contradictions)),
    }
}

/// Most rows of all traces, and what one of them takes in a file, compressed.
const MOST_ROWS: f64 = 1e8;
const BYTES_OF_ROW: f64 = 115.0;

/// Outcome of a scene, as it is reported.
struct Ran {
    table: String,
    /// JSON.
    verdicts: String,
    untrusted: Vec<String>,
    contradictions: Vec<Contradiction>,
}

fn ran(scene: &Scene, args: &RunArgs, staging: &Staging) -> Result<Ran, CommandError> {
    let results = run_all(scene, args, staging)?;
    let verdicts = pretty(&table::json(scene, &results), "formatting verdict.json")? + "\n";
    staging.write("verdict.json", &verdicts)?;
    let mut contradicted = Vec::new();
    for (plane, runs) in scene.planes.iter().zip(&results.planes) {
        write_records(staging, runs, plane)?;
        contradicted.extend(contradictions(runs, plane));
    }
    let html = report::html(scene, &results)
        .map_err(|error| CommandError::other("drawing the report", error))?;
    staging.write("report.html", html)?;
    Ok(Ran {
        table: table::text(scene, &results),
        verdicts,
        untrusted: results.untrusted().into_iter().map(str::to_owned).collect(),
        contradictions: contradicted,
    })
}

/// Whether a file is a run's of one policy: an earlier one may have had policies that this one has not, and what they
/// left would be taken for results of this scene.
fn of_a_policy(file: &str) -> bool {
    // With the names of planes behind them.
    let of = |policy: &str| {
        let of = |start: &str, end: &str| {
            let rest = file
                .strip_prefix(start)
                .and_then(|rest| rest.strip_suffix(end));
            rest.and_then(|rest| rest.strip_prefix(policy))
                .is_some_and(|plane| plane.is_empty() || plane.starts_with('_'))
        };
        of("trace_", ".parquet") || of("axis_", ".parquet") || of("record_", ".bin")
    };
    PolicyKind::ALL.iter().any(|kind| of(kind.name()))
}

/// A policy, and the plane where that has a name, as they stand in names of files.
fn in_files(policy: &str, plane: &PlaneScene) -> String {
    match plane.name_in_files().as_str() {
        "" => policy.to_owned(),
        plane => format!("{policy}_{plane}"),
    }
}

/// Checks that end with another outcome than their run.
fn contradictions(runs: &[PolicyRun], plane: &PlaneScene) -> Vec<Contradiction> {
    let of_run = |run: &PolicyRun| {
        let checks = run.checked().into_iter().flat_map(|v| &v.checks);
        let other = checks.filter(|c| c.outcome != run.verdict.figures.outcome);
        let contradiction = |c: &Check| Contradiction {
            policy: match plane.name.as_str() {
                "" => run.name.clone(),
                plane => format!("{}, {plane}", run.name),
            },
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

/// What comes of each policy, in the scene's order whatever finishes first: a run, or why there is none.
type Outcomes = Vec<Result<MachineRun, RunError>>;

/// Runs every policy; where none can be trusted there is nothing to keep, and the first error says it.
fn each_policy(
    scene: &Scene,
    args: &RunArgs,
    checks: usize,
    one: impl Fn(PolicyKind, &mut dyn FnMut(u64)) -> Result<Result<MachineRun, RunError>, OutputError>
    + Sync,
) -> Result<Outcomes, CommandError> {
    let ticks = (scene.duration_s * scene.sample_rate_hz).round() as u64;
    let all = ticks * ((1 + checks) * scene.policies.len()) as u64;
    let progress = LateProgress::new(all, "ticks");
    let one = |kind: &PolicyKind| one(*kind, &mut |ticks| progress.add(ticks));
    let all = args.threads.pool()?.install(|| {
        let all: Vec<_> = each(&scene.policies, one);
        all.into_iter().collect::<Result<Outcomes, OutputError>>()
    });
    progress.finish();
    let mut all = all?;
    // A controller that cannot be set up is an error of the scene, whatever else has run.
    if let Some(i) = all.iter().position(is_of_the_scene) {
        all.swap_remove(i)?;
    }
    if all.iter().all(Result::is_err) {
        all.into_iter().collect::<Result<Vec<_>, _>>()?;
        return Ok(Vec::new());
    }
    Ok(all)
}

fn is_of_the_scene(outcome: &Result<MachineRun, RunError>) -> bool {
    matches!(outcome, Err(RunError::Controller { reason, .. }) if reason.help().is_some())
}

/// Every policy of the scene; traces are written meanwhile.
fn run_all(scene: &Scene, args: &RunArgs, staging: &Staging) -> Result<Results, CommandError> {
    let checks = match args.verify {
        true => verify::check_scenes(scene)?.to_vec(),
        false => Vec::new(),
    };
    let all = each_policy(scene, args, checks.len(), |kind, on_tick| {
        let names = Names::new(scene, kind.name());
        let mut files = match args.no_trace {
            true => None,
            false => Some(names.begin(scene, (args, kind.name()), staging)?),
        };
        let ran = recorded(scene, kind, &checks, files.as_mut(), on_tick);
        match (&ran, files) {
            (Ok(_), Some(files)) => names.end(files, staging)?,
            (Err(_), Some(_)) => names.discard(staging)?,
            _ => {}
        }
        Ok(ran)
    })?;
    let mut results = Results::default();
    for (kind, ran) in scene.policies.iter().zip(all) {
        match ran {
            Ok(run) => results.push(run),
            Err(error) => results.failed.push(FailedRun {
                name: kind.name().to_owned(),
                error: error.to_string(),
            }),
        }
    }
    Ok(results)
}

/// Names of the trace files of a policy.
struct Names {
    planes: Vec<String>,
    axis: Option<String>,
}

impl Names {
    fn new(scene: &Scene, policy: &str) -> Self {
        Self {
            planes: (scene.planes.iter())
                .map(|plane| format!("trace_{}.parquet", in_files(policy, plane)))
                .collect(),
            axis: (scene.has_axis()).then(|| format!("axis_{policy}.parquet")),
        }
    }

    fn begin(
        &self,
        scene: &Scene,
        (args, policy): (&RunArgs, &str),
        staging: &Staging,
    ) -> Result<TraceFiles<File>, OutputError> {
        let planes = self.planes.iter().zip(&scene.planes).map(|(name, plane)| {
            let named = Some(plane.name.as_str()).filter(|name| !name.is_empty());
            let columns = Columns::of_plane().about(args.about(scene, policy, named));
            staging.trace(name, columns)
        });
        let modes = scene.machine.rotor.bending().len();
        let axis = self.axis.as_ref().map(|name| {
            let columns = Columns::of_axis(modes).about(args.about(scene, policy, None));
            staging.trace(name, columns)
        });
        Ok(TraceFiles {
            planes: planes.collect::<Result<_, _>>()?,
            axis: axis.transpose()?,
        })
    }

    fn end(&self, files: TraceFiles<File>, staging: &Staging) -> Result<(), OutputError> {
        for (name, file) in self.planes.iter().zip(files.planes) {
            staging.end_trace(name, file)?;
        }
        match (&self.axis, files.axis) {
            (Some(name), Some(file)) => staging.end_trace(name, file),
            _ => Ok(()),
        }
    }

    fn discard(&self, staging: &Staging) -> Result<(), OutputError> {
        for name in self.planes.iter().chain(&self.axis) {
            staging.discard(name)?;
        }
        Ok(())
    }
}

/// Frozen flight records, each under the name that its policy has.
fn write_records(
    staging: &Staging,
    runs: &[PolicyRun],
    plane: &PlaneScene,
) -> Result<(), CommandError> {
    for run in runs {
        let read_out = run.trace.read_out.as_ref();
        if let Some(record) = read_out.and_then(|read_out| read_out.flight_record.as_ref()) {
            let name = format!("record_{}.bin", in_files(&run.name, plane));
            staging.write(&name, record)?;
        }
    }
    Ok(())
}
