//! `study`: any of the studies, with its claims.

use crate::cli::chapters;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_studies::STUDIES;
use firmware_studies::campaign::{
    Claim, Extent, Machines, OnRecord, Report, Study, StudyError, digest, html,
};
use firmware_studies::on_target::measure::TargetError;
use firmware_studies::validation::RecordError;
use serde::Serialize;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `study`.
#[derive(Debug, Clone, clap::Args)]
pub struct StudyArgs {
    /// Which one; `list` says what there is.
    #[arg(value_parser = names())]
    pub name: String,
    /// Fewer cases: seconds to a minute.
    #[arg(long)]
    pub quick: bool,
    /// Machines of each class, of a study on machines drawn at random.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub machines: Option<u64>,
    /// Seed of their draw.
    #[arg(long, value_name = "NUMBER")]
    pub seed: Option<u64>,
    /// Record in CSV, of a study that compares with a measured one.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Print claims, the rows behind them, number of cases and seconds as JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// Page of the documentation, in Markdown, that gets what is claimed and the first rows of the tables between its marks.
    #[arg(long, value_name = "FILE")]
    pub page: Option<PathBuf>,
    /// Folder for the page as NAME.html; without it nothing is written.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// End with exit code 1 where a claim does not hold.
    #[arg(long)]
    pub strict: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

const LIST: &str = "list";

fn names() -> clap::builder::PossibleValuesParser {
    let names = STUDIES.iter().map(|study| study.name);
    names.chain([LIST]).collect::<Vec<_>>().into()
}

/// What programs get of a study.
#[derive(Debug, Serialize)]
struct Measured<'a> {
    study: &'static str,
    quick: bool,
    claims: &'a [Claim],
    cases: u64,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    rows: &'a [serde_json::Value],
    seconds: f64,
}

/// Runs a study, or lists them.
///
/// # Errors
/// [`CommandError`]; [`CommandError::Claims`] after the results were printed.
pub fn execute(args: &StudyArgs) -> Result<(), CommandError> {
    match STUDIES.iter().find(|study| study.name == args.name) {
        Some(study) => run(study, args),
        None => list(args.json),
    }
}

fn list(json: bool) -> Result<(), CommandError> {
    if json {
        let names: Vec<&str> = STUDIES.iter().map(|study| study.name).collect();
        return print(
            &(pretty(
                &serde_json::json!({ "names": names }),
                "formatting the list",
            )? + "\n"),
        );
    }
    let line = |study: &Study| format!("{:16} {}\n", study.name, study.about);
    print(&STUDIES.iter().map(line).collect::<String>())
}

fn run(study: &Study, args: &StudyArgs) -> Result<(), CommandError> {
    // What cannot be written is named before anything takes its time.
    if let Some(out) = &args.out {
        output::probe(out)?;
    }
    let marked = (args.page.as_ref())
        .map(|page| MarkedPage::open(page, study.name))
        .transpose()?;
    let (bar, begun) = (LateProgress::default(), Instant::now());
    let (extent, machines) = (Extent::new(args.quick), machines_of(study, args)?);
    let recorded = recorded(study, args)?;
    let report = (args.threads.pool()?)
        .install(|| match (study.drawn, machines, recorded) {
            (Some(drawn), Some(machines), _) => drawn(machines, extent, &bar),
            (_, _, Some((on_record, file))) => on_record(file, extent, &bar),
            _ => (study.run)(extent, &bar),
        })
        .map_err(|error| failed(study.name, error))?;
    bar.finish();
    let seconds = begun.elapsed().as_secs_f64();
    let quick = if args.quick { " --quick" } else { "" };
    let page = report.page(&format!("study {}{quick}", study.name));
    if let Some(out) = &args.out {
        let html = html(&page).map_err(|e| CommandError::other("drawing the page", e))?;
        let staging = Staging::for_folder(out)?;
        staging.write(&format!("{}.html", study.name), html)?;
        staging.publish()?;
    }
    if let Some(marked) = marked {
        marked.write(&digest(&page))?;
    }
    if args.json {
        let measured = Measured {
            study: study.name,
            quick: args.quick,
            claims: &report.claims,
            cases: report.cases,
            rows: &report.classes,
            seconds,
        };
        print(&(pretty(&measured, "formatting the claims")? + "\n"))?;
    } else {
        let text = chapters::of_claims(&report.claims);
        print_wrapped(&format!("{text}; {} cases, {seconds:.1} s\n", report.cases))?;
    }
    strictly(args.strict, &report)
}

/// A page of the documentation, part of which a study writes: what stands between the marks.
struct MarkedPage<'a> {
    path: &'a Path,
    before: String,
    after: String,
}

impl<'a> MarkedPage<'a> {
    /// The first mark begins so, with the study's name behind it; the second one is whole.
    const MARKS: [&'static str; 2] = ["<!-- study ", "<!-- end -->"];

    fn open(path: &'a Path, study: &str) -> Result<Self, CommandError> {
        let text = std::fs::read_to_string(path)
            .map_err(|e| CommandError::other("reading the page", e))?;
        let [begin, end] = Self::MARKS;
        let begin = format!("{begin}{study}: ");
        let parts = text.split_once(&begin).and_then(|(before, rest)| {
            let (mark, rest) = rest.split_once('\n')?;
            let (_, after) = rest.split_once(end)?;
            Some((format!("{before}{begin}{mark}\n"), format!("{end}{after}")))
        });
        let Some((before, after)) = parts else {
            return Err(CommandError::Numbers {
                message: format!("{}: no place for the study {study}", path.display()),
                help: format!("a line begins with `{begin}`, a later one is `{end}`"),
            });
        };
        Ok(Self {
            path,
            before,
            after,
        })
    }

    /// The page is replaced as a whole or not at all.
    fn write(&self, text: &str) -> Result<(), CommandError> {
        let failed = |e: std::io::Error| CommandError::other("writing the page", e);
        let folder = self.path.parent().filter(|p| *p != Path::new(""));
        let mut file =
            tempfile::NamedTempFile::new_in(folder.unwrap_or(Path::new("."))).map_err(failed)?;
        let Self { before, after, .. } = self;
        write!(file, "{before}\n{text}\n{after}").map_err(failed)?;
        file.persist(self.path).map_err(|e| failed(e.error))?;
        Ok(())
    }
}

/// Machines that are asked for, of a study that has such.
fn machines_of(study: &Study, args: &StudyArgs) -> Result<Option<Machines>, CommandError> {
    let machines = Machines {
        seed: args.seed,
        number: args.machines,
    };
    if machines == Machines::default() {
        return Ok(None);
    }
    if study.drawn.is_none() {
        let with = STUDIES.iter().filter(|study| study.drawn.is_some());
        let names: Vec<&str> = with.map(|study| study.name).collect();
        return Err(CommandError::Numbers {
            message: format!("{} is not on machines drawn at random", study.name),
            help: format!("--seed and --machines are of {}", names.join(", ")),
        });
    }
    Ok(Some(machines))
}

/// A record that is given, of a study that compares with one.
fn recorded<'a>(
    study: &Study,
    args: &'a StudyArgs,
) -> Result<Option<(OnRecord, &'a Path)>, CommandError> {
    let Some(file) = &args.record else {
        return Ok(None);
    };
    let on_record = study.on_record.ok_or_else(|| {
        let with = STUDIES.iter().filter(|study| study.on_record.is_some());
        let names: Vec<&str> = with.map(|study| study.name).collect();
        CommandError::Numbers {
            message: format!("{} does not compare with a measured record", study.name),
            help: format!("--record is of {}", names.join(", ")),
        }
    })?;
    Ok(Some((on_record, file)))
}

fn strictly(strict: bool, report: &Report) -> Result<(), CommandError> {
    let broken: Vec<String> = (report.claims.iter())
        .filter(|claim| strict && !claim.holds)
        .map(|c| format!("{}: {}, not {}", c.name, c.measured, c.bound()))
        .collect();
    if broken.is_empty() {
        Ok(())
    } else {
        Err(CommandError::Claims(broken))
    }
}

fn failed(name: &'static str, error: StudyError) -> CommandError {
    let error = match error.downcast::<TargetError>() {
        Ok(target) => return CommandError::Target(*target),
        Err(other) => other,
    };
    match error.downcast::<RecordError>() {
        Ok(record) => CommandError::Numbers {
            message: record.message,
            help: record.help,
        },
        Err(other) => CommandError::other(name, other),
    }
}
