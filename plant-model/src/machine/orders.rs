//! One order of a plane's series, written out for each order: sums whose length the compiler knows have no loop and no remainder.

use super::plane_series::PlaneSeries;
use crate::V2;
use crate::series::{LENGTH, MAX_ORDER};
use crate::vector::perp;

/// What an order needs beside the series: ρ on the wall, step over k + 1 and its inverse.
#[derive(Clone, Copy)]
pub(super) struct Order {
    pub(super) wall_m: f64,
    pub(super) next: f64,
    pub(super) per_next: f64,
}

type Extends = fn(&mut PlaneSeries, Order);

/// A table over the orders.
macro_rules! by_order {
    ($of:ident, $also:literal) => {
        by_order!(@ $of, $also, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24)
    };
    (@ $of:ident, $also:literal, $($k:literal)*) => { [$($of::<$k, $also>),*] };
    ($of:ident) => {
        by_order!(@ $of, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25)
    };
    (@ $of:ident, $($k:literal)*) => { [$($of::<$k>),*] };
}

const FREE: [Extends; MAX_ORDER + 1] = by_order!(extend, false);
const HELD: [Extends; MAX_ORDER + 1] = by_order!(extend, true);
const CROSSED: [fn(&PlaneSeries) -> f64; LENGTH] = by_order!(crossed);

/// Coefficients k of a touched plane's forces, and k + 1 of its gap and distance; friction that holds is left out.
#[inline]
pub(super) fn extend_touched(plane: &mut PlaneSeries, k: usize, order: Order) {
    let table = if plane.grip.holds { &HELD } else { &FREE };
    table[k](plane, order);
}

/// Coefficient k of u × w.
#[inline]
pub(super) fn whirl_coefficient(plane: &PlaneSeries, k: usize) -> f64 {
    CROSSED[k](plane)
}

fn crossed<const K: usize>(plane: &PlaneSeries) -> f64 {
    let (gap, rate) = (&plane.gap.0, &plane.gap_rate.0);
    let mut sum = V2::zeros();
    for i in 0..=K {
        let (u, w) = (gap[i], rate[K - i]);
        sum += V2::new(u.x * w.y, u.y * w.x);
    }
    sum.x - sum.y
}

fn extend<const K: usize, const HOLDS: bool>(plane: &mut PlaneSeries, order: Order) {
    let (gap, distance) = (&mut plane.gap.0, &mut plane.distance.0);
    let ahead = order.next * plane.gap_rate.0[K];
    gap[K + 1] = ahead;
    // ρ_0·ρ_n = u_0·u_n + ½·Σ (u_i·u_(n−i) − ρ_i·ρ_(n−i)), n = k + 1 and 0 < i < n, by halves.
    let (mut products, mut squares) = (gap[0].component_mul(&ahead), 0.0);
    for i in 1..=K / 2 {
        products += gap[i].component_mul(&gap[K + 1 - i]);
        squares += distance[i] * distance[K + 1 - i];
    }
    if K % 2 == 1 {
        let (u, rho) = (gap[K.div_ceil(2)], distance[K.div_ceil(2)]);
        products += 0.5 * u.component_mul(&u);
        squares += 0.5 * rho * rho;
    }
    let rho = (products.x + products.y - squares) * plane.per_m;
    distance[K + 1] = rho;
    let mut force_n = plane.by_rate_n_s_m * (rho * order.per_next);
    force_n += match K {
        0 => plane.by_depth_n_m * (distance[0] - order.wall_m) + plane.offset_n,
        _ => plane.by_depth_n_m * distance[K],
    };
    plane.force.0[K] = force_n;
    // κ·ρ = f_n, and f_n·r̂ = κ·u.
    let kappa = &mut plane.normal_n_m.0;
    let mut below = 0.0;
    let mut push = V2::zeros();
    for i in 0..K {
        below += kappa[i] * distance[K - i];
        push += kappa[i] * gap[K - i];
    }
    let normal_n_m = (force_n - below) * plane.per_m;
    kappa[K] = normal_n_m;
    push += normal_n_m * gap[0];
    let grip = plane.grip;
    plane.sliding_n_m.0[K] = grip.sliding * normal_n_m;
    plane.rolling_n_m.0[K] = grip.rolling * normal_n_m;
    plane.torque_n = grip.sliding * force_n;
    plane.reaction = (grip.sliding + grip.rolling) * perp(push) - push;
    if HOLDS {
        let held = &mut plane.held_n_m.0;
        held[K] = 0.0;
        let mut pull = V2::zeros();
        for i in 0..K {
            pull += held[i] * gap[K - i];
        }
        plane.reaction += perp(pull);
        if grip.turns && grip.rolls {
            let sliding = &plane.sliding_n_m.0;
            plane.torque_n = (0..K).map(|i| sliding[i] * distance[K - i]).sum();
        }
    }
}
