//! A whole rotor as a linear system, against what can be written down.

use crate::rotor_closed_forms::{ARM_M, STIFFNESS_N_M, TRANSVERSE, conical};
use crate::support::rotor::*;
use plant_model::V2;
use plant_model::machine::linear::{Direction, LinearMachine, Walls};
use plant_model::machine::params::*;

fn linear(params: &MachineParams) -> LinearMachine {
    LinearMachine::new(params, Walls::Off).unwrap()
}

/// The same frequencies and senses from the eigenvalues, with the Jeffcott pair beside them.
#[test]
fn modes_are_those_of_the_closed_forms() {
    let spin = 800.0;
    for ratio in [0.05, 0.9, 1.5, 1.9] {
        let (params, half, root) = conical(ratio, spin);
        let translation = (2.0 * STIFFNESS_N_M / 10.0).sqrt();
        let found = linear(&params).modes(spin).unwrap();
        assert_eq!(found.len(), 4);
        for (expected, direction) in [
            (half + root, Direction::Forward),
            (root - half, Direction::Backward),
        ] {
            let near = found.iter().find(|mode| {
                (mode.frequency_rad_s - expected).abs() < 1e-9 * expected
                    && mode.direction == direction
            });
            let mode = near.unwrap_or_else(|| panic!("{expected}: {found:?}"));
            assert!(mode.damping_ratio.abs() < 1e-12);
        }
        let translations = found
            .iter()
            .filter(|mode| (mode.frequency_rad_s - translation).abs() < 1e-9 * translation);
        let mut senses: Vec<Direction> = translations.map(|mode| mode.direction).collect();
        senses.sort_by_key(|d| d.name());
        // Both senses of the translation are one mixture.
        assert_eq!(senses, [Direction::Backward, Direction::Forward]);
    }
}

/// A damped support damps by d/(2·√(k·m)), a negative stiffness grows by √(k/m), and what nothing holds is at zero.
#[test]
fn modes_tell_damping_and_instability() {
    let mut params = machine();
    let damped = linear(&params).modes(0.0).unwrap();
    let expected = 200.0 / (2.0 * (4e5_f64 * 10.0).sqrt());
    let near = damped
        .iter()
        .filter(|m| (m.damping_ratio - expected).abs() < 1e-12);
    assert_eq!(near.count(), 2, "{damped:?}");
    for support in &mut params.supports {
        (support.stiffness_n_m, support.damping_n_s_m) = (V2::repeat(-2e5), V2::zeros());
    }
    let grows = linear(&params).modes(0.0).unwrap();
    let fastest = grows.iter().map(|m| m.growth_s).fold(0.0, f64::max);
    let tilt = (4e5 * 0.15 * 0.15 / 0.2_f64).sqrt();
    assert!(
        (fastest - tilt.max(4e4_f64.sqrt())).abs() < 1e-9 * fastest,
        "{grows:?}"
    );
    params.supports.clear();
    for mode in linear(&params).modes(0.0).unwrap() {
        assert!(
            mode.frequency_rad_s < 1e-6 && mode.growth_s.abs() < 1e-6,
            "{mode:?}"
        );
    }
}

/// 1/m + z_a·z_b/I_t: none between planes that are each other's centres of percussion.
#[test]
fn planes_feel_each_other_by_their_mobility() {
    let mut params = machine();
    params.rotor = rigid(10.0 * 0.16 * 0.125, 0.0);
    params.planes = vec![plane(-0.16, 1.0), plane(0.125, 1.0)];
    let mobility = linear(&params).mobility();
    assert!(mobility[0][1].abs() < 1e-15 && mobility[1][0].abs() < 1e-15);
    let expected = 0.1 + 0.125 * 0.125 / 0.2;
    assert!((mobility[1][1] - expected).abs() < 1e-15);
}

/// Translation at √(k/m) both ways; the tilt at √(k_φ/(I_t − I_p)) forward, if it is no disc, and at √(k_φ/(I_t + I_p))
/// backward.
#[test]
fn critical_speeds_are_those_of_the_closed_forms() {
    for ratio in [0.05, 0.9, 1.0, 1.5, 1.9] {
        let (params, ..) = conical(ratio, 0.0);
        let tilt = 2.0 * STIFFNESS_N_M * ARM_M * ARM_M / TRANSVERSE;
        let translation = (2.0 * STIFFNESS_N_M / 10.0).sqrt();
        let mut expected = vec![
            (translation, Direction::Backward),
            (translation, Direction::Forward),
            ((tilt / (1.0 + ratio)).sqrt(), Direction::Backward),
        ];
        if ratio < 1.0 {
            expected.push(((tilt / (1.0 - ratio)).sqrt(), Direction::Forward));
        }
        let found = linear(&params).critical_speeds().unwrap();
        assert_eq!(found.len(), expected.len(), "{ratio}: {found:?}");
        for (spin, direction) in expected {
            let near = found.iter().any(|speed| {
                (speed.spin_rad_s - spin).abs() < 1e-8 * spin && speed.direction == direction
            });
            assert!(near, "{ratio}, {spin} {direction:?}: {found:?}");
        }
    }
}

/// A Jeffcott rotor: U·Ω²/|k − m·Ω² + jΩd| below, at and above its critical speed, which is √(k/m).
/// A free rotor that turns into a disc has a tilt without stiffness and, at its critical speed, without inertia: there is none.
#[test]
fn a_free_disc_has_no_critical_speed() {
    for transverse in [0.01, 0.03, 0.2] {
        for ratio in [0.0, 0.5, 1.0, 2.0] {
            let mut params = machine();
            params.rotor = rigid(transverse, ratio * transverse);
            params.supports.clear();
            assert_eq!(
                linear(&params).critical_speeds(),
                Some(vec![]),
                "{transverse}, {ratio}"
            );
        }
    }
}

#[test]
fn unbalance_response_is_that_of_a_jeffcott_rotor() {
    let params = machine();
    let (m, k, d, u) = (10.0, 4e5, 200.0, 10.0 * 1e-5);
    for spin in [50.0, 200.0, 900.0] {
        let found = linear(&params).unbalance_response_m(spin).unwrap();
        let expected = u * spin * spin / (k - m * spin * spin).hypot(spin * d);
        for amplitude in &found[..params.planes.len()] {
            assert!(
                (amplitude - expected).abs() < 1e-12 * expected,
                "{found:?}, {expected}"
            );
        }
    }
    let critical = (k / m).sqrt();
    let forward = linear(&params)
        .critical_speeds()
        .unwrap()
        .into_iter()
        .any(|speed| {
            speed.direction == Direction::Forward
                && (speed.spin_rad_s - critical).abs() < 1e-9 * critical
        });
    assert!(forward);
}

/// Two forces on a rotor that is supported at the same places move it as (S·K⁻¹·Sᵀ) does; contact adds its stiffness.
#[test]
fn receptance_and_contact_are_those_of_springs() {
    let mut params = machine();
    params.planes[0].position_m = -0.15;
    params.planes[1].position_m = 0.15;
    let receptance = linear(&params).receptance(0.0, 0.0).unwrap();
    let (near, far) = (receptance[(0, 0)].re, receptance[(0, 2)].re);
    assert!(
        (near - 1.0 / 2e5).abs() < 1e-17 && far.abs() < 1e-17,
        "{near:e} {far:e}"
    );
    let closed = LinearMachine::new(&params, Walls::Closed).unwrap();
    let stiffness: f64 = (params.planes.iter())
        .filter_map(|p| p.contact.law.linear())
        .map(|law| law.stiffness_n_m)
        .sum();
    let expected = ((4e5 + stiffness) / 10.0).sqrt();
    let found = closed.critical_speeds().unwrap();
    let near = |speed: &&plant_model::machine::linear::CriticalSpeed| {
        (speed.spin_rad_s - expected).abs() < 1e-9 * expected
    };
    assert_eq!(found.iter().filter(near).count(), 2, "{found:?}");
}

/// What controllers of one plane are told: a struck place moves as 1/(1/m + z²/I_t), and a spring there holds it alone.
#[test]
fn a_plane_is_a_point_mass_to_an_impact() {
    let mut params = machine();
    params.rotor = rigid(10.0 * 0.16 * 0.125, 0.0);
    params.supports = vec![support(-0.16), support(0.125)];
    let point = params.point_mass(0.125);
    assert!((point.mass_kg - 1.0 / (0.1 + 0.125 * 0.125 / 0.2)).abs() < 1e-14);
    // The other spring stands at the centre of percussion.
    assert!((point.stiffness_n_m - 2e5).abs() < 1e-9);
    assert!((point.damping_n_s_m - 100.0).abs() < 1e-12);
    let rigid = params.rotor.rigid();
    assert!(rigid.lever(-0.16, 0.125).abs() < 1e-15);
    assert!(rigid.lever(-0.3, 0.125) < 0.0 && rigid.lever(0.2, 0.125) > 1.0);
}

/// Springs that differ along x and y: a translation of each, to and fro.
#[test]
fn unequal_supports_part_the_axes() {
    let mut params = machine();
    for support in &mut params.supports {
        support.stiffness_n_m = V2::new(2e5, 3e5);
        support.damping_n_s_m = V2::zeros();
    }
    let modes = linear(&params).modes(0.0).unwrap();
    for stiffness in [4e5_f64, 6e5] {
        let rate = (stiffness / 10.0).sqrt();
        let near = |mode: &&plant_model::machine::linear::MachineMode| {
            (mode.frequency_rad_s - rate).abs() < 1e-9 * rate
        };
        let found: Vec<_> = modes.iter().filter(near).collect();
        assert_eq!(found.len(), 1, "{modes:?}");
        assert_eq!(found[0].direction, Direction::Planar);
    }
}

/// Two like pairs of real and complex rates, at which a search for eigenvalues may go round in circles.
#[test]
fn a_rotor_in_magnets_alone_has_its_modes_at_every_spin() {
    let mut params = machine();
    params.rotor = rigid(0.5, 0.045);
    for support in &mut params.supports {
        (support.stiffness_n_m, support.damping_n_s_m) = (V2::repeat(-1e5), V2::zeros());
    }
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
        let near = found
            .iter()
            .filter(|m| (m.growth_s / grows - 1.0).abs() < 1e-9);
        assert!(near.count() >= 2, "{found:?}");
    }
}
