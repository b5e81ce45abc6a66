//! The plot of `accuracy`.

use crate::cli::error::CommandError;
use firmware_bench::report::plot;
use firmware_bench::report::plot::log_log::{LogLine, LogPanel, log_log};
use firmware_studies::accuracy::study::Accuracy;
use firmware_studies::accuracy::{Reference, Row};

/// One panel for each problem with a reference.
pub(super) fn svg(found: &Accuracy) -> Result<String, CommandError> {
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
        ("collocation", "collocation", plot::FREE),
    ];
    LogPanel {
        title: &reference.problem,
        lines: methods.into_iter().map(line).collect(),
    }
}
