//! A whole rotor as a linear system, against what can be written down.

use crate::support::*;
use plant_model::machine::linear::{Direction, LinearMachine, MachineMode, Walls};

fn linear(params: &MachineParams) -> LinearMachine {
    LinearMachine::new(params, Walls::Off).unwrap()
}

fn modes(params: &MachineParams, spin_rad_s: f64) -> Vec<MachineMode> {
    linear(params).modes(spin_rad_s).unwrap()
}

/// Critical speeds near this one.
fn critical(linear: &LinearMachine, spin_rad_s: f64) -> Vec<Direction> {
    let speeds = linear.critical_speeds().unwrap();
    let near = speeds
        .iter()
        .filter(|s| (s.spin_rad_s / spin_rad_s - 1.0).abs() < 1e-8);
    near.map(|speed| speed.direction).collect()
}

/// Directions of the modes that turn so fast.
fn turning(modes: &[MachineMode], rate_rad_s: f64) -> Vec<Direction> {
    let near = modes
        .iter()
        .filter(|m| (m.frequency_rad_s / rate_rad_s - 1.0).abs() < 1e-9);
    let mut directions: Vec<Direction> = near.map(|mode| mode.direction).collect();
    directions.sort_by_key(|d| d.name());
    directions
}

const BOTH: [Direction; 2] = [Direction::Backward, Direction::Forward];

/// Conical modes as in `conical_modes_part_with_spin`, with the Jeffcott pair beside them; both senses of the translation are one
/// mixture.
#[test]
fn modes_are_those_of_the_closed_forms() {
    let spin = 800.0;
    let translation = (2.0 * STIFFNESS_N_M / 10.0).sqrt();
    for ratio in [0.05, 0.9, 1.5, 1.9] {
        let (params, half, root) = conical(ratio, spin);
        let found = modes(&params, spin);
        assert_eq!(found.len(), 4);
        assert!(found.iter().all(|m| m.damping_ratio.abs() < 1e-12));
        assert_eq!(turning(&found, half + root), [Direction::Forward]);
        assert_eq!(turning(&found, root - half), [Direction::Backward]);
        assert_eq!(turning(&found, translation), BOTH);
    }
}

/// A damped support damps by d/(2·√(k·m)), a negative stiffness grows by √(k/m), and what nothing holds is at zero.
#[test]
fn modes_tell_damping_and_instability() {
    let mut params = machine();
    let damped = modes(&params, 0.0);
    let expected = 200.0 / (2.0 * (4e5_f64 * 10.0).sqrt());
    let near_it = damped
        .iter()
        .filter(|m| (m.damping_ratio - expected).abs() < 1e-12);
    assert_eq!(near_it.count(), 2, "{damped:?}");
    undamped(&mut params, -2e5);
    let fastest = modes(&params, 0.0)
        .iter()
        .map(|m| m.growth_s)
        .fold(0.0, f64::max);
    let tilt = (4e5 * 0.15 * 0.15 / 0.2_f64).sqrt();
    near("growth", fastest, tilt.max(4e4_f64.sqrt()), 1e-9);
    params.supports.clear();
    for mode in modes(&params, 0.0) {
        let fastest = mode.frequency_rad_s.max(mode.growth_s.abs());
        assert!(fastest < 1e-6, "{mode:?}");
    }
}

/// 1/m + z_a·z_b/I_t: none between planes that are each other's centres of percussion. What controllers of one plane are given: a
/// struck place moves as 1/(1/m + z²/I_t), and a spring there holds it alone.
#[test]
fn planes_feel_each_other_by_their_mobility() {
    let mut params = machine();
    params.rotor = rigid(10.0 * 0.16 * 0.125, 0.0);
    params.planes = vec![plane(-0.16, 1.0), plane(0.125, 1.0)];
    let mobility = linear(&params).mobility();
    assert!(mobility[0][1].abs() < 1e-15 && mobility[1][0].abs() < 1e-15);
    let expected = 0.1 + 0.125 * 0.125 / 0.2;
    assert!((mobility[1][1] - expected).abs() < 1e-15);

    params.supports = vec![support(-0.16), support(0.125)];
    let point = params.point_mass(0.125);
    near("mass", point.mass_kg, 1.0 / expected, 1e-14);
    // The other spring stands at the centre of percussion.
    near("stiffness", point.stiffness_n_m, 2e5, 1e-14);
    near("damping", point.damping_n_s_m, 100.0, 1e-14);
    let rigid = params.rotor.rigid();
    assert!(rigid.lever(-0.16, 0.125).abs() < 1e-15);
    assert!(rigid.lever(-0.3, 0.125) < 0.0 && rigid.lever(0.2, 0.125) > 1.0);
}

/// Translation at √(k/m) both ways; the tilt at √(k_φ/(I_t − I_p)) forward, if it is no disc, and at √(k_φ/(I_t + I_p))
/// backward.
#[test]
fn critical_speeds_are_those_of_the_closed_forms() {
    let tilt = 2.0 * STIFFNESS_N_M * ARM_M * ARM_M / TRANSVERSE;
    let translation = (2.0 * STIFFNESS_N_M / 10.0).sqrt();
    for ratio in [0.05, 0.9, 1.0, 1.5, 1.9] {
        let found = linear(&conical(ratio, 0.0).0);
        let count = found.critical_speeds().unwrap().len();
        assert_eq!(count, if ratio < 1.0 { 4 } else { 3 }, "{ratio}");
        let ways = critical(&found, translation);
        assert!(BOTH.iter().all(|way| ways.contains(way)), "{ways:?}");
        let backward = (tilt / (1.0 + ratio)).sqrt();
        assert!(critical(&found, backward).contains(&Direction::Backward));
        if ratio < 1.0 {
            let forward = (tilt / (1.0 - ratio)).sqrt();
            assert!(critical(&found, forward).contains(&Direction::Forward));
        }
    }
}

/// A free rotor that turns into a disc has a tilt without stiffness and, at its critical speed, without inertia: there is none.
#[test]
fn a_free_disc_has_no_critical_speed() {
    for transverse in [0.01, 0.03, 0.2] {
        for ratio in [0.0, 0.5, 1.0, 2.0] {
            let mut params = machine();
            params.rotor = rigid(transverse, ratio * transverse);
            params.supports.clear();
            let speeds = linear(&params).critical_speeds();
            assert_eq!(speeds, Some(vec![]), "{transverse}, {ratio}");
        }
    }
}

/// A Jeffcott rotor: U·Ω²/|k − m·Ω² + jΩd| below, at and above its critical speed, which is √(k/m).
#[test]
fn unbalance_response_is_that_of_a_jeffcott_rotor() {
    let params = machine();
    let (m, k, d, u) = (10.0, 4e5, 200.0, 10.0 * 1e-5);
    for spin in [50.0, 200.0, 900.0] {
        let found = linear(&params).unbalance_response_m(spin).unwrap();
        let expected = u * spin * spin / (k - m * spin * spin).hypot(spin * d);
        for amplitude in &found[..params.planes.len()] {
            near("amplitude", *amplitude, expected, 1e-12);
        }
    }
    assert!(critical(&linear(&params), f64::sqrt(k / m)).contains(&Direction::Forward));
}

/// Two forces on a rotor that is supported at the same places move it as (S·K⁻¹·Sᵀ) does; contact adds its stiffness.
#[test]
fn receptance_and_contact_are_those_of_springs() {
    let mut params = machine();
    params.planes = [-0.15, 0.15].map(|z| plane(z, 0.5)).to_vec();
    let receptance = linear(&params).receptance(0.0, 0.0).unwrap();
    let (here, far) = (receptance[(0, 0)].re, receptance[(0, 2)].re);
    assert!((here - 1.0 / 2e5).abs() < 1e-17, "{here:e}");
    assert!(far.abs() < 1e-17, "{far:e}");
    let closed = LinearMachine::new(&params, Walls::Closed).unwrap();
    let stiffness: f64 = params
        .planes
        .iter()
        .map(|p| p.contact.stiffness_n_m())
        .sum();
    let rate = ((4e5 + stiffness) / 10.0).sqrt();
    assert_eq!(critical(&closed, rate).len(), 2);
}

/// Springs that differ along x and y: a translation of each, to and fro.
#[test]
fn unequal_supports_part_the_axes() {
    let mut params = machine();
    for support in &mut params.supports {
        (support.stiffness_n_m, support.damping_n_s_m) = (V2::new(2e5, 3e5), V2::zeros());
    }
    let found = modes(&params, 0.0);
    for stiffness in [4e5_f64, 6e5] {
        let rate = (stiffness / 10.0).sqrt();
        assert_eq!(turning(&found, rate), [Direction::Planar]);
    }
}

/// Two like pairs of real and complex rates, at which a search for eigenvalues may go round in circles.
#[test]
fn a_rotor_in_magnets_alone_has_its_modes_at_every_spin() {
    let mut params = machine();
    params.rotor = rigid(0.5, 0.045);
    undamped(&mut params, -1e5);
    let linear = linear(&params);
    // Among them spins so low that pairs are next to alike.
    let low = (0..12).map(|i| 0.3 * 0.1_f64.powi(i));
    for spin in (0..100).map(|i| 35.0 * f64::from(i)).chain(low) {
        let found = linear
            .modes(spin)
            .unwrap_or_else(|| panic!("none at {spin}"));
        let rates: f64 = found.iter().map(|mode| mode.growth_s).sum();
        // They grow and decay alike; and the translations by √(2k/m).
        assert!(rates.abs() < 1e-6, "{rates} at {spin}");
        let grows = (2e5_f64 / 10.0).sqrt();
        let alike = found
            .iter()
            .filter(|m| (m.growth_s / grows - 1.0).abs() < 1e-9);
        assert!(alike.count() >= 2, "{found:?}");
    }
}
