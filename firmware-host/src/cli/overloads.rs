//! `overloads`: the catalogue of overloads, and what it says of the supervisor's promises.

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::load;
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use comfy_table::Cell;
use firmware_bench::report::table::{lined, right};
use firmware_studies::overloads::histories::{CASES, Way, compare};
use firmware_studies::overloads::page::{self, GROUP_COLUMNS, SCENE_COLUMNS, scene_rows};
use firmware_studies::overloads::plan::{Catalogue, CatalogueError, Extent, Plan, search};
use firmware_studies::overloads::plants::RATES_HZ;
use firmware_studies::overloads::results::ResultRow;
use std::path::PathBuf;

/// Arguments of `overloads`.
#[derive(Debug, Clone, clap::Args)]
pub struct OverloadsArgs {
    /// Folder for overloads.json, overloads.md and a page for each scene.
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
    /// Instead of the catalogue: search force histories that were laid down beforehand against the reference,
    /// and write them to histories.json in the folder; takes minutes.
    #[arg(long, conflicts_with_all = ["json", "quick", "scene", "search"])]
    pub histories: bool,
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
    if args.histories {
        return against_histories(args);
    }
    let extent = if args.quick {
        Extent::Quick
    } else {
        Extent::Full
    };
    let plan = Plan::new(extent, own).map_err(failed)?;
    let progress = LateProgress::new(plan.pieces(), "the catalogue");
    let catalogue = args
        .threads
        .pool()?
        .install(|| plan.run(&|done| progress.add(done)))
        .map_err(failed)?;
    progress.finish();
    // A hundred thousand runs: not indented.
    let json = serde_json::to_string(&catalogue)
        .map_err(|e| CommandError::other("formatting overloads.json", e))?;
    let staging = Staging::for_folder(&args.out)?;
    let mut files = vec![
        ("overloads.json".to_owned(), json.clone()),
        (
            "overloads.md".to_owned(),
            page::summary(&catalogue, extent, &args.scene),
        ),
    ];
    files.extend(page::scenes(&catalogue));
    for (name, text) in &files {
        staging.write(name, text)?;
    }
    let out = staging.publish()?;
    if args.json {
        return print(&format!("{json}\n"));
    }
    let page = out.join("overloads.md");
    print(&format!(
        "{}\n{}{}page: {}\n",
        promises(&catalogue),
        harm(&catalogue),
        own_scenes(&catalogue),
        page.display()
    ))
}

fn search_anew(args: &OverloadsArgs) -> Result<(), CommandError> {
    let plants = firmware_studies::overloads::plants::plants(RATES_HZ[0])?.len();
    let progress = LateProgress::new((plants * RATES_HZ.len()) as u64, "the search");
    let rows = args
        .threads
        .pool()?
        .install(|| search(&|done| progress.add(done)))
        .map_err(failed)?;
    progress.finish();
    let json = pretty(&rows, "formatting found.json")?;
    let staging = Staging::for_folder(&args.out)?;
    staging.write("found.json", format!("{json}\n"))?;
    let out = staging.publish()?;
    print(&format!("found: {}\n", out.join("found.json").display()))
}

fn against_histories(args: &OverloadsArgs) -> Result<(), CommandError> {
    let progress = LateProgress::new((CASES.len() * Way::ALL.len()) as u64, "the searches");
    let rows = args
        .threads
        .pool()?
        .install(|| compare(&|done| progress.add(done)))
        .map_err(failed)?;
    progress.finish();
    let json = serde_json::to_string(&rows)
        .map_err(|e| CommandError::other("formatting histories.json", e))?;
    let staging = Staging::for_folder(&args.out)?;
    staging.write("histories.json", format!("{json}\n"))?;
    let out = staging.publish()?;
    let mut table = lined([
        "impact",
        "clairvoyant",
        "from nothing",
        "from clairvoyant",
        "on top",
        "best/clairvoyant",
        "runs",
    ]);
    for row in &rows {
        let mut cells = vec![
            format!("{}, {:+.0}°", row.plant, row.angle_deg),
            format!("{:.3}", row.clairvoyant_m_s),
        ];
        cells.extend((row.searched.iter()).map(|s| format!("{:.3}", s.impact_m_s)));
        cells.push(format!("{:.3}", row.best_over_clairvoyant()));
        cells.push((row.searched.iter().map(|s| s.runs).sum::<u64>()).to_string());
        table.add_row(cells);
    }
    let path = out.join("histories.json");
    print(&format!(
        "{table}\nspeeds in m/s; histories: {}\n",
        path.display()
    ))
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

/// The scenes that the user has added.
fn own_scenes(catalogue: &Catalogue) -> String {
    let one = |(name, results): (&str, Vec<&ResultRow>)| {
        let mut table = lined(SCENE_COLUMNS);
        for [plant, rate, policy, recovered, outcomes, figures @ ..] in scene_rows(&results) {
            let words = [plant, rate, policy, recovered, outcomes].map(Cell::new);
            table.add_row(words.into_iter().chain(figures.map(right)));
        }
        format!("\n{name}\n{table}\n")
    };
    page::own_scenes(catalogue).into_iter().map(one).collect()
}

/// Where it does harm.
fn harm(catalogue: &Catalogue) -> String {
    let groups = page::groups(&catalogue.against_levitation);
    let harmed: Vec<_> = groups.iter().filter(|group| group.is_harmed()).collect();
    if harmed.is_empty() {
        return String::new();
    }
    let mut table = lined(GROUP_COLUMNS);
    for group in harmed {
        let [name, figures @ ..] = group.cells();
        table.add_row([Cell::new(name)].into_iter().chain(figures.map(right)));
    }
    format!(
        "\nLargest contact force over levitation alone, by groups with a median above 1.1 or recoveries lost beyond chance\n\
         {table}\nwhy: docs/src/host/overloads-explained.md\n"
    )
}

fn promises(catalogue: &Catalogue) -> String {
    let mut table = lined(["promise", "bound", "measured", "holds"]);
    for p in &catalogue.promises {
        table.add_row([
            Cell::new(&p.name),
            right(p.bound()),
            right(format!("{:.3}", p.measured)),
            Cell::new(if p.holds { "yes" } else { "NO" }),
        ]);
    }
    let kept = catalogue.promises.iter().filter(|p| p.holds).count();
    let runs = catalogue.results.len();
    let untrusted = catalogue
        .results
        .iter()
        .filter(|r| r.error.is_some())
        .count();
    format!(
        "{table}\n{kept} of {} promises hold; {runs} runs, {untrusted} of them not to be trusted",
        catalogue.promises.len()
    )
}
