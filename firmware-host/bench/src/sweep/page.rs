//! The page of a sweep: what became of the runs, where they are lost, what decides it, and the worst of them.

mod deciding;
mod maps;

use self::deciding::decided;
use self::maps::map;
use crate::report::html_page::{Head, HtmlPage};
use crate::report::listing::Listing;
use crate::report::markup::Markup;
use crate::report::plot::PlotError;
use crate::report::plot::text::figures;
use crate::report::table::shown_as;
use crate::run::figures::Figures;
use crate::run::outcome::Outcome;
use crate::sweep::summary::{PairSummary, PolicySummary, Summary};

/// Name of its file.
pub const PAGE: &str = "report.html";

/// Complete HTML document. Deterministic: the same summary gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(summary: &Summary) -> Result<String, PlotError> {
    let policies = summary.policies.iter().map(headline);
    let head: Vec<String> = policies
        .chain(summary.pairs.iter().map(PairSummary::sentence))
        .collect();
    let mut warnings = summary.errors.clone();
    let more = summary.failed - summary.errors.len() as u64;
    if more > 0 {
        warnings.push(format!(
            "{more} more rows have an error in the place of figures"
        ));
    }
    let facts = vec![
        ("Design", summary.design.name().to_owned()),
        ("Runs", summary.runs.to_string()),
        ("Policies", summary.policies.len().to_string()),
        ("Keys that vary", summary.influences.len().to_string()),
    ];
    let head = Head {
        title: format!("Sweep: {}", summary.scene),
        headline: head.join(" "),
        facts,
        warnings,
        ..Head::default()
    };
    let mut page = HtmlPage::begun(&head);
    let maps = (summary.maps.iter().map(map)).collect::<Result<Vec<_>, _>>()?;
    page.section("Where runs are lost", |page| {
        let text = match maps.is_empty() {
            true => "No two keys vary that could be shown against each other.",
            false => {
                "Over the two keys with the most influence, or those that maps in the sweep file names. Few runs are shown one by \
                 one, with crosses where the rotor is lost; of many the share that is lost, white where there is no run."
            }
        };
        page.figures(&maps);
        page.note(&Markup::text(text));
    });
    page.about(&head);
    page.section("Outcomes", |page| {
        page.columns(|page| {
            page.block(|page| {
                page.table(&outcomes(summary));
                page.note(&Markup::text(bound(summary)));
                if let Some(sampled) = summary.sampled_runs {
                    page.note(&Markup::text(format!(
                        "Quantiles, influences and maps are of {sampled} runs drawn at random."
                    )));
                }
            });
            for policy in &summary.policies {
                page.table(&quantiles(policy));
            }
        });
    });
    page.section("What decides", |page| decided(page, summary));
    page.section("Worst runs", |page| {
        page.note(&Markup::text(match summary.worst.is_empty() {
            true => "None is kept.",
            false => "Each is a scene file beside this page. In its folder: firmware-host run FILE",
        }));
        if !summary.worst.is_empty() {
            page.table(&worst(summary));
        }
    });
    Ok(page.ended())
}

fn headline(policy: &PolicySummary) -> String {
    let PolicySummary {
        policy, lost, runs, ..
    } = policy;
    format!("{policy}: {lost} of {runs} lost.")
}

fn percent(share: f64) -> String {
    format!("{} %", figures(100.0 * share))
}

/// A row a policy; those outcomes that came up.
fn outcomes(summary: &Summary) -> Listing {
    let came_up = |outcome: &Outcome| {
        (summary.policies.iter()).any(|policy| policy.outcomes.contains_key(outcome.name()))
    };
    let all: Vec<Outcome> = Outcome::ALL.into_iter().filter(came_up).collect();
    let mut headings: Vec<Markup> = ["policy", "runs"].map(Markup::text).to_vec();
    headings.extend(all.iter().map(|outcome| Markup::outcome(*outcome)));
    headings.extend(["failed", "lost", "share lost", "share lost, at most"].map(Markup::text));
    let rows = summary.policies.iter().map(|policy| {
        let count = |outcome: &Outcome| policy.outcomes.get(outcome.name()).copied().unwrap_or(0);
        let mut row = vec![policy.policy.clone(), policy.runs.to_string()];
        row.extend(all.iter().map(|outcome| count(outcome).to_string()));
        row.extend([policy.failed, policy.lost].map(|n| n.to_string()));
        row.push(percent(policy.lost as f64 / policy.runs as f64));
        row.push(policy.lost_at_most.map_or("–".to_owned(), percent));
        row.iter().map(Markup::text).collect()
    });
    Listing {
        caption: "How runs ended".to_owned(),
        rows: rows.collect(),
        headings,
        ..Listing::default()
    }
}

/// What may be said about the share that is lost.
fn bound(summary: &Summary) -> String {
    let lost = "Lost: ended neither recovered nor decayed.";
    let bounds =
        (summary.policies.iter()).filter_map(|policy| Some((policy, policy.lost_at_most?)));
    let sentences: Vec<String> = bounds
        .map(|(policy, most)| {
            format!(
                "Under {} none of {} independent runs was lost: with a confidence of 95 % at most {} of all such runs are (rule of three, 3 over the runs).",
                policy.policy,
                policy.runs,
                percent(most)
            )
        })
        .collect();
    match sentences.is_empty() {
        true => format!(
            "{lost} A bound on the share holds where runs are drawn independently (design monte_carlo), and none is lost or failed: the rule of three."
        ),
        false => format!("{lost} {}", sentences.join(" ")),
    }
}

fn quantiles(policy: &PolicySummary) -> Listing {
    let row = |of: &crate::sweep::summary::Quantiles| {
        let figure = Figures::ALL.iter().find(|figure| figure.key == of.key)?;
        let mut row = vec![
            Markup::with_unit(figure.heading, figure.unit),
            Markup::text(of.runs.to_string()),
        ];
        let values = [of.median, of.q90, of.q99, of.largest];
        row.extend(values.map(|x| Markup::text(shown_as(figure, x))));
        Some(row)
    };
    Listing {
        caption: format!("Figures under {}", policy.policy),
        headings: ["figure", "runs", "median", "90 %", "99 %", "largest"]
            .map(Markup::text)
            .to_vec(),
        rows: policy.figures.iter().filter_map(row).collect(),
        ..Listing::default()
    }
}

fn worst(summary: &Summary) -> Listing {
    let figure = Figures::ALL
        .iter()
        .find(|figure| figure.key == summary.worst_by);
    let shown =
        |value: f64| figure.map_or_else(|| figures(value), |figure| shown_as(figure, value));
    let heading = match figure {
        Some(figure) => Markup::with_unit(figure.heading, figure.unit),
        None => Markup::text(&summary.worst_by),
    };
    let rows = summary.worst.iter().map(|run| {
        let outcome = Outcome::from_name(&run.outcome);
        vec![
            Markup::text(run.run.to_string()),
            Markup::text(shown(run.value)),
            outcome.map_or_else(|| Markup::text(&run.outcome), Markup::outcome),
            Markup::link(&run.file),
        ]
    });
    Listing {
        caption: format!(
            "Largest {} under {}",
            summary.worst_by, summary.worst_policy
        ),
        headings: vec![
            Markup::text("run"),
            heading,
            Markup::text("outcome"),
            Markup::text("scene"),
        ],
        rows: rows.collect(),
        ..Listing::default()
    }
}
