//! `review`: a flight record from a machine, for a person who asks what happened.

mod again;
mod findings;
mod page;
mod planes;
mod tables;
mod text;

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::screen::print_wrapped;
use again::Again;
use firmware_bench::log_file::{LogError, LogFile, Renamed};
use firmware_bench::record::Contact;
use firmware_bench::record::file::RecordFile;
use firmware_bench::record::identify::{Findings, Identified};
use firmware_bench::record::narrative::{Event, Narrative};
use firmware_bench::record::remaining::{Remaining, ledgers};
use firmware_bench::record::replay::Replay;
use firmware_bench::record::shapes::Shapes;
use firmware_bench::record::ticks::Ticks;
use firmware_bench::record::unknown::Unknown;
use firmware_bench::report::table;
use firmware_bench::run::log_watch::{LogSummary, WatchError, watch};
use firmware_bench::scene::spec::{Setting, Spec};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use tables::csv;
use text::text;

/// Arguments of `review`.
#[derive(Debug, Clone, clap::Args)]
pub struct ReviewArgs {
    /// The sections of one or more records, one after the other, as firmware has written them. Or a log of a machine, as .csv,
    /// .parquet, .mat or .mcap, which the supervisor of --scene watches: t_s, measured_x_m, measured_y_m, where there
    /// commanded_x_n, commanded_y_n, delivered_x_n, delivered_y_n, spin_rad_s; of several planes PLANE.measured_x_m and so on.
    pub file: PathBuf,
    /// A column of a log that has another name, and perhaps another unit, e.g. measured_x_m=x1_um*1e-6.
    #[arg(long, value_name = "NAME=COLUMN[*FACTOR]", requires = "scene")]
    pub column: Vec<Renamed>,
    /// Ledger of the retainer bearing as firmware has written it, of each plane one after the other: how many landings it may
    /// still bear.
    #[arg(long, value_name = "FILE")]
    pub ledger: Option<PathBuf>,
    /// Severity that the retainer bearing may bear in all, in place of what the scene has as retainer.severity_allowed, the ledger,
    /// or without these severity_limit.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub allowance: Option<f32>,
    /// Scene of the machine: the event is simulated on it, with what the record tells, under levitation alone, passively and
    /// under the supervisor; and it may say what its retainer bearings may bear.
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// A key of the scene with another value, e.g. supervisor.hold_share=0.5: the supervisor once more with it.
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    pub set: Vec<Setting>,
    /// Print every tick as CSV instead of tables.
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// Print JSON instead of tables.
    #[arg(long)]
    pub json: bool,
    /// Folder for report.html, the recorded ticks as a page, beside what is printed.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Folder for the figures of that page, each as a drawing of its own (SVG), as for a document.
    #[arg(long, value_name = "FOLDER")]
    pub figures: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &ReviewArgs) -> Result<(), CommandError> {
    let name = args.file.display();
    let mut spec = args.scene.as_deref().map(Spec::load).transpose()?;
    let (bytes, log) = match &mut spec {
        Some(spec) if LogFile::is_at(&args.file) => {
            let watched =
                watch(spec, &args.file, &args.column).map_err(|e| not_watched(args, e))?;
            (watched.records, Some(watched.summary))
        }
        None if LogFile::is_at(&args.file) => {
            return Err(CommandError::Numbers {
                message: format!("{name}: a log, and no scene of its machine"),
                help: "give the scene with --scene: clearance, mass and magnet are not in a log"
                    .to_owned(),
            });
        }
        _ if !args.column.is_empty() => {
            return Err(CommandError::Numbers {
                message: format!("{name}: --column is of a log, and this is none by its ending"),
                help: "give a log as .csv, .parquet, .mat or .mcap, or leave --column out"
                    .to_owned(),
            });
        }
        _ => {
            let read = std::fs::read(&args.file).map_err(|e| CommandError::Numbers {
                message: format!("{name}: {e}"),
                help: "give the file that the record was written to".to_owned(),
            })?;
            (read, None)
        }
    };
    let asked = Asked { args, spec, log };
    if bytes.is_empty() && asked.log.is_some() {
        return of_sections(&asked, &RecordFile::default());
    }
    let file = RecordFile::of(&bytes);
    if file.records.is_empty() {
        let damage: Vec<String> = file.damage.iter().map(ToString::to_string).collect();
        return Err(CommandError::Numbers {
            message: format!("{name}: {}", damage.join("; ")),
            help: "write the sections of a frozen record one after the other, and nothing else"
                .to_owned(),
        });
    }
    of_sections(&asked, &file)
}

fn not_watched(args: &ReviewArgs, error: WatchError) -> CommandError {
    match error {
        WatchError::Scene(error) => error.into(),
        WatchError::Log(LogError { message, help }) => CommandError::Numbers {
            help: match message.starts_with("no column") {
                true => format!("{help}: --column measured_x_m=NAME*FACTOR"),
                false => help,
            },
            message: format!("{}: {message}", args.file.display()),
        },
    }
}

/// What is asked: the arguments, the scene with what was set in it, and what a log tells of itself.
struct Asked<'a> {
    args: &'a ReviewArgs,
    spec: Option<Spec>,
    log: Option<LogSummary>,
}

/// An event for programs.
#[derive(Serialize)]
struct Reviewed {
    summary: Option<Narrative>,
    replay: Option<Replay>,
    /// Why there is no replay.
    no_replay: Option<String>,
    /// Number that the firmware has, and its clock.
    firmware: u32,
    time_us: u64,
    at_sequence: u32,
    /// Events before this one that found a record frozen, and are in none.
    dropped: u32,
    /// How both planes of a rotor moved while one of them bounced or whirled; null for one plane.
    shapes: Option<Shapes>,
    /// What the event tells of the machine; null where nothing can be found out.
    identified: Option<Identified>,
    /// Contacts that were found, times in ticks from the sequence number `contacts_from` on.
    contacts: Vec<Contact>,
    contacts_from: Option<u32>,
    /// The event once more on a scene's machine, as `run` has it.
    simulated: Option<serde_json::Value>,
    /// Parameters of the supervisor that the scene gives other values than the record has.
    configured_otherwise: Vec<&'static str>,
    /// Ticks of each plane.
    planes: Vec<Plane>,
}

/// A plane for programs.
#[derive(Serialize)]
struct Plane {
    #[serde(flatten)]
    ticks: Ticks,
    /// Where the position is unknown, and why.
    unknown: Vec<Unknown>,
}

/// A file for programs: its first event, and the others.
#[derive(Serialize)]
struct Review<'a> {
    intact: bool,
    /// Of a log what it is; null of a record.
    log: Option<&'a LogSummary>,
    format: u32,
    error: Option<String>,
    #[serde(flatten)]
    first: Option<Reviewed>,
    others: Vec<Reviewed>,
    /// Retainer bearings after the last event, and how many landings they may still bear.
    bearings: Vec<Remaining>,
}

/// An event with what is found out from it.
struct Examined<'a> {
    event: Event<'a>,
    /// Whether the record is of a log, by this very build: what it would do is no finding.
    of_log: bool,
    shapes: Option<Shapes>,
    findings: Option<Findings>,
    again: Option<Again>,
}

fn examined<'a>(asked: &Asked<'_>, event: Event<'a>) -> Result<Examined<'a>, CommandError> {
    let findings = event.findings();
    let scene = asked.args.scene.as_deref().zip(asked.spec.as_ref());
    let again = match (scene, &findings) {
        (Some(scene), Some(findings)) => {
            Some(again::simulate(scene, &asked.args.set, (&event, findings))?)
        }
        _ => None,
    };
    Ok(Examined {
        shapes: Shapes::of(&event.records),
        of_log: asked.log.is_some(),
        event,
        findings,
        again,
    })
}

fn reviewed(of: &Examined<'_>) -> Reviewed {
    let (event, head) = (&of.event, of.event.records[0].head);
    let findings = of.findings.as_ref();
    let again = of.again.as_ref();
    Reviewed {
        summary: event.narrative(),
        replay: event.replay.ok(),
        no_replay: event.replay.err().map(|why| why.to_string()),
        firmware: head.firmware,
        time_us: head.time_us,
        at_sequence: head.at_sequence,
        dropped: head.dropped,
        shapes: of.shapes,
        identified: findings.map(|f| f.identified),
        contacts: findings.map_or_else(Vec::new, |f| f.contacts.clone()),
        contacts_from: findings.map(|f| f.first),
        simulated: again.map(|again| table::json(&again.scene, &again.results)),
        configured_otherwise: again.map_or_else(Vec::new, |again| again.differing.clone()),
        planes: (event.records.iter().zip(&event.unknown))
            .map(|(record, unknown)| Plane {
                ticks: Ticks::of(record),
                unknown: unknown.clone(),
            })
            .collect(),
    }
}

/// Retainer bearings after the last event of a file.
fn remaining(asked: &Asked<'_>, events: &[Examined<'_>]) -> Result<Vec<Remaining>, CommandError> {
    let args = asked.args;
    if let Some(allowed) = args.allowance
        && !(allowed > 0.0 && allowed.is_finite())
    {
        return Err(CommandError::Numbers {
            message: format!("--allowance {allowed}: expected a severity above 0"),
            help: "give the number of landings that the bearing's maker allows, times the severity of one of them".to_owned(),
        });
    }
    let Some(Examined { event, .. }) = events.last() else {
        return Ok(Vec::new());
    };
    let kept = match &args.ledger {
        None => Vec::new(),
        Some(file) => {
            let name = file.display();
            let planes = event.records[0].head.planes as usize;
            let wrong = |message: String, help: &str| CommandError::Numbers {
                message: format!("{name}: {message}"),
                help: help.to_owned(),
            };
            let bytes = std::fs::read(file).map_err(|e| {
                wrong(
                    e.to_string(),
                    "give the file that the ledger was written to",
                )
            })?;
            ledgers(&bytes, planes).map_err(|e| {
                wrong(
                    e.to_string(),
                    "take the ledger from the firmware once more, or its other copy; without --ledger the record alone is reviewed",
                )
            })?
        }
    };
    let planes = event.records[0].head.planes as usize;
    let allowed = match (args.allowance, &asked.spec) {
        (Some(allowed), _) => vec![Some(allowed); planes],
        (None, Some(spec)) => again::allowances(spec, &args.set)?,
        (None, None) => Vec::new(),
    };
    Ok(Remaining::of(event, &kept, &allowed))
}

/// What is whole is shown; that something is not is an error all the same.
fn of_sections(asked: &Asked<'_>, file: &RecordFile) -> Result<(), CommandError> {
    let args = asked.args;
    let mut of_file = file.events();
    if let Some(last) = of_file.last_mut() {
        let cut = asked.log.as_ref().and_then(|log| log.events.last());
        last.log_ends = cut.is_some_and(|event| event.to_s.is_none());
    }
    let events: Result<Vec<Examined<'_>>, CommandError> = (of_file.into_iter())
        .map(|event| examined(asked, event))
        .collect();
    let events = events?;
    let bearings = remaining(asked, &events)?;
    let damage: Vec<String> = file.damage.iter().map(ToString::to_string).collect();
    let error = (!file.is_intact()).then(|| damage.join("; "));
    if let Some(out) = &args.out {
        let name = args.file.display().to_string();
        let log = asked.log.as_ref().map(LogSummary::sentences);
        let head = page::head(&name, (&events, &bearings), (&damage, log));
        let parts = text::parts(&events, args.scene.is_some());
        page::write(out, (&head, &parts), &page::tracks(&events))?;
    }
    if let Some(folder) = &args.figures {
        page::write_figures(folder, &page::tracks(&events))?;
    }
    if args.json {
        let mut all = events.iter().map(reviewed);
        let review = Review {
            intact: file.is_intact(),
            log: asked.log.as_ref(),
            format: 3,
            error: error.clone(),
            first: all.next(),
            others: all.collect(),
            bearings,
        };
        print(&(pretty(&review, "writing JSON")? + "\n"))?;
    } else if args.csv {
        let mut out = String::new();
        for (number, of) in events.iter().enumerate() {
            for record in &of.event.records {
                let ticks = csv(&Ticks::of(record));
                let mut lines = ticks.lines();
                let head = lines.next().unwrap_or_default();
                if out.is_empty() {
                    let _ = writeln!(out, "event,plane,{head}");
                }
                for line in lines {
                    let _ = writeln!(out, "{number},{},{line}", record.head.plane);
                }
            }
        }
        print(&out)?;
    } else {
        let damaged = text::damaged(&damage).map(|sentence| sentence + "\n");
        let text = (events.iter().enumerate())
            .map(|(i, of)| text(of, args.scene.is_some(), of_event(&bearings, i, &events)));
        let log = asked.log.as_ref().map(|log| log.sentences() + "\n");
        let texts: Vec<String> = log.into_iter().chain(damaged).chain(text).collect();
        print_wrapped(&texts.join("\n"))?;
    }
    match error {
        None => Ok(()),
        Some(error) => Err(CommandError::Numbers {
            message: format!("{}: {error}", args.file.display()),
            help: "what is shown was written so; take the rest from the firmware once more, if it still has it".to_owned(),
        }),
    }
}

/// Bearings to report with an event: with the last one alone, after which they are as their ledgers say.
fn of_event<'a>(
    bearings: &'a [Remaining],
    event: usize,
    events: &[Examined<'_>],
) -> &'a [Remaining] {
    if event + 1 == events.len() {
        bearings
    } else {
        &[]
    }
}

/// The largest share of what a bearing may bear that is used up.
fn used(bearings: &[Remaining]) -> f64 {
    bearings.iter().map(Remaining::used).fold(0.0, f64::max)
}
