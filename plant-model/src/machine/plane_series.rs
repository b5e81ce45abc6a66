//! Series of what happens in one plane.

use super::system::{MachineSystem, PlaneData};
use crate::V2;
use crate::params::ContactLaw;
use crate::series::{Scalar, Series};

/// What a plane does over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum State {
    #[default]
    Inside,
    Beyond,
    Touched,
}

/// How friction acts in a plane over a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Grip {
    /// Sliding and rolling part over the normal force, where they are in proportion to it.
    pub(crate) sliding: f64,
    pub(crate) rolling: f64,
    /// Whether some part holds a speed.
    pub(super) holds: bool,
    /// Whether the surfaces' speeds change.
    pub(crate) turns: bool,
}

impl Grip {
    /// Of a plane without friction in proportion to the normal force, and none that holds.
    pub(crate) fn none(system: &MachineSystem, plane: usize) -> Self {
        Self {
            turns: system.turns(plane),
            ..Self::default()
        }
    }
}

/// Series of one plane.
#[derive(Debug, Clone, Default)]
pub(crate) struct PlaneSeries {
    pub(super) state: State,
    pub(crate) grip: Grip,
    /// u, rotor against ring, and its rate w.
    pub(crate) gap: Series,
    pub(crate) gap_rate: Series,
    /// ρ.
    pub(crate) distance: Scalar,
    /// f_n, and κ.
    pub(crate) force: Scalar,
    pub(crate) normal_n_m: Scalar,
    /// What falls through zero where contact of a law that is not linear ends; of collocation alone.
    pub(crate) lift: Scalar,
    /// Parts of τ, and the sum of those that hold.
    pub(crate) sliding_n_m: Scalar,
    pub(crate) rolling_n_m: Scalar,
    pub(super) held_n_m: Scalar,
    /// Ω_i.
    pub(crate) race: Scalar,
    /// Of the order at hand: force on the rotor, and sliding friction.
    pub(super) reaction: V2,
    pub(super) torque_n: f64,
    /// 1/ρ at the start.
    pub(super) per_m: f64,
    /// Slopes of the contact law; of one that is not linear those a moment from now, and what is between them and the force.
    pub(super) by_depth_n_m: f64,
    pub(super) by_rate_n_s_m: f64,
    pub(super) offset_n: f64,
}

impl PlaneSeries {
    /// What is positive while contact lasts.
    pub(crate) fn lift(&self, data: &PlaneData) -> &Scalar {
        match data.law {
            ContactLaw::Linear(_) => &self.force,
            ContactLaw::HuntCrossley(_) => &self.lift,
        }
    }
}
