//! `overloads`: the catalogue of overloads, and what it says of the supervisor's promises.

use crate::cli::chapters;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::load;
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_studies::campaign::{Extent, html};
use firmware_studies::overloads::page;
use firmware_studies::overloads::plan::{Catalogue, CatalogueError, Plan, search};
use firmware_studies::whole_rotors::reference::search_laws;
use std::borrow::Cow;
use std::path::PathBuf;

/// Arguments of `overloads`.
#[derive(Debug, Clone, clap::Args)]
pub struct OverloadsArgs {
    /// Folder for overloads.json and overloads.html.
    #[arg(long, default_value = "runs/overloads")]
    pub out: PathBuf,
    /// Print promises and results as JSON instead of the table of promises.
    #[arg(long)]
    pub json: bool,
    /// One control rate, one cap for P1, three seeds.
    #[arg(long)]
    pub quick: bool,
    /// A scene of your own, run under its policies with every seed and added to the results. May be repeated.
    #[arg(long, value_name = "FILE")]
    pub scene: Vec<PathBuf>,
    /// Instead of the catalogue: search the baselines' gains and the reference's weights anew, and write
    /// them to found.json in the folder.
    #[arg(long, conflicts_with_all = ["json", "quick", "scene"])]
    pub search: bool,
    /// With --search: search the reference's weights on the whole rotors P5 to P8 instead, and write them to
    /// found_rotors.json in the folder.
    #[arg(long, requires = "search")]
    pub rotors: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// Runs the catalogue.
///
/// # Errors
/// [`CommandError`]; nothing is left behind then.
pub fn execute(args: &OverloadsArgs) -> Result<(), CommandError> {
    let own = (args.scene.iter())
        .map(|path| load(path))
        .collect::<Result<Vec<_>, _>>()?;
    output::probe(&args.out)?;
    if args.search {
        return search_anew(args);
    }
    let extent = Extent::new(args.quick);
    let plan = Plan::new(extent, own).map_err(failed)?;
    let progress = LateProgress::default();
    let catalogue = (args.threads.pool()?)
        .install(|| plan.run(&progress))
        .map_err(failed)?;
    progress.finish();
    // A hundred thousand runs: not indented.
    let json = serde_json::to_string(&catalogue)
        .map_err(|e| CommandError::other("formatting overloads.json", e))?;
    let page = html(&page::report(&catalogue, extent).page(&command(args)))
        .map_err(|e| CommandError::other("drawing overloads.html", e))?;
    let staging = Staging::for_folder(&args.out)?;
    for (name, content) in [("overloads.json", &json), ("overloads.html", &page)] {
        staging.write(name, content)?;
    }
    let out = staging.publish()?;
    if args.json {
        return print(&format!("{json}\n"));
    }
    let page = out.join("overloads.html");
    print_wrapped(&format!(
        "{}\n\n{}page: {}\n",
        promises(&catalogue),
        chapters::text(&page::in_brief(&catalogue)),
        page.display()
    ))
}

/// What repeats it, each file one argument of a shell.
fn command(args: &OverloadsArgs) -> String {
    let mut command = "overloads".to_owned();
    if args.quick {
        command += " --quick";
    }
    for file in &args.scene {
        let file = file.display().to_string();
        // Only a zero byte cannot be quoted, and no path has one.
        let quoted = shlex::try_quote(&file).map_or(file.clone(), Cow::into_owned);
        command += &format!(" --scene {quoted}");
    }
    command
}

fn search_anew(args: &OverloadsArgs) -> Result<(), CommandError> {
    let progress = LateProgress::default();
    let pool = args.threads.pool()?;
    let (name, json) = if args.rotors {
        let rows = pool.install(|| search_laws(&progress))?;
        let name = "found_rotors.json";
        (name, pretty(&rows, "formatting found_rotors.json")?)
    } else {
        let rows = pool.install(|| search(&progress)).map_err(failed)?;
        ("found.json", pretty(&rows, "formatting found.json")?)
    };
    progress.finish();
    let staging = Staging::for_folder(&args.out)?;
    staging.write(name, format!("{json}\n"))?;
    let out = staging.publish()?;
    print(&format!("found: {}\n", out.join(name).display()))
}

fn failed(error: CatalogueError) -> CommandError {
    match error {
        CatalogueError::Scene(error) => error.into(),
        twice @ CatalogueError::Title { .. } => CommandError::Numbers {
            message: twice.to_string(),
            help: "give each scene a title of its own".to_owned(),
        },
        other => CommandError::other("running the catalogue", other),
    }
}

fn promises(catalogue: &Catalogue) -> String {
    let runs = catalogue.results.len();
    let untrusted = (catalogue.results.iter())
        .filter(|r| r.error.is_some())
        .count();
    format!(
        "{}; {runs} runs, {untrusted} of them not to be trusted",
        chapters::of_claims(&catalogue.promises)
    )
}
