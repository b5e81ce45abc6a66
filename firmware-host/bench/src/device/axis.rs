//! Axes of the bearing.

use crate::words::words;
use nalgebra::Rotation2;
use plant_model::V2;

words! {
    /// One axis, or both.
    #[derive(Default)]
    pub enum Axis {
        X = "x",
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

/// Axes that are turned from those of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turned(Option<Rotation2<f64>>);

impl Turned {
    /// By an angle \[rad\]. By none, every vector keeps its bits.
    pub fn by(angle_rad: f64) -> Self {
        Self((angle_rad != 0.0).then(|| Rotation2::new(angle_rad)))
    }

    /// What is along the axes of the scene, along these.
    pub fn seen(self, v: V2) -> V2 {
        self.0.map_or(v, |axes| axes.inverse() * v)
    }

    /// As [`Self::meant`], in single precision.
    pub(crate) fn meant_f32(self, v: [f32; 2]) -> [f32; 2] {
        match self.0 {
            None => v,
            Some(axes) => {
                let v = axes * V2::from(v.map(f64::from));
                [v.x as f32, v.y as f32]
            }
        }
    }

    /// What is along these axes, along those of the scene.
    pub fn meant(self, v: V2) -> V2 {
        self.0.map_or(v, |axes| axes * v)
    }
}
