//! What crosses the border at every tick: [`Sample`] in, [`Command`] out.

use crate::border::finding::Checked;
use crate::number::words::Words;

/// What the firmware knows at one sampling instant. Any bit pattern is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Sample {
    /// Counts up by one each tick, wrapping. A repeated number means that no new sample came; a gap
    /// means that ticks were missed.
    pub sequence: u32,
    /// What is valid and ready.
    pub status: Status,
    /// Rotor position at the sensor, relative to the centre of the retainer bearing, x and y \[m\].
    pub position_m: [f32; 2],
    /// Spin Ω \[rad/s\], counter-clockwise positive; used only with [`Status::SPIN_VALID`].
    pub spin_rad_s: f32,
    /// Force that the levitation controller wants \[N\].
    pub levitation_n: [f32; 2],
    /// What the actuator delivers of the commanded force at this sampling instant \[N\], from current or flux feedback,
    /// without what the firmware adds to the command; used only with [`Status::APPLIED_VALID`], while it is finite and
    /// at most two caps long.
    pub applied_n: [f32; 2],
}

bitflags::bitflags! {
    /// Status bits that come in with a [`Sample`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[repr(transparent)]
    pub struct Status: u32 {
        /// `spin_rad_s` is measured. Without it the supervisor works against the observed whirl.
        const SPIN_VALID = 1;
        /// The bearing is switched on and may act. Without it the supervisor watches and records,
        /// and lets the levitation command through.
        const BEARING_ON = 1 << 1;
        /// `applied_n` is measured. Without it the supervisor models amplifier and delay, and does not see a drive
        /// that disobeys.
        const APPLIED_VALID = 1 << 2;
        /// The drive cannot act along x: nothing is commanded there.
        const AXIS_X_LOST = 1 << 3;
        /// The drive cannot act along y: nothing is commanded there.
        const AXIS_Y_LOST = 1 << 4;
        /// The last command came too late for its tick: the actuator kept the one before for that long.
        const LATE = 1 << 5;
        /// Compute and record, but let the levitation command through, within the limits: to watch the supervisor on a
        /// machine before it may act. A drive that disobeys is left to the controller, too.
        const SHADOW = 1 << 6;
        /// The rotor is meant to be set down on its retainer bearing, or lies there and is to be lifted: the supervisor leaves it to
        /// the levitation controller and acts on backward whirl alone.
        const SET_DOWN = 1 << 7;
        /// The rotor levitated until now, and its readings moved as they usually do: what they show is acted on from the first
        /// sample on. Without it the supervisor looks for itself first, for six √(m·c/F) in peace, and until then acts on whirl alone.
        const LEVITATED_BEFORE = 1 << 8;
    }

    /// What binds the command of this tick. Eight bits, so that the flight record keeps them all.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[repr(transparent)]
    pub struct Limits: u32 {
        /// The wanted force was larger than the cap.
        const FORCE_CAP = 1;
        /// The levitation command was not finite or beyond a limit.
        const LEVITATION_CLAMPED = 1 << 1;
        /// Something that should have been a number was not; the force along it goes to zero.
        const NOT_FINITE = 1 << 2;
        /// The sample was not used: the estimate is running on its model.
        const SAMPLE_REFUSED = 1 << 3;
        /// The force changes no faster than the slew limit allows.
        const SLEW = 1 << 4;
        /// An axis had less than was wanted: its cap, or it is lost.
        const AXIS_CAP = 1 << 5;
        /// The cap that bound was the one lowered by the force–time budget.
        const DERATED = 1 << 6;
        /// The rotor whirls backward in contact faster than the cap can arrest.
        const BEYOND_WHIRL_LIMIT = 1 << 7;
    }

    /// What changed at this tick. The low 16 bits go into the flight record.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[repr(transparent)]
    pub struct Events: u32 {
        /// The supervisor took over from the levitation controller.
        const ENGAGED = 1;
        /// The rotor touched the retainer bearing.
        const TOUCHED = 1 << 1;
        /// It left it.
        const LIFTED_OFF = 1 << 2;
        /// Continuous backward whirl was recognised.
        const WHIRL = 1 << 3;
        /// The rotor was recognised as held on the bearing by a load.
        const PINNED = 1 << 4;
        /// Hand-over to the levitation controller began.
        const HANDOVER = 1 << 5;
        /// The levitation controller has the bearing again.
        const LEVITATED = 1 << 6;
        /// Samples were implausible for too long; the force goes to zero along what cannot be trusted.
        const SENSOR_FAULT = 1 << 7;
        /// Samples are plausible again.
        const SENSOR_OK = 1 << 8;
        /// A sequence number was missed or repeated.
        const SEQUENCE = 1 << 9;
        /// The last command came too late ([`Status::LATE`]).
        const LATE = 1 << 10;
        /// From this tick on another configuration holds.
        const RECONFIGURED = 1 << 11;
        /// The drive has lost an axis, or does not obey on it ([`Status::APPLIED_VALID`]).
        const AXIS_LOST = 1 << 12;
        /// An axis is back.
        const AXIS_BACK = 1 << 13;
        /// The machine should coast down: whirl beyond the limit has lasted, or the severity index has
        /// passed its limit. Once until the bearing is switched off.
        const COAST_DOWN = 1 << 14;
        /// Forward rub was recognised: the rotor slides round the retainer bearing with its spin and at its rate,
        /// as unbalance drives it.
        const FORWARD_RUB = 1 << 15;
        /// The flight recorder has frozen a record.
        const RECORD_FROZEN = 1 << 16;
        /// An event was lost because the background did not drain the queue. Only in the queue.
        const QUEUE_FULL = 1 << 17;
        /// The supervisor made no progress and gave the bearing back to the levitation controller.
        const HANDED_BACK = 1 << 18;
    }
}

impl Status {
    /// What says that x, y is lost.
    pub(crate) const LOST_AXES: [Self; 2] = [Self::AXIS_X_LOST, Self::AXIS_Y_LOST];
}

/// Why a sample is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum RejectReason {
    /// It is not.
    #[default]
    None = 0,
    /// A coordinate is NaN or infinite.
    NotFinite = 1,
    /// The radius is beyond `position_limit`.
    Range = 2,
    /// No rotor moves so far in the time since the last good sample.
    Slew = 3,
    /// The sequence number is the last one: no new sample came.
    Dropout = 4,
    /// A coordinate does not change although the rotor moves.
    Stuck = 5,
    /// Farther from where the rotor was bound to than noise and any force could take it.
    Doubted = 6,
}

impl Words for RejectReason {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(*self as u32);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        let all = [
            Self::None,
            Self::NotFinite,
            Self::Range,
            Self::Slew,
            Self::Dropout,
            Self::Stuck,
            Self::Doubted,
        ];
        let number = u32::decode(from);
        let named = all.into_iter().find(|reason| *reason as u32 == number);
        named.unwrap_or_default()
    }
}

impl RejectReason {
    /// Whether the sample shows what cannot be, and is not merely old.
    pub(crate) fn is_wrong(self) -> bool {
        matches!(self, Self::NotFinite | Self::Range | Self::Slew)
    }
}

/// What the supervisor is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Mode {
    /// Transparent: the levitation command goes through bit for bit, within the limits and along axes that act; but for
    /// that of a sample which cannot be, in whose place the one before stays.
    #[default]
    Levitated = 0,
    /// Contact can no longer be avoided: tangential force against the backward whirl that the impacts to come would
    /// drive, as far as it would be dangerous; the rest damps.
    Approach = 1,
    /// Touching and leaving again: damping, tangential first.
    Bounce = 2,
    /// Continuous backward whirl: braking.
    BackwardWhirl = 3,
    /// Held on the bearing by a load: inward, damped hold.
    Pinned = 4,
    /// Blending over to the levitation controller.
    Handover = 5,
    /// No trustworthy position: force blended to zero; if one coordinate is good, levitation command along it.
    SensorFault = 6,
    /// The supervisor has given up for a while, as it made no progress: the levitation command goes through as in `Levitated`,
    /// whatever the rotor does.
    HandedBack = 7,
}

impl Words for Mode {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(*self as u32);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        let all = [
            Self::Levitated,
            Self::Approach,
            Self::Bounce,
            Self::BackwardWhirl,
            Self::Pinned,
            Self::Handover,
            Self::SensorFault,
            Self::HandedBack,
        ];
        let number = u32::decode(from);
        let named = all.into_iter().find(|mode| *mode as u32 == number);
        named.unwrap_or_default()
    }
}

impl Mode {
    /// Whether the supervisor has the bearing, alone or in part.
    #[inline]
    pub const fn is_engaged(self) -> bool {
        !matches!(self, Self::Levitated | Self::HandedBack)
    }

    /// Short name for tables and traces.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Levitated => "levitated",
            Self::Approach => "approach",
            Self::Bounce => "bounce",
            Self::BackwardWhirl => "backward whirl",
            Self::Pinned => "pinned",
            Self::Handover => "handover",
            Self::SensorFault => "sensor fault",
            Self::HandedBack => "handed back",
        }
    }
}

/// What the levitation controller should do with its integrator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum IntegratorHint {
    /// Integrate as usual.
    #[default]
    Run = 0,
    /// Keep its value: the bearing does not do what the controller wants. It holds what carried the
    /// rotor's load before the contact, and will have to carry it again.
    Hold = 1,
}

/// What to do until the next tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command {
    /// Force to command \[N\]: finite, within the cap, the caps of the axes and the slew limit (to the last
    /// bits of `f32`).
    pub force_n: [f32; 2],
    /// Force that the supervisor would command \[N\], within the same limits: `force_n` but under
    /// [`Status::SHADOW`].
    pub own_n: [f32; 2],
    /// What the supervisor is doing.
    pub mode: Mode,
    /// What binds now.
    pub limits: Limits,
    /// What changed.
    pub events: Events,
    /// Hint for the levitation controller's integrator.
    pub integrator: IntegratorHint,
    /// Backward speed that is to be expected after the impacts to come, over the highest that the cap
    /// can arrest; 0 while no contact is coming, 1e6 at most.
    pub severity: f32,
}

/// A [`Sample`] per unit, for a core without floating point ([`crate::Core`]).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CoreSample<S> {
    /// As in [`Sample`].
    pub sequence: u32,
    /// As in [`Sample`].
    pub status: Status,
    /// Position at the retainer bearing \[clearances\].
    pub position: [S; 2],
    /// Spin, counter-clockwise positive \[1/t₀\]. Forces follow its sense alone, its size tells forward rub; one
    /// too fast for the number may be cut.
    pub spin: S,
    /// Force that the levitation controller wants \[caps\].
    pub levitation: [S; 2],
    /// As in [`Sample`] \[caps\].
    pub applied: [S; 2],
}

/// A [`Command`] per unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CoreCommand<S> {
    /// Force to command \[caps\].
    pub force: [S; 2],
    /// Force that the supervisor would command \[caps\].
    pub own: [S; 2],
    /// As in [`Command`].
    pub mode: Mode,
    /// As in [`Command`].
    pub limits: Limits,
    /// As in [`Command`].
    pub events: Events,
    /// As in [`Command`].
    pub integrator: IntegratorHint,
    /// As in [`Command`]; saturating.
    pub severity: S,
}

/// What has happened since the supervisor was made. A flight record that is discarded takes nothing from it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report {
    /// Engagements in which the rotor touched the retainer bearing.
    pub landings: u32,
    /// Engagements without a touch.
    pub nuisance_engagements: u32,
    /// Times that the bearing was handed back because an engagement made no progress.
    pub handed_back: u32,
    /// Touches in them.
    pub impacts: u32,
    /// Ticks in contact in them.
    pub contact_ticks: u32,
    /// Fastest normal speed before an impact, estimated \[m/s\].
    pub impact_speed_max_m_s: f32,
    /// Fastest backward speed in contact, estimated \[m/s\].
    pub backward_speed_max_m_s: f32,
    /// Highest backward speed that the cap can arrest, from the configuration \[m/s\].
    pub whirl_limit_m_s: f32,
    /// Energy of all impacts and of friction on the whirl over the energy at `whirl_limit_m_s`; 1e9 at most.
    pub severity_index: f32,
    /// Whether coasting down was asked for and the bearing has been on ever since.
    pub coast_down: bool,
    /// State of the force–time budget: above 1 the cap is lowered.
    pub thermal_state: f32,
    /// Force cap now \[N\].
    pub force_cap_n: f32,
    /// Ticks that were missed, by the sequence number.
    pub missed_ticks: u32,
    /// Calls with the sequence number of the call before.
    pub repeated_ticks: u32,
    /// Commands that came too late.
    pub late_ticks: u32,
    /// Why the last sample was refused, if it was.
    pub refusal: RejectReason,
    /// Why the last sensor fault began.
    pub fault: RejectReason,
    /// What the check of the configuration has come to.
    pub checked: Checked,
}
