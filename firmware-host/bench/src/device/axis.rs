//! Axes of the bearing.

use crate::words::words;
use plant_model::V2;

words! {
    /// One axis, or both.
    #[derive(Default)]
    pub enum Axis {
        /// x.
        X = "x",
        /// y.
        Y = "y",
        /// Both.
        #[default]
        Both = "both",
    }
}

impl Axis {
    /// Whether component 0 or 1 belongs to it.
    pub fn has(self, component: usize) -> bool {
        match self {
            Self::X => component == 0,
            Self::Y => component == 1,
            Self::Both => true,
        }
    }

    /// A vector with the components of this axis changed.
    pub fn map(self, v: V2, mut change: impl FnMut(f64) -> f64) -> V2 {
        let mut v = v;
        for i in [0, 1] {
            if self.has(i) {
                v[i] = change(v[i]);
            }
        }
        v
    }
}
