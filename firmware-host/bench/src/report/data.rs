//! What a figure shows, as a table for those who cannot see it or want its numbers.

use super::listing::{Column, Listing};
use super::markup::Markup;
use super::quantities::Chart;
use super::track::Track;
use crate::report::plot::Lane;
use crate::report::plot::text::figures;
use crate::report::plot::thin::{Interval, one_band_a_column};

/// Rows of a table at most.
const ROWS: usize = 16;

/// Lowest and highest of each line in equal parts of the window.
pub(super) fn extremes(chart: &Chart, track: &Track, window: Interval) -> Listing {
    let lines: Vec<_> = chart.lines_of(track).collect();
    let mut headings = vec![Markup::with_unit("from", track.units.time)];
    for (line, _) in &lines {
        let name = &line.column;
        headings.extend(["lowest", "highest"].map(|end| Markup::text(format!("{name}, {end}"))));
    }
    let part = window.size() / ROWS as f64;
    let rows = (0..ROWS).filter_map(|row| {
        let lo = window.lo + part * row as f64;
        let within = |t: f64| t >= lo && (t < lo + part || row + 1 == ROWS);
        let of = |values: &[f64]| {
            let pairs = track.t.iter().zip(values);
            Interval::of(pairs.filter(|(t, _)| within(**t)).map(|(_, value)| *value))
        };
        let found: Vec<_> = lines.iter().map(|(_, values)| of(values)).collect();
        let cells = found.iter().flat_map(|range| {
            let shown =
                |of: fn(Interval) -> f64| range.map_or("–".to_owned(), |r| figures(of(r)));
            [shown(|r| r.lo), shown(|r| r.hi)]
        });
        let row = std::iter::once(figures(lo)).chain(cells);
        let row = row.map(Markup::text).collect();
        (found.iter().any(Option::is_some)).then_some(row)
    });
    Listing {
        caption: format!("Extremes: {}", chart.y_name(track)),
        headings,
        rows: rows.collect(),
        ..Listing::default()
    }
}

/// Where the rotor was at equal times.
pub(super) fn places(track: &Track, window: Interval) -> Listing {
    let [Some(x), Some(y)] = ["x", "y"].map(|name| track.column(name)) else {
        return Listing::default();
    };
    let (time, length) = (track.units.time, track.units.length);
    let headings = [("at", time), ("x", length), ("y", length)];
    let rows = (0..=ROWS).filter_map(|row| {
        let at = window.lo + window.size() * row as f64 / ROWS as f64;
        let i = track.t.partition_point(|t| *t < at);
        let i = i.min(track.t.len().checked_sub(1)?);
        let row = [track.t[i], x[i], y[i]].map(|value| Markup::text(figures(value)));
        Some(row.to_vec())
    });
    Listing {
        caption: "Places at equal times".to_owned(),
        headings: headings
            .map(|(name, unit)| Markup::with_unit(name, unit))
            .to_vec(),
        rows: rows.collect(),
        ..Listing::default()
    }
}

/// Stretches of each lane; those that are shorter than a 200th of the window share their row.
pub(super) fn stretches(lanes: &[Lane<'_>], window: Interval, time: &str) -> Listing {
    const COLUMNS: usize = 200;
    let headings = [("lane", ""), ("from", time), ("to", time), ("mode", "")];
    let mut rows = Vec::new();
    for lane in lanes {
        let bands = one_band_a_column(lane.bands, window, COLUMNS);
        let left_out = bands.len().saturating_sub(2 * ROWS);
        for band in bands.iter().take(2 * ROWS) {
            let name = lane.classes.get(band.class).map_or("", |class| class.0);
            rows.push(vec![
                lane.name.to_owned(),
                figures(band.span.lo),
                figures(band.span.hi),
                name.to_owned(),
            ]);
        }
        if left_out > 0 {
            let more = format!("{left_out} more");
            rows.push(vec![
                lane.name.to_owned(),
                more,
                String::new(),
                String::new(),
            ]);
        }
    }
    let columns = [
        Column::Words,
        Column::Numbers,
        Column::Numbers,
        Column::Words,
    ];
    Listing {
        columns: columns.to_vec(),
        headings: headings
            .map(|(name, unit)| Markup::with_unit(name, unit))
            .to_vec(),
        ..Listing::of_texts("Stretches", [""; 0], rows)
    }
}
