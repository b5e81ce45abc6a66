//! `accuracy [SCENE]`: error against run time, and silently wrong runs, as tables, JSON and a page.

use crate::cli::chapters;
use crate::cli::error::{CommandError, pretty, print, say};
use crate::cli::load;
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_studies::accuracy::study::{
    WrongRuns, benchmarks, chapters as chapters_of, measure, page,
};
use firmware_studies::campaign::html;
use std::path::PathBuf;

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
    /// Folder for accuracy.json and accuracy.html; without it nothing is written.
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

impl From<When> for WrongRuns {
    fn from(when: When) -> Self {
        match when {
            When::Auto => Self::Auto,
            When::Always => Self::Always,
            When::Never => Self::Never,
        }
    }
}

/// Sweeps tolerances, methods and starts.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &AccuracyArgs) -> Result<(), CommandError> {
    let scenes = match args.scenes.as_slice() {
        [] => benchmarks()?,
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
    let progress = LateProgress::default();
    let found = (args.threads.pool()?)
        .install(|| measure(&scenes, args.wrong_runs.into(), &progress))
        .map_err(|e| CommandError::other("accuracy", e))?;
    progress.finish();
    for reference in found.references.iter().filter(|r| !r.confirmed) {
        say(format_args!("warning: {}", reference.in_words()));
    }
    let json = pretty(&found, "formatting accuracy.json")?;
    if let Some(out) = &args.out {
        let staging = Staging::for_folder(out)?;
        let page =
            html(&page(&found)).map_err(|e| CommandError::other("drawing accuracy.html", e))?;
        staging.write("accuracy.json", &json)?;
        staging.write("accuracy.html", page)?;
        staging.publish()?;
    }
    if args.json {
        print(&(json + "\n"))
    } else {
        print_wrapped(&chapters::text(&chapters_of(&found)))
    }
}
