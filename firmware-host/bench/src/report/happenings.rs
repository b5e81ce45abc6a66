//! What happened, as a table for the reviewer of an overload; the script makes its times lead there.

use super::push;
use super::track::Track;
use crate::report::plot::text::{escape, figures};
use crate::run::supervision::{Happening, Happenings, names};
use crate::run::verdict::PolicyRun;

/// So many rows of a record are told.
const MOST: usize = Happenings::MOST;

/// One table for each run with a supervisor, told with the name of its plane, if it has one.
pub(super) fn push_tables(page: &mut String, runs: &[&PolicyRun], plane: Option<&str>) {
    for run in runs.iter().filter(|run| run.supervision.is_some()) {
        let name = match plane {
            Some(plane) => format!("{}, {plane}", run.name),
            None => run.name.clone(),
        };
        push_table(page, &name, run);
    }
}

fn begun(page: &mut String, name: &str, headings: &[&str]) {
    let name = escape(name);
    push(
        page,
        format_args!(
            "<div class=\"scroll events\" role=\"group\" tabindex=\"0\" aria-label=\"What happened: {name}\">\n\
             <table class=\"words\">\n<caption>What happened: {name}</caption>\n<thead><tr>"
        ),
    );
    for heading in headings {
        push(page, format_args!("<th scope=\"col\">{heading}</th>"));
    }
    page.push_str("</tr></thead>\n<tbody>\n");
}

fn push_table(page: &mut String, name: &str, run: &PolicyRun) {
    let happenings = &run.happenings;
    let headings = [
        "At <small>ms</small>",
        "Mode",
        "Expected severity",
        "Bound by",
        "Events",
    ];
    begun(page, name, &headings);
    if happenings.all.is_empty() {
        page.push_str("<tr><td colspan=\"5\">nothing</td></tr>\n");
    }
    for happening in &happenings.all {
        push_row(page, happening);
    }
    page.push_str(
        "</tbody>\n</table>\n</div>\n<p class=\"note\">Samples at which the mode changed or something happened, as the \
         supervisor saw it; touches that changed nothing are counted. Expected severity: backward speed after the impacts to \
         come, if nobody brakes, over the highest that the cap can arrest.",
    );
    match (happenings.more, happenings.touches_after) {
        (0, 0) => {}
        (0, touches) => push(
            page,
            format_args!(" Touches after the last of them: {touches}."),
        ),
        (more, _) => push(page, format_args!(" {more} more are in the trace.")),
    }
    page.push_str("</p>\n");
}

fn push_row(page: &mut String, happening: &Happening) {
    let (t_ms, said) = (1e3 * happening.t_s, happening.said);
    let events = names(said.events.iter_names());
    push(
        page,
        format_args!(
            "<tr><th scope=\"row\" data-t=\"{t_ms}\">{t_ms:.3}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            said.mode.name(),
            figures(said.severity.into()),
            names(said.limits.iter_names()),
            match happening.touches_before {
                0 => events,
                touches => format!("{events} (touches before: {touches})"),
            },
        ),
    );
}

/// The same of a track: what its record has.
pub(super) fn push_of_track(page: &mut String, track: &Track) {
    let at = format!("At <small>{}</small>", track.units.time);
    begun(page, &track.name, &[&at, "Mode", "Bound by", "Events"]);
    for event in track.events.iter().take(MOST) {
        let (t, decimals) = (event.t, track.units.decimals);
        push(
            page,
            format_args!(
                "<tr><th scope=\"row\" data-t=\"{t}\">{t:.decimals$}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                event.mode, event.limits, event.events,
            ),
        );
    }
    page.push_str("</tbody>\n</table>\n</div>\n");
    let more = track.events.len().saturating_sub(MOST);
    if more > 0 {
        push(
            page,
            format_args!("<p class=\"note\">{more} more are in the record.</p>\n"),
        );
    }
}
