//! Curves over an axis and values over a plane, with named axes, legend and measured points.

use crate::report::plot::text::{escape, figures, hex};
use crate::report::plot::{INK, PlotError};
use plotters::backend::SVGBackend;
use plotters::chart::ChartBuilder;
use plotters::coord::Shift;
use plotters::coord::combinators::IntoLogRange;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Cross, PathElement};
use plotters::prelude::Ranged;
use plotters::style::{Color, RGBColor, WHITE};
use std::collections::BTreeMap;
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

impl Axis {
    pub fn linear(name: &str, range: (f64, f64)) -> Self {
        let (name, log) = (name.to_owned(), false);
        Self { name, range, log }
    }

    /// A logarithmic one.
    pub fn log(name: &str, range: (f64, f64)) -> Self {
        Self {
            log: true,
            ..Self::linear(name, range)
        }
    }

    /// Value at a share of its length.
    pub(in crate::report) fn at(&self, share: f64) -> f64 {
        let (from, to) = self.range;
        match self.log {
            true => from * (to / from).powf(share),
            false => from + (to - from) * share,
        }
    }
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    Line,
    /// A dashed line: closed forms and limits.
    Dashed,
    /// Dots: single runs.
    Dots,
    /// Crosses: what the paper measured.
    Crosses,
    /// The curve's name, written at its points; not in the legend.
    Name,
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
    /// Place among nine colours.
    pub colour: usize,
}

impl Curve {
    pub fn line(name: String, points: Vec<(f64, f64)>, colour: usize) -> Self {
        Self {
            name,
            points,
            mark: Mark::Line,
            colour,
        }
    }
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
    /// Names of the columns, and of the rows, in the place of numbers; of an axis without names none.
    pub names: [Vec<String>; 2],
    /// Rows from bottom to top, cells from left to right; not finite is left white.
    pub cells: Vec<Vec<f64>>,
    /// Values of the lightest and the darkest colour, and what the value is.
    pub scale: (f64, f64, String),
}

/// Colours that can be told apart, also without red and green.
const COLOURS: [RGBColor; 9] = [
    RGBColor(0x1f, 0x5f, 0x99),
    RGBColor(0xdd, 0x5a, 0x0b),
    RGBColor(0x2a, 0x8a, 0x6a),
    RGBColor(0x8a, 0x1c, 0x1c),
    RGBColor(0x7a, 0x4f, 0xa3),
    RGBColor(0x6b, 0x74, 0x7f),
    RGBColor(0x3f, 0xa9, 0xd5),
    RGBColor(0xb8, 0x92, 0x00),
    RGBColor(0xd0, 0x5c, 0xa0),
];

// CSS pixels.
pub(super) const WIDTH: u32 = 680;
const HEIGHT: u32 = 380;
pub(super) const FONT: u32 = 17;
/// Room for a letter of it.
const LETTER: u32 = 9;
/// Room for half of the last number of the x axis.
const RIGHT: u32 = 24;

/// Draws curves.
pub fn chart(plot: &Chart) -> Result<String, PlotError> {
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
            Mark::Name => continue,
        };
        let colour = hex(colour(curve.colour));
        let name = escape(&curve.name);
        let _ = write!(
            legend,
            "<li><span data-sign=\"{sign}\" style=\"color:{colour}\"></span> {name}</li>"
        );
    }
    legend.push_str("</ul>");
    Ok(svg(&plot.label, draw)? + &legend)
}

/// Draws a map.
pub(crate) fn heat_map(plot: &HeatMap) -> Result<String, PlotError> {
    let picture = svg(&plot.label, |area| {
        // Cells are laid out evenly; a logarithmic axis says what their places mean, names stand in their middles.
        let [columns, rows] = &plot.names;
        let range = |axis: &Axis, names: &[String]| match (names.len(), axis.log) {
            (0, false) => linear(axis),
            (0, true) => 0.0..1.0,
            (count, _) => -0.5..count as f64 - 0.5,
        };
        let label = |axis: &Axis, names: &[String], place: f64| match (names.len(), axis.log) {
            (0, false) => figures(place),
            (0, true) => figures(axis.at(place)),
            // Between two names.
            _ if place.fract() != 0.0 => String::new(),
            _ => names.get(place as usize).cloned().unwrap_or_default(),
        };
        let names = [columns, rows]
            .map(|names| names.iter().map(|name| shortened(name)).collect::<Vec<_>>());
        let widest = |names: &[String]| names.iter().map(|name| name.chars().count()).max();
        let [columns, rows] = &names;
        // A mark a name, as far as there is room for them beside each other.
        let room = (WIDTH - 120) as usize / (LETTER as usize * (widest(columns).unwrap_or(0) + 1));
        let marks = |names: &[String], most: usize| match names.len() {
            0 => 6,
            _ => most.clamp(2, 25),
        };
        let beside = widest(rows).map_or(70, |letters| LETTER * letters as u32 + 34);
        let mut chart = ChartBuilder::on(area)
            .margin(10)
            .margin_right(RIGHT)
            .x_label_area_size(44)
            .y_label_area_size(beside)
            .build_cartesian_2d(range(&plot.x, columns), range(&plot.y, rows))?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc(&plot.x.name)
            .y_desc(&plot.y.name)
            .x_labels(marks(columns, room))
            .y_labels(marks(rows, 2 * rows.len()))
            .x_label_formatter(&|place| label(&plot.x, columns, *place))
            .y_label_formatter(&|place| label(&plot.y, rows, *place))
            .label_style(("sans-serif", FONT))
            .axis_style(INK)
            .draw()?;
        Ok(cells(plot, &chart.plotting_area().get_pixel_range()))
    })?;
    let (low, high, name) = &plot.scale;
    let mut legend = format!("<ul class=\"legend\"><li>{}:</li>", escape(name));
    for third in 0..=3 {
        let value = low + (high - low) * f64::from(third) / 3.0;
        let (colour, value) = (hex(shade(value, &plot.scale)), figures(value));
        let _ = write!(
            legend,
            "<li><span data-sign=\"■\" style=\"color:{colour}\"></span> {value}</li>"
        );
    }
    legend.push_str("</ul>");
    Ok(picture + &legend)
}

/// What there is room for beside an axis.
fn shortened(name: &str) -> String {
    match name.char_indices().nth(8) {
        Some((end, _)) if name.chars().count() > 9 => format!("{}…", &name[..end]),
        _ => name.to_owned(),
    }
}

/// The cells, one path a colour and one rectangle for each run of it: a rectangle a cell would make pages of
/// many megabytes.
fn cells(plot: &HeatMap, (x, y): &(Range<i32>, Range<i32>)) -> String {
    let mut paths: BTreeMap<String, String> = BTreeMap::new();
    // Whole pixels, or the seams between cells would show.
    let edge = |from: i32, to: i32, i: usize, n: usize| {
        from + (f64::from(to - from) * i as f64 / n as f64).round() as i32
    };
    for (j, row) in plot.cells.iter().enumerate() {
        let [low, high] = [j, j + 1].map(|j| edge(y.end, y.start, j, plot.cells.len()));
        let colours: Vec<Option<String>> = (row.iter())
            .map(|v| v.is_finite().then(|| hex(shade(*v, &plot.scale))))
            .collect();
        let mut from = 0;
        for run in colours.chunk_by(|a, b| a == b) {
            let [left, right] =
                [from, from + run.len()].map(|i| edge(x.start, x.end, i, row.len()));
            from += run.len();
            if let Some(Some(colour)) = run.first() {
                let path = paths.entry(colour.clone()).or_default();
                let (wide, tall) = (right - left, low - high);
                let _ = write!(path, "M{left} {high}h{wide}v{tall}h-{wide}z");
            }
        }
    }
    let mut out = String::from("<g shape-rendering=\"crispEdges\">\n");
    for (colour, path) in paths {
        let _ = writeln!(out, "<path fill=\"{colour}\" d=\"{path}\"/>");
    }
    out + "</g>\n"
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A drawing; what `draw` returns is laid over it.
fn svg(
    label: &str,
    draw: impl FnOnce(&Area<'_>) -> Result<String, PlotError>,
) -> Result<String, PlotError> {
    let mut svg = String::new();
    let over = {
        let area = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT)).into_drawing_area();
        area.fill(&WHITE)?;
        let over = draw(&area)?;
        area.present()?;
        over
    };
    let begin = format!("<svg role=\"img\" aria-label=\"{}\" ", escape(label));
    let end = format!("{over}</svg>");
    Ok(svg.replacen("<svg ", &begin, 1).replacen("</svg>", &end, 1))
}

/// Draws the curves; returns what the backend has no element for.
fn curves<X, Y>(area: &Area<'_>, plot: &Chart, x: X, y: Y) -> Result<String, PlotError>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .margin_right(RIGHT)
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
    let mut over = String::new();
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
            Mark::Name => {
                for point in curve.points.iter().filter(finite) {
                    let (x, y) = chart.backend_coord(point);
                    let (colour, name) = (hex(colour), escape(&curve.name));
                    let _ = writeln!(
                        over,
                        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\" font-size=\"12\" \
                         font-weight=\"bold\" fill=\"{colour}\">{name}</text>"
                    );
                }
            }
            Mark::Line | Mark::Dashed => {
                let pieces = (curve.points).split(|p| !(p.0.is_finite() && p.1.is_finite()));
                for piece in pieces.filter(|piece| !piece.is_empty()) {
                    if curve.mark == Mark::Line {
                        chart.draw_series([PathElement::new(piece, colour.stroke_width(2))])?;
                        continue;
                    }
                    let _ = write!(
                        over,
                        "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" \
                         stroke-dasharray=\"6 4\" points=\"",
                        hex(colour)
                    );
                    for point in piece {
                        let (x, y) = chart.backend_coord(point);
                        let _ = write!(over, "{x},{y} ");
                    }
                    over.push_str("\"/>\n");
                }
            }
        }
    }
    Ok(over)
}

fn linear(axis: &Axis) -> Range<f64> {
    axis.range.0..axis.range.1
}

pub(super) fn colour(place: usize) -> RGBColor {
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
    // In 36 steps, so that neighbours share colours; whole numbers from 1 to 10 stay apart.
    let share = (((value - low) / (high - low)).clamp(0.0, 1.0) * 36.0).round() / 12.0;
    let i = (share as usize).min(2);
    let (a, b, part) = (STOPS[i], STOPS[i + 1], share - i as f64);
    let mix = |a: f64, b: f64| (a + part * (b - a)).round() as u8;
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}
