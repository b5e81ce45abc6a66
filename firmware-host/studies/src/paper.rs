//! The paper reproduced: every number and figure of "dry friction backward whirl" that the model can
//! speak to, each as a row of paper, computed value and deviation, with its source and whether it was
//! fitted, predicted or assumed. Rows that miss stay in, with the reason.
//!
//! One file a chapter; a chapter computes, and says nothing about how it is shown.

pub mod established;
mod laws;
mod levels;
mod limits;
pub mod maps;
mod mounting;
pub mod onset;
mod page;
pub mod phases;
mod retainer;
pub mod rotors;
mod rows;
mod summary;
mod whirl_runs;

pub use self::page::{chapters, page, study};
pub use self::rows::{json, text};
use crate::campaign::Extent;
pub use crate::campaign::{Drawing, Figure, Table};
pub use firmware_bench::report::plot::chart::{Axis, Chart, Curve, HeatMap, Mark};
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

/// In which sense the paper gives a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stated {
    /// A value.
    Value,
    /// "No more than", "under".
    AtMost(f64),
    /// "More than", "still too high".
    AtLeast(f64),
    /// "One to five".
    Between(f64, f64),
}

/// One number of the paper beside what the model gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What it is.
    pub quantity: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Where the paper has it: section, figure, footnote or equation.
    pub source: &'static str,
    /// The paper's value; `None` where it gives none.
    pub paper: Option<f64>,
    /// What the model gives; `None` where it gives none (the note says why).
    pub computed: Option<f64>,
    /// computed/paper − 1, where both are there.
    pub deviation: Option<f64>,
    /// How it came about.
    pub kind: Kind,
    /// What must be said beside it: an interval, a condition, the reason of a miss.
    pub note: String,
    /// In which sense the paper gives it.
    pub stated: Stated,
}

/// A row farther than this from a value of the paper misses it: the paper's own numbers are "about".
pub const MISS: f64 = 0.1;

impl Row {
    /// A row with its deviation. A value that is no number counts as none.
    pub fn new(
        (quantity, unit): (impl Into<String>, &'static str),
        source: &'static str,
        (paper, computed): (Option<f64>, Option<f64>),
        kind: Kind,
        note: impl Into<String>,
    ) -> Self {
        let computed = computed.filter(|value| value.is_finite());
        let deviation = paper
            .zip(computed)
            .filter(|(paper, _)| *paper != 0.0)
            .map(|(paper, computed)| computed / paper - 1.0);
        Self {
            quantity: quantity.into(),
            unit,
            source,
            paper,
            computed,
            deviation,
            kind,
            note: note.into(),
            stated: Stated::Value,
        }
    }

    /// The same row, where the paper gives a bound or a range.
    #[must_use]
    pub fn stated(self, stated: Stated) -> Self {
        Self { stated, ..self }
    }

    /// Whether the paper is met: its bound or range, or its value to [`MISS`]. `None` where there is
    /// nothing to compare.
    pub fn holds(&self) -> Option<bool> {
        match self.stated {
            Stated::Value => self.deviation.map(|d| d.abs() <= MISS),
            Stated::AtMost(high) => self.computed.map(|v| v <= high),
            Stated::AtLeast(low) => self.computed.map(|v| v >= low),
            Stated::Between(low, high) => self.computed.map(|v| (low..=high).contains(&v)),
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
