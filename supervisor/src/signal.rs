//! What crosses the border at every tick: [`Sample`] in, [`Command`] out.

/// What the firmware knows at one sampling instant. Any bit pattern is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct Sample {
    /// Counts up by one each tick, wrapping. A repeated number means that no new sample came; a gap
    /// means that ticks were missed.
    pub sequence: u32,
    /// What is valid and ready.
    pub status: Status,
    /// Rotor position relative to the centre of the retainer bearing, x and y \[m\].
    pub position_m: [f32; 2],
    /// Spin Ω \[rad/s\], counter-clockwise positive; used only with [`Status::SPIN_VALID`].
    pub spin_rad_s: f32,
    /// Force that the levitation controller wants \[N\].
    pub levitation_n: [f32; 2],
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
    }

    /// What binds the command of this tick.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[repr(transparent)]
    pub struct Limits: u32 {
        /// The wanted force was larger than the cap.
        const FORCE_CAP = 1;
        /// The levitation command was not finite or larger than the cap.
        const LEVITATION_CLAMPED = 1 << 1;
        /// Something that should have been a number was not; the force was set to zero.
        const NOT_FINITE = 1 << 2;
        /// The sample was not used: the estimate is running on its model.
        const SAMPLE_REFUSED = 1 << 3;
    }

    /// What changed at this tick.
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
        /// Samples were implausible for too long; the force goes to zero.
        const SENSOR_FAULT = 1 << 7;
        /// Samples are plausible again.
        const SENSOR_OK = 1 << 8;
        /// A sequence number was missed or repeated.
        const SEQUENCE = 1 << 9;
        /// The flight recorder has frozen a record.
        const RECORD_FROZEN = 1 << 10;
        /// An event was lost because the background did not drain the queue.
        const QUEUE_FULL = 1 << 11;
    }
}

/// What the supervisor is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u8)]
pub enum Mode {
    /// Transparent: the levitation command goes through bit for bit.
    #[default]
    Levitated = 0,
    /// Contact can no longer be avoided: tangential force against the coming backward whirl.
    Approach = 1,
    /// Touching and leaving again: damping, tangential first.
    Bounce = 2,
    /// Continuous backward whirl: braking.
    BackwardWhirl = 3,
    /// Held on the bearing by a load: inward, damped hold.
    Pinned = 4,
    /// Blending over to the levitation controller.
    Handover = 5,
    /// No trustworthy position: force blended to zero.
    SensorFault = 6,
}

impl Mode {
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
        }
    }
}

/// What the levitation controller should do with its integrator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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
pub struct Command {
    /// Force to command \[N\]: finite, no longer than the cap (to the last bit of `f32`).
    pub force_n: [f32; 2],
    /// What the supervisor is doing.
    pub mode: Mode,
    /// What binds now.
    pub limits: Limits,
    /// What changed.
    pub events: Events,
    /// Hint for the levitation controller's integrator.
    pub integrator: IntegratorHint,
}
