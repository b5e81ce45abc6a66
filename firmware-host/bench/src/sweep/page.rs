//! The page of a sweep: what became of the runs, where they are lost, what decides it, and the worst of them.

use crate::report::drawn::Drawn;
use crate::report::html_page::{Head, HtmlPage};
use crate::report::listing::Listing;
use crate::report::markup::Markup;
use crate::report::plot::PlotError;
use crate::report::plot::bars::{Bars, Measured, Thing, bars};
use crate::report::plot::chart::{Axis, Chart, Curve, HeatMap, Mark, chart, heat_map};
use crate::report::plot::text::figures;
use crate::report::table::shown_as;
use crate::run::figures::Figures;
use crate::run::outcome::Outcome;
use crate::sweep::indices::{Index, Indices};
use crate::sweep::map::{MapAxis, OutcomeMap, Places};
use crate::sweep::summary::{KeyInfluence, PolicySummary, Summary};

/// Name of its file.
pub const PAGE: &str = "report.html";

/// Keys whose bars are drawn at most; the table has all.
const MOST_BARS: usize = 20;
/// Room around runs that are shown one by one, as a share of an axis.
const ROOM: f64 = 0.02;

/// Complete HTML document. Deterministic: the same summary gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(summary: &Summary) -> Result<String, PlotError> {
    let head: Vec<String> = summary.policies.iter().map(headline).collect();
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
    let mut page = HtmlPage::begun(&Head {
        title: format!("Sweep: {}", summary.scene),
        headline: head.join(" "),
        facts,
        warnings,
        ..Head::default()
    });
    page.section("Outcomes", |page| {
        page.table(&outcomes(summary));
        page.note(&Markup::text(bound(summary)));
        if let Some(sampled) = summary.sampled_runs {
            page.note(&Markup::text(format!(
                "Quantiles, influences and maps below are of {sampled} runs drawn at random."
            )));
        }
        for policy in &summary.policies {
            page.table(&quantiles(policy));
        }
    });
    let maps = (summary.maps.iter().map(map)).collect::<Result<Vec<_>, _>>()?;
    page.section("Where runs are lost", |page| {
        let text = match maps.is_empty() {
            true => "No two keys vary that could be shown against each other.",
            false => {
                "Over the two keys with the most influence, or those that maps in the sweep file names. Few runs are shown one by \
                 one, with crosses where the rotor is lost; of many the share that is lost, white where there is no run."
            }
        };
        page.note(&Markup::text(text));
        // Policies side by side.
        for of_pair in maps.chunks(summary.policies.len().max(1)) {
            page.figures(of_pair);
        }
    });
    page.section("What decides", |page| match &summary.indices {
        Some(of) => decided_by_indices(page, summary, of),
        None => decided_by_ranks(page, summary),
    });
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
    let said: Vec<String> = bounds
        .map(|(policy, most)| {
            format!(
                "Under {} none of {} independent runs was lost: with a confidence of 95 % at most {} of all such runs are (rule of three, 3 over the runs).",
                policy.policy,
                policy.runs,
                percent(most)
            )
        })
        .collect();
    match said.is_empty() {
        true => format!(
            "{lost} A bound on the share holds where runs are drawn independently (design monte_carlo), and none is lost or failed: the rule of three."
        ),
        false => format!("{lost} {}", said.join(" ")),
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

fn map(map: &OutcomeMap) -> Result<Drawn, PlotError> {
    let OutcomeMap {
        policy, x, y, dots, ..
    } = map;
    let name = format!("{policy}: {} and {}", x.key, y.key);
    let drawing = match dots {
        Some(dots) => chart(&Chart {
            label: format!("Outcomes under {policy} over {} and {}", x.key, y.key),
            x: axis(x, ROOM),
            y: axis(y, ROOM),
            curves: by_outcome(dots),
        })?,
        None => heat_map(&HeatMap {
            label: format!(
                "Share of runs lost under {policy} over {} and {}",
                x.key, y.key
            ),
            x: axis(x, 0.0),
            y: axis(y, 0.0),
            names: [x, y].map(|axis| names(axis).unwrap_or_default()),
            cells: (map.cells.iter())
                .map(|row| {
                    (row.iter())
                        .map(|cell| f64::from(cell.lost) / f64::from(cell.runs))
                        .collect()
                })
                .collect(),
            scale: (0.0, 1.0, "share lost".to_owned()),
        })?,
    };
    Ok(Drawn::new(&name, drawing, counted(map)))
}

/// Those that are lost as crosses, on top.
fn by_outcome(dots: &[(f64, f64, Outcome)]) -> Vec<Curve> {
    let curve = |(colour, outcome): (usize, Outcome)| {
        let points = dots.iter().filter(|dot| dot.2 == outcome);
        let points: Vec<(f64, f64)> = points.map(|dot| (dot.0, dot.1)).collect();
        let count = points.len();
        (count > 0).then(|| Curve {
            name: format!("{} ({count})", outcome.name()),
            points,
            mark: match outcome.recovered() {
                true => Mark::Dots,
                false => Mark::Crosses,
            },
            colour,
        })
    };
    // Blue and green for what is back, warm colours for the rest.
    let colours = [0, 2, 7, 5, 4, 1, 8, 3];
    (colours.into_iter().zip(Outcome::ALL))
        .filter_map(curve)
        .collect()
}

fn names(axis: &MapAxis) -> Option<Vec<String>> {
    match &axis.places {
        Places::Named(names) => Some(names.iter().map(|(name, _)| name.clone()).collect()),
        Places::Parts { .. } => None,
    }
}

/// With some room at both ends, as a share of the whole.
fn axis(of: &MapAxis, room: f64) -> Axis {
    match of.places {
        Places::Named(ref names) => Axis::linear(&of.key, (0.0, names.len() as f64)),
        Places::Parts {
            low,
            high,
            log: false,
            ..
        } => {
            let room = room * (high - low);
            Axis::linear(&of.key, (low - room, high + room))
        }
        Places::Parts { low, high, .. } => {
            let room = (high / low).powf(room);
            Axis::log(&of.key, (low / room, high * room))
        }
    }
}

/// Cells as numbers, the top row first as in the drawing.
fn counted(map: &OutcomeMap) -> Listing {
    let place = |axis: &MapAxis, at: usize| match names(axis) {
        Some(names) => names.get(at).cloned().unwrap_or_default(),
        None => {
            let [from, to] = [at, at + 1].map(|part| figures(axis.places.edge(part)));
            format!("{from} to {to}")
        }
    };
    let mut headings = vec![Markup::with_unit(&map.y.key, &map.x.key)];
    headings.extend((0..map.x.places.count()).map(|at| Markup::text(place(&map.x, at))));
    let rows = map.cells.iter().enumerate().rev().map(|(at, cells)| {
        let mut row = vec![Markup::text(place(&map.y, at))];
        row.extend(cells.iter().map(|cell| {
            Markup::text(match cell.runs {
                0 => "–".to_owned(),
                runs => format!("{} of {runs}", cell.lost),
            })
        }));
        row
    });
    Listing {
        caption: format!("Lost runs under {}", map.policy),
        headings,
        rows: rows.collect(),
        ..Listing::default()
    }
}

/// What bars show of a key, on loss and on the figure.
type Shown<'a> = (&'a str, [Vec<Option<Measured>>; 2]);

/// A figure for loss and one for the figure that the worst runs are chosen by, with what their tables show.
fn decided(
    page: &mut HtmlPage,
    summary: &Summary,
    (series, least_ranges): (&[&str], [f64; 2]),
    keys: &[Shown<'_>],
    mut listings: [Listing; 2],
) {
    let of = ["loss", &summary.worst_by];
    let mut drawn = Vec::new();
    for (i, name) in of.into_iter().enumerate() {
        let varies = keys.iter().any(|(_, of)| of[i].iter().any(Option::is_some));
        if !varies {
            page.note(&Markup::text(format!(
                "Nothing can be said about {name}: it does not vary, or too few runs have it."
            )));
            continue;
        }
        let label = format!("Influence of keys on {name} under {}", summary.worst_policy);
        let plot = Bars {
            label: label.clone(),
            series: series.iter().map(|name| (*name).to_owned()).collect(),
            things: (keys.iter().take(MOST_BARS))
                .map(|(key, of)| Thing {
                    name: (*key).to_owned(),
                    values: of[i].clone(),
                })
                .collect(),
            least_range: least_ranges[i],
        };
        let mut listing = std::mem::take(&mut listings[i]);
        listing.caption.clone_from(&label);
        drawn.push(Drawn::new(&label, bars(&plot), listing));
    }
    page.figures(&drawn);
}

fn listing(headings: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Listing {
    Listing::of_texts("", headings, rows)
}

fn decided_by_ranks(page: &mut HtmlPage, summary: &Summary) {
    page.note(&Markup::text(
        "Share of the variance of ranks that goes away when a key is known, as from groups of runs with close values: a \
         first-order index. What keys do only together it does not show; the designs saltelli and morris do.",
    ));
    let of = |key: &KeyInfluence| {
        let bar = |share: Option<f64>| vec![share.map(|share| (share, 0.0))];
        [bar(key.lost.first_order), bar(key.figure.first_order)]
    };
    let keys: Vec<Shown<'_>> = (summary.influences.iter())
        .map(|key| (key.key.as_str(), of(key)))
        .collect();
    let rows = |influence: fn(&KeyInfluence) -> crate::sweep::influence::Influence| {
        let number = |x: Option<f64>| x.map_or("–".to_owned(), figures);
        let row = move |key: &KeyInfluence| {
            let of = influence(key);
            vec![
                key.key.clone(),
                number(of.first_order),
                number(of.rank_correlation),
            ]
        };
        let headings = ["key", "share of the variance", "Spearman's correlation"];
        listing(&headings, summary.influences.iter().map(row))
    };
    let listings = [rows(|key| key.lost), rows(|key| key.figure)];
    decided(
        page,
        summary,
        (&["share of the variance"], [1.0; 2]),
        &keys,
        listings,
    );
}

fn decided_by_indices(page: &mut HtmlPage, summary: &Summary, indices: &Indices) {
    let saltelli = indices
        .keys
        .iter()
        .flat_map(|of| [of.lost, of.figure])
        .flatten();
    let saltelli = saltelli
        .clone()
        .next()
        .is_none_or(|of| matches!(of, Index::Sobol(_)));
    page.note(&Markup::text(match saltelli {
        true => {
            "Sobol indices: shares of the variance. First order: what goes away when the key alone is known. Total order: what is \
             left when all others are known, so also what the key does together with others, and with chance within a run. Lines \
             are intervals of 95 %."
        }
        false => {
            "Elementary effects: what changes when a key moves by half of its distribution, for the whole of it. Keys with a large \
             mean magnitude matter; a large standard deviation says that others decide how much. Lines are intervals of 95 %."
        }
    }));
    let [whole, with_figure, all] = [
        indices.whole_blocks,
        indices.whole_blocks_with_figure,
        indices.blocks,
    ];
    if whole.min(with_figure) < all {
        page.note(&Markup::text(format!(
            "Of {all} blocks of {} runs {whole} have all outcomes and {with_figure} all figures; {}",
            indices.block_runs,
            match saltelli {
                true => "the others are left out.",
                false => "of the others the moves between runs that have them count.",
            }
        )));
    }
    let bar = |index: Option<Index>| match index {
        Some(Index::Sobol(of)) => vec![
            Some((of.total_order, of.total_order_error)),
            Some((of.first_order, of.first_order_error)),
        ],
        Some(Index::Morris(of)) => vec![
            Some((of.mean_magnitude, of.mean_magnitude_error)),
            Some((of.standard_deviation, 0.0)),
        ],
        None => vec![None],
    };
    let keys: Vec<Shown<'_>> = (indices.keys.iter())
        .map(|of| (of.key.as_str(), [bar(of.lost), bar(of.figure)]))
        .collect();
    let (series, headings, least): (_, &[&str], _) = match saltelli {
        true => (
            ["total order", "first order"],
            &["key", "first order", "±", "total order", "±"],
            [1.0; 2],
        ),
        false => (
            ["mean magnitude", "standard deviation"],
            &[
                "key",
                "mean magnitude",
                "±",
                "mean",
                "standard deviation",
                "effects",
            ],
            [1.0, f64::MIN_POSITIVE],
        ),
    };
    let numbers = |index: Option<Index>| match index {
        Some(Index::Sobol(of)) => [
            of.first_order,
            of.first_order_error,
            of.total_order,
            of.total_order_error,
        ]
        .map(figures)
        .to_vec(),
        Some(Index::Morris(of)) => {
            let numbers = [
                of.mean_magnitude,
                of.mean_magnitude_error,
                of.mean,
                of.standard_deviation,
            ];
            let mut numbers = numbers.map(figures).to_vec();
            numbers.push(of.effects.to_string());
            numbers
        }
        None => Vec::new(),
    };
    let rows = |index: fn(&crate::sweep::indices::KeyIndices) -> Option<Index>| {
        let row = move |of: &crate::sweep::indices::KeyIndices| {
            let mut row = vec![of.key.clone()];
            row.extend(numbers(index(of)));
            row
        };
        listing(headings, indices.keys.iter().map(row))
    };
    let listings = [rows(|of| of.lost), rows(|of| of.figure)];
    decided(page, summary, (&series, least), &keys, listings);
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
