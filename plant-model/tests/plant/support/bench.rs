//! What the cases share: a mass in a ring, runs that are checked, the impact in closed form.

use std::f64::consts::PI;

use plant_model::contact::{damping_for_restitution, restitution_of};
use plant_model::params::*;
use plant_model::{Inputs, Method, Options, Plant, Snapshot, V2, build};

pub(crate) const RTOL: f64 = 1e-10;

pub(crate) const METHODS: [Method; 2] = [Method::Series, Method::Collocation];
pub(crate) const MASS_KG: f64 = 10.0;
pub(crate) const CLEARANCE_M: f64 = 2e-4;
pub(crate) const RADIUS_M: f64 = 0.1;

/// A mass without a shaft in a rigid ring: between impacts it flies straight.
pub(crate) fn free_mass(
    contact_stiffness_n_m: f64,
    restitution: f64,
    friction: f64,
) -> PlantParams {
    PlantParams {
        rotor: RotorParams {
            mass_kg: MASS_KG,
            stiffness_n_m: 0.0,
            damping_n_s_m: 0.0,
            eccentricity_m: 0.0,
            contact_radius_m: RADIUS_M,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: CLEARANCE_M,
            law: LinearContact {
                stiffness_n_m: contact_stiffness_n_m,
                damping_n_s_m: damping_for_restitution(restitution, contact_stiffness_n_m, MASS_KG)
                    .unwrap(),
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant {
                coefficient: friction,
            },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

pub(crate) fn free_spin(inertia_kg_m2: f64) -> SpinParams {
    SpinParams::Free {
        inertia_kg_m2,
        drive_torque_n_m: 0.0,
    }
}

pub(crate) fn ring(mass_kg: f64, stiffness_n_m: V2, damping_n_s_m: f64) -> RingParams {
    RingParams {
        mass_kg,
        stiffness_n_m,
        damping_n_s_m: V2::repeat(damping_n_s_m),
    }
}

pub(crate) fn start(position_m: V2, velocity_m_s: V2, spin_rad_s: f64) -> Start {
    Start {
        position_m,
        velocity_m_s,
        spin_rad_s,
        spin_phase_rad: 0.0,
    }
}

pub(crate) fn plant(params: &PlantParams, start: &Start, method: Method) -> Plant {
    let options = Options {
        rtol: RTOL,
        method,
        steps_per_sample: 1_000_000,
        steps: 10_000_000,
    };
    build(params, start, options).unwrap()
}

pub(crate) fn load(external_n: V2) -> Inputs {
    Inputs {
        command_n: V2::zeros(),
        external_n,
    }
}

/// Carries the plant on under a load, within its work limit; what it says is finite and the energy
/// audit closes to ten times the tolerance.
pub(crate) fn carry(plant: &mut Plant, t_s: f64, external_n: V2) -> Snapshot {
    carry_with(plant, t_s, external_n, &mut |_| {})
}

pub(crate) fn carry_with(
    plant: &mut Plant,
    t_s: f64,
    external_n: V2,
    on_change: &mut dyn FnMut(&Snapshot),
) -> Snapshot {
    plant.advance(t_s, &load(external_n), on_change).unwrap();
    let now = plant.snapshot();
    let said = [
        now.position_m.norm(),
        now.velocity_m_s.norm(),
        now.inner_ring.position.norm() + now.inner_ring.velocity.norm(),
        now.outer_ring.position.norm() + now.outer_ring.velocity.norm(),
        now.spin_rad_s,
        now.normal_force_n + now.sliding_force_n + now.rolling_force_n,
        now.contact_tangential_speed_m_s,
        plant.meters().peak_contact_force_n,
        plant.audit().turnover_j(),
    ];
    assert!(said.iter().all(|x| x.is_finite()), "{now:?}");
    let (audit, residual) = (plant.audit(), plant.audit().residual());
    let (gap_j, turned_over_j) = (residual * audit.turnover_j(), audit.turnover_j());
    // Energy is known to round-off in the spin, of some ten thousand steps that may all round the same way.
    let round_off_j = 1e-11 * audit.stored_at_start_j.abs();
    assert!(
        gap_j <= 10.0 * RTOL * turned_over_j + round_off_j,
        "residual {residual:e} at {now:?}"
    );
    now
}

/// `got` is `expected` to a relative tolerance.
#[track_caller]
pub(crate) fn near(what: &str, got: f64, expected: f64, tolerance: f64) {
    let off = (got - expected).abs() / expected.abs();
    assert!(
        off <= tolerance,
        "{what}: {got:e} is not {expected:e}, off by {off:e}"
    );
}

/// A head-on impact on the linear contact without any other force, in closed form: with ω = √(k/m),
/// ζ = d/2√(km) and a = acos ζ/√(1 − ζ²) (beyond ζ = 1 acosh ζ/√(ζ² − 1)).
pub(crate) struct HeadOn {
    pub(crate) restitution: f64,
    pub(crate) duration_s: f64,
    pub(crate) peak_penetration_m: f64,
    pub(crate) peak_force_n: f64,
}

pub(crate) fn half_angle(z: f64) -> f64 {
    match z {
        z if (z - 1.0).abs() < 1e-9 => 1.0,
        z if z < 1.0 => z.acos() / (1.0 - z * z).sqrt(),
        z => z.acosh() / (z * z - 1.0).sqrt(),
    }
}

pub(crate) fn head_on(contact: &ContactParams, mass_kg: f64, speed_m_s: f64) -> HeadOn {
    let law = contact.law.linear().unwrap();
    let (k, d) = (law.stiffness_n_m, law.damping_n_s_m);
    let omega = (k / mass_kg).sqrt();
    let z = 0.5 * d / (k * mass_kg).sqrt();
    let a = half_angle(z);
    let peak_force_n = if z < 0.5 {
        let until = 3.0 * a - PI / (1.0 - z * z).sqrt();
        mass_kg * speed_m_s * omega * (-z * until).exp()
    } else {
        d * speed_m_s
    };
    HeadOn {
        restitution: restitution_of(z),
        duration_s: 2.0 * a / omega,
        peak_penetration_m: speed_m_s / omega * (-z * a).exp(),
        peak_force_n,
    }
}
