//! Tables and the plot of `accuracy`.

use super::Accuracy;
use crate::cli::error::CommandError;
use comfy_table::{Cell, Table};
use firmware_bench::report::plot;
use firmware_bench::report::plot::log_log::{LogLine, LogPanel, log_log};
use firmware_bench::report::table::{lined, right};
use firmware_studies::accuracy::{Reference, Row};
use std::fmt::Write as _;

/// What is wrong with a reference.
pub(super) fn unconfirmed(reference: &Reference) -> String {
    let Reference {
        problem,
        methods: [one, other],
        uncertainty,
        same_modes,
        ..
    } = reference;
    let modes = if *same_modes { "the same" } else { "other" };
    format!(
        "{problem}: no errors, for the reference is not confirmed: at rtol 1e-13 {other} ends \
         {uncertainty:.1e} c away from {one}, through {modes} modes"
    )
}

pub(super) fn tables(found: &Accuracy) -> String {
    let mut text = String::new();
    for reference in &found.references {
        let problem = &reference.problem;
        let note = if reference.confirmed {
            let [one, other] = reference.methods;
            format!(
                "reference: {one} at rtol 1e-13; {other} ends {:.1e} c away, through the same modes",
                reference.uncertainty
            )
        } else {
            unconfirmed(reference)
        };
        let rows = found.rows.iter().filter(|r| r.problem == *problem);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{problem}\n{}\n{note}\n", errors(rows));
    }
    if !found.wrong_runs.is_empty() {
        let _ = writeln!(
            text,
            "Silently wrong runs, from 400 start speeds each\n{}",
            wrong(found)
        );
    }
    for skipped in &found.not_swept {
        let _ = writeln!(
            text,
            "{}: no search for wrong runs ({})",
            skipped.problem, skipped.reason
        );
    }
    text
}

fn errors<'a>(rows: impl Iterator<Item = &'a Row>) -> Table {
    let mut table = lined([
        "method",
        "rtol",
        "error [c]",
        "time [ms]",
        "steps",
        "evaluations",
        "mode changes",
    ]);
    for row in rows {
        table.add_row([
            Cell::new(row.method),
            right(format!("{:.0e}", row.rtol)),
            right(row.error.map_or("–".to_owned(), |e| format!("{e:.1e}"))),
            right(format!("{:.3}", row.seconds * 1e3)),
            right(row.steps.to_string()),
            right(row.evaluations.to_string()),
            right(row.mode_changes.to_string()),
        ]);
    }
    table
}

fn wrong(found: &Accuracy) -> Table {
    let mut table = lined([
        "problem", "method", "rtol", "wrong", "failed", "of", "left out",
    ]);
    for row in &found.wrong_runs {
        table.add_row([
            Cell::new(&row.problem),
            Cell::new(row.method),
            right(format!("{:.0e}", row.rtol)),
            right(row.wrong.to_string()),
            right(row.failed.to_string()),
            right(row.of.to_string()),
            right(row.left_out.to_string()),
        ]);
    }
    table
}

/// One panel for each problem with a reference.
pub(super) fn figure(found: &Accuracy) -> Result<String, CommandError> {
    let confirmed = found.references.iter().filter(|r| r.confirmed);
    let panels: Vec<_> = confirmed.map(|r| panel(found, r)).collect();
    log_log(("error / clearance", "time / s"), &panels)
        .map_err(|e| CommandError::other("drawing accuracy.svg", e))
}

fn panel<'a>(found: &Accuracy, reference: &'a Reference) -> LogPanel<'a> {
    // Below the references' distance an error means nothing; it is drawn there.
    let floor = reference.uncertainty.max(1e-15);
    let line = |(method, name, colour)| {
        let of = |r: &&Row| r.problem == reference.problem && r.method == method;
        let point = |r: &Row| Some((r.error?.max(floor), r.seconds));
        LogLine {
            name,
            points: found.rows.iter().filter(of).filter_map(point).collect(),
            colour,
        }
    };
    let methods = [
        ("series", "series", plot::TOUCHING),
        ("explicit", "explicit pair 8(5,3)", plot::FREE),
        ("stiff", "stiff, Radau IIA", plot::LIMIT),
    ];
    LogPanel {
        title: &reference.problem,
        lines: methods.into_iter().map(line).collect(),
    }
}
