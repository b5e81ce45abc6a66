//! Rotors by matrices in coordinates of their own.

use crate::support::*;
use nalgebra::DMatrix;
use plant_model::machine::reduced::{ReducedRotor, RotorMatrices};
use std::f64::consts::TAU;

/// Three masses of 2, 5 and 3 kg at 0.1, 0.4 and 0.8 m on a shaft without mass that resists their getting out of line,
/// given by coordinates that are mixtures of their displacements.
fn three_masses() -> RotorMatrices {
    let masses = DMatrix::from_diagonal(&[2.0, 5.0, 3.0].as_slice().to_vec().into());
    // How far the middle one is off the line of the others, and the force of that.
    let out = DMatrix::from_row_slice(1, 3, &[4.0 / 7.0, -1.0, 3.0 / 7.0]);
    let stiffness = out.transpose() * 3e6 * &out;
    let mixed = DMatrix::from_row_slice(3, 3, &[1.0, 0.4, 0.0, -0.2, 1.5, 0.3, 0.5, 0.0, 0.8]);
    let seen = |matrix: &DMatrix<f64>| mixed.transpose() * matrix * &mixed;
    RotorMatrices {
        mass: seen(&masses),
        stiffness: seen(&stiffness),
        damping: Some(seen(&(out.transpose() * 20.0 * &out))),
        gyroscopic: None,
        places_m: vec![0.1, 0.4, 0.8],
        displacement: mixed,
    }
}

fn reduced(matrices: &RotorMatrices) -> ReducedRotor {
    matrices.reduced(&[0.1, 0.6], f64::INFINITY, 0.0).unwrap()
}

#[test]
fn mass_centre_inertia_and_modes_follow_whatever_the_coordinates() {
    let rotor = reduced(&three_masses());
    let rigid = rotor.rotor.rigid();
    assert!((rigid.mass_kg - 10.0).abs() < 1e-11);
    let centre = (0.2 + 2.0 + 2.4) / 10.0;
    assert!((rotor.centre_m - centre).abs() < 1e-12);
    let places = [(2.0, 0.1), (5.0, 0.4), (3.0, 0.8)];
    let about: f64 = places
        .map(|(m, z)| m * (z - centre) * (z - centre))
        .iter()
        .sum();
    assert!((rigid.transverse_inertia_kg_m2 - about).abs() < 1e-11);
    // The one that bends: k·Σ out²/m, its damper likewise.
    let out = [4.0 / 7.0, -1.0, 3.0 / 7.0];
    let mobility: f64 = out.iter().zip(places).map(|(o, (m, _))| o * o / m).sum();
    let [mode] = rotor.rotor.bending() else {
        panic!("one bending mode");
    };
    assert!((mode.frequency_rad_s / (3e6 * mobility).sqrt() - 1.0).abs() < 1e-11);
    // Its shape is out/m, of the rotor's mass.
    let size = (10.0 / mobility).sqrt();
    let sign = mode.shape[0].1.signum();
    for ((z, phi), (o, (m, place))) in mode.shape.iter().zip(out.iter().zip(places)) {
        assert!((z + centre - place).abs() < 1e-12);
        assert!((phi - sign * size * o / m).abs() < 1e-10, "{phi}");
    }
    let Rotor::Modal { damping_n_s_m, .. } = &rotor.rotor else {
        panic!("modal");
    };
    // Of the rigid motions nothing, of the mode d·Σ out²/m·M.
    let bends = damping_n_s_m[8];
    assert!((bends / (20.0 * mobility * 10.0) - 1.0).abs() < 1e-11);
    assert!(damping_n_s_m[..8].iter().all(|d| d.abs() < 1e-9 * bends));
    // Kept or not is a matter of frequency.
    let few = three_masses()
        .reduced(&[0.1, 0.6], 0.5 * mode.frequency_rad_s, 0.0)
        .unwrap();
    assert!(few.rotor.bending().is_empty());
    let straight = mode.shape[0].1.powi(2) / (10.0 * mode.frequency_rad_s.powi(2));
    assert!((few.residual_m_n(0.1) / straight - 1.0).abs() < 1e-12);
}

#[test]
fn what_is_no_free_rotor_is_refused_by_name() {
    let refused = |field: &str, change: &dyn Fn(&mut RotorMatrices)| {
        let mut matrices = three_masses();
        change(&mut matrices);
        let error = matrices.reduced(&[0.6], TAU * 1e3, 0.0).unwrap_err();
        assert_eq!(error.field, field, "{error}");
    };
    refused("mass", &|m| m.mass[(0, 1)] += 0.1);
    refused("mass", &|m| m.mass = -m.mass.clone());
    refused("stiffness", &|m| m.stiffness[(0, 0)] = f64::NAN);
    refused("stiffness", &|m| {
        m.stiffness = m.stiffness.clone().remove_row(2);
    });
    // A bearing in it.
    refused("stiffness", &|m| {
        let at = m.displacement.row(0).into_owned();
        m.stiffness += at.transpose() * 1e6 * at;
    });
    // A soft one, and one that pulls.
    for stiffness_n_m in [100.0, -100.0] {
        refused("stiffness", &|m| {
            let all = DMatrix::from_element(1, 3, 1.0) * &m.displacement;
            m.stiffness += all.transpose() * stiffness_n_m * all;
        });
    }
    // Displacements that no straight line has.
    refused("stiffness", &|m| m.displacement[(1, 1)] *= 1.1);
    refused("places_m", &|m| m.places_m[1] = 0.05);
    refused("displacement", &|m| {
        m.displacement = m.displacement.clone().remove_row(2);
    });
    refused("nodes[0]", &|m| m.places_m[2] = 0.5);
}
