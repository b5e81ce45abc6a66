//! A page whose figures move together where there is a script: the data of all tracks, and that one script, named by its hash.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::html_page::{Head, HtmlPage};
use super::markup::Markup;
use super::panels::{Key, PanelRow, Shown, View};
use super::push;
use super::rendered::Rendered;
use super::track::{ROTOR_MODES, SUPERVISOR_MODES, Track};
use crate::report::plot::text::{escape, hex};
use crate::report::plot::thin::{Band, Interval, drawable, one_band_a_column};

/// The library under its licence, and what drives it, in the order in which they need each other.
const SCRIPT: &str = concat!(
    "/*\n",
    include_str!("uplot/LICENSE"),
    "\n*/\n",
    include_str!("uplot/uPlot.iife.min.js"),
    include_str!("script/data.js"),
    include_str!("script/lines.js"),
    include_str!("script/orbit.js"),
    include_str!("script/controls.js"),
);

/// Buttons and their keys; hidden until the script works.
const CONTROLS: &str = include_str!("script/controls.html");

/// Rows of all tracks that the script gets at most: some 30 bytes each.
const MOST_ROWS: usize = 40_000;
/// Stretches of one lane that it gets at most.
const MOST_BANDS: usize = 4_000;
/// A column is written in so many steps over its range.
const STEPS: f64 = 20_000.0;
/// Times are written in steps of this many of their unit, ms or ticks.
const TIME_STEP: f64 = 1e-4;

/// What all figures of a page share.
pub(super) struct Times {
    pub(super) window: Interval,
    /// Where the events are.
    pub(super) focus: Option<Interval>,
    /// Stretches to be shaded.
    pub(super) shaded: Vec<Interval>,
}

impl Times {
    /// Those tracks over the whole time.
    pub(super) fn view<'a>(&'a self, shown: &'a [Shown<'a>]) -> View<'a> {
        View {
            shown,
            window: self.window,
            shaded: &self.shaded,
        }
    }
}

/// A page that is being written.
pub(super) struct Document {
    pub(super) page: HtmlPage,
    panels: Vec<Value>,
    groups: usize,
}

impl Document {
    /// A page with its head.
    pub(super) fn begun(head: &Head) -> Self {
        let hash = STANDARD.encode(Sha256::digest(SCRIPT));
        Self {
            page: HtmlPage::with_scripts(head, &format!("; script-src 'sha256-{hash}'")),
            panels: Vec::new(),
            groups: 0,
        }
    }

    /// What is seen before anybody scrolls, then the controls of all figures, from there on in sight.
    pub(super) fn first_section(
        &mut self,
        shown: &[Shown<'_>],
        times: &Times,
        of: &str,
        rows: &[PanelRow],
    ) {
        let what = match times.focus {
            Some(_) => "The event",
            None => "The whole course",
        };
        let heading = match of {
            "" => what.to_owned(),
            of => format!("{what}: {of}"),
        };
        self.section(shown, (&heading, ""), rows, false);
        self.page.push(CONTROLS);
    }

    /// A part with figures. One that is `still` is left to readers without script, as the others show the same when zoomed.
    pub(super) fn section(
        &mut self,
        shown: &[Shown<'_>],
        (heading, text): (&str, &str),
        rows: &[PanelRow],
        still: bool,
    ) {
        let (panels, groups) = (&mut self.panels, &mut self.groups);
        let write = |page: &mut HtmlPage| {
            if !text.is_empty() {
                page.note(&Markup::written(text));
            }
            page.push("<div class=\"rows\">\n");
            for row in rows {
                heading_of(page, row);
                for cell in &row.cells {
                    let Some(of) = shown.get(cell.shown) else {
                        continue;
                    };
                    let panel = match still {
                        true => String::new(),
                        false => {
                            let mut live = cell.live.clone();
                            live["group"] = json!(*groups);
                            panels.push(live);
                            format!(" data-panel=\"{}\"", panels.len() - 1)
                        }
                    };
                    let outcome = of.track.outcome.map_or(Markup::default(), Markup::outcome);
                    let own = match cell.own_scale {
                        true => " <em class=\"own\">own scale</em>",
                        false => "",
                    };
                    let caption = format!("<b>{}</b> {}{own}", escape(of.name), outcome.as_html());
                    let drawn = Rendered {
                        id: None,
                        caption: Markup::written(caption),
                        // For readers without script, and for paper.
                        drawing: format!("<div class=\"still\">{}</div>", cell.svg),
                        data: cell.data.clone(),
                    };
                    page.figure(&panel, &drawn);
                }
                page.push("</div></div>\n");
                *groups += 1;
            }
            page.push("</div>\n");
        };
        match still {
            true => self.page.still_section(heading, write),
            false => self.page.section(heading, write),
        }
    }

    /// The whole page, with what the script needs of the tracks.
    pub(super) fn ended(self, tracks: &[Track], times: &Times) -> String {
        let classes = json!({
            "rotor": ROTOR_MODES.map(|(mode, colour)| json!([mode.name(), hex(colour)])),
            "supervisor": SUPERVISOR_MODES.map(|(mode, colour)| json!([mode.name(), hex(colour)])),
        });
        let spans = |spans: &[Interval]| spans.iter().map(|s| [s.lo, s.hi]).collect::<Vec<_>>();
        let budget = MOST_ROWS / tracks.len().max(1);
        let data = json!({
            "window": [times.window.lo, times.window.hi],
            "focus": times.focus.map(|focus| [focus.lo, focus.hi]),
            "shaded": spans(&times.shaded),
            "classes": classes,
            "tracks": tracks.iter().map(|t| of_track(t, times, budget)).collect::<Vec<_>>(),
            "panels": self.panels,
        });
        // An end tag in a text would end the block.
        let data = data.to_string().replace('<', "\\u003c");
        self.page.ended_with(&format!(
            "<script type=\"application/json\" id=\"report-data\">{data}</script>\n<script>{SCRIPT}</script>\n"
        ))
    }
}

/// Heading and legend of a row of panels, up to where they begin.
fn heading_of(page: &mut HtmlPage, row: &PanelRow) {
    let mut html = format!(
        "<div class=\"row\" style=\"--panels:{}\">\n<div class=\"head\"><h3>{}</h3> ",
        row.cells.len(),
        row.heading
    );
    for Key {
        name,
        colour,
        dashed,
    } in &row.legend
    {
        let class = if *dashed { "key dashed" } else { "key" };
        let name = escape(name);
        push(
            &mut html,
            format_args!("<span class=\"{class}\" style=\"--colour:{colour}\">{name}</span> "),
        );
    }
    push(
        &mut html,
        format_args!(
            "<span class=\"note\">{}</span></div>\n<div class=\"grid\">\n",
            row.note
        ),
    );
    page.push(&html);
}

fn of_track(track: &Track, times: &Times, budget: usize) -> Value {
    let rows = standing_out(track, times, budget);
    let picked = |values: &[f64]| rows.iter().map(|i| values[*i]).collect::<Vec<_>>();
    let columns: serde_json::Map<String, Value> = (track.columns.iter())
        .map(|(name, values)| {
            let range = Interval::of(values.iter().copied()).map_or(0.0, Interval::size);
            (name.to_string(), in_steps(&picked(values), range / STEPS))
        })
        .collect();
    let touching: String = (rows.iter())
        .map(|i| match track.touching.get(*i) {
            Some(true) => '1',
            _ => '0',
        })
        .collect();
    let span = Interval::of(track.t.iter().copied()).map_or(0.0, Interval::size);
    let period = span / track.t.len().saturating_sub(1).max(1) as f64;
    let events = (track.events.iter()).map(|event| {
        (
            event.t,
            format!("{} {}", event.mode, event.events).trim().to_owned(),
        )
    });
    json!({
        "name": track.name,
        "unit": track.units.time,
        "of": track.t.len(),
        "period": period,
        "t": in_steps(&picked(&track.t), TIME_STEP),
        "columns": columns,
        "touching": touching,
        "bands": { "rotor": bands(&track.rotor, times), "supervisor": bands(&track.supervisor, times) },
        "events": events.collect::<Vec<_>>(),
    })
}

/// Places of the rows that the script gets: all, or of neighbours those that are lowest or highest in a column or the first
/// that touch or touch no more. Where the events are neighbours are fewer.
fn standing_out(track: &Track, times: &Times, budget: usize) -> Vec<usize> {
    let rows = track.t.len();
    if rows <= budget {
        return (0..rows).collect();
    }
    let place = |t: f64| track.t.partition_point(|known| *known < t);
    let focus = times.focus.unwrap_or(times.window);
    let (from, to) = (place(focus.lo), place(focus.hi));
    let parts = [(0, from), (from, to), (to, rows)];
    let outside = rows - (to - from);
    let mut kept = vec![false; rows];
    for (i, (from, to)) in parts.into_iter().enumerate() {
        // Half for the events, but no more than there is; what is left for the rest.
        let (of, share) = match i {
            1 => (to - from, (budget / 2).min(to - from)),
            _ => (outside, budget - (budget / 2).min(rows - outside)),
        };
        let share = if outside == 0 { budget } else { share };
        let most = 2 * track.columns.len() + 2;
        // A block leaves `most` rows at most.
        let block = match of <= share {
            true => 1,
            false => (of * most).div_ceil(share.max(1)),
        };
        for begin in (from..to).step_by(block) {
            mark(track, begin..to.min(begin + block), &mut kept);
        }
    }
    (0..rows).filter(|i| kept[*i]).collect()
}

fn mark(track: &Track, block: std::ops::Range<usize>, kept: &mut [bool]) {
    for (_, values) in &track.columns {
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let there = || block.clone().filter(|i| drawable(values[*i]));
        for i in [there().min_by(by_value), there().max_by(by_value)]
            .into_iter()
            .flatten()
        {
            kept[i] = true;
        }
    }
    if let Some(touching) = track.touching.get(block.clone()) {
        for kind in [false, true] {
            if let Some(i) = touching.iter().position(|t| *t == kind) {
                kept[block.start + i] = true;
            }
        }
    }
}

/// Differences of neighbours in whole steps, null for what cannot be drawn: short, and exact to half a step.
fn in_steps(values: &[f64], step: f64) -> Value {
    let step = if drawable(step) { step.max(1e-12) } else { 1.0 };
    let mut before = 0;
    let differences = values.iter().map(|value| {
        drawable(*value).then(|| {
            let at = (value / step).round() as i64;
            at - std::mem::replace(&mut before, at)
        })
    });
    json!({ "step": step, "differences": differences.collect::<Vec<_>>() })
}

fn bands(all: &[Band], times: &Times) -> Vec<(usize, f64, f64)> {
    let thinned;
    let bands = match all.len() > MOST_BANDS {
        true => {
            thinned = one_band_a_column(all, times.window, MOST_BANDS);
            &thinned[..]
        }
        false => all,
    };
    let short = |t: f64| (t / TIME_STEP).round() * TIME_STEP;
    (bands.iter())
        .map(|band| (band.class, short(band.span.lo), short(band.span.hi)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture::{run, scene};
    use crate::run::outcome::Outcome;

    /// What a browser would take for the end of the script would leave the rest of it in the page.
    #[test]
    fn the_script_cannot_end_early() {
        for word in ["</script", "<!--", "\r"] {
            assert!(!SCRIPT.contains(word), "{word:?}");
        }
    }

    fn track(rows: u32) -> Track {
        let samples: Vec<_> = (0..rows)
            .map(|i| (f64::from(i) * 5e-5, i == 7_777))
            .collect();
        let mut run = run("a", Outcome::Recovered, &samples);
        for (i, row) in run.trace.rows.iter_mut().enumerate() {
            row.commanded_n.x = (i as f64 * 0.1).sin();
        }
        run.trace.rows[12_345].commanded_n.x = 300.0;
        Track::of_run(&scene(), &run)
    }

    fn decoded(column: &Value) -> Vec<f64> {
        let step = column["step"].as_f64().unwrap();
        let mut at = 0;
        (column["differences"].as_array().unwrap().iter())
            .map(|difference| {
                at += difference.as_i64().unwrap();
                at as f64 * step
            })
            .collect()
    }

    /// 40,000 rows in room for 4,000: the force of one tick and the one touch are there, and all is where it was.
    #[test]
    fn what_is_embedded_keeps_extremes_and_times() {
        let track = track(40_000);
        let times = Times {
            window: Interval { lo: 0.0, hi: 2e3 },
            focus: Some(Interval { lo: 0.0, hi: 20.0 }),
            shaded: Vec::new(),
        };
        let rows = standing_out(&track, &times, 4_000);
        assert!(rows.len() <= 4_000 && rows.len() > 500, "{}", rows.len());
        assert!(rows.contains(&12_345) && rows.contains(&7_777));
        // Of the events, which have room, every row.
        assert_eq!(rows[..400], (0..400).collect::<Vec<_>>());
        let of = of_track(&track, &times, 4_000);
        let t = decoded(&of["t"]);
        let commanded = decoded(&of["columns"]["commanded"]);
        let expected = track.column("commanded").unwrap();
        for (place, row) in rows.iter().enumerate() {
            assert!((t[place] - track.t[*row]).abs() < 1e-4);
            assert!((commanded[place] - expected[*row]).abs() < 300.0 / STEPS);
        }
        assert_eq!(standing_out(&track, &times, 40_000).len(), 40_000);
    }

    #[test]
    fn what_is_no_number_is_null() {
        let column = in_steps(&[0.5, f64::NAN, 1.0], 0.5);
        assert_eq!(column["differences"], json!([1, null, 1]));
    }
}
