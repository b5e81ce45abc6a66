//! Rows, tables and charts as data: a line each, whose parts are what is shown; and what chapters need to get there.

pub(super) use super::Kind::{self, *};
pub(super) use super::Paper::*;
pub(super) use super::{Chapter, PaperError, Row};
use crate::campaign;
pub(super) use crate::campaign::{Drawing, Extent, Figure, Table};
pub(super) use firmware_bench::report::plot::chart::{Axis, Chart, Curve, HeatMap, Mark};
pub(super) use plant_model::params::PlantParams;
pub(super) use std::f64::consts::TAU;

/// Rows of a chapter. A line: item, unit, source, what the paper has `=>` what the model gives, how that came about, note.
macro_rules! rows {
    ($(
        $item:literal, $unit:expr, $source:expr, $paper:expr => $computed:expr, $kind:expr, $note:literal $(, $arg:expr)*;
    )*) => {
        vec![$(Row {
            item: format!($item),
            unit: $unit,
            source: $source,
            paper: $paper.into(),
            computed: Option::<f64>::from($computed).filter(|value| value.is_finite()),
            kind: $kind,
            note: format!($note $(, $arg)*),
        }),*]
    };
}

/// A table: caption, what its rows are of, and a line for each column, heading `=>` cell.
macro_rules! table {
    ($caption:literal; for $of:pat in $all:expr; $($heading:literal => $cell:literal $(, $arg:expr)*;)*) => {
        Table {
            caption: format!($caption),
            columns: vec![$($heading.to_owned()),*],
            rows: $all.into_iter().map(|$of| vec![$(format!($cell $(, $arg)*)),*]).collect(),
        }
    };
}

/// Curves of a chart. A line: name, mark, place among the colours `=>` points.
macro_rules! curves {
    ($($name:literal, $mark:ident, $colour:expr => $points:expr;)*) => {
        vec![$(curve(format!($name), Mark::$mark, $colour, $points)),*]
    };
}

/// A chart: short name, what a screen reader says, caption, both axes, and its curves.
macro_rules! chart {
    ($file:expr, $label:literal, $caption:literal; $x:expr, $y:expr; $curves:expr) => {
        Figure {
            file: $file.into(),
            caption: format!($caption),
            drawing: Drawing::Chart(Chart {
                label: format!($label),
                x: $x,
                y: $y,
                curves: $curves,
            }),
        }
    };
}

pub(super) use {chart, curves, rows, table};

/// What a part of a chapter comes to.
pub(super) type Result<T, E = PaperError> = std::result::Result<T, E>;

/// A curve.
pub(super) fn curve(name: String, mark: Mark, colour: usize, points: Vec<(f64, f64)>) -> Curve {
    let line = Curve::line(name, points, colour);
    Curve { mark, ..line }
}

/// A line at one height.
pub(super) fn level((from, to): (f64, f64), height: f64) -> Vec<(f64, f64)> {
    vec![(from, height), (to, height)]
}

/// The highest of the finite points of some curves.
pub(super) fn highest(curves: &[Curve]) -> f64 {
    let values = curves.iter().flat_map(|c| &c.points).map(|p| p.1);
    values.filter(|y| y.is_finite()).fold(0.0, f64::max)
}

/// A cell: a number with so many digits, or a dash.
pub(super) fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |x| format!("{x:.digits$}"))
}

/// An error that says what is missing.
pub(super) fn missing<T>(what: impl Into<String>) -> Result<T> {
    Err(PaperError::Missing(what.into()))
}

/// Something that a chapter looks for and may not find.
pub(super) trait OrMissing<T> {
    /// It, or an error that says what is missing.
    fn or_missing(self, what: impl Into<String>) -> Result<T>;
}

impl<T> OrMissing<T> for Option<T> {
    fn or_missing(self, what: impl Into<String>) -> Result<T> {
        self.map_or_else(|| missing(what), Ok)
    }
}

/// Runs every case on the threads of the pool; results are in the order of the cases.
pub(super) fn each<C: Sync, R: Send>(
    cases: &[C],
    run: impl Fn(&C) -> Result<R> + Sync + Send,
) -> Result<Vec<R>> {
    campaign::each(cases, run).into_iter().collect()
}

/// Halves a bracket of where `below` turns from true to false until it is no wider than `width` says of its upper end.
pub(super) fn halved(
    (mut low, mut high): (f64, f64),
    width: impl Fn(f64) -> f64,
    mut below: impl FnMut(f64) -> Result<bool>,
) -> Result<(f64, f64)> {
    while high - low > width(high) {
        let middle = 0.5 * (low + high);
        match below(middle)? {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok((low, high))
}

/// Goes up from a bracket by `next` until `below` turns false, and halves that last step.
pub(super) fn first_above(
    (mut low, mut high): (f64, f64),
    (next, most): (fn(f64) -> f64, f64),
    width: impl Fn(f64) -> f64,
    mut below: impl FnMut(f64) -> Result<bool>,
) -> Result<f64> {
    while below(high)? {
        (low, high) = (high, next(high));
        if high > most {
            return missing(format!("no whirl up to {most}"));
        }
    }
    Ok(halved((low, high), width, below)?.1)
}
