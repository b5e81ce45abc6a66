//! The chapters as one HTML document without scripts.

use super::{Chapter, Drawing, Row, Table};
use crate::plot::PlotError;
use crate::plot::chart::{chart, heat_map};
use crate::plot::text::{escape, figures};
use std::fmt::Write as _;

const STYLE: &str = include_str!("../report/style.css");

/// The page. Deterministic: the same chapters give the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(chapters: &[Chapter]) -> Result<String, PlotError> {
    let title = "The paper, reproduced";
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>{title}</h1>\n</header>\n<main>\n"
    );
    for chapter in chapters {
        push(
            &mut page,
            format_args!("<section>\n<h2>{}</h2>\n", escape(chapter.title)),
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
        for figure in &chapter.figures {
            let drawing = match &figure.drawing {
                Drawing::Chart(plot) => chart(plot)?,
                Drawing::Map(plot) => heat_map(plot)?,
            };
            let caption = escape(&figure.caption);
            push(
                &mut page,
                format_args!(
                    "<figure>\n{drawing}\n<figcaption>{caption}</figcaption>\n</figure>\n"
                ),
            );
        }
        for table in &chapter.tables {
            push_table(&mut page, table);
        }
        page.push_str("</section>\n");
    }
    page.push_str("</main>\n</body>\n</html>\n");
    Ok(page)
}

fn push_rows(page: &mut String, rows: &[Row]) {
    let optional = |value: Option<f64>| value.map_or("–".to_owned(), figures);
    let table = Table {
        caption: "Paper and model".to_owned(),
        columns: [
            "Quantity",
            "Unit",
            "Source",
            "Paper",
            "Computed",
            "Deviation",
            "",
            "Note",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: (rows.iter())
            .map(|row| {
                vec![
                    row.quantity.clone(),
                    row.unit.to_owned(),
                    row.source.to_owned(),
                    optional(row.paper),
                    optional(row.computed),
                    (row.deviation).map_or("–".to_owned(), |d| format!("{:+.1} %", 100.0 * d)),
                    format!("{:?}", row.kind).to_lowercase(),
                    row.note.clone(),
                ]
            })
            .collect(),
    };
    push_table(page, &table);
}

fn push_table(page: &mut String, table: &Table) {
    let caption = escape(&table.caption);
    push(
        page,
        format_args!("<div class=\"scroll\">\n<table>\n<caption>{caption}</caption>\n<thead><tr>"),
    );
    for heading in &table.columns {
        push(
            page,
            format_args!("<th scope=\"col\">{}</th>", escape(heading)),
        );
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for row in &table.rows {
        page.push_str("<tr>");
        for cell in row {
            push(page, format_args!("<td>{}</td>", escape(cell)));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table>\n</div>\n");
}

/// Writing to a string cannot fail.
fn push(page: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = page.write_fmt(text);
}
