//! Maps of outcomes over two keys.

use crate::report::listing::Listing;
use crate::report::markup::Markup;
use crate::report::plot::PlotError;
use crate::report::plot::chart::{Axis, Chart, Curve, HeatMap, Mark, chart, heat_map};
use crate::report::plot::text::figures;
use crate::report::rendered::Rendered;
use crate::run::outcome::Outcome;
use crate::sweep::map::{MapAxis, OutcomeMap, Places};

/// Room around runs that are shown one by one, as a share of an axis.
const ROOM: f64 = 0.02;

pub(super) fn map(map: &OutcomeMap) -> Result<Rendered, PlotError> {
    let OutcomeMap {
        policy, x, y, dots, ..
    } = map;
    let name = format!("{policy}: {} and {}", x.key, y.key);
    let drawing = match dots {
        Some(dots) => chart(&Chart {
            label: format!("Outcomes under {policy} over {} and {}", x.key, y.key),
            x: axis(x, ROOM),
            y: axis(y, ROOM),
            curves: by_outcome(dots),
        })?,
        None => heat_map(&HeatMap {
            label: format!(
                "Share of runs lost under {policy} over {} and {}",
                x.key, y.key
            ),
            x: axis(x, 0.0),
            y: axis(y, 0.0),
            names: [x, y].map(|axis| names(axis).unwrap_or_default()),
            cells: (map.cells.iter())
                .map(|row| {
                    (row.iter())
                        .map(|cell| f64::from(cell.lost) / f64::from(cell.runs))
                        .collect()
                })
                .collect(),
            scale: (0.0, 1.0, "share lost".to_owned()),
        })?,
    };
    Ok(Rendered::new(&name, drawing, counted(map)))
}

/// Those that are lost as crosses, on top.
fn by_outcome(dots: &[(f64, f64, Outcome)]) -> Vec<Curve> {
    let curve = |(colour, outcome): (usize, Outcome)| {
        let points = dots.iter().filter(|dot| dot.2 == outcome);
        let points: Vec<(f64, f64)> = points.map(|dot| (dot.0, dot.1)).collect();
        let count = points.len();
        (count > 0).then(|| Curve {
            name: format!("{} ({count})", outcome.name()),
            points,
            mark: match outcome.recovered() {
                true => Mark::Dots,
                false => Mark::Crosses,
            },
            colour,
        })
    };
    // Blue and green for what is back, warm colours for the rest.
    let colours = [0, 2, 7, 5, 4, 1, 8, 3];
    (colours.into_iter().zip(Outcome::ALL))
        .filter_map(curve)
        .collect()
}

fn names(axis: &MapAxis) -> Option<Vec<String>> {
    match &axis.places {
        Places::Named(names) => Some(names.iter().map(|(name, _)| name.clone()).collect()),
        Places::Parts { .. } => None,
    }
}

/// With some room at both ends, as a share of the whole.
fn axis(of: &MapAxis, room: f64) -> Axis {
    match of.places {
        Places::Named(ref names) => Axis::linear(&of.key, (0.0, names.len() as f64)),
        Places::Parts {
            low,
            high,
            log: false,
            ..
        } => {
            let room = room * (high - low);
            Axis::linear(&of.key, (low - room, high + room))
        }
        Places::Parts { low, high, .. } => {
            let room = (high / low).powf(room);
            Axis::log(&of.key, (low / room, high * room))
        }
    }
}

/// Cells as numbers, the top row first as in the drawing.
fn counted(map: &OutcomeMap) -> Listing {
    let place = |axis: &MapAxis, at: usize| match names(axis) {
        Some(names) => names.get(at).cloned().unwrap_or_default(),
        None => {
            let [from, to] = [at, at + 1].map(|part| figures(axis.places.edge(part)));
            format!("{from} to {to}")
        }
    };
    let mut headings = vec![Markup::with_unit(&map.y.key, &map.x.key)];
    headings.extend((0..map.x.places.count()).map(|at| Markup::text(place(&map.x, at))));
    let rows = map.cells.iter().enumerate().rev().map(|(at, cells)| {
        let mut row = vec![Markup::text(place(&map.y, at))];
        row.extend(cells.iter().map(|cell| {
            Markup::text(match cell.runs {
                0 => "–".to_owned(),
                runs => format!("{} of {runs}", cell.lost),
            })
        }));
        row
    });
    Listing {
        caption: format!("Lost runs under {}", map.policy),
        headings,
        rows: rows.collect(),
        ..Listing::default()
    }
}
