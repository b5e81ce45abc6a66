//! Two quantities over several decades each.

use plotters::backend::SVGBackend;
use plotters::chart::ChartBuilder;
use plotters::coord::combinators::IntoLogRange;
use plotters::drawing::IntoDrawingArea;
use plotters::element::{Circle, PathElement, Text};
use plotters::style::{Color, IntoFont, RGBColor, WHITE};

use crate::plot::PlotError;

/// A line with marks.
pub(crate) struct LogLine<'a> {
    pub(crate) name: &'a str,
    /// Positive numbers.
    pub(crate) points: &'a [(f64, f64)],
    pub(crate) colour: RGBColor,
}

const SIZE: (u32, u32) = (720, 480);
const FONT: u32 = 16;

/// A complete SVG file; both axes logarithmic, their names as (x, y).
pub(crate) fn log_log(names: (&str, &str), lines: &[LogLine<'_>]) -> Result<String, PlotError> {
    let range = |pick: fn(&(f64, f64)) -> f64| {
        let values = lines.iter().flat_map(|l| l.points).map(pick);
        let values = values.filter(|v| *v > 0.0 && v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        if low <= high {
            (0.5 * low, 2.0 * high)
        } else {
            (0.1, 1.0)
        }
    };
    let (x, y) = (range(|p| p.0), range(|p| p.1));
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .x_label_area_size(48)
            .y_label_area_size(72)
            .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
        let power = |v: &f64| format!("{v:.0e}");
        chart
            .configure_mesh()
            .x_desc(names.0)
            .y_desc(names.1)
            .x_label_formatter(&power)
            .y_label_formatter(&|v| format!("{v}"))
            .label_style(("sans-serif", FONT))
            .draw()?;
        for line in lines {
            let points: Vec<(f64, f64)> = line.points.to_vec();
            chart.draw_series([PathElement::new(
                points.clone(),
                line.colour.stroke_width(2),
            )])?;
            let marks = points
                .iter()
                .map(|p| Circle::new(*p, 4, line.colour.filled()));
            chart.draw_series(marks)?;
            if let Some(last) = points.last() {
                let style = ("sans-serif", FONT).into_font().color(&line.colour);
                chart.draw_series([Text::new(line.name.to_owned(), *last, style)])?;
            }
        }
        area.present()?;
    }
    Ok(svg)
}
