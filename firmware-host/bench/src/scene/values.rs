//! Values of scene files with their own way to be written.

use plant_model::V2;
use serde::Deserialize;

/// Two numbers [x, y]; fewer or more are refused.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(crate) struct Pair(pub(crate) [f64; 2]);

impl TryFrom<Vec<f64>> for Pair {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let found = numbers.len();
        <[f64; 2]>::try_from(numbers)
            .map(Self)
            .map_err(|_| format!("{found} numbers, expected two: [x, y]"))
    }
}

/// One number for both axes, or one for each.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "a number, or two numbers [x, y]")]
pub(crate) enum PerAxis {
    /// One number for both axes.
    Both(f64),
    /// One for x, one for y.
    Each(Pair),
}

impl PerAxis {
    /// As a vector of both axes.
    pub(crate) fn vector(self) -> V2 {
        match self {
            Self::Both(x) => V2::repeat(x),
            Self::Each(xy) => xy.0.into(),
        }
    }
}
