//! Curves over an axis and values over a plane, with named axes, legend and measured points.

use crate::plot::text::{escape, figures, hex};
use crate::plot::{INK, PlotError};
use plotters::backend::SVGBackend;
use plotters::chart::ChartBuilder;
use plotters::coord::Shift;
use plotters::coord::combinators::IntoLogRange;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Cross, PathElement, Rectangle};
use plotters::prelude::Ranged;
use plotters::style::{Color, RGBColor, WHITE};
use std::fmt::Write as _;
use std::ops::Range;

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name and unit.
    pub name: String,
    /// From and to.
    pub range: (f64, f64),
    /// Logarithmic; both ends must be positive.
    pub log: bool,
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// A dashed line: closed forms and limits.
    Dashed,
    /// Dots: single runs.
    Dots,
    /// Crosses: what the paper measured.
    Crosses,
}

/// A curve with its entry in the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is.
    pub name: String,
    /// Points, left to right for lines; what is not finite interrupts a line.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub mark: Mark,
    /// Place among six colours.
    pub colour: usize,
}

/// Curves over an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What a screen reader says.
    pub label: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves, the first at the bottom.
    pub curves: Vec<Curve>,
}

/// A value over a plane, on a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// What a screen reader says.
    pub label: String,
    /// Horizontal axis; cells divide it evenly (by its logarithm where it is logarithmic).
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Rows from bottom to top, cells from left to right; not finite is left white.
    pub cells: Vec<Vec<f64>>,
    /// Values of the lightest and the darkest colour, and what the value is.
    pub scale: (f64, f64, String),
}

/// Colours that can be told apart, also without red and green.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0x1f, 0x5f, 0x99),
    RGBColor(0xdd, 0x5a, 0x0b),
    RGBColor(0x2a, 0x8a, 0x6a),
    RGBColor(0x8a, 0x1c, 0x1c),
    RGBColor(0x7a, 0x4f, 0xa3),
    RGBColor(0x6b, 0x74, 0x7f),
];

// CSS pixels.
const WIDTH: u32 = 680;
const HEIGHT: u32 = 380;
const FONT: u32 = 15;

/// Draws curves.
pub(crate) fn chart(plot: &Chart) -> Result<String, PlotError> {
    let draw = |area: &Area<'_>| match (plot.x.log, plot.y.log) {
        (false, false) => curves(area, plot, linear(&plot.x), linear(&plot.y)),
        (true, false) => curves(area, plot, linear(&plot.x).log_scale(), linear(&plot.y)),
        (false, true) => curves(area, plot, linear(&plot.x), linear(&plot.y).log_scale()),
        (true, true) => curves(
            area,
            plot,
            linear(&plot.x).log_scale(),
            linear(&plot.y).log_scale(),
        ),
    };
    let mut legend = String::from("<ul class=\"legend\">");
    for curve in &plot.curves {
        let sign = match curve.mark {
            Mark::Line => "—",
            Mark::Dashed => "– –",
            Mark::Dots => "●",
            Mark::Crosses => "✕",
        };
        let colour = hex(colour(curve.colour));
        let name = escape(&curve.name);
        let _ = write!(
            legend,
            "<li><span style=\"color:{colour}\">{sign}</span> {name}</li>"
        );
    }
    legend.push_str("</ul>");
    Ok(svg(&plot.label, draw)? + &legend)
}

/// Draws a map.
pub(crate) fn heat_map(plot: &HeatMap) -> Result<String, PlotError> {
    let picture = svg(&plot.label, |area| {
        // Cells are laid out evenly; the axis says what their places mean.
        let mut chart = ChartBuilder::on(area)
            .margin(10)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
        let rows = plot.cells.len() as f64;
        for (j, row) in plot.cells.iter().enumerate() {
            let columns = row.len() as f64;
            let cells = row.iter().enumerate().filter(|(_, v)| v.is_finite());
            chart.draw_series(cells.map(|(i, v)| {
                let (x, y) = (i as f64 / columns, j as f64 / rows);
                let corner = (x + 1.0 / columns, y + 1.0 / rows);
                Rectangle::new([(x, y), corner], shade(*v, &plot.scale).filled())
            }))?;
        }
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc(&plot.x.name)
            .y_desc(&plot.y.name)
            .x_labels(6)
            .y_labels(6)
            .x_label_formatter(&|share| figures(at(&plot.x, *share)))
            .y_label_formatter(&|share| figures(at(&plot.y, *share)))
            .label_style(("sans-serif", FONT))
            .draw()?;
        Ok(())
    })?;
    let (low, high, name) = &plot.scale;
    let [from, to] = [*low, *high].map(|v| hex(shade(v, &plot.scale)));
    let legend = format!(
        "<ul class=\"legend\"><li>{}: <span style=\"color:{from}\">■</span> {} to \
         <span style=\"color:{to}\">■</span> {}</li></ul>",
        escape(name),
        figures(*low),
        figures(*high)
    );
    Ok(picture + &legend)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn svg(
    label: &str,
    draw: impl FnOnce(&Area<'_>) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT)).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()?;
    }
    let begin = format!("<svg role=\"img\" aria-label=\"{}\" ", escape(label));
    Ok(svg.replacen("<svg ", &begin, 1))
}

fn curves<X, Y>(area: &Area<'_>, plot: &Chart, x: X, y: Y) -> Result<(), PlotError>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(&plot.x.name)
        .y_desc(&plot.y.name)
        .x_label_formatter(&|v| figures(*v))
        .y_label_formatter(&|v| figures(*v))
        .light_line_style(WHITE)
        .label_style(("sans-serif", FONT))
        .axis_style(INK)
        .draw()?;
    for curve in &plot.curves {
        let colour = colour(curve.colour);
        let finite = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite();
        match curve.mark {
            Mark::Dots => {
                let points = curve.points.iter().filter(finite);
                chart.draw_series(points.map(|p| Circle::new(*p, 3, colour.filled())))?;
            }
            Mark::Crosses => {
                let points = curve.points.iter().filter(finite);
                chart.draw_series(points.map(|p| Cross::new(*p, 5, colour.stroke_width(2))))?;
            }
            Mark::Line | Mark::Dashed => {
                let width = if curve.mark == Mark::Line { 2 } else { 1 };
                for piece in curve
                    .points
                    .split(|p| !(p.0.is_finite() && p.1.is_finite()))
                {
                    chart.draw_series([PathElement::new(piece, colour.stroke_width(width))])?;
                }
            }
        }
    }
    Ok(())
}

fn linear(axis: &Axis) -> Range<f64> {
    axis.range.0..axis.range.1
}

/// Value of the axis at a share of its length.
fn at(axis: &Axis, share: f64) -> f64 {
    let (from, to) = axis.range;
    if axis.log {
        from * (to / from).powf(share)
    } else {
        from + share * (to - from)
    }
}

fn colour(place: usize) -> RGBColor {
    COLOURS[place % COLOURS.len()]
}

/// From a light yellow through red to a dark violet; monotone in lightness.
fn shade(value: f64, (low, high, _): &(f64, f64, String)) -> RGBColor {
    const STOPS: [(f64, f64, f64); 4] = [
        (252.0, 243.0, 191.0),
        (246.0, 160.0, 80.0),
        (190.0, 50.0, 90.0),
        (45.0, 15.0, 70.0),
    ];
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0) * 3.0;
    let i = (share as usize).min(2);
    let (a, b, part) = (STOPS[i], STOPS[i + 1], share - i as f64);
    let mix = |a: f64, b: f64| (a + part * (b - a)).round() as u8;
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}
