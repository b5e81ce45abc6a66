//! The only place that limits forces, and the last word on them.

use crate::coeffs::Coeffs;
use crate::guard::Actuator;
use crate::law::Wanted;
use crate::math::{Sum, between, max, min, sqrt};
use crate::signal::Limits;
use crate::vec2::Vec2;

/// Room for the force of this tick \[caps\]: a disc, and a box of the axes that act.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room {
    /// Cap under the force–time budget, at most 1.
    pub(crate) cap: f32,
    /// Cap of x and of y, 0 for an axis that is lost.
    axes: [f32; 2],
    /// Whether the box can bind before the disc does.
    boxed: bool,
    /// The same in newtons.
    cap_n: f32,
    axes_n: [f32; 2],
}

impl Room {
    pub(crate) fn new(budget: &Budget, actuator: Actuator, coeffs: &Coeffs) -> Self {
        let of = |cap: f32| actuator.acts.map(|acts| if acts { cap } else { 0.0 });
        let cap = budget.cap(coeffs);
        let axes = of(coeffs.axis_cap);
        let [x, y] = axes;
        Self {
            cap,
            axes,
            boxed: min(x, y) < cap,
            cap_n: cap * coeffs.force_max_n,
            axes_n: of(coeffs.axis_cap_n),
        }
    }

    fn lost(&self) -> bool {
        self.axes.contains(&0.0)
    }

    /// A braking force that cannot have an axis at all, as the other can do it.
    ///
    /// A force takes A = f̂·u from the power of the motion (f̂ its aim). The whole of the other axis with
    /// the sign of f̂ would take most, but it also pushes across the aim, off the wall or into it, which
    /// nothing can make up for. With u = f̂·|f̂| it is the whole along the aim, and across it next to nothing.
    fn braking(&self, aim: Vec2) -> Vec2 {
        let on = |part: f32, cap: f32| {
            if cap > 0.0 {
                part * max(part, -part)
            } else {
                0.0
            }
        };
        let [x, y] = self.axes;
        Vec2::new(on(aim.x, x), on(aim.y, y))
    }

    /// Largest s in [0, 1] with sum + s·part in the room, for a sum in it and a part that is not nothing; and whether the box says so.
    #[inline(never)]
    fn share(&self, sum: Vec2, part: Vec2) -> (f32, bool) {
        let disc = largest_share(self.cap, sum, part);
        if !self.boxed {
            return (disc, false);
        }
        let [x, y] = self.axes;
        let box_share = min(axis_share(x, sum.x, part.x), axis_share(y, sum.y, part.y));
        (min(disc, box_share), box_share < disc)
    }

    /// The rest of a part along the axis that still has room.
    #[cold]
    fn along_edge(&self, sum: Vec2, rest: Vec2) -> Vec2 {
        let [x, y] = self.axes;
        let on = |cap: f32, sum: f32, rest: f32| {
            if axis_share(cap, sum, rest) < ON_EDGE {
                0.0
            } else {
                rest
            }
        };
        Vec2::new(on(x, sum.x, rest.x), on(y, sum.y, rest.y))
    }
}

/// Share of a part for which an axis counts as used up: what rounding leaves.
const ON_EDGE: f32 = 1e-4;

/// Square of a force that is as good as none \[caps²\].
const NO_FORCE: f32 = 1e-12;

/// Gives the room to braking first, then damping, then restoring. Each is scaled, for its direction is
/// what it is good for; where braking has all it wants, the others may also use what is left of an axis
/// alone, for each of their components does what the whole does.
pub(crate) fn allocate(wanted: &Wanted, room: &Room) -> (Vec2, Limits) {
    let mut limits = Limits::empty();
    let mut sum = Vec2::ZERO;
    if room.lost() {
        limits |= Limits::AXIS_CAP;
    }
    let mut braking_cut = false;
    // With one axis alone a push across the aim cannot be made up for: off the wall only damping is sure not
    // to drive the rotor into it, and on the wall nothing may lift it off that could not catch it.
    let (braking, restoring) = match (room.lost(), wanted.touching) {
        (false, _) => (wanted.braking, wanted.restoring),
        (true, true) => (room.braking(wanted.braking), Vec2::ZERO),
        (true, false) => (Vec2::ZERO, wanted.restoring),
    };
    for part in [braking, wanted.damping, restoring] {
        if part.length_squared() <= NO_FORCE {
            continue;
        }
        let (share, by_box) = room.share(sum, part);
        sum = sum + part * share;
        if share < 1.0 {
            limits |= if by_box {
                Limits::AXIS_CAP
            } else if room.cap < 1.0 {
                Limits::FORCE_CAP | Limits::DERATED
            } else {
                Limits::FORCE_CAP
            };
        }
        if part == braking {
            braking_cut = share < 1.0;
        } else if by_box && !braking_cut {
            let rest = room.along_edge(sum, part * (1.0 - share));
            if rest.length_squared() > NO_FORCE {
                sum = sum + rest * room.share(sum, rest).0;
            }
        }
    }
    (sum, limits)
}

/// Largest s in [0, 1] with |sum + s·part| ≤ cap, for |sum| ≤ cap and a part that is not nothing.
fn largest_share(cap: f32, sum: Vec2, part: Vec2) -> f32 {
    let square = part.length_squared();
    let along = sum.dot(part);
    let room = max(cap * cap - sum.length_squared(), 0.0);
    between(
        (sqrt(along * along + square * room) - along) / square,
        0.0,
        1.0,
    )
}

/// Largest s in [0, 1] with |sum + s·part| ≤ cap on one axis.
fn axis_share(cap: f32, sum: f32, part: f32) -> f32 {
    let (sum, part) = if part < 0.0 {
        (-sum, -part)
    } else {
        (sum, part)
    };
    let room = max(cap - sum, 0.0);
    // Also without a division by nothing where there is nothing to do.
    if part <= room { 1.0 } else { room / part }
}

/// A levitation command within finite bounds \[N\], and whether it had to be changed.
pub(crate) fn levitation(command_n: [f32; 2], room: &Room, coeffs: &Coeffs) -> ([f32; 2], Limits) {
    let v = Vec2::from_array(command_n);
    let (number, mut limits) = if v.length_squared() < SQUARE_FITS {
        (v, Limits::empty())
    } else {
        // No number, or so large that its square is none.
        let cap = coeffs.force_max_n;
        let on = |x: f32| {
            if x.is_finite() {
                between(x, -cap, cap)
            } else {
                0.0
            }
        };
        (Vec2::new(on(v.x), on(v.y)), Limits::LEVITATION_CLAMPED)
    };
    let (limited, bound) = within_caps(number, room);
    if !bound.is_empty() {
        // That the whole cap was too small is what clamping says already.
        limits |= Limits::LEVITATION_CLAMPED | (bound - Limits::FORCE_CAP);
    }
    (limited.to_array(), limits)
}

/// Squares below this are far from overflow.
const SQUARE_FITS: f32 = 1e30;
/// A few units in the last place below a limit, so that rounding cannot lift a scaled force above it.
const JUST_BELOW: f32 = 1.0 - 4.0 * f32::EPSILON;

/// A finite force \[N\] scaled into the room; untouched where it fits.
#[inline]
fn within_caps(force: Vec2, room: &Room) -> (Vec2, Limits) {
    let [x, y] = room.axes_n;
    let fits = force.length_squared() <= room.cap_n * room.cap_n
        && force.x <= x
        && -force.x <= x
        && force.y <= y
        && -force.y <= y;
    if fits {
        (force, Limits::empty())
    } else {
        scaled(force, room)
    }
}

/// A force that does not fit, in its direction but for an axis that is lost: that one takes nothing
/// away from the other.
#[cold]
fn scaled(force: Vec2, room: &Room) -> (Vec2, Limits) {
    let mut limits = Limits::empty();
    let [x, y] = room.axes_n;
    let on = |cap: f32, v: f32| if cap > 0.0 { v } else { 0.0 };
    let mut v = Vec2::new(on(x, force.x), on(y, force.y));
    if v != force {
        limits |= Limits::AXIS_CAP;
    }
    let square = v.length_squared();
    if square > room.cap_n * room.cap_n {
        v = v * (room.cap_n * JUST_BELOW / sqrt(square));
        limits |= Limits::FORCE_CAP;
        if room.cap < 1.0 {
            limits |= Limits::DERATED;
        }
    }
    let largest = max(max(v.x, -v.x), max(v.y, -v.y));
    let cap = max(x, y);
    if largest > cap {
        v = v * (cap * JUST_BELOW / largest);
        limits |= Limits::AXIS_CAP;
    }
    (v, limits)
}

/// The last word on a force of the supervisor's own \[N\]: finite, within the caps, and not farther from
/// `last` than the slew limit, whatever came before.
pub(crate) fn final_force_n(
    force_n: [f32; 2],
    last: Vec2,
    room: &Room,
    coeffs: &Coeffs,
) -> ([f32; 2], Limits) {
    let wanted = Vec2::from_array(force_n);
    let (target, limits) = if wanted.length_squared() < SQUARE_FITS {
        within_caps(wanted, room)
    } else {
        (Vec2::ZERO, Limits::NOT_FINITE)
    };
    let (force_n, slew) = slewed(target.to_array(), last, coeffs);
    (force_n, limits | slew)
}

/// A force within the caps \[N\], no farther from `last` than the slew limit. Where the budget has
/// lowered the cap faster than that, the slew limit holds.
#[inline]
pub(crate) fn slewed(target_n: [f32; 2], last: Vec2, coeffs: &Coeffs) -> ([f32; 2], Limits) {
    let change = Vec2::from_array(target_n) - last;
    let square = change.length_squared();
    let step = coeffs.slew_step_n;
    if square <= step * step {
        return (target_n, Limits::empty());
    }
    if square.is_nan() || square >= SQUARE_FITS {
        return ([0.0; 2], Limits::NOT_FINITE);
    }
    let force = last + change * (step * JUST_BELOW / sqrt(square));
    (force.to_array(), Limits::SLEW)
}

/// Force–time budget: a first-order thermal state of (force/continuous force)².
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Budget {
    state: Sum,
}

/// The cap falls from full to continuous while the state goes from 1 to this much more. The force at
/// which it comes to rest exceeds the continuous one by less than half as much.
const FALL: f32 = 0.1;

impl Budget {
    /// Cap now \[caps\]: a function of the state alone, so that it comes back as it fell.
    pub(crate) fn cap(&self, coeffs: &Coeffs) -> f32 {
        let Some(continuous) = coeffs.continuous else {
            return 1.0;
        };
        let x = between((self.state.value - 1.0) / FALL, 0.0, 1.0);
        // So written it ends at the continuous force however small that is.
        continuous + (1.0 - continuous) * (1.0 - x * x * (3.0 - 2.0 * x))
    }

    /// A tick with this force \[caps\].
    pub(crate) fn tick(&mut self, force: Vec2, coeffs: &Coeffs) {
        if let Some(continuous) = coeffs.continuous {
            let load = force.length_squared() / (continuous * continuous);
            self.state
                .add((load - self.state.value) * coeffs.thermal_step);
        }
    }

    pub(crate) fn state(&self) -> f32 {
        self.state.value
    }
}
