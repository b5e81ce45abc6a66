//! The scene file as it is written: keys, types and defaults. What the values mean is decided in
//! [`crate::scene`].

#![allow(
    missing_docs,
    reason = "fields and variants are the keys and words of scene files, which docs/src/host/scenes.md explains"
)]

use crate::scene::event_file::{
    BaseMotionFile, ChangeFile, DisturbanceFile, FaultFile, OutageFile,
};
use crate::scene::values::{Pair, PerAxis};
use serde::Deserialize;

/// A whole file.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct SceneFile {
    pub title: String,
    #[serde(default)]
    pub story: String,
    pub run: RunFile,
    pub rotor: RotorFile,
    pub spin: SpinFile,
    #[serde(default)]
    pub start: StartFile,
    #[serde(default)]
    pub stator: StatorFile,
    pub contact: ContactFile,
    pub friction: FrictionFile,
    #[serde(default)]
    pub retainer: RetainerFile,
    pub race: Option<RaceFile>,
    pub magnet: Option<MagnetFile>,
    #[serde(default)]
    pub sensor: SensorFile,
    #[serde(default)]
    pub spin_sensor: SpinSensorFile,
    pub levitation: Option<LevitationFile>,
    #[serde(default)]
    pub radial: RadialFile,
    #[serde(default)]
    pub damping: DampingFile,
    #[serde(default)]
    pub supervisor: toml::Table,
    #[serde(default)]
    pub disturbance: Vec<DisturbanceFile>,
    #[serde(default)]
    pub base_motion: Vec<BaseMotionFile>,
    #[serde(default)]
    pub outage: Vec<OutageFile>,
    #[serde(default)]
    pub fault: Vec<FaultFile>,
    #[serde(default)]
    pub change: Vec<ChangeFile>,
    #[serde(default)]
    pub verdict: VerdictFile,
}

/// Time, accuracy, policies.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RunFile {
    pub duration_s: f64,
    pub sample_rate_hz: f64,
    pub policies: Vec<String>,
    #[serde(default = "default_rtol")]
    pub rtol: f64,
    #[serde(default)]
    pub method: MethodFile,
    #[serde(default)]
    pub seed: u64,
}

/// How contact is integrated.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MethodFile {
    #[default]
    Auto,
    Series,
    Explicit,
    Stiff,
}

fn default_rtol() -> f64 {
    1e-9
}

/// The rotor; stiffness and damping directly or as frequency and damping ratio.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RotorFile {
    pub mass_kg: f64,
    pub stiffness_n_m: Option<f64>,
    pub natural_frequency_hz: Option<f64>,
    pub damping_n_s_m: Option<f64>,
    pub damping_ratio: Option<f64>,
    #[serde(default)]
    pub eccentricity_m: f64,
    pub contact_radius_m: f64,
    #[serde(default)]
    pub gravity_m_s2: Pair,
}

/// Spin: held unless an inertia is given.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct SpinFile {
    pub frequency_hz: f64,
    pub inertia_kg_m2: Option<f64>,
    pub drive_torque_n_m: Option<f64>,
}

/// Where the rotor starts.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct StartFile {
    #[serde(default)]
    pub position_m: Pair,
    #[serde(default)]
    pub velocity_m_s: Pair,
    #[serde(default)]
    pub spin_phase_rad: f64,
}

/// Rings of the stator; none means rigid.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct StatorFile {
    pub inner: Option<RingFile>,
    pub outer: Option<RingFile>,
}

/// One ring with its mounting.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RingFile {
    pub mass_kg: f64,
    pub stiffness_n_m: PerAxis,
    pub damping_n_s_m: PerAxis,
}

/// The contact, linear or with a stiffness that grows with depth; damping directly or as restitution.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct ContactFile {
    pub clearance_m: f64,
    pub stiffness_n_m: Option<f64>,
    pub damping_n_s_m: Option<f64>,
    pub stiffness_n_mn: Option<f64>,
    pub exponent: Option<f64>,
    pub damping_s_m: Option<f64>,
    pub restitution: Option<f64>,
    pub restitution_speed_m_s: Option<f64>,
}

/// Friction; constant unless the coefficient at speed is given.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct FrictionFile {
    pub coefficient: f64,
    pub coefficient_at_speed: Option<f64>,
    pub speed_scale_m_s: Option<f64>,
    #[serde(default)]
    pub rolling_coefficient: f64,
}

/// The retainer bearing.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RetainerFile {
    #[serde(default)]
    pub centre_offset_m: Pair,
    #[serde(default)]
    pub ellipticity: f64,
    pub long_axis_deg: Option<f64>,
}

/// The inner race of a retainer ball bearing; none means a bushing.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RaceFile {
    pub inertia_kg_m2: f64,
    #[serde(default)]
    pub drag_n_m_s: f64,
    #[serde(default)]
    pub start_frequency_hz: f64,
}

/// The magnet.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct MagnetFile {
    pub force_max_n: f64,
    #[serde(default)]
    pub lag_s: f64,
    #[serde(default)]
    pub negative_stiffness_n_m: f64,
    pub axis_force_max_n: Option<f64>,
    pub slew_n_s: Option<f64>,
    #[serde(default = "default_delay")]
    pub delay_samples: u32,
    #[serde(default)]
    pub force_measured: bool,
}

fn default_delay() -> u32 {
    1
}

/// The position sensor.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct SensorFile {
    #[serde(default)]
    pub quantum_m: f64,
    #[serde(default)]
    pub noise_rms_m: f64,
    #[serde(default)]
    pub offset_m: Pair,
    pub gain: Option<PerAxis>,
    #[serde(default)]
    pub delay_samples: u32,
    #[serde(default)]
    pub swapped: bool,
    pub range_m: Option<f64>,
}

/// What is known of the spin.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct SpinSensorFile {
    #[serde(default = "default_valid")]
    pub valid: bool,
    #[serde(default)]
    pub reversed: bool,
    #[serde(default = "default_gain")]
    pub gain: f64,
}

fn default_gain() -> f64 {
    1.0
}

fn default_valid() -> bool {
    true
}

impl Default for SpinSensorFile {
    fn default() -> Self {
        Self {
            valid: default_valid(),
            reversed: false,
            gain: default_gain(),
        }
    }
}

/// The stand-in firmware's levitation controller.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct LevitationFile {
    pub proportional_n_m: f64,
    #[serde(default)]
    pub integral_n_m_s: f64,
    pub derivative_n_s_m: f64,
    #[serde(default)]
    pub derivative_filter_s: f64,
    #[serde(default)]
    pub feed_forward_weight: bool,
}

/// The whole-capacity-inwards baseline.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RadialFile {
    #[serde(default = "default_band")]
    pub band: f64,
}

fn default_band() -> f64 {
    0.7
}

impl Default for RadialFile {
    fn default() -> Self {
        Self {
            band: default_band(),
        }
    }
}

/// The pure-damping baseline.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct DampingFile {
    pub coefficient_n_s_m: Option<f64>,
}

/// How the end is judged.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct VerdictFile {
    pub whirl_speed_m_s: Option<f64>,
}
