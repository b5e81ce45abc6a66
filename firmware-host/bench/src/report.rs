//! The report: one HTML document that shows what every policy did with a scene, or what is in a flight record. It needs no
//! network and no fonts of its own; without its script the figures stand still.

mod axes;
pub mod campbell;
pub mod commission;
mod data;
mod document;
#[cfg(test)]
pub(crate) mod fixture;
mod happenings;
mod headline;
pub mod html_page;
pub mod lines;
pub mod listing;
mod machine;
pub mod markup;
mod panels;
pub mod plot;
mod quantities;
pub mod record;
pub mod rendered;
mod slow_track;
pub mod summary;
pub mod table;
pub mod tone;
pub mod track;
mod verification;

use std::fmt::Write as _;

use self::axes::{disturbances, focus_window, run_window};
use self::document::{Document, Times};
use self::headline::{Concluded, headline};
use self::html_page::{Head, HtmlPage};
use self::listing::Listing;
use self::markup::Markup;
use self::panels::{PanelRow, Shown, View, first_seen};
use self::table::supervisor_first;
use self::track::Track;
pub use crate::report::plot::PlotError;
use crate::report::plot::text::figures;
use crate::report::summary::{Disturbed, Fact, SceneSummary, summary};
use crate::run::figures::Figures;
use crate::run::outcome::Outcome;
use crate::run::verdict::{PolicyRun, Results, far_into_the_wall};
use crate::scene::Scene;

/// Complete HTML document on the results of one scene, policies side by side, the supervisor first.
/// Deterministic: the same input gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(scene: &Scene, results: &Results) -> Result<String, PlotError> {
    match scene.planes.len() == 1 && !scene.has_axis() {
        true => html_of_a_plane(&summary(scene, 0), results, limits(scene).next().flatten()),
        false => machine::html(scene, results),
    }
}

/// The severity index at which the supervisor of each plane asks for coasting down.
fn limits(scene: &Scene) -> impl Iterator<Item = Option<f32>> {
    let planes = scene.planes.iter();
    planes.map(|plane| Some(plane.supervisor.as_ref()?.severity_limit))
}

fn html_of_a_plane(
    scene: &SceneSummary,
    results: &Results,
    limit: Option<f32>,
) -> Result<String, PlotError> {
    let all = results.planes.first().map_or(&[][..], Vec::as_slice);
    let runs = supervisor_first(all);
    let concluded: Vec<_> = (runs.iter())
        .map(|run| Concluded::of(run, std::iter::once((*run, limit))))
        .collect();
    let head = Head {
        title: scene.title.clone(),
        headline: headline(&concluded),
        story: scene.story.clone(),
        facts: facts(scene),
        points: disturbance_lines(&scene.disturbances),
        warnings: warnings(&scene.warnings, results),
    };
    let mut document = Document::begun(&head);
    let tracks: Vec<Track> = (runs.iter()).map(|run| Track::of_run(scene, run)).collect();
    let (times, shown) = (times_of(scene, &tracks), shown(&tracks));
    let rows = match tracks.is_empty() {
        true => Vec::new(),
        false => times.view(&shown).whole_run()?,
    };
    let (first, others) = first_seen(rows);
    if !tracks.is_empty() {
        document.first_section(&shown, &times, "", &first);
    }
    document.page.columns(|page| {
        page.about(&head);
        page.block(|page| {
            push_table(page, "Verdicts", &runs);
            push_far(page, all, scene.clearance_m);
        });
        page.block(|page| verification::push_table(page, &runs));
        page.block(|page| happenings::push_tables(page, &runs, None));
    });
    if !tracks.is_empty() {
        push_sections(&mut document, &shown, &times, ("", &others))?;
    }
    Ok(document.ended(&tracks, &times))
}

/// All of them, under their own names.
fn shown(tracks: &[Track]) -> Vec<Shown<'_>> {
    let all = tracks.iter().enumerate();
    all.map(|(at, track)| Shown {
        name: &track.name,
        at,
        track,
    })
    .collect()
}

fn times_of(scene: &SceneSummary, tracks: &[Track]) -> Times {
    let (window, shaded) = (run_window(scene, tracks), disturbances(scene));
    Times {
        window,
        focus: focus_window(window, &shaded, tracks),
        shaded,
    }
}

fn facts(scene: &SceneSummary) -> Vec<Fact> {
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
    facts
}

/// Of the scene, and of what cannot be trusted.
fn warnings(of_scene: &[String], results: &Results) -> Vec<String> {
    let untrusted = results.untrusted().into_iter().map(str::to_owned);
    of_scene.iter().cloned().chain(untrusted).collect()
}

/// A line each, of many the first.
fn disturbance_lines(all: &[Disturbed]) -> Vec<String> {
    const SHOWN: usize = 20;
    if all.is_empty() {
        return vec!["No external loads, outages or sensor faults.".to_owned()];
    }
    let line = |d: &Disturbed| {
        let (from, to) = (figures(1e3 * d.from_s), figures(1e3 * d.to_s));
        let span = match d.from_s == d.to_s {
            true => from,
            false => format!("{from}–{to}"),
        };
        format!("{span} ms: {}", d.what)
    };
    let more = all.len().saturating_sub(SHOWN);
    let more = (more > 0).then(|| format!("and {more} more"));
    all.iter().take(SHOWN).map(line).chain(more).collect()
}

/// The rows of the terminal's table.
fn push_table(page: &mut HtmlPage, caption: &str, runs: &[&PolicyRun]) {
    let outcome = Figures::ALL[0].title();
    let row = |(title, cells): (String, Vec<String>)| {
        let cell = |(cell, run): (&String, &&PolicyRun)| match title == outcome {
            true => Markup::outcome(run.verdict.figures.outcome),
            false => Markup::text(cell),
        };
        let cells: Vec<Markup> = cells.iter().zip(runs).map(cell).collect();
        [Markup::text(&title)].into_iter().chain(cells).collect()
    };
    let names = runs.iter().map(|run| Markup::text(&run.name));
    page.table(&Listing {
        caption: caption.to_owned(),
        headings: [Markup::text("figure")].into_iter().chain(names).collect(),
        rows: table::rows(runs).into_iter().map(row).collect(),
        ..Listing::default()
    });
    let mut outcomes: Vec<Outcome> = runs.iter().map(|r| r.verdict.figures.outcome).collect();
    outcomes.sort();
    outcomes.dedup();
    let meanings: Vec<String> = (outcomes.iter())
        .map(|outcome| format!("<b>{}</b>: {}.", outcome.name(), outcome.meaning()))
        .collect();
    page.note(&Markup::written(meanings.join(" ")));
}

fn push_far(page: &mut HtmlPage, runs: &[PolicyRun], clearance_m: f64) {
    if let Some(note) = far_into_the_wall(runs, clearance_m) {
        page.warning(&note);
    }
}

/// Panels of the run and, for readers without script, of the close-up; `of` stands before the headings.
fn push_sections(
    document: &mut Document,
    shown: &[Shown<'_>],
    times: &Times,
    (of, rows): (&str, &[PanelRow]),
) -> Result<(), PlotError> {
    let text = "Panels of one row share their axes. A whirling run that would stretch them more than \
                three times has axes of its own, marked <em class=\"own\">own scale</em>. The \
                background is shaded while one of the things listed above goes on.";
    document.section(shown, (&format!("{of}Over time"), text), rows, false);
    if let Some(window) = times.focus {
        let heading = format!(
            "{of}Close-up: {} to {} ms",
            figures(window.lo),
            figures(window.hi)
        );
        let text = "From a little before the first event to a little after the last contact or change \
                    of mode of the runs that settle. The axes are shared within this stretch.";
        let view = View {
            window,
            ..times.view(shown)
        };
        let rows = view.fast()?;
        document.section(shown, (&heading, text), &rows, true);
    }
    Ok(())
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

    fn results(runs: &[PolicyRun]) -> Results {
        Results {
            runs: runs.to_vec(),
            planes: vec![runs.to_vec()],
            ..Results::default()
        }
    }

    fn page(scene: &SceneSummary, runs: &[PolicyRun]) -> String {
        let page = html_of_a_plane(scene, &results(runs), None).unwrap();
        let (drawn, data) = page.split_once("<script").unwrap();
        for word in ["NaN", "\"inf", " inf"] {
            assert!(!drawn.contains(word), "{word}");
        }
        let (_, data) = data.split_once('>').unwrap();
        let (data, _) = data.split_once("</script>").unwrap();
        assert!(serde_json::from_str::<serde_json::Value>(data).is_ok());
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
        assert!(page.contains("<th scope=\"col\">&lt;script&gt;</th>"));
        assert!(page.contains("<span class=\"outcome bad\">whirl</span>"));
        assert!(page.contains("Close-up: 19.2 to"));
        // Seven panels of the whole run and five close-ups for each.
        assert_eq!(page.matches("<svg").count(), 24);
        assert_eq!(
            page,
            html_of_a_plane(&scene(), &results(&runs), None).unwrap()
        );
    }

    #[test]
    fn what_cannot_be_trusted_is_said() {
        let mut unchecked = run("radial", Outcome::Decayed, &[(0.0, false), (0.1, false)]);
        unchecked.verification = Some(Err("no <check>".to_owned()));
        let results = Results {
            failed: vec![FailedRun {
                name: "passive".to_owned(),
                error: "lost".to_owned(),
            }],
            ..results(&[unchecked])
        };
        let page = html_of_a_plane(&scene(), &results, None).unwrap();
        for error in ["Warning: lost", "Warning: no &lt;check&gt;"] {
            assert!(page.contains(error), "{error}");
        }
        let text = include_str!("../scenes/overload_then_release.toml");
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
