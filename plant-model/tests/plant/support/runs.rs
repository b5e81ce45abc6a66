//! Runs, some of them checked, and comparisons.

use plant_model::machine::params::{MachineParams, MachineStart};
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Inputs, Method, Options, Plant, Snapshot, V2, build};

/// They share nothing but the equations.
pub(crate) const METHODS: [Method; 2] = [Method::Series, Method::Collocation];

pub(crate) fn options(method: Method, rtol: f64) -> Options {
    Options {
        rtol,
        method,
        ..Options::default()
    }
}

pub(crate) fn series() -> Options {
    options(Method::Series, 1e-12)
}

/// `found` is `expected` to a share of it.
#[track_caller]
pub(crate) fn near(what: &str, found: f64, expected: f64, share: f64) {
    let off = (found - expected).abs() / expected.abs();
    assert!(
        found == expected || off <= share,
        "{what}: {found:e} is not {expected:e}, off by {off:e}"
    );
}

/// `found` is `expected` to a distance.
#[track_caller]
pub(crate) fn close(what: &str, found: V2, expected: V2, distance: f64) {
    let off = (found - expected).norm();
    assert!(
        off <= distance,
        "{what}: {found} is not {expected}, off by {off:e}"
    );
}

/// Energy adds up to a share of what was turned over.
#[track_caller]
pub(crate) fn closes(what: &str, residual: f64, most: f64) {
    assert!(residual <= most, "{what}: {residual:e} of the energy");
}

pub(crate) fn direction(angle_rad: f64) -> V2 {
    V2::new(angle_rad.cos(), angle_rad.sin())
}

pub(crate) fn start(position_m: V2, velocity_m_s: V2, spin_rad_s: f64) -> Start {
    Start {
        position_m,
        velocity_m_s,
        spin_rad_s,
        spin_phase_rad: 0.0,
    }
}

/// A force from outside.
pub(crate) fn load(external_n: V2) -> Inputs {
    Inputs {
        external_n,
        ..Inputs::default()
    }
}

/// Carries a plant on without forces from outside.
#[track_caller]
pub(crate) fn run_to(plant: &mut Plant, t_s: f64) {
    plant.advance(t_s, &Inputs::default(), &mut |_| {}).unwrap();
}

/// The same in samples, up to a time.
pub(crate) fn sampled(plant: &mut Plant, end_s: f64, samples: u32) {
    for i in 1..=samples {
        run_to(plant, end_s * f64::from(i) / f64::from(samples));
    }
}

pub(crate) fn rotor(params: &MachineParams, start: &MachineStart, options: Options) -> Machine {
    Machine::new(params, start, options).unwrap()
}

/// Carries a rotor on without forces from outside.
#[track_caller]
pub(crate) fn advance(rotor: &mut Machine, t_s: f64) {
    let nothing = MachineInputs::default();
    rotor.advance(t_s, &nothing, &mut |_, _| {}).unwrap();
}

/// The same in samples, up to a time.
pub(crate) fn carry_sampled(rotor: &mut Machine, end_s: f64, samples: u32) {
    for i in 1..=samples {
        advance(rotor, end_s * f64::from(i) / f64::from(samples));
    }
}

const RTOL: f64 = 1e-10;

/// A plant for [`carry`].
pub(crate) fn plant(params: &PlantParams, start: &Start, method: Method) -> Plant {
    let options = Options {
        steps_per_sample: 1_000_000,
        ..options(method, RTOL)
    };
    build(params, start, options).unwrap()
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
    let values = [
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
    assert!(values.iter().all(|x| x.is_finite()), "{now:?}");
    let audit = plant.audit();
    let gap_j = audit.residual() * audit.turnover_j();
    // Energy is known to round-off in the spin, of some ten thousand steps that may all round the same way.
    let round_off_j = 1e-11 * audit.stored_at_start_j.abs();
    assert!(
        gap_j <= 10.0 * RTOL * audit.turnover_j() + round_off_j,
        "residual {:e} at {now:?}",
        audit.residual()
    );
    now
}

/// Each of the one with each of the other.
pub(crate) fn each<A: Copy, B: Copy>(one: &[A], other: &[B]) -> Vec<(A, B)> {
    let with_all = |a: &A| other.iter().map(|b| (*a, *b)).collect::<Vec<_>>();
    one.iter().flat_map(with_all).collect()
}

/// Where a function changes its sign between two places at which it differs.
pub(crate) fn root_between([mut low, mut high]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    assert!(sign != f(high).signum(), "no root from {low} to {high}");
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match f(middle).signum() == sign {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}
