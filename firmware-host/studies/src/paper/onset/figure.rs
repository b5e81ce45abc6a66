//! The chart of the five configurations, as Fig. 3.

use super::Configuration;
use crate::paper::{Axis, Chart, Curve, Drawing, Figure, Mark};

pub(super) fn figure(five: &[Configuration; 5], values: &[[f64; 3]]) -> Figure {
    let place = |i: usize| (i + 1) as f64;
    let curve = |name: &str, mark, colour, points: Vec<(f64, f64)>| Curve {
        name: name.to_owned(),
        points,
        mark,
        colour,
    };
    let intervals = values.iter().enumerate().flat_map(|(i, [_, slow, fast])| {
        let x = place(i) + 0.08;
        [(x, *fast), (x, *slow), (f64::NAN, f64::NAN)]
    });
    let names: Vec<String> = (five.iter().enumerate())
        .map(|(i, c)| format!("{} {}", i + 1, c.name))
        .collect();
    let top = values.iter().map(|v| v[1]).fold(0.0, f64::max);
    Figure {
        file: "onset_configurations",
        caption: format!(
            "Critical impact speed of the five configurations, as in Fig. 3: {}. Intervals from μ ± 25 %. \
             Fitted: 1 (restitution) and 5 (μ).",
            names.join(", ")
        ),
        drawing: Drawing::Chart(Chart {
            label: "Critical radial impact speed, measured and computed".to_owned(),
            x: Axis {
                name: "Configuration".to_owned(),
                range: (0.5, 5.5),
                log: false,
            },
            y: Axis {
                name: "v_r,crit [m/s]".to_owned(),
                range: (0.0, 1.1 * top),
                log: false,
            },
            curves: (five.iter().enumerate())
                .map(|(i, c)| curve(c.name, Mark::Name, 5, vec![(place(i), 1.04 * top)]))
                .chain([
                    curve("μ ± 25 %", Mark::Line, 0, intervals.collect()),
                    curve(
                        "measured (paper)",
                        Mark::Crosses,
                        1,
                        (five.iter().enumerate())
                            .map(|(i, c)| (place(i) - 0.08, c.measured_m_s))
                            .collect(),
                    ),
                    curve(
                        "computed",
                        Mark::Dots,
                        0,
                        (values.iter().enumerate())
                            .map(|(i, v)| (place(i) + 0.08, v[0]))
                            .collect(),
                    ),
                ])
                .collect(),
        }),
    }
}
