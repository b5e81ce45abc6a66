//! The plant as its users see it: built once from [`PlantParams`], carried from sample to sample.

use crate::ellipse::Ellipse;
use crate::energy::Audit;
use crate::integrate::driver::Run;
use crate::integrate::{Method, Options, PlantError};
use crate::magnet::{Amplifier, Direct, Lagged};
use crate::mode::Mode;
use crate::params::{Change, ParamError, PlantParams, SpinParams, Start, StatorParams};
use crate::part::{Body, Part};
use crate::plane::race::Race;
use crate::plane::{Bore, Plane, Raceway};
use crate::readout::{Meters, Snapshot, Work};
use crate::spin::{Free, Held, Phased, Spin};
use crate::stator::{OneMass, Rigid, Stator, TwoMass};
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

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> Plant for Run<S, W, M, B, R> {
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
        <StateOf<S, W, M, R> as Part>::STATES
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
    let phased = params.rotor.eccentricity_m > 0.0;
    Ok(Parts {
        params,
        start,
        options,
        phased,
    }
    .with_stator())
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
    let phased = true;
    Ok(Parts {
        params,
        start,
        options,
        phased,
    }
    .with_stator())
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

/// What a plant is composed of, as data; each step turns one part into its type.
#[derive(Clone, Copy)]
struct Parts<'a> {
    params: &'a PlantParams,
    start: &'a Start,
    options: Options,
    /// Whether the angle of the rotor is followed also without an unbalance.
    phased: bool,
}

impl Parts<'_> {
    fn with_stator(self) -> Box<dyn Plant> {
        match &self.params.stator {
            StatorParams::Rigid => self.round(Rigid),
            // A ball bearing out of round is refused: no race to ask for.
            StatorParams::RigidEllipse(ellipse) => {
                let clearance_m = self.params.contact.clearance_m;
                self.with_spin(Rigid, Ellipse::new(ellipse, clearance_m))
            }
            StatorParams::OneMass(ring) => self.round(OneMass(*ring)),
            StatorParams::TwoMass { inner, outer } => {
                let (inner, outer) = (*inner, *outer);
                self.round(TwoMass { inner, outer })
            }
        }
    }

    fn round<S: Stator>(self, stator: S) -> Box<dyn Plant> {
        let Some(race) = &self.params.race else {
            return self.with_spin(stator, ());
        };
        let race = Race::new(self.params.bore_radius_m(), race);
        self.with_amplifier(stator, self.phased_spin(), self.plane((), race))
    }

    fn phased_spin(self) -> Phased {
        match self.params.spin {
            SpinParams::Held => Phased {
                inverse_inertia: 0.0,
                drive_torque_n_m: 0.0,
            },
            SpinParams::Free {
                inertia_kg_m2,
                drive_torque_n_m,
            } => Phased {
                inverse_inertia: 1.0 / inertia_kg_m2,
                drive_torque_n_m,
            },
        }
    }

    fn with_spin<S: Stator, B: Bore>(self, stator: S, bore: B) -> Box<dyn Plant> {
        let plane = self.plane(bore, ());
        match self.params.spin {
            SpinParams::Held => {
                let held = Held {
                    spin_rad_s: self.start.spin_rad_s,
                    phase_rad: self.start.spin_phase_rad,
                };
                self.with_amplifier(stator, held, plane)
            }
            SpinParams::Free { .. } if self.phased => {
                self.with_amplifier(stator, self.phased_spin(), plane)
            }
            SpinParams::Free {
                inertia_kg_m2,
                drive_torque_n_m,
            } => {
                let free = Free {
                    inertia_kg_m2,
                    drive_torque_n_m,
                };
                self.with_amplifier(stator, free, plane)
            }
        }
    }

    fn plane<B, R>(&self, bore: B, race: R) -> Plane<B, R> {
        Plane {
            radius_m: self.params.rotor.contact_radius_m,
            contact: self.params.contact,
            friction: self.params.friction,
            bore,
            race,
        }
    }

    fn with_amplifier<S: Stator, W: Spin, B: Bore, R: Raceway>(
        self,
        stator: S,
        spin: W,
        plane: Plane<B, R>,
    ) -> Box<dyn Plant> {
        match self.params.magnet {
            Some(magnet) if magnet.lag_s > 0.0 => {
                let lagged = Lagged {
                    lag_s: magnet.lag_s,
                };
                self.compose(stator, spin, plane, lagged)
            }
            _ => self.compose(stator, spin, plane, Direct),
        }
    }

    fn compose<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        self,
        stator: S,
        spin: W,
        plane: Plane<B, R>,
        amplifier: M,
    ) -> Box<dyn Plant> {
        let Self { params, start, .. } = self;
        let system = System {
            rotor: params.rotor,
            plane,
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
            race: plane.race.start(),
            force: M::State::default(),
        };
        let force_max_n = params.magnet.map_or(0.0, |m| m.force_max_n);
        Box::new(Run::new(system, state, force_max_n, self.options))
    }
}
