//! A rigid retainer bearing out of round: the rotor's centre may go as far as an ellipse.
//!
//! The normal of the contact is that of the ellipse at the point nearest to the centre, the penetration is the
//! distance from there. Then the contact force is the gradient of the energy of the contact spring, as on a
//! circle, and the normal turns with (tangential speed)/(R + A), R the radius of curvature at that point and A
//! the penetration: R + A takes the place of the distance of the centres.

use crate::V2;
use crate::params::EllipseParams;
use crate::vector::perp;
use std::f64::consts::FRAC_PI_2;

/// The ellipse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ellipse {
    /// Longer semi-axis a, and shorter b \[m\].
    long_m: f64,
    short_m: f64,
    /// Direction of the longer.
    axis: V2,
}

/// The point of the ellipse that is nearest to a centre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClosestPoint {
    /// Outward normal there.
    pub(crate) normal: V2,
    /// How far the centre lies outside \[m\]; negative inside.
    pub(crate) depth_m: f64,
    /// Radius of curvature \[m\].
    pub(crate) radius_m: f64,
}

impl Ellipse {
    pub(crate) fn new(params: &EllipseParams, clearance_m: f64) -> Self {
        let (sin, cos) = params.long_axis_rad.sin_cos();
        Self {
            long_m: clearance_m * (1.0 + params.ellipticity),
            short_m: clearance_m * (1.0 - params.ellipticity),
            axis: V2::new(cos, sin),
        }
    }

    /// The wall nearest to the middle \[m\].
    pub(crate) fn nearest_m(&self) -> f64 {
        self.short_m
    }

    /// Components along the longer and the shorter axis.
    fn along(&self, v: V2) -> V2 {
        V2::new(self.axis.dot(&v), self.axis.perp(&v))
    }

    /// Squeezed so that the ellipse is a circle of a radius: what decides whether the wall is reached. Linear,
    /// so that a polynomial of time stays one.
    pub(crate) fn to_circle(self, v: V2, radius_m: f64) -> V2 {
        let own = self.along(v);
        V2::new(
            own.x * radius_m / self.long_m,
            own.y * radius_m / self.short_m,
        )
    }

    /// The nearest point, to round-off.
    ///
    /// With the normal at an angle ψ to the longer axis, the tangent stands p(ψ) = √(a²cos²ψ + b²sin²ψ) from the
    /// middle. u·n(ψ) − p(ψ) is largest at the nearest point, where it is the depth; its slope is u·t − p′, and
    /// the slope falls with R + depth, R = p + p″ = a²b²/p³. In the quadrant of u there is one such point: Newton's
    /// steps, kept between bounds. From the gradient of the squeezed circle they need two or three near the wall.
    pub(crate) fn closest_point(&self, u: V2) -> ClosestPoint {
        const MOST: usize = 64;
        let (a, b) = (self.long_m, self.short_m);
        let own = self.along(u);
        let first = own.abs();
        let mut angle = (first.y / (b * b)).atan2(first.x / (a * a));
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        let mut at = self.tangent_at(angle);
        for _ in 0..MOST {
            let slope = first.y * at.cos - first.x * at.sin - at.first_m;
            let depth_m = first.x * at.cos + first.y * at.sin - at.support_m;
            if slope >= 0.0 {
                low = angle;
            } else {
                high = angle;
            }
            let step = slope / (at.radius_m + depth_m);
            let next = angle + step;
            let falls = at.radius_m + depth_m > 0.0;
            if falls && step.abs() <= f64::EPSILON {
                break;
            }
            angle = if falls && (low..=high).contains(&next) {
                next
            } else {
                0.5 * (low + high)
            };
            at = self.tangent_at(angle);
        }
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let (sx, sy) = (sign(own.x), sign(own.y));
        let normal = V2::new(sx * at.cos, sy * at.sin);
        ClosestPoint {
            normal: normal.x * self.axis + normal.y * perp(self.axis),
            depth_m: first.x * at.cos + first.y * at.sin - at.support_m,
            radius_m: at.radius_m,
        }
    }

    fn tangent_at(&self, angle_rad: f64) -> Tangent {
        let (a, b) = (self.long_m, self.short_m);
        let (sin, cos) = angle_rad.sin_cos();
        let support_m = (a * a * cos * cos + b * b * sin * sin).sqrt();
        Tangent {
            sin,
            cos,
            support_m,
            first_m: (b * b - a * a) * sin * cos / support_m,
            radius_m: a * a * b * b / (support_m * support_m * support_m),
        }
    }
}

/// The tangent whose normal has an angle to the longer axis.
struct Tangent {
    sin: f64,
    cos: f64,
    /// p, p′ and R = p + p″ \[m\].
    support_m: f64,
    first_m: f64,
    radius_m: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    fn ellipse(ellipticity: f64, long_axis_rad: f64) -> Ellipse {
        let params = EllipseParams {
            ellipticity,
            long_axis_rad,
        };
        Ellipse::new(&params, 2e-4)
    }

    /// The nearest of many points of the ellipse, and whether the centre is outside.
    fn by_search(e: &Ellipse, u: V2) -> f64 {
        let own = e.along(u);
        let away = |t: f64| (own - V2::new(e.long_m * t.cos(), e.short_m * t.sin())).norm();
        let mut best = (f64::INFINITY, 0.0);
        for i in 0..4000 {
            let t = f64::from(i) * FRAC_PI_2 / 1000.0;
            if away(t) < best.0 {
                best = (away(t), t);
            }
        }
        let (mut t, mut width) = (best.1, FRAC_PI_2 / 1000.0);
        while width > 1e-12 {
            for next in [t - width, t + width] {
                if away(next) < away(t) {
                    t = next;
                }
            }
            width *= 0.5;
        }
        let outside = e.to_circle(u, 1.0).norm() > 1.0;
        if outside { away(t) } else { -away(t) }
    }

    /// From the very middle to far outside, on the axes and beside them: the depth is the distance from the
    /// nearest point that a search without derivatives finds.
    #[test]
    fn closest_point_is_the_nearest() {
        for (ellipticity, axis) in [(0.01, 0.0), (0.05, 0.7), (0.2, -2.0)] {
            let e = ellipse(ellipticity, axis);
            for r in [0.0, 1e-7, 0.05, 0.3, 0.7, 0.99, 1.0, 1.001, 1.2, 2.0] {
                for i in 0..48 {
                    let angle = axis + f64::from(i) * std::f64::consts::TAU / 48.0;
                    let u = 2e-4 * r * V2::new(angle.cos(), angle.sin());
                    let closest = e.closest_point(u);
                    let depth = by_search(&e, u);
                    assert!(
                        (closest.depth_m - depth).abs() < 1e-12 * 2e-4 + 1e-7 * depth.abs(),
                        "{ellipticity} {r} {i}: {} {depth}",
                        closest.depth_m
                    );
                    assert!((closest.normal.norm() - 1.0).abs() < 1e-14);
                }
            }
        }
    }

    /// The depth has the normal as its gradient, the normal turns by 1/(R + A) along the wall, and R changes as
    /// it says: central differences around the wall.
    #[test]
    fn normal_and_radius_are_derivatives() {
        let e = ellipse(0.1, 0.4);
        let h = 1e-9;
        for i in 0..64 {
            let angle = 0.05 + f64::from(i) * std::f64::consts::TAU / 64.0;
            let u = 2.05e-4 * V2::new(angle.cos(), angle.sin());
            let closest = e.closest_point(u);
            let tangent = perp(closest.normal);
            let rho = closest.radius_m + closest.depth_m;
            let (there, back) = (
                e.closest_point(u + h * tangent),
                e.closest_point(u - h * tangent),
            );
            assert!((there.depth_m - back.depth_m).abs() / (2.0 * h) < 1e-6);
            let turn = (there.normal - back.normal).dot(&tangent) / (2.0 * h);
            assert!((turn * rho - 1.0).abs() < 1e-6, "{turn} {rho}");
            let out = e.closest_point(u + h * closest.normal).depth_m
                - e.closest_point(u - h * closest.normal).depth_m;
            assert!((out / (2.0 * h) - 1.0).abs() < 1e-6);
        }
    }

    /// Without ellipticity it is the circle, and the squeezed wall is one always.
    #[test]
    fn round_is_round() {
        let round = ellipse(0.0, 0.3);
        let u = V2::new(1.5e-4, -1.6e-4);
        let closest = round.closest_point(u);
        assert!((closest.depth_m - (u.norm() - 2e-4)).abs() < 1e-19);
        assert!((closest.normal - u.normalize()).norm() < 1e-15);
        assert!((closest.radius_m - 2e-4).abs() < 1e-18);
        let e = ellipse(0.1, FRAC_PI_4);
        for i in 0..16 {
            let t = f64::from(i);
            let on = e.long_m * t.cos() * e.axis + e.short_m * t.sin() * perp(e.axis);
            assert!((e.to_circle(on, 3.0).norm() - 3.0).abs() < 1e-14);
            assert!(e.closest_point(on).depth_m.abs() < 1e-18);
        }
    }
}
