//! `sensitivity SCENE.toml`: how well the supervisor has to know its machine.

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::load;
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_bench::report::lines::{Cell, lined, right};
use firmware_bench::report::table::shown;
use firmware_bench::run::figures::{Figure, Figures, TableLevel};
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::{PlaneScene, Scene};
use firmware_studies::campaign::{Progress, each};
use firmware_studies::sensitivity::{Row, configured_right, misjudged};
use std::path::PathBuf;

/// Arguments of `sensitivity`.
#[derive(Debug, Clone, clap::Args)]
pub struct SensitivityArgs {
    /// Scene file with a magnet and a levitation controller.
    pub scene: PathBuf,
    /// Errors so many times as wide as usual: the exponent of factors, a factor of ticks.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true, value_name = "NUMBER", value_parser = width)]
    pub width: f64,
    /// How often all data are wrong at once, each somewhere between its two errors.
    #[arg(long, default_value_t = 8, allow_negative_numbers = true, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub draws: u32,
    /// Print JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// Wider than this no datum is called known.
fn width(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(width) if (0.1..=4.0).contains(&width) => Ok(width),
        _ => Err("expected a number from 0.1 to 4".to_owned()),
    }
}

/// Runs the scene with levitation alone, with the supervisor, and with the supervisor configured wrong.
///
/// # Errors
/// [`CommandError`] for a scene that has nothing to supervise.
pub fn execute(args: &SensitivityArgs) -> Result<(), CommandError> {
    let scene = load(&args.scene)?;
    let of_planes = |has: fn(&PlaneScene) -> bool| scene.planes.iter().any(has);
    for (there, table) in [
        (of_planes(|plane| plane.magnet.is_some()), "[magnet]"),
        (
            scene.levitation.is_some() || of_planes(|plane| plane.levitation.is_some()),
            "[levitation]",
        ),
    ] {
        if !there {
            return Err(CommandError::Numbers {
                message: format!("{} has no {table}", args.scene.display()),
                help: format!("add {table}: without it there is nothing to supervise"),
            });
        }
    }
    let rows = rows(&scene, args)?;
    if !args.json {
        return print_wrapped(&text(&scene, &rows));
    }
    let value = serde_json::json!({
        "scene": scene.title,
        "width": args.width,
        "rows": rows,
    });
    print(&(pretty(&value, "formatting the rows")? + "\n"))
}

fn rows(scene: &Scene, args: &SensitivityArgs) -> Result<Vec<Row>, CommandError> {
    let configured = configured_right(scene).map_err(|e| CommandError::Numbers {
        message: format!("{}: the supervisor derives {e}", args.scene.display()),
        help: e.parameter().text.to_owned(),
    })?;
    let wrong = misjudged(args.width, args.draws, scene.planes[0].seed);
    let progress = LateProgress::new(wrong.len() as u64, "runs");
    let one = |misjudged: &_| {
        let row = Row::of_misjudged(misjudged, scene);
        progress.add(1);
        row
    };
    let rows = args.threads.pool()?.install(|| {
        let mut rows = vec![
            Row::of("levitation alone", scene, PolicyKind::Levitation),
            Row::of("right", &configured, PolicyKind::Supervisor),
        ];
        let wrong: Vec<Option<Row>> = each(&wrong, one);
        rows.extend(wrong.into_iter().flatten());
        rows
    });
    progress.finish();
    Ok(rows)
}

fn text(scene: &Scene, rows: &[Row]) -> String {
    let columns = || (Figures::ALL.iter()).filter(|figure| figure.place == TableLevel::Everywhere);
    let mut header = vec![Cell::new("configured"), right("engaged")];
    header.extend(columns().map(Figure::title).map(right));
    let mut table = lined(header);
    // Levitation alone is the first of the rows.
    let mut shown_rows: Vec<&Row> = rows.iter().collect();
    if let [alone, supervisor, ..] = &mut shown_rows[..] {
        std::mem::swap(alone, supervisor);
    }
    for row in shown_rows {
        let mut cells = vec![Cell::new(&row.configured)];
        match (&row.metrics, &row.error) {
            (Some(figures), _) => {
                cells.push(right(row.engagements));
                cells.extend(columns().map(|figure| right(shown(figure, figures))));
            }
            (None, error) => cells.push(right(error.as_deref().unwrap_or_default())),
        }
        table.add_row(cells);
    }
    let wrong = rows.get(2..).unwrap_or_default();
    let recovered = wrong.iter().filter(|row| row.recovered()).count();
    format!(
        "{}\n{table}\nTold wrong it recovers in {recovered} of {} runs. Wider errors: --width 2.\n",
        scene.title,
        wrong.len()
    )
}
