//! Drawing primitives: lines over time, orbits and strips, each one an inline SVG.
//!
//! The canvas has `SCALE` units per CSS pixel, because the backend rounds to whole units; the browser
//! scales it back. All figures have one width and the same margins, so that time axes line up.

pub mod bars;
pub mod chart;
pub mod text;
pub(crate) mod thin;

use std::io;

use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::types::RangedCoordf64;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, RGBColor, TextStyle};

use crate::report::plot::text::{escape, number};
use crate::report::plot::thin::{Band, Interval, PathPoint, one_band_a_column, trail};

/// Why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// The drawing backend refused.
    #[error("a figure could not be drawn: {0}")]
    Draw(#[from] DrawingAreaErrorKind<io::Error>),
}

/// Canvas units per CSS pixel.
const SCALE: u32 = 3;
// CSS pixels.
const WIDTH: u32 = 420;
const LEFT: u32 = 62;
const RIGHT: u32 = 26;
const TOP: u32 = 6;
const BOTTOM: u32 = 20;
/// Room for a description under the numbers of the x axis.
const DESCRIPTION: u32 = 14;
/// Height of the plotting area of a time plot.
const HEIGHT: u32 = 124;
/// Height of a strip.
const LANE: u32 = 17;
/// Width of the plotting area \[CSS px\].
const PLOT: u32 = WIDTH - LEFT - RIGHT;
/// Two columns per CSS pixel, for screens that have them.
pub(crate) const COLUMNS: usize = 2 * PLOT as usize;
/// What the path of one orbit may take \[bytes of SVG\].
const ORBIT_BYTES: usize = 120_000;
/// The backend divides by 1.24 what it is given; this comes out as 10.5 CSS pixels.
const FONT: u32 = 39;

const INK: RGBColor = RGBColor(0x3b, 0x44, 0x4f);
const GRID: RGBColor = RGBColor(0xe6, 0xe9, 0xed);
const SHADE: RGBColor = RGBColor(0xff, 0xf1, 0xcc);
/// Colour of limits: clearance, force cap, whirl limit.
pub(crate) const LIMIT: RGBColor = RGBColor(0x8a, 0x1c, 0x1c);
/// Colour of motion without contact.
pub(crate) const FREE: RGBColor = RGBColor(0x4f, 0x77, 0xa3);
/// Colour of motion in contact.
pub(crate) const TOUCHING: RGBColor = RGBColor(0xdd, 0x5a, 0x0b);

/// A line of a [`TimePlot`].
pub(crate) struct Line {
    /// (time, value), in time order.
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) colour: RGBColor,
}

/// The time axis of a figure.
#[derive(Clone, Copy)]
pub(crate) struct TimeAxis<'a> {
    /// What it spans.
    pub(crate) window: Interval,
    /// Name of the unit of times.
    pub(crate) unit: &'static str,
    /// Intervals to shade.
    pub(crate) shaded: &'a [Interval],
}

/// Lines over time.
pub(crate) struct TimePlot<'a> {
    /// What a screen reader says.
    pub(crate) label: &'a str,
    pub(crate) time: TimeAxis<'a>,
    pub(crate) y: Interval,
    pub(crate) y_name: &'a str,
    pub(crate) lines: &'a [Line],
    /// Drawn dashed; left out where it is off the axis.
    pub(crate) limit: Option<f64>,
}

/// An ellipse about the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wall {
    pub(crate) semi_axes: [f64; 2],
    /// Direction of the first \[rad\].
    pub(crate) tilt_rad: f64,
}

impl Wall {
    /// Where nothing is known of one.
    pub(crate) const NONE: Self = Self {
        semi_axes: [0.0; 2],
        tilt_rad: 0.0,
    };
}

/// A path in the plane with equal axes and the wall about the centre.
pub(crate) struct OrbitPlot<'a> {
    /// What a screen reader says.
    pub(crate) label: &'a str,
    /// Both axes span ± this.
    pub(crate) reach: f64,
    /// Name of the unit of lengths.
    pub(crate) unit: &'static str,
    pub(crate) wall: Wall,
    /// In time order.
    pub(crate) path: &'a [PathPoint],
}

/// One strip of coloured bands.
pub(crate) struct Lane<'a> {
    pub(crate) name: &'a str,
    /// Name and colour of every class.
    pub(crate) classes: &'a [(&'static str, RGBColor)],
    pub(crate) bands: &'a [Band],
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'c, 'a> = ChartContext<'c, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Draws lines over time.
pub(crate) fn time_plot(plot: &TimePlot<'_>) -> Result<String, PlotError> {
    svg(plot.label, TOP + HEIGHT + BOTTOM, |root| {
        let mut chart = chart(root, plot.time.window, plot.y, BOTTOM)?;
        shade(&mut chart, plot.time, plot.y)?;
        let unit = format!(" {}", plot.time.unit);
        let x = (plot.time.window, &unit[..], "");
        mesh(&mut chart, x, Some((plot.y, plot.y_name)))?;
        if let Some(limit) = plot.limit.filter(|at| plot.y.contains(*at)) {
            dashed(&mut chart, plot.time.window, limit)?;
        }
        for line in plot.lines {
            let style = line.colour.stroke_width(4);
            chart.draw_series([PathElement::new(line.points.clone(), style)])?;
        }
        Ok(())
    })
}

/// Draws an orbit; contact in another colour than flight.
pub(crate) fn orbit_plot(plot: &OrbitPlot<'_>) -> Result<String, PlotError> {
    let axis = Interval::symmetric(plot.reach);
    let bottom = BOTTOM + DESCRIPTION;
    svg(plot.label, TOP + PLOT + bottom, |root| {
        let mut chart = chart(root, axis, axis, bottom)?;
        let [x_name, y_name] = ["x", "y"].map(|name| format!("{name} / {}", plot.unit));
        mesh(&mut chart, (axis, "", &x_name), Some((axis, &y_name)))?;
        let [a, b] = plot.wall.semi_axes;
        let (turn_sin, turn_cos) = plot.wall.tilt_rad.sin_cos();
        let wall = (0..=120).map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 120.0).sin_cos();
            let (x, y) = (a * cos, b * sin);
            (turn_cos * x - turn_sin * y, turn_sin * x + turn_cos * y)
        });
        chart.draw_series([PathElement::new(
            wall.collect::<Vec<_>>(),
            LIMIT.stroke_width(4),
        )])?;
        let stretches = trail(plot.path, plot.reach, f64::from(PLOT), ORBIT_BYTES);
        // Contact last, on top.
        for touching in [false, true] {
            let style = if touching {
                TOUCHING.stroke_width(5)
            } else {
                FREE.stroke_width(3)
            };
            let of_kind = stretches.iter().filter(|s| s.touching == touching);
            chart.draw_series(of_kind.map(|s| PathElement::new(s.points.clone(), style)))?;
        }
        let start = plot.path.first().map(|p| ((p.0, p.1), INK.stroke_width(4)));
        let end = plot.path.last().map(|p| ((p.0, p.1), INK.filled()));
        let marks = [start, end].into_iter().flatten();
        chart.draw_series(marks.map(|(at, style)| Circle::new(at, 3 * SCALE, style)))?;
        Ok(())
    })
}

/// Draws strips of coloured bands over time, the first one on top.
pub(crate) fn strip_plot(
    label: &str,
    time: TimeAxis<'_>,
    lanes: &[Lane<'_>],
) -> Result<String, PlotError> {
    let count = u32::try_from(lanes.len()).unwrap_or(1).max(1);
    let y = Interval {
        lo: 0.0,
        hi: f64::from(count),
    };
    svg(label, TOP + LANE * count + BOTTOM, |root| {
        let mut chart = chart(root, time.window, y, BOTTOM)?;
        shade(&mut chart, time, y)?;
        let unit = format!(" {}", time.unit);
        mesh(&mut chart, (time.window, &unit, ""), None)?;
        for (lane, top) in lanes.iter().zip((1..=count).rev()) {
            let middle = (TOP + LANE * (count - top) + LANE / 2) * SCALE;
            let style = lettering(INK, HPos::Right);
            let at = (((LEFT - 4) * SCALE).cast_signed(), middle.cast_signed());
            root.draw(&Text::new(lane.name, at, style))?;
            draw_lane(&mut chart, lane, time.window, f64::from(top))?;
        }
        Ok(())
    })
}

fn draw_lane(
    chart: &mut Chart<'_, '_>,
    lane: &Lane<'_>,
    window: Interval,
    top: f64,
) -> Result<(), PlotError> {
    let bands = one_band_a_column(lane.bands, window, COLUMNS);
    let pixels = f64::from(PLOT) / window.size();
    for band in bands {
        let Some(&(name, colour)) = lane.classes.get(band.class) else {
            continue;
        };
        let corners = [(band.span.lo, top - 0.06), (band.span.hi, top - 0.94)];
        chart.draw_series([Rectangle::new(corners, colour.filled())])?;
        // An average glyph is about 6 pixels wide.
        if band.span.size() * pixels > 6.0 * name.len() as f64 + 6.0 {
            let middle = (band.span.middle(), top - 0.5);
            let style = lettering(readable_on(colour), HPos::Center);
            chart.draw_series([Text::new(name, middle, style)])?;
        }
    }
    Ok(())
}

fn svg(
    label: &str,
    height: u32,
    draw: impl FnOnce(&Area<'_>) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut drawn = String::new();
    {
        let size = (WIDTH * SCALE, height * SCALE);
        let root = SVGBackend::with_string(&mut drawn, size).into_drawing_area();
        draw(&root)?;
        root.present()?;
    }
    // The backend's opening tag has a fixed size and no role.
    let body = drawn.split_once('>').map_or("", |(_, body)| body);
    let (width, height) = (WIDTH * SCALE, height * SCALE);
    let label = escape(label);
    Ok(format!(
        r#"<svg viewBox="0 0 {width} {height}" role="img" aria-label="{label}">{body}"#
    ))
}

/// A figure as a file of its own, on paper of its own.
pub(crate) fn alone(svg: &str) -> String {
    let paper = "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>";
    let of_its_own = svg.replacen("<svg ", "<svg xmlns=\"http://www.w3.org/2000/svg\" ", 1);
    of_its_own.replacen('>', &format!(">\n{paper}"), 1)
}

fn chart<'c, 'a>(
    root: &'c Area<'a>,
    x: Interval,
    y: Interval,
    bottom: u32,
) -> Result<Chart<'c, 'a>, PlotError> {
    Ok(ChartBuilder::on(root)
        .margin_top(TOP * SCALE)
        .margin_right(RIGHT * SCALE)
        .x_label_area_size(bottom * SCALE)
        .y_label_area_size(LEFT * SCALE)
        .build_cartesian_2d(x.lo..x.hi, y.lo..y.hi)?)
}

/// Grid, numbers and names of the axes. Without a `y` the vertical axis stays bare.
fn mesh(
    chart: &mut Chart<'_, '_>,
    (x, x_unit, x_name): (Interval, &str, &str),
    y: Option<(Interval, &str)>,
) -> Result<(), PlotError> {
    let style = lettering(INK, HPos::Center);
    let bare = y.is_none();
    let (y, y_name) = y.unwrap_or((x, ""));
    let (format_x, format_y) = (|v: &f64| number(*v, x) + x_unit, |v: &f64| number(*v, y));
    let mut mesh = chart.configure_mesh();
    mesh.max_light_lines(0)
        .bold_line_style(GRID.stroke_width(SCALE))
        .axis_style(INK.mix(0.5).stroke_width(SCALE))
        .label_style(style.clone())
        .axis_desc_style(style)
        .set_all_tick_mark_size(3 * SCALE)
        .x_labels(7)
        .y_labels(7)
        .x_label_formatter(&format_x)
        .y_label_formatter(&format_y)
        .x_desc(x_name)
        .y_desc(y_name);
    if bare {
        mesh.disable_y_mesh().disable_y_axis().y_labels(0);
    }
    mesh.draw()?;
    Ok(())
}

fn shade(chart: &mut Chart<'_, '_>, time: TimeAxis<'_>, y: Interval) -> Result<(), PlotError> {
    // Wide enough to be seen, however short.
    let least = time.window.size() / f64::from(PLOT);
    let visible = time
        .shaded
        .iter()
        .filter_map(|span| span.within(time.window));
    let boxes = visible.map(|span| {
        let end = span.hi.max(span.lo + least).min(time.window.hi);
        Rectangle::new([(span.lo, y.lo), (end, y.hi)], SHADE.filled())
    });
    chart.draw_series(boxes)?;
    Ok(())
}

fn dashed(chart: &mut Chart<'_, '_>, x: Interval, level: f64) -> Result<(), PlotError> {
    let dash = x.size() / 80.0;
    let dashes = (0..40).map(|i| {
        let begin = x.lo + 2.0 * f64::from(i) * dash;
        PathElement::new(
            [(begin, level), (begin + dash, level)],
            LIMIT.stroke_width(4),
        )
    });
    chart.draw_series(dashes)?;
    Ok(())
}

fn lettering(colour: RGBColor, side: HPos) -> TextStyle<'static> {
    TextStyle {
        font: ("sans-serif", FONT).into_font(),
        color: colour.to_backend_color(),
        pos: Pos::new(side, VPos::Center),
    }
}

/// Black or white, whichever stands out.
fn readable_on(colour: RGBColor) -> RGBColor {
    let light =
        0.30 * f64::from(colour.0) + 0.59 * f64::from(colour.1) + 0.11 * f64::from(colour.2);
    if light > 140.0 {
        INK
    } else {
        RGBColor(0xff, 0xff, 0xff)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Interval = Interval { lo: 0.0, hi: 1.0 };

    #[test]
    fn a_figure_is_accessible_and_has_no_fixed_size() {
        let time = TimeAxis {
            window: UNIT,
            unit: "ms",
            shaded: &[UNIT],
        };
        let points = vec![(0.0, 0.0), (1.0, 1.0)];
        let svg = time_plot(&TimePlot {
            label: "a \"quoted\" name",
            time,
            y: UNIT,
            y_name: "y",
            lines: &[Line {
                points,
                colour: FREE,
            }],
            limit: Some(0.5),
        })
        .unwrap();
        assert!(svg.starts_with("<svg viewBox=\"0 0 1260 "));
        assert!(svg.contains("role=\"img\" aria-label=\"a &quot;quoted&quot; name\">"));
        assert!(svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn an_orbit_without_extent_is_drawn() {
        let plot = |path| OrbitPlot {
            label: "",
            reach: 0.0,
            unit: "mm",
            wall: Wall::NONE,
            path,
        };
        assert!(orbit_plot(&plot(&[])).is_ok());
        let svg = orbit_plot(&plot(&[(0.0, 0.0, true), (0.0, 0.0, false)])).unwrap();
        assert!(!svg.contains("NaN"));
    }
}
