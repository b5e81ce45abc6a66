//! Onset of backward whirl: the tangential speed at which friction outweighs damping.

use crate::params::PlantParams;

/// Critical tangential speed v_t,crit \[m/s\] of sliding whirl on a rigid stator:
/// c·ω0·(D/μ + √(1 + (D/μ)²)) with D = d/(2·m·ω0) and μ the coefficient that drives the whirl, here
/// the coefficient at rest less the rolling coefficient.
///
/// `None` where friction has no threshold to overcome (no restoring stiffness) or drives nothing.
pub fn critical_tangential_speed_m_s(params: &PlantParams) -> Option<f64> {
    let natural = params.natural_frequency_rad_s()?;
    let friction = &params.friction;
    let mu = friction.sliding.coefficient(0.0) - friction.rolling_coefficient;
    if mu <= 0.0 {
        return None;
    }
    let damping_ratio = params.rotor.damping_n_s_m / (2.0 * params.rotor.mass_kg * natural);
    let ratio = damping_ratio / mu;
    Some(params.contact.clearance_m * natural * (ratio + (1.0 + ratio * ratio).sqrt()))
}

/// Speed below which an inward force F can break a whirling contact on a rigid wall \[m/s\]:
/// √(c·(F + k·c)/m); 0 where even at rest it cannot.
pub fn lift_off_speed_m_s(params: &PlantParams, force_n: f64) -> f64 {
    let c = params.contact.clearance_m;
    let inward = force_n + params.rotor.stiffness_n_m * c;
    (c * inward / params.rotor.mass_kg).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::*;

    /// The paper's footnote-4 rotor and its onset rig.
    #[test]
    fn known_thresholds() {
        let mut params = PlantParams {
            rotor: RotorParams {
                mass_kg: 10.0,
                stiffness_n_m: 9.1e5,
                damping_n_s_m: 20.5,
                eccentricity_m: 0.0,
                contact_radius_m: 0.1,
            },
            spin: SpinParams::Held,
            stator: StatorParams::Rigid,
            contact: ContactParams {
                clearance_m: 2e-4,
                stiffness_n_m: 1e9,
                damping_n_s_m: 0.0,
            },
            friction: FrictionParams {
                sliding: SlidingFriction::Constant { coefficient: 0.15 },
                rolling_coefficient: 0.025,
            },
            magnet: None,
        };
        let v = critical_tangential_speed_m_s(&params).unwrap();
        assert!((v - 0.0620).abs() < 5e-5, "{v}");
        params.friction.rolling_coefficient = 0.0;
        let v = critical_tangential_speed_m_s(&params).unwrap();
        assert!((v - 0.0617).abs() < 8e-5, "{v}");
        params.rotor.stiffness_n_m = -1e5;
        assert_eq!(critical_tangential_speed_m_s(&params), None);
    }
}
