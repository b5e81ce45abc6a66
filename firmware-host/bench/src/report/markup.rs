//! Text that is HTML already.

use super::plot::text::escape;
use super::tone::Tone;
use crate::run::outcome::Outcome;

/// Text for a page, safe where it stands.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Markup(String);

impl Markup {
    pub fn text(text: impl AsRef<str>) -> Self {
        Self(escape(text.as_ref()))
    }

    /// HTML that is written out in this crate.
    pub(super) fn written(html: impl Into<String>) -> Self {
        Self(html.into())
    }

    /// A text, and what it is in smaller letters below.
    pub(crate) fn with_unit(text: &str, unit: &str) -> Self {
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

    /// A text whose parts between backticks are such words.
    pub fn prose(text: &str) -> Self {
        let text = escape(text);
        let part = |(i, part): (usize, &str)| match i % 2 {
            0 => part.to_owned(),
            _ => format!("<code>{part}</code>"),
        };
        Self(text.split('`').enumerate().map(part).collect())
    }

    /// How a run ended.
    pub fn outcome(outcome: Outcome) -> Self {
        let class = Tone::of(outcome).class();
        let word = outcome.name();
        Self(format!("<span class=\"outcome {class}\">{word}</span>"))
    }

    /// A time of the figures, as text; the script makes it lead there.
    pub(super) fn time(t: f64, text: &str) -> Self {
        Self(format!("<span data-t=\"{t}\">{}</span>", escape(text)))
    }

    /// The text for readers of HTML.
    pub(crate) fn as_html(&self) -> &str {
        &self.0
    }
}
