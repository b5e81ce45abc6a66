//! What happened, as a table for the reviewer of an overload; the script makes its times lead there.

use super::html_page::HtmlPage;
use super::listing::{Column, Listing};
use super::markup::Markup;
use super::track::Track;
use crate::report::plot::text::figures;
use crate::run::supervision::{Happening, Happenings, names};
use crate::run::verdict::PolicyRun;

/// So many rows of a record are listed.
const MOST: usize = Happenings::MOST;

/// One table for each run with a supervisor, headed by the name of its plane, if it has one.
pub(super) fn push_tables(page: &mut HtmlPage, runs: &[&PolicyRun], plane: Option<&str>) {
    for run in runs.iter().filter(|run| run.supervision.is_some()) {
        let name = match plane {
            Some(plane) => format!("{}, {plane}", run.name),
            None => run.name.clone(),
        };
        push_table(page, &name, run);
    }
}

/// Times and words.
fn listing<const N: usize>(
    name: &str,
    (time, others): (&str, [&str; N]),
    rows: impl Iterator<Item = (Markup, [String; N])>,
) -> Listing {
    let mut columns = vec![Column::Words; N + 1];
    columns[0] = Column::Numbers;
    let row = |(at, words): (Markup, [String; N])| {
        let words = words.iter().map(Markup::text);
        [at].into_iter().chain(words).collect()
    };
    Listing {
        caption: format!("What happened: {name}"),
        headings: [Markup::with_unit("At", time)]
            .into_iter()
            .chain(others.map(Markup::text))
            .collect(),
        columns,
        rows: rows.map(row).collect(),
        low: true,
        ..Listing::default()
    }
}

fn push_table(page: &mut HtmlPage, name: &str, run: &PolicyRun) {
    let happenings = &run.happenings;
    let headings = ["Mode", "Expected severity", "Bound by", "Events"];
    let rows = happenings.all.iter().map(row);
    page.table(&listing(name, ("ms", headings), rows));
    let after = match (happenings.more, happenings.touches_after) {
        (0, 0) => String::new(),
        (0, touches) => format!(" Touches after the last of them: {touches}."),
        (more, _) => format!(" {more} more are in the trace."),
    };
    page.note(&Markup::text(format!(
        "Samples at which the mode changed or something happened, as the supervisor saw it; touches that changed nothing are \
         counted. Expected severity: backward speed after the impacts to come, if nobody brakes, over the highest that the cap can \
         arrest.{after}"
    )));
}

fn row(happening: &Happening) -> (Markup, [String; 4]) {
    let (t_ms, supervisor) = (1e3 * happening.t_s, happening.supervisor);
    let events = names(supervisor.events.iter_names());
    let words = [
        supervisor.mode.name().to_owned(),
        figures(supervisor.severity.into()),
        names(supervisor.limits.iter_names()),
        match happening.touches_before {
            0 => events,
            touches => format!("{events} (touches before: {touches})"),
        },
    ];
    (Markup::time(t_ms, &format!("{t_ms:.3}")), words)
}

/// The same of a track: what its record has.
pub(super) fn push_of_track(page: &mut HtmlPage, track: &Track) {
    let rows = track.events.iter().take(MOST).map(|event| {
        let (t, decimals) = (event.t, track.units.decimals);
        let words = [
            event.mode.to_string(),
            event.limits.to_string(),
            event.events.to_string(),
        ];
        (Markup::time(t, &format!("{t:.decimals$}")), words)
    });
    let headings = ["Mode", "Bound by", "Events"];
    page.table(&listing(&track.name, (track.units.time, headings), rows));
    let more = track.events.len().saturating_sub(MOST);
    if more > 0 {
        page.note(&Markup::text(format!("{more} more are in the record.")));
    }
}
