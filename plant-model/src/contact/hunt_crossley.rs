//! Hunt and Crossley's contact, f_n = k_h·Aⁿ·(1 + λ·B), and its impacts in closed form.
//!
//! Against the contact force all other forces are neglected, m is the reduced mass of the contact. Then
//! m·B·dB/dA = −k_h·Aⁿ·(1 + λ·B), the variables separate, and from A = 0 with speed v
//!
//! ```text
//! k_h·Aⁿ⁺¹/((n + 1)·m) = G(v) − G(B)        G(x) = ∫₀ˣ B/(1 + λB) dB = (λx − ln(1 + λx))/λ²
//! ```
//!
//! on the way in and out. G(v) = G(−e·v) at A = 0 gives the restitution; neither k_h, n nor m is in it.
//! 1 + λ·B stays positive: B = −1/λ is approached and never reached, so that an impact without other
//! forces leaves no dent.

use super::Normal;
use crate::bisection::bisect;
use crate::params::HuntCrossley;

impl HuntCrossley {
    /// Aⁿ⁻¹.
    #[inline]
    fn power(&self, depth_m: f64) -> f64 {
        if self.exponent == 1.5 {
            depth_m.sqrt()
        } else {
            depth_m.powf(self.exponent - 1.0)
        }
    }

    /// k_h·Aⁿ \[N\], A ≥ 0.
    pub fn spring_n(&self, depth_m: f64) -> f64 {
        self.stiffness_n_mn * self.power(depth_m) * depth_m
    }

    /// ∂f_n/∂A at a depth without damper, n·k_h·Aⁿ⁻¹ \[N/m\].
    pub fn stiffness_n_m(&self, depth_m: f64) -> f64 {
        self.exponent * self.stiffness_n_mn * self.power(depth_m)
    }

    /// The law, continued to A < 0 as an odd function of A: a step looks a little beyond the end of
    /// contact.
    #[inline(never)]
    pub(crate) fn at(&self, penetration_m: f64, penetration_rate_m_s: f64) -> Normal {
        let k = self.stiffness_n_mn * self.power(penetration_m.abs());
        let spring_n = k * penetration_m;
        let share = self.damping_s_m * penetration_rate_m_s;
        let bracket = 1.0 + share;
        // Outside and with a bracket that pulls the product would be positive.
        let sign = if penetration_m < 0.0 && bracket < 0.0 {
            -1.0
        } else {
            1.0
        };
        Normal {
            force_n: spring_n * bracket,
            damper_n: spring_n * share,
            by_depth_n_m: self.exponent * k * bracket,
            by_rate_n_s_m: spring_n * self.damping_s_m,
            guard: sign * penetration_m * bracket,
        }
    }

    /// k_h·Aⁿ⁺¹/(n + 1) \[J\]. Apart, so that it costs a flight by the linear law nothing.
    #[cold]
    #[inline(never)]
    pub(super) fn stored_j(&self, penetration_m: f64) -> f64 {
        let depth_m = penetration_m.abs();
        self.spring_n(depth_m) * depth_m / (self.exponent + 1.0)
    }

    /// Depth A at which k_h·Aⁿ⁺¹/((n + 1)·m) has a value \[m²/s²\].
    fn depth_of(&self, value: f64, contact_mass_kg: f64) -> f64 {
        let power = self.exponent + 1.0;
        (power * contact_mass_kg * value / self.stiffness_n_mn).powf(1.0 / power)
    }

    /// Largest penetration \[m\] of an impact at a speed without damping:
    /// ((n + 1)·m·v²/(2·k_h))^(1/(n + 1)).
    pub(crate) fn undamped_depth_m(&self, speed_m_s: f64, contact_mass_kg: f64) -> f64 {
        self.depth_of(0.5 * speed_m_s * speed_m_s, contact_mass_kg)
    }

    /// Largest penetration \[m\] of an impact at a speed, where k_h·Aⁿ⁺¹/((n + 1)·m) = G(v).
    pub fn depth_m(&self, speed_m_s: f64, contact_mass_kg: f64) -> f64 {
        self.depth_of(travel_m2_s2(speed_m_s, self.damping_s_m), contact_mass_kg)
    }

    /// Largest force \[N\] of an impact at a speed. Its rate ∂f_n/∂A·B + ∂f_n/∂B·Ḃ vanishes at the B with
    /// n·B = λ·(n + 1)·(G(v) − G(B)), found by bisection.
    pub fn peak_force_n(&self, speed_m_s: f64, contact_mass_kg: f64) -> f64 {
        let (n, lambda) = (self.exponent, self.damping_s_m);
        let whole = travel_m2_s2(speed_m_s, lambda);
        let left = |b: f64| whole - travel_m2_s2(b, lambda);
        let b = bisect((0.0, speed_m_s), |b| lambda * (n + 1.0) * left(b) > n * b);
        self.spring_n(self.depth_of(left(b), contact_mass_kg)) * (1.0 + lambda * b)
    }

    /// Duration \[s\] of an impact at a speed without damping:
    /// 2·A_max/v·∫₀¹dx/√(1 − xⁿ⁺¹) = 2·A_max/v·√π·Γ(1 + 1/(n + 1))/Γ(1/2 + 1/(n + 1)), with n = 3/2
    /// 2.943·A_max/v.
    pub fn undamped_contact_s(&self, speed_m_s: f64, contact_mass_kg: f64) -> f64 {
        let q = 1.0 / (self.exponent + 1.0);
        let integral = std::f64::consts::PI.sqrt() * (ln_gamma(1.0 + q) - ln_gamma(0.5 + q)).exp();
        2.0 * self.undamped_depth_m(speed_m_s, contact_mass_kg) / speed_m_s * integral
    }

    /// Restitution e of an impact at a speed.
    pub fn restitution(&self, speed_m_s: f64) -> f64 {
        restitution_of(self.damping_s_m * speed_m_s)
    }

    /// The law with the k_h that makes an impact at a speed as deep as `depth_m`.
    pub fn with_depth(self, depth_m: f64, speed_m_s: f64, contact_mass_kg: f64) -> Self {
        // A_max is in proportion to k_h^(−1/(n + 1)).
        let ratio = self.depth_m(speed_m_s, contact_mass_kg) / depth_m;
        Self {
            stiffness_n_mn: self.stiffness_n_mn * ratio.powf(self.exponent + 1.0),
            ..self
        }
    }

    /// The law with the k_h that gives an impact at a speed the largest force `force_n`.
    pub fn with_peak_force(self, force_n: f64, speed_m_s: f64, contact_mass_kg: f64) -> Self {
        // The force is in proportion to k_h^(1/(n + 1)).
        let ratio = force_n / self.peak_force_n(speed_m_s, contact_mass_kg);
        Self {
            stiffness_n_mn: self.stiffness_n_mn * ratio.powf(self.exponent + 1.0),
            ..self
        }
    }
}

/// G(v) for λ \[m²/s²\].
fn travel_m2_s2(speed_m_s: f64, damping_s_m: f64) -> f64 {
    let half = 0.5 * speed_m_s * speed_m_s;
    half * excess(damping_s_m * speed_m_s)
}

/// 2·(p − ln(1 + p))/p², which is 1 at p = 0.
fn excess(p: f64) -> f64 {
    if p.abs() > 0.1 {
        return 2.0 * (p - p.ln_1p()) / (p * p);
    }
    // 2·Σ (−p)^k/(k + 2): at 0.1 the eighteenth term is 1e-19.
    (0..18)
        .rev()
        .fold(0.0, |sum, k| 2.0 / f64::from(k + 2) - p * sum)
}

/// Restitution e for p = λ·v: p − ln(1 + p) = −e·p − ln(1 − e·p).
///
/// The right side grows with e from zero without bound, so there is one e; e·p < 1.
pub fn restitution_of(damping_times_speed: f64) -> f64 {
    let p = damping_times_speed;
    let square = excess(p);
    bisect((0.0, (1.0 / p).min(1.0)), |e| {
        e * e * excess(-e * p) < square
    })
}

/// λ \[s/m\] that gives the restitution e in (0, 1] at an impact speed \[m/s\], by bisection on the relation
/// of [`restitution_of`].
///
/// Returns `None` for e outside (0, 1] or a speed that is not positive.
pub fn damping_for_restitution(restitution: f64, speed_m_s: f64) -> Option<f64> {
    let e = restitution;
    if !(e > 0.0 && e <= 1.0 && speed_m_s > 0.0 && speed_m_s.is_finite()) {
        return None;
    }
    if e == 1.0 {
        return Some(0.0);
    }
    // e falls with p, and e·p < 1.
    let p = bisect((0.0, 1.0 / e), |p| e * e * excess(-e * p) < excess(p));
    Some(p / speed_m_s)
}

/// k_h \[N/mⁿ\] that makes an undamped impact at a speed as deep as a linear contact of stiffness k_c
/// does: A_max = v·√(m/k_c).
pub fn stiffness_for_depth_of(
    linear_n_m: f64,
    exponent: f64,
    (speed_m_s, contact_mass_kg): (f64, f64),
) -> f64 {
    let depth_m = speed_m_s * (contact_mass_kg / linear_n_m).sqrt();
    undamped(exponent)
        .with_depth(depth_m, speed_m_s, contact_mass_kg)
        .stiffness_n_mn
}

fn undamped(exponent: f64) -> HuntCrossley {
    HuntCrossley {
        stiffness_n_mn: 1.0,
        exponent,
        damping_s_m: 0.0,
    }
}

/// ln Γ(x), x > 0, by Stirling's series from 12 upwards and Γ(x + 1) = x·Γ(x) below.
fn ln_gamma(x: f64) -> f64 {
    if x < 12.0 {
        return ln_gamma(x + 1.0) - x.ln();
    }
    let r = 1.0 / (x * x);
    let series = (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r / 1680.0))) / x;
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hertz: 2.9432·A_max/v; a spring: half a period.
    #[test]
    fn undamped_impacts_take_the_known_time() {
        for (exponent, factor) in [(1.5, 2.943_275_0), (1.0, std::f64::consts::PI)] {
            let law = HuntCrossley {
                stiffness_n_mn: 3e9,
                ..undamped(exponent)
            };
            let depth = law.undamped_depth_m(0.2, 7.0);
            let time = law.undamped_contact_s(0.2, 7.0);
            assert!(
                (time * 0.2 / depth / factor - 1.0).abs() < 1e-6,
                "{}",
                time * 0.2 / depth
            );
            let energy = 0.5 * 7.0 * 0.04;
            assert!((law.stored_j(depth) / energy - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn restitution_and_damping_invert_each_other() {
        for e in [1e-3, 0.01, 0.1, 0.3, 0.7, 0.9, 0.99, 0.999_999, 1.0] {
            for v in [1e-3, 0.2, 30.0] {
                let lambda = damping_for_restitution(e, v).unwrap();
                assert!(
                    (restitution_of(lambda * v) / e - 1.0).abs() < 1e-9,
                    "e = {e}"
                );
            }
        }
        for (e, v) in [
            (0.0, 1.0),
            (1.1, 1.0),
            (f64::NAN, 1.0),
            (0.5, 0.0),
            (0.5, -1.0),
        ] {
            assert_eq!(damping_for_restitution(e, v), None);
        }
        // 1 − e = (2/3)·λ·v to first order.
        assert!(((1.0 - restitution_of(1e-6)) / 1e-6 - 2.0 / 3.0).abs() < 1e-5);
        // Much damping: the rotor leaves at 1/λ.
        assert!((restitution_of(1e8) * 1e8 - 1.0).abs() < 1e-9);
    }

    /// Matching is what it says, with and without damping; without, the closed forms.
    #[test]
    fn stiffness_matches_depth_or_force() {
        let (v, m, k_c) = (0.3, 6.0, 4e8);
        for n in [1.0, 1.2, 1.5, 2.0, 3.0] {
            let k = stiffness_for_depth_of(k_c, n, (v, m));
            let depth = v * (m / k_c).sqrt();
            assert!((k / ((n + 1.0) * m * v * v / 2.0 / depth.powf(n + 1.0)) - 1.0).abs() < 1e-12);
            let law = HuntCrossley {
                damping_s_m: 2.0,
                ..undamped(n)
            };
            let deep = law.with_depth(1e-5, v, m);
            assert!((deep.depth_m(v, m) / 1e-5 - 1.0).abs() < 1e-12);
            let strong = law.with_peak_force(1e4, v, m);
            assert!((strong.peak_force_n(v, m) / 1e4 - 1.0).abs() < 1e-12);
        }
    }

    /// What is no speed has no largest force, and the search for it ends.
    #[test]
    fn no_number_gives_no_number() {
        let law = HuntCrossley {
            damping_s_m: 2.0,
            ..undamped(1.5)
        };
        assert!(law.peak_force_n(f64::NAN, 6.0).is_nan());
        assert!(
            law.with_peak_force(1e4, f64::NAN, 6.0)
                .stiffness_n_mn
                .is_nan()
        );
    }

    /// Slopes against differences, on both sides of the touch; the guard has the sign of the force.
    #[test]
    fn slopes_are_those_of_force_and_guard() {
        for n in [1.0, 1.5, 2.2, 3.0] {
            let law = HuntCrossley {
                stiffness_n_mn: 2e9,
                exponent: n,
                damping_s_m: 1.5,
            };
            for a in [3e-5, 1e-6, -2e-6] {
                for b in [0.4, -0.3, -0.9] {
                    let now = law.at(a, b);
                    let (da, db) = (1e-5 * a.abs(), 1e-5);
                    let slope = |f: fn(&Normal) -> f64, d: [f64; 2], h: f64| {
                        let (up, down) = (law.at(a + d[0], b + d[1]), law.at(a - d[0], b - d[1]));
                        (f(&up) - f(&down)) / (2.0 * h)
                    };
                    let near = |x: f64, y: f64| (x - y).abs() <= 1e-8 * y.abs();
                    assert!(near(slope(|x| x.force_n, [da, 0.0], da), now.by_depth_n_m));
                    assert!(near(slope(|x| x.force_n, [0.0, db], db), now.by_rate_n_s_m));
                    let holds = a > 0.0 && 1.0 + 1.5 * b > 0.0;
                    assert_eq!(now.guard > 0.0, holds);
                    assert!(a < 0.0 || (now.force_n > 0.0) == holds);
                }
            }
        }
    }
}
