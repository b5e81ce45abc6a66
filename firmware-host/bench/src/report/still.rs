//! A page without a script: sections of text, tables and drawings, each drawing with its numbers.

use super::data::{folded, table};
use super::document::begun;
use super::summary::Fact;
use super::{badge, push, push_headline, push_list, push_story, push_warnings};
use crate::report::plot::text::escape;
use crate::run::outcome::Outcome;

/// Text for a page, safe where it stands.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Markup(String);

impl Markup {
    /// A text as it is.
    pub fn text(text: impl AsRef<str>) -> Self {
        Self(escape(text.as_ref()))
    }

    /// A text, and what it is in smaller letters below.
    pub fn with_unit(text: &str, unit: &str) -> Self {
        match unit {
            "" => Self::text(text),
            unit => Self(format!("{} <small>{}</small>", escape(text), escape(unit))),
        }
    }

    /// A link to a file beside the page.
    pub fn link(file: &str) -> Self {
        let file = escape(file);
        Self(format!("<a href=\"{file}\">{file}</a>"))
    }

    /// Words of a command line or a file.
    pub fn code(text: &str) -> Self {
        Self(format!("<code>{}</code>", escape(text)))
    }

    /// How a run ended.
    pub fn outcome(outcome: Outcome) -> Self {
        Self(badge(outcome))
    }

    /// A text for readers of HTML.
    pub fn as_html(&self) -> &str {
        &self.0
    }
}

/// Headings and rows of a table; the first cell of a row is its heading.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Listing {
    /// What it shows.
    pub caption: String,
    /// A heading a column.
    pub headings: Vec<Markup>,
    /// As many cells each.
    pub rows: Vec<Vec<Markup>>,
}

/// A page that is being written.
pub struct StillPage(String);

impl StillPage {
    /// A page with its title, conclusion, paragraphs below it, facts and warnings.
    pub fn begun(
        title: &str,
        (headline, story): (&str, &str),
        facts: &[Fact],
        warnings: &[String],
    ) -> Self {
        let mut html = begun(title, "");
        if !headline.is_empty() {
            push_headline(&mut html, headline);
        }
        push_story(&mut html, story);
        if !facts.is_empty() {
            push_list(&mut html, facts);
        }
        push_warnings(&mut html, warnings);
        html.push_str("</header>\n<main>\n");
        Self(html)
    }

    /// A part under a heading.
    pub fn section(&mut self, heading: &str, write: impl FnOnce(&mut Self)) {
        let heading = escape(heading);
        push(&mut self.0, format_args!("<section>\n<h2>{heading}</h2>\n"));
        write(self);
        self.0.push_str("</section>\n");
    }

    /// A paragraph.
    pub fn note(&mut self, text: &Markup) {
        let text = text.as_html();
        push(&mut self.0, format_args!("<p class=\"note\">{text}</p>\n"));
    }

    /// A table in sight.
    pub fn table(&mut self, listing: &Listing) {
        self.0.push_str(&html_of(listing, table));
    }

    /// Drawings side by side, each with its name and its numbers.
    pub fn figures(&mut self, figures: &[(String, String, Listing)]) {
        let panels = figures.len().max(1);
        push(
            &mut self.0,
            format_args!("<div class=\"grid\" style=\"--panels:{panels}\">\n"),
        );
        for (name, drawing, listing) in figures {
            let (name, data) = (escape(name), html_of(listing, folded));
            push(
                &mut self.0,
                format_args!(
                    "<figure><figcaption><b>{name}</b></figcaption>\n{drawing}\n{data}</figure>\n"
                ),
            );
        }
        self.0.push_str("</div>\n");
    }

    /// A drawing whose numbers stand elsewhere on the page.
    pub fn figure(&mut self, drawing: &str) {
        push(&mut self.0, format_args!("<figure>{drawing}</figure>\n"));
    }

    /// Lines as a terminal has them.
    pub fn lines(&mut self, text: &str) {
        let text = escape_lines(text);
        push(
            &mut self.0,
            format_args!(
                "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"Tables\"><pre>{text}</pre></div>\n"
            ),
        );
    }

    /// The whole page.
    pub fn ended(mut self) -> String {
        self.0.push_str("</main>\n</body>\n</html>\n");
        self.0
    }
}

fn escape_lines(text: &str) -> String {
    let lines: Vec<String> = text.split('\n').map(escape).collect();
    lines.join("\n")
}

type Write = fn(&str, &[String], &mut dyn Iterator<Item = Vec<String>>) -> String;

fn html_of(listing: &Listing, write: Write) -> String {
    let cells = |all: &[Markup]| all.iter().map(|cell| cell.0.clone()).collect::<Vec<_>>();
    let mut rows = listing.rows.iter().map(|row| cells(row));
    write(
        &escape(&listing.caption),
        &cells(&listing.headings),
        &mut rows,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_users_wrote_stays_text() {
        let bad = "<script>\"'&";
        let mut page = StillPage::begun(
            bad,
            (bad, bad),
            &[("Fact", bad.to_owned())],
            &[bad.to_owned()],
        );
        let listing = Listing {
            caption: bad.to_owned(),
            headings: vec![Markup::with_unit(bad, bad), Markup::text(bad)],
            rows: vec![vec![Markup::link(bad), Markup::code(bad)]],
        };
        page.section(bad, |page| {
            page.note(&Markup::text(bad));
            page.table(&listing);
            page.figures(&[(bad.to_owned(), String::new(), listing.clone())]);
            page.lines(&format!("{bad}\nnext"));
        });
        let html = page.ended();
        assert!(!html.contains("<script") && html.ends_with("</html>\n"));
        assert!(html.contains("default-src 'none'; style-src 'unsafe-inline'\">"));
        assert!(html.contains("&amp;\nnext</pre>"));
        assert_eq!(html.matches("<table").count(), 2);
    }
}
