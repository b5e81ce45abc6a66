//! Tables of Gauss's eight points: integrals, values and powers of the polynomials through values there.

use super::{END, GAUSS, POINTS};
use crate::quadrature::{EIGHT, Nodes, lagrange};

/// Tables of the rule, of a polynomial through values at points.
#[derive(Debug, Clone)]
pub(super) struct Tables {
    /// Both ends and Gauss's points between.
    pub(super) theta: [f64; POINTS],
    /// ∫ and ∬ of the Lagrange polynomials of Gauss's points, up to each point.
    pub(super) once: [[f64; GAUSS]; POINTS],
    pub(super) twice: [[f64; GAUSS]; POINTS],
    /// Values of them at both ends, and at the end those of the polynomials of the start and Gauss's points.
    pub(super) at_ends: [[f64; GAUSS]; 2],
    pub(super) from_start: [f64; GAUSS + 1],
    /// Power by power, from values at Gauss's points, and at all points.
    pub(super) inner: [[f64; GAUSS]; GAUSS],
    pub(super) all: [[f64; POINTS]; POINTS],
}

/// Coefficients of the Lagrange polynomials of N places: row k has those of θ^k.
fn powers<const N: usize>(places: &[f64; N]) -> [[f64; N]; N] {
    let mut rows = [[0.0; N]; N];
    for j in 0..N {
        let mut product = [0.0; N];
        product[0] = 1.0;
        for (m, place) in places.iter().enumerate().filter(|(m, _)| *m != j) {
            let per = 1.0 / (places[j] - place);
            let degree = if m < j { m } else { m - 1 };
            for k in (0..=degree).rev() {
                product[k + 1] += per * product[k];
                product[k] *= -per * place;
            }
        }
        for (row, coefficient) in rows.iter_mut().zip(product) {
            row[j] = coefficient;
        }
    }
    rows
}

impl Tables {
    pub(super) fn new() -> Self {
        let gauss = EIGHT.theta;
        let mut theta = [0.0; POINTS];
        theta[1..END].copy_from_slice(&gauss);
        theta[END] = 1.0;
        let (mut once, mut twice) = ([[0.0; GAUSS]; POINTS], [[0.0; GAUSS]; POINTS]);
        for i in 0..POINTS {
            let nodes = Nodes::stretched(&EIGHT, theta[i]);
            for j in 0..GAUSS {
                let value = |n: usize| lagrange(&gauss, j, nodes.theta[n]);
                once[i][j] = nodes.integral(value);
                twice[i][j] = nodes.integral(|n| (theta[i] - nodes.theta[n]) * value(n));
            }
        }
        Self {
            once,
            twice,
            at_ends: [0.0, 1.0].map(|end| std::array::from_fn(|j| lagrange(&gauss, j, end))),
            from_start: std::array::from_fn(|j| lagrange(&theta[..END], j, 1.0)),
            inner: powers(&gauss),
            all: powers(&theta),
            theta,
        }
    }
}
