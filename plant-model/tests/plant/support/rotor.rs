//! A rotor of 10 kg between two planes, and the point mass that it is in cylindrical motion.

use plant_model::V2;
use plant_model::machine::params::*;
use plant_model::params::*;

pub(crate) const CLEARANCE_M: f64 = 3e-4;

/// A plane with a share of the contact's stiffness and damping.
pub(crate) fn plane(position_m: f64, share: f64) -> MachinePlane {
    let law = LinearContact {
        stiffness_n_m: share * 1e8,
        damping_n_s_m: share * 0.1 * 1e9_f64.sqrt(),
    };
    MachinePlane {
        position_m,
        centre_m: V2::zeros(),
        radius_m: 2.5e-3,
        contact: ContactParams {
            clearance_m: CLEARANCE_M,
            law: law.into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.3 },
            rolling_coefficient: 0.0,
        },
        stator: StatorParams::Rigid,
        race: None,
        load_drag: None,
        heat: None,
    }
}

/// Half of the shaft's stiffness and damping.
pub(crate) fn support(position_m: f64) -> Support {
    Support {
        position_m,
        stiffness_n_m: V2::repeat(2e5),
        damping_n_s_m: V2::repeat(100.0),
        ..Support::default()
    }
}

pub(crate) fn rigid(transverse: f64, polar: f64) -> Rotor {
    Rotor::Rigid(RigidRotor {
        mass_kg: 10.0,
        transverse_inertia_kg_m2: transverse,
        polar_inertia_kg_m2: polar,
    })
}

/// Two like planes, two like supports, an unbalance of the centre.
pub(crate) fn machine() -> MachineParams {
    MachineParams {
        rotor: rigid(0.2, 0.05),
        supports: vec![support(-0.15), support(0.15)],
        spin: SpinParams::Held,
        eccentricity_m: 0.0,
        unbalances: vec![Unbalance {
            position_m: 0.0,
            moment_kg_m: 10.0 * 1e-5,
            angle_rad: 0.0,
        }],
        magnets: vec![],
        loads_m: vec![],
        probes_m: vec![],
        gravity_m_s2: V2::zeros(),
        planes: vec![plane(-0.2, 0.5), plane(0.2, 0.5)],
    }
}

/// The point mass that this rotor is without tilt.
pub(crate) fn point() -> PlantParams {
    let whole = plane(0.0, 1.0);
    PlantParams {
        rotor: RotorParams {
            mass_kg: 10.0,
            stiffness_n_m: 4e5,
            damping_n_s_m: 200.0,
            eccentricity_m: 1e-5,
            contact_radius_m: whole.radius_m,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: whole.contact,
        friction: whole.friction,
        magnet: None,
        race: None,
    }
}

/// Bending modes with as many nodes as those of a free beam of half a metre.
pub(crate) fn bending(count: usize, first_rad_s: f64) -> Vec<BendingMode> {
    let shape = |nodes: f64| {
        let place = |j: u32| -0.25 + 0.025 * f64::from(j);
        let at = |z: f64| 1.4 * (std::f64::consts::PI * nodes * (z + 0.25) / 0.5).cos();
        (0..=20).map(|j| (place(j), at(place(j)))).collect()
    };
    (0..count)
        .map(|i| BendingMode {
            frequency_rad_s: first_rad_s * (1.0 + i as f64).powf(1.6),
            damping_ratio: 0.01,
            shape: shape((i + 2) as f64),
        })
        .collect()
}
