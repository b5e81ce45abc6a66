//! The table of checks, where runs were checked.

use super::{badge, push};
use crate::report::plot::text::{escape, figures};
use crate::run::verdict::PolicyRun;
use crate::run::verify::{Check, Verification};

/// One row for each check, headed by its policy; nothing where no run was checked.
pub(super) fn push_table(page: &mut String, runs: &[&PolicyRun]) {
    let mut checked = (runs.iter())
        .filter_map(|r| Some((*r, r.checked()?)))
        .peekable();
    let Some((_, first)) = checked.peek() else {
        return;
    };
    let threshold = figures(first.threshold_clearances);
    push(
        page,
        format_args!(
            "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"Checks\">\n<table>\n<caption>Checks</caption>\n<thead><tr>\
             <th scope=\"col\">Policy</th><th scope=\"col\">Outcome</th>\
             <th scope=\"col\">Checked by</th><th scope=\"col\">Tolerance</th>\
             <th scope=\"col\">Changes of mode</th>\
             <th scope=\"col\">Difference at the end <small>clearances</small></th>\
             <th scope=\"col\">Largest difference <small>clearances</small></th>\
             <th scope=\"col\">Apart by {threshold} clearances from <small>ms</small></th>\
             </tr></thead>\n<tbody>\n"
        ),
    );
    for (run, verification) in checked {
        for check in &verification.checks {
            push_check(page, run, verification, check);
        }
    }
    page.push_str(
        "</tbody>\n</table>\n</div>\n<p class=\"note\">Every policy was run again with the same seed. \
         Differences are distances of the rotor from where the run above has it.</p>\n",
    );
}

fn push_check(page: &mut String, run: &PolicyRun, verification: &Verification, check: &Check) {
    let name = escape(&run.name);
    let agreement = if check.outcome == run.verdict.figures.outcome {
        badge(check.outcome)
    } else {
        format!("{}, OTHER than the run", badge(check.outcome))
    };
    let changes = if check.same_modes {
        format!("the same {}", check.mode_changes)
    } else {
        format!("{}, not {}", check.mode_changes, verification.mode_changes)
    };
    let apart = (check.differs_from_s).map_or("never".to_owned(), |t| figures(1e3 * t));
    push(
        page,
        format_args!(
            "<tr><th scope=\"row\">{name}</th><td>{agreement}</td><td>{}</td><td>{:.0e}</td>\
             <td>{changes}</td><td>{}</td><td>{}</td><td>{apart}</td></tr>\n",
            check.method,
            check.rtol,
            figures(check.end_difference_clearances),
            figures(check.largest_difference_clearances),
        ),
    );
}
