//! Motions of a whole rotor that can be written down.

use crate::support::rotor::*;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Options, V2};

const OPTIONS: Options = Options {
    rtol: 1e-12,
    method: plant_model::Method::Series,
    steps_per_sample: 200_000,
    steps: 50_000_000,
};

pub(crate) const TRANSVERSE: f64 = 0.2;
pub(crate) const ARM_M: f64 = 0.2;
pub(crate) const STIFFNESS_N_M: f64 = 1e6;

/// A balanced rotor on two undamped springs, with Ω·I_p/(2·I_t) and the root beside it in its conical frequencies.
pub(crate) fn conical(ratio: f64, spin: f64) -> (MachineParams, f64, f64) {
    let mut params = machine();
    params.rotor = rigid(TRANSVERSE, ratio * TRANSVERSE);
    params.unbalances.clear();
    params.supports = [-ARM_M, ARM_M]
        .map(|position_m| Support {
            position_m,
            stiffness_n_m: V2::repeat(STIFFNESS_N_M),
            ..Support::default()
        })
        .to_vec();
    let half = 0.5 * spin * ratio;
    let root = (half * half + 2.0 * STIFFNESS_N_M * ARM_M * ARM_M / TRANSVERSE).sqrt();
    (params, half, root)
}

/// ω = Ω·I_p/(2·I_t) ± √((Ω·I_p/(2·I_t))² + k_φ/I_t), forward and backward, to many periods.
#[test]
fn conical_modes_part_with_spin() {
    let spin = 800.0;
    for ratio in [0.05, 0.3, 0.9, 1.0, 1.5, 1.9] {
        let (params, half, root) = conical(ratio, spin);
        for omega in [half + root, half - root] {
            let amplitude = 1e-4;
            let start = MachineStart {
                tilt_rad: V2::new(amplitude, 0.0),
                tilt_rate_rad_s: V2::new(0.0, amplitude * omega),
                spin_rad_s: spin,
                ..MachineStart::default()
            };
            let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
            rotor
                .advance(1.0, &MachineInputs::default(), &mut |_, _| {})
                .unwrap();
            let at = rotor.snapshot().planes().next().unwrap().rotor.position / -ARM_M;
            let off = (at / amplitude - V2::new(omega.cos(), omega.sin())).norm();
            // Round-off of some thousand radians.
            assert!(off < 1e-10, "I_p/I_t {ratio}, {omega} rad/s: {off:e}");
            assert!(rotor.audit().residual() < 1e-11);
        }
    }
}

/// Without stiffness a tilt rate goes round forward at Ω·I_p/I_t, and while the spin falls by the angle it has turned through.
#[test]
fn nutation_follows_the_spin() {
    let mut params = machine();
    params.rotor = rigid(0.2, 0.3);
    params.supports.clear();
    params.unbalances.clear();
    params.spin = SpinParams::Free {
        inertia_kg_m2: 0.5,
        drive_torque_n_m: -200.0,
    };
    let start = MachineStart {
        tilt_rate_rad_s: V2::new(0.01, 0.0),
        spin_rad_s: 500.0,
        ..MachineStart::default()
    };
    let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
    rotor
        .advance(0.5, &MachineInputs::default(), &mut |_, _| {})
        .unwrap();
    let now = rotor.snapshot();
    assert!((now.spin_rad_s - 300.0).abs() < 1e-9);
    let turned = 1.5 * (500.0 * 0.5 - 0.5 * 400.0 * 0.25);
    let rate = now.planes().next().unwrap().rotor.velocity / -0.2;
    let off = (rate / 0.01 - V2::new(f64::cos(turned), f64::sin(turned))).norm();
    assert!(off < 1e-11, "{off:e}");
    assert!(rotor.audit().residual() < 1e-12);
}

/// An unbalance off the centre of mass turns the rotor about both: forced response of a rigid rotor on two springs.
#[test]
fn unbalance_off_the_centre_gives_its_forced_response() {
    let (spin, z, moment) = (300.0_f64, 0.07, 2e-5);
    let mut params = machine();
    for support in &mut params.supports {
        support.damping_n_s_m = V2::zeros();
    }
    params.unbalances = vec![Unbalance {
        position_m: z,
        moment_kg_m: moment,
        angle_rad: 0.4,
    }];
    let force = moment * spin * spin;
    let centre = force / (4e5 - 10.0 * spin * spin);
    // I_t·φ̈ + I_p·Ω·ψ̇ + k_φ·φ of a circle at Ω: (k_φ − (I_t − I_p)·Ω²)·tilt.
    let tilt = z * force / (4e5 * 0.15 * 0.15 - (0.2 - 0.05) * spin * spin);
    let direction = |angle: f64| V2::new(angle.cos(), angle.sin());
    let start = MachineStart {
        centre_m: centre * direction(0.4),
        centre_velocity_m_s: centre * spin * direction(0.4 + std::f64::consts::FRAC_PI_2),
        tilt_rad: tilt * direction(0.4),
        tilt_rate_rad_s: tilt * spin * direction(0.4 + std::f64::consts::FRAC_PI_2),
        spin_rad_s: spin,
        ..MachineStart::default()
    };
    let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
    rotor
        .advance(0.3, &MachineInputs::default(), &mut |_, _| {})
        .unwrap();
    for (snapshot, position_m) in rotor.snapshot().planes().zip([-0.2, 0.2]) {
        let expected = (centre + position_m * tilt) * direction(0.4 + 0.3 * spin);
        let off = (snapshot.rotor.position - expected).norm() / centre.abs();
        assert!(off < 1e-10, "{position_m} m: {off:e}");
    }
}

/// Whole samples of the same length become a matrix; cut in two unequal parts they stay series. Both go the same way.
#[test]
fn a_map_of_whole_samples_changes_nothing() {
    let mut params = machine();
    params.rotor = Rotor::Modal {
        rigid: *rigid(0.2, 0.3).rigid(),
        bending: bending(4, 1900.0),
        polar_coupling_kg_m2: {
            let mut coupling = vec![0.0; 25];
            (coupling[1], coupling[5], coupling[6]) = (0.2, 0.2, 0.5);
            coupling
        },
        damping_n_s_m: {
            // Of a damper somewhere along the shaft.
            let moved = [1.0, 0.05, 0.7, -0.4, 0.2, 0.1];
            let both = moved.iter().flat_map(|a| moved.map(|b| 40.0 * (a * b)));
            both.collect()
        },
    };
    let ring = RingParams {
        mass_kg: 2.0,
        stiffness_n_m: V2::new(2e7, 3e7),
        damping_n_s_m: V2::new(3000.0, 500.0),
    };
    params.planes[1].stator = StatorParams::OneMass(ring);
    params.planes[0].race = Some(RaceParams {
        inertia_kg_m2: 1e-5,
        drag_n_m_s: 1e-5,
        start_spin_rad_s: 300.0,
    });
    let magnet = |position_m: f64, lag_s: f64| MachineMagnet {
        position_m,
        force_max_n: 500.0,
        lag_s,
        lag_damping_ratio: None,
        poles: None,
    };
    params.magnets = vec![magnet(-0.12, 2e-4), magnet(0.14, 0.0)];
    params.loads_m = vec![0.2];
    params.gravity_m_s2 = V2::new(0.0, -1.0);
    let start = MachineStart {
        centre_m: V2::new(2e-5, 1e-5),
        tilt_rate_rad_s: V2::new(0.02, 0.01),
        spin_rad_s: 700.0,
        ..MachineStart::default()
    };
    let run = |cut: bool| {
        let mut rotor = Machine::new(&params, &start, OPTIONS).unwrap();
        for i in 0..2000 {
            let (angle, t) = (0.01 * f64::from(i), f64::from(i) * 5e-5);
            let inputs = MachineInputs {
                commands_n: vec![
                    V2::new(10.0 * angle.cos(), 8.0),
                    V2::new(-10.0, 15.0 * angle.sin()),
                ],
                loads_n: vec![V2::new(5.0 * angle.sin(), 0.0)],
            };
            for end in if cut {
                vec![t + 2e-5, t + 5e-5]
            } else {
                vec![t + 5e-5]
            } {
                rotor.advance(end, &inputs, &mut |_, _| {}).unwrap();
            }
        }
        rotor
    };
    let (mut whole, mut cut) = (run(false), run(true));
    assert!(
        whole.work().evaluations < cut.work().evaluations / 5,
        "{:?}, {:?}",
        whole.work(),
        cut.work()
    );
    for (a, b) in whole.snapshot().planes().zip(cut.snapshot().planes()) {
        let off = (a.rotor.position - b.rotor.position).norm()
            + (a.ring.position - b.ring.position).norm();
        assert!(off < 1e-12 * CLEARANCE_M, "{off:e} m");
        assert!((a.race_spin_rad_s - b.race_spin_rad_s).abs() < 1e-9);
    }
    let (a, b) = (whole.audit(), cut.audit());
    assert!(a.residual() < 1e-13, "{:e}", a.residual());
    for (name, x, y) in [
        ("control", a.flows.control, b.flows.control),
        ("external", a.flows.external, b.flows.external),
        ("unbalance", a.flows.unbalance, b.flows.unbalance),
        ("damping", a.flows.rotor_damping, b.flows.rotor_damping),
        ("drag", a.flows.stator_damping, b.flows.stator_damping),
    ] {
        assert!(
            (x - y).abs() < 1e-12 * b.turnover_j() && x != 0.0,
            "{name}: {x:e} J, {y:e} J"
        );
    }
}
