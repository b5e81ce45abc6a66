//! The plant as its users see it: built once from [`PlantParams`], carried from sample to sample.

use crate::ellipse::Ellipse;
use crate::energy::Audit;
use crate::integrate::driver::Run;
use crate::integrate::{Method, Options, PlantError};
use crate::magnet::{Amplifier, Direct, Lagged};
use crate::mode::Mode;
use crate::params::{Change, ParamError, PlantParams, SpinParams, Start, StatorParams};
use crate::part::{Body, Part};
use crate::readout::{Meters, Snapshot, Work};
use crate::spin::race::{Race, Raced};
use crate::spin::{Free, FreePhased, Held, Spin};
use crate::stator::{Elliptic, OneMass, Rigid, Stator, TwoMass};
use crate::system::{Inputs, State, StateOf, System};

/// Why a plant could not be built.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// A parameter is out of range.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// The power series is asked for with a contact that has none.
    #[error(
        "run.method = series: Hunt and Crossley's contact has no power series at the touch, and a \
         bearing out of round none at all; take auto, explicit or stiff"
    )]
    NoSeries,
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
    /// Gives parameters other values from now on. Position, speeds and stored energy stay: none of these
    /// parameters has a share in the stored energy, and what they do from here on is booked as before.
    ///
    /// # Errors
    /// A value that is out of range, or that this plant has no part for. Then nothing has changed.
    fn change(&mut self, change: &Change) -> Result<(), ParamError>;
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
    /// Method that integrates contact; never [`Method::Auto`].
    fn method(&self) -> Method;
    /// Number of scalar states that this plant integrates in contact.
    fn states(&self) -> usize;
}

impl<S: Stator, W: Spin, M: Amplifier> Plant for Run<S, W, M> {
    fn advance(
        &mut self,
        t_end_s: f64,
        inputs: &Inputs,
        on_change: &mut dyn FnMut(&Snapshot),
    ) -> Result<(), PlantError> {
        Run::advance(self, t_end_s, inputs, on_change)
    }
    fn change(&mut self, change: &Change) -> Result<(), ParamError> {
        Run::change(self, change)
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
    fn method(&self) -> Method {
        Run::method(self)
    }
    fn states(&self) -> usize {
        <StateOf<S, W, M> as Part>::STATES
    }
}

/// Builds the plant that has exactly the parts of `params`: the one place that turns data into the
/// right combination of types.
///
/// # Errors
/// [`BuildError::Param`] for the first value out of range, [`BuildError::NoSeries`].
pub fn build(
    params: &PlantParams,
    start: &Start,
    options: Options,
) -> Result<Box<dyn Plant>, BuildError> {
    checked(params, start, options)?;
    Ok(with_parts(
        params,
        start,
        options,
        params.rotor.eccentricity_m > 0.0,
    ))
}

/// [`build`] with a rotor whose angle is followed from the start, so that an unbalance may come later.
///
/// # Errors
/// As [`build`].
pub fn build_for_changes(
    params: &PlantParams,
    start: &Start,
    options: Options,
) -> Result<Box<dyn Plant>, BuildError> {
    checked(params, start, options)?;
    Ok(with_parts(params, start, options, true))
}

fn checked(params: &PlantParams, start: &Start, options: Options) -> Result<(), BuildError> {
    params.validate()?;
    start.validate()?;
    if !(options.rtol >= 1e-14 && options.rtol <= 1e-2) {
        return Err(BuildError::Param(ParamError {
            field: "run.rtol",
            value: options.rtol,
            expected: "a number from 1e-14 to 0.01",
        }));
    }
    if options.method == Method::Series && !params.has_series() {
        return Err(BuildError::NoSeries);
    }
    Ok(())
}

fn with_parts(
    params: &PlantParams,
    start: &Start,
    options: Options,
    phased: bool,
) -> Box<dyn Plant> {
    let made = (options, phased);
    match &params.stator {
        StatorParams::Rigid => with_stator(params, start, made, Rigid),
        StatorParams::RigidEllipse(ellipse) => {
            let ellipse = Ellipse::new(ellipse, params.contact.clearance_m);
            with_stator(params, start, made, Elliptic(ellipse))
        }
        StatorParams::OneMass(ring) => with_stator(params, start, made, OneMass(*ring)),
        StatorParams::TwoMass { inner, outer } => {
            let stator = TwoMass {
                inner: *inner,
                outer: *outer,
            };
            with_stator(params, start, made, stator)
        }
    }
}

fn with_stator<S: Stator>(
    params: &PlantParams,
    start: &Start,
    (o, phased): (Options, bool),
    stator: S,
) -> Box<dyn Plant> {
    if let Some(race) = &params.race {
        let (inverse_inertia, drive_torque_n_m) = match params.spin {
            SpinParams::Held => (0.0, 0.0),
            SpinParams::Free {
                inertia_kg_m2,
                drive_torque_n_m,
            } => (1.0 / inertia_kg_m2, drive_torque_n_m),
        };
        let raced = Raced {
            inverse_inertia,
            drive_torque_n_m,
            race: Race {
                radius_m: params.bore_radius_m(),
                inertia_kg_m2: race.inertia_kg_m2,
                drag_n_m_s: race.drag_n_m_s,
                start_spin_rad_s: race.start_spin_rad_s,
            },
        };
        return with_spin(params, start, o, stator, raced);
    }
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
            if phased {
                with_spin(params, start, o, stator, FreePhased(free))
            } else {
                with_spin(params, start, o, stator, free)
            }
        }
    }
}

fn with_spin<S: Stator, W: Spin>(
    params: &PlantParams,
    start: &Start,
    options: Options,
    stator: S,
    spin: W,
) -> Box<dyn Plant> {
    match params.magnet {
        Some(magnet) if magnet.lag_s > 0.0 => {
            let lagged = Lagged {
                lag_s: magnet.lag_s,
            };
            compose(params, start, options, stator, spin, lagged)
        }
        _ => compose(params, start, options, stator, spin, Direct),
    }
}

fn compose<S: Stator, W: Spin, M: Amplifier>(
    params: &PlantParams,
    start: &Start,
    options: Options,
    stator: S,
    spin: W,
    amplifier: M,
) -> Box<dyn Plant> {
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
