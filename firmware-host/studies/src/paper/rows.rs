//! The rows of all chapters: as JSON for programs, as tables for the terminal, and how a row is worded.

use super::summary::{Summary, all};
use super::{Chapter, Kind, Row, Stated};
use firmware_bench::report::lines::{Cell, lined, right};
use firmware_bench::report::plot::text::figures;
use firmware_bench::report::tone::Tone;
use serde::Serialize;

/// A row as programs get it.
#[derive(Debug, Serialize)]
struct JsonRow<'a> {
    item: &'a str,
    source: &'a str,
    paper: Option<f64>,
    computed: Option<f64>,
    unit: &'a str,
    kind: Kind,
    deviation: Option<f64>,
    /// What the paper says, where that is no plain value.
    claim: Option<String>,
    holds: Option<bool>,
    chapter: &'a str,
    note: &'a str,
}

/// All rows.
#[derive(Debug, Serialize)]
pub struct Rows<'a> {
    rows: Vec<JsonRow<'a>>,
}

/// The rows of all chapters under `rows`; numbers are finite or null.
pub fn json(chapters: &[Chapter]) -> Rows<'_> {
    let rows = all(chapters)
        .map(|(chapter, row)| JsonRow {
            item: &row.quantity,
            source: row.source,
            paper: row.paper,
            computed: row.computed,
            unit: row.unit,
            kind: row.kind,
            deviation: row.deviation,
            claim: (row.stated != Stated::Value).then(|| paper(row)),
            holds: row.holds(),
            chapter: chapter.title,
            note: &row.note,
        })
        .collect();
    Rows { rows }
}

/// What the paper has.
pub(super) fn paper(row: &Row) -> String {
    match row.stated {
        Stated::Value => row.paper.map_or("–".to_owned(), figures),
        Stated::AtMost(high) => format!("≤ {}", figures(high)),
        Stated::AtLeast(low) => format!("≥ {}", figures(low)),
        Stated::Between(low, high) => format!("{} to {}", figures(low), figures(high)),
    }
}

/// What the model gives.
pub(super) fn computed(row: &Row) -> String {
    row.computed.map_or("–".to_owned(), figures)
}

/// The deviation; bounds and ranges hold or do not.
pub(super) fn deviation(row: &Row) -> String {
    match (row.stated, row.holds()) {
        (Stated::Value, _) => row.deviation.map_or("–".to_owned(), percent),
        (_, Some(true)) => "holds".to_owned(),
        (_, Some(false)) => "fails".to_owned(),
        (_, None) => "–".to_owned(),
    }
}

/// With sign; whole percents where it is large.
fn percent(share: f64) -> String {
    let digits = if share.abs() < 0.0995 { 1 } else { 0 };
    let text = format!("{:+.digits$} %", 100.0 * share);
    if ["+0.0 %", "-0.0 %"].contains(&text.as_str()) {
        return "0.0 %".to_owned();
    }
    text.replace('-', "\u{2212}")
}

/// How it came about, in a word.
pub(super) fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Fitted => "fitted",
        Kind::Predicted => "predicted",
        Kind::Assumed => "assumed",
    }
}

/// One table a chapter, and the summary.
pub fn text(chapters: &[Chapter]) -> String {
    let mut out = String::new();
    for chapter in chapters {
        let mut table = lined([
            Cell::new("item"),
            right("paper"),
            right("computed"),
            Cell::new("unit"),
            right("deviation"),
            Cell::new("kind"),
        ]);
        for row in &chapter.rows {
            table.add_row([
                Cell::new(&row.quantity),
                right(paper(row)),
                right(computed(row)),
                Cell::new(row.unit),
                right(deviation(row)).toned(row.holds().map(Tone::of_claim)),
                Cell::new(kind(row.kind)),
            ]);
        }
        out += &format!("{}\n{table}\n\n", chapter.title);
    }
    for sentence in Summary::of(chapters).sentences() {
        out += &format!("{sentence}\n");
    }
    out
}
