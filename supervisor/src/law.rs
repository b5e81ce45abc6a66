//! The wanted force per mode. Pure functions; nothing here is limited yet.
//!
//! What drives a rotor into backward whirl is friction at impacts: an impact with normal speed v_n
//! adds μ(1 + e)·v_n to the backward tangential speed, and the bounces that follow add their share of
//! what is left. Over all of them the backward speed comes to S = v_b + K·v_n with
//! K = μ(1 + e)/(1 − e). A force lowers S fastest along −(b̂ + K·n̂) of the *next* impact, b̂ being its
//! backward direction and n̂ its normal. In continuous contact only −b̂ brakes, and an inward part
//! of μ takes away some of the driving friction: −(b̂ + μ·n̂).

use crate::coeffs::Coeffs;
use crate::detect::Findings;
use crate::estimate::Motion;
use crate::math::{max, min, sqrt};
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
}

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

/// Backward direction at a contact with normal `n`: against the surface speed of the spin, or, with
/// unknown spin, along the whirl that is there.
fn backward(n: Vec2, velocity: Vec2, spin_sign: f32) -> Vec2 {
    let t = n.turned();
    let forward = if spin_sign != 0.0 {
        spin_sign
    } else if velocity.dot(t) > 0.0 {
        -1.0
    } else {
        1.0
    };
    t * -forward
}

/// Unit vector of b̂ + share·n̂, opposed.
fn opposed(b: Vec2, n: Vec2, share: f32) -> Vec2 {
    -(b + n * share) * (1.0 / sqrt(1.0 + share * share))
}

/// In flight: the next impact is at the end of the chord. If it comes before a force decided now can
/// act, the flight after it counts instead, with the velocity that the impact will leave.
fn before_impact(motion: &Motion, spin_sign: f32, coeffs: &Coeffs) -> Wanted {
    let damping = -motion.velocity * coeffs.damper;
    // What speed leaves of the capacity brings the rotor back: damping alone would let it lie.
    let restoring = -motion.position * coeffs.hold_share;
    let (mut position, mut velocity) = (motion.position, motion.velocity);
    let Some(mut impact) = Impact::ahead(position, velocity) else {
        return Wanted {
            braking: Vec2::ZERO,
            damping,
            restoring,
        };
    };
    if impact.ticks < coeffs.horizon {
        let b = backward(impact.normal, velocity, spin_sign);
        let normal_speed = velocity.dot(impact.normal);
        velocity = velocity - impact.normal * ((1.0 + coeffs.restitution) * normal_speed)
            + b * (coeffs.friction * (1.0 + coeffs.restitution) * normal_speed);
        position = impact.normal;
        if let Some(after) = Impact::ahead(position * 0.999, velocity) {
            impact = after;
        }
    }
    let n = impact.normal;
    let b = backward(n, velocity, spin_sign);
    let sum = velocity.dot(b) + coeffs.bounce_gain * velocity.dot(n);
    let strength = min(max(sum, 0.0) * coeffs.damper, 1.0);
    Wanted {
        braking: opposed(b, n, coeffs.bounce_gain) * strength,
        damping: -velocity * coeffs.damper,
        restoring: Vec2::ZERO,
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
    let b = backward(n, motion.velocity, spin_sign);
    let speed = motion.velocity.dot(b);
    let strength = min(
        max(
            speed + coeffs.bounce_gain * max(found.radial_speed, 0.0),
            0.0,
        ) * coeffs.damper,
        1.0,
    );
    let aim = opposed(b, n, coeffs.friction) * strength;
    Wanted {
        braking: aim.rotated(lead(found.tangential_speed, coeffs)),
        damping: -motion.velocity * coeffs.damper,
        restoring: Vec2::ZERO,
    }
}

/// Rotation that makes up for delay and lag on a circle at `rate` radians per tick: a lag of τ turns
/// a rotating force by atan(ω·τ), a delay of h by ω·h.
fn lead(rate: f32, coeffs: &Coeffs) -> Vec2 {
    let delay = rate * (coeffs.delay as f32 + 0.5);
    let lag = rate * coeffs.lag;
    let both = Vec2::new(1.0, delay).rotated(Vec2::new(1.0, lag));
    both.direction().0
}

/// On the wall under a load: push inwards with what the load leaves useful, keep still.
fn hold(motion: &Motion, found: &Findings, spin_sign: f32, coeffs: &Coeffs) -> Wanted {
    let b = backward(found.normal, motion.velocity, spin_sign);
    let speed = max(motion.velocity.dot(b), 0.0);
    Wanted {
        braking: b * -min(speed * coeffs.damper, 1.0),
        damping: -motion.velocity * coeffs.damper,
        restoring: found.normal * -coeffs.hold_share,
    }
}
