//! Two numbers in a scene file.

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
