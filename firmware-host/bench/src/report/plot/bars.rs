//! Shares as bars, one below the other.

use crate::report::plot::chart::{FONT, WIDTH, colour};
use crate::report::plot::text::{escape, figures, hex};
use crate::report::plot::{GRID, INK};
use std::fmt::Write as _;

// CSS pixels.
const MARGIN: f64 = 10.0;
/// Room for a name above its bar.
const NAME: f64 = 24.0;
const BAR: f64 = 13.0;
const BELOW: f64 = 12.0;
/// Room for a value behind its bar.
const VALUE: f64 = 64.0;

/// A bar from 0 to the right.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bar {
    /// What has the share.
    pub name: String,
    /// The share, up to 1; below 0 there is no bar, only its number.
    pub share: Option<f64>,
}

/// Draws bars from top to bottom; `label` is what a screen reader says.
pub(crate) fn bars(label: &str, bars: &[Bar]) -> String {
    let room = f64::from(WIDTH) - 2.0 * MARGIN - VALUE;
    let x = |share: f64| MARGIN + room * share.clamp(0.0, 1.0);
    let step = NAME + BAR + BELOW;
    let height = MARGIN + step * bars.len() as f64;
    let mut svg = format!(
        "<svg role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {WIDTH} {height}\">\n",
        escape(label)
    );
    let [ink, grid, fill] = [hex(INK), hex(GRID), hex(colour(0))];
    for quarter in 0..=4 {
        let at = x(f64::from(quarter) / 4.0);
        let _ = writeln!(svg, "<path d=\"M{at:.1} 0V{height}\" stroke=\"{grid}\"/>");
    }
    for (place, Bar { name, share }) in bars.iter().enumerate() {
        let y = MARGIN + step * place as f64 + NAME;
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN}\" y=\"{}\" font-size=\"{FONT}\" fill=\"{ink}\">{}</text>",
            y - 7.0,
            escape(name)
        );
        let Some(share) = share.filter(|share| share.is_finite()) else {
            continue;
        };
        let (wide, high) = (x(share) - MARGIN, BAR - 2.0);
        let _ = writeln!(
            svg,
            "<path d=\"M{MARGIN} {y}h{wide:.1}v{high}h-{wide:.1}z\" fill=\"{fill}\"/>"
        );
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" fill=\"{ink}\">{}</text>",
            x(share) + 6.0,
            y + BAR / 2.0 + 3.5,
            figures(share)
        );
    }
    svg + "</svg>"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_share_has_its_bar_and_none_leaves_the_figure() {
        let all = [
            ("<key>", Some(0.5)),
            ("none", None),
            ("nothing", Some(f64::NAN)),
            ("negative", Some(-0.1)),
            ("large", Some(1.5)),
        ];
        let svg = bars(
            "<label>",
            &all.map(|(name, share)| Bar {
                name: name.to_owned(),
                share,
            }),
        );
        assert!(!svg.contains("NaN") && svg.contains("&lt;key&gt;") && !svg.contains("<key>"));
        assert_eq!(svg.matches("z\" fill").count(), 3);
        // The largest fills the room.
        let room = f64::from(WIDTH) - 2.0 * MARGIN - VALUE;
        for wide in [room, room / 2.0, 0.0] {
            assert!(svg.contains(&format!("h{wide:.1}v")), "{wide}");
        }
    }
}
