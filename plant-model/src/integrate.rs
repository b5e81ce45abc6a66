//! How time passes: flight and contact by power series, an explicit and a stiff method beside them, and
//! the events between modes.

pub(crate) mod contact_series;
pub(crate) mod contact_step;
mod crossings;
pub(crate) mod dop853;
pub(crate) mod driver;
pub(crate) mod enough;
pub(crate) mod first_fall;
pub(crate) mod flight;
pub(crate) mod flight_map;
mod frame;
mod lu;
mod pair;
pub(crate) mod progress;
pub(crate) mod radau;
mod radau_tableau;
mod scales;
pub(crate) mod series_readout;
pub(crate) mod series_step;
pub(crate) mod transitions;

use crate::params::ContactLaw;

/// λ·v from which the stiff method is taken with Hunt and Crossley's law. Measured on impacts sampled at
/// 20 kHz the explicit pair is two to five times faster up to here; at 3e6 it runs out of steps.
const OVERDAMPED_IMPACT: f64 = 1e4;

/// How contact is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// [`Method::Series`], or [`Method::Stiff`] where the contact is so overdamped that stability and
    /// not the tolerance would set the steps of the series. [`Method::Explicit`] or [`Method::Stiff`]
    /// with a contact law that has no power series.
    #[default]
    Auto,
    /// Power series of the order that the tolerance asks for.
    Series,
    /// The explicit pair of order 8(5,3).
    Explicit,
    /// L-stable collocation of order 9 in a frame that turns with the contact point.
    Stiff,
}

impl Method {
    /// What [`Method::Auto`] comes to; the others stay.
    ///
    /// The linear law goes by its damping ratio ζ = d_c/(2√(k_c·m)) and the rate d_c/m at which the
    /// damper stops the rotor.
    /// The series must take about one step for every eight of the damper's time constants. Measured
    /// at 20 samples a millisecond on rigid and elastic stators the two are equally fast at ten time
    /// constants a sample (at forty below 1e-10), and the stiff method a hundred times faster at
    /// ζ = 100 and k_c = 1e10 N/m. Where contact springs back it has no such advantage.
    ///
    /// Hunt and Crossley's law goes by λ·v with v the speed at the start: the rotor creeps out at 1/λ, over
    /// about (n + 1)·λ·v of the damper's time constants. A rotor that touches at the start slides, rolls or rests there
    /// for long, where the explicit pair has to follow a contact that does not move: in whirl it takes some
    /// three hundred times as many steps.
    pub(crate) fn resolved(
        self,
        law: &ContactLaw,
        (speed_m_s, touching): (f64, bool),
        mobility: f64,
        rtol: f64,
    ) -> Self {
        if self != Self::Auto {
            return self;
        }
        let worth = match law {
            ContactLaw::Linear(law) => {
                let rate_s = law.damping_n_s_m * mobility;
                let ratio = 0.5 * rate_s / (law.stiffness_n_m * mobility).sqrt();
                ratio > 2.0 && rate_s > if rtol < 1e-10 { 1e6 } else { 2.5e5 }
            }
            ContactLaw::HuntCrossley(law) => {
                touching || law.damping_s_m * speed_m_s > OVERDAMPED_IMPACT
            }
        };
        match (worth, law) {
            (true, _) => Self::Stiff,
            (false, ContactLaw::Linear(_)) => Self::Series,
            (false, ContactLaw::HuntCrossley(_)) => Self::Explicit,
        }
    }

    /// Name as in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Series => "series",
            Self::Explicit => "explicit",
            Self::Stiff => "stiff",
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
