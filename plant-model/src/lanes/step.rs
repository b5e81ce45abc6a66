//! What steps of all modes have in common: how far series can be trusted, and their values at the end.

use super::group::{Event, Group, Pair, Rows};
use super::number::{Lanes, Mask, WIDTH, root_of_inverse};
use super::roots::ZeroCrossing;
use crate::series::LENGTH;

/// Value at θ.
#[inline(always)]
pub(super) fn at(c: &[Lanes; LENGTH], order: usize, theta: Lanes) -> Lanes {
    let mut sum = c[order];
    for c in c[..order].iter().rev() {
        sum = sum * theta + *c;
    }
    sum
}

/// How far it can get from its start up to θ: Σ |c_k|·θ^k.
#[inline(always)]
pub(super) fn reach(c: &[Lanes; LENGTH], order: usize, theta: Lanes) -> Lanes {
    let mut sum = c[order].abs();
    for c in c[1..order].iter().rev() {
        sum = sum * theta + c.abs();
    }
    sum * theta
}

/// The direction of the unbalance, as long as it is wanted.
#[inline(always)]
pub(super) fn turn(rows: &mut Rows, group: &Group, k: usize, next: Lanes) {
    let by = next * group.constants.spin;
    rows.cos[k + 1] = -(by * rows.sin[k]);
    rows.sin[k + 1] = by * rows.cos[k];
}

#[inline(always)]
pub(super) fn begin(rows: &mut Rows, group: &Group) {
    (rows.ux[0], rows.uy[0]) = (group.position.x, group.position.y);
    (rows.wx[0], rows.wy[0]) = (group.velocity.x, group.velocity.y);
    (rows.cos[0], rows.sin[0]) = (group.direction.x, group.direction.y);
}

/// θ up to which the series can be trusted: see [`crate::integrate::order_control::trusted_theta`].
#[inline(always)]
pub(super) fn trusted(rows: &Rows, order: usize, (position, velocity): (Lanes, Lanes)) -> Lanes {
    let mut least = Lanes::all(f64::INFINITY);
    for k in order - 2..=order {
        let u = Pair {
            x: rows.ux[k],
            y: rows.uy[k],
        };
        let w = Pair {
            x: rows.wx[k],
            y: rows.wy[k],
        };
        let square = u.dot(u) * position * position + w.dot(w) * velocity * velocity;
        least = root_of_inverse(square, 2.0 * k as f64).min(least);
    }
    least * 0.9
}

/// Reciprocal scales of distances and of speeds, over the tolerance.
#[inline(always)]
pub(super) fn weights(group: &mut Group, rate: Lanes, rtol: f64) -> (Lanes, Lanes) {
    let c = &group.constants;
    let now = group.velocity.dot(group.velocity).sqrt();
    group.fastest = group.fastest.max(now);
    let floor = group.fastest.max(c.clearance * c.contact_rate * 1e-3) * 1e-3;
    let speed = now.max(floor);
    let distance = (speed * rate.recip()).min(c.clearance);
    ((distance * rtol).recip(), (speed * rtol).recip())
}

/// Largest angle by which the unbalance turns in a step of an order, so that what is left out of its series is rounding.
fn largest_turn(order: usize) -> f64 {
    match order {
        ..18 => 0.9,
        18..22 => 1.3,
        _ => 2.0,
    }
}

/// From the trusted θ: how far the step may go, in θ; 0 where the reference was too long. Sets the next reference.
#[inline(always)]
pub(super) fn limit(group: &mut Group, trusted: Lanes, order: usize) -> Lanes {
    let mut theta = trusted;
    if group.unbalanced {
        let turn = group.constants.spin.abs() * group.reference;
        // Of a balanced run beside one that is not: infinite.
        theta = theta.min(turn.map(|turn| largest_turn(order) / turn));
    }
    let far = Lanes::all(1e-2).less(theta);
    let kept = theta.min(Lanes::all(1e3)) * group.reference;
    let shrunk = theta.max(Lanes::all(1e-6)) * group.reference;
    let end = (group.most * group.reference.recip()).min(theta);
    group.reference = kept.or(far, shrunk);
    end.or(far, Lanes::all(0.0))
}

/// Puts the end of the step.
#[inline(always)]
pub(super) fn finish(
    rows: &Rows,
    group: &mut Group,
    (order, theta): (usize, Lanes),
    reference: Lanes,
) {
    group.position.x = at(&rows.ux, order, theta);
    group.position.y = at(&rows.uy, order, theta);
    group.velocity.x = at(&rows.wx, order, theta);
    group.velocity.y = at(&rows.wy, order, theta);
    if group.unbalanced {
        group.direction.x = at(&rows.cos, order, theta);
        group.direction.y = at(&rows.sin, order, theta);
    }
    group.step = theta * reference;
    group.theta = theta;
}

/// Coefficient n of ρ, from ρ² = u·u, each product of two but once.
#[inline(always)]
pub(super) fn extend_distance(rows: &mut Rows, n: usize, per: Lanes) {
    let mut sum = Lanes::all(0.0);
    for i in 1..n.div_ceil(2) {
        let j = n - i;
        sum = sum
            + (rows.ux[i] * rows.ux[j] + rows.uy[i] * rows.uy[j]
                - rows.distance[i] * rows.distance[j]);
    }
    if n.is_multiple_of(2) {
        let (x, y, r) = (rows.ux[n / 2], rows.uy[n / 2], rows.distance[n / 2]);
        sum = sum + (x * x + y * y - r * r) * 0.5;
    }
    // What has just become known comes last: nothing before it has to wait.
    rows.distance[n] = (sum + (rows.ux[0] * rows.ux[n] + rows.uy[0] * rows.uy[n])) * per;
}

impl ZeroCrossing {
    /// Shortens the step to this where it is sooner.
    #[inline(always)]
    pub(super) fn shorten(
        &self,
        (theta, asked): (Lanes, Mask),
        event: &mut [Option<Event>; WIDTH],
        of: Event,
    ) -> Lanes {
        let mut out = theta;
        for i in 0..WIDTH {
            let sooner = self.theta.0[i] < theta.0[i] || self.found[i];
            if asked[i] && sooner {
                out.0[i] = self.theta.0[i];
                event[i] = self.found[i].then_some(of);
            }
        }
        out
    }
}
