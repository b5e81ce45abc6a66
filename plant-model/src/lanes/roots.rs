//! The first zero of a polynomial over a step: none is missed.
//!
//! Over [0, θ] the polynomial is written in Bernstein's basis. Coefficients that do not change sign say that it has no zero
//! there, and one change that it has exactly one, which bisection and Newton's method then find. Where there are more changes
//! the step is halved.

#![expect(
    clippy::needless_range_loop,
    reason = "a lane has its place in several arrays"
)]

use super::number::{Lanes, Mask, WIDTH};
use crate::series::{LENGTH, MAX_ORDER};

/// Where guards fall: θ, and whether it is a zero or only the end of what is known to have none.
#[derive(Debug, Clone, Copy)]
pub(super) struct ZeroCrossing {
    pub(super) theta: Lanes,
    pub(super) found: Mask,
}

/// 1 / C(n, k).
const INVERSE_BINOMIAL: [[f64; MAX_ORDER + 1]; MAX_ORDER + 1] = {
    let mut table = [[0.0; MAX_ORDER + 1]; MAX_ORDER + 1];
    let mut n = 0;
    while n <= MAX_ORDER {
        let (mut k, mut choose) = (0, 1.0);
        while k <= n {
            table[n][k] = 1.0 / choose;
            choose = choose * (n - k) as f64 / (k + 1) as f64;
            k += 1;
        }
        n += 1;
    }
    table
};

/// How often a step is halved at most.
const HALVINGS: usize = 12;
/// Steps to a zero.
const ITERATIONS: usize = 12;

#[inline(always)]
pub(super) fn first_crossing(
    c: &[Lanes; LENGTH],
    (order, end): (usize, Lanes),
    room: &mut [Lanes; LENGTH],
) -> ZeroCrossing {
    let mut theta = end;
    let mut found = [false; WIDTH];
    let mut decided = [false; WIDTH];
    let mut guess = [0.0; WIDTH];
    for _ in 0..HALVINGS {
        // Bernstein's coefficients: those of the powers over binomials, added up.
        let mut power = Lanes::all(1.0);
        for k in 0..=order {
            room[k] = c[k] * power * INVERSE_BINOMIAL[order][k];
            power = power * theta;
        }
        for pass in 0..order {
            for k in (pass + 1..=order).rev() {
                room[k] = room[k] + room[k - 1];
            }
        }
        // It begins above zero, or at it and rising.
        let mut changes = [0_u32; WIDTH];
        let mut below = [false; WIDTH];
        let mut places = [0.0; WIDTH];
        let mut before = room[0].max(Lanes::all(0.0));
        for k in 1..=order {
            let now = room[k];
            for i in 0..WIDTH {
                let under = now.0[i] < 0.0;
                if under != below[i] {
                    if changes[i] == 0 {
                        let part = before.0[i] / (before.0[i] - now.0[i]);
                        places[i] = ((k - 1) as f64 + part) / order as f64;
                    }
                    changes[i] += 1;
                    below[i] = under;
                }
            }
            before = now;
        }
        let mut all = true;
        for i in 0..WIDTH {
            if decided[i] {
                continue;
            }
            match changes[i] {
                0 => decided[i] = true,
                1 => {
                    (decided[i], found[i]) = (true, true);
                    guess[i] = places[i] * theta.0[i];
                }
                _ => {
                    theta.0[i] *= 0.5;
                    all = false;
                }
            }
        }
        if all {
            break;
        }
    }
    if !found.iter().any(|f| *f) {
        return ZeroCrossing { theta, found };
    }
    let (mut low, mut high, mut now) = (Lanes::all(0.0), theta, theta);
    for i in 0..WIDTH {
        now.0[i] = if found[i] { guess[i] } else { theta.0[i] };
    }
    // Whatever the others still do, a lane that has settled stays.
    let mut settled = found.map(|found| !found);
    for _ in 0..ITERATIONS {
        let (mut value, mut slope) = (c[order], Lanes::all(0.0));
        for c in c[..order].iter().rev() {
            slope = slope * now + value;
            value = value * now + *c;
        }
        for i in 0..WIDTH {
            let under = value.0[i] < 0.0;
            low.0[i] = if under { low.0[i] } else { now.0[i] };
            high.0[i] = if under { now.0[i] } else { high.0[i] };
            let newton = now.0[i] - value.0[i] / slope.0[i];
            let inside = newton >= low.0[i] && newton <= high.0[i];
            let next = if inside {
                newton
            } else {
                0.5 * (low.0[i] + high.0[i])
            };
            let still = (next - now.0[i]).abs() <= 1e-15 * high.0[i];
            now.0[i] = if settled[i] { now.0[i] } else { next };
            settled[i] |= still;
        }
        if settled.iter().all(|s| *s) {
            break;
        }
    }
    ZeroCrossing { theta: now, found }
}
