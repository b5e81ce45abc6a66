//! Many runs of a point mass in a rigid bore, several at a time.
//!
//! What [`crate::build`] integrates one by one is done here in groups: runs in the same mode take their steps side by side in
//! the vector registers of the machine. It knows held spin, unbalance, linear contact and constant friction in a rigid, round
//! bore ([`LaneParams::of`]); and what it cannot decide for certain it gives up ([`Ending::GaveUp`]), for the integrator that
//! knows everything. The same bits on every machine, however many runs there are and in whatever order.
//!
//! Files, each importing only from those above it: `number`, `roots`, `group`, `step`, `flight`, `contact`, `kernel`, `slot`, `pool`.

mod contact;
mod flight;
mod group;
mod kernel;
mod number;
mod pool;
mod roots;
mod slot;
mod step;

use crate::V2;
use crate::params::{ContactLaw, PlantParams, SlidingFriction, SpinParams, Start, StatorParams};
use pool::Pool;
use pulp::Arch;

/// A point mass in a rigid bore, as far as lanes know it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneParams {
    mass_kg: f64,
    stiffness_n_m: f64,
    damping_n_s_m: f64,
    eccentricity_m: f64,
    radius_m: f64,
    clearance_m: f64,
    contact_stiffness_n_m: f64,
    contact_damping_n_s_m: f64,
    friction: f64,
}

impl LaneParams {
    /// Those of a plant, `None` where it has something that lanes do not know: a stator that moves or is not round, spin that
    /// is not held, a magnet, a race, rolling friction or friction that falls with speed, contact that is not linear or is
    /// overdamped, a negative stiffness; and where a value is out of range.
    pub fn of(params: &PlantParams) -> Option<Self> {
        let PlantParams {
            rotor,
            spin: SpinParams::Held,
            stator: StatorParams::Rigid,
            contact,
            friction,
            magnet: None,
            race: None,
        } = params
        else {
            return None;
        };
        let (ContactLaw::Linear(law), SlidingFriction::Constant { coefficient }) =
            (&contact.law, &friction.sliding)
        else {
            return None;
        };
        let spring_n_s_m = (law.stiffness_n_m * rotor.mass_kg).sqrt();
        let known = params.validate().is_ok()
            && friction.rolling_coefficient == 0.0
            && rotor.stiffness_n_m >= 0.0
            && rotor.damping_n_s_m >= 0.0
            && law.damping_n_s_m <= 4.0 * spring_n_s_m;
        known.then_some(Self {
            mass_kg: rotor.mass_kg,
            stiffness_n_m: rotor.stiffness_n_m,
            damping_n_s_m: rotor.damping_n_s_m,
            eccentricity_m: rotor.eccentricity_m,
            radius_m: rotor.contact_radius_m,
            clearance_m: contact.clearance_m,
            contact_stiffness_n_m: law.stiffness_n_m,
            contact_damping_n_s_m: law.damping_n_s_m,
            friction: *coefficient,
        })
    }
}

/// A run to be done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Launch {
    params: LaneParams,
    start: Start,
    until_s: f64,
    threshold_m_s: f64,
    whirl_m_s: f64,
    until_free: bool,
}

impl Launch {
    /// A run from a start to a time \[s\]. `None` for a start that is not finite or beyond the wall, and for no time.
    pub fn new(params: LaneParams, start: &Start, until_s: f64) -> Option<Self> {
        let inside = start.position_m.norm() <= params.clearance_m * (1.0 + 1e-12);
        let sound = start.validate().is_ok() && until_s > 0.0 && until_s.is_finite();
        (inside && sound).then_some(Self {
            params,
            start: *start,
            until_s,
            threshold_m_s: f64::INFINITY,
            whirl_m_s: f64::INFINITY,
            until_free: false,
        })
    }

    /// The same until it is decided: by a backward speed in contact that is whirl, or when the rotor can never touch again.
    /// Impacts are counted up to a threshold \[m/s\].
    pub(crate) fn until_decided(self, threshold_m_s: f64, whirl_m_s: f64) -> Self {
        Self {
            threshold_m_s,
            whirl_m_s,
            until_free: true,
            ..self
        }
    }
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Its time is over.
    Time,
    /// It whirls.
    Whirl,
    /// It never touches again.
    Free,
    /// It is not for lanes to decide.
    GaveUp,
}

/// A run that has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ended {
    /// Why.
    pub ending: Ending,
    /// When \[s\].
    pub t_s: f64,
    /// Where \[m\].
    pub position_m: V2,
    /// How fast \[m/s\].
    pub velocity_m_s: V2,
    /// Whether it touched then.
    pub in_contact: bool,
    /// Touches.
    pub impacts: u32,
    /// Touches until the backward speed first passed the threshold, that one included.
    pub impacts_to_threshold: Option<u32>,
    /// Changes of mode.
    pub events: u32,
    /// Steps taken.
    pub steps: u64,
}

/// Runs everything to a tolerance from 1e-14 to 1e-2, on this thread. Each run that has ended goes to `next`, which may name one
/// that takes its place.
pub fn run<T>(
    rtol: f64,
    waiting: impl Iterator<Item = (Launch, T)>,
    next: impl FnMut(T, Ended) -> Option<(Launch, T)>,
) {
    Pool::new(Arch::new(), rtol).run(waiting, next);
}

#[cfg(test)]
mod tests;
