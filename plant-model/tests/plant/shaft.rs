//! Shafts of beam elements against Timoshenko's beam, a Jeffcott rotor and a solid cylinder.

use crate::support::*;
use plant_model::machine::linear::{Direction, LinearMachine, Walls};
use plant_model::machine::reduced::ReducedRotor;
use plant_model::machine::shaft::{Disc, Shaft, ShaftSection};
use std::f64::consts::PI;

/// A tube, thick enough for shear and rotary inertia to count: a tenth of the third frequency.
const TUBE: ShaftSection = ShaftSection {
    length_m: 1.0,
    outer_diameter_m: 0.1,
    inner_diameter_m: 0.04,
    density_kg_m3: 7850.0,
    youngs_modulus_n_m2: 2.1e11,
    poisson_ratio: 0.3,
};

fn uniform(section: ShaftSection, elements: usize) -> Shaft {
    Shaft {
        sections: vec![section],
        discs: vec![],
        elements,
    }
}

fn reduced(shaft: &Shaft, nodes_m: &[f64]) -> ReducedRotor {
    shaft.reduced(nodes_m, f64::INFINITY, 0.0).unwrap()
}

/// ρA, ρI, EI, κGA of a section.
fn stiffnesses(s: &ShaftSection) -> (f64, f64, f64, f64) {
    let (outer, inner) = (s.outer_diameter_m, s.inner_diameter_m);
    let area = PI / 4.0 * (outer.powi(2) - inner.powi(2));
    let second = PI / 64.0 * (outer.powi(4) - inner.powi(4));
    let shear = s.youngs_modulus_n_m2 / (2.0 * (1.0 + s.poisson_ratio));
    (
        s.density_kg_m3 * area,
        s.density_kg_m3 * second,
        s.youngs_modulus_n_m2 * second,
        s.shear_coefficient() * shear * area,
    )
}

/// Timoshenko's frequency equation of a free–free beam: its determinant, over cosh.
fn free_free(s: &ShaftSection, omega: f64) -> f64 {
    let (mass, inertia, bending, shear) = stiffnesses(s);
    // EI·λ⁴ + ω²·(ρI + ρA·EI/κGA)·λ² + (ρI·ρA·ω⁴/κGA − ρA·ω²) = 0
    let square = omega * omega;
    let b = square * (inertia + mass * bending / shear) / bending;
    let c = (inertia * mass * square * square / shear - mass * square) / bending;
    let root = (0.25 * b * b - c).sqrt();
    let (alpha, beta) = ((root - 0.5 * b).sqrt(), (root + 0.5 * b).sqrt());
    let g = mass * square / shear;
    let l = s.length_m;
    let (near, far) = (alpha * alpha + g, beta * beta - g);
    // w = cosh + (near/far)·cos, and sinh + (β/α)·sin: moment and shear vanish at the left end.
    let (sh, cosh) = ((alpha * l).tanh(), (alpha * l).cosh());
    let [cos, sin] = [(beta * l).cos() / cosh, (beta * l).sin() / cosh];
    let moment = [near - near * cos, near * sh - far * (beta / alpha) * sin];
    let force = [sh / alpha + near / far / beta * sin, (1.0 - cos) / alpha];
    moment[0] * force[1] - moment[1] * force[0]
}

fn timoshenko(section: &ShaftSection, count: usize) -> Vec<f64> {
    let (mass, _, bending, _) = stiffnesses(section);
    let unit = (bending / mass).sqrt() / section.length_m.powi(2);
    let mut roots = Vec::new();
    let mut at = 5.0 * unit;
    while roots.len() < count {
        let next = at + 0.5 * unit;
        if free_free(section, at).signum() != free_free(section, next).signum() {
            roots.push(root_between([at, next], |omega| free_free(section, omega)));
        }
        at = next;
    }
    roots
}

#[test]
fn a_free_tube_has_timoshenkos_frequencies() {
    let exact = timoshenko(&TUBE, 4);
    let error = |elements: usize| {
        let found = reduced(&uniform(TUBE, elements), &[]);
        let modes = found.rotor.bending().iter().zip(&exact);
        let off = modes.map(|(mode, exact)| mode.frequency_rad_s / exact - 1.0);
        off.collect::<Vec<f64>>()
    };
    let [coarse, fine, ten] = [6, 12, 10].map(error);
    // Euler and Bernoulli's are far above.
    let (mass, _, bending, _) = stiffnesses(&TUBE);
    assert!(22.373 * (bending / mass).sqrt() / exact[0] > 1.02);
    for (error, bound) in ten.iter().zip([1e-5, 2e-5, 1e-4]) {
        assert!(error.abs() < bound, "{ten:?}");
    }
    // Twice as many elements leave a 64th.
    for mode in 0..3 {
        let order = (coarse[mode] / fine[mode]).log2();
        assert!((5.5..6.3).contains(&order), "{order}: {coarse:?}, {fine:?}");
    }
}

fn linear(params: &MachineParams) -> LinearMachine {
    LinearMachine::new(params, Walls::Off).unwrap()
}

/// A rotor on these supports.
fn on(shaft: &ReducedRotor, places_m: &[f64], stiffness_n_m: f64) -> MachineParams {
    let mut params = machine();
    params.spin = SpinParams::Held;
    params.rotor = shaft.rotor.clone();
    params.unbalances.clear();
    let support = |z: &f64| held(shaft.centred_m(*z), stiffness_n_m, 0.0);
    params.supports = places_m.iter().map(support).collect();
    for plane in &mut params.planes {
        plane.position_m = 0.0;
    }
    params
}

/// EI·k⁴ − (ρA + ρI·(1 + E/κG)·k²)·ω² + ρI·ρA/κGA·ω⁴ = 0 with k = nπ/L.
#[test]
fn a_pinned_tube_has_timoshenkos_frequencies() {
    let shaft = reduced(&uniform(TUBE, 10), &[0.0, 1.0]);
    let params = on(&shaft, &[0.0, 1.0], 1e13);
    let modes = linear(&params).modes(0.0).unwrap();
    let (mass, inertia, bending, shear) = stiffnesses(&TUBE);
    for n in 1..=2 {
        let k2 = (f64::from(n) * PI / TUBE.length_m).powi(2);
        let a = inertia * mass / shear;
        let b = mass + (inertia + mass * bending / shear) * k2;
        let exact = ((b - (b * b - 4.0 * a * bending * k2 * k2).sqrt()) / (2.0 * a)).sqrt();
        let off = modes
            .iter()
            .map(|mode| (mode.frequency_rad_s / exact - 1.0).abs());
        let least = off.fold(f64::INFINITY, f64::min);
        assert!(least < 1e-4, "{n}: {least:e}");
    }
}

/// A light shaft that carries a disc in its middle between two pins: √(k/m), k of bending and shear.
#[test]
fn a_jeffcott_rotor_has_its_critical_speed() {
    let light = ShaftSection {
        density_kg_m3: 1.0,
        outer_diameter_m: 0.02,
        inner_diameter_m: 0.0,
        ..TUBE
    };
    let mut jeffcott = uniform(light, 4);
    jeffcott.discs.push(Disc {
        position_m: 0.5,
        mass_kg: 5.0,
        transverse_inertia_kg_m2: 0.01,
        polar_inertia_kg_m2: 0.02,
    });
    let shaft = reduced(&jeffcott, &[0.0, 1.0]);
    let params = on(&shaft, &[0.0, 1.0], 1e10);
    let (_, _, bending, shear) = stiffnesses(&light);
    let stiffness = 1.0 / (1.0 / (48.0 * bending) + 1.0 / (4.0 * shear));
    let exact = (stiffness / 5.0).sqrt();
    let speeds = linear(&params).critical_speeds().unwrap();
    let first = speeds.iter().find(|s| s.direction == Direction::Forward);
    near("critical", first.unwrap().spin_rad_s, exact, 1e-4);
}

#[test]
fn a_cylinder_has_its_mass_and_inertias() {
    let solid = ShaftSection {
        inner_diameter_m: 0.0,
        ..TUBE
    };
    let shaft = uniform(solid, 7).reduced(&[0.3], 0.0, 0.0).unwrap();
    let rigid = *shaft.rotor.rigid();
    let mass = 7850.0 * PI * 0.05 * 0.05;
    near("mass", rigid.mass_kg, mass, 1e-12);
    near("centre", shaft.centre_m, 0.5, 2e-12);
    let polar = 0.5 * mass * 0.05 * 0.05;
    near("polar", rigid.polar_inertia_kg_m2, polar, 1e-10);
    let transverse = mass * (3.0 * 0.05 * 0.05 + 1.0) / 12.0;
    near(
        "transverse",
        rigid.transverse_inertia_kg_m2,
        transverse,
        1e-10,
    );
}

/// Compliance of the modes that go is what is missing of the whole at low frequencies.
#[test]
fn what_the_modes_leave_out_is_kept_as_compliance() {
    let tube = uniform(TUBE, 6);
    let compliance = |up_to: f64| {
        let shaft = tube.reduced(&[0.1, 0.6], up_to, 0.0).unwrap();
        let mut params = on(&shaft, &[], 0.0);
        params.planes[0].position_m = shaft.centred_m(0.1);
        params.planes[1].position_m = shaft.centred_m(0.6);
        let receptance = linear(&params).receptance(20.0, 0.0).unwrap();
        ([0, 1].map(|p| receptance[(2 * p, 2 * p)].re), shaft)
    };
    let (whole, all) = compliance(f64::INFINITY);
    let (kept, few) = compliance(2.0 * PI * 1000.0);
    assert_eq!(few.rotor.bending().len(), 1);
    assert_eq!([0.1, 0.6].map(|z| all.residual_m_n(z)), [0.0; 2]);
    for (p, z) in [0.1, 0.6].into_iter().enumerate() {
        let missing = whole[p] - kept[p];
        assert!(missing > 0.0);
        near("told", few.residual_m_n(z), missing, 1e-4);
    }
}

#[test]
fn what_is_no_shaft_is_refused_by_name() {
    let thin = ShaftSection {
        inner_diameter_m: 0.1,
        ..TUBE
    };
    let outside = Shaft {
        discs: vec![Disc {
            position_m: 1.2,
            mass_kg: 1.0,
            transverse_inertia_kg_m2: 0.0,
            polar_inertia_kg_m2: 0.0,
        }],
        ..uniform(TUBE, 10)
    };
    for (shaft, node, field) in [
        (uniform(thin, 10), 0.5, "shaft[0].inner_diameter_m"),
        (uniform(TUBE, 0), 0.5, "elements"),
        (outside, 0.5, "discs[0].position_m"),
        (uniform(TUBE, 10), -0.1, "nodes[0]"),
    ] {
        assert_eq!(shaft.reduced(&[node], 1e4, 0.0).unwrap_err().field, field);
    }
}
