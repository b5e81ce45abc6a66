//! What the supervisor did, as a table for the reviewer of an overload.

use super::push;
use crate::report::plot::text::{escape, figures};
use crate::run::supervision::{Happening, names};
use crate::run::verdict::PolicyRun;

/// One table for each run with a supervisor.
pub(super) fn push_tables(page: &mut String, runs: &[PolicyRun]) {
    for run in runs.iter().filter(|run| run.supervision.is_some()) {
        push_table(page, run);
    }
}

fn push_table(page: &mut String, run: &PolicyRun) {
    let (name, happenings) = (escape(&run.name), &run.happenings);
    push(
        page,
        format_args!(
            "<section class=\"scroll\">\n<table class=\"words\">\n<caption>What happened: {name}</caption>\n<thead><tr>\
             <th scope=\"col\">At <small>ms</small></th><th scope=\"col\">Mode</th>\
             <th scope=\"col\">Expected severity</th>\
             <th scope=\"col\">Bound by</th><th scope=\"col\">Events</th></tr></thead>\n<tbody>\n"
        ),
    );
    if happenings.all.is_empty() {
        page.push_str("<tr><td colspan=\"5\">nothing</td></tr>\n");
    }
    for happening in &happenings.all {
        push_row(page, happening);
    }
    page.push_str(
        "</tbody>\n</table>\n<p class=\"note\">Samples at which the mode changed or something happened, as the supervisor saw it; \
         touches that changed nothing are counted. Expected severity: backward speed after the impacts to come, if \
         nobody brakes, over the highest that the cap can arrest.",
    );
    match (happenings.more, happenings.touches_after) {
        (0, 0) => {}
        (0, touches) => push(
            page,
            format_args!(" Touches after the last of them: {touches}."),
        ),
        (more, _) => push(page, format_args!(" {more} more are in the trace.")),
    }
    page.push_str("</p>\n</section>\n");
}

fn push_row(page: &mut String, happening: &Happening) {
    let (t_ms, said) = (1e3 * happening.t_s, happening.said);
    let events = names(said.events.iter_names());
    push(
        page,
        format_args!(
            "<tr><th scope=\"row\">{t_ms:.3}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
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
