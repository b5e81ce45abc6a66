//! What a force of limited size can still do against established backward whirl.

use crate::bisection::bracket;
use crate::params::{ContactLaw, PlantParams};
use crate::quadrature::EIGHT;

/// Sliding whirl on a circle under a force of constant size that brakes best.
///
/// On a radius r the wall presses with N = m·v²/r − k·r − F_n and m·v̇ = μN − d·v − F_t. Of a force F the
/// part along the wall brakes with F_t and the inward part takes μ·F_n of friction drive away, together
/// at best F·√(1 + μ²) at atan μ inward of the tangent, as long as N > 0:
///
/// ```text
/// m·v̇ = μ·(m·v²/r − k·r) − d·v − F·√(1 + μ²)
/// ```
///
/// which is zero at v_lim. Below it the whirl is arrested, above it friction wins. Along the wall the balance there is
/// μN = d·v + F/√(1 + μ²), and the wall yields under N: v_lim, N and r come together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrest {
    /// Radius r of the circle at v_lim \[m\]: the clearance and the penetration under N there.
    pub radius_m: f64,
    /// v_lim \[m/s\].
    pub limit_m_s: f64,
    circle: Circle,
    /// The coefficient that drives.
    friction: f64,
    damping_n_s_m: f64,
    /// F·√(1 + μ²), and its inward part as a force, F·μ/√(1 + μ²).
    braking_n: f64,
    inward_n: f64,
}

impl Arrest {
    /// For a force F \[N\]. `None` without a speed that parts what is arrested from what is not: friction drives
    /// nothing; or a negative stiffness presses the rotor onto the wall so hard that friction wins from rest; or the
    /// damping is so strong against the wall's stiffness, d² ≥ μ²·m·k_c or so, that it wins at any speed.
    pub fn new(params: &PlantParams, force_n: f64) -> Option<Self> {
        let friction = &params.friction;
        let mu = friction.sliding.coefficient(0.0) - friction.rolling_coefficient;
        if mu <= 0.0 {
            return None;
        }
        let tilt = (1.0 + mu * mu).sqrt();
        let inward_n = force_n * mu / tilt;
        let circle = Circle::new(params);
        let d = params.rotor.damping_n_s_m;
        let radius_at = |v: f64| {
            let normal_n = (d * v + force_n / tilt) / mu;
            (circle.clearance_m + circle.law.depth_m(normal_n), normal_n)
        };
        // What holds the rotor on the circle against what it takes: friction wins where the second is more.
        let friction_wins = |v: f64| {
            let (r, normal_n) = radius_at(v);
            circle.mass_kg * v * v > r * (circle.stiffness_n_m * r + inward_n + normal_n)
        };
        let limit_m_s = border(friction_wins)?;
        Some(Self {
            radius_m: radius_at(limit_m_s).0,
            limit_m_s,
            circle,
            friction: mu,
            damping_n_s_m: d,
            braking_n: force_n * tilt,
            inward_n,
        })
    }

    /// Time under the best braking force from the circle at a speed below v_lim until the angular momentum about the
    /// centre has fallen to a share in [0, 1) of what it was \[s\].
    ///
    /// The circle shrinks as the whirl slows, r(v) in balance without waiting, and with L = m·r·v
    ///
    /// ```text
    /// L̇ = r·(μ·(m·v²/r − k·r) − d·v − F·√(1 + μ²))
    /// ```
    ///
    /// On a hard wall without shaft and damping it is c/(μ·v_lim)·(atanh(v/v_lim) − atanh(share·v/v_lim)). The
    /// inward part draws the circle together at the same momentum, so the speed is at once a little higher; infinite
    /// where that is v_lim or more.
    pub fn time_s(&self, from_m_s: f64, share: f64) -> f64 {
        const PANELS: u32 = 64;
        let m = self.circle.mass_kg;
        let start = from_m_s * self.circle.radius_m(from_m_s, 0.0);
        let [first, last] = [start, share * start].map(|l| self.speed_m_s(l));
        if first >= self.limit_m_s {
            return f64::INFINITY;
        }
        let panel = (first - last) / f64::from(PANELS);
        let per_speed = |v: f64| {
            let (r, slope) = self.circle.radius_and_slope(v, self.inward_n);
            let driving = self.friction * (m * v * v / r - self.circle.stiffness_n_m * r);
            let net = self.braking_n + self.damping_n_s_m * v - driving;
            m * (r + v * slope) / (r * net)
        };
        let sum =
            |i: u32| EIGHT.integral(|j| per_speed(last + panel * (f64::from(i) + EIGHT.theta[j])));
        panel * (0..PANELS).map(sum).sum::<f64>()
    }

    /// Speed on the circle under the inward part with an angular momentum per mass \[m²/s\].
    fn speed_m_s(&self, momentum_m2_s: f64) -> f64 {
        let ends = (0.0, 2.0 * momentum_m2_s / self.circle.clearance_m);
        let (_, speed) = bracket(ends, |v| {
            v * self.circle.radius_m(v, self.inward_n) < momentum_m2_s
        });
        speed
    }
}

/// Speed up to which `wins` is false; `None` where it is true at rest or nowhere \[m/s\].
fn border(wins: impl Fn(f64) -> bool) -> Option<f64> {
    if wins(f64::MIN_POSITIVE.sqrt()) {
        return None;
    }
    let mut high = 1.0;
    while !wins(high) {
        high *= 2.0;
        if high > 1e9 {
            return None;
        }
    }
    Some(bracket((0.0, high), |v| !wins(v)).1)
}

/// What balances on a circle of sliding contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Circle {
    mass_kg: f64,
    stiffness_n_m: f64,
    law: ContactLaw,
    clearance_m: f64,
}

impl Circle {
    fn new(params: &PlantParams) -> Self {
        Self {
            mass_kg: params.rotor.mass_kg,
            stiffness_n_m: params.rotor.stiffness_n_m,
            law: params.contact.law,
            clearance_m: params.contact.clearance_m,
        }
    }

    /// f(A) + k·r + F_n = m·v²/r, r = c + A, F_n inward; the clearance where the wall would have to pull. And
    /// dr/dv. With the linear law (k + k_c)·r² − (k_c·c − F_n)·r − m·v² = 0.
    fn radius_and_slope(&self, speed_m_s: f64, inward_n: f64) -> (f64, f64) {
        let energy = self.mass_kg * speed_m_s * speed_m_s;
        let law = match &self.law {
            ContactLaw::Linear(law) => {
                let stiffness = self.stiffness_n_m + law.stiffness_n_m;
                let linear = law.stiffness_n_m * self.clearance_m - inward_n;
                let root = (linear * linear + 4.0 * stiffness * energy).sqrt();
                let radius = (linear + root) / (2.0 * stiffness);
                return if radius > self.clearance_m {
                    (radius, 2.0 * self.mass_kg * speed_m_s / root)
                } else {
                    (self.clearance_m, 0.0)
                };
            }
            ContactLaw::HuntCrossley(law) => law,
        };
        // What presses outwards less what the wall bears.
        let excess = |depth_m: f64| {
            let r = self.clearance_m + depth_m;
            energy / r - self.stiffness_n_m * r - inward_n - law.spring_n(depth_m)
        };
        if excess(0.0) <= 0.0 {
            return (self.clearance_m, 0.0);
        }
        let mut high = self.clearance_m;
        while excess(high) > 0.0 && high < 1e6 * self.clearance_m {
            high *= 2.0;
        }
        let (_, depth_m) = bracket((0.0, high), |depth_m| excess(depth_m) > 0.0);
        let radius = self.clearance_m + depth_m;
        let stiffness =
            law.stiffness_n_m(depth_m) + self.stiffness_n_m + energy / (radius * radius);
        (
            radius,
            2.0 * self.mass_kg * speed_m_s / (radius * stiffness),
        )
    }

    fn radius_m(&self, speed_m_s: f64, inward_n: f64) -> f64 {
        self.radius_and_slope(speed_m_s, inward_n).0
    }
}

/// Radius of the circle on which the rotor slides with a tangential speed \[m/s\], its penetration in
/// balance with the centrifugal force, f(A) + k·r = m·v²/r; the clearance where the shaft is so stiff that the wall would
/// have to pull \[m\].
pub fn circle_radius_m(params: &PlantParams, speed_m_s: f64) -> f64 {
    Circle::new(params).radius_m(speed_m_s, 0.0)
}

#[cfg(test)]
mod tests;
