//! A levitation controller that sees all sensors and drives all magnets.

use crate::device::modal_levitation::{ModalLevitation, ModalLevitationParams};
use crate::device::state_space::{StateSpace, StateSpaceParams};
use plant_model::V2;

/// Which, and its numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum WholeLevitationParams {
    /// By rigid mode.
    Modal(ModalLevitationParams),
    /// The user's.
    StateSpace(StateSpaceParams),
}

/// The controller.
#[derive(Debug, Clone)]
pub enum WholeLevitation {
    /// By rigid mode.
    Modal(ModalLevitation),
    /// The user's.
    StateSpace(StateSpace),
}

impl WholeLevitation {
    /// A controller at rest.
    pub fn new(params: &WholeLevitationParams, period_s: f64) -> Self {
        match params {
            WholeLevitationParams::Modal(params) => {
                Self::Modal(ModalLevitation::new(params, period_s))
            }
            WholeLevitationParams::StateSpace(params) => {
                Self::StateSpace(StateSpace::new(params.clone()))
            }
        }
    }

    /// Forces of the stations \[N\] for what their sensors measure \[m\], each within its cap. `hold`: integrators are to stand;
    /// which of its states are such a state space does not say, and runs on.
    pub fn forces_n(
        &mut self,
        measured_m: impl Iterator<Item = V2>,
        spin_rad_s: f64,
        hold: bool,
        forces_n: &mut [V2],
    ) {
        match self {
            Self::Modal(modal) => modal.forces_n(measured_m, spin_rad_s, hold, forces_n),
            Self::StateSpace(state_space) => state_space.forces_n(measured_m, forces_n),
        }
    }
}
