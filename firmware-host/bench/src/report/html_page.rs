//! The one builder of pages: head with the conclusion first, sections of text, tables and figures, each figure with its numbers.
//! A page that needs no script is complete with it; `document` adds what makes figures move.

use super::listing::Listing;
use super::markup::Markup;
use super::push;
use super::rendered::Rendered;
use super::summary::Fact;
use crate::report::plot::text::escape;

const STYLE: &str = concat!(
    include_str!("style.css"),
    include_str!("uplot/uPlot.min.css"),
    "\n"
);

/// What stands above everything else.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Head {
    /// Title of the page, one line.
    pub title: String,
    /// The conclusion, a sentence or two.
    pub headline: String,
    /// Paragraphs below the first figure, with an empty line between two.
    pub story: String,
    /// What it is about, in figures.
    pub facts: Vec<Fact>,
    /// What is to be known before, a line each.
    pub points: Vec<String>,
    /// What is damaged, cannot be trusted or does not fit.
    pub warnings: Vec<String>,
}

/// A page that is being written.
pub struct HtmlPage {
    html: String,
    /// Of the part that is being written.
    heading: String,
}

impl HtmlPage {
    /// A page with its head.
    pub fn begun(head: &Head) -> Self {
        Self::with_scripts(head, "")
    }

    /// With what its scripts may be, as its content security policy has it.
    pub(super) fn with_scripts(head: &Head, scripts: &str) -> Self {
        let title = escape(&head.title);
        let html = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" \
             content=\"default-src 'none'; style-src 'unsafe-inline'{scripts}\">\n\
             <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n"
        );
        let mut page = Self {
            html,
            heading: String::new(),
        };
        // Before anything is concluded.
        for warning in &head.warnings {
            page.warning(&format!("Warning: {warning}"));
        }
        if !head.headline.is_empty() {
            page.classed("headline", &Markup::text(&head.headline));
        }
        page.push("</header>\n<main>\n");
        page
    }

    /// What it is about. Below the first figure, which is to be seen before anybody scrolls.
    pub(crate) fn about(&mut self, head: &Head) {
        self.block(|page| {
            page.story(&head.story);
            page.facts(&head.facts);
            let points: Vec<Markup> = head.points.iter().map(Markup::text).collect();
            page.points(&points);
        });
    }

    /// Parts that stand in columns where the screen is wide.
    pub(crate) fn columns<T>(&mut self, write: impl FnOnce(&mut Self) -> T) -> T {
        self.within("<div class=\"columns\">\n", "</div>\n", write)
    }

    /// A part of columns that stays whole.
    pub(crate) fn block<T>(&mut self, write: impl FnOnce(&mut Self) -> T) -> T {
        self.within("<div>\n", "</div>\n", write)
    }

    fn within<T>(&mut self, opened: &str, closed: &str, write: impl FnOnce(&mut Self) -> T) -> T {
        self.push(opened);
        let written = write(self);
        self.push(closed);
        written
    }

    /// HTML that is written out in this crate.
    pub(super) fn push(&mut self, html: &str) {
        self.html.push_str(html);
    }

    fn classed(&mut self, class: &str, text: &Markup) {
        let text = text.as_html();
        push(
            &mut self.html,
            format_args!("<p class=\"{class}\">{text}</p>\n"),
        );
    }

    /// Lines that a scene file wraps belong to one paragraph; an empty line begins another.
    fn story(&mut self, story: &str) {
        let lines: Vec<_> = story.lines().map(str::trim).collect();
        for paragraph in lines
            .split(|line| line.is_empty())
            .filter(|p| !p.is_empty())
        {
            self.paragraph(&Markup::text(paragraph.join("\n")));
        }
    }

    /// Names and values side by side.
    pub(super) fn facts(&mut self, facts: &[Fact]) {
        if facts.is_empty() {
            return;
        }
        self.push("<dl class=\"facts\">\n");
        for (name, value) in facts {
            let value = escape(value);
            push(
                &mut self.html,
                format_args!("<div><dt>{name}</dt><dd>{value}</dd></div>\n"),
            );
        }
        self.push("</dl>\n");
    }

    /// A list, a line for each point.
    pub fn points(&mut self, points: &[Markup]) {
        if points.is_empty() {
            return;
        }
        self.push("<ul class=\"story\">\n");
        for point in points {
            let point = point.as_html();
            push(&mut self.html, format_args!("<li>{point}</li>\n"));
        }
        self.push("</ul>\n");
    }

    /// Where the chapters are.
    pub fn contents<'a>(&mut self, headings: impl Iterator<Item = &'a str>) {
        self.push("<nav aria-label=\"Contents\">\n<ol>\n");
        for heading in headings {
            let (id, heading) = (anchor(heading), escape(heading));
            push(
                &mut self.html,
                format_args!("<li><a href=\"#{id}\">{heading}</a></li>\n"),
            );
        }
        self.push("</ol>\n</nav>\n");
    }

    /// A part under a heading.
    pub fn section<T>(&mut self, heading: &str, write: impl FnOnce(&mut Self) -> T) -> T {
        self.numbered_part("", "", heading, write)
    }

    /// A part that the contents lead to, with its number.
    pub fn chapter<T>(
        &mut self,
        number: usize,
        heading: &str,
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let id = format!(" id=\"{}\"", anchor(heading));
        self.numbered_part(&id, &format!("{number} "), heading, write)
    }

    /// A part for readers without script alone.
    pub(super) fn still_section<T>(
        &mut self,
        heading: &str,
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        self.numbered_part(" class=\"still\"", "", heading, write)
    }

    fn numbered_part<T>(
        &mut self,
        attributes: &str,
        number: &str,
        heading: &str,
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let escaped = escape(heading);
        let opened = format!("<section{attributes}>\n<h2>{number}{escaped}</h2>\n");
        self.part(heading, [&opened, "</section>\n"], write)
    }

    /// What is written between two tags is under a heading.
    fn part<T>(
        &mut self,
        heading: &str,
        [opened, closed]: [&str; 2],
        write: impl FnOnce(&mut Self) -> T,
    ) -> T {
        heading.clone_into(&mut self.heading);
        self.within(opened, closed, write)
    }

    /// A part that is shown as its heading until somebody opens it.
    pub fn folded<T>(&mut self, heading: &str, write: impl FnOnce(&mut Self) -> T) -> T {
        let summary = escape(heading);
        let opened = format!("<details class=\"part\">\n<summary>{summary}</summary>\n");
        self.part(heading, [&opened, "</details>\n"], write)
    }

    pub fn paragraph(&mut self, text: &Markup) {
        self.classed("story", text);
    }

    /// What is to be known to read what stands beside it.
    pub fn note(&mut self, text: &Markup) {
        self.classed("note", text);
    }

    /// What must not be missed.
    pub(super) fn warning(&mut self, text: &str) {
        self.classed("warning", &Markup::text(text));
    }

    /// A table in sight.
    pub fn table(&mut self, listing: &Listing) {
        let html = listing.html(&self.heading);
        self.push(&html);
    }

    /// Drawings side by side, each with its name and its numbers.
    pub fn figures(&mut self, figures: &[Rendered]) {
        let panels = figures.len().max(1);
        push(
            &mut self.html,
            format_args!("<div class=\"grid charts\" style=\"--panels:{panels}\">\n"),
        );
        for figure in figures {
            let id = figure.id.as_ref();
            let id = id.map_or(String::new(), |id| format!(" id=\"{id}\""));
            self.figure(&id, figure);
        }
        self.push("</div>\n");
    }

    /// One of them; `attributes` are its own.
    pub(super) fn figure(&mut self, attributes: &str, figure: &Rendered) {
        let Rendered {
            caption,
            drawing,
            data,
            ..
        } = figure;
        let (caption, data) = (caption.as_html(), data.folded());
        push(
            &mut self.html,
            format_args!(
                "<figure{attributes}><figcaption>{caption}</figcaption>\n{drawing}\n{data}</figure>\n"
            ),
        );
    }

    /// Lines as a terminal has them.
    pub fn lines(&mut self, text: &str) {
        let lines: Vec<String> = text.split('\n').map(escape).collect();
        let lines = lines.join("\n");
        push(
            &mut self.html,
            format_args!(
                "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"Tables\"><pre>{lines}</pre></div>\n"
            ),
        );
    }

    /// The whole page.
    pub fn ended(self) -> String {
        self.ended_with("")
    }

    /// With its scripts, if any.
    pub(super) fn ended_with(mut self, scripts: &str) -> String {
        push(
            &mut self.html,
            format_args!("</main>\n{scripts}</body>\n</html>\n"),
        );
        self.html
    }
}

/// A title as an anchor.
pub fn anchor(title: &str) -> String {
    (title.to_lowercase().chars())
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_users_wrote_stays_text() {
        let bad = "<script>\"'&";
        let head = Head {
            title: bad.to_owned(),
            headline: bad.to_owned(),
            story: bad.to_owned(),
            facts: vec![("Fact", bad.to_owned())],
            points: vec![bad.to_owned()],
            warnings: vec![bad.to_owned()],
        };
        let mut page = HtmlPage::begun(&head);
        page.about(&head);
        let listing = Listing {
            caption: bad.to_owned(),
            headings: vec![Markup::with_unit(bad, bad), Markup::text(bad)],
            rows: vec![vec![Markup::link(bad), Markup::code(bad)]],
            ..Listing::default()
        };
        page.contents([bad].into_iter());
        page.chapter(1, bad, |page| {
            page.note(&Markup::text(bad));
            page.paragraph(&Markup::prose(bad));
            page.points(&[Markup::text(bad)]);
            page.table(&listing);
            let drawn = Rendered::new(bad, String::new(), listing.clone());
            page.figures(&[drawn.numbered("name".to_owned(), "1.1", bad)]);
            page.lines(&format!("{bad}\nnext"));
        });
        page.folded(bad, |page| {
            page.table(&Listing {
                caption: String::new(),
                ..listing
            });
        });
        let html = page.ended();
        assert!(!html.contains("<script") && html.ends_with("</html>\n"));
        assert!(html.contains("default-src 'none'; style-src 'unsafe-inline'\">"));
        assert!(html.contains("&amp;\nnext</pre>"));
        assert_eq!(html.matches("<table").count(), 3);
        assert!(html.contains("aria-label=\"Table: &lt;script&gt;"));
    }

    /// Backticks of a text are code, and an odd one swallows nothing.
    #[test]
    fn prose_has_code() {
        let html = |text: &str| Markup::prose(text).as_html().to_owned();
        assert_eq!(html("a `b < c` d"), "a <code>b &lt; c</code> d");
        assert_eq!(html("a `b"), "a <code>b</code>");
    }
}
