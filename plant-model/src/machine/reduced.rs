//! A rotor by the matrices of its motion in one plane, reduced to its rigid motions and to bending modes.

use super::params::shape_at;
use super::params::{BendingMode, RigidRotor, Rotor};
use crate::params::{ParamError, check};
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

/// A free rotor, the same in every plane through its axis, by the matrices of one of them:
///
/// ```text
/// M·q̈_x + D·q̇_x + Ω·P·q̇_y + K·q_x = f_x
/// M·q̈_y + D·q̇_y − Ω·P·q̇_x + K·q_y = f_y
/// ```
///
/// The coordinates are anybody's; what they move is given by the displacement at some places along the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorMatrices {
    /// M \[kg\], n × n, symmetric, positive definite.
    pub mass: DMatrix<f64>,
    /// K \[N/m\], n × n, symmetric; without bearings: translation and tilt strain nothing.
    pub stiffness: DMatrix<f64>,
    /// D \[N s/m\], n × n, symmetric; none without damping.
    pub damping: Option<DMatrix<f64>>,
    /// P \[kg\], n × n, symmetric: polar inertia on the slopes; none where the spin turns nothing.
    pub gyroscopic: Option<DMatrix<f64>>,
    /// Places along the axis \[m\], rising, two at least; counted from anywhere.
    pub places_m: Vec<f64>,
    /// Displacement at each place by each coordinate, places × n. Straight in between.
    pub displacement: DMatrix<f64>,
}

/// A rotor reduced to modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedRotor {
    /// The rotor, positions counted from its centre of mass.
    pub rotor: Rotor,
    /// Where the centre of mass is, as places were given \[m\].
    pub centre_m: f64,
    /// First and last place \[m\].
    pub ends_m: (f64, f64),
    /// Static compliance of the modes that were left out \[m/N\], at each place \[m\] that was asked for.
    residual: Vec<(f64, f64)>,
}

impl ReducedRotor {
    /// A place as it was given, from the centre of mass \[m\].
    pub fn centred_m(&self, position_m: f64) -> f64 {
        position_m.clamp(self.ends_m.0, self.ends_m.1) - self.centre_m
    }

    /// Static compliance of the modes that were left out, at a place that was asked for \[m/N\].
    pub fn residual_m_n(&self, position_m: f64) -> f64 {
        let away = |of: &&(f64, f64)| (of.0 - position_m).abs();
        let nearest = (self.residual.iter()).min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.map_or(0.0, |(_, residual)| *residual)
    }
}

/// Motions that strain nothing, in the rotor's coordinates.
pub(super) struct RigidMotions {
    /// By 1 everywhere.
    pub(super) translation: DVector<f64>,
    /// By z, about where places count from.
    pub(super) tilt: DVector<f64>,
}

/// Square of a mode's rate, and its motion of unit modal mass.
pub(super) type FreeMode = (f64, DVector<f64>);

/// Squares of rates below this share of the largest are rounding.
const ROUNDING: f64 = 1e-13;
/// Entries that should be alike may differ by this share of the largest.
const SYMMETRIC: f64 = 1e-9;
/// Square of the rate of a rigid motion, of that of the slowest bending mode.
const STRAINS: f64 = 1e-8;
/// How far a rigid motion may be from straight.
const STRAIGHT: f64 = 1e-6;

fn no_modes(mass_kg: f64) -> ParamError {
    ParamError {
        field: "mass".to_owned(),
        value: mass_kg,
        expected: "a positive definite matrix that a computer can tell from the stiffness",
    }
}

impl RotorMatrices {
    fn validate(&self) -> Result<(), ParamError> {
        let n = self.mass.nrows();
        check(n >= 2, "mass", n as f64, "two coordinates at least")?;
        let squares = [
            ("mass", Some(&self.mass)),
            ("stiffness", Some(&self.stiffness)),
            ("damping", self.damping.as_ref()),
            ("gyroscopic", self.gyroscopic.as_ref()),
        ];
        for (field, matrix) in squares {
            let Some(matrix) = matrix else { continue };
            let (rows, columns) = matrix.shape();
            let odd = if rows == n { columns } else { rows } as f64;
            let rule = "a square matrix, as large as mass";
            check(rows == n && columns == n, field, odd, rule)?;
            let unlike = (matrix - matrix.transpose()).amax();
            let alike = matrix.iter().all(|x| x.is_finite()) && unlike <= SYMMETRIC * matrix.amax();
            check(alike, field, unlike, "a symmetric matrix of finite numbers")?;
        }
        let places = self.places_m.len();
        check(
            places >= 2,
            "places_m",
            places as f64,
            "two places at least",
        )?;
        for (i, z) in self.places_m.iter().enumerate() {
            let rises = i == 0 || *z > self.places_m[i - 1];
            check(rises, "places_m", *z, "finite places that rise")?;
        }
        let (rows, columns) = self.displacement.shape();
        let field = "displacement";
        check(rows == places, field, rows as f64, "a row for each place")?;
        check(
            columns == n,
            field,
            columns as f64,
            "a column for each coordinate",
        )?;
        let odd = self.displacement.iter().find(|x| !x.is_finite());
        check(
            odd.is_none(),
            field,
            odd.copied().unwrap_or(0.0),
            "finite numbers",
        )
    }

    /// The rotor with bending modes up to a natural frequency \[rad/s\], each with a damping ratio beside what the damping
    /// matrix does; `nodes_m` are all places at which something acts or is read.
    ///
    /// # Errors
    /// The first value that is out of range: by the name of the matrix, or `nodes[i]`.
    pub fn reduced(
        &self,
        nodes_m: &[f64],
        up_to_rad_s: f64,
        damping_ratio: f64,
    ) -> Result<ReducedRotor, ParamError> {
        self.validate()?;
        let (first, last) = self.ends_m();
        for (i, z) in nodes_m.iter().enumerate() {
            let rule = "a place between the first and the last of places_m";
            check((first..=last).contains(z), format!("nodes[{i}]"), *z, rule)?;
        }
        let modes = self.modes()?;
        let rigid = self.rigid_motions(&modes)?;
        Ok(self.reduced_with(modes, &rigid, nodes_m, (up_to_rad_s, damping_ratio)))
    }

    fn ends_m(&self) -> (f64, f64) {
        (self.places_m[0], self.places_m[self.places_m.len() - 1])
    }

    /// The two slowest motions, mixed to a translation and a tilt.
    fn rigid_motions(&self, modes: &[FreeMode]) -> Result<RigidMotions, ParamError> {
        let slowest = DMatrix::from_columns(&[modes[0].1.clone(), modes[1].1.clone()]);
        let moved = &self.displacement * &slowest;
        let wanted = DMatrix::from_fn(self.places_m.len(), 2, |row, column| match column {
            0 => 1.0,
            _ => self.places_m[row],
        });
        let rule = "the stiffness of the free rotor, without bearings: a translation and a tilt that strain nothing";
        let crooked = || ParamError {
            field: "stiffness".to_owned(),
            value: modes[1].0.abs().sqrt(),
            expected: rule,
        };
        let normal = (moved.transpose() * &moved)
            .try_inverse()
            .ok_or_else(crooked)?;
        let mix = normal * moved.transpose() * &wanted;
        let off = (&moved * &mix - &wanted).amax() / wanted.amax();
        let bends = modes.get(2).map_or(f64::INFINITY, |mode| mode.0);
        let fastest = modes[modes.len() - 1].0;
        let strains = modes[0].0.abs().max(modes[1].0.abs());
        if off > STRAIGHT || strains > (STRAINS * bends).max(ROUNDING * fastest) {
            return Err(crooked());
        }
        let motions = slowest * mix;
        Ok(RigidMotions {
            translation: motions.column(0).into_owned(),
            tilt: motions.column(1).into_owned(),
        })
    }

    /// Modes of the free rotor, slowest first; the rigid motions are among them.
    pub(super) fn modes(&self) -> Result<Vec<FreeMode>, ParamError> {
        let failed = || no_modes(self.mass.trace());
        let root = Cholesky::new(self.mass.clone()).ok_or_else(failed)?;
        // L⁻¹·K·L⁻ᵀ has the squares of the rates.
        let l = root.l();
        let half = l
            .solve_lower_triangular(&self.stiffness)
            .ok_or_else(failed)?;
        let whole = (l.solve_lower_triangular(&half.transpose())).ok_or_else(failed)?;
        let eigen = SymmetricEigen::new(0.5 * (&whole + whole.transpose()));
        let mut modes = Vec::with_capacity(self.mass.nrows());
        for (square, vector) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            let motion = (l.tr_solve_lower_triangular(&vector)).ok_or_else(failed)?;
            modes.push((*square, motion));
        }
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(modes)
    }

    pub(super) fn reduced_with(
        &self,
        modes: Vec<FreeMode>,
        rigid: &RigidMotions,
        nodes_m: &[f64],
        (up_to_rad_s, damping_ratio): (f64, f64),
    ) -> ReducedRotor {
        let translation = rigid.translation.clone();
        let heavy = &self.mass * &translation;
        let mass_kg = translation.dot(&heavy);
        let centre_m = rigid.tilt.dot(&heavy) / mass_kg;
        let tilt = &rigid.tilt - centre_m * &translation;
        let transverse_inertia_kg_m2 = tilt.dot(&(&self.mass * &tilt));
        let fastest = modes.last().map_or(0.0, |mode| mode.0);
        let mut bending = Vec::new();
        let mut shapes = vec![translation, tilt];
        let mut residual: Vec<(f64, f64)> = nodes_m.iter().map(|z| (*z, 0.0)).collect();
        for (square, motion) in modes.into_iter().skip(2) {
            // The modal mass is the rotor's.
            let motion = motion * mass_kg.sqrt();
            let frequency_rad_s = square.max(ROUNDING * fastest).sqrt();
            let moved = &self.displacement * &motion;
            let places = self.places_m.iter().zip(moved.iter());
            let shape: Vec<(f64, f64)> = places.map(|(z, phi)| (z - centre_m, *phi)).collect();
            if frequency_rad_s <= up_to_rad_s {
                bending.push(BendingMode {
                    frequency_rad_s,
                    damping_ratio,
                    shape,
                });
                shapes.push(motion);
            } else {
                for (z, sum) in &mut residual {
                    let phi = shape_at(&shape, *z - centre_m);
                    *sum += phi * phi / (mass_kg * frequency_rad_s * frequency_rad_s);
                }
            }
        }
        let seen_by = |matrix: &Option<DMatrix<f64>>, shapes: &[DVector<f64>]| {
            let Some(matrix) = matrix else {
                return Vec::new();
            };
            let size = shapes.len();
            let mut all = vec![0.0; size * size];
            for i in 0..size {
                for j in 0..=i {
                    let value = shapes[i].dot(&(matrix * &shapes[j]));
                    (all[i * size + j], all[j * size + i]) = (value, value);
                }
            }
            all
        };
        let polar_coupling_kg_m2 = seen_by(&self.gyroscopic, &shapes[1..]);
        let rigid = RigidRotor {
            mass_kg,
            transverse_inertia_kg_m2,
            polar_inertia_kg_m2: polar_coupling_kg_m2.first().copied().unwrap_or(0.0),
        };
        let damping_n_s_m = seen_by(&self.damping, &shapes);
        ReducedRotor {
            rotor: match bending.is_empty() && damping_n_s_m.is_empty() {
                true => Rotor::Rigid(rigid),
                false => Rotor::Modal {
                    rigid,
                    bending,
                    polar_coupling_kg_m2,
                    damping_n_s_m,
                },
            },
            centre_m,
            ends_m: self.ends_m(),
            residual,
        }
    }
}
