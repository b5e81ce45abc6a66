//! Stiffness of a ball bearing below the race that the rotor touches: Hertz's contacts of its balls, or a measured curve.
//!
//! The rotor on its race is a contact of like cylinders, many times stiffer than the few balls that bear the load; it and the
//! race's mass are left out, and so are the cage and the single balls' inertia.

use crate::params::HuntCrossley;

/// A ball bearing of steel balls in grooves, without internal clearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallBearing {
    /// Number of balls Z in one row, ≥ 3.
    pub balls: u32,
    /// Diameter D of a ball \[m\], > 0.
    pub ball_diameter_m: f64,
    /// Contact angle α \[rad\], 0 to below π/2.
    pub contact_angle_rad: f64,
}

/// Palmgren's constant: a ball of 1 mm gives way between both races by this many mm under 1 N.
const PALMGREN_MM: f64 = 4.36e-4;

/// (1/2π)·∫ cos^{5/2}ψ dψ over the loaded half: mean over the balls of their radial share of the largest load.
const LOADED_HALF: f64 = 0.228_84;

impl BallBearing {
    /// k_h \[N/m^1.5\] of the radial force over the radial deflection, f = k_h·δ^{3/2}:
    ///
    /// ```text
    /// Q = (δ·cos α·cos ψ/4.36e-4)^{3/2}·√D          N, mm: Palmgren, a ball at ψ from the load
    /// f = cos α·Σ Q·cos ψ = 0.2288·Z·cos^{5/2}α·√D·(δ/4.36e-4)^{3/2}
    /// ```
    pub fn stiffness_n_mn(&self) -> f64 {
        let per_ball = (1e3 / PALMGREN_MM).powf(1.5) * (1e3 * self.ball_diameter_m).sqrt();
        LOADED_HALF * f64::from(self.balls) * self.contact_angle_rad.cos().powf(2.5) * per_ball
    }
}

/// f = k_h·δⁿ through a curve, and by how much it misses the forces at most, as a share of each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedCurve {
    /// k_h and n, without damping.
    pub law: HuntCrossley,
    /// Largest miss.
    pub misfit: f64,
}

/// Fits the law to deflections \[m\] and forces \[N\], both > 0 and at least two, by least squares of the logarithms. `None`
/// for other numbers, and where all deflections are one.
pub fn fitted_curve(deflections_m: &[f64], forces_n: &[f64]) -> Option<FittedCurve> {
    let usable = |x: &f64| x.is_finite() && *x > 0.0;
    let count = deflections_m.len();
    if count < 2 || forces_n.len() != count || !deflections_m.iter().chain(forces_n).all(usable) {
        return None;
    }
    let pairs = || deflections_m.iter().zip(forces_n);
    let per = 1.0 / count as f64;
    let mean = |values: &[f64]| per * values.iter().map(|x| x.ln()).sum::<f64>();
    let (x_mean, y_mean) = (mean(deflections_m), mean(forces_n));
    let spread: f64 = pairs().map(|(x, _)| (x.ln() - x_mean).powi(2)).sum();
    let common: f64 = pairs()
        .map(|(x, y)| (x.ln() - x_mean) * (y.ln() - y_mean))
        .sum();
    let exponent = common / spread;
    let law = HuntCrossley {
        stiffness_n_mn: (y_mean - exponent * x_mean).exp(),
        exponent,
        damping_s_m: 0.0,
    };
    let miss = |(x, y): (&f64, &f64)| (law.stiffness_n_mn * x.powf(exponent) / y - 1.0).abs();
    let misfit = pairs().map(miss).fold(0.0, f64::max);
    (law.stiffness_n_mn.is_finite() && exponent.is_finite()).then_some(FittedCurve { law, misfit })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_the_balls_is_that_of_many_single_ones() {
        let bearing = BallBearing {
            balls: 14,
            ball_diameter_m: 7.144e-3,
            contact_angle_rad: 0.3,
        };
        let deflection_m: f64 = 12e-6;
        // Of every position that the ball set may stand in.
        let force_n = |turned: f64| -> f64 {
            let ball = |i: u32| {
                let psi = (f64::from(i) + turned) / 14.0 * std::f64::consts::TAU;
                let normal_mm = 1e3 * deflection_m * 0.3_f64.cos() * psi.cos().max(0.0);
                let load = (normal_mm / 4.36e-4).powf(1.5) * 7.144_f64.sqrt();
                load * psi.cos() * 0.3_f64.cos()
            };
            (0..14).map(ball).sum()
        };
        let law = bearing.stiffness_n_mn() * deflection_m.powf(1.5);
        for turned in [0.0, 0.25, 0.5] {
            assert!((force_n(turned) / law - 1.0).abs() < 2e-3, "{turned}");
        }
    }

    #[test]
    fn a_curve_that_is_a_power_is_found_again() {
        let deflections = [2e-6, 5e-6, 1e-5, 3e-5];
        let forces = deflections.map(|x: f64| 4e9 * x.powf(1.4));
        let fitted = fitted_curve(&deflections, &forces).unwrap();
        assert!((fitted.law.exponent - 1.4).abs() < 1e-12);
        assert!((fitted.law.stiffness_n_mn / 4e9 - 1.0).abs() < 1e-10);
        assert!(fitted.misfit < 1e-12);
        assert_eq!(fitted_curve(&[1e-6, 1e-6], &[1.0, 2.0]), None);
        assert_eq!(fitted_curve(&[1e-6, -2e-6], &[1.0, 2.0]), None);
    }
}
