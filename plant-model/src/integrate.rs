//! How time passes: exact flight, a high-order explicit pair in contact, events between them.

pub(crate) mod contact_step;
pub(crate) mod dop853;
pub(crate) mod driver;
pub(crate) mod flight;

/// Accuracy and work limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Relative tolerance of one contact step, in (0, 1e-2].
    pub rtol: f64,
    /// Steps allowed between two control samples before the run gives up with
    /// [`PlantError::WorkLimit`].
    pub steps_per_sample: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rtol: 1e-9,
            steps_per_sample: 1_000_000,
        }
    }
}

/// Why a run cannot be trusted any further.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// An input or the state is not finite.
    #[error("at t = {t_s} s: a force or the state is not finite")]
    NotFinite {
        /// When \[s\].
        t_s: f64,
    },
    /// The tolerance cannot be met with a step the clock can resolve.
    #[error("at t = {t_s} s: the step needed for the tolerance is too small for the clock")]
    StepTooSmall {
        /// When \[s\].
        t_s: f64,
    },
    /// Too many steps between two samples.
    #[error("at t = {t_s} s: {steps} steps within one control sample are not enough")]
    WorkLimit {
        /// When \[s\].
        t_s: f64,
        /// The limit.
        steps: u32,
    },
    /// Modes follow each other without time passing.
    #[error("at t = {t_s} s: the contact mode cannot be decided")]
    ModeUndecided {
        /// When \[s\].
        t_s: f64,
    },
}
