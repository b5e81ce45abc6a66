//! Least squares of a model over the lines of all windows, and how far its numbers are known by what windows say alone.

use crate::commission::Found;
use crate::commission::spectrum::{Complex64, Line};
use crate::log_file::LogError;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use std::collections::BTreeSet;

/// Steps towards the least squares at most; how much of the way is gone at first, and how a step is shortened.
const STEPS: usize = 60;
const DAMPED: (f64, f64, f64) = (1e-6, 0.2, 8.0);
/// Windows whose misfit is so many times the usual are left out; and the largest share of the motion that the fit may leave.
const OUTLIER: f64 = 3.0;
pub(super) const UNEXPLAINED: f64 = 0.15;

/// What the model is not, as a share of a number: sums for integrals, a force that is held.
const MODELLED: f64 = 1e-3;

/// How a rotor moves, by numbers.
pub(super) trait Model {
    /// By how much each reading is off \[m\] what the forces explain.
    fn residuals_m(&self, line: &Line, values: &[f64]) -> Vec<Complex64>;

    /// By how much a number is changed to see what it does.
    fn step(&self, number: usize, values: &[f64]) -> f64;
}

/// What one window says: of each pair of numbers, and of each number.
struct Share {
    normal: DMatrix<f64>,
    score: DVector<f64>,
}

/// Numbers of a model with their covariance; those that were not fitted have none.
pub(super) struct Fit {
    pub(super) values: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Degrees of freedom of the scatter, and the windows that it is of.
    degrees: f64,
    pub(super) windows: usize,
}

/// A model over lines, and which of its numbers are free.
pub(super) struct Problem<'a, M> {
    pub(super) model: &'a M,
    pub(super) lines: &'a [Line],
    pub(super) free: &'a [usize],
}

impl<M: Model> Problem<'_, M> {
    /// Squares of what is left.
    pub(super) fn cost(&self, values: &[f64]) -> f64 {
        let of = |line: &Line| line.weight * own_cost(self.model, line, values);
        self.lines.iter().map(of).sum()
    }

    fn slopes(&self, line: &Line, values: &[f64]) -> Vec<Vec<Complex64>> {
        let slope = |i: &usize| {
            let step = self.model.step(*i, values);
            let (mut above, mut below) = (values.to_vec(), values.to_vec());
            above[*i] += step;
            below[*i] -= step;
            let [above, below] = [above, below].map(|v| self.model.residuals_m(line, &v));
            let pairs = above.iter().zip(&below);
            pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect()
        };
        self.free.iter().map(slope).collect()
    }

    fn share(&self, lines: &[&Line], values: &[f64]) -> Share {
        let number = self.free.len();
        let mut normal = DMatrix::zeros(number, number);
        let mut score = DVector::zeros(number);
        let product = |a: &[Complex64], b: &[Complex64]| -> f64 {
            a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum()
        };
        for line in lines {
            let slopes = self.slopes(line, values);
            let rest = self.model.residuals_m(line, values);
            for i in 0..number {
                score[i] += line.weight * product(&slopes[i], &rest);
                for j in 0..=i {
                    normal[(i, j)] += line.weight * product(&slopes[i], &slopes[j]);
                }
            }
        }
        normal.fill_upper_triangle_with_lower_triangle();
        Share { normal, score }
    }

    /// One step to the least squares: all of the way where the model is linear in what is free.
    pub(super) fn stepped(&self, values: &[f64], damping: f64) -> Option<Vec<f64>> {
        let next = self.step(values, damping)?;
        next.iter().all(|x| x.is_finite()).then_some(next)
    }

    fn step(&self, values: &[f64], damping: f64) -> Option<Vec<f64>> {
        let all: Vec<&Line> = self.lines.iter().collect();
        let Share { normal, score } = self.share(&all, values);
        let step = solved(&normal, &score, damping)?;
        let mut next = values.to_vec();
        for (place, i) in self.free.iter().enumerate() {
            next[*i] -= step[place];
        }
        Some(next)
    }

    /// The least squares from a start.
    pub(super) fn least(&self, start: Vec<f64>) -> Option<Vec<f64>> {
        let (mut values, mut cost) = (start.clone(), self.cost(&start));
        let (mut damping, quicker, slower) = DAMPED;
        for _ in 0..STEPS {
            let next = self.step(&values, damping)?;
            let to = self.cost(&next);
            if to < cost {
                let gained = (cost - to) / cost.abs().max(f64::MIN_POSITIVE);
                (values, cost) = (next, to);
                damping = (damping * quicker).max(1e-12);
                if gained < 1e-10 {
                    break;
                }
            } else {
                damping = (damping * slower).max(1e-9);
                if damping > 1e6 {
                    break;
                }
            }
        }
        Some(values)
    }

    /// The fit at these numbers: each window left out once shows how far they depend on it. Windows are independent of each other,
    /// and their lines are not. `of_fit` windows are taken up by the numbers.
    pub(super) fn known(&self, values: Vec<f64>, of_fit: f64) -> Option<Fit> {
        let numbers: BTreeSet<usize> = self.lines.iter().map(|line| line.window).collect();
        let shares: Vec<Share> = (numbers.iter())
            .map(|window| {
                let own = self.lines.iter().filter(|line| line.window == *window);
                self.share(&own.collect::<Vec<_>>(), &values)
            })
            .collect();
        let number = self.free.len();
        let mut whole = DMatrix::zeros(number, number);
        let mut score = DVector::zeros(number);
        for share in &shares {
            whole += &share.normal;
            score += &share.score;
        }
        let windows = shares.len() as f64;
        let mut steps = Vec::new();
        for share in &shares {
            let (normal, score) = (&whole - &share.normal, &score - &share.score);
            steps.push(solved(&normal, &score, 0.0)?);
        }
        let mean: DVector<f64> = steps.iter().sum::<DVector<f64>>() / windows;
        let mut covariance = DMatrix::zeros(values.len(), values.len());
        for step in &steps {
            let off = step - &mean;
            for (a, i) in self.free.iter().enumerate() {
                for (b, j) in self.free.iter().enumerate() {
                    covariance[(*i, *j)] += (windows - 1.0) / windows * off[a] * off[b];
                }
            }
        }
        Some(Fit {
            values,
            covariance,
            degrees: (windows - of_fit).max(1.0),
            windows: shares.len(),
        })
    }
}

pub(super) fn own_cost(model: &impl Model, line: &Line, values: &[f64]) -> f64 {
    let residuals_m = model.residuals_m(line, values);
    residuals_m.iter().map(Complex64::norm_sqr).sum()
}

/// Of numbers that are as different as they are, each brought to one size.
fn solved(normal: &DMatrix<f64>, right: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let number = normal.nrows();
    let scale = DVector::from_fn(number, |i, _| 1.0 / normal[(i, i)].max(1e-300).sqrt());
    let scaled = DMatrix::from_fn(number, number, |i, j| {
        let more = if i == j { 1.0 + damping } else { 1.0 };
        more * normal[(i, j)] * scale[i] * scale[j]
    });
    let solved = scaled.cholesky()?.solve(&right.component_mul(&scale));
    Some(solved.component_mul(&scale))
}

/// Lines without those of windows in which something else moves the rotor, a hum or a blow; all where too few would be left.
pub(super) fn without_outliers(
    model: &impl Model,
    lines: &[Line],
    values: &[f64],
    least: usize,
) -> Vec<Line> {
    let windows = lines.iter().map(|line| line.window).max().unwrap_or(0) + 1;
    let mut costs = vec![0.0; windows];
    for line in lines.iter().filter(|line| line.weight > 0.0) {
        costs[line.window] += own_cost(model, line, values);
    }
    let mut sorted = costs.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[windows / 2] * OUTLIER * OUTLIER;
    let kept = costs.iter().filter(|cost| **cost <= usual).count();
    match kept < windows && kept >= least {
        true => (lines.iter())
            .filter(|line| costs[line.window] <= usual)
            .cloned()
            .collect(),
        false => lines.to_vec(),
    }
}

/// Share of the motion that numbers leave unexplained.
pub(super) fn unexplained(model: &impl Model, lines: &[Line], values: &[f64]) -> f64 {
    let own = || lines.iter().filter(|line| line.weight > 0.0);
    let left: f64 = own().map(|line| own_cost(model, line, values)).sum();
    let positions = own().flat_map(|line| line.position_m.iter().flatten());
    let moved: f64 = positions.map(Complex64::norm_sqr).sum();
    left / moved.max(f64::MIN_POSITIVE)
}

/// Where nothing explains the motion.
pub(super) fn hidden() -> LogError {
    LogError::new(
        "the motion at the lines of the stimulus is not one that its force explains well enough: noise, a hum or a load hides it",
        "record it with a larger stimulus, for longer, or at another spin",
    )
}

impl Fit {
    /// A number that follows from the values, with its interval.
    pub(super) fn found(
        &self,
        name: impl Into<String>,
        unit: &'static str,
        of: impl Fn(&[f64]) -> f64,
    ) -> Found {
        let value = of(&self.values);
        let number = self.values.len();
        let gradient = DVector::from_fn(number, |i, _| {
            let known = self.covariance[(i, i)].sqrt();
            let by = known.max(1e-12 * self.values[i].abs()) * 1e-2;
            let (mut above, mut below) = (self.values.clone(), self.values.clone());
            above[i] += by;
            below[i] -= by;
            match by > 0.0 {
                true => (of(&above) - of(&below)) / (2.0 * by),
                false => 0.0,
            }
        });
        let variance = (gradient.transpose() * &self.covariance * &gradient)[(0, 0)];
        let student = StudentsT::new(0.0, 1.0, self.degrees);
        let times = student.map_or(2.0, |t| t.inverse_cdf(0.975));
        let spread = (times * variance.max(0.0).sqrt()).hypot(MODELLED * value);
        Found {
            name: name.into(),
            unit,
            value,
            low: value - spread,
            high: value + spread,
            from: format!("stimulus in {} windows", self.windows),
        }
    }
}
