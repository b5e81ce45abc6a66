//! The only place that limits forces, and the last word on them.

use crate::act::law::ForceDemand;
use crate::border::coeffs::{Coeffs, FALL};
use crate::border::parts::THERMAL_BUDGET;
use crate::border::signal::Limits;
use crate::number::scalar::{Accumulator, Scalar};
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;
use crate::sense::reading::SampleFlags;

/// What a force may be at this tick \[caps\]: a disc, and a box of the axes that act.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ForceEnvelope<S> {
    /// Cap under the force–time budget, at most 1.
    pub(crate) cap: S,
    /// Cap of an axis that acts.
    axis: S,
    /// Whether the box can bind before the disc does.
    boxed: bool,
    axes: SampleFlags,
}

impl<S: Scalar> ForceEnvelope<S> {
    #[inline]
    pub(crate) fn new(budget: &Budget<S>, axes: SampleFlags, coeffs: &Coeffs<S>) -> Self {
        Self::below(budget.cap(coeffs), axes, coeffs)
    }

    /// The envelope under a cap of at most 1.
    #[inline]
    pub(crate) fn below(cap: S, axes: SampleFlags, coeffs: &Coeffs<S>) -> Self {
        Self {
            cap,
            axis: coeffs.axis_cap,
            boxed: axes.has_lost() || coeffs.axis_cap < cap,
            axes,
        }
    }

    /// Whether the budget leaves all of the cap.
    #[inline]
    pub(crate) fn is_whole(self) -> bool {
        self.cap >= S::ONE
    }

    /// Cap of x and of y, 0 for an axis that is lost.
    fn axes(self) -> [S; 2] {
        (self.axes.carried(Vec2::new(self.axis, self.axis))).to_array()
    }

    /// Whether a force is in the envelope; not if it is no number.
    #[inline]
    fn holds(self, force: Vec2<S>) -> bool {
        !force.exceeds(self.cap) && (!self.boxed || self.in_box(force))
    }

    fn in_box(self, force: Vec2<S>) -> bool {
        let [x, y] = self.axes();
        force.x.abs() <= x && force.y.abs() <= y
    }

    /// Largest s in [0, 1] with sum + s·part in the envelope, for a sum in it and a part that is too long; and
    /// whether the box says so. A hair inside, or rounding would have to be undone.
    #[inline]
    fn share(self, sum: Vec2<S>, part: Vec2<S>) -> (S, bool) {
        let cap = self.cap * S::JUST_BELOW_ONE;
        let disc = if sum == Vec2::ZERO {
            // Squares of a small cap would be nothing in fixed point.
            (cap * part.inverse_length()).min(S::ONE)
        } else {
            largest_share(cap, sum, part)
        };
        if !self.boxed {
            return (disc, false);
        }
        let axis = self.axis * S::JUST_BELOW_ONE;
        let box_share = axis_share(axis, sum.x, part.x).min(axis_share(axis, sum.y, part.y));
        (disc.min(box_share), box_share < disc)
    }
}

/// Gives the envelope to braking first, then damping, then restoring. Each is scaled, for its direction is
/// what it is good for. Once a part is cut nothing is left: what pointed back into the envelope would take from
/// what comes first.
#[inline]
pub(crate) fn allocate<S: Scalar>(
    demand: &ForceDemand<S>,
    envelope: ForceEnvelope<S>,
) -> (Vec2<S>, Limits) {
    if envelope.axes.has_lost() {
        return (on_what_is_left(demand, envelope), Limits::AXIS_CAP);
    }
    let (mut sum, mut part) = (Vec2::ZERO, demand.braking);
    // No law wants to brake with more than the whole cap, but for rounding.
    let whole_disc = !envelope.boxed && envelope.is_whole();
    if whole_disc || envelope.holds(part) {
        (sum, part) = (part, demand.damping);
        if envelope.holds(sum + part) {
            (sum, part) = (sum + part, demand.restoring);
            if envelope.holds(sum + part) {
                return (sum + part, Limits::empty());
            }
        }
    }
    let (share, by_box) = envelope.share(sum, part);
    let limits = match (by_box, envelope.cap < S::ONE) {
        (true, _) => Limits::AXIS_CAP,
        (false, false) => Limits::FORCE_CAP,
        (false, true) => Limits::FORCE_CAP.union(Limits::DERATED),
    };
    (sum + part * share, limits)
}

/// The same with one axis or none: all forces are along it.
///
/// A push across the aim cannot be made up for with one axis. So off the wall nothing brakes, for only damping
/// is sure not to drive the rotor into it; and on the wall nothing restores, which may lift the rotor
/// off without being able to catch it. There a force u takes A = f̂·u from the power of the motion (f̂ its aim): the whole of
/// the axis with the sign of f̂ would take most, but u = f̂·|f̂| is the whole along the aim, and across it next
/// to nothing.
#[inline]
fn on_what_is_left<S: Scalar>(demand: &ForceDemand<S>, envelope: ForceEnvelope<S>) -> Vec2<S> {
    let along = |lost: SampleFlags, aim: S, damping: S, restoring: S| {
        if envelope.axes.contains(lost) {
            return S::ZERO;
        }
        let cap = envelope.axis.min(envelope.cap);
        let (first, last) = if demand.touching {
            (aim * aim.abs(), S::ZERO)
        } else {
            (S::ZERO, restoring)
        };
        let sum = (first.within(cap) + damping).within(cap);
        (sum + last).within(cap)
    };
    let d = demand;
    Vec2::new(
        along(SampleFlags::X_LOST, d.braking.x, d.damping.x, d.restoring.x),
        along(SampleFlags::Y_LOST, d.braking.y, d.damping.y, d.restoring.y),
    )
}

/// Largest s in [0, 1] with |sum + s·part| ≤ cap, for |sum| ≤ cap and a part that is not nothing.
#[inline]
fn largest_share<S: Scalar>(cap: S, sum: Vec2<S>, part: Vec2<S>) -> S {
    let along = sum.dot(part);
    let room = (cap * cap - sum.length_squared()).max(S::ZERO);
    let root = (along * along + part.length_squared() * room).sqrt();
    // The solution of the quadratic equation whose terms do not cancel.
    let share = if along > S::ZERO {
        room.div(root + along)
    } else {
        (root - along).div(part.length_squared())
    };
    share.clamp(S::ZERO, S::ONE)
}

/// Largest s in [0, 1] with |sum + s·part| ≤ cap on one axis.
fn axis_share<S: Scalar>(cap: S, sum: S, part: S) -> S {
    let (sum, part) = if part < S::ZERO {
        (-sum, -part)
    } else {
        (sum, part)
    };
    let room = (cap - sum).max(S::ZERO);
    // Also without a division by nothing where there is nothing to do.
    if part <= room { S::ONE } else { room.div(part) }
}

/// A force within the envelope, and what had to be done to it: the last word on every force.
#[inline]
pub(crate) fn within<S: Scalar>(force: Vec2<S>, envelope: ForceEnvelope<S>) -> (Vec2<S>, Limits) {
    if envelope.holds(force) {
        (force, Limits::empty())
    } else {
        scaled_into(force, envelope)
    }
}

/// The same for a command of the levitation controller.
#[inline]
pub(crate) fn levitation<S: Scalar>(
    command: Vec2<S>,
    envelope: ForceEnvelope<S>,
) -> (Vec2<S>, Limits) {
    if envelope.holds(command) {
        (command, Limits::empty())
    } else {
        clamped(command, envelope)
    }
}

#[cold]
#[inline(never)]
fn clamped<S: Scalar>(command: Vec2<S>, envelope: ForceEnvelope<S>) -> (Vec2<S>, Limits) {
    let (force, bound) = scaled_into(command, envelope);
    // That it was no number, or more than the whole cap, is what clamping says already.
    let redundant = Limits::FORCE_CAP | Limits::NOT_FINITE;
    (force, Limits::LEVITATION_CLAMPED | (bound - redundant))
}

/// A force that does not fit, in its direction but for an axis that is lost, or has no number: that one takes nothing
/// away from the other.
#[cold]
#[inline(never)]
fn scaled_into<S: Scalar>(force: Vec2<S>, envelope: ForceEnvelope<S>) -> (Vec2<S>, Limits) {
    let mut limits = Limits::empty();
    let number = force.map(|x| if x.is_finite() { x } else { S::ZERO });
    if number != force {
        limits |= Limits::NOT_FINITE;
    }
    let mut v = envelope.axes.carried(number);
    if v != number {
        limits |= Limits::AXIS_CAP;
    }
    let largest = |v: Vec2<S>| v.x.abs().max(v.y.abs());
    if v.exceeds(envelope.cap) {
        let most = largest(v);
        if most > S::ONE {
            // However long it is: its square has to be a number, too.
            v = v * S::ONE.div(most);
        }
        v = v * v.inverse_length() * (envelope.cap * S::JUST_BELOW_ONE);
        limits |= Limits::FORCE_CAP;
        if envelope.cap < S::ONE {
            limits |= Limits::DERATED;
        }
    }
    let most = largest(v);
    if most > envelope.axis {
        v = v * (envelope.axis * S::JUST_BELOW_ONE).div(most);
        limits |= Limits::AXIS_CAP;
    }
    (v, limits)
}

/// A force within the caps, no farther from `last` than the slew limit. Where the budget has lowered the
/// cap faster than that, the slew limit holds.
#[inline]
pub(crate) fn slewed<S: Scalar>(
    target: Vec2<S>,
    last: Vec2<S>,
    coeffs: &Coeffs<S>,
) -> (Vec2<S>, Limits) {
    let change = target - last;
    if !change.exceeds(coeffs.slew_step) {
        return (target, Limits::empty());
    }
    (one_step(last, change, coeffs), Limits::SLEW)
}

/// A step of the slew limit's length.
#[inline(never)]
fn one_step<S: Scalar>(last: Vec2<S>, change: Vec2<S>, coeffs: &Coeffs<S>) -> Vec2<S> {
    let force = last + change * change.inverse_length() * coeffs.slew_step;
    // Both ends are within the caps; rounding may have left them between. The way inwards makes no step longer.
    let axis = coeffs.axis_cap;
    let force = force.map(|x| x.within(axis));
    if force.exceeds(S::ONE) {
        force * S::JUST_BELOW_ONE
    } else {
        force
    }
}

/// Force–time budget: a first-order thermal state of the force squared.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Budget<S: Scalar> {
    state: S::Accumulator,
}

words_of_fields!(Budget<S> { state });

impl<S: Scalar> Budget<S> {
    /// Cap now \[caps\].
    #[inline]
    pub(crate) fn cap(&self, coeffs: &Coeffs<S>) -> S {
        match coeffs.budget.continuous {
            Some(continuous) if THERMAL_BUDGET => derated(self.state.value(), continuous),
            _ => S::ONE,
        }
    }

    /// Some ticks, few against the thermal time, with this force \[caps\].
    #[inline]
    pub(crate) fn spend(&mut self, ticks: S, force: Vec2<S>, coeffs: &Coeffs<S>) {
        if THERMAL_BUDGET && coeffs.budget.continuous.is_some() {
            let way = force.length_squared() - self.state.value();
            self.state.add(way * ticks, coeffs.budget.thermal_rate);
        }
    }

    /// The state \[caps²\].
    #[inline]
    pub(crate) fn state(&self) -> S {
        self.state.value()
    }

    /// After a change of the unit of force.
    pub(crate) fn rescale(&mut self, force: f32) {
        self.state = self.state.scaled(force * force);
    }
}

/// The cap \[caps\] in a thermal state, for a force that is borne for ever: a function of the state alone, so that it comes back
/// as it fell. On its own: within the tick it costs more stack than the call.
#[inline(never)]
pub(crate) fn derated<S: Scalar>(state: S, continuous: S) -> S {
    let square = continuous * continuous;
    let over = state - square;
    if over <= S::ZERO {
        return S::ONE;
    }
    let x = over.div(square * S::from_f32(FALL)).min(S::ONE);
    // So written it ends at the continuous force however small that is.
    let three = S::from_f32(3.0) - (x + x);
    continuous + (S::ONE - continuous) * (S::ONE - x * x * three)
}
