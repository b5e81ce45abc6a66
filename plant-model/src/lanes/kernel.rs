//! One step of several runs that are in the same mode: power series of the motion, how far they can be trusted, and the first
//! guard that falls.
//!
//! The recurrence is that of [`crate::machine`] for one pair of coordinates, per mass. Contact is −κ·u + τ·(u turned by a right
//! angle) with κ the normal force and τ the friction over the distance ρ.

#![expect(
    clippy::needless_range_loop,
    reason = "a lane has its place in several arrays"
)]

use super::number::{Lanes, Mask, WIDTH, any, root_of_inverse};
use super::roots::{Fall, first_fall};
use crate::V2;
use crate::series::{INVERSE, LENGTH, MAX_ORDER};
use pulp::{Simd, WithSimd};

/// Mode of all runs in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Flight,
    /// Without force, while the wall is still dented.
    Beyond,
    Slip,
    Roll,
}

impl Kind {
    pub(super) fn touches(self) -> bool {
        matches!(self, Self::Slip | Self::Roll)
    }
}

/// A plane vector of each run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pair {
    pub(super) x: Lanes,
    pub(super) y: Lanes,
}

impl Pair {
    #[inline(always)]
    fn dot(self, other: Self) -> Lanes {
        self.x * other.x + self.y * other.y
    }

    #[inline(always)]
    pub(super) fn perp(self, other: Self) -> Lanes {
        self.x * other.y - self.y * other.x
    }
}

/// Numbers that stay the same over a run, one field for each; forces and stiffnesses are per mass.
macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// Of one run.
        #[derive(Debug, Clone, Copy, Default)]
        pub(super) struct Constants {
            $($(#[$doc])* pub(super) $name: f64,)*
        }

        /// Of each run.
        #[derive(Debug, Clone, Copy, Default)]
        pub(super) struct LanesOfConstants {
            $(pub(super) $name: Lanes,)*
        }

        impl LanesOfConstants {
            pub(super) fn set(&mut self, lane: usize, of: &Constants) {
                $(self.$name.0[lane] = of.$name;)*
            }
        }
    };
}

constants! {
    /// Shaft: k/m \[1/s²\] and its root.
    stiffness,
    natural,
    /// d/m \[1/s\].
    damping,
    /// k_c/m \[1/s²\], its root, and d_c/m \[1/s\].
    contact_stiffness,
    contact_rate,
    contact_damping,
    /// c \[m\].
    clearance,
    friction,
    /// Ω·R \[m/s\].
    surface,
    /// ε·Ω² \[m/s²\], and Ω \[rad/s\] where that is not zero.
    unbalance,
    spin,
}

/// Runs in one step: what goes in, and what comes out.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) kind: Kind,
    /// Whether any run is unbalanced.
    pub(super) unbalanced: bool,
    pub(super) constants: LanesOfConstants,
    /// State, and at the end of the step.
    pub(super) position: Pair,
    pub(super) velocity: Pair,
    /// Direction of the unbalance.
    pub(super) direction: Pair,
    /// Sign of the sliding speed.
    pub(super) sign: Lanes,
    /// Flight beyond the wall: of lanes that have just lifted off.
    pub(super) beyond: Mask,
    /// Reference \[s\], and the next one.
    pub(super) reference: Lanes,
    /// Longest step \[s\].
    pub(super) most: Lanes,
    /// Largest speed so far \[m/s\].
    pub(super) fastest: Lanes,
    /// Length of the step \[s\], 0 where the reference was far too long; and its end on the series.
    pub(super) step: Lanes,
    pub(super) theta: Lanes,
    /// In a step of slip the whirl is never faster than this \[m/s\].
    pub(super) whirl: Lanes,
    pub(super) event: [Option<Event>; WIDTH],
}

/// What ended a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    Touch,
    LiftOff,
    /// The sliding speed comes to zero.
    Stops,
    /// Friction that holds it comes to an edge of its cone: from then on the sliding speed has this sign.
    Slips(bool),
    /// It may stay beyond the wall for longer; no step was taken.
    Lingers,
    /// Back inside the wall, without force.
    Returns,
}

/// Series of a step over θ = time / reference.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    ux: [Lanes; LENGTH],
    uy: [Lanes; LENGTH],
    wx: [Lanes; LENGTH],
    wy: [Lanes; LENGTH],
    /// ρ, f_n, κ, τ.
    distance: [Lanes; LENGTH],
    force: [Lanes; LENGTH],
    normal: [Lanes; LENGTH],
    friction: [Lanes; LENGTH],
    cos: [Lanes; LENGTH],
    sin: [Lanes; LENGTH],
    /// A guard.
    guard: [Lanes; LENGTH],
    room: [Lanes; LENGTH],
}

impl Default for Rows {
    fn default() -> Self {
        let row = [Lanes::default(); LENGTH];
        Self {
            ux: row,
            uy: row,
            wx: row,
            wy: row,
            distance: row,
            force: row,
            normal: row,
            friction: row,
            cos: row,
            sin: row,
            guard: row,
            room: row,
        }
    }
}

impl Rows {
    /// Speed of a run's whirl \[m/s\] at θ, counter-clockwise, and its slope.
    pub(super) fn whirl(&self, lane: usize, order: usize, theta: f64) -> (f64, f64) {
        let with_slope = |x: &[Lanes; LENGTH], y: &[Lanes; LENGTH]| {
            let (mut value, mut slope) = (V2::zeros(), V2::zeros());
            for k in (0..=order).rev() {
                slope = slope * theta + value;
                value = value * theta + V2::new(x[k].0[lane], y[k].0[lane]);
            }
            (value, slope)
        };
        let (u, w) = (
            with_slope(&self.ux, &self.uy),
            with_slope(&self.wx, &self.wy),
        );
        let distance = u.0.norm();
        let speed = u.0.perp(&w.0) / distance;
        let turned = speed * u.0.dot(&u.1) / (distance * distance);
        (speed, (u.1.perp(&w.0) + u.0.perp(&w.1)) / distance - turned)
    }
}

/// Tolerances and orders in flight and in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accuracy {
    pub(super) rtol: [f64; 2],
    pub(super) order: [usize; 2],
}

/// A step of a group.
pub(super) struct Task<'a> {
    pub(super) accuracy: &'a Accuracy,
    pub(super) rows: &'a mut Rows,
    pub(super) group: &'a mut Group,
}

/// Compiled for each set of instructions. Nothing in it says which: the compiler puts the arrays into what registers there are.
impl WithSimd for Task<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            accuracy,
            rows,
            group,
        } = self;
        match group.kind {
            Kind::Flight => flight(accuracy, rows, group),
            Kind::Beyond => beyond(accuracy, rows, group),
            Kind::Slip => contact::<false>(accuracy, rows, group),
            Kind::Roll => contact::<true>(accuracy, rows, group),
        }
    }
}

/// Value at θ.
#[inline(always)]
fn at(c: &[Lanes; LENGTH], order: usize, theta: Lanes) -> Lanes {
    let mut sum = c[order];
    for c in c[..order].iter().rev() {
        sum = sum * theta + *c;
    }
    sum
}

/// How far it can get from its start up to θ: Σ |c_k|·θ^k.
#[inline(always)]
fn reach(c: &[Lanes; LENGTH], order: usize, theta: Lanes) -> Lanes {
    let mut sum = c[order].abs();
    for c in c[1..order].iter().rev() {
        sum = sum * theta + c.abs();
    }
    sum * theta
}

/// The direction of the unbalance, as long as it is wanted.
#[inline(always)]
fn turn(rows: &mut Rows, group: &Group, k: usize, next: Lanes) {
    let by = next * group.constants.spin;
    rows.cos[k + 1] = -(by * rows.sin[k]);
    rows.sin[k + 1] = by * rows.cos[k];
}

#[inline(always)]
fn begin(rows: &mut Rows, group: &Group) {
    (rows.ux[0], rows.uy[0]) = (group.position.x, group.position.y);
    (rows.wx[0], rows.wy[0]) = (group.velocity.x, group.velocity.y);
    (rows.cos[0], rows.sin[0]) = (group.direction.x, group.direction.y);
}

/// θ up to which the series can be trusted: see [`crate::integrate::enough::trusted_theta`].
#[inline(always)]
fn trusted(rows: &Rows, order: usize, (position, velocity): (Lanes, Lanes)) -> Lanes {
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
fn weights(group: &mut Group, rate: Lanes, rtol: f64) -> (Lanes, Lanes) {
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
fn limit(group: &mut Group, trusted: Lanes, order: usize) -> Lanes {
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
fn finish(rows: &Rows, group: &mut Group, (order, theta): (usize, Lanes), reference: Lanes) {
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

/// The motion without contact.
#[inline(always)]
fn fly(rows: &mut Rows, group: &Group, order: usize) {
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
fn beyond(accuracy: &Accuracy, rows: &mut Rows, group: &mut Group) {
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
    let fall = first_fall(&rows.room, (top, theta), &mut rows.guard);
    theta = fall.take((theta, all), &mut event, Event::Returns);
    let fall = first_fall(&rows.force, (top, theta), &mut rows.guard);
    theta = fall.take((theta, all), &mut event, Event::Touch);
    finish(rows, group, (order, theta), h);
    group.event = event;
}

/// Coefficient n of ρ, from ρ² = u·u, each product of two but once.
#[inline(always)]
fn extend_distance(rows: &mut Rows, n: usize, per: Lanes) {
    let mut sum = rows.ux[0] * rows.ux[n] + rows.uy[0] * rows.uy[n];
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
    rows.distance[n] = sum * per;
}

#[inline(always)]
fn flight(accuracy: &Accuracy, rows: &mut Rows, group: &mut Group) {
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

#[inline(always)]
fn contact<const ROLLS: bool>(accuracy: &Accuracy, rows: &mut Rows, group: &mut Group) {
    let ([_, rtol], [_, order]) = (accuracy.rtol, accuracy.order);
    debug_assert!(order <= MAX_ORDER);
    begin(rows, group);
    let c = group.constants;
    let h = group.reference;
    let slides = c.friction * group.sign;
    let rate = c.contact_damping * h.recip();
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
            let (mut tx, mut ty) = (Lanes::all(0.0), Lanes::all(0.0));
            for i in 0..k {
                let (friction, j) = (rows.friction[i], k - i);
                tx = tx - friction * rows.uy[j];
                ty = ty + friction * rows.ux[j];
            }
            ax = ax + tx;
            ay = ay + ty;
            let mut whirl = c.surface * rows.distance[n];
            for i in 1..=n {
                let j = n - i;
                whirl = whirl + (rows.ux[i] * rows.wy[j] - rows.uy[i] * rows.wx[j]);
            }
            let friction = -((whirl * next.recip() + (u0.x * ay - u0.y * ax)) * per_square);
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
        let fall = first_fall(&rows.force, (top, theta), &mut rows.guard);
        theta = fall.take((theta, asked), &mut event, Event::LiftOff);
    }
    if ROLLS {
        for (sign, slips) in [(1.0, true), (-1.0, false)] {
            // τ > 0 gives way to a negative sliding speed.
            for k in 0..=top {
                rows.room[k] = c.friction * rows.normal[k] + rows.friction[k] * sign;
            }
            let asked = rows.room[0].less(reach(&rows.room, top, theta));
            if any(asked) {
                let fall = first_fall(&rows.room, (top, theta), &mut rows.guard);
                theta = fall.take((theta, asked), &mut event, Event::Slips(slips));
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
            let fall = first_fall(&rows.room, (order, theta), &mut rows.guard);
            theta = fall.take((theta, asked), &mut event, Event::Stops);
        }
    }
    if !ROLLS {
        group.whirl = fastest_whirl(rows, group, (order, theta));
    }
    finish(rows, group, (order, theta), h);
    group.event = event;
}

/// Bound of the whirl's speed up to θ \[m/s\]: by the tangent at the start, and by how far the tangent turns.
#[inline(always)]
fn fastest_whirl(rows: &Rows, group: &Group, (order, theta): (usize, Lanes)) -> Lanes {
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

impl Fall {
    /// Shortens the step to this where it is sooner.
    #[inline(always)]
    fn take(
        &self,
        (theta, asked): (Lanes, Mask),
        event: &mut [Option<Event>; WIDTH],
        of: Event,
    ) -> Lanes {
        let mut out = theta;
        for i in 0..WIDTH {
            let sooner = self.theta.0[i] < theta.0[i] || self.falls[i];
            if asked[i] && sooner {
                out.0[i] = self.theta.0[i];
                event[i] = self.falls[i].then_some(of);
            }
        }
        out
    }
}
