//! By which method, how accurately and with how much work a run is integrated, and why it may end.

pub(crate) mod first_crossing;
pub(crate) mod order_control;
pub(crate) mod progress;

use crate::params::{ParamError, check};

/// How contact is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// [`Method::Series`]; [`Method::Collocation`] with what has no power series, and where a contact is so overdamped that stability
    /// and not the tolerance would set the steps of the series.
    #[default]
    Auto,
    /// Power series of the order that the tolerance asks for.
    Series,
    /// Implicit collocation in eight points.
    Collocation,
}

impl Method {
    /// Name as in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Series => "series",
            Self::Collocation => "collocation",
        }
    }
}

/// Accuracy and work limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Relative tolerance of one contact step, from 1e-14 to 1e-2.
    pub rtol: f64,
    /// How contact is integrated.
    pub method: Method,
    /// Steps allowed between two control samples before the run gives up with
    /// [`PlantError::WorkLimit`]. Free flight does not count.
    pub steps_per_sample: u64,
    /// Steps allowed in the whole run.
    pub steps: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rtol: 1e-9,
            method: Method::default(),
            steps_per_sample: 200_000,
            steps: 50_000_000,
        }
    }
}

impl Options {
    /// Checks the tolerance against its range.
    ///
    /// # Errors
    /// A tolerance out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        let (rtol, range) = (self.rtol, "a number from 1e-14 to 0.01");
        check((1e-14..=1e-2).contains(&rtol), "run.rtol", rtol, range)
    }
}

/// What moves fastest in a rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fastest {
    /// What it is.
    pub what: &'static str,
    /// Its plane, unless it is the rotor with its supports.
    pub plane: Option<usize>,
    /// Its rate \[1/s\].
    pub rate_s: f64,
}

impl std::fmt::Display for Fastest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the {}", self.what)?;
        if let Some(plane) = self.plane {
            write!(f, " of plane {plane}")?;
        }
        write!(f, ", with a rate of {:.1e} /s,", self.rate_s)
    }
}

/// Why a run cannot be trusted any further.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// An input or the state is not finite.
    #[error("at t = {t_s:e} s: a force or the state is not finite")]
    NotFinite {
        /// When \[s\].
        t_s: f64,
    },
    /// The tolerance cannot be met with a step the clock can resolve.
    #[error("at t = {t_s:e} s: the step needed for the tolerance is too small for the clock")]
    StepTooSmall {
        /// When \[s\].
        t_s: f64,
    },
    /// Too many steps, between two samples or in all.
    #[error(
        "at t = {t_s:e} s: {steps} steps are not enough; {} too fast for this scene",
        fastest.map_or("something moves".to_owned(), |f| format!("{f} is"))
    )]
    WorkLimit {
        /// When \[s\].
        t_s: f64,
        /// The limit.
        steps: u64,
        /// What moves fastest, of a whole rotor.
        fastest: Option<Fastest>,
    },
    /// The rotor has left everything that the model describes.
    #[error(
        "at t = {t_s:e} s: the rotor is {radius_m:e} m from the centre, far beyond its stator; \
         is a stiffness too low, or a force too large?"
    )]
    Diverged {
        /// When \[s\].
        t_s: f64,
        /// How far \[m\].
        radius_m: f64,
    },
    /// A machine was given another number of commands or loads than it has magnets or places for loads.
    #[error(
        "at t = {t_s:e} s: expected a command for each magnet and a force for each place of a load"
    )]
    InputCount {
        /// When \[s\].
        t_s: f64,
    },
    /// Modes follow each other without time passing.
    #[error("at t = {t_s:e} s: the contact mode cannot be decided")]
    ModeUndecided {
        /// When \[s\].
        t_s: f64,
    },
}
