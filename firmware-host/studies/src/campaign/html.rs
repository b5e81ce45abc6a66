//! A page as one HTML document without scripts.

use super::chapter::{Block, Column, Drawing, Figure, Page, Table};
use firmware_bench::report::plot::PlotError;
use firmware_bench::report::plot::chart::{chart, heat_map};
use firmware_bench::report::plot::text::escape;
use std::fmt::Write as _;

const STYLE: &str = include_str!("style.css");

/// The document. Deterministic: the same page gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(page: &Page) -> Result<String, PlotError> {
    let title = escape(&page.title);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>{title}</h1>\n</header>\n<main>\n<nav aria-label=\"Contents\">\n<ol>\n"
    );
    for chapter in page.chapters.iter().filter(|chapter| !chapter.folded) {
        let (id, title) = (anchor(&chapter.title), escape(&chapter.title));
        push(
            &mut out,
            format_args!("<li><a href=\"#{id}\">{title}</a></li>\n"),
        );
    }
    out.push_str("</ol>\n</nav>\n<section id=\"summary\">\n<h2>Summary</h2>\n");
    push_blocks(&mut out, &page.lead, 0)?;
    out.push_str("</section>\n");
    for (i, chapter) in page.chapters.iter().enumerate() {
        let (number, title) = (i + 1, escape(&chapter.title));
        if chapter.folded {
            push(
                &mut out,
                format_args!("<details>\n<summary>{title}</summary>\n"),
            );
            push_blocks(&mut out, &chapter.blocks, number)?;
            out.push_str("</details>\n");
        } else {
            let id = anchor(&chapter.title);
            push(
                &mut out,
                format_args!("<section id=\"{id}\">\n<h2>{number} {title}</h2>\n"),
            );
            push_blocks(&mut out, &chapter.blocks, number)?;
            out.push_str("</section>\n");
        }
    }
    out.push_str("</main>\n</body>\n</html>\n");
    Ok(out)
}

/// A title as an anchor.
fn anchor(title: &str) -> String {
    (title.to_lowercase().chars())
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect()
}

fn push_blocks(out: &mut String, blocks: &[Block], chapter: usize) -> Result<(), PlotError> {
    for block in blocks {
        match block {
            Block::Paragraph(text) => {
                push(
                    out,
                    format_args!("<p class=\"story\">{}</p>\n", with_code(text)),
                );
            }
            Block::List(points) => {
                out.push_str("<ul>\n");
                for point in points {
                    push(out, format_args!("<li>{}</li>\n", escape(point)));
                }
                out.push_str("</ul>\n");
            }
            Block::Table(table, marked) => push_table(out, table, marked),
            Block::Figures(figures) => {
                out.push_str("<div class=\"figures\">\n");
                for (j, figure) in figures.iter().enumerate() {
                    push_figure(out, &format!("{chapter}.{}", j + 1), figure)?;
                }
                out.push_str("</div>\n");
            }
        }
    }
    Ok(())
}

/// Text with its parts between backticks as code.
fn with_code(text: &str) -> String {
    let parts = escape(text);
    let part = |(i, part): (usize, &str)| match i % 2 {
        0 => part.to_owned(),
        _ => format!("<code>{part}</code>"),
    };
    parts.split('`').enumerate().map(part).collect()
}

fn push_table(out: &mut String, table: &Table, marked: &[bool]) {
    out.push_str("<div class=\"scroll\">\n<table>\n");
    if !table.caption.is_empty() {
        push(
            out,
            format_args!("<caption>{}</caption>\n", escape(&table.caption)),
        );
    }
    out.push_str("<thead><tr>");
    let classes: Vec<&str> = (0..table.columns.len()).map(|i| class(table, i)).collect();
    for (heading, class) in table.columns.iter().zip(&classes) {
        let heading = escape(heading);
        push(out, format_args!("<th scope=\"col\"{class}>{heading}</th>"));
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for (i, row) in table.rows.iter().enumerate() {
        let mark = match marked.get(i) {
            Some(true) => " class=\"miss\"",
            _ => "",
        };
        push(out, format_args!("<tr{mark}>"));
        for (cell, class) in row.iter().zip(&classes) {
            push(out, format_args!("<td{class}>{}</td>", escape(cell)));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table>\n</div>\n");
}

fn class(table: &Table, column: usize) -> &'static str {
    match table.kind_of(column) {
        Column::Numbers => " class=\"number\"",
        Column::Words => "",
        Column::LongTexts => " class=\"long\"",
    }
}

fn push_figure(out: &mut String, number: &str, figure: &Figure) -> Result<(), PlotError> {
    let drawing = match &figure.drawing {
        Drawing::Chart(plot) => chart(plot)?,
        Drawing::Map(plot) => heat_map(plot)?,
    };
    let (id, caption) = (anchor(figure.file), escape(&figure.caption));
    push(
        out,
        format_args!(
            "<figure id=\"figure-{id}\">\n<div class=\"plot\">{drawing}</div>\n\
             <figcaption><b>Figure {number}.</b> {caption}</figcaption>\n</figure>\n"
        ),
    );
    Ok(())
}

/// Writing to a string cannot fail.
fn push(out: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = out.write_fmt(text);
}
