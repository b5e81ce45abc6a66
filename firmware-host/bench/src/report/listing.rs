//! Tables of a page: every one of them is written here.

use super::lines::Lines;
use super::markup::Markup;
use super::push;
use crate::report::plot::text::escape;

/// What is in a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// Mostly numbers, which stand to the right.
    Numbers,
    Words,
    /// Texts that need room.
    LongTexts,
}

/// Headings and rows of a table; the first cell of a row is its heading.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Listing {
    /// What it shows; may be empty in a part with a heading of its own.
    pub caption: String,
    /// A heading a column.
    pub headings: Vec<Markup>,
    /// What is in the columns; of those that are not said words in the first, numbers in the others.
    pub columns: Vec<Column>,
    /// As many cells each as there are headings.
    pub rows: Vec<Vec<Markup>>,
    /// Which rows are to catch the eye; none of those beyond its end.
    pub marked: Vec<bool>,
    /// Whether it stays low, and its rows scroll.
    pub low: bool,
}

impl Listing {
    /// Of plain texts.
    pub fn of_texts<H: AsRef<str>, C: AsRef<str>>(
        caption: impl Into<String>,
        headings: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<C>>,
    ) -> Self {
        let row = |row: Vec<C>| row.iter().map(Markup::text).collect();
        Self {
            caption: caption.into(),
            headings: headings.into_iter().map(Markup::text).collect(),
            rows: rows.into_iter().map(row).collect(),
            ..Self::default()
        }
    }

    /// What a terminal has as a table.
    pub(crate) fn of_lines(caption: impl Into<String>, lines: &Lines) -> Self {
        let columns = (0..lines.headings().count()).map(|i| match lines.is_of_figures(i) {
            true => Column::Numbers,
            false => Column::Words,
        });
        Self {
            columns: columns.collect(),
            ..Self::of_texts(caption, lines.headings(), lines.rows())
        }
    }

    fn kind_of(&self, column: usize) -> Column {
        match (self.columns.get(column), column) {
            (Some(kind), _) => *kind,
            (None, 0) => Column::Words,
            (None, _) => Column::Numbers,
        }
    }

    /// As HTML, in a room that scrolls where the page is narrow; `part`: the heading above it.
    pub(super) fn html(&self, part: &str) -> String {
        let mut html = String::new();
        let caption = escape(&self.caption);
        let label = match caption.is_empty() {
            true => format!("Table: {}", escape(part)),
            false => caption.clone(),
        };
        let class = if self.low { "scroll low" } else { "scroll" };
        push(
            &mut html,
            format_args!(
                "<div class=\"{class}\" role=\"group\" tabindex=\"0\" aria-label=\"{label}\"><table>"
            ),
        );
        if !caption.is_empty() {
            push(&mut html, format_args!("<caption>{caption}</caption>"));
        }
        let classes: Vec<&str> = (0..self.headings.len())
            .map(|column| match (self.kind_of(column), column) {
                (Column::Numbers, 0) => " class=\"number\"",
                (Column::Words, 0) | (Column::Numbers, _) => "",
                (Column::Words, _) => " class=\"words\"",
                (Column::LongTexts, _) => " class=\"words long\"",
            })
            .collect();
        html.push_str("<thead><tr>");
        for (heading, class) in self.headings.iter().zip(&classes) {
            // What is empty heads nothing.
            match heading.as_html() {
                "" => html.push_str("<td></td>"),
                heading => push(
                    &mut html,
                    format_args!("<th scope=\"col\"{class}>{heading}</th>"),
                ),
            }
        }
        html.push_str("</tr></thead><tbody>\n");
        if self.rows.is_empty() {
            let columns = self.headings.len();
            push(
                &mut html,
                format_args!("<tr><td class=\"words\" colspan=\"{columns}\">nothing</td></tr>\n"),
            );
        }
        for (i, row) in self.rows.iter().enumerate() {
            html.push_str(match self.marked.get(i) {
                Some(true) => "<tr class=\"miss\">",
                _ => "<tr>",
            });
            for (i, (cell, class)) in row.iter().zip(&classes).enumerate() {
                let cell = cell.as_html();
                match i {
                    0 if !cell.is_empty() => push(
                        &mut html,
                        format_args!("<th scope=\"row\"{class}>{cell}</th>"),
                    ),
                    _ => push(&mut html, format_args!("<td{class}>{cell}</td>")),
                }
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody></table></div>\n");
        html
    }

    /// Folded, as below a figure; nothing without columns.
    pub(super) fn folded(&self) -> String {
        if self.headings.is_empty() {
            return String::new();
        }
        let table = self.html("");
        format!("<details class=\"data\"><summary>Data</summary>{table}</details>\n")
    }
}
