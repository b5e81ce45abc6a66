//! Bars side by side for each of several things, with the interval that each value lies in.

use crate::report::plot::chart::{FONT, WIDTH, colour};
use crate::report::plot::text::{escape, figures, hex};
use crate::report::plot::{GRID, INK};
use std::fmt::Write as _;

// CSS pixels.
const MARGIN: f64 = 10.0;
/// Room for a name above its bars.
const NAME: f64 = 24.0;
const BAR: f64 = 13.0;
const BELOW: f64 = 12.0;
/// Room for a value behind its bar.
const VALUE: f64 = 64.0;

/// A value with half the width of the interval around it.
pub type Measured = (f64, f64);

/// What has bars.
#[derive(Debug, Clone, PartialEq)]
pub struct Thing {
    /// Its name.
    pub name: String,
    /// Its value of each series.
    pub values: Vec<Option<Measured>>,
}

/// Bars from 0 to the right.
#[derive(Debug, Clone, PartialEq)]
pub struct Bars {
    /// What a screen reader says.
    pub label: String,
    /// What each colour is.
    pub series: Vec<String>,
    /// From top to bottom.
    pub things: Vec<Thing>,
    /// The right end is this at least.
    pub least_range: f64,
}

/// Draws them; below 0 there is no bar, only its number.
pub fn bars(plot: &Bars) -> String {
    let values = || {
        (plot
            .things
            .iter()
            .flat_map(|thing| thing.values.iter().flatten()))
        .filter(|of| of.0.is_finite())
    };
    let range = values()
        .map(|(value, error)| value + error)
        .fold(plot.least_range, f64::max);
    let room = f64::from(WIDTH) - 2.0 * MARGIN - VALUE;
    let x = |value: f64| MARGIN + room * (value / range).clamp(0.0, 1.0);
    let thing = NAME + BAR * plot.series.len() as f64 + BELOW;
    let height = MARGIN + thing * plot.things.len() as f64;
    let mut svg = format!(
        "<svg role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {WIDTH} {height}\">\n",
        escape(&plot.label)
    );
    let [ink, grid] = [INK, GRID].map(hex);
    for quarter in 0..=4 {
        let at = x(range * f64::from(quarter) / 4.0);
        let _ = writeln!(svg, "<path d=\"M{at:.1} 0V{height}\" stroke=\"{grid}\"/>");
    }
    for (place, Thing { name, values: all }) in plot.things.iter().enumerate() {
        let top = MARGIN + thing * place as f64;
        let baseline = top + NAME - 7.0;
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN}\" y=\"{baseline}\" font-size=\"{FONT}\" fill=\"{ink}\">{}</text>",
            escape(name)
        );
        for (series, of) in all.iter().enumerate() {
            let Some((value, error)) = of.filter(|(value, _)| value.is_finite()) else {
                continue;
            };
            let y = top + NAME + BAR * series as f64;
            let (end, fill) = (x(value), hex(colour(series)));
            let (wide, middle) = (end - MARGIN, y + BAR / 2.0);
            let _ = writeln!(
                svg,
                "<path d=\"M{MARGIN} {y}h{wide:.1}v{}h-{wide:.1}z\" fill=\"{fill}\"/>",
                BAR - 2.0
            );
            let mut behind = end;
            if error > 0.0 {
                let [from, to] = [value - error, value + error].map(x);
                behind = behind.max(to);
                let _ = writeln!(
                    svg,
                    "<path d=\"M{from:.1} {middle:.1}H{to:.1}M{from:.1} {:.1}v6M{to:.1} {:.1}v6\" stroke=\"{ink}\" fill=\"none\"/>",
                    middle - 3.0,
                    middle - 3.0
                );
            }
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"{ink}\">{}</text>",
                behind + 6.0,
                middle + 3.5,
                figures(value)
            );
        }
    }
    svg.push_str("</svg><ul class=\"legend\">");
    for (i, name) in plot.series.iter().enumerate() {
        let (colour, name) = (hex(colour(i)), escape(name));
        let _ = write!(
            svg,
            "<li><span data-sign=\"■\" style=\"color:{colour}\"></span> {name}</li>"
        );
    }
    svg + "</ul>"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_its_bar_and_none_leaves_the_figure() {
        let svg = bars(&Bars {
            label: "<label>".to_owned(),
            series: vec!["a".to_owned(), "b".to_owned()],
            things: [
                ("<key>", [Some((0.5, 0.1)), Some((-0.1, 0.2))]),
                ("none", [None, Some((f64::NAN, 0.0))]),
                ("large", [Some((4.0, 0.0)), Some((0.0, 0.0))]),
            ]
            .map(|(name, values)| Thing {
                name: name.to_owned(),
                values: values.to_vec(),
            })
            .to_vec(),
            least_range: 1.0,
        });
        assert!(!svg.contains("NaN") && svg.contains("&lt;key&gt;") && !svg.contains("<key>"));
        assert_eq!(svg.matches("z\" fill").count(), 4);
        assert_eq!(svg.matches("v6M").count(), 2);
        // The largest fills the room, a half of a fourth an eighth of it.
        let room = f64::from(WIDTH) - 2.0 * MARGIN - VALUE;
        for wide in [room, room / 8.0] {
            assert!(svg.contains(&format!("h{wide:.1}v")), "{wide}");
        }
    }
}
