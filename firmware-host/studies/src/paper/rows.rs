//! The rows of all chapters: how one is worded, and as JSON for programs.

use super::{Chapter, Kind, Paper, Row};
use firmware_bench::report::plot::text::figures;
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

/// The rows of all chapters; numbers are finite or null.
pub(super) fn values(chapters: &[Chapter]) -> Vec<serde_json::Value> {
    let all = (chapters.iter()).flat_map(|c| c.rows.iter().map(move |row| (c.title, row)));
    all.filter_map(|(chapter, row)| serde_json::to_value(JsonRow::of(chapter, row)).ok())
        .collect()
}

impl<'a> JsonRow<'a> {
    fn of(chapter: &'a str, row: &'a Row) -> Self {
        let plain = matches!(row.paper, Paper::Value(_) | Paper::Silent);
        Self {
            item: &row.item,
            source: row.source,
            paper: row.paper.number(),
            computed: row.computed,
            unit: row.unit,
            kind: row.kind,
            deviation: row.deviation(),
            claim: (!plain).then(|| row.paper.words()),
            holds: row.holds(),
            chapter,
            note: &row.note,
        }
    }
}

impl Paper {
    fn words(self) -> String {
        match self {
            Self::Silent => "–".to_owned(),
            Self::Value(value) => figures(value),
            Self::AtMost(high) => format!("≤ {}", figures(high)),
            Self::AtLeast(low) => format!("≥ {}", figures(low)),
            Self::Between(low, high) => format!("{} to {}", figures(low), figures(high)),
        }
    }
}

/// Headings of [`Row::cells`].
pub(super) const COLUMNS: [&str; 8] = [
    "Quantity",
    "Source",
    "Paper",
    "Computed",
    "Unit",
    "Deviation",
    "Kind",
    "Note",
];

impl Row {
    /// As it is read.
    pub(super) fn cells(&self) -> [String; 8] {
        [
            self.item.clone(),
            self.source.to_owned(),
            self.paper.words(),
            self.computed_words(),
            self.unit.to_owned(),
            self.deviation_words(),
            format!("{:?}", self.kind).to_lowercase(),
            self.note.clone(),
        ]
    }

    /// What the model gives, as it is read.
    pub(super) fn computed_words(&self) -> String {
        self.computed.map_or("–".to_owned(), figures)
    }

    /// The deviation from a value; bounds and ranges hold or do not.
    fn deviation_words(&self) -> String {
        match (self.paper, self.holds()) {
            (Paper::Value(_), _) => self.deviation().map_or("–".to_owned(), percent),
            (_, Some(true)) => "holds".to_owned(),
            (_, Some(false)) => "fails".to_owned(),
            (_, None) => "–".to_owned(),
        }
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
