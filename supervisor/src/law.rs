//! The wanted force per mode. Pure functions; nothing here is limited yet.
//!
//! What drives a rotor into backward whirl is friction at impacts: an impact with normal speed v_n
//! adds μ(1 + e)·v_n to the backward tangential speed, and the bounces that follow add their share of
//! what is left. Over all of them the backward speed comes to S = v_b + K·v_n with
//! K = μ(1 + e)/(1 − e). A force lowers S fastest against its gradient in the velocity: at the wall
//! b̂ + K·n̂, b̂ being the backward direction and n̂ the normal of the *next* impact; farther inside a
//! force has less of an arm about the centre, and damping the speed itself counts for more. In
//! continuous contact only −b̂ brakes, and an inward part of μ takes away some of the driving
//! friction: −(b̂ + μ·n̂).

use crate::coeffs::Coeffs;
use crate::detect::Findings;
use crate::estimate::Motion;
use crate::math::{between, max, min, sqrt};
use crate::signal::Mode;
use crate::vec2::Vec2;

/// Wanted forces in the order in which they may use the capacity \[caps\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Wanted {
    /// Against the backward tangential speed, tilted inwards by what friction is worth.
    pub(crate) braking: Vec2,
    /// Against the velocity.
    pub(crate) damping: Vec2,
    /// Inwards.
    pub(crate) restoring: Vec2,
    /// Wanted in contact.
    pub(crate) touching: bool,
}

/// Share of the cap that pushes inwards between impacts: more shortens the chords and with them the time
/// in which braking takes speed out.
const FLIGHT_SHARE: f32 = 0.15;
/// Of the whirl limit: impacts that will add up to less than the first need no help but to be softened,
/// from the second on all the force goes to what they add.
const HARMLESS: f32 = 1.0;
const URGENT: f32 = 1.6;
/// Largest share of the cap that ever pushes inwards.
const NEARLY_ALL: f32 = 0.95;

/// The wanted force of a mode; zero for the modes in which the supervisor wants nothing itself.
pub(crate) fn wanted(
    mode: Mode,
    motion: &Motion,
    found: &Findings,
    spin_sign: f32,
    coeffs: &Coeffs,
) -> Wanted {
    match mode {
        Mode::Levitated | Mode::SensorFault => Wanted::default(),
        Mode::BackwardWhirl => braking(motion, found, spin_sign, coeffs),
        Mode::Pinned => hold(motion, found, spin_sign, coeffs),
        Mode::Approach | Mode::Bounce | Mode::Handover => {
            if found.touching {
                braking(motion, found, spin_sign, coeffs)
            } else {
                before_impact(motion, spin_sign, coeffs)
            }
        }
    }
}

/// Sense of backward at a contact with normal `n`, +1 counter-clockwise: against the surface speed of
/// the spin, or, with unknown spin, along the whirl that is there.
fn backward(n: Vec2, velocity: Vec2, spin_sign: f32) -> f32 {
    if spin_sign != 0.0 {
        -spin_sign
    } else if velocity.dot(n.turned()) > 0.0 {
        1.0
    } else {
        -1.0
    }
}

/// In flight: the next impact is at the end of the chord. If it comes before a force decided now can
/// act, the flight after it counts instead, with the velocity that the impact will leave.
fn before_impact(motion: &Motion, spin_sign: f32, coeffs: &Coeffs) -> Wanted {
    let damping = -motion.velocity * coeffs.damper;
    // What speed leaves of the capacity brings the rotor back: damping alone would let it lie. When slow,
    // a little more of it than a hold on the wall has, or the two would take turns.
    let share = max(
        NEARLY_ALL - of_lift_off(motion.velocity, coeffs),
        FLIGHT_SHARE,
    );
    let restoring = -motion.position * share;
    let rest = Wanted {
        braking: Vec2::ZERO,
        damping,
        restoring,
        touching: false,
    };
    let (mut position, mut velocity) = (motion.position, motion.velocity);
    let Some(mut impact) = Impact::ahead(position, velocity) else {
        return rest;
    };
    // With unknown spin nobody knows which way an impact will push: only the whirl counts that is
    // there, or its sense, and the force with it, would change from tick to tick.
    let (gain, friction) = if spin_sign != 0.0 {
        (coeffs.bounce_gain, coeffs.friction)
    } else {
        (0.0, 0.0)
    };
    let mut act_after = coeffs.horizon;
    if impact.ticks < act_after {
        let b = impact.normal.turned() * backward(impact.normal, velocity, spin_sign);
        let lost = (1.0 + coeffs.restitution) * velocity.dot(impact.normal);
        velocity = velocity - impact.normal * lost + b * (friction * lost);
        act_after -= impact.ticks;
        // A hair inside, so that the chord ahead is not the point itself.
        position = impact.normal * 0.999;
        match Impact::ahead(position, velocity) {
            Some(after) => impact = after,
            None => return rest,
        }
        act_after = min(act_after, impact.ticks);
    }
    let acts_at = position + velocity * act_after;
    let n = impact.normal;
    let sense = backward(n, velocity, spin_sign);
    let (v_n, v_b) = (velocity.dot(n), velocity.dot(n.turned()) * sense);
    let sum = v_b + gain * v_n;
    let urgency = between(
        (sum / coeffs.whirl_limit - HARMLESS) / (URGENT - HARMLESS),
        0.0,
        1.0,
    );
    let strength = min(max(sum, 0.0) * coeffs.damper, urgency);
    // Gradient of S, times v_n: v_b = r × v about the centre, v_n = √(v² − v_b²).
    let (gradient, _) =
        (acts_at.turned() * (sense * (v_n - gain * v_b)) + velocity * gain).direction();
    Wanted {
        braking: gradient * -strength,
        ..rest
    }
}

/// Where a straight flight meets the clearance circle.
struct Impact {
    ticks: f32,
    normal: Vec2,
}

impl Impact {
    /// `None` for a rotor without speed, or beyond the wall.
    fn ahead(position: Vec2, velocity: Vec2) -> Option<Self> {
        let square = velocity.length_squared();
        let room = 1.0 - position.length_squared();
        if !(square > 1e-12 && room > 0.0) {
            return None;
        }
        let along = position.dot(velocity);
        let ticks = (sqrt(along * along + square * room) - along) / square;
        Some(Self {
            ticks,
            normal: position + velocity * ticks,
        })
    }
}

/// In contact: brake along the wall, aimed at where the rotor will be when the force has come.
fn braking(motion: &Motion, found: &Findings, spin_sign: f32, coeffs: &Coeffs) -> Wanted {
    let n = found.normal;
    let b = n.turned() * backward(n, motion.velocity, spin_sign);
    // With unknown spin only the whirl counts that is there, as in flight.
    let gain = if spin_sign != 0.0 {
        coeffs.bounce_gain
    } else {
        0.0
    };
    let sum = motion.velocity.dot(b) + gain * max(found.radial_speed, 0.0);
    // Switched on into a contact that is pressed on as only whirl does: no time is to be lost.
    let pressed = 2.0 - coeffs.touch_radius;
    let strength = if motion.fresh && motion.position.length_squared() > pressed * pressed {
        1.0
    } else {
        min(max(sum, 0.0) * coeffs.damper, 1.0)
    };
    // Unit vector against b̂ + μ·n̂.
    let mu = coeffs.friction;
    let aim = (b + n * mu) * (-strength / sqrt(1.0 + mu * mu));
    Wanted {
        braking: aim.rotated(lead(found.tangential_speed, coeffs)),
        damping: -motion.velocity * coeffs.damper,
        // Slower than lift-off an inward force can end the contact.
        restoring: n * -max(
            coeffs.hold_share - of_lift_off(motion.velocity, coeffs),
            0.0,
        ),
        touching: true,
    }
}

/// Square of a speed over that of the lift-off speed.
fn of_lift_off(velocity: Vec2, coeffs: &Coeffs) -> f32 {
    velocity.length_squared() / coeffs.slow_squared
}

/// Rotation that makes up for delay and lag on a circle at `rate` radians per tick: a delay of h turns
/// a rotating force by ω·h, a lag of τ by atan(ω·τ).
fn lead(rate: f32, coeffs: &Coeffs) -> Vec2 {
    // The series of sine and cosine are good to 1 % up to a radian, beyond which no lead would help.
    let angle = between(rate * (coeffs.delay as f32 + 0.5), -1.0, 1.0);
    let square = angle * angle;
    let delay = Vec2::new(
        1.0 - square * (0.5 - square / 24.0),
        angle * (1.0 - square / 6.0),
    );
    delay
        .rotated(Vec2::new(1.0, rate * coeffs.lag))
        .direction()
        .0
}

/// On the wall under a load: push inwards with what the load leaves useful, keep still.
fn hold(motion: &Motion, found: &Findings, spin_sign: f32, coeffs: &Coeffs) -> Wanted {
    let b = found.normal.turned() * backward(found.normal, motion.velocity, spin_sign);
    let speed = max(motion.velocity.dot(b), 0.0);
    Wanted {
        braking: b * -min(speed * coeffs.damper, 1.0),
        damping: -motion.velocity * coeffs.damper,
        restoring: found.normal * -coeffs.hold_share,
        touching: true,
    }
}
