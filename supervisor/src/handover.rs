//! Blend between the supervisor's force and the levitation controller's, and the hint for the
//! controller's integrator.

use crate::coeffs::Coeffs;
use crate::phase::Phase;
use crate::signal::IntegratorHint;
use crate::vec2::Vec2;

/// Force of this tick \[caps\]: the phase decides whose it is. `last` is the force of the tick before.
pub(crate) fn blend(
    phase: Phase,
    own: Vec2,
    levitation: Vec2,
    last: Vec2,
    coeffs: &Coeffs,
) -> Vec2 {
    match phase {
        Phase::Levitated => levitation,
        Phase::Handover { weight } => own * (1.0 - weight) + levitation * weight,
        // The last force already carries the last weight: their ratio makes the fall linear.
        Phase::SensorFault { weight } if weight > 0.0 => {
            last * (weight / (weight + coeffs.fault_step))
        }
        Phase::SensorFault { .. } => Vec2::ZERO,
        _ => own,
    }
}

/// While the supervisor acts the controller does not have the bearing and must not integrate; what it
/// integrated before the contact is forgotten when it gets the bearing back.
pub(crate) fn integrator_hint(before: Phase, now: Phase) -> IntegratorHint {
    match (before, now) {
        (Phase::Handover { .. }, Phase::Handover { .. }) => IntegratorHint::Run,
        (_, Phase::Handover { .. }) => IntegratorHint::Reset,
        (_, Phase::Levitated) => IntegratorHint::Run,
        _ => IntegratorHint::Hold,
    }
}
