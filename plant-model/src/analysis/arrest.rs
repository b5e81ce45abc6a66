//! What a force of limited size can still do against established backward whirl.

use crate::params::PlantParams;

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
    /// The coefficient that drives.
    friction: f64,
    /// The other root of v̇ = 0, not positive \[m/s\].
    other_root_m_s: f64,
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
        let radius_m = params.contact.clearance_m + normal_n / params.contact.stiffness_n_m();
        let (m, d, k) = (
            params.rotor.mass_kg,
            params.rotor.damping_n_s_m,
            params.rotor.stiffness_n_m,
        );
        let half = radius_m / (2.0 * mu * m);
        let square = d * d + 4.0 * mu * m * (mu * k * radius_m + force_n * tilt) / radius_m;
        (square > 0.0).then(|| Self {
            radius_m,
            limit_m_s: half * (d + square.sqrt()),
            friction: mu,
            other_root_m_s: half * (d - square.sqrt()),
        })
    }

    /// Time from a speed below v_lim down to another under the best braking force \[s\].
    ///
    /// v̇ = (μ/r)·(v − v_lim)·(v − v₂) gives t = r/(μ·(v_lim − v₂))·ln of the ratio below; without damping
    /// v₂ = −v_lim and it is r/(μ·v_lim)·(atanh(v/v_lim) − atanh(v'/v_lim)).
    pub fn time_s(&self, from_m_s: f64, to_m_s: f64) -> f64 {
        let (limit, other) = (self.limit_m_s, self.other_root_m_s);
        let ratio = |v: f64| (v - other) / (limit - v);
        self.radius_m / (self.friction * (limit - other)) * (ratio(from_m_s) / ratio(to_m_s)).ln()
    }
}

/// Radius of the circle on which the rotor slides with a tangential speed \[m/s\], its penetration in
/// balance with the centrifugal force, linear contact: (k + k_c)·r² − k_c·c·r − m·v² = 0 \[m\].
pub fn circle_radius_m(params: &PlantParams, speed_m_s: f64) -> f64 {
    let (k, k_c) = (params.rotor.stiffness_n_m, params.contact.stiffness_n_m());
    let (c, m) = (params.contact.clearance_m, params.rotor.mass_kg);
    let linear = k_c * c;
    let square = linear * linear + 4.0 * (k + k_c) * m * speed_m_s * speed_m_s;
    (linear + square.sqrt()) / (2.0 * (k + k_c))
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
    }

    /// The time solves the equation of motion it comes from, damping and shaft included.
    #[test]
    fn time_is_the_integral() {
        let mut params = rotor(1e9);
        (params.rotor.damping_n_s_m, params.rotor.stiffness_n_m) = (300.0, -2e5);
        let (force, mu, m) = (1000.0, 0.15, 10.0);
        let arrest = Arrest::new(&params, force).unwrap();
        let (from, to) = (0.9 * arrest.limit_m_s, 0.1 * arrest.limit_m_s);
        let deceleration = |v: f64| {
            let r = arrest.radius_m;
            let drive = mu * (m * v * v / r + 2e5 * r);
            (force * (1.0 + mu * mu).sqrt() + 300.0 * v - drive) / m
        };
        assert!(deceleration(arrest.limit_m_s * (1.0 + 1e-9)).abs() < 1e-3);
        let n = 20_000;
        let step = (from - to) / f64::from(n);
        let sum: f64 = (0..n)
            .map(|i| step / deceleration(to + (f64::from(i) + 0.5) * step))
            .sum();
        let time = arrest.time_s(from, to);
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
