//! Largest values over a step of contact, and how far the contact point turns.

use super::readout::ContactMotion;
use super::series::Parts;
use super::system::PlaneData;
use crate::V2;
use crate::bisection::top_between;
use crate::readout::Peaks;
use crate::series::Scalar;
use std::f64::consts::TAU;

/// Share of a largest value below which values at the nodes say that a step has none larger: between two of eight nodes over less
/// than half a vibration it rises by less than a twentieth.
const NEAR_TOP: f64 = 0.9;

impl Parts {
    /// Largest values in a plane up to θ, as far as they may be larger than those so far; `tops` are those at the nodes.
    pub(crate) fn peaks(
        &self,
        (plane, data): (usize, &PlaneData),
        (theta, backward): (f64, f64),
        end: &ContactMotion,
        (tops, so_far): (&Peaks, &Peaks),
    ) -> Peaks {
        let (series, order) = (&self.planes[plane], self.order);
        let bound = |of: &Scalar| of.0[0].abs() + of.reach(theta, order);
        let signed = |sign: f64, (value, slope): (f64, f64)| (sign * value, sign * slope);
        let force = |at: f64| series.force.with_slope(at, order);
        let depth = |at: f64| match &data.bore {
            None => {
                let (distance_m, slope) = series.distance.with_slope(at, order);
                (distance_m - data.clearance_m, slope)
            }
            Some(_) => series.depth.with_slope(at, order),
        };
        let whirl = |at: f64| {
            let (u, w) = (
                series.gap.with_slope(at, order),
                series.gap_rate.with_slope(at, order),
            );
            let distance_m = u.0.norm();
            let speed_m_s = u.0.perp(&w.0) / distance_m;
            let turned = speed_m_s * u.0.dot(&u.1) / (distance_m * distance_m);
            let slope = (u.1.perp(&w.0) + u.0.perp(&w.1)) / distance_m - turned;
            signed(backward, (speed_m_s, slope))
        };
        let ends_n = [series.force.0[0], series.force.at(theta, order)];
        let most_n = (bound(&series.force), so_far.normal_n);
        let normal_n = top(&force, theta, (tops.normal_n, ends_n), most_n);
        let sliding_n = match series.grip.sliding {
            0.0 => {
                let sliding = &series.sliding_n;
                let most_n = bound(sliding);
                [1.0, -1.0]
                    .map(|sign| {
                        let ends_n = [sliding.0[0], sliding.at(theta, order)].map(|end| sign * end);
                        let of = |at: f64| signed(sign, sliding.with_slope(at, order));
                        top(
                            &of,
                            theta,
                            (tops.sliding_n, ends_n),
                            (most_n, so_far.sliding_n),
                        )
                    })
                    .into_iter()
                    .fold(0.0, f64::max)
            }
            share => share.abs() * normal_n,
        };
        let (start_m, most_m) = match &data.bore {
            None => (
                series.distance.0[0] - data.clearance_m,
                bound(&series.distance) - data.clearance_m,
            ),
            Some(_) => (series.depth.0[0], bound(&series.depth)),
        };
        let depths = (tops.penetration_m, [start_m, end.penetration_m]);
        // Where the sliding speed is held, the whirl is as fast as the surfaces are.
        let rolls = series.grip.rolls && !series.grip.turns;
        let most_m_s = if rolls {
            so_far.backward_m_s
        } else {
            f64::INFINITY
        };
        let start_m_s = series.gap.0[0].perp(&series.gap_rate.0[0]) / series.distance.0[0];
        let speeds = [start_m_s, end.whirl_m_s].map(|speed_m_s| backward * speed_m_s);
        let speeds = (tops.backward_m_s, speeds);
        Peaks {
            normal_n,
            penetration_m: top(&depth, theta, depths, (most_m, so_far.penetration_m)),
            sliding_n: sliding_n.min(data.sliding * normal_n.max(0.0)),
            backward_m_s: top(&whirl, theta, speeds, (most_m_s, so_far.backward_m_s)),
        }
    }

    /// By how much the contact point of a plane turns over a step up to its end \[rad\].
    pub(crate) fn turn_rad(&self, plane: usize, end: &ContactMotion, step_s: f64) -> f64 {
        let series = &self.planes[plane];
        let (gap, square) = (series.gap.0[0], series.distance.0[0] * series.distance.0[0]);
        let start = (gap, gap.perp(&series.gap_rate.0[0]) / square);
        turn_rad(start, (end.normal, end.whirl_m_s / end.distance_m), step_s)
    }
}

/// Angle by which a direction turns over a step \[rad\], from direction and rate \[rad/s\] at both ends:
/// whole turns by the mean rate, since a step may take several.
fn turn_rad((a, rate_a): (V2, f64), (b, rate_b): (V2, f64), step_s: f64) -> f64 {
    let part = a.perp(&b).atan2(a.dot(&b));
    let turns = (0.5 * (rate_a + rate_b) * step_s - part) / TAU;
    part + TAU * turns.round()
}

/// Highest value over [0, θ] of what is known with its slope: from the largest at nodes and at both ends, a bound, and the largest
/// so far, below which nothing is looked for.
fn top(
    of: &dyn Fn(f64) -> (f64, f64),
    theta: f64,
    (nodes, ends): (f64, [f64; 2]),
    (bound, so_far): (f64, f64),
) -> f64 {
    let near = nodes.max(ends[0]).max(ends[1]);
    if near < NEAR_TOP * so_far || bound <= so_far {
        return near;
    }
    let end = of(theta);
    // It still rises where it is highest.
    if near == ends[1] && end.1 >= 0.0 {
        return near;
    }
    let start = of(0.0);
    if near == ends[0] && start.1 <= 0.0 {
        return near;
    }
    // At loose tolerances a step may be a little longer than half a vibration, its halves are not.
    let point = |at: f64, (value, slope): (f64, f64)| (at, value, slope);
    let middle = point(0.5 * theta, of(0.5 * theta));
    let first = top_between(of, point(0.0, start), middle);
    first.max(top_between(of, middle, point(theta, end)))
}
