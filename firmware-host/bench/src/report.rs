//! The report: one HTML document that shows what every policy did with a scene. It needs no script,
//! no network and no fonts of its own.

mod axes;
pub mod campbell;
#[cfg(test)]
pub(crate) mod fixture;
mod happenings;
pub mod machine;
mod panels;
pub mod plot;
mod quantities;
pub mod summary;
pub mod table;
mod verification;

use std::fmt::Write as _;

use self::axes::focus_window;
use self::panels::{Key, PanelRow};
pub use crate::report::plot::PlotError;
use crate::report::plot::text::{escape, figures};
use crate::report::summary::{Disturbed, Fact, SceneSummary};
use crate::report::table::shown;
use crate::run::figures::{Figure, Figures, Timing, Value};
use crate::run::outcome::Outcome;
use crate::run::verdict::{PolicyRun, Results, far_into_the_wall};

const STYLE: &str = include_str!("report/style.css");

/// Complete HTML document on the results of one scene, policies side by side in the order given.
/// Deterministic: the same input gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(scene: &SceneSummary, results: &Results) -> Result<String, PlotError> {
    let runs = &results.runs;
    let mut page = begun(&scene.title);
    push_story(&mut page, &scene.story);
    push_facts(&mut page, scene);
    push_warnings(&mut page, &scene.warnings);
    push_warnings(&mut page, &results.untrusted());
    page.push_str("</header>\n<main>\n");
    push_runs(&mut page, scene, runs)?;
    page.push_str("</main>\n</body>\n</html>\n");
    Ok(page)
}

/// A page up to its title.
fn begun(title: &str) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n"
    )
}

/// What the policies did in one plane.
fn push_runs(page: &mut String, scene: &SceneSummary, runs: &[PolicyRun]) -> Result<(), PlotError> {
    push_table(page, runs, scene.clearance_m);
    verification::push_table(page, runs);
    if !runs.is_empty() {
        push_sections(page, scene, runs)?;
    }
    happenings::push_tables(page, runs);
    Ok(())
}

/// Lines that a scene file wraps belong to one paragraph; an empty line begins another.
fn push_story(page: &mut String, story: &str) {
    let lines: Vec<_> = story.lines().map(str::trim).collect();
    for paragraph in lines
        .split(|line| line.is_empty())
        .filter(|p| !p.is_empty())
    {
        push(
            page,
            format_args!("<p class=\"story\">{}</p>\n", escape(&paragraph.join("\n"))),
        );
    }
}

fn push_facts(page: &mut String, scene: &SceneSummary) {
    let cap = scene
        .force_max_n
        .map_or("no magnet".to_owned(), |cap| figures(cap) + " N");
    let mut facts = vec![
        ("Clearance", figures(1e3 * scene.clearance_m) + " mm"),
        ("Force cap", cap),
        (
            "Counts as whirl",
            format!("above {} m/s backward", figures(scene.whirl_speed_m_s)),
        ),
        ("Duration", figures(1e3 * scene.duration_s) + " ms"),
    ];
    facts.extend(scene.facts.iter().cloned());
    push_list(page, &facts);
    push_disturbances(page, &scene.disturbances);
}

fn push_list(page: &mut String, facts: &[Fact]) {
    page.push_str("<dl class=\"facts\">\n");
    for (name, value) in facts {
        let value = escape(value);
        push(
            page,
            format_args!("<div><dt>{name}</dt><dd>{value}</dd></div>\n"),
        );
    }
    page.push_str("</dl>\n");
}

fn push_warnings<T: AsRef<str>>(page: &mut String, warnings: &[T]) {
    for warning in warnings {
        let warning = escape(warning.as_ref());
        push(
            page,
            format_args!("<p class=\"warning\">Warning: {warning}</p>\n"),
        );
    }
}

fn push_disturbances(page: &mut String, all: &[Disturbed]) {
    const SHOWN: usize = 20;
    if all.is_empty() {
        page.push_str("<p class=\"story\">Nothing happens from outside.</p>\n");
        return;
    }
    page.push_str("<ul class=\"story\">\n");
    for d in all.iter().take(SHOWN) {
        let (from, to) = (figures(1e3 * d.from_s), figures(1e3 * d.to_s));
        let span = match d.from_s == d.to_s {
            true => from,
            false => format!("{from}–{to}"),
        };
        push(
            page,
            format_args!("<li>{span} ms: {}</li>\n", escape(&d.what)),
        );
    }
    if all.len() > SHOWN {
        push(
            page,
            format_args!("<li>and {} more</li>\n", all.len() - SHOWN),
        );
    }
    page.push_str("</ul>\n");
}

fn push_table(page: &mut String, runs: &[PolicyRun], clearance_m: f64) {
    page.push_str("<section class=\"scroll\">\n<table>\n<caption>Verdicts</caption>\n<thead><tr>");
    page.push_str("<th scope=\"col\">policy</th>");
    push_headings(page, Figures::ALL);
    push_headings(page, Timing::ALL);
    page.push_str("</tr></thead>\n<tbody>\n");
    for run in runs {
        let name = escape(&run.name);
        push(page, format_args!("<tr><th scope=\"row\">{name}</th>"));
        push_cells(page, Figures::ALL, &run.verdict.figures);
        push_cells(page, Timing::ALL, &run.verdict.timing);
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table>\n</section>\n");
    if let Some(note) = far_into_the_wall(runs, clearance_m) {
        push(page, format_args!("<p>{}</p>\n", escape(&note)));
    }
}

fn push_headings<T>(page: &mut String, figures: &[Figure<T>]) {
    for Figure { heading, unit, .. } in figures {
        push(
            page,
            format_args!("<th scope=\"col\">{heading} <small>{unit}</small></th>"),
        );
    }
}

fn push_cells<T>(page: &mut String, figures: &[Figure<T>], of: &T) {
    for figure in figures {
        let text = match (figure.value)(of) {
            Value::Outcome(outcome) => badge(outcome),
            _ => shown(figure, of),
        };
        push(page, format_args!("<td>{text}</td>"));
    }
}

fn badge(outcome: Outcome) -> String {
    let class = match outcome {
        Outcome::Recovered | Outcome::Decayed => "good",
        Outcome::Diverging
        | Outcome::Resting
        | Outcome::Pinned
        | Outcome::Rubbing
        | Outcome::Bouncing => "fair",
        Outcome::Whirl => "bad",
    };
    let word = outcome.name();
    format!("<span class=\"outcome {class}\">{word}</span>")
}

fn push_sections(
    page: &mut String,
    scene: &SceneSummary,
    runs: &[PolicyRun],
) -> Result<(), PlotError> {
    let text = "Panels of one row share their axes. A whirling run that would stretch them more than \
                three times has axes of its own, marked <em class=\"own\">own scale</em>. The \
                background is shaded while one of the things listed above goes on.";
    let rows = panels::whole_run(scene, runs)?;
    push_section(page, runs, "Whole run", text, &rows);
    if let Some(window) = focus_window(scene, runs) {
        let heading = format!(
            "Close-up: {} to {} ms",
            figures(window.lo),
            figures(window.hi)
        );
        let text = "From the start, or a little before the first event, to a little after the last \
                    contact or change of mode of the runs that settle. The axes are shared within \
                    this stretch.";
        let rows = panels::close_up(scene, runs, window)?;
        push_section(page, runs, &heading, text, &rows);
    }
    Ok(())
}

fn push_section(
    page: &mut String,
    runs: &[PolicyRun],
    heading: &str,
    text: &str,
    rows: &[PanelRow],
) {
    push(
        page,
        format_args!("<section>\n<h2>{heading}</h2>\n<p class=\"note\">{text}</p>\n"),
    );
    push(
        page,
        format_args!(
            "<div class=\"scroll\"><div class=\"grid\" style=\"--policies:{}\">\n",
            runs.len()
        ),
    );
    for row in rows {
        push_row(page, runs, row);
    }
    page.push_str("</div></div>\n</section>\n");
}

fn push_row(page: &mut String, runs: &[PolicyRun], row: &PanelRow) {
    push(
        page,
        format_args!("<div class=\"head\"><h3>{}</h3> ", row.heading),
    );
    for Key {
        name,
        colour,
        dashed,
    } in &row.legend
    {
        let class = if *dashed { "key dashed" } else { "key" };
        push(
            page,
            format_args!("<span class=\"{class}\" style=\"--colour:{colour}\">{name}</span> "),
        );
    }
    push(
        page,
        format_args!("<span class=\"note\">{}</span></div>\n", row.note),
    );
    for (run, cell) in runs.iter().zip(&row.cells) {
        let (name, outcome) = (escape(&run.name), badge(run.verdict.figures.outcome));
        let own = if cell.own_scale {
            " <em class=\"own\">own scale</em>"
        } else {
            ""
        };
        push(
            page,
            format_args!("<figure><figcaption><b>{name}</b> {outcome}{own}</figcaption>\n"),
        );
        page.push_str(&cell.svg);
        page.push_str("</figure>\n");
    }
}

fn push(page: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = page.write_fmt(text);
}

#[cfg(test)]
mod tests {
    use super::fixture::{run, scene};
    use super::*;
    use crate::run::verdict::FailedRun;
    use crate::scene::Scene;

    fn results(runs: &[PolicyRun]) -> Results {
        Results {
            runs: runs.to_vec(),
            failed: Vec::new(),
        }
    }

    fn page(scene: &SceneSummary, runs: &[PolicyRun]) -> String {
        let page = html(scene, &results(runs)).unwrap();
        for word in ["NaN", "\"inf", " inf", "<script"] {
            assert!(!page.contains(word), "{word}");
        }
        page
    }

    #[test]
    fn policies_stand_side_by_side_and_text_is_escaped() {
        let samples: Vec<_> = (0..=400).map(|i| (f64::from(i) * 1e-3, i == 20)).collect();
        let runs = [
            run("passive", Outcome::Whirl, &samples),
            run("<script>", Outcome::Recovered, &samples),
        ];
        let page = page(&scene(), &runs);
        assert!(page.contains("<h1>Title &lt;b&gt;</h1>"));
        assert!(page.contains("And a &quot;second&quot; one.</p>"));
        assert!(page.contains("<th scope=\"row\">&lt;script&gt;</th>"));
        assert!(page.contains("<span class=\"outcome bad\">whirl</span>"));
        assert!(page.contains("Close-up: 0 to"));
        // Seven panels of the whole run and five close-ups for each.
        assert_eq!(page.matches("<svg").count(), 24);
        assert_eq!(page, html(&scene(), &results(&runs)).unwrap());
    }

    #[test]
    fn what_cannot_be_trusted_is_said() {
        let mut unchecked = run("radial", Outcome::Decayed, &[(0.0, false), (0.1, false)]);
        unchecked.verification = Some(Err("no <check>".to_owned()));
        let results = Results {
            runs: vec![unchecked],
            failed: vec![FailedRun {
                name: "passive".to_owned(),
                error: "lost".to_owned(),
            }],
        };
        let page = html(&scene(), &results).unwrap();
        for error in ["Warning: lost", "Warning: no &lt;check&gt;"] {
            assert!(page.contains(error), "{error}");
        }
        let text = include_str!("../../scenes/overload_then_release.toml");
        let scene = Scene::parse("test", text).unwrap();
        let json = table::json(&scene, &results);
        let policies = &json["policies"];
        assert_eq!(policies["passive"], serde_json::json!({ "error": "lost" }));
        assert_eq!(policies["radial"]["verification"]["error"], "no <check>");
        assert_eq!(policies["radial"]["outcome"], "decayed");
        let text = table::text(&scene, &results);
        assert!(
            text.contains("\nlost") && text.contains("\nno <check>"),
            "{text}"
        );
    }

    #[test]
    fn what_is_empty_or_no_number_is_drawn_nevertheless() {
        let mut broken = scene();
        broken.clearance_m = f64::NAN;
        broken.whirl_speed_m_s = f64::INFINITY;
        broken.duration_s = f64::NAN;
        broken.force_max_n = None;
        broken.disturbances = [(f64::NAN, 1.0), (0.1, 0.1)]
            .map(|(from_s, to_s)| Disturbed {
                what: "<load>".to_owned(),
                from_s,
                to_s,
            })
            .to_vec();
        let mut lost = run(
            "lost",
            Outcome::Whirl,
            &[(0.0, true), (1e-3, true), (f64::NAN, true)],
        );
        lost.trace.rows[1].plant.position_m.x = f64::NAN;
        lost.trace.rows[1].plant.normal_force_n = f64::INFINITY;
        lost.trace.rows[1].plant.spin_rad_s = 1e300;
        lost.verdict.figures.energy_residual = f64::NAN;
        let runs = [
            run("empty", Outcome::Decayed, &[]),
            run("single", Outcome::Resting, &[(0.0, true)]),
            lost,
        ];
        for scene in [scene(), broken] {
            page(&scene, &[]);
            page(&scene, &runs);
            for run in &runs {
                page(&scene, std::slice::from_ref(run));
            }
        }
    }
}
