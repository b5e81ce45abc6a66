//! What a log of a commissioning run shows, as a page: how the machine answers, the fit, numbers and differences.

use super::PlotError;
use super::html_page::{Head, HtmlPage};
use super::listing::{Column, Listing};
use super::plot::chart::{Axis, Chart, Curve, Mark};
use super::rendered::Rendered;
use crate::commission::{Answer, AnswerPoint, Commissioned};

/// A page of what was found in a log of this name.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(log: &str, found: &Commissioned) -> Result<String, PlotError> {
    let head = Head {
        title: format!("Commissioning: {log}"),
        headline: headline(found),
        ..Head::default()
    };
    let mut page = HtmlPage::begun(&head);
    let answers = || found.answers.iter().filter(|a| !a.points.is_empty());
    let fits: Vec<Rendered> = answers()
        .map(|answer| Rendered::of_chart(&fit(answer)))
        .collect::<Result<_, _>>()?;
    let rests: Vec<Rendered> = answers()
        .map(|answer| Rendered::of_chart(&rest(answer)))
        .collect::<Result<_, _>>()?;
    if !fits.is_empty() {
        page.section("Answer to the stimulus", |page| page.figures(&fits));
    }
    page.section("Numbers", |page| page.table(&numbers(found)));
    if !found.contradictions.is_empty() {
        page.section("Configured otherwise", |page| {
            page.table(&differences(found));
        });
    }
    page.section("Not found", |page| page.table(&missing(found)));
    if !rests.is_empty() {
        page.section("What the fit leaves", |page| page.figures(&rests));
    }
    Ok(page.ended())
}

fn headline(found: &Commissioned) -> String {
    let numbers = found.parameters.len();
    let missing = found.not_found.len();
    match found.contradictions.first() {
        None => format!("{numbers} numbers found, none configured otherwise; {missing} not found."),
        Some(first) => format!(
            "{numbers} numbers found, {} configured otherwise, before all {}; {missing} not found.",
            found.contradictions.len(),
            first.name
        ),
    }
}

fn short(x: f64) -> String {
    format!("{x:.4e}")
}

/// Of each number name, unit, value, interval, and what it rests on.
pub fn number_rows(found: &Commissioned) -> impl Iterator<Item = Vec<String>> {
    found.parameters.iter().map(|f| {
        let [value, low, high] = [f.value, f.low, f.high].map(short);
        vec![
            f.name.clone(),
            f.unit.to_owned(),
            value,
            low,
            high,
            f.from.clone(),
        ]
    })
}

/// Of each number that is configured otherwise name, configured value, interval, and what it costs.
pub fn difference_rows(found: &Commissioned) -> impl Iterator<Item = Vec<String>> {
    found.contradictions.iter().map(|c| {
        let [configured, low, high] = [c.configured, c.low, c.high].map(short);
        vec![c.name.clone(), configured, low, high, c.costs.clone()]
    })
}

/// What is not found, and why.
pub fn missing_rows(found: &Commissioned) -> impl Iterator<Item = Vec<String>> {
    (found.not_found.iter()).map(|m| vec![m.name.clone(), m.reason.clone()])
}

fn numbers(found: &Commissioned) -> Listing {
    let headings = ["number", "unit", "value", "at least", "at most", "from"];
    Listing {
        columns: vec![
            Column::Words,
            Column::Words,
            Column::Numbers,
            Column::Numbers,
            Column::Numbers,
            Column::Words,
        ],
        ..Listing::of_texts("", headings, number_rows(found))
    }
}

fn differences(found: &Commissioned) -> Listing {
    let headings = ["number", "configured", "at least", "at most", "costs"];
    Listing {
        columns: vec![
            Column::Words,
            Column::Numbers,
            Column::Numbers,
            Column::Numbers,
            Column::Words,
        ],
        ..Listing::of_texts("", headings, difference_rows(found))
    }
}

fn missing(found: &Commissioned) -> Listing {
    Listing {
        columns: vec![Column::Words, Column::Words],
        ..Listing::of_texts(
            "",
            ["number", "why, and what would show it"],
            missing_rows(found),
        )
    }
}

/// Motion at the frequencies of the stimulus, read and fitted.
fn fit(answer: &Answer) -> Chart {
    let curve = |name: &str, mark, colour, of: fn(&AnswerPoint) -> f64| Curve {
        name: name.to_owned(),
        points: points(answer, of),
        mark,
        colour,
    };
    let read = curve("read", Mark::Dots, 0, |p| 1e6 * p.read_m);
    let fitted = curve("fitted", Mark::Crosses, 1, |p| 1e6 * p.fitted_m);
    Chart {
        label: format!("Motion along {}", answer.name),
        x: frequencies(answer),
        y: Axis::linear("amplitude / µm", amplitudes(&[&read, &fitted])),
        curves: vec![read, fitted],
    }
}

/// What is left between both.
fn rest(answer: &Answer) -> Chart {
    let rest = Curve {
        name: "left".to_owned(),
        points: points(answer, |p| {
            100.0 * p.left_m / p.read_m.max(f64::MIN_POSITIVE)
        }),
        mark: Mark::Dots,
        colour: 2,
    };
    let highest = rest.points.iter().fold(1.0_f64, |most, p| most.max(p.1));
    Chart {
        label: format!("Left of the motion along {}", answer.name),
        x: frequencies(answer),
        y: Axis::linear("left / %", (0.0, 1.1 * highest)),
        curves: vec![rest],
    }
}

fn points(answer: &Answer, of: fn(&AnswerPoint) -> f64) -> Vec<(f64, f64)> {
    let points = answer.points.iter();
    points.map(|p| (p.frequency_hz, of(p))).collect()
}

fn frequencies(answer: &Answer) -> Axis {
    let of = |p: &AnswerPoint| p.frequency_hz;
    let high = answer.points.iter().map(of).fold(1.0, f64::max);
    Axis::linear("frequency / Hz", (0.0, 1.1 * high))
}

/// From nothing to beyond the largest.
fn amplitudes(curves: &[&Curve]) -> (f64, f64) {
    let values = curves.iter().flat_map(|c| &c.points).map(|p| p.1);
    let high = values.fold(0.0, f64::max);
    (0.0, if high > 0.0 { 1.1 * high } else { 1.0 })
}
