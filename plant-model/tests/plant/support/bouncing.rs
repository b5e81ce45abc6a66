//! The benchmark problem of the integrator tests; also compiled by what compares scene files with it.

use plant_model::V2;
use plant_model::params::*;

/// A stiff contact with strong friction and a surface slow enough to reach rolling; passes through
/// flight, slip and roll. Start: [`bouncing_start`].
pub fn bouncing(contact_stiffness_n_m: f64) -> PlantParams {
    let mass_kg = 10.0;
    PlantParams {
        rotor: RotorParams {
            mass_kg,
            stiffness_n_m: 4e5,
            damping_n_s_m: 200.0,
            eccentricity_m: 1e-5,
            contact_radius_m: 2.5e-3,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: 3e-4,
            law: LinearContact {
                stiffness_n_m: contact_stiffness_n_m,
                damping_n_s_m: 0.1 * (contact_stiffness_n_m * mass_kg).sqrt(),
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.3 },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

/// Start of the [`bouncing`] problem.
pub fn bouncing_start() -> Start {
    Start {
        position_m: V2::zeros(),
        velocity_m_s: V2::new(0.3, 0.0),
        spin_rad_s: 400.0,
        spin_phase_rad: 0.0,
    }
}
