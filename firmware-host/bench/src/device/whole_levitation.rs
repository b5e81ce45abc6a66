//! A levitation controller that sees all sensors and drives all magnets.

use crate::device::biquads::{Biquads, BiquadsParams};
use crate::device::external::{ControllerError, External, ExternalParams};
use crate::device::modal_levitation::{ModalLevitation, ModalLevitationParams};
use crate::device::sensor::Reading;
use crate::device::state_space::{StateSpace, StateSpaceParams};
use plant_model::V2;

/// Which, and its numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum WholeLevitationParams {
    /// By rigid mode.
    Modal(ModalLevitationParams),
    /// The user's matrices.
    StateSpace(StateSpaceParams),
    /// The user's filters, of each plane that has a magnet.
    Biquads(Vec<Option<BiquadsParams>>),
    /// The user's program.
    External(ExternalParams),
}

impl WholeLevitationParams {
    /// What it is, for people.
    pub fn described(&self) -> String {
        match self {
            Self::Modal(_) => "by mode".to_owned(),
            Self::StateSpace(own) => format!("a state space with {} states", own.a.nrows()),
            Self::Biquads(planes) => {
                let axes = planes.iter().flatten().flat_map(|plane| &plane.sections);
                let most = axes.map(Vec::len).max().unwrap_or_default();
                format!("chains of {most} biquads at most")
            }
            Self::External(own) => own.named.clone(),
        }
    }
}

/// The controller.
#[derive(Debug)]
pub(crate) enum WholeLevitation {
    /// By rigid mode.
    Modal(ModalLevitation),
    /// The user's matrices.
    StateSpace(StateSpace),
    /// The user's filters.
    Biquads(Biquads),
    /// The user's program.
    External(External),
}

/// What holds for a sample, whatever the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AtSample {
    /// Time \[s\].
    pub t_s: f64,
    /// Spin as reported \[rad/s\].
    pub spin_rad_s: f64,
    /// Integrators are to stand.
    pub hold: bool,
}

impl WholeLevitation {
    /// A controller at rest.
    ///
    /// # Errors
    /// [`ControllerError`] of a program that does not start.
    pub(crate) fn new(
        params: &WholeLevitationParams,
        period_s: f64,
    ) -> Result<Self, ControllerError> {
        Ok(match params {
            WholeLevitationParams::Modal(params) => {
                Self::Modal(ModalLevitation::new(params, period_s))
            }
            WholeLevitationParams::StateSpace(params) => {
                Self::StateSpace(StateSpace::new(params.clone()))
            }
            WholeLevitationParams::Biquads(params) => Self::Biquads(Biquads::new(params)),
            WholeLevitationParams::External(params) => Self::External(External::start(params)?),
        })
    }

    /// Forces of the stations \[N\] for what their sensors measure, each within its cap. Which of their states are integrators
    /// state spaces and biquads do not say, and run on where they are to stand.
    ///
    /// # Errors
    /// [`ControllerError`] of a program.
    pub(crate) fn forces_n(
        &mut self,
        readings: impl Iterator<Item = Reading>,
        at: AtSample,
        forces_n: &mut [V2],
    ) -> Result<(), ControllerError> {
        let measured_m = |reading: Reading| reading.position_m;
        match self {
            Self::Modal(modal) => {
                modal.forces_n(readings.map(measured_m), at.spin_rad_s, at.hold, forces_n);
            }
            Self::StateSpace(own) => own.forces_n(readings.map(measured_m), forces_n),
            Self::Biquads(own) => own.forces_n(readings.map(measured_m), forces_n),
            Self::External(own) => {
                let measured = readings.map(|reading| (reading.sequence, reading.position_m));
                own.forces_n(measured, (at.t_s, at.spin_rad_s, at.hold), forces_n)?;
            }
        }
        Ok(())
    }

    /// Ends the controller.
    ///
    /// # Errors
    /// [`ControllerError`] of a program that does not end.
    pub(crate) fn close(self) -> Result<(), ControllerError> {
        match self {
            Self::External(own) => own.close(),
            Self::Modal(_) | Self::StateSpace(_) | Self::Biquads(_) => Ok(()),
        }
    }
}
