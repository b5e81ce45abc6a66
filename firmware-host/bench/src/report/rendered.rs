//! Drawings of curves and maps with what they show as a table.

use super::listing::Listing;
use super::markup::Markup;
use super::plot::PlotError;
use super::plot::chart::{Axis, Chart, Curve, HeatMap, Mark, chart, heat_map};
use super::plot::text::figures;

/// Rows of a table at most, or points of a curve.
const ROWS: usize = 24;
/// Columns of a map's table at most.
const COLUMNS: usize = 12;

/// A drawing with its name, and what it shows as a table for those who cannot see it or want its numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rendered {
    /// By which the page links to it; no two are alike.
    pub id: Option<String>,
    /// What is to be seen.
    pub caption: Markup,
    pub drawing: String,
    /// Its numbers.
    pub data: Listing,
}

impl Rendered {
    /// A drawing under a name.
    pub fn new(name: &str, drawing: String, data: Listing) -> Self {
        Self {
            id: None,
            caption: Markup::written(format!("<b>{}</b>", Markup::text(name).as_html())),
            drawing,
            data,
        }
    }

    /// Curves under their label.
    ///
    /// # Errors
    /// [`PlotError`] if the drawing backend refuses.
    pub fn of_chart(plot: &Chart) -> Result<Self, PlotError> {
        Ok(Self::new(&plot.label, chart(plot)?, points(plot)))
    }

    /// A map under its label.
    ///
    /// # Errors
    /// [`PlotError`] if the drawing backend refuses.
    pub fn of_map(plot: &HeatMap) -> Result<Self, PlotError> {
        Ok(Self::new(&plot.label, heat_map(plot)?, cells(plot)))
    }

    /// With a caption that begins with its number, and a name to link to.
    #[must_use]
    pub fn numbered(self, id: String, number: &str, caption: &str) -> Self {
        let caption = format!(
            "<b>Figure {number}.</b> {}",
            Markup::text(caption).as_html()
        );
        Self {
            id: Some(id),
            caption: Markup::written(caption),
            ..self
        }
    }
}

/// The points of all curves: a row for each x where the curves share it, else for each point.
fn points(plot: &Chart) -> Listing {
    let whole = |curve: &Curve| curve.points.iter().all(|p| p.0.is_finite());
    let shared = plot.curves.first().is_some_and(|first| {
        (plot.curves.iter()).all(|curve| {
            let mut x = curve.points.iter().zip(&first.points);
            let alike = x.all(|(a, b)| a.0.to_bits() == b.0.to_bits());
            curve.mark != Mark::Name && alike && curve.points.len() == first.points.len()
        }) && whole(first)
    });
    match shared {
        true => side_by_side(plot),
        false => one_by_one(plot),
    }
}

fn side_by_side(plot: &Chart) -> Listing {
    let count = plot.curves.first().map_or(0, |curve| curve.points.len());
    let rows = spread(count, ROWS);
    let of_row = |i: &usize| {
        let x = plot.curves.first().map(|curve| curve.points[*i].0);
        let y = plot.curves.iter().map(|curve| curve.points[*i].1);
        x.into_iter().chain(y).map(figures).collect()
    };
    let names = plot.curves.iter().map(|curve| match curve.name.is_empty() {
        true => &plot.y.name,
        false => &curve.name,
    });
    Listing::of_texts(
        thinned(&plot.label, &[(rows.len(), count, "points")]),
        [&plot.x.name].into_iter().chain(names),
        rows.iter().map(of_row),
    )
}

fn one_by_one(plot: &Chart) -> Listing {
    let mut rows = Vec::new();
    let (mut shown, mut all) = (0, 0);
    for curve in &plot.curves {
        let drawn = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite();
        let points: Vec<&(f64, f64)> = curve.points.iter().filter(drawn).collect();
        let kept = spread(points.len(), ROWS);
        (shown, all) = (shown + kept.len(), all + points.len());
        rows.extend((kept.iter()).map(|i| {
            let (x, y) = points[*i];
            vec![curve.name.clone(), figures(*x), figures(*y)]
        }));
    }
    Listing::of_texts(
        thinned(&plot.label, &[(shown, all, "points")]),
        ["curve", &plot.x.name, &plot.y.name],
        rows,
    )
}

/// The cells, the top row first as in the drawing.
fn cells(plot: &HeatMap) -> Listing {
    let [columns, rows] = &plot.names;
    let count = plot.cells.first().map_or(0, Vec::len);
    let (across, up) = (spread(count, COLUMNS), spread(plot.cells.len(), ROWS));
    let place = |axis: &Axis, names: &[String], i: usize, n: usize| match names.get(i) {
        Some(name) => name.clone(),
        None => figures(axis.at((i as f64 + 0.5) / n as f64)),
    };
    let heading = |i: &usize| place(&plot.x, columns, *i, count);
    let corner = format!("{}, over {}", plot.y.name, plot.x.name);
    let row = |j: &usize| {
        let cells = &plot.cells[*j];
        let first = place(&plot.y, rows, *j, plot.cells.len());
        let cells = across.iter().map(|i| cells.get(*i).copied());
        let cells = cells.map(|value| figures(value.unwrap_or(f64::NAN)));
        [first].into_iter().chain(cells).collect::<Vec<_>>()
    };
    Listing::of_texts(
        thinned(
            &format!("{}: {}", plot.label, plot.scale.2),
            &[
                (up.len(), plot.cells.len(), "rows"),
                (across.len(), count, "columns"),
            ],
        ),
        [corner].into_iter().chain(across.iter().map(heading)),
        up.iter().rev().map(row),
    )
}

/// At most so many places of `count`, both ends among them.
fn spread(count: usize, most: usize) -> Vec<usize> {
    match count <= most {
        true => (0..count).collect(),
        false => (0..most).map(|i| i * (count - 1) / (most - 1)).collect(),
    }
}

/// Says so where a table has not all.
fn thinned(label: &str, parts: &[(usize, usize, &str)]) -> String {
    let less = parts.iter().filter(|(shown, all, _)| shown < all);
    let less: Vec<String> = less
        .map(|(shown, all, what)| format!("{shown} of {all} {what}"))
        .collect();
    match less.is_empty() {
        true => label.to_owned(),
        false => format!("{label} ({})", less.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(row: &[Markup]) -> Vec<&str> {
        row.iter().map(Markup::as_html).collect()
    }

    fn curve(name: &str, x: impl Iterator<Item = u32>) -> Curve {
        let points = x.map(|x| (f64::from(x), f64::from(2 * x)));
        Curve::line(name.to_owned(), points.collect(), 0)
    }

    fn chart_of(curves: Vec<Curve>) -> Chart {
        Chart {
            label: "label".to_owned(),
            x: Axis::linear("x", (0.0, 1.0)),
            y: Axis::linear("y", (0.0, 1.0)),
            curves,
        }
    }

    #[test]
    fn curves_that_share_x_stand_side_by_side() {
        let data = points(&chart_of(vec![curve("a", 0..3), curve("b", 0..3)]));
        assert_eq!(texts(&data.headings), ["x", "a", "b"]);
        assert_eq!(texts(&data.rows[2]), ["2", "4", "4"]);
        assert_eq!((data.rows.len(), &data.caption[..]), (3, "label"));

        let mut broken = curve("b", 0..3);
        broken.points[1] = (f64::NAN, f64::NAN);
        let data = points(&chart_of(vec![curve("a", 0..3), broken]));
        assert_eq!(texts(&data.headings), ["curve", "x", "y"]);
        assert_eq!(data.rows.len(), 5, "a gap is no point");
        assert_eq!(texts(&data.rows[4]), ["b", "2", "4"]);
    }

    #[test]
    fn long_tables_keep_their_ends_and_say_so() {
        let data = points(&chart_of(vec![curve("a", 0..1001)]));
        assert_eq!(data.caption, "label (24 of 1001 points)");
        assert_eq!(texts(&data.rows[0]), ["0", "0"]);
        assert_eq!(texts(&data.rows[ROWS - 1]), ["1000", "2000"]);
        assert!(points(&chart_of(Vec::new())).rows.is_empty());
    }

    #[test]
    fn a_map_stands_as_it_is_drawn() {
        let map = HeatMap {
            label: "label".to_owned(),
            x: Axis::log("x", (1.0, 100.0)),
            y: Axis::linear("y", (0.0, 4.0)),
            names: [Vec::new(), vec!["low".to_owned(), "high".to_owned()]],
            cells: vec![vec![1.0], vec![f64::NAN]],
            scale: (0.0, 1.0, "share".to_owned()),
        };
        let data = cells(&map);
        assert_eq!(texts(&data.headings), ["y, over x", "10"]);
        assert_eq!(texts(&data.rows[0]), ["high", "–"]);
        assert_eq!(texts(&data.rows[1]), ["low", "1"]);
    }
}
