//! The contact law: the linear one, f_n = k_c·A + d_c·B, eqs (2.8), (2.9), with its restitution, and Hunt
//! and Crossley's.

pub mod ball_bearing;
pub mod hunt_crossley;

use crate::bisection::bracket_until;
use crate::params::{ContactLaw, ContactParams, LinearContact};

/// A dent shallower than this share of the clearance is round-off of a lift-off without one.
pub(crate) const NO_DENT: f64 = 1e-12;

/// Everything that a law says at a penetration A and its rate B.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Normal {
    /// f_n \[N\]; negative where contact has ended.
    pub(crate) force_n: f64,
    /// Its part that takes energy \[N\].
    pub(crate) damper_n: f64,
    /// ∂f_n/∂A and ∂f_n/∂B.
    pub(crate) by_depth_n_m: f64,
    pub(crate) by_rate_n_s_m: f64,
    /// Positive while contact lasts. The force itself where its zero is a simple one, else a function
    /// that has a simple zero where the force ends.
    pub(crate) guard: f64,
}

impl LinearContact {
    /// Normal force \[N\] for a penetration A \[m\] and its rate B \[m/s\]. Negative values mean that
    /// contact has ended: a wall does not pull.
    #[inline]
    pub fn normal_force_n(&self, penetration_m: f64, penetration_rate_m_s: f64) -> f64 {
        self.stiffness_n_m * penetration_m + self.damping_n_s_m * penetration_rate_m_s
    }

    /// Energy in the contact spring \[J\].
    #[inline]
    pub(crate) fn stored_j(&self, penetration_m: f64) -> f64 {
        0.5 * self.stiffness_n_m * penetration_m * penetration_m
    }

    /// The law at a penetration and its rate.
    #[inline]
    pub(crate) fn at(&self, penetration_m: f64, penetration_rate_m_s: f64) -> Normal {
        let damper_n = self.damping_n_s_m * penetration_rate_m_s;
        let force_n = self.stiffness_n_m * penetration_m + damper_n;
        Normal {
            force_n,
            damper_n,
            by_depth_n_m: self.stiffness_n_m,
            by_rate_n_s_m: self.damping_n_s_m,
            guard: force_n,
        }
    }
}

impl ContactLaw {
    /// The linear law, where it is that.
    pub fn linear(&self) -> Option<LinearContact> {
        match self {
            Self::Linear(law) => Some(*law),
            Self::HuntCrossley(_) => None,
        }
    }

    /// The linear law to be changed, where it is that.
    pub fn linear_mut(&mut self) -> Option<&mut LinearContact> {
        match self {
            Self::Linear(law) => Some(law),
            Self::HuntCrossley(_) => None,
        }
    }

    /// Normal force \[N\] for a penetration A \[m\] and its rate B \[m/s\]. Negative values mean that
    /// contact has ended: a wall does not pull.
    #[inline]
    pub fn normal_force_n(&self, penetration_m: f64, penetration_rate_m_s: f64) -> f64 {
        self.at(penetration_m, penetration_rate_m_s).force_n
    }

    /// The law at a penetration and its rate.
    #[inline]
    pub(crate) fn at(&self, penetration_m: f64, penetration_rate_m_s: f64) -> Normal {
        match self {
            Self::Linear(law) => law.at(penetration_m, penetration_rate_m_s),
            Self::HuntCrossley(law) => law.at(penetration_m, penetration_rate_m_s),
        }
    }

    /// Energy in the contact spring \[J\].
    #[inline]
    pub(crate) fn stored_j(&self, penetration_m: f64) -> f64 {
        match self {
            Self::Linear(law) => law.stored_j(penetration_m),
            Self::HuntCrossley(law) => law.stored_j(penetration_m),
        }
    }

    /// Depth A at which the spring bears a force \[N\] ≥ 0 \[m\].
    pub(crate) fn depth_m(&self, force_n: f64) -> f64 {
        match self {
            Self::Linear(law) => force_n / law.stiffness_n_m,
            Self::HuntCrossley(law) => (force_n / law.stiffness_n_mn).powf(1.0 / law.exponent),
        }
    }

    /// ∂f_n/∂B at a depth \[N s/m\].
    pub(crate) fn by_rate_n_s_m(&self, depth_m: f64) -> f64 {
        match self {
            Self::Linear(law) => law.damping_n_s_m,
            Self::HuntCrossley(law) => law.damping_s_m * law.spring_n(depth_m),
        }
    }
}

impl ContactParams {
    /// k_c; where the stiffness grows with the depth, ∂f_n/∂A at a depth of one clearance \[N/m\].
    pub fn stiffness_n_m(&self) -> f64 {
        match &self.law {
            ContactLaw::Linear(law) => law.stiffness_n_m,
            ContactLaw::HuntCrossley(law) => law.stiffness_n_m(self.clearance_m),
        }
    }
}

/// Restitution e of a normal impact with contact damping ratio ζ = d_c/(2√(k_c·m)), contact ending
/// where the force falls to zero: e = exp(−2ζ·acos ζ/√(1 − ζ²)), continued by acosh beyond ζ = 1.
///
/// Derivation: with x(0) = 0 the force vanishes with the acceleration, at ω_d·t = 2·acos ζ, and the
/// velocity there is −v·exp(−ζω·t).
pub fn restitution_of(damping_ratio: f64) -> f64 {
    let z = damping_ratio;
    let near_one = (1.0 - z).abs() < 1e-9;
    let exponent = if near_one {
        2.0
    } else if z < 1.0 {
        2.0 * z * z.acos() / (1.0 - z * z).sqrt()
    } else {
        2.0 * z * z.acosh() / (z * z - 1.0).sqrt()
    };
    (-exponent).exp()
}

/// Contact damping d_c \[N s/m\] that gives the restitution e in (0, 1] for the reduced mass of the
/// contact. Solved by bisection on the exact relation of [`restitution_of`].
///
/// Returns `None` for e outside (0, 1].
pub fn damping_for_restitution(
    restitution: f64,
    stiffness_n_m: f64,
    contact_mass_kg: f64,
) -> Option<f64> {
    if !(restitution > 0.0 && restitution <= 1.0) {
        return None;
    }
    if restitution == 1.0 {
        return Some(0.0);
    }
    // e falls monotonically with ζ, and e < (2ζ)^-2 beyond critical damping.
    let (low, high) = bracket_until(
        (0.0, 1.0 + 1.0 / restitution),
        |low, high| high - low <= 1e-15 * high,
        |ratio| restitution_of(ratio) > restitution,
    );
    Some((low + high) * (stiffness_n_m * contact_mass_kg).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restitution_and_damping_invert_each_other() {
        for e in [0.01, 0.1, (-2.0_f64).exp(), 0.3, 0.7, 0.99, 0.999_999] {
            let (k, m) = (1e8, 10.0);
            let d = damping_for_restitution(e, k, m).unwrap();
            let zeta = d / (2.0 * (k * m).sqrt());
            assert!((restitution_of(zeta) - e).abs() < 1e-9, "e = {e}");
        }
        assert_eq!(damping_for_restitution(1.0, 1e8, 10.0), Some(0.0));
        assert_eq!(damping_for_restitution(0.0, 1e8, 10.0), None);
    }

    #[test]
    fn restitution_is_continuous_at_critical_damping() {
        let at_one = (-2.0_f64).exp();
        for z in [1.0 - 1e-6, 1.0, 1.0 + 1e-6] {
            assert!((restitution_of(z) - at_one).abs() < 1e-5);
        }
    }
}
