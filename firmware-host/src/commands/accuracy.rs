//! `accuracy SCENE.toml`: error against run time, as a table, JSON and a plot.

use crate::accuracy::{Accuracy, Row, sweep};
use crate::commands::error::{CommandError, print};
use crate::output::{self, OutputError, Staging};
use crate::plot;
use crate::scene::Scene;
use comfy_table::{Cell, CellAlignment, Table, presets};
use std::path::PathBuf;

/// Arguments of `accuracy`.
#[derive(Debug, Clone, clap::Args)]
pub struct AccuracyArgs {
    /// Scene file; its plant is run without control, from its start, with its disturbances.
    #[arg(default_value = "firmware-host/scenes/bouncing_into_rolling.toml")]
    pub scene: PathBuf,
    /// Print JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// Folder for accuracy.json and the plot accuracy.svg; without it nothing is written.
    #[arg(long)]
    pub out: Option<PathBuf>,
}

/// Sweeps tolerances and methods.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &AccuracyArgs) -> Result<(), CommandError> {
    let scene = Scene::load(&args.scene)?;
    if let Some(out) = &args.out {
        output::probe(out)?;
    }
    let accuracy = sweep(&scene).map_err(|e| CommandError::other("accuracy", e))?;
    let pretty = serde_json::to_string_pretty(&accuracy)
        .map_err(|e| CommandError::other("formatting accuracy.json", e))?;
    if let Some(out) = &args.out {
        let staging = Staging::beside(out)?;
        let svg = figure(&accuracy)?;
        for (name, text) in [("accuracy.json", &pretty), ("accuracy.svg", &svg)] {
            let path = staging.path(name);
            std::fs::write(&path, text).map_err(|reason| OutputError { path, reason })?;
        }
        staging.publish()?;
    }
    if args.json {
        print(&format!("{pretty}\n"))
    } else {
        print(&table(&scene, &accuracy))
    }
}

fn table(scene: &Scene, accuracy: &Accuracy) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header([
        "method",
        "rtol",
        "error [c]",
        "time [ms]",
        "steps",
        "evaluations",
        "mode changes",
    ]);
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    for row in &accuracy.rows {
        table.add_row([
            Cell::new(row.method),
            right(format!("{:.0e}", row.rtol)),
            right(format!("{:.1e}", row.error)),
            right(format!("{:.3}", row.seconds * 1e3)),
            right(row.steps.to_string()),
            right(row.evaluations.to_string()),
            right(row.mode_changes.to_string()),
        ]);
    }
    let agreement = if accuracy.references_agree {
        "the same"
    } else {
        "DIFFERENT"
    };
    format!(
        "{}: end position against a run at rtol 1e-13\n{table}\nthe other method at 1e-13 ends {:.1e} c away, with {agreement} mode changes\n",
        scene.title, accuracy.reference_uncertainty,
    )
}

fn figure(accuracy: &Accuracy) -> Result<String, CommandError> {
    let points = |method: &str| -> Vec<(f64, f64)> {
        // Below the references' distance an error means nothing; it is drawn there.
        let floor = accuracy.reference_uncertainty.max(1e-15);
        let of = |r: &&Row| r.method == method;
        let rows = accuracy.rows.iter().filter(of);
        rows.map(|r| (r.error.max(floor), r.seconds * 1e3))
            .collect()
    };
    let (series, explicit) = (points("series"), points("explicit"));
    let stiff = points("stiff");
    let lines = [
        plot::LogLine {
            name: "series",
            points: &series,
            colour: plot::TOUCHING,
        },
        plot::LogLine {
            name: "explicit pair 8(5,3)",
            points: &explicit,
            colour: plot::FREE,
        },
        plot::LogLine {
            name: "stiff pair 5(4)",
            points: &stiff,
            colour: plot::LIMIT,
        },
    ];
    plot::log_log(("error / clearance", "time / ms"), &lines)
        .map_err(|e| CommandError::other("drawing accuracy.svg", e))
}
