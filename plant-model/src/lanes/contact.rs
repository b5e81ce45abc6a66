//! A step in contact, slipping or rolling.
//!
//! The recurrence is that of [`crate::machine`] for one pair of coordinates, per mass. Contact is −κ·u + τ·(u turned by a right
//! angle) with κ the normal force and τ the friction over the distance ρ.

#![expect(
    clippy::needless_range_loop,
    reason = "a lane has its place in several arrays"
)]

use super::group::{Accuracy, Event, Group, Pair, Rows};
use super::number::{Lanes, WIDTH, any};
use super::roots::first_crossing;
use super::step::*;
use crate::series::{INVERSE, MAX_ORDER};

#[inline(always)]
pub(super) fn contact<const ROLLS: bool>(accuracy: &Accuracy, rows: &mut Rows, group: &mut Group) {
    let ([_, rtol], [_, order]) = (accuracy.rtol, accuracy.order);
    debug_assert!(order <= MAX_ORDER);
    begin(rows, group);
    let c = group.constants;
    let h = group.reference;
    let slides = c.friction * group.sign;
    let per_h = h.recip();
    let rate = c.contact_damping * per_h;
    let (u0, w0) = (group.position, group.velocity);
    let start = u0.dot(u0).sqrt();
    let per = start.recip();
    let per_square = per * per;
    rows.distance[0] = start;
    for k in 0..order {
        let n = k + 1;
        let next = h * INVERSE[n];
        rows.ux[n] = next * rows.wx[k];
        rows.uy[n] = next * rows.wy[k];
        extend_distance(rows, n, per);
        let depth = match k {
            0 => rows.distance[0] - c.clearance,
            _ => rows.distance[k],
        };
        rows.force[k] = c.contact_stiffness * depth + rate * rows.distance[n] * n as f64;
        let (mut below, mut fx, mut fy) = (Lanes::all(0.0), Lanes::all(0.0), Lanes::all(0.0));
        for i in 0..k {
            let (normal, j) = (rows.normal[i], k - i);
            below = below + normal * rows.distance[j];
            fx = fx + normal * rows.ux[j];
            fy = fy + normal * rows.uy[j];
            if ROLLS {
                fx = fx + rows.friction[i] * rows.uy[j];
                fy = fy - rows.friction[i] * rows.ux[j];
            }
        }
        let normal = (rows.force[k] - below) * per;
        rows.normal[k] = normal;
        fx = fx + normal * u0.x;
        fy = fy + normal * u0.y;
        let (ux, uy, wx, wy) = (rows.ux[k], rows.uy[k], rows.wx[k], rows.wy[k]);
        let mut ax = -(c.stiffness * ux + c.damping * wx) - fx;
        let mut ay = -(c.stiffness * uy + c.damping * wy) - fy;
        if group.unbalanced {
            ax = ax + c.unbalance * rows.cos[k];
            ay = ay + c.unbalance * rows.sin[k];
            turn(rows, group, k, next);
        }
        if ROLLS {
            // What friction has to be follows from the sliding speed that is then zero: u × w + Ω·R·ρ.
            let mut whirl = Lanes::all(0.0);
            // Of u × w, w the derivative of u: places that are exchanged take their turn together.
            for i in 1..=n / 2 {
                let j = n + 1 - i;
                whirl =
                    whirl + (rows.ux[i] * rows.uy[j] - rows.uy[i] * rows.ux[j]) * (j - i) as f64;
            }
            let rate = (whirl * per_h + c.surface * rows.distance[n]) * (per_h * n as f64);
            let friction = -((rate + (u0.x * ay - u0.y * ax)) * per_square);
            rows.friction[k] = friction;
            ax = ax - friction * u0.y;
            ay = ay + friction * u0.x;
        } else {
            ax = ax + slides * fy;
            ay = ay - slides * fx;
        }
        rows.wx[n] = next * ax;
        rows.wy[n] = next * ay;
    }
    // Forces are known to one order less than the motion.
    let top = order - 1;
    let weights = weights(group, c.contact_rate, rtol);
    let mut theta = limit(group, trusted(rows, order, weights), order);
    let mut event = [None; WIDTH];

    let asked = rows.force[0].less(reach(&rows.force, top, theta));
    if any(asked) {
        let crossing = first_crossing(&rows.force, (top, theta), &mut rows.guard);
        theta = crossing.shorten((theta, asked), &mut event, Event::LiftOff);
    }
    if ROLLS {
        for (sign, slips) in [(1.0, true), (-1.0, false)] {
            // τ > 0 gives way to a negative sliding speed.
            for k in 0..=top {
                rows.room[k] = c.friction * rows.normal[k] + rows.friction[k] * sign;
            }
            let asked = rows.room[0].less(reach(&rows.room, top, theta));
            if any(asked) {
                let crossing = first_crossing(&rows.room, (top, theta), &mut rows.guard);
                theta = crossing.shorten((theta, asked), &mut event, Event::Slips(slips));
            }
        }
    } else {
        let fast =
            w0.x.abs() + w0.y.abs() + reach(&rows.wx, order, theta) + reach(&rows.wy, order, theta);
        // Without friction the direction of slip changes nothing.
        let mut asked = c.surface.abs().less(fast);
        for i in 0..WIDTH {
            asked[i] &= c.friction.0[i] > 0.0;
        }
        if any(asked) {
            for n in 0..=order {
                let mut whirl = c.surface * rows.distance[n];
                for i in 0..=n {
                    let j = n - i;
                    whirl = whirl + (rows.ux[i] * rows.wy[j] - rows.uy[i] * rows.wx[j]);
                }
                rows.room[n] = whirl * group.sign;
            }
            let crossing = first_crossing(&rows.room, (order, theta), &mut rows.guard);
            theta = crossing.shorten((theta, asked), &mut event, Event::Stops);
        }
    }
    if !ROLLS && group.watched {
        group.whirl = fastest_whirl(rows, group, (order, theta));
    }
    finish(rows, group, (order, theta), h);
    group.event = event;
}

/// Bound of the whirl's speed up to θ \[m/s\]: by the tangent at the start, and by how far the tangent turns.
#[inline(always)]
pub(super) fn fastest_whirl(rows: &Rows, group: &Group, (order, theta): (usize, Lanes)) -> Lanes {
    let (u, w) = (group.position, group.velocity);
    let per = rows.distance[0].recip();
    let tangent = Pair {
        x: -(u.y * per),
        y: u.x * per,
    };
    let (mut gone, mut faster) = (Lanes::all(0.0), Lanes::all(0.0));
    for k in (1..=order).rev() {
        let along = |x: Lanes, y: Lanes| (tangent.x * x + tangent.y * y).abs();
        gone = gone * theta + along(rows.ux[k], rows.uy[k]);
        faster = faster * theta + along(rows.wx[k], rows.wy[k]);
    }
    let speed =
        w.x.abs() + w.y.abs() + reach(&rows.wx, order, theta) + reach(&rows.wy, order, theta);
    // In contact the rotor is no nearer to the middle than the wall is.
    let turned = gone * theta * group.constants.clearance.recip();
    tangent.dot(w).abs() + faster * theta + turned * speed
}
