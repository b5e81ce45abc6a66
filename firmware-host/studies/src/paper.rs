//! The paper reproduced: every number and figure of "dry friction backward whirl" that the model can
//! speak to, each as a row of paper, computed value and deviation, with its source and whether it was
//! fitted, predicted or assumed. Rows that miss stay in, with the reason.
//!
//! One file a chapter. A chapter runs its cases and lists what came out as data (`data`): rows, tables and
//! charts, a line each. How they are compared, claimed and shown is the same for all (`rows`, `summary`, `page`).

mod data;
mod established;
mod laws;
mod levels;
mod limits;
mod maps;
mod mounting;
mod onset;
mod page;
mod phases;
mod retainer;
pub mod rotors;
mod rows;
mod runs;
mod summary;

pub use self::page::{chapters, report, study};
use crate::campaign::{Extent, Figure, Table};
use plant_model::{BuildError, PlantError};
use serde::Serialize;

/// How a computed value came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A constant of the model was chosen so that this row fits.
    Fitted,
    /// Nothing was chosen for this row.
    Predicted,
    /// Hangs on a constant that the paper leaves out and that was not fitted to this row.
    Assumed,
}

/// What the paper has of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paper {
    /// No number.
    Silent,
    /// A value.
    Value(f64),
    /// "No more than", "under".
    AtMost(f64),
    /// "More than", "still too high".
    AtLeast(f64),
    /// "One to five".
    Between(f64, f64),
}

impl From<f64> for Paper {
    fn from(value: f64) -> Self {
        Self::Value(value)
    }
}

impl Paper {
    /// Its value or bound; a range has no one number.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Value(v) | Self::AtMost(v) | Self::AtLeast(v) => Some(v),
            Self::Silent | Self::Between(..) => None,
        }
    }
}

/// One number of the paper beside what the model gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What it is.
    pub item: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Where the paper has it: section, figure, footnote or equation.
    pub source: &'static str,
    /// What the paper has.
    pub paper: Paper,
    /// What the model gives, finite; `None` where it gives none (the note says why).
    pub computed: Option<f64>,
    /// How it came about.
    pub kind: Kind,
    /// What must be said beside it: an interval, a condition, the reason of a miss.
    pub note: String,
}

/// A row farther than this from a value of the paper misses it: the paper's own numbers are "about".
pub(crate) const MISS: f64 = 0.1;

impl Row {
    /// computed/paper − 1, where both are there.
    pub fn deviation(&self) -> Option<f64> {
        let paper = self.paper.number().filter(|paper| *paper != 0.0);
        (paper.zip(self.computed)).map(|(paper, computed)| computed / paper - 1.0)
    }

    /// Whether the paper is met: its bound or range, or its value to `MISS`. `None` where there is
    /// nothing to compare.
    pub fn holds(&self) -> Option<bool> {
        let computed = self.computed?;
        match self.paper {
            Paper::Silent => None,
            Paper::Value(_) => self.deviation().map(|d| d.abs() <= MISS),
            Paper::AtMost(high) => Some(computed <= high),
            Paper::AtLeast(low) => Some(computed >= low),
            Paper::Between(low, high) => Some((low..=high).contains(&computed)),
        }
    }
}

/// One chapter, computed.
#[derive(Debug, Clone)]
pub struct Chapter {
    /// Its heading.
    pub title: &'static str,
    /// What was computed, with which constants, and what comes of it: paragraphs.
    pub story: Vec<String>,
    /// Paper against model.
    pub rows: Vec<Row>,
    /// Model alone.
    pub tables: Vec<Table>,
    /// Drawings.
    pub figures: Vec<Figure>,
}

impl Chapter {
    /// One that has no more than its story yet.
    fn new<S: Into<String>>(title: &'static str, story: impl IntoIterator<Item = S>) -> Self {
        Self {
            title,
            story: story.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
            tables: Vec::new(),
            figures: Vec::new(),
        }
    }
}

/// Why a chapter has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PaperError {
    /// Parameters out of range.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A run that cannot be trusted.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// Something that the chapter looks for is not there.
    #[error("{0}")]
    Missing(String),
}

/// A chapter that has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name}: {reason}")]
pub struct ChapterError {
    /// Which.
    pub name: &'static str,
    /// Why.
    pub reason: PaperError,
}

/// Computes a chapter.
pub type Compute = fn(Extent) -> Result<Chapter, PaperError>;

/// The chapters in order: a short name for progress and errors, and how each is computed.
pub const CHAPTERS: &[(&str, Compute)] = &[
    ("onset", onset::chapter),
    ("stability maps", maps::chapter),
    ("established whirl", established::chapter),
    ("the nine phases", phases::chapter),
    ("limits", limits::chapter),
    ("levels", levels::chapter),
    ("contact laws", laws::chapter),
    ("mounting", mounting::chapter),
    ("retainer bearing", retainer::chapter),
];
