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
pub(crate) enum ShapeName {
    #[default]
    Constant,
    HalfSine,
    Sine,
}

/// Shape, frequency and phase.
pub(crate) type ShapeFile = (ShapeName, Option<f64>, Option<f64>);

/// A force on the rotor for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct DisturbanceFile {
    pub(crate) start_s: f64,
    pub(crate) duration_s: f64,
    pub(crate) force_n: Pair,
    #[serde(default)]
    pub(crate) shape: ShapeName,
    pub(crate) frequency_hz: Option<f64>,
    pub(crate) phase_rad: Option<f64>,
}

/// Acceleration of the housing for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct BaseMotionFile {
    pub(crate) start_s: f64,
    pub(crate) duration_s: f64,
    pub(crate) acceleration_m_s2: Pair,
    #[serde(default)]
    pub(crate) shape: ShapeName,
    pub(crate) frequency_hz: Option<f64>,
    pub(crate) phase_rad: Option<f64>,
}

/// One axis, or both.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum AxisFile {
    X,
    Y,
    #[default]
    Both,
}

/// What a faulty amplifier delivers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum DeliversFile {
    #[default]
    Nothing,
    Inverted,
    Swapped,
}

/// A faulty amplifier for a while.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct OutageFile {
    pub(crate) start_s: f64,
    pub(crate) duration_s: f64,
    #[serde(default)]
    pub(crate) delivers: DeliversFile,
    #[serde(default)]
    pub(crate) axis: AxisFile,
    #[serde(default)]
    pub(crate) known: bool,
}

/// Kinds of sensor faults.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FaultName {
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
pub(crate) struct FaultFile {
    pub(crate) start_s: f64,
    pub(crate) duration_s: f64,
    pub(crate) kind: FaultName,
    pub(crate) axis: Option<AxisFile>,
    pub(crate) value_m: Option<f64>,
    pub(crate) factor: Option<f64>,
    pub(crate) rate_hz: Option<f64>,
    pub(crate) size_m: Option<f64>,
    pub(crate) samples: Option<u32>,
    pub(crate) bits: Option<u32>,
    pub(crate) frequency_hz: Option<f64>,
    pub(crate) amplitude_m: Option<f64>,
}

/// Parameters of the plant that take other values from a time on.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct ChangeFile {
    pub(crate) at_s: f64,
    pub(crate) eccentricity_m: Option<f64>,
    pub(crate) friction_coefficient: Option<f64>,
    pub(crate) drive_torque_n_m: Option<f64>,
}

impl ChangeFile {
    /// Keys that another change has, too.
    pub(crate) fn keys_of_both(&self, other: &Self) -> impl Iterator<Item = &'static str> {
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
