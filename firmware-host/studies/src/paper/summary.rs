//! What comes of all rows together: how good the predictions are, what was fitted, what misses.

use super::{Chapter, Kind, MISS, Paper, Row};

/// Kinds in the order in which they are summed up.
const KINDS: [Kind; 3] = [Kind::Predicted, Kind::Assumed, Kind::Fitted];

impl Kind {
    fn meaning(self) -> &'static str {
        match self {
            Self::Predicted => "predicted (nothing was chosen for them)",
            Self::Assumed => {
                "assumed (they hang on a constant that the paper leaves out and that was not fitted to them)"
            }
            Self::Fitted => "fitted (a constant was chosen so that they fit)",
        }
    }
}

/// The rows wanted, of all chapters.
fn rows(chapters: &[Chapter], wanted: impl Fn(&Row) -> bool) -> Vec<&Row> {
    let all = chapters.iter().flat_map(|chapter| &chapter.rows);
    all.filter(|row| wanted(row)).collect()
}

/// Rows of a kind that the paper has a value, bound or range for.
fn compared(chapters: &[Chapter], kind: Kind) -> Vec<&Row> {
    rows(chapters, |row| row.kind == kind && row.holds().is_some())
}

fn met(rows: &[&Row]) -> usize {
    rows.iter().filter(|row| row.holds() == Some(true)).count()
}

/// The summary in sentences.
pub(super) fn sentences(chapters: &[Chapter]) -> Vec<String> {
    let compared_with = rows(chapters, |row| row.holds().is_some());
    let all = format!(
        "{} rows in {} chapters; the paper has a number for {} of them. A value is met within {:.0} %, \
         a bound or range where it holds: {} are met, {} miss.",
        rows(chapters, |_| true).len(),
        chapters.len(),
        compared_with.len(),
        100.0 * MISS,
        met(&compared_with),
        compared_with.len() - met(&compared_with),
    );
    let by_kind = KINDS.into_iter().filter_map(|kind| {
        let of = compared(chapters, kind);
        (!of.is_empty()).then(|| sentence(kind, &of))
    });
    let constants = rows(chapters, |row| {
        row.kind == Kind::Fitted && row.paper == Paper::Silent
    });
    let words = |row: &&Row| format!("{} = {} {}", row.item, row.computed_words(), row.unit);
    let named: Vec<String> = constants.iter().map(words).collect();
    let named: Vec<&str> = named.iter().map(|words| words.trim_end()).collect();
    let named = named.join(", ");
    let fitted = (!named.is_empty()).then(|| format!("Constants fitted: {named}."));
    [all].into_iter().chain(by_kind).chain(fitted).collect()
}

fn sentence(kind: Kind, of: &[&Row]) -> String {
    let (values, bounds): (Vec<&Row>, Vec<&Row>) =
        (of.iter()).partition(|row| matches!(row.paper, Paper::Value(_)));
    let mut parts = Vec::new();
    if !values.is_empty() {
        let off = values.iter().filter_map(|row| row.deviation());
        let mut off: Vec<f64> = off.map(f64::abs).collect();
        off.sort_by(f64::total_cmp);
        let median = 50.0 * (off[(off.len() - 1) / 2] + off[off.len() / 2]);
        parts.push(format!(
            "{} of {} values within {:.0} %, median deviation {median:.1} %",
            met(&values),
            values.len(),
            100.0 * MISS
        ));
    }
    if !bounds.is_empty() {
        let (held, all) = (met(&bounds), bounds.len());
        parts.push(format!("{held} of {all} bounds and ranges hold"));
    }
    format!("{} {}: {}.", of.len(), kind.meaning(), parts.join("; "))
}
