//! A rotor of 10 kg between two planes. In cylindrical motion it is the point mass of [`bouncing`].

use super::bouncing::bouncing;
use super::plants::spring;
use plant_model::V2;
use plant_model::machine::params::*;
use plant_model::params::*;

pub(crate) const PLAY_M: f64 = 3e-4;

/// A plane with a share of the stiffness and damping of the contact of [`bouncing`].
pub(crate) fn plane(position_m: f64, share: f64) -> MachinePlane {
    let whole = bouncing(1e8);
    let law = spring(share * 1e8, share * 0.1 * 1e9_f64.sqrt());
    MachinePlane {
        position_m,
        centre_m: V2::zeros(),
        radius_m: whole.rotor.contact_radius_m,
        contact: ContactParams {
            law: law.into(),
            ..whole.contact
        },
        friction: whole.friction,
        stator: StatorParams::Rigid,
        race: None,
        load_drag: None,
        heat: None,
    }
}

/// Half of the shaft's stiffness and damping.
pub(crate) fn support(position_m: f64) -> Support {
    held(position_m, 2e5, 100.0)
}

/// The same along x and y.
pub(crate) fn held(position_m: f64, stiffness_n_m: f64, damping_n_s_m: f64) -> Support {
    Support {
        position_m,
        stiffness_n_m: V2::repeat(stiffness_n_m),
        damping_n_s_m: V2::repeat(damping_n_s_m),
        ..Support::default()
    }
}

/// Supports of the same stiffness without damping.
pub(crate) fn undamped(params: &mut MachineParams, stiffness_n_m: f64) {
    for support in &mut params.supports {
        *support = held(support.position_m, stiffness_n_m, 0.0);
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

/// A balanced rotor on two undamped springs, with Ω·I_p/(2·I_t) and the root beside it in its conical frequencies.
pub(crate) fn conical(ratio: f64, spin: f64) -> (MachineParams, f64, f64) {
    let mut params = machine();
    params.rotor = rigid(TRANSVERSE, ratio * TRANSVERSE);
    params.unbalances.clear();
    params.supports = [-ARM_M, ARM_M]
        .map(|z| held(z, STIFFNESS_N_M, 0.0))
        .to_vec();
    let half = 0.5 * spin * ratio;
    let root = (half * half + 2.0 * STIFFNESS_N_M * ARM_M * ARM_M / TRANSVERSE).sqrt();
    (params, half, root)
}

/// Of [`conical`].
pub(crate) const TRANSVERSE: f64 = 0.2;
pub(crate) const ARM_M: f64 = 0.2;
pub(crate) const STIFFNESS_N_M: f64 = 1e6;

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

/// A rotor with bending modes alone beside its rigid ones.
pub(crate) fn modal(rigid: &Rotor, bending: Vec<BendingMode>) -> Rotor {
    Rotor::Modal {
        rigid: *rigid.rigid(),
        bending,
        polar_coupling_kg_m2: vec![],
        damping_n_s_m: vec![],
    }
}

pub(crate) fn magnet(position_m: f64, force_max_n: f64, lag_s: f64) -> MachineMagnet {
    MachineMagnet {
        position_m,
        force_max_n,
        lag_s,
        lag_damping_ratio: None,
        poles: None,
    }
}

/// From the middle, with so much speed of the centre, tilt rate and spin.
pub(crate) fn moving(
    velocity_m_s: [f64; 2],
    tilt_rate_rad_s: [f64; 2],
    spin_rad_s: f64,
) -> MachineStart {
    MachineStart {
        centre_velocity_m_s: velocity_m_s.into(),
        tilt_rate_rad_s: tilt_rate_rad_s.into(),
        spin_rad_s,
        ..MachineStart::default()
    }
}

pub(crate) fn spinning(spin_rad_s: f64) -> MachineStart {
    moving([0.0; 2], [0.0; 2], spin_rad_s)
}

/// At rest, apart from its spin.
pub(crate) fn placed(centre_m: V2, spin_rad_s: f64) -> MachineStart {
    MachineStart {
        centre_m,
        ..spinning(spin_rad_s)
    }
}
