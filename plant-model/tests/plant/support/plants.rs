//! Two rotors of one point mass.

use plant_model::V2;
use plant_model::contact::damping_for_restitution;
use plant_model::params::*;

/// The paper's onset rig: 10 kg at 45 Hz with a damping ratio of 0.003 in a rigid stator with 0.2 mm
/// clearance; μ = 0.125, e = 0.7 at k_c = 1e8 N/m.
pub(crate) fn onset_rig() -> PlantParams {
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

/// A ring that is the same along x and y.
pub(crate) fn ring(mass_kg: f64, stiffness_n_m: f64, damping_n_s_m: f64) -> RingParams {
    RingParams {
        mass_kg,
        stiffness_n_m: V2::repeat(stiffness_n_m),
        damping_n_s_m: V2::repeat(damping_n_s_m),
    }
}

/// The rings of [`footnote_4`], inner and outer.
pub(crate) fn two_rings() -> [RingParams; 2] {
    [ring(10.0, 8.9e8, 28_300.0), ring(10.0, 3.6e9, 18_970.0)]
}

/// The rotor of the paper's footnote 4: a free spin, a stator of two rings, rolling friction.
pub(crate) fn footnote_4() -> PlantParams {
    let [inner, outer] = two_rings();
    PlantParams {
        rotor: RotorParams {
            mass_kg: 10.0,
            stiffness_n_m: 9.1e5,
            damping_n_s_m: 20.5,
            eccentricity_m: 0.0,
            contact_radius_m: 0.1,
        },
        spin: SpinParams::Free {
            inertia_kg_m2: 0.05,
            drive_torque_n_m: 0.0,
        },
        stator: StatorParams::TwoMass { inner, outer },
        contact: ContactParams {
            clearance_m: 2e-4,
            law: LinearContact {
                stiffness_n_m: 1e9,
                damping_n_s_m: 1.6e4,
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.15 },
            rolling_coefficient: 0.025,
        },
        magnet: None,
        race: None,
    }
}
