//! Two quantities over several decades each.

use plotters::backend::SVGBackend;
use plotters::chart::ChartBuilder;
use plotters::coord::Shift;
use plotters::coord::combinators::IntoLogRange;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Text};
use plotters::style::{Color, IntoFont, RGBColor, WHITE};

use crate::report::plot::PlotError;

/// A line with marks.
pub struct LogLine<'a> {
    /// In the legend.
    pub name: &'a str,
    /// Positive numbers.
    pub points: Vec<(f64, f64)>,
    /// Of line and marks.
    pub colour: RGBColor,
}

/// Lines that belong together.
pub struct LogPanel<'a> {
    /// Above the panel.
    pub title: &'a str,
    /// The later ones above the earlier.
    pub lines: Vec<LogLine<'a>>,
}

/// Size of a panel.
const SIZE: (u32, u32) = (720, 480);
const FONT: u32 = 16;
/// Room right of the points for the names of lines, as a factor.
const NAMES: f64 = 200.0;

/// A complete SVG file, two panels abreast; all axes logarithmic, their names as (x, y).
pub fn log_log(names: (&str, &str), panels: &[LogPanel<'_>]) -> Result<String, PlotError> {
    let columns = panels.len().clamp(1, 2);
    let rows = panels.len().div_ceil(columns).max(1);
    let size = (SIZE.0 * columns as u32, SIZE.1 * rows as u32);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE)?;
        for (place, panel) in area.split_evenly((rows, columns)).iter().zip(panels) {
            draw(place, names, panel)?;
        }
        area.present()?;
    }
    Ok(svg)
}

/// Least and largest value, with some room; the same everywhere where there is nothing to show.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values = values.filter(|v| *v > 0.0 && v.is_finite());
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    if low <= high {
        (0.5 * low, 2.0 * high)
    } else {
        (0.1, 1.0)
    }
}

fn draw(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    names: (&str, &str),
    panel: &LogPanel<'_>,
) -> Result<(), PlotError> {
    let points = || panel.lines.iter().flat_map(|l| &l.points);
    let (x, y) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)));
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, ("sans-serif", FONT))
        .margin(12)
        .x_label_area_size(48)
        .y_label_area_size(72)
        .build_cartesian_2d((x.0..x.1 * NAMES).log_scale(), (y.0..y.1).log_scale())?;
    let power = |v: &f64| format!("{v:.0e}");
    chart
        .configure_mesh()
        .x_desc(names.0)
        .y_desc(names.1)
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .label_style(("sans-serif", FONT))
        .draw()?;
    for line in &panel.lines {
        chart.draw_series([PathElement::new(
            line.points.clone(),
            line.colour.stroke_width(2),
        )])?;
        let marks = (line.points.iter()).map(|p| Circle::new(*p, 4, line.colour.filled()));
        chart.draw_series(marks)?;
        // Named at the loosest tolerance, the end to the right.
        if let Some((x, y)) = line.points.first() {
            let style = ("sans-serif", FONT).into_font().color(&line.colour);
            chart.draw_series([Text::new(line.name.to_owned(), (1.3 * x, *y), style)])?;
        }
    }
    Ok(())
}
