//! Onset of backward whirl: the tangential speed at which friction outweighs damping.

use crate::params::PlantParams;

/// Critical tangential speed v_t,crit \[m/s\] of sliding whirl on a rigid stator, above which friction
/// μ·(m·v²/c − k·c) outweighs damping d·v: v = a + √(a² + k·c²/m) with a = c·d/(2μm). With a shaft that is
/// c·ω0·(D/μ + √(1 + (D/μ)²)), D = d/(2·m·ω0). μ is the coefficient at rest less the rolling coefficient.
///
/// `None` for a negative stiffness, which presses the rotor onto the wall even at rest, and where
/// friction drives nothing.
pub fn critical_tangential_speed_m_s(params: &PlantParams) -> Option<f64> {
    let mu = driving_coefficient(params);
    let (c, rotor) = (params.contact.clearance_m, &params.rotor);
    if mu <= 0.0 || rotor.stiffness_n_m < 0.0 {
        return None;
    }
    let damped = c * rotor.damping_n_s_m / (2.0 * mu * rotor.mass_kg);
    let shaft = c * c * rotor.stiffness_n_m / rotor.mass_kg;
    Some(damped + (damped * damped + shaft).sqrt())
}

/// The coefficient that drives the whirl: at rest, less the rolling coefficient.
pub(crate) fn driving_coefficient(params: &PlantParams) -> f64 {
    params.friction.sliding.coefficient(0.0) - params.friction.rolling_coefficient
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
                law: LinearContact {
                    stiffness_n_m: 1e9,
                    damping_n_s_m: 0.0,
                }
                .into(),
            },
            friction: FrictionParams {
                sliding: SlidingFriction::Constant { coefficient: 0.15 },
                rolling_coefficient: 0.025,
            },
            magnet: None,
            race: None,
        };
        let v = critical_tangential_speed_m_s(&params).unwrap();
        assert!((v - 0.0620).abs() < 5e-5, "{v}");
        params.friction.rolling_coefficient = 0.0;
        let v = critical_tangential_speed_m_s(&params).unwrap();
        assert!((v - 0.0617).abs() < 8e-5, "{v}");
        // Without a shaft damping alone holds it: μ·m·v²/c = d·v.
        params.rotor.stiffness_n_m = 0.0;
        let v = critical_tangential_speed_m_s(&params).unwrap();
        assert!((v - 2e-4 * 20.5 / (0.15 * 10.0)).abs() < 1e-15);
        params.rotor.stiffness_n_m = -1e5;
        assert_eq!(critical_tangential_speed_m_s(&params), None);
    }
}
