//! What a force of limited size can still do against established backward whirl.

use crate::params::PlantParams;
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
/// which is zero at v_lim. Below it the whirl is arrested, above it friction wins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrest {
    /// Radius r of the circle at v_lim \[m\]: the clearance and the penetration N/k_c there, with
    /// N = F/(μ·√(1 + μ²)) by the balance along the wall.
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
    /// For a force F \[N\]; `None` where friction drives nothing, or where the shaft is so stiff against
    /// the wall that no speed is out of reach.
    pub fn new(params: &PlantParams, force_n: f64) -> Option<Self> {
        let friction = &params.friction;
        let mu = friction.sliding.coefficient(0.0) - friction.rolling_coefficient;
        if mu <= 0.0 {
            return None;
        }
        let tilt = (1.0 + mu * mu).sqrt();
        let normal_n = force_n / (mu * tilt);
        let circle = Circle::of(params);
        let radius_m = circle.clearance_m + normal_n / circle.contact_n_m;
        let (m, d, k) = (
            circle.mass_kg,
            params.rotor.damping_n_s_m,
            circle.stiffness_n_m,
        );
        let half = radius_m / (2.0 * mu * m);
        let square = d * d + 4.0 * mu * m * (mu * k * radius_m + force_n * tilt) / radius_m;
        (square > 0.0).then(|| Self {
            radius_m,
            limit_m_s: half * (d + square.sqrt()),
            circle,
            friction: mu,
            damping_n_s_m: d,
            braking_n: force_n * tilt,
            inward_n: force_n * mu / tilt,
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
    /// On a hard wall without shaft and damping it is c/(μ·v_lim)·(atanh(v/v_lim) − atanh(share·v/v_lim)).
    pub fn time_s(&self, from_m_s: f64, share: f64) -> f64 {
        const PANELS: u32 = 64;
        let m = self.circle.mass_kg;
        let start = from_m_s * self.circle.radius_m(from_m_s, 0.0);
        let [first, last] = [start, share * start].map(|l| self.speed_m_s(l));
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
        let (mut low, mut high) = (0.0, 2.0 * momentum_m2_s / self.circle.clearance_m);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if middle * self.circle.radius_m(middle, self.inward_n) < momentum_m2_s {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// What balances on a circle of sliding contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Circle {
    mass_kg: f64,
    stiffness_n_m: f64,
    contact_n_m: f64,
    clearance_m: f64,
}

impl Circle {
    fn of(params: &PlantParams) -> Self {
        Self {
            mass_kg: params.rotor.mass_kg,
            stiffness_n_m: params.rotor.stiffness_n_m,
            contact_n_m: params.contact.stiffness_n_m(),
            clearance_m: params.contact.clearance_m,
        }
    }

    /// (k + k_c)·r² − (k_c·c − F_n)·r − m·v² = 0, F_n inward; the clearance where the wall would have to pull. And
    /// dr/dv.
    fn radius_and_slope(&self, speed_m_s: f64, inward_n: f64) -> (f64, f64) {
        let stiffness = self.stiffness_n_m + self.contact_n_m;
        let linear = self.contact_n_m * self.clearance_m - inward_n;
        let energy = self.mass_kg * speed_m_s * speed_m_s;
        let root = (linear * linear + 4.0 * stiffness * energy).sqrt();
        let radius = (linear + root) / (2.0 * stiffness);
        if radius > self.clearance_m {
            (radius, 2.0 * self.mass_kg * speed_m_s / root)
        } else {
            (self.clearance_m, 0.0)
        }
    }

    fn radius_m(&self, speed_m_s: f64, inward_n: f64) -> f64 {
        self.radius_and_slope(speed_m_s, inward_n).0
    }
}

/// Radius of the circle on which the rotor slides with a tangential speed \[m/s\], its penetration in
/// balance with the centrifugal force, linear contact: (k + k_c)·r² − k_c·c·r − m·v² = 0; the clearance where the
/// shaft is so stiff that the wall would have to pull \[m\].
pub fn circle_radius_m(params: &PlantParams, speed_m_s: f64) -> f64 {
    Circle::of(params).radius_m(speed_m_s, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::*;

    fn rotor(contact_stiffness_n_m: f64) -> PlantParams {
        PlantParams {
            rotor: RotorParams {
                mass_kg: 10.0,
                stiffness_n_m: 0.0,
                damping_n_s_m: 0.0,
                eccentricity_m: 0.0,
                contact_radius_m: 0.05,
            },
            spin: SpinParams::Held,
            stator: StatorParams::Rigid,
            contact: ContactParams {
                clearance_m: 2e-4,
                law: LinearContact {
                    stiffness_n_m: contact_stiffness_n_m,
                    damping_n_s_m: 0.0,
                }
                .into(),
            },
            friction: FrictionParams {
                sliding: SlidingFriction::Constant { coefficient: 0.15 },
                rolling_coefficient: 0.0,
            },
            magnet: None,
            race: None,
        }
    }

    /// √(F·√(1 + μ²)·c/(μm)) on a hard wall, and more on a soft one.
    #[test]
    fn limits_by_hand() {
        let hard = Arrest::new(&rotor(1e18), 1000.0).unwrap();
        let by_hand = (1000.0 * 1.0225_f64.sqrt() * 2e-4 / 1.5).sqrt();
        assert!((hard.limit_m_s / by_hand - 1.0).abs() < 1e-9);
        let soft = Arrest::new(&rotor(1e8), 1000.0).unwrap();
        assert!((soft.limit_m_s - 0.4234).abs() < 1e-4, "{}", soft.limit_m_s);
        let time = hard.time_s(0.5 * by_hand, 0.0);
        assert!((time / (2e-4 / (0.15 * by_hand) * 0.5_f64.atanh()) - 1.0).abs() < 1e-9);
        let part = hard.time_s(0.5 * by_hand, 0.4);
        let logs = 0.5_f64.atanh() - 0.2_f64.atanh();
        assert!((part / (2e-4 / (0.15 * by_hand) * logs) - 1.0).abs() < 1e-9);
    }

    /// The time solves the equation of motion it comes from, damping and shaft included.
    #[test]
    fn time_is_the_integral() {
        let mut params = rotor(2e7);
        (params.rotor.damping_n_s_m, params.rotor.stiffness_n_m) = (300.0, -2e5);
        let (force, mu, m) = (1000.0, 0.15, 10.0_f64);
        let arrest = Arrest::new(&params, force).unwrap();
        let tilt = (1.0_f64 + mu * mu).sqrt();
        // Radius and speed on the circle by fixed-point iteration on r = c + N/k_c, from L.
        let circle = |momentum: f64, inward: f64| {
            let mut r = 2e-4;
            for _ in 0..200 {
                let v = momentum / (m * r);
                r = 0.5 * r + 0.5 * (2e-4 + (m * v * v / r + 2e5 * r - inward) / 2e7);
            }
            (r, momentum / (m * r))
        };
        let from = 0.9 * arrest.limit_m_s;
        let start = m * from * circle_radius_m(&params, from);
        let (n, share) = (20_000, 0.3);
        let step = (1.0 - share) * start / f64::from(n);
        let sum: f64 = (0..n)
            .map(|i| {
                let momentum = share * start + (f64::from(i) + 0.5) * step;
                let (r, v) = circle(momentum, force * mu / tilt);
                let drive = mu * (m * v * v / r + 2e5 * r);
                step / (r * (force * tilt + 300.0 * v - drive))
            })
            .sum();
        let time = arrest.time_s(from, share);
        assert!((time / sum - 1.0).abs() < 1e-6, "{time} {sum}");
    }

    #[test]
    fn circles_balance() {
        let mut params = rotor(1e8);
        params.rotor.stiffness_n_m = -2e5;
        let r = circle_radius_m(&params, 0.3);
        let normal = 1e8 * (r - 2e-4);
        assert!((normal / (10.0 * 0.09 / r + 2e5 * r) - 1.0).abs() < 1e-9);
    }
}
