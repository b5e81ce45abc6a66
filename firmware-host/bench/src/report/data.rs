//! What a figure shows, as a table for those who cannot see it or want its numbers.

use super::push;
use super::quantities::Chart;
use super::track::Track;
use crate::report::plot::Lane;
use crate::report::plot::text::{escape, figures};
use crate::report::plot::thin::{Interval, one_band_a_column};

/// Rows of a table at most.
const ROWS: usize = 16;

/// Lowest and highest of each line in equal parts of the window.
pub(super) fn extremes(chart: &Chart, track: &Track, window: Interval) -> String {
    let lines: Vec<_> = chart.lines_of(track).collect();
    let mut headings = vec![format!("from <small>{}</small>", track.units.time)];
    for (line, _) in &lines {
        let name = escape(&line.column);
        headings.push(format!("{name}, lowest"));
        headings.push(format!("{name}, highest"));
    }
    let part = window.size() / ROWS as f64;
    let mut rows = (0..ROWS).filter_map(|row| {
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
        let row = std::iter::once(figures(lo)).chain(cells).collect();
        (found.iter().any(Option::is_some)).then_some(row)
    });
    let caption = format!("Extremes: {}", escape(&chart.y_name(track)));
    folded(&caption, &headings, &mut rows)
}

/// Where the rotor was at equal times.
pub(super) fn places(track: &Track, window: Interval) -> String {
    let [Some(x), Some(y)] = ["x", "y"].map(|name| track.column(name)) else {
        return String::new();
    };
    let (time, length) = (track.units.time, track.units.length);
    let headings = [
        format!("at <small>{time}</small>"),
        format!("x <small>{length}</small>"),
        format!("y <small>{length}</small>"),
    ];
    let mut rows = (0..=ROWS).filter_map(|row| {
        let at = window.lo + window.size() * row as f64 / ROWS as f64;
        let i = track.t.partition_point(|t| *t < at);
        let i = i.min(track.t.len().checked_sub(1)?);
        Some([track.t[i], x[i], y[i]].map(figures).to_vec())
    });
    folded("Places at equal times", &headings, &mut rows)
}

/// Stretches of each lane; those that are shorter than a 200th of the window share their row.
pub(super) fn stretches(lanes: &[Lane<'_>], window: Interval, time: &str) -> String {
    const COLUMNS: usize = 200;
    let headings = [
        "lane".to_owned(),
        format!("from <small>{time}</small>"),
        format!("to <small>{time}</small>"),
        "mode".to_owned(),
    ];
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
    folded("Stretches", &headings, &mut rows.into_iter())
}

/// A table that is folded below its figure.
pub(super) fn folded(
    caption: &str,
    headings: &[String],
    rows: &mut dyn Iterator<Item = Vec<String>>,
) -> String {
    let table = table(caption, headings, rows);
    format!("<details class=\"data\"><summary>Data</summary>{table}</details>\n")
}

/// A table; caption, headings and cells are HTML.
pub(super) fn table(
    caption: &str,
    headings: &[String],
    rows: &mut dyn Iterator<Item = Vec<String>>,
) -> String {
    let mut html = String::new();
    push(
        &mut html,
        format_args!(
            "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{caption}\"><table><caption>{caption}</caption><thead><tr>"
        ),
    );
    for heading in headings {
        push(&mut html, format_args!("<th scope=\"col\">{heading}</th>"));
    }
    html.push_str("</tr></thead><tbody>\n");
    for row in rows {
        html.push_str("<tr>");
        for (i, cell) in row.iter().enumerate() {
            match i {
                0 => push(&mut html, format_args!("<th scope=\"row\">{cell}</th>")),
                _ => push(&mut html, format_args!("<td>{cell}</td>")),
            }
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    html
}
