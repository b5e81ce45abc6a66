//! What is claimed of a measurement.

use super::chapter::{Block, Table};
use firmware_bench::report::plot::text::figures;
use serde::Serialize;

/// On which side of its bound a measurement has to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Not below it.
    AtLeast,
    /// Not above it.
    AtMost,
}

/// A claim with its measurement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// What is claimed, of what.
    pub name: String,
    pub bound: f64,
    /// On which side of it the measurement has to be.
    pub side: Side,
    /// What was measured.
    pub measured: f64,
    /// Whether it holds; what is no number does not.
    pub holds: bool,
}

impl Claim {
    /// That a measurement is not below a bound.
    pub fn at_least(name: impl Into<String>, bound: f64, measured: f64) -> Self {
        Self {
            name: name.into(),
            bound,
            side: Side::AtLeast,
            measured,
            holds: measured >= bound,
        }
    }

    /// That a measurement is not above a bound.
    pub fn at_most(name: impl Into<String>, bound: f64, measured: f64) -> Self {
        Self {
            name: name.into(),
            bound,
            side: Side::AtMost,
            measured,
            holds: measured <= bound,
        }
    }

    /// The bound as it is read.
    pub fn bound(&self) -> String {
        let sign = match self.side {
            Side::AtLeast => "≥",
            Side::AtMost => "≤",
        };
        format!("{sign} {}", self.bound)
    }

    /// Name, bound, measurement and whether it holds, as they are read.
    pub fn cells(&self) -> [String; 4] {
        let holds = if self.holds { "yes" } else { "NO" };
        let size = self.measured.abs();
        let measured = match size == 0.0 || (1e-3..1e6).contains(&size) {
            // Finer than three figures: a measurement near its bound is to be seen on its side of it.
            true => format!("{:.3}", self.measured),
            false => figures(self.measured),
        };
        [self.name.clone(), self.bound(), measured, holds.to_owned()]
    }
}

/// Outcome of the claims, in a sentence for the top of a page; those that do not hold by name, of many the first.
pub(super) fn conclusion(claims: &[Claim], cases: u64) -> String {
    const NAMED: usize = 5;
    let broken: Vec<&str> = (claims.iter().filter(|claim| !claim.holds))
        .map(|claim| &claim.name[..])
        .collect();
    let all = claims.len();
    if broken.is_empty() {
        return format!("All {all} claims hold, in {cases} cases.");
    }
    let more = broken.len().saturating_sub(NAMED);
    let more = match more {
        0 => String::new(),
        more => format!("; and {more} more"),
    };
    let named = broken[..broken.len().min(NAMED)].join("; ");
    let kept = all - broken.len();
    format!("{kept} of {all} claims hold, in {cases} cases. Not held: {named}{more}.")
}

/// Headings of [`Claim::cells`].
pub const CLAIM_COLUMNS: [&str; 4] = ["claim", "bound", "measured", "holds"];

/// Claims as a table, those that do not hold marked.
pub(super) fn table(claims: &[Claim]) -> Block {
    let table = Table {
        caption: String::new(),
        columns: CLAIM_COLUMNS.map(str::to_owned).to_vec(),
        rows: claims.iter().map(|claim| claim.cells().to_vec()).collect(),
    };
    let marked = claims.iter().map(|claim| !claim.holds).collect();
    Block::Table(table, marked)
}
