//! Runs of a rotor in two planes that end without an error and are wrong all the same: there are none.

use crate::support::reference::{N, Plane, Reference, settled};
use crate::support::rotor::bending;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Method, Options, V2};
use std::f64::consts::TAU;

/// A rotor between two bearings out of line, under gravity and with an unbalance, for both codes.
fn case(bending_modes: usize, stiffness_n_m: f64) -> (MachineParams, Reference) {
    let damping_n_s_m = 0.1 * (stiffness_n_m * 10.0).sqrt();
    let plane = |position_m: f64, centre_m: V2, share: f64| MachinePlane {
        position_m,
        centre_m,
        radius_m: 2.5e-3,
        contact: ContactParams {
            clearance_m: 3e-4,
            law: LinearContact {
                stiffness_n_m: share * stiffness_n_m,
                damping_n_s_m,
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.3 },
            rolling_coefficient: 0.0,
        },
        stator: StatorParams::Rigid,
        race: None,
        load_drag: None,
        heat: None,
    };
    let rigid = RigidRotor {
        mass_kg: 10.0,
        transverse_inertia_kg_m2: 0.15,
        polar_inertia_kg_m2: 0.06,
    };
    let modes = bending(bending_modes, 300.0 * TAU);
    let support = |position_m: f64| Support {
        position_m,
        stiffness_n_m: V2::repeat(2e5),
        damping_n_s_m: V2::repeat(100.0),
        ..Support::default()
    };
    let supports = vec![support(-0.15), support(0.12)];
    let planes = [
        plane(-0.2, V2::new(2e-5, 0.0), 1.0),
        plane(0.18, V2::new(0.0, -3e-5), 0.7),
    ];
    let (spin, unbalance, gravity) = (400.0, (0.05, 1e-4), V2::new(0.0, -9.81));
    let reference = Reference {
        mass_kg: rigid.mass_kg,
        transverse: rigid.transverse_inertia_kg_m2,
        polar: rigid.polar_inertia_kg_m2,
        spin,
        unbalance,
        gravity,
        supports: supports
            .iter()
            .map(|s| (s.position_m, s.stiffness_n_m.x, s.damping_n_s_m.x))
            .collect(),
        planes: planes.map(|p| {
            let law = p.contact.law.linear().unwrap();
            Plane {
                z: p.position_m,
                centre: p.centre_m,
                clearance: p.contact.clearance_m,
                stiffness: law.stiffness_n_m,
                damping: law.damping_n_s_m,
                friction: 0.3,
                radius: p.radius_m,
            }
        }),
        modes: modes
            .iter()
            .map(|m| (m.frequency_rad_s, m.damping_ratio, m.shape.clone()))
            .collect(),
    };
    let params = MachineParams {
        rotor: match bending_modes {
            0 => Rotor::Rigid(rigid),
            _ => Rotor::Modal {
                rigid,
                bending: modes,
                polar_coupling_kg_m2: vec![],
                damping_n_s_m: vec![],
            },
        },
        supports,
        spin: SpinParams::Held,
        eccentricity_m: 0.0,
        unbalances: vec![Unbalance {
            position_m: unbalance.0,
            moment_kg_m: unbalance.1,
            angle_rad: 0.0,
        }],
        magnets: vec![],
        loads_m: vec![],
        probes_m: vec![],
        gravity_m_s2: gravity,
        planes: planes.to_vec(),
    };
    (params, reference)
}

const METHODS: [Method; 2] = [Method::Series, Method::Collocation];
const TOLERANCES: [f64; 4] = [1e-6, 1e-8, 1e-10, 1e-12];

/// Largest error over rtol, clearances, of runs of `duration_s` from `starts` speeds. A run that passes through other modes
/// than the reference fails; starts at which the reference itself does not survive another step are left out.
fn sweep(
    method: Method,
    bending_modes: usize,
    stiffness_n_m: f64,
    starts: u32,
    duration_s: f64,
) -> [f64; TOLERANCES.len()] {
    let (params, reference) = case(bending_modes, stiffness_n_m);
    let step_s = 5e-6 / (stiffness_n_m / 1e8).sqrt();
    let (mut worst, mut left_out, mut changes) = ([0.0_f64; TOLERANCES.len()], 0, 0);
    for i in 0..starts {
        let speed = 0.05 + 0.399 * f64::from(i) / f64::from(starts - 1);
        let mut y = [0.0; 2 * N];
        (y[N], y[N + 2], y[N + 3]) = (speed, 0.4, -1.0);
        let start = MachineStart {
            centre_velocity_m_s: V2::new(speed, 0.0),
            tilt_rate_rad_s: V2::new(0.4, -1.0),
            spin_rad_s: reference.spin,
            ..MachineStart::default()
        };
        let coarse = reference.run(y, duration_s, step_s);
        let (modes, ends) = reference.run(y, duration_s, 0.61 * step_s);
        if coarse.0 != modes || (coarse.1[0] - ends[0]).norm() > 1e-8 {
            left_out += 1;
            continue;
        }
        changes += modes.len();
        for (worst, rtol) in worst.iter_mut().zip(TOLERANCES) {
            let options = Options {
                rtol,
                method,
                ..Options::default()
            };
            let mut machine = Machine::new(&params, &start, options).unwrap();
            let mut seen = vec![];
            let nothing = MachineInputs::default();
            machine
                .advance(duration_s, &nothing, &mut |_, s| {
                    let mut planes = s.planes().map(|p| p.mode);
                    seen.push((s.t_s, [planes.next().unwrap(), planes.next().unwrap()]));
                })
                .unwrap();
            let seen = settled(&seen);
            if seen != modes {
                // A slip that is over before the reference looks again.
                let (finer, _) = reference.run(y, duration_s, step_s / 16.0);
                assert_eq!(seen, finer, "{speed} m/s at {rtol:e}");
            }
            for (plane, end) in machine.snapshot().planes().zip(ends) {
                *worst = worst.max((plane.rotor.position - end).norm() / 3e-4);
            }
            let residual = machine.audit().residual();
            assert!(
                residual < 1e2 * rtol,
                "{speed} m/s at {rtol:e}: {residual:e} of the energy"
            );
        }
    }
    assert!(left_out * 20 <= starts, "{left_out} of {starts} left out");
    assert!(
        changes as u32 > 8 * starts,
        "{changes} changes of mode: nothing happens"
    );
    worst
}

/// Errors follow the tolerance: each hundredfold finer one is at least ten times better, down to what the reference knows.
fn follow(method: Method, worst: [f64; TOLERANCES.len()]) {
    // What bouncing makes of the rounding of a step.
    let floor = if method == Method::Series { 1e-9 } else { 5e-9 };
    for pair in worst.windows(2) {
        assert!(pair[1] < 0.1 * pair[0] || pair[1] < floor, "{worst:?}");
    }
    assert!(
        worst[0] < 1e-2 && worst[TOLERANCES.len() - 1] < 1e-8,
        "{worst:?}"
    );
}

#[test]
fn rigid_rotor() {
    for method in METHODS {
        follow(method, sweep(method, 0, 1e8, 16, 0.05));
    }
}

#[test]
fn four_bending_modes() {
    for method in METHODS {
        follow(method, sweep(method, 4, 1e8, 10, 0.03));
    }
}

#[test]
fn stiff_walls() {
    for method in METHODS {
        follow(method, sweep(method, 0, 1e10, 4, 0.012));
    }
}

/// 400 starts of each, as [the page on accuracy](../../../../docs/src/theory/whole-rotor.md) reports: some ten minutes.
#[test]
#[ignore = "ten minutes"]
fn four_hundred_starts() {
    for bending_modes in [0, 4] {
        for method in METHODS {
            println!(
                "{bending_modes} bending modes, {}: {:?}",
                method.name(),
                sweep(method, bending_modes, 1e8, 400, 0.06)
            );
        }
    }
}
