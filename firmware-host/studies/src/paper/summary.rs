//! What comes of all rows together: how good the predictions are, what was fitted, what misses.

use super::{Chapter, Kind, MISS, Row, Stated};
use firmware_bench::report::plot::text::figures;

/// Every row with its chapter.
pub(super) fn all(chapters: &[Chapter]) -> impl Iterator<Item = (&Chapter, &Row)> {
    (chapters.iter()).flat_map(|chapter| chapter.rows.iter().map(move |row| (chapter, row)))
}

/// The rows, sorted.
pub(super) struct Summary<'a> {
    /// Rows of the paper with a value, bound or range, by kind: predicted, assumed, fitted.
    compared: [Vec<&'a Row>; 3],
    /// Constants that were fitted: fitted rows without a counterpart in the paper.
    constants: Vec<&'a Row>,
    /// Rows that miss, with their chapters.
    pub(super) misses: Vec<(&'a Chapter, &'a Row)>,
    chapters: usize,
    rows: usize,
}

/// Kinds in the order of [`Summary::compared`], with their meaning.
const KINDS: [(Kind, &str); 3] = [
    (Kind::Predicted, "predicted (nothing was chosen for them)"),
    (
        Kind::Assumed,
        "assumed (they hang on a constant that the paper leaves out and that was not fitted to them)",
    ),
    (
        Kind::Fitted,
        "fitted (a constant was chosen so that they fit)",
    ),
];

impl<'a> Summary<'a> {
    /// Of all chapters.
    pub(super) fn of(chapters: &'a [Chapter]) -> Self {
        let compared = KINDS.map(|(kind, _)| {
            (all(chapters).map(|(_, row)| row))
                .filter(|row| row.kind == kind && row.holds().is_some())
                .collect()
        });
        let constant =
            |row: &&Row| row.kind == Kind::Fitted && row.paper.is_none() && row.computed.is_some();
        Self {
            compared,
            constants: (all(chapters).map(|(_, row)| row))
                .filter(constant)
                .collect(),
            misses: (all(chapters))
                .filter(|(_, row)| row.holds() == Some(false))
                .collect(),
            chapters: chapters.len(),
            rows: all(chapters).count(),
        }
    }

    fn compared(&self) -> usize {
        self.compared.iter().map(Vec::len).sum()
    }

    /// What comes of it, in a sentence.
    pub(super) fn conclusion(&self) -> String {
        let compared = self.compared();
        let misses = self.misses.len();
        let predicted = &self.compared[0];
        let met = |rows: &[&Row]| rows.iter().filter(|r| r.holds() == Some(true)).count();
        format!(
            "The model meets {} of the {compared} numbers, bounds and ranges that the paper gives; {} of the {} for which nothing was \
             chosen. {}",
            compared - misses,
            met(predicted),
            predicted.len(),
            match misses {
                0 => "None misses.".to_owned(),
                1 => "The one that misses is listed with the reason.".to_owned(),
                _ => format!("The {misses} that miss are listed with the reasons."),
            }
        )
    }

    /// The summary in sentences.
    pub(super) fn sentences(&self) -> Vec<String> {
        let compared = self.compared();
        let mut out = vec![format!(
            "{} rows in {} chapters; the paper has a number for {compared} of them. A value is met within {:.0} %, \
             a bound or range where it holds: {} are met, {} miss.",
            self.rows,
            self.chapters,
            100.0 * MISS,
            compared - self.misses.len(),
            self.misses.len()
        )];
        out.extend(
            (KINDS.iter().zip(&self.compared))
                .filter(|(_, rows)| !rows.is_empty())
                .map(|((_, meaning), rows)| sentence(meaning, rows)),
        );
        if !self.constants.is_empty() {
            out.push(format!("Constants fitted: {}.", list(&self.constants)));
        }
        out
    }
}

fn sentence(meaning: &str, rows: &[&Row]) -> String {
    let (values, claims): (Vec<&Row>, Vec<&Row>) =
        (rows.iter().copied()).partition(|row| row.stated == Stated::Value);
    let met = |rows: &[&Row]| rows.iter().filter(|r| r.holds() == Some(true)).count();
    let mut parts = Vec::new();
    if !values.is_empty() {
        let mut off: Vec<f64> = (values.iter().filter_map(|r| r.deviation))
            .map(f64::abs)
            .collect();
        off.sort_by(f64::total_cmp);
        let (low, high) = (off.get((off.len() - 1) / 2), off.get(off.len() / 2));
        let median = (low.zip(high)).map_or(f64::NAN, |(low, high)| 50.0 * (low + high));
        parts.push(format!(
            "{} of {} values within {:.0} %, median deviation {median:.1} %",
            met(&values),
            values.len(),
            100.0 * MISS
        ));
    }
    if !claims.is_empty() {
        parts.push(format!(
            "{} of {} bounds and ranges hold",
            met(&claims),
            claims.len()
        ));
    }
    format!("{} {meaning}: {}.", rows.len(), parts.join("; "))
}

fn list(rows: &[&Row]) -> String {
    let word = |row: &&Row| {
        let value = row.computed.map_or("–".to_owned(), figures);
        format!("{} = {value} {}", row.quantity, row.unit)
            .trim_end()
            .to_owned()
    };
    rows.iter().map(word).collect::<Vec<_>>().join(", ")
}
