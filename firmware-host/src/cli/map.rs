//! `map SCENE.toml --x KEY=FROM..TO --y KEY=FROM..TO`: which impact a rotor bears, over two of its keys.

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::output::Staging;
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_bench::run::columns::{Cell, Column, Kind};
use firmware_bench::scene::spec::{Setting, Spec};
use firmware_bench::sweep::table::{Rows, written};
use firmware_studies::campaign::html;
use firmware_studies::map::{MOST_CELLS, Map, MapError, MapPlan, PERCENTILES, Spread, Varied};

use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `map`.
#[derive(Debug, Clone, clap::Args)]
pub struct MapArgs {
    /// Scene file of a point mass in one plane, e.g. firmware-host/scenes/impact_at_40_hz.toml.
    pub scene: PathBuf,
    /// Key along the horizontal axis with its range, as friction.coefficient=0.05..0.6; impact.inclination_deg is that of the impact.
    #[arg(long, value_name = "KEY=FROM..TO")]
    pub x: Varied,
    /// The same along the vertical axis.
    #[arg(long, value_name = "KEY=FROM..TO")]
    pub y: Varied,
    /// What the map shows: v_crit is the lowest speed of an impact, left to itself, that ends in backward whirl; p5, p50 and p95 are
    /// percentiles of it, with --spread [default: v_crit, or p5 with --spread].
    #[arg(long, value_name = "WHAT", value_parser = ["v_crit", "p5", "p50", "p95"])]
    pub of: Option<String>,
    /// A key that is known within limits only, as contact.stiffness_n_m=1e8..4e8, every value between them as likely; any number of
    /// times.
    #[arg(long, value_name = "KEY=FROM..TO")]
    pub spread: Vec<Varied>,
    /// Draws of each cell with --spread.
    #[arg(long, value_name = "NUMBER", default_value_t = 64, value_parser = clap::value_parser!(u32).range(20..=10_000))]
    pub draws: u32,
    /// Cells along both axes.
    #[arg(long, value_name = "COLUMNSxROWS", default_value = "100x100", value_parser = cells)]
    pub cells: Cells,
    /// Hold the spin, as in the paper's maps; ten times as fast.
    #[arg(long)]
    pub held_spin: bool,
    /// Put a value in the place of the scene's, as contact.restitution=0.8; any number of times.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Setting>,
    /// Folder for map.parquet and map.html [default: runs/, the name of the scene file and _map].
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Print what was done as JSON.
    #[arg(long)]
    pub json: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// Columns and rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cells([usize; 2]);

fn cells(text: &str) -> Result<Cells, String> {
    let both = text.split_once('x').and_then(|(columns, rows)| {
        Some([columns.parse::<usize>().ok()?, rows.parse::<usize>().ok()?])
    });
    let all = |[columns, rows]: [usize; 2]| columns.checked_mul(rows);
    both.filter(|both| all(*both).is_some_and(|all| (1..=MOST_CELLS).contains(&all)))
        .map(Cells)
        .ok_or_else(|| format!("expected columns and rows, as 200x200, {MOST_CELLS} cells at most"))
}

/// What was done, for programs.
#[derive(Debug, Serialize)]
struct Done {
    cells: usize,
    seconds: f64,
    /// Impacts that were run, and those of them side by side.
    runs: u64,
    lanes: u64,
    /// Those that were not decided in the time they had, and count as borne.
    undecided: u64,
    /// What of the scene is not in an impact that is left to itself.
    left_out: Vec<&'static str>,
    /// Of so many cells that were run one by one, too: those that came to the same speed.
    checked: usize,
    equal_to_scalar: usize,
    lowest_m_s: Option<f64>,
    highest_m_s: Option<f64>,
    results: PathBuf,
    page: PathBuf,
}

/// Runs the map and writes it.
///
/// # Errors
/// [`CommandError`]; nothing is left behind then.
pub fn execute(args: &MapArgs) -> Result<(), CommandError> {
    let started = Instant::now();
    let mut spec = Spec::load(&args.scene)?;
    let set = (args.set.iter()).map(|setting| (setting.path.as_str(), setting.value.clone()));
    spec.set_all(&set.collect::<Vec<_>>())?;
    let out = args.out.clone().unwrap_or_else(|| {
        let name = args.scene.file_stem().unwrap_or(args.scene.as_os_str());
        Path::new("runs").join(format!("{}_map", name.to_string_lossy()))
    });
    let spread = spread(args)?;
    let staging = Staging::for_folder(&out)?;
    let plan = MapPlan {
        x: args.x.clone(),
        y: args.y.clone(),
        cells: args.cells.0,
        spread,
        held_spin: args.held_spin,
    };
    let bar = LateProgress::default();
    let map = (args.threads.pool()?.install(|| plan.run(&spec, &bar))).map_err(refused)?;
    bar.finish();
    let file = args.scene.file_name().unwrap_or(args.scene.as_os_str());
    let page = html(&map.page(&file.to_string_lossy()))
        .map_err(|e| CommandError::other("drawing map.html", e))?;
    staging.write("map.html", &page)?;
    let rows = written(&rows(&map)).map_err(|e| CommandError::other("writing map.parquet", e))?;
    staging.write("map.parquet", &rows)?;
    let folder = staging.publish()?;
    let range = map.range_m_s();
    let done = Done {
        cells: map.cells.len(),
        seconds: started.elapsed().as_secs_f64(),
        runs: map.tried.impacts,
        lanes: map.tried.by_lanes,
        undecided: map.tried.undecided,
        left_out: map.left_out.clone(),
        checked: map.checked[0],
        equal_to_scalar: map.checked[1],
        lowest_m_s: range.map(|(low, _)| low),
        highest_m_s: range.map(|(_, high)| high),
        results: folder.join("map.parquet"),
        page: folder.join("map.html"),
    };
    if args.json {
        return print(&(pretty(&done, "formatting what was done")? + "\n"));
    }
    print_wrapped(&format!(
        "{}: {}\n{} cells, {} impacts, {} of them side by side, in {:.1} s; {} of {} critical speeds found one by one were the same.\npage: {}\n",
        args.scene.display(),
        [Some(map.headline()), map.doubts()]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("\n"),
        done.cells,
        done.runs,
        done.lanes,
        done.seconds,
        done.equal_to_scalar,
        done.checked,
        done.page.display()
    ))
}

/// What is known within limits only.
fn spread(args: &MapArgs) -> Result<Option<Spread>, CommandError> {
    /// Keys at most.
    const MOST_KEYS: usize = 32;
    let refused = |message: String, help: &str| {
        let help = help.to_owned();
        Err(CommandError::Numbers { message, help })
    };
    let percentile = args.of.as_deref().and_then(|of| of.strip_prefix('p'));
    let shown = percentile.and_then(|of| PERCENTILES.iter().position(|p| p.to_string() == of));
    if args.spread.is_empty() {
        return match shown {
            None => Ok(None),
            Some(_) => refused(
                "--of is a percentile, and nothing is spread".to_owned(),
                "say what is known within limits only, as --spread contact.stiffness_n_m=1e8..4e8",
            ),
        };
    }
    if args.of.is_some() && shown.is_none() {
        return refused(
            "--of v_crit is of a rotor that is known, and --spread of one that is not".to_owned(),
            "give p5, p50 or p95",
        );
    }
    let draws = args.draws as usize;
    let [columns, rows] = args.cells.0;
    if columns * rows > MOST_CELLS / draws {
        return refused(
            format!(
                "{columns} x {rows} cells are {} critical speeds with {draws} draws each",
                columns * rows * draws
            ),
            &format!("give fewer --cells or --draws, {MOST_CELLS} critical speeds at most"),
        );
    }
    if args.spread.len() > MOST_KEYS {
        return refused(
            format!("{} keys are spread", args.spread.len()),
            &format!("give {MOST_KEYS} at most"),
        );
    }
    Ok(Some(Spread {
        keys: args.spread.clone(),
        draws,
        shown: shown.unwrap_or(0),
    }))
}

fn refused(error: MapError) -> CommandError {
    let message = error.to_string();
    let help = match error {
        MapError::Scene(error) => return error.into(),
        MapError::Run { .. } => return CommandError::other("running the map", error),
        MapError::Twice(_) => "give it once, along x, along y or as a spread",
        MapError::Idle(_) => "vary what shaft, spin, wall, friction and unbalance are",
        MapError::Inclination => "give a range within these limits",
        MapError::NotOfOnePlane(_) => "give a scene without [[plane]], inertias and [[shaft]]",
    };
    let help = help.to_owned();
    CommandError::Numbers { message, help }
}

/// A row a cell.
fn rows(map: &Map) -> Rows {
    let keys = [map.plan.x.key.clone(), map.plan.y.key.clone()];
    let columns = (keys.into_iter().chain(map.plan.columns())).map(|name| Column {
        name,
        kind: Kind::Number,
    });
    let mut rows = Rows::new(columns.collect());
    for cell in &map.cells {
        let place = [Some(cell.x), Some(cell.y)].into_iter();
        rows.push(
            place
                .chain(cell.critical_m_s.iter().copied())
                .map(Cell::Number)
                .collect(),
        );
    }
    rows
}
