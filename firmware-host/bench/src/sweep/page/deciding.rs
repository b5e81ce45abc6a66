//! What decides: bars of influence, and their tables.

use crate::report::html_page::HtmlPage;
use crate::report::listing::Listing;
use crate::report::markup::Markup;
use crate::report::plot::bars::{Bar, bars};
use crate::report::plot::text::figures;
use crate::report::rendered::Rendered;
use crate::sweep::influence::Influence;
use crate::sweep::summary::{KeyInfluence, Summary};

/// Keys whose bars are drawn at most; the table has all.
const MOST_BARS: usize = 20;

/// A figure for loss and one for the figure that the worst runs are chosen by, each with its table.
pub(super) fn decided(page: &mut HtmlPage, summary: &Summary) {
    page.note(&Markup::text(
        "Share of the variance of ranks that goes away when a key is known, as from groups of runs with close values: a \
         first-order index. What keys do only together it does not show.",
    ));
    let on_loss: fn(&KeyInfluence) -> Influence = |key| key.lost;
    let on_figure: fn(&KeyInfluence) -> Influence = |key| key.figure;
    let mut drawn = Vec::new();
    for (name, influence) in [("loss", on_loss), (&summary.worst_by, on_figure)] {
        let keys = summary.influences.iter();
        let keys: Vec<(&str, Influence)> =
            keys.map(|key| (key.key.as_str(), influence(key))).collect();
        if keys.iter().all(|(_, of)| of.first_order.is_none()) {
            page.note(&Markup::text(format!(
                "Nothing can be said about {name}: it does not vary, or too few runs have it."
            )));
            continue;
        }
        let label = format!("Influence of keys on {name} under {}", summary.worst_policy);
        let shares: Vec<Bar> = (keys.iter().take(MOST_BARS))
            .map(|(key, of)| Bar {
                name: (*key).to_owned(),
                share: of.first_order,
            })
            .collect();
        let number = |x: Option<f64>| x.map_or("–".to_owned(), figures);
        let row = |(key, of): (&str, Influence)| {
            let numbers = [of.first_order, of.rank_correlation].map(number);
            [vec![key.to_owned()], numbers.to_vec()].concat()
        };
        let headings = ["key", "share of the variance", "Spearman's correlation"];
        let listing = Listing::of_texts(&label, headings, keys.into_iter().map(row));
        drawn.push(Rendered::new(&label, bars(&label, &shares), listing));
    }
    page.figures(&drawn);
}
