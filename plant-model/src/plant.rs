//! The plant as its users see it: built once from [`PlantParams`], carried from sample to sample.

use crate::V2;
use crate::energy::Audit;
use crate::integrate::driver::Run;
use crate::magnet::{Amplifier, Direct, Lagged};
use crate::mode::Mode;
use crate::params::{ParamError, PlantParams, SpinParams, Start, StatorParams};
use crate::part::{Body, Part};
use crate::spin::{Free, FreePhased, Held, Spin};
use crate::stator::{OneMass, Rigid, Stator, TwoMass};
use crate::system::{Inputs, State, StateOf, System, Touch};

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

/// Why a plant could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// A parameter is out of range.
    #[error(transparent)]
    Param(#[from] ParamError),
}

/// What can be read off at an instant, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapshot {
    /// Time \[s\].
    pub t_s: f64,
    /// Rotor position \[m\].
    pub position_m: V2,
    /// Rotor velocity \[m/s\].
    pub velocity_m_s: V2,
    /// Ring that the rotor touches; at rest in the centre for a rigid stator.
    pub inner_ring: Body,
    /// Outer ring; at rest in the centre where there is none.
    pub outer_ring: Body,
    /// Spin Ω \[rad/s\].
    pub spin_rad_s: f64,
    /// What the rotor does.
    pub mode: Mode,
    /// A of eq. (2.8) \[m\]; negative inside the clearance.
    pub penetration_m: f64,
    /// f_n \[N\]; 0 without contact.
    pub normal_force_n: f64,
    /// Sliding friction on the rotor along t̂ \[N\].
    pub sliding_force_n: f64,
    /// Rolling friction on the rotor along t̂ \[N\].
    pub rolling_force_n: f64,
    /// Tangential speed of the rotor against the ring about its centre \[m/s\].
    pub contact_tangential_speed_m_s: f64,
    /// Force that the magnet delivers \[N\].
    pub delivered_n: V2,
    /// Angle of the contact point, summed over all contact so far \[rad\]; differences are meaningful
    /// within one contact.
    pub whirl_angle_rad: f64,
}

/// Extremes and sums over a run, taken at every step and not only at samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Meters {
    /// Number of touches.
    pub impacts: u64,
    /// Time in contact \[s\].
    pub contact_time_s: f64,
    /// Largest normal speed at a touch \[m/s\].
    pub peak_impact_speed_m_s: f64,
    /// Largest f_n \[N\].
    pub peak_contact_force_n: f64,
    /// Largest sliding-friction torque on the spin \[N m\].
    pub peak_friction_torque_n_m: f64,
    /// Largest tangential speed against the spin while in contact \[m/s\].
    pub peak_backward_speed_m_s: f64,
    /// Angle of the contact point summed over all contact \[rad\].
    pub whirl_angle_rad: f64,
}

impl Meters {
    pub(crate) fn contact_step(&mut self, start: &Touch, end: &Touch, step_s: f64, turn_rad: f64) {
        self.contact_time_s += step_s;
        self.whirl_angle_rad += turn_rad;
        self.peak_contact_force_n = self.peak_contact_force_n.max(end.normal_n);
        // A maximum inside the step: the cubic through both ends and their slopes, at its top.
        if start.normal_rate_n_s > 0.0 && end.normal_rate_n_s < 0.0 {
            let top = cubic_maximum(
                start.normal_n,
                end.normal_n,
                start.normal_rate_n_s * step_s,
                end.normal_rate_n_s * step_s,
            );
            self.peak_contact_force_n = self.peak_contact_force_n.max(top);
        }
    }
}

/// Maximum over [0, 1] of the cubic with the given end values and slopes (rising, then falling).
fn cubic_maximum(f0: f64, f1: f64, d0: f64, d1: f64) -> f64 {
    let a = 2.0 * (f0 - f1) + d0 + d1;
    let b = 3.0 * (f1 - f0) - 2.0 * d0 - d1;
    // 3a·x² + 2b·x + d0 = 0; the root with falling slope, in the form that does not cancel.
    let root = (b * b - 3.0 * a * d0).max(0.0).sqrt();
    let x = if b <= 0.0 { d0 / (root - b) } else { -(b + root) / (3.0 * a) };
    if x > 0.0 && x < 1.0 {
        f0 + x * (d0 + x * (b + x * a))
    } else {
        f0.max(f1)
    }
}

/// How much work the contact integrator did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Events found.
    pub events: u64,
}

/// A plant that is being run. Deterministic: the same calls give the same bits.
pub trait Plant: Send {
    /// Carries the plant to `t_end_s` with `inputs` held. `on_change` is called right after each
    /// change of mode with what can be read off there.
    ///
    /// # Errors
    /// [`PlantError`]: the run cannot be trusted any further and must end.
    fn advance(
        &mut self,
        t_end_s: f64,
        inputs: &Inputs,
        on_change: &mut dyn FnMut(&Snapshot),
    ) -> Result<(), PlantError>;
    /// What can be read off now.
    fn snapshot(&self) -> Snapshot;
    /// Mode now.
    fn mode(&self) -> Mode;
    /// Extremes and sums so far.
    fn meters(&self) -> Meters;
    /// The energy audit so far.
    fn audit(&self) -> Audit;
    /// Work done so far.
    fn work(&self) -> Work;
    /// Number of scalar states that this plant integrates in contact.
    fn states(&self) -> usize;
}

impl<S, W, M> Plant for Run<S, W, M>
where
    S: Stator + Send,
    W: Spin + Send,
    M: Amplifier + Send,
    StateOf<S, W, M>: Send,
{
    fn advance(
        &mut self,
        t_end_s: f64,
        inputs: &Inputs,
        on_change: &mut dyn FnMut(&Snapshot),
    ) -> Result<(), PlantError> {
        Run::advance(self, t_end_s, inputs, on_change)
    }
    fn snapshot(&self) -> Snapshot {
        Run::snapshot(self)
    }
    fn mode(&self) -> Mode {
        Run::mode(self)
    }
    fn meters(&self) -> Meters {
        self.meters
    }
    fn audit(&self) -> Audit {
        Run::audit(self)
    }
    fn work(&self) -> Work {
        Run::work(self)
    }
    fn states(&self) -> usize {
        <StateOf<S, W, M> as Part>::STATES
    }
}

/// Builds the plant that has exactly the parts of `params`: the one place that turns data into the
/// right combination of types.
///
/// # Errors
/// [`BuildError::Param`] for the first value out of range.
pub fn build(
    params: &PlantParams,
    start: &Start,
    options: Options,
) -> Result<Box<dyn Plant>, BuildError> {
    params.validate()?;
    start.validate()?;
    if !(options.rtol > 0.0 && options.rtol <= 1e-2) {
        return Err(BuildError::Param(ParamError {
            field: "run.rtol",
            value: options.rtol,
            expected: "a number greater than 0, at most 0.01",
        }));
    }
    Ok(match &params.stator {
        StatorParams::Rigid => with_stator(params, start, options, Rigid),
        StatorParams::OneMass(ring) => with_stator(params, start, options, OneMass(*ring)),
        StatorParams::TwoMass { inner, outer } => {
            let stator = TwoMass {
                inner: *inner,
                outer: *outer,
            };
            with_stator(params, start, options, stator)
        }
    })
}

fn with_stator<S>(params: &PlantParams, start: &Start, o: Options, stator: S) -> Box<dyn Plant>
where
    S: Stator + Send + 'static,
    S::State: Send,
{
    match params.spin {
        SpinParams::Held => {
            let held = Held {
                spin_rad_s: start.spin_rad_s,
                phase_rad: start.spin_phase_rad,
            };
            with_spin(params, start, o, stator, held)
        }
        SpinParams::Free {
            inertia_kg_m2,
            drive_torque_n_m,
        } => {
            let free = Free {
                inertia_kg_m2,
                drive_torque_n_m,
            };
            if params.rotor.eccentricity_m > 0.0 {
                with_spin(params, start, o, stator, FreePhased(free))
            } else {
                with_spin(params, start, o, stator, free)
            }
        }
    }
}

fn with_spin<S, W>(
    params: &PlantParams,
    start: &Start,
    options: Options,
    stator: S,
    spin: W,
) -> Box<dyn Plant>
where
    S: Stator + Send + 'static,
    S::State: Send,
    W: Spin + Send + 'static,
    W::State: Send,
{
    match params.magnet {
        Some(magnet) if magnet.lag_s > 0.0 => {
            let lagged = Lagged { lag_s: magnet.lag_s };
            compose(params, start, options, stator, spin, lagged)
        }
        _ => compose(params, start, options, stator, spin, Direct),
    }
}

fn compose<S, W, M>(
    params: &PlantParams,
    start: &Start,
    options: Options,
    stator: S,
    spin: W,
    amplifier: M,
) -> Box<dyn Plant>
where
    S: Stator + Send + 'static,
    S::State: Send,
    W: Spin + Send + 'static,
    W::State: Send,
    M: Amplifier + Send + 'static,
    M::State: Send,
{
    let system = System {
        rotor: params.rotor,
        contact: params.contact,
        friction: params.friction,
        stator,
        spin,
        amplifier,
    };
    let state = State {
        rotor: Body {
            position: start.position_m,
            velocity: start.velocity_m_s,
        },
        stator: S::State::default(),
        spin: spin.start(start.spin_rad_s, start.spin_phase_rad),
        force: M::State::default(),
    };
    let force_max_n = params.magnet.map_or(0.0, |m| m.force_max_n);
    Box::new(Run::new(system, state, force_max_n, options))
}
