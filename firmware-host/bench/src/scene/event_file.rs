//! The tables of a scene file that say what happens during the run, as they are written.

#![allow(
    missing_docs,
    reason = "fields and variants are the keys and words of scene files, which docs/src/host/scenes.md explains"
)]

use crate::scene::values::Pair;
use serde::Deserialize;

/// Course of a load over its interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShapeName {
    #[default]
    Constant,
    HalfSine,
    Sine,
}

/// Shape, frequency and phase.
pub type ShapeFile = (ShapeName, Option<f64>, Option<f64>);

/// A force on the rotor for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct DisturbanceFile {
    pub start_s: f64,
    pub duration_s: f64,
    pub force_n: Pair,
    #[serde(default)]
    pub shape: ShapeName,
    pub frequency_hz: Option<f64>,
    pub phase_rad: Option<f64>,
}

/// Acceleration of the housing for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct BaseMotionFile {
    pub start_s: f64,
    pub duration_s: f64,
    pub acceleration_m_s2: Pair,
    #[serde(default)]
    pub shape: ShapeName,
    pub frequency_hz: Option<f64>,
    pub phase_rad: Option<f64>,
}

/// One axis, or both.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxisFile {
    X,
    Y,
    #[default]
    Both,
}

/// What a faulty amplifier delivers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DeliversFile {
    #[default]
    Nothing,
    Inverted,
    Swapped,
}

/// A faulty amplifier for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct OutageFile {
    pub start_s: f64,
    pub duration_s: f64,
    #[serde(default)]
    pub delivers: DeliversFile,
    #[serde(default)]
    pub axis: AxisFile,
    #[serde(default)]
    pub known: bool,
}

/// Kinds of sensor faults.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FaultName {
    Nan,
    Infinity,
    Zero,
    Rail,
    Stuck,
    Offset,
    Gain,
    Inverted,
    Swapped,
    Noise,
    Spikes,
    Dropout,
    Delay,
    Bits,
    Oscillation,
}

/// A sensor fault for a while; which of the other keys belong to it depends on the kind.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct FaultFile {
    pub start_s: f64,
    pub duration_s: f64,
    pub kind: FaultName,
    pub axis: Option<AxisFile>,
    pub value_m: Option<f64>,
    pub factor: Option<f64>,
    pub rate_hz: Option<f64>,
    pub size_m: Option<f64>,
    pub samples: Option<u32>,
    pub bits: Option<u32>,
    pub frequency_hz: Option<f64>,
    pub amplitude_m: Option<f64>,
}

/// Parameters of the plant that take other values from a time on.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct ChangeFile {
    pub at_s: f64,
    pub eccentricity_m: Option<f64>,
    pub friction_coefficient: Option<f64>,
    pub drive_torque_n_m: Option<f64>,
}

impl ChangeFile {
    /// Keys that another change has, too.
    pub fn keys_of_both(&self, other: &Self) -> impl Iterator<Item = &'static str> {
        let both = |a: Option<f64>, b: Option<f64>| a.is_some() && b.is_some();
        let keys = [
            (
                "eccentricity_m",
                both(self.eccentricity_m, other.eccentricity_m),
            ),
            (
                "friction_coefficient",
                both(self.friction_coefficient, other.friction_coefficient),
            ),
            (
                "drive_torque_n_m",
                both(self.drive_torque_n_m, other.drive_torque_n_m),
            ),
        ];
        (keys.into_iter()).filter_map(|(key, both)| both.then_some(key))
    }
}
