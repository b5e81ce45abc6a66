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
    pub(crate) title: String,
    #[serde(default)]
    pub(crate) story: String,
    /// The table `[run]`.
    pub run: RunFile,
    pub(crate) rotor: RotorFile,
    pub(crate) spin: SpinFile,
    #[serde(default)]
    pub(crate) start: StartFile,
    #[serde(default)]
    pub(crate) stator: StatorFile,
    pub(crate) contact: ContactFile,
    pub(crate) friction: FrictionFile,
    #[serde(default)]
    pub(crate) retainer: RetainerFile,
    pub(crate) race: Option<RaceFile>,
    /// The table `[magnet]`.
    pub magnet: Option<MagnetFile>,
    #[serde(default)]
    pub(crate) sensor: SensorFile,
    #[serde(default)]
    pub(crate) spin_sensor: SpinSensorFile,
    pub(crate) levitation: Option<LevitationFile>,
    #[serde(default)]
    pub(crate) radial: RadialFile,
    #[serde(default)]
    pub(crate) damping: DampingFile,
    #[serde(default)]
    pub(crate) supervisor: toml::Table,
    #[serde(default)]
    pub(crate) disturbance: Vec<DisturbanceFile>,
    #[serde(default)]
    pub(crate) base_motion: Vec<BaseMotionFile>,
    #[serde(default)]
    pub(crate) outage: Vec<OutageFile>,
    #[serde(default)]
    pub(crate) fault: Vec<FaultFile>,
    #[serde(default)]
    pub(crate) change: Vec<ChangeFile>,
    #[serde(default)]
    pub(crate) verdict: VerdictFile,
}

/// Time, accuracy, policies.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct RunFile {
    pub(crate) duration_s: f64,
    /// Control rate.
    pub sample_rate_hz: f64,
    pub(crate) policies: Vec<String>,
    #[serde(default = "default_rtol")]
    pub(crate) rtol: f64,
    #[serde(default)]
    pub(crate) method: MethodFile,
    #[serde(default)]
    pub(crate) seed: u64,
}

/// How contact is integrated.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum MethodFile {
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
pub(crate) struct RotorFile {
    pub(crate) mass_kg: f64,
    pub(crate) stiffness_n_m: Option<f64>,
    pub(crate) natural_frequency_hz: Option<f64>,
    pub(crate) damping_n_s_m: Option<f64>,
    pub(crate) damping_ratio: Option<f64>,
    #[serde(default)]
    pub(crate) eccentricity_m: f64,
    pub(crate) contact_radius_m: f64,
    #[serde(default)]
    pub(crate) gravity_m_s2: Pair,
}

/// Spin: held unless an inertia is given.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct SpinFile {
    pub(crate) frequency_hz: f64,
    pub(crate) inertia_kg_m2: Option<f64>,
    pub(crate) drive_torque_n_m: Option<f64>,
}

/// Where the rotor starts.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct StartFile {
    #[serde(default)]
    pub(crate) position_m: Pair,
    #[serde(default)]
    pub(crate) velocity_m_s: Pair,
    #[serde(default)]
    pub(crate) spin_phase_rad: f64,
}

/// Rings of the stator; none means rigid.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct StatorFile {
    pub(crate) inner: Option<RingFile>,
    pub(crate) outer: Option<RingFile>,
}

/// One ring with its mounting.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct RingFile {
    pub(crate) mass_kg: f64,
    pub(crate) stiffness_n_m: PerAxis,
    pub(crate) damping_n_s_m: PerAxis,
}

/// The contact, linear or with a stiffness that grows with depth; damping directly or as restitution.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct ContactFile {
    pub(crate) clearance_m: f64,
    pub(crate) stiffness_n_m: Option<f64>,
    pub(crate) damping_n_s_m: Option<f64>,
    pub(crate) stiffness_n_mn: Option<f64>,
    pub(crate) exponent: Option<f64>,
    pub(crate) damping_s_m: Option<f64>,
    pub(crate) restitution: Option<f64>,
    pub(crate) restitution_speed_m_s: Option<f64>,
}

/// Friction; constant unless the coefficient at speed is given.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct FrictionFile {
    pub(crate) coefficient: f64,
    pub(crate) coefficient_at_speed: Option<f64>,
    pub(crate) speed_scale_m_s: Option<f64>,
    #[serde(default)]
    pub(crate) rolling_coefficient: f64,
}

/// The retainer bearing.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct RetainerFile {
    #[serde(default)]
    pub(crate) centre_offset_m: Pair,
    #[serde(default)]
    pub(crate) ellipticity: f64,
    pub(crate) long_axis_deg: Option<f64>,
}

/// The inner race of a retainer ball bearing; none means a bushing.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct RaceFile {
    pub(crate) inertia_kg_m2: f64,
    #[serde(default)]
    pub(crate) drag_n_m_s: f64,
    #[serde(default)]
    pub(crate) start_frequency_hz: f64,
}

/// The magnet.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub struct MagnetFile {
    /// Cap of the force.
    pub force_max_n: f64,
    #[serde(default)]
    pub(crate) lag_s: f64,
    #[serde(default)]
    pub(crate) negative_stiffness_n_m: f64,
    pub(crate) axis_force_max_n: Option<f64>,
    pub(crate) slew_n_s: Option<f64>,
    #[serde(default = "default_delay")]
    pub(crate) delay_samples: u32,
    #[serde(default)]
    pub(crate) force_measured: bool,
}

fn default_delay() -> u32 {
    1
}

/// The position sensor.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct SensorFile {
    #[serde(default)]
    pub(crate) quantum_m: f64,
    #[serde(default)]
    pub(crate) noise_rms_m: f64,
    #[serde(default)]
    pub(crate) offset_m: Pair,
    pub(crate) gain: Option<PerAxis>,
    #[serde(default)]
    pub(crate) delay_samples: u32,
    #[serde(default)]
    pub(crate) swapped: bool,
    pub(crate) range_m: Option<f64>,
}

/// What is known of the spin.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct SpinSensorFile {
    #[serde(default = "default_valid")]
    pub(crate) valid: bool,
    #[serde(default)]
    pub(crate) reversed: bool,
    #[serde(default = "default_gain")]
    pub(crate) gain: f64,
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
pub(crate) struct LevitationFile {
    pub(crate) proportional_n_m: f64,
    #[serde(default)]
    pub(crate) integral_n_m_s: f64,
    pub(crate) derivative_n_s_m: f64,
    #[serde(default)]
    pub(crate) derivative_filter_s: f64,
    #[serde(default)]
    pub(crate) feed_forward_weight: bool,
}

/// The whole-capacity-inwards baseline.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct RadialFile {
    #[serde(default = "default_band")]
    pub(crate) band: f64,
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
pub(crate) struct DampingFile {
    pub(crate) coefficient_n_s_m: Option<f64>,
}

/// How the end is judged.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with keys")]
pub(crate) struct VerdictFile {
    pub(crate) whirl_speed_m_s: Option<f64>,
}
