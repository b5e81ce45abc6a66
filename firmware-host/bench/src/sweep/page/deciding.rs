//! What decides: bars of influence or of indices, and their tables.

use crate::report::drawn::Drawn;
use crate::report::html_page::HtmlPage;
use crate::report::listing::Listing;
use crate::report::markup::Markup;
use crate::report::plot::bars::{Bars, Measured, Thing, bars};
use crate::report::plot::text::figures;
use crate::sweep::indices::{Index, Indices};
use crate::sweep::summary::{KeyInfluence, Summary};

/// Keys whose bars are drawn at most; the table has all.
const MOST_BARS: usize = 20;

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

pub(super) fn decided_by_ranks(page: &mut HtmlPage, summary: &Summary) {
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

pub(super) fn decided_by_indices(page: &mut HtmlPage, summary: &Summary, indices: &Indices) {
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
