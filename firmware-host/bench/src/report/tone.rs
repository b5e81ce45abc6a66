//! What a word says of a machine: a colour on a terminal and on a page.

use super::push;
use crate::run::outcome::Outcome;
use anstyle::{AnsiColor, Style};
use std::sync::OnceLock;

/// How good what a word says is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// As it should be.
    Good,
    /// To be looked at.
    Fair,
    /// As it must not be.
    Bad,
}

/// Whether words have colours on what they are shown on.
static COLOURS: OnceLock<bool> = OnceLock::new();

/// Says that words are shown on a terminal that takes colours. Said once, before any is; where nobody says so there are none.
pub fn set_colours() {
    let _first = COLOURS.set(true);
}

pub(super) fn colours() -> bool {
    COLOURS.get().copied().unwrap_or(false)
}

impl Tone {
    const ALL: [Self; 3] = [Self::Good, Self::Fair, Self::Bad];

    /// Where a word in its colour begins: an invisible sign of mathematics, which no text here has.
    const fn mark(self) -> char {
        match self {
            Self::Good => '\u{2061}',
            Self::Fair => '\u{2062}',
            Self::Bad => '\u{2063}',
        }
    }

    /// With marks that take no room around each word, as cells of a table are broken between words; see [`coloured`].
    pub(super) fn marked(self, text: &str) -> String {
        let mark = self.mark();
        let words = text.split(' ');
        let marked: Vec<String> = words.map(|word| format!("{mark}{word}{END}")).collect();
        marked.join(" ")
    }

    /// Of how a run ended.
    pub fn of(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Recovered | Outcome::Decayed => Self::Good,
            Outcome::Diverging
            | Outcome::Resting
            | Outcome::Pinned
            | Outcome::Rubbing
            | Outcome::Bouncing => Self::Fair,
            Outcome::Whirl => Self::Bad,
        }
    }

    /// Of what holds or does not.
    pub fn of_claim(holds: bool) -> Self {
        if holds { Self::Good } else { Self::Bad }
    }

    /// Its class in the style sheet.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Fair => "fair",
            Self::Bad => "bad",
        }
    }

    /// Of the terminal's own colours, which its user has chosen against the background.
    fn style(self) -> Style {
        let colour = match self {
            Self::Good => AnsiColor::Green,
            Self::Fair => AnsiColor::Yellow,
            Self::Bad => AnsiColor::Red,
        };
        Style::new().bold().fg_color(Some(colour.into()))
    }

    /// Words in its colour, where there are colours.
    pub fn paint(self, words: &str) -> String {
        let style = self.style();
        match colours() {
            true => format!("{style}{words}{style:#}"),
            false => words.to_owned(),
        }
    }
}

/// Where it ends.
const END: char = '\u{2064}';

/// A text with marks, when all is laid out: colours take their place.
pub(super) fn coloured(marked: &str) -> String {
    let mut out = String::with_capacity(marked.len());
    for c in marked.chars() {
        match Tone::ALL.into_iter().find(|tone| tone.mark() == c) {
            Some(tone) => push(&mut out, format_args!("{}", tone.style())),
            None if c == END => push(&mut out, format_args!("{}", anstyle::Reset)),
            None => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Tone, coloured};

    /// Without a word from the command line there are no colours: in tests, in files, in pipes.
    #[test]
    fn colours_are_asked_for() {
        assert_eq!(Tone::Bad.paint("whirl"), "whirl");
        assert_eq!(
            coloured(&Tone::Bad.marked("whirl")),
            "\u{1b}[1m\u{1b}[31mwhirl\u{1b}[0m"
        );
    }
}
