//! Rotors of one point mass.

use plant_model::V2;
use plant_model::contact::damping_for_restitution;
use plant_model::params::*;

pub(crate) const MASS_KG: f64 = 10.0;
pub(crate) const CLEARANCE_M: f64 = 2e-4;
pub(crate) const RADIUS_M: f64 = 0.1;

/// The paper's onset rig: 10 kg at 45 Hz with a damping ratio of 0.003 in a rigid stator with 0.2 mm
/// clearance; μ = 0.125, e = 0.7 at k_c = 1e8 N/m.
pub(crate) fn onset_rig() -> PlantParams {
    let natural = std::f64::consts::TAU * 45.0;
    PlantParams {
        rotor: RotorParams {
            mass_kg: MASS_KG,
            stiffness_n_m: MASS_KG * natural * natural,
            damping_n_s_m: 2.0 * 0.003 * MASS_KG * natural,
            eccentricity_m: 0.0,
            contact_radius_m: RADIUS_M,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: CLEARANCE_M,
            law: linear(1e8, 0.7).into(),
        },
        friction: FrictionParams {
            sliding: constant(0.125),
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
    let mut params = free_mass(spring(1e9, 1.6e4), 0.15);
    (params.rotor.stiffness_n_m, params.rotor.damping_n_s_m) = (9.1e5, 20.5);
    params.spin = free_spin(0.05, 0.0);
    params.stator = StatorParams::TwoMass { inner, outer };
    params.friction.rolling_coefficient = 0.025;
    params
}

/// A mass without a shaft in a rigid bore: between impacts it flies straight.
pub(crate) fn free_mass(law: impl Into<ContactLaw>, friction: f64) -> PlantParams {
    let mut params = onset_rig();
    (params.rotor.stiffness_n_m, params.rotor.damping_n_s_m) = (0.0, 0.0);
    params.contact.law = law.into();
    params.friction.sliding = constant(friction);
    params
}

/// Linear contact of a free mass, by its restitution.
pub(crate) fn linear(stiffness_n_m: f64, restitution: f64) -> LinearContact {
    let damping_n_s_m = damping_for_restitution(restitution, stiffness_n_m, MASS_KG);
    spring(stiffness_n_m, damping_n_s_m.expect("it is a restitution"))
}

/// The law of a contact that is linear.
pub(crate) fn law_of(params: &mut PlantParams) -> &mut LinearContact {
    params.contact.law.linear_mut().expect("it is linear")
}

pub(crate) fn free_spin(inertia_kg_m2: f64, drive_torque_n_m: f64) -> SpinParams {
    SpinParams::Free {
        inertia_kg_m2,
        drive_torque_n_m,
    }
}

pub(crate) fn race(inertia_kg_m2: f64, drag_n_m_s: f64, start_spin_rad_s: f64) -> RaceParams {
    RaceParams {
        inertia_kg_m2,
        drag_n_m_s,
        start_spin_rad_s,
    }
}

/// Hunt and Crossley's law of that depth in metres at a speed in m/s, without damping.
pub(crate) fn hertz(exponent: f64, depth_m: f64, speed_m_s: f64, damping_s_m: f64) -> HuntCrossley {
    HuntCrossley {
        damping_s_m,
        ..hardening(1.0, exponent, 0.0).with_depth(depth_m, speed_m_s, MASS_KG)
    }
}

/// Out of round.
pub(crate) fn ellipse(ellipticity: f64, long_axis_rad: f64) -> StatorParams {
    StatorParams::RigidEllipse(EllipseParams {
        ellipticity,
        long_axis_rad,
    })
}

/// A stator of no, one and two rings.
pub(crate) fn stators(inner: RingParams, outer: RingParams) -> [StatorParams; 3] {
    [
        StatorParams::Rigid,
        StatorParams::OneMass(inner),
        StatorParams::TwoMass { inner, outer },
    ]
}

pub(crate) fn spring(stiffness_n_m: f64, damping_n_s_m: f64) -> LinearContact {
    LinearContact {
        stiffness_n_m,
        damping_n_s_m,
    }
}

pub(crate) fn hardening(stiffness_n_mn: f64, exponent: f64, damping_s_m: f64) -> HuntCrossley {
    HuntCrossley {
        stiffness_n_mn,
        exponent,
        damping_s_m,
    }
}

pub(crate) fn constant(coefficient: f64) -> SlidingFriction {
    SlidingFriction::Constant { coefficient }
}

pub(crate) fn falling(at_rest: f64, at_speed: f64, speed_scale_m_s: f64) -> SlidingFriction {
    SlidingFriction::Falling {
        at_rest,
        at_speed,
        speed_scale_m_s,
    }
}

pub(crate) fn magnet_of(force_max_n: f64, lag_s: f64) -> MagnetParams {
    MagnetParams { force_max_n, lag_s }
}
