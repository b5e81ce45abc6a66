//! The paper's two rotors, and the benchmark problem of the integrator tests.

pub use firmware_studies::paper::rotors::footnote_4;
use plant_model::V2;
use plant_model::contact::damping_for_restitution;
use plant_model::params::*;

/// The paper's onset rig: 10 kg at 45 Hz with a damping ratio of 0.003 in a rigid stator with 0.2 mm
/// clearance; μ = 0.125, e = 0.7 at k_c = 1e8 N/m.
pub fn onset_rig() -> PlantParams {
    let mass_kg = 10.0;
    let natural = std::f64::consts::TAU * 45.0;
    let stiffness_n_m = 1e8;
    PlantParams {
        rotor: RotorParams {
            mass_kg,
            stiffness_n_m: mass_kg * natural * natural,
            damping_n_s_m: 2.0 * 0.003 * mass_kg * natural,
            eccentricity_m: 0.0,
            contact_radius_m: 0.1,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: 2e-4,
            law: LinearContact {
                stiffness_n_m,
                damping_n_s_m: damping_for_restitution(0.7, stiffness_n_m, mass_kg)
                    .expect("0.7 is a restitution"),
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.125 },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

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
