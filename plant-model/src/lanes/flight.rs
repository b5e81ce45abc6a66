//! A step in flight, and one beyond the wall, which stays dented after a lift-off.

#![expect(
    clippy::needless_range_loop,
    reason = "a lane has its place in several arrays"
)]

use super::group::{Accuracy, Event, Group, Rows};
use super::number::{Lanes, WIDTH, any, root_of_inverse};
use super::roots::first_crossing;
use super::step::*;
use crate::series::INVERSE;

/// The motion without contact.
#[inline(always)]
pub(super) fn fly(rows: &mut Rows, group: &Group, order: usize) {
    begin(rows, group);
    let (c, h) = (&group.constants, group.reference);
    for k in 0..order {
        let next = h * INVERSE[k + 1];
        let (ux, uy, wx, wy) = (rows.ux[k], rows.uy[k], rows.wx[k], rows.wy[k]);
        rows.ux[k + 1] = next * wx;
        rows.uy[k + 1] = next * wy;
        let mut ax = -(c.stiffness * ux + c.damping * wx);
        let mut ay = -(c.stiffness * uy + c.damping * wy);
        if group.unbalanced {
            ax = ax + c.unbalance * rows.cos[k];
            ay = ay + c.unbalance * rows.sin[k];
            turn(rows, group, k, next);
        }
        rows.wx[k + 1] = next * ax;
        rows.wy[k + 1] = next * ay;
    }
}

/// Flight beyond the wall: until the rotor is back inside, or the force returns.
#[inline(always)]
pub(super) fn beyond(accuracy: &Accuracy, rows: &mut Rows, group: &mut Group) {
    let ([_, rtol], [_, order]) = (accuracy.rtol, accuracy.order);
    fly(rows, group, order);
    let (c, h) = (group.constants, group.reference);
    let start = group.position.dot(group.position).sqrt();
    rows.distance[0] = start;
    for n in 1..=order {
        extend_distance(rows, n, start.recip());
    }
    let rate = c.contact_damping * h.recip();
    let top = order - 1;
    rows.room = rows.distance;
    rows.room[0] = start - c.clearance;
    for k in 0..=top {
        rows.force[k] =
            -(c.contact_stiffness * rows.room[k] + rate * rows.distance[k + 1] * (k + 1) as f64);
    }
    let weights = weights(group, c.contact_rate, rtol);
    // Its distance has a pole where the rotor would pass the middle.
    let mut least = trusted(rows, order, weights);
    for k in top - 2..=top {
        let c = rows.distance[k] * weights.0;
        least = (root_of_inverse(c * c, 2.0 * k as f64) * 0.9).min(least);
    }
    let mut theta = limit(group, least, order);
    let mut event = [None; WIDTH];
    let all = [true; WIDTH];
    let crossing = first_crossing(&rows.room, (top, theta), &mut rows.guard);
    theta = crossing.shorten((theta, all), &mut event, Event::Returns);
    let crossing = first_crossing(&rows.force, (top, theta), &mut rows.guard);
    theta = crossing.shorten((theta, all), &mut event, Event::Touch);
    finish(rows, group, (order, theta), h);
    group.event = event;
}

#[inline(always)]
pub(super) fn flight(accuracy: &Accuracy, rows: &mut Rows, group: &mut Group) {
    let ([rtol, _], [order, _]) = (accuracy.rtol, accuracy.order);
    fly(rows, group, order);
    let c = group.constants;
    let h = group.reference;
    let weights = weights(group, c.natural, rtol);
    let end = limit(group, trusted(rows, order, weights), order);

    // In flight speed grows by the unbalance alone, so that everything has a bound.
    let time = end * h;
    let (u, w) = (group.position, group.velocity);
    let energy = w.dot(w) + c.stiffness * u.dot(u);
    let speed = energy.sqrt() + c.unbalance * time;
    let distance = (u.dot(u).sqrt() + speed * time).min(speed * c.natural.recip());
    let pushed = c.damping * speed + c.unbalance;
    let bend = (speed * speed + pushed * distance) * 2.0;

    // Beyond the wall: until it is inside for certain, and no force can return before.
    let mut from = Lanes::all(0.0);
    let mut lingers = [false; WIDTH];
    if any(group.beyond) {
        let radius = u.dot(u).sqrt();
        let inward = -(u.dot(w) * radius.recip());
        let until = (radius - c.clearance) * 2.0 * inward.recip();
        // By then it has not gone far, so that it cannot be at another wall.
        let pulled = c.stiffness * radius + pushed;
        let gone = (inward + pulled * until) * until;
        let deepest = radius - gone;
        let nearest = c.clearance * 0.8;
        // What slows its way inward: the whirl, by its angular momentum, the shaft's damping, the unbalance. The shaft helps.
        let momentum = u.perp(w).abs() + radius * c.unbalance * until;
        let per = nearest.recip();
        let slowed = momentum * momentum * per * per * per + pushed;
        let slows = slowed * until;
        let returns = c.contact_damping * slowed;
        for i in 0..WIDTH {
            let clear = inward.0[i] > 0.0
                && until.0[i] < time.0[i]
                && deepest.0[i] > nearest.0[i]
                && slows.0[i] < 0.5 * inward.0[i]
                && returns.0[i] < 0.5 * c.contact_stiffness.0[i] * inward.0[i];
            lingers[i] = group.beyond[i] && !clear;
            from.0[i] = if group.beyond[i] && clear {
                until.0[i].max(0.0)
            } else {
                0.0
            };
        }
        from = from * h.recip();
    }

    let square = c.clearance * c.clearance;
    let tiny = square * 1e-15;
    let (mut theta, mut done) = (from, [false; WIDTH]);
    let mut touches = [false; WIDTH];
    let per_h = h.recip();
    for i in 0..WIDTH {
        // Far from the wall, or no way to go.
        let far = distance.0[i] < c.clearance.0[i];
        done[i] = far || lingers[i] || end.0[i] <= theta.0[i];
        theta.0[i] = if done[i] { end.0[i] } else { theta.0[i] };
    }
    for _ in 0..20 {
        if done.iter().all(|d| *d) {
            break;
        }
        let (x, y) = (at(&rows.ux, order, theta), at(&rows.uy, order, theta));
        let (vx, vy) = (at(&rows.wx, order, theta), at(&rows.wy, order, theta));
        let gap = square - (x * x + y * y);
        let rate = (x * vx + y * vy) * -2.0;
        let gap = gap.max(Lanes::all(0.0));
        let root = (rate * rate + bend * gap * 2.0).sqrt();
        for i in 0..WIDTH {
            let (g, r, root) = (gap.0[i], rate.0[i], root.0[i]);
            let advance = if r >= 0.0 {
                (r + root) / bend.0[i]
            } else {
                2.0 * g / (root - r)
            };
            let touch = !done[i] && g <= tiny.0[i] && r < 0.0;
            touches[i] |= touch;
            done[i] |= touch;
            let next = theta.0[i] + advance * per_h.0[i];
            let ends = next >= end.0[i];
            theta.0[i] = if done[i] {
                theta.0[i]
            } else if ends {
                end.0[i]
            } else {
                next
            };
            done[i] |= ends;
        }
    }
    for i in 0..WIDTH {
        theta.0[i] = if lingers[i] { 0.0 } else { theta.0[i] };
    }
    finish(rows, group, (order, theta), h);
    for i in 0..WIDTH {
        group.event[i] = if lingers[i] {
            Some(Event::Lingers)
        } else if touches[i] {
            Some(Event::Touch)
        } else {
            None
        };
    }
}
