//! A shaft with discs as a rotor: the matrices of its Timoshenko beam elements.
//!
//! Elements have shear, rotary inertia and gyroscopics, and Cowper's (1966) shear coefficient of round sections. Every place at
//! which something acts or is read is a node.

use super::reduced::{ReducedRotor, RigidMotions, RotorMatrices};
use crate::params::{ParamError, check};
use crate::quadrature::lagrange;
use nalgebra::{DMatrix, DVector};

/// A cylindrical piece of shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShaftSection {
    /// Length \[m\], > 0.
    pub length_m: f64,
    /// Outer diameter \[m\], > 0.
    pub outer_diameter_m: f64,
    /// Inner diameter \[m\], ≥ 0 and below the outer one.
    pub inner_diameter_m: f64,
    /// Density \[kg/m³\], > 0.
    pub density_kg_m3: f64,
    /// Young's modulus \[N/m²\], > 0.
    pub youngs_modulus_n_m2: f64,
    /// Poisson's ratio, 0 to 0.5.
    pub poisson_ratio: f64,
}

/// A rigid disc on the shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Where, from the left end \[m\].
    pub position_m: f64,
    /// Mass \[kg\], ≥ 0.
    pub mass_kg: f64,
    /// Transverse moment of inertia about its own centre \[kg m²\], ≥ 0.
    pub transverse_inertia_kg_m2: f64,
    /// Polar moment of inertia \[kg m²\], ≥ 0.
    pub polar_inertia_kg_m2: f64,
}

/// A shaft from its left end to its right.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaft {
    /// Its pieces, from left to right.
    pub sections: Vec<ShaftSection>,
    /// Its discs.
    pub discs: Vec<Disc>,
    /// Elements at least, of like length as far as sections and nodes allow.
    pub elements: usize,
}

/// Nodes nearer than this to each other are one, of the shaft's length.
const SAME_PLACE: f64 = 1e-9;

impl ShaftSection {
    fn area_m2(&self) -> f64 {
        let (outer, inner) = (self.outer_diameter_m, self.inner_diameter_m);
        0.25 * std::f64::consts::PI * (outer * outer - inner * inner)
    }

    /// Second moment of area about a diameter \[m⁴\].
    fn second_moment_m4(&self) -> f64 {
        let (outer, inner) = (self.outer_diameter_m, self.inner_diameter_m);
        std::f64::consts::PI / 64.0 * (outer.powi(4) - inner.powi(4))
    }

    /// Cowper's shear coefficient of a hollow circle.
    pub fn shear_coefficient(&self) -> f64 {
        let nu = self.poisson_ratio;
        let m2 = (self.inner_diameter_m / self.outer_diameter_m).powi(2);
        let square = (1.0 + m2) * (1.0 + m2);
        6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * m2)
    }

    fn shear_modulus_n_m2(&self) -> f64 {
        0.5 * self.youngs_modulus_n_m2 / (1.0 + self.poisson_ratio)
    }

    /// Stiffness, mass and rotational mass of an element over (displacement, rotation) of its nodes.
    fn element(&self, l: f64) -> Element {
        let (area, second) = (self.area_m2(), self.second_moment_m4());
        let bending = self.youngs_modulus_n_m2 * second;
        let shear = self.shear_coefficient() * self.shear_modulus_n_m2() * area;
        let mut all = Element::default();
        for (at, weight) in GAUSS {
            let ([n, slope], dx) = (cubics(at), weight * l);
            for i in 0..NODES {
                for j in 0..NODES {
                    // EI·θ′² + κGA·(w′ − θ)²
                    let slopes = slope[i] * slope[j] / (l * l);
                    all.k[2 * i][2 * j] += dx * shear * slopes;
                    all.k[2 * i][2 * j + 1] -= dx * shear * slope[i] / l * n[j];
                    all.k[2 * i + 1][2 * j] -= dx * shear * n[i] * slope[j] / l;
                    all.k[2 * i + 1][2 * j + 1] += dx * (bending * slopes + shear * n[i] * n[j]);
                    let product = dx * self.density_kg_m3 * n[i] * n[j];
                    all.m[2 * i][2 * j] += area * product;
                    all.turning[i][j] += second * product;
                }
            }
        }
        all
    }
}

/// Nodes of an element, at thirds of its length: displacement and rotation are cubic each, so that shear does not lock and
/// frequencies converge with the sixth power.
const NODES: usize = 4;

/// Matrices of an element.
#[derive(Default)]
struct Element {
    k: [[f64; 2 * NODES]; 2 * NODES],
    m: [[f64; 2 * NODES]; 2 * NODES],
    /// ∫ρI·θ²: about a diameter, half of what it is about the axis.
    turning: [[f64; NODES]; NODES],
}

/// Places and weights of Gauss's rule of four points from 0 to 1, exact for the squares of cubics.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Cubics that are one at one of the nodes and zero at the others, and their slopes, at a share of the length.
fn cubics(at: f64) -> [[f64; NODES]; 2] {
    let places: [f64; NODES] = std::array::from_fn(|i| i as f64 / (NODES - 1) as f64);
    let slope = |i: usize| {
        let others = || (0..NODES).filter(move |j| *j != i);
        let factor = |j: usize| (at - places[j]) / (places[i] - places[j]);
        let terms = others().map(|k| {
            let rest: f64 = others().filter(|j| *j != k).map(factor).product();
            rest / (places[i] - places[k])
        });
        terms.sum()
    };
    [
        std::array::from_fn(|i| lagrange(&places, i, at)),
        std::array::from_fn(slope),
    ]
}

impl Shaft {
    /// Its length \[m\].
    pub fn length_m(&self) -> f64 {
        self.sections.iter().map(|section| section.length_m).sum()
    }

    fn validate(&self, nodes_m: &[f64]) -> Result<(), ParamError> {
        const POSITIVE: &str = "a finite number greater than 0";
        const NOT_NEGATIVE: &str = "a finite number, 0 or greater";
        let count = self.sections.len();
        check(count > 0, "shaft".to_owned(), 0.0, "at least one section")?;
        for (i, s) in self.sections.iter().enumerate() {
            let field = |name: &str| format!("shaft[{i}].{name}");
            for (name, value) in [
                ("length_m", s.length_m),
                ("outer_diameter_m", s.outer_diameter_m),
                ("density_kg_m3", s.density_kg_m3),
                ("youngs_modulus_n_m2", s.youngs_modulus_n_m2),
            ] {
                check(value > 0.0, field(name), value, POSITIVE)?;
            }
            let hollow = (0.0..s.outer_diameter_m).contains(&s.inner_diameter_m);
            let rule = "0 or greater, and less than the outer diameter";
            check(hollow, field("inner_diameter_m"), s.inner_diameter_m, rule)?;
            let poisson = (0.0..=0.5).contains(&s.poisson_ratio);
            check(poisson, field("poisson_ratio"), s.poisson_ratio, "0 to 0.5")?;
        }
        let length_m = self.length_m();
        let on = |z: f64| (-SAME_PLACE * length_m..=(1.0 + SAME_PLACE) * length_m).contains(&z);
        let rule = "a place on the shaft, from 0 at its left end to its length";
        for (i, disc) in self.discs.iter().enumerate() {
            let field = |name: &str| format!("discs[{i}].{name}");
            check(
                on(disc.position_m),
                field("position_m"),
                disc.position_m,
                rule,
            )?;
            for (name, value) in [
                ("mass_kg", disc.mass_kg),
                ("transverse_inertia_kg_m2", disc.transverse_inertia_kg_m2),
                ("polar_inertia_kg_m2", disc.polar_inertia_kg_m2),
            ] {
                check(value >= 0.0, field(name), value, NOT_NEGATIVE)?;
            }
        }
        for (i, z) in nodes_m.iter().enumerate() {
            check(on(*z), format!("nodes[{i}]"), *z, rule)?;
        }
        let elements = (1..=200).contains(&self.elements);
        check(
            elements,
            "elements".to_owned(),
            self.elements as f64,
            "1 to 200",
        )
    }

    /// Nodes from left to right: ends, changes of section, discs, what is asked for, and enough between them.
    fn nodes_m(&self, asked_m: &[f64]) -> Vec<f64> {
        let length_m = self.length_m();
        let mut fixed = vec![0.0];
        for section in &self.sections {
            fixed.push(fixed[fixed.len() - 1] + section.length_m);
        }
        fixed.extend(self.discs.iter().map(|disc| disc.position_m));
        fixed.extend(asked_m);
        fixed.iter_mut().for_each(|z| *z = z.clamp(0.0, length_m));
        fixed.sort_by(f64::total_cmp);
        fixed.dedup_by(|a, b| (*a - *b).abs() <= SAME_PLACE * length_m);
        let longest = length_m / self.elements as f64 * (1.0 + SAME_PLACE);
        let mut nodes = Vec::new();
        for pair in fixed.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let parts = ((b - a) / longest).ceil().max(1.0);
            let all = parts * (NODES - 1) as f64;
            nodes.extend((0..all as usize).map(|i| a + (b - a) * i as f64 / all));
        }
        nodes.push(length_m);
        nodes
    }

    /// The rotor with bending modes up to a natural frequency \[rad/s\], each with a damping ratio; `nodes_m` are all places at
    /// which something acts or is read, from the left end.
    ///
    /// # Errors
    /// The first value that is out of range.
    pub fn reduced(
        &self,
        nodes_m: &[f64],
        up_to_rad_s: f64,
        damping_ratio: f64,
    ) -> Result<ReducedRotor, ParamError> {
        self.validate(nodes_m)?;
        let nodes = self.nodes_m(nodes_m);
        let n = 2 * nodes.len();
        let rigid = RigidMotions {
            translation: DVector::from_fn(n, |i, _| if i % 2 == 0 { 1.0 } else { 0.0 }),
            tilt: DVector::from_fn(n, |i, _| if i % 2 == 0 { nodes[i / 2] } else { 1.0 }),
        };
        let (mass, stiffness, gyroscopic) = self.assembled(&nodes);
        let matrices = RotorMatrices {
            mass,
            stiffness,
            damping: None,
            gyroscopic: Some(gyroscopic),
            displacement: DMatrix::from_fn(nodes.len(), n, |row, column| {
                if column == 2 * row { 1.0 } else { 0.0 }
            }),
            places_m: nodes,
        };
        let modes = matrices.modes()?;
        Ok(matrices.reduced_with(modes, &rigid, nodes_m, (up_to_rad_s, damping_ratio)))
    }

    /// Mass, stiffness and polar inertia of the free shaft in one plane, over (displacement, rotation) of its nodes.
    fn assembled(&self, nodes: &[f64]) -> (DMatrix<f64>, DMatrix<f64>, DMatrix<f64>) {
        let n = 2 * nodes.len();
        let zeros = || DMatrix::zeros(n, n);
        let (mut mass, mut stiffness, mut polar) = (zeros(), zeros(), zeros());
        let mut ends = Vec::new();
        let mut end_m = 0.0;
        for section in &self.sections {
            end_m += section.length_m;
            ends.push(end_m);
        }
        let last = NODES - 1;
        for first in (0..nodes.len() - 1).step_by(last) {
            let (from, to) = (nodes[first], nodes[first + last]);
            let middle = 0.5 * (from + to);
            let section = ends
                .partition_point(|end| *end <= middle)
                .min(ends.len() - 1);
            let element = self.sections[section].element(to - from);
            for row in 0..2 * NODES {
                for column in 0..2 * NODES {
                    let at = (2 * first + row, 2 * first + column);
                    stiffness[at] += element.k[row][column];
                    mass[at] += element.m[row][column];
                }
            }
            for (i, row) in element.turning.iter().enumerate() {
                for (j, turning) in row.iter().enumerate() {
                    let at = (2 * (first + i) + 1, 2 * (first + j) + 1);
                    mass[at] += turning;
                    polar[at] += 2.0 * turning;
                }
            }
        }
        for disc in &self.discs {
            let at = 2 * nearest(nodes, disc.position_m);
            mass[(at, at)] += disc.mass_kg;
            mass[(at + 1, at + 1)] += disc.transverse_inertia_kg_m2;
            polar[(at + 1, at + 1)] += disc.polar_inertia_kg_m2;
        }
        (mass, stiffness, polar)
    }
}

/// The node at a place.
fn nearest(nodes: &[f64], position_m: f64) -> usize {
    let away = |i: &usize| (nodes[*i] - position_m).abs();
    (0..nodes.len())
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .unwrap_or(0)
}
