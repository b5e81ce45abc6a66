//! Pages: chapters of text, tables and figures. Nothing here says how they are shown.

use firmware_bench::report::listing::Column;
use firmware_bench::report::plot::chart::{Chart, HeatMap};
use std::borrow::Cow;

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it shows; may be empty.
    pub caption: String,
    /// Heading of each column, unit included.
    pub columns: Vec<String>,
    /// Cells as they are to be read.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Whether a column has mostly numbers.
    pub fn is_numeric(&self, column: usize) -> bool {
        self.kind_of(column) == Column::Numbers
    }

    pub(super) fn kind_of(&self, column: usize) -> Column {
        let filled = || {
            (self.rows.iter().filter_map(|row| row.get(column)))
                .filter(|cell| !cell.is_empty() && *cell != "–" && *cell != "∞")
        };
        let numeric = |cell: &String| {
            cell.starts_with(|c: char| c.is_ascii_digit() || "+-\u{2212}≤≥".contains(c))
                && cell.chars().count() < 24
        };
        let numbers = filled().filter(|cell| numeric(cell)).count();
        if filled().any(|cell| cell.chars().count() > 60) {
            Column::LongTexts
        } else if 2 * numbers > filled().count() {
            Column::Numbers
        } else {
            Column::Words
        }
    }
}

/// A drawing.
#[derive(Debug, Clone)]
pub enum Drawing {
    /// Curves over an axis.
    Chart(Chart),
    /// A value over a plane.
    Map(HeatMap),
}

/// A drawing with what is to be seen in it.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Short name, by which the page links to it; no two are alike.
    pub file: Cow<'static, str>,
    /// What is to be seen.
    pub caption: String,
    pub drawing: Drawing,
}

/// A part of a chapter.
#[derive(Debug, Clone)]
pub enum Block {
    /// Text.
    Paragraph(String),
    /// A sentence for each point.
    List(Vec<String>),
    /// A table, and which of its rows are to catch the eye; none where there are fewer marks than rows.
    Table(Table, Vec<bool>),
    /// Drawings side by side.
    Figures(Vec<Figure>),
}

impl Block {
    /// A paragraph.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Paragraph(text.into())
    }

    /// A table without caption and marks.
    pub fn table<const N: usize>(
        columns: [&str; N],
        rows: impl IntoIterator<Item = [String; N]>,
    ) -> Self {
        let table = Table {
            caption: String::new(),
            columns: columns.map(str::to_owned).to_vec(),
            rows: rows.into_iter().map(|row| row.to_vec()).collect(),
        };
        Self::Table(table, Vec::new())
    }
}

/// A part of a page with a heading.
#[derive(Debug, Clone)]
pub struct Chapter {
    /// Its heading.
    pub title: String,
    /// What is in it, in order.
    pub blocks: Vec<Block>,
    /// Whether it is shown as its heading until somebody opens it.
    pub folded: bool,
    /// Whether the documentation has it too.
    pub in_docs: bool,
}

impl Chapter {
    /// An open chapter.
    pub fn new(title: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self {
            title: title.into(),
            blocks,
            folded: false,
            in_docs: true,
        }
    }

    /// One that is shown as its heading until somebody opens it, and left out of the documentation.
    pub fn folded(title: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self {
            folded: true,
            in_docs: false,
            ..Self::new(title, blocks)
        }
    }
}

/// A document.
#[derive(Debug, Clone)]
pub struct Page {
    pub title: String,
    /// The conclusion in a sentence or two, above everything.
    pub headline: String,
    /// What comes before the chapters.
    pub lead: Vec<Block>,
    /// The chapters in order.
    pub chapters: Vec<Chapter>,
}
