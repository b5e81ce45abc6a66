//! The table of checks, where runs were checked.

use super::html_page::HtmlPage;
use super::listing::Listing;
use super::markup::Markup;
use crate::report::plot::text::figures;
use crate::run::verdict::PolicyRun;
use crate::run::verify::{Check, Verification};

/// One row for each check, headed by its policy; nothing where no run was checked.
pub(super) fn push_table(page: &mut HtmlPage, runs: &[&PolicyRun]) {
    let checked = (runs.iter()).filter_map(|r| Some((*r, r.checked()?)));
    let Some((_, first)) = checked.clone().next() else {
        return;
    };
    let threshold = figures(first.threshold_clearances);
    let apart = format!("Apart by {threshold} clearances from");
    let headings = [
        ("Policy", ""),
        ("Outcome", ""),
        ("Checked by", ""),
        ("Tolerance", ""),
        ("Changes of mode", ""),
        ("Difference at the end", "clearances"),
        ("Largest difference", "clearances"),
        (&apart, "ms"),
    ];
    let rows = checked.flat_map(|(run, verification)| {
        let checks = verification.checks.iter();
        checks.map(move |check| row(run, verification, check))
    });
    page.table(&Listing {
        caption: "Checks".to_owned(),
        headings: headings
            .map(|(name, unit)| Markup::with_unit(name, unit))
            .to_vec(),
        rows: rows.collect(),
        ..Listing::default()
    });
    page.note(&Markup::text(
        "Every policy was run again with the same seed. Differences are distances of the rotor from where the run above has it.",
    ));
}

fn row(run: &PolicyRun, verification: &Verification, check: &Check) -> Vec<Markup> {
    let mut agreement = Markup::outcome(check.outcome);
    if check.outcome != run.verdict.figures.outcome {
        agreement = Markup::written(format!("{}, OTHER than the run", agreement.as_html()));
    }
    let changes = if check.same_modes {
        format!("the same {}", check.mode_changes)
    } else {
        format!("{}, not {}", check.mode_changes, verification.mode_changes)
    };
    let apart = (check.differs_from_s).map_or("never".to_owned(), |t| figures(1e3 * t));
    let words = [
        check.method.to_string(),
        format!("{:.0e}", check.rtol),
        changes,
        figures(check.end_difference_clearances),
        figures(check.largest_difference_clearances),
        apart,
    ];
    [Markup::text(&run.name), agreement]
        .into_iter()
        .chain(words.iter().map(Markup::text))
        .collect()
}
