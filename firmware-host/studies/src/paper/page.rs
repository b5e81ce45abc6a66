//! The chapters as one HTML document without scripts.

use super::rows::{computed, deviation, kind, paper};
use super::summary::Summary;
use super::{Chapter, Drawing, Figure, Row, Table};
use firmware_bench::report::plot::PlotError;
use firmware_bench::report::plot::chart::{chart, heat_map};
use firmware_bench::report::plot::text::escape;
use std::fmt::Write as _;

const STYLE: &str = include_str!("style.css");
const TITLE: &str = "Dry friction backward whirl: the paper, reproduced";

/// The page. Deterministic: the same chapters give the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(chapters: &[Chapter]) -> Result<String, PlotError> {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{TITLE}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>{TITLE}</h1>\n</header>\n<main>\n"
    );
    push_summary(&mut page, chapters);
    for (i, chapter) in chapters.iter().enumerate() {
        let (number, title) = (i + 1, escape(chapter.title));
        let id = anchor(chapter.title);
        push(
            &mut page,
            format_args!("<section id=\"{id}\">\n<h2>{number} {title}</h2>\n"),
        );
        for paragraph in &chapter.story {
            push(
                &mut page,
                format_args!("<p class=\"story\">{}</p>\n", escape(paragraph)),
            );
        }
        if !chapter.rows.is_empty() {
            push_rows(&mut page, &chapter.rows);
        }
        page.push_str("<div class=\"figures\">\n");
        for (j, figure) in chapter.figures.iter().enumerate() {
            push_figure(&mut page, &format!("{number}.{}", j + 1), figure)?;
        }
        page.push_str("</div>\n");
        for table in &chapter.tables {
            push_table(&mut page, table);
        }
        page.push_str("</section>\n");
    }
    page.push_str("</main>\n</body>\n</html>\n");
    Ok(page)
}

/// A title as an anchor.
fn anchor(title: &str) -> String {
    (title.to_lowercase().chars())
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect()
}

fn push_summary(page: &mut String, chapters: &[Chapter]) {
    page.push_str("<nav aria-label=\"Contents\">\n<ol>\n");
    for chapter in chapters {
        let (id, title) = (anchor(chapter.title), escape(chapter.title));
        push(
            page,
            format_args!("<li><a href=\"#{id}\">{title}</a></li>\n"),
        );
    }
    page.push_str("</ol>\n</nav>\n<section id=\"summary\">\n<h2>Summary</h2>\n");
    page.push_str(
        "<p class=\"story\">Numbers and figures of the paper \u{201c}Dry Friction Backward Whirl of Rotors: \
         Theory, Experiments, Results, and Recommendations\u{201d}, computed from its equations (2.1) to (2.9). \
         Where the paper's figures are not legible as numbers, only what its text says is compared.</p>\n<ul>\n",
    );
    let summary = Summary::of(chapters);
    for sentence in summary.sentences() {
        push(page, format_args!("<li>{}</li>\n", escape(&sentence)));
    }
    page.push_str("</ul>\n");
    if summary.misses.is_empty() {
        page.push_str("</section>\n");
        return;
    }
    let rows = (summary.misses.iter())
        .map(|(chapter, row)| {
            [chapter.title.to_owned()]
                .into_iter()
                .chain(cells(row))
                .collect()
        })
        .collect();
    let mut columns = vec!["Chapter".to_owned()];
    columns.extend(COLUMNS.map(str::to_owned));
    let table = Table {
        caption: "Rows that miss, and why".to_owned(),
        columns,
        rows,
    };
    push_table(page, &table);
    page.push_str("</section>\n");
}

const COLUMNS: [&str; 8] = [
    "Quantity",
    "Source",
    "Paper",
    "Computed",
    "Unit",
    "Deviation",
    "Kind",
    "Note",
];

fn cells(row: &Row) -> [String; 8] {
    [
        row.quantity.clone(),
        row.source.to_owned(),
        paper(row),
        computed(row),
        row.unit.to_owned(),
        deviation(row),
        kind(row.kind).to_owned(),
        row.note.clone(),
    ]
}

fn push_rows(page: &mut String, rows: &[Row]) {
    let table = Table {
        caption: "Paper and model".to_owned(),
        columns: COLUMNS.map(str::to_owned).to_vec(),
        rows: rows.iter().map(|row| cells(row).to_vec()).collect(),
    };
    let missed: Vec<bool> = rows.iter().map(|r| r.holds() == Some(false)).collect();
    push_marked(page, &table, &missed);
}

fn push_table(page: &mut String, table: &Table) {
    push_marked(page, table, &[]);
}

/// A table, with the rows marked that miss.
fn push_marked(page: &mut String, table: &Table, missed: &[bool]) {
    let caption = escape(&table.caption);
    push(
        page,
        format_args!("<div class=\"scroll\">\n<table>\n<caption>{caption}</caption>\n<thead><tr>"),
    );
    let classes: Vec<&str> = (0..table.columns.len()).map(|i| class(table, i)).collect();
    for (heading, class) in table.columns.iter().zip(&classes) {
        let heading = escape(heading);
        push(
            page,
            format_args!("<th scope=\"col\"{class}>{heading}</th>"),
        );
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for (i, row) in table.rows.iter().enumerate() {
        let mark = match missed.get(i) {
            Some(true) => " class=\"miss\"",
            _ => "",
        };
        push(page, format_args!("<tr{mark}>"));
        for (cell, class) in row.iter().zip(&classes) {
            push(page, format_args!("<td{class}>{}</td>", escape(cell)));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table>\n</div>\n");
}

/// Numbers stand to the right, words to the left, and long texts get room.
fn class(table: &Table, column: usize) -> &'static str {
    let filled = || {
        (table.rows.iter().filter_map(|row| row.get(column)))
            .filter(|cell| !cell.is_empty() && *cell != "–" && *cell != "∞")
    };
    let numeric = |cell: &String| {
        cell.starts_with(|c: char| c.is_ascii_digit() || "+-\u{2212}≤≥".contains(c))
            && cell.chars().count() < 24
    };
    let numbers = filled().filter(|cell| numeric(cell)).count();
    if filled().any(|cell| cell.chars().count() > 60) {
        " class=\"long\""
    } else if 2 * numbers > filled().count() {
        " class=\"number\""
    } else {
        ""
    }
}

fn push_figure(page: &mut String, number: &str, figure: &Figure) -> Result<(), PlotError> {
    let drawing = match &figure.drawing {
        Drawing::Chart(plot) => chart(plot)?,
        Drawing::Map(plot) => heat_map(plot)?,
    };
    let (id, caption) = (anchor(figure.file), escape(&figure.caption));
    push(
        page,
        format_args!(
            "<figure id=\"figure-{id}\">\n<div class=\"plot\">{drawing}</div>\n\
             <figcaption><b>Figure {number}.</b> {caption}</figcaption>\n</figure>\n"
        ),
    );
    Ok(())
}

/// Writing to a string cannot fail.
fn push(page: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = page.write_fmt(text);
}
