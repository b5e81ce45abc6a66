//! Blend between the supervisor's force and the levitation controller's, and the hint for the
//! controller's integrator.

use crate::act::limit::ForceEnvelope;
use crate::border::coeffs::Coeffs;
use crate::border::signal::IntegratorHint;
use crate::decide::phase::Phase;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::SampleFlags;

/// In a fault of the sensor: along a coordinate that is bad the last force fades, so fast that a whole cap would be gone in
/// the time of the fading; along one that is good the levitation controller acts, and goes first. A levitated rotor loses the
/// force no slower than in a hand-over: held, it would push it out to the wall. So does one of which a coordinate is known.
#[cold]
#[inline(never)]
pub(crate) fn faded<S: Scalar>(
    bouncing: bool,
    last: Vec2<S>,
    levitation: Vec2<S>,
    flags: SampleFlags,
    envelope: ForceEnvelope<S>,
    coeffs: &Coeffs<S>,
) -> Vec2<S> {
    let step = if bouncing && flags.contains(SampleFlags::BOTH_BAD) {
        coeffs.fault_step
    } else {
        coeffs.fault_step.max(coeffs.blend_step)
    };
    // What the other coordinate is sure to leave of the cap.
    let most = (envelope.cap - levitation.x.abs() - levitation.y.abs()).max(S::ZERO);
    let left = last.map(|force| (force - force.within(step)).within(most));
    flags.sensed(levitation, left)
}

/// Whether the levitation controller would hold the rotor as well as the supervisor does.
///
/// It may be calm only because the supervisor carries a load, or holds it against a controller whose integrator still carries one that
/// is gone: such a controller would drop the rotor, or throw it. It gets the bearing when it asks for as much.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Readiness<S> {
    /// Inward force that the controller asks for less than the supervisor, filtered \[caps\].
    shortfall: S,
    /// The same when waiting for it began.
    mark: S,
}

words_of_fields!(Readiness<S> { shortfall, mark });

/// Shortfall that the blend can cover \[caps\].
const COVERED: f32 = 0.06;
/// By how much it has to fall while it is waited for.
const NEARER: f32 = 0.03;
/// From this radius on all of a shortfall counts. In the middle nothing has to be held, and what is outward there is
/// noise, which the supervisor's force follows: a soft controller behind it would never seem ready.
const COUNTS_FROM: f32 = 0.1;
/// Farthest place, for a shortfall of so many caps or more, where the rotor is held for the controller to take its integral back.
const RESTS_WITHIN: f32 = 0.3;

impl<S: Scalar> Readiness<S> {
    #[inline]
    pub(crate) fn ready(&self) -> bool {
        self.shortfall < S::from_f32(COVERED)
    }

    /// Whether the controller has come nearer since it was asked last. One that has not wants something else.
    #[inline]
    pub(crate) fn comes_nearer(&mut self) -> bool {
        let before = core::mem::replace(&mut self.mark, self.shortfall);
        before <= S::ZERO || self.shortfall < before - S::from_f32(NEARER)
    }

    /// Where the rotor, in calm, is held under a controller that itself pushes it there: near where the controller would hold it, so
    /// that its integrator sees the deviation which it has to see.
    #[inline]
    pub(crate) fn rests_at(&self, levitation: Vec2<S>, outward: Vec2<S>) -> Vec2<S> {
        if levitation.dot(outward) * self.shortfall <= S::ZERO {
            return Vec2::ZERO;
        }
        outward * self.shortfall.within(S::from_f32(RESTS_WITHIN))
    }

    /// Takes in what a controller that has the bearing asks for, outwards on the wall and nothing off it, of a rotor that touches most
    /// of the time: whether it presses it there by itself.
    #[cold]
    pub(crate) fn watch(&mut self, outwards: S, coeffs: &Coeffs<S>) {
        self.shortfall = self.shortfall + (outwards - self.shortfall) * coeffs.blend_step;
        self.mark = S::ZERO;
    }

    /// Whether it does, of a rotor that is not held.
    #[inline]
    pub(crate) fn is_pressed(&self) -> bool {
        self.shortfall > S::from_f32(COVERED)
    }

    /// After a change of the unit of force.
    pub(crate) fn rescale(&mut self, force: S) {
        self.shortfall = self.shortfall * force;
        self.mark = self.mark * force;
    }

    /// Compares the forces of this tick along the outward direction at a radius.
    #[inline]
    pub(crate) fn compare(
        &mut self,
        own: Vec2<S>,
        levitation: Vec2<S>,
        outward: Vec2<S>,
        radius: S,
        coeffs: &Coeffs<S>,
    ) {
        let share = (radius * S::from_f32(1.0 / COUNTS_FROM)).min(S::ONE);
        let short = (levitation - own).dot(outward) * share;
        self.shortfall = self.shortfall + (short - self.shortfall) * coeffs.blend_step;
    }
}

/// While the supervisor acts, or the bearing is off, the controller does not have the bearing and must
/// not integrate. Once contact could be avoided it may, so that it becomes ready, and where that undoes what it holds.
#[inline]
pub(crate) fn integrator_hint<S: Scalar>(
    phase: Phase<S>,
    bearing_on: bool,
    undoes: impl FnOnce() -> bool,
) -> IntegratorHint {
    let runs = bearing_on
        && match phase {
            Phase::Levitated | Phase::HandedBack { .. } | Phase::Handover { .. } => true,
            Phase::Approach { .. } | Phase::Bounce { .. } => undoes(),
            _ => false,
        };
    if runs {
        IntegratorHint::Run
    } else {
        IntegratorHint::Hold
    }
}
