//! Radau IIA with five stages: collocation of order 9, L-stable and stiffly accurate (Hairer, Wanner:
//! Solving Ordinary Differential Equations II, sections IV.5 and IV.8), solved by Newton's method with
//! the analytic Jacobian of the start.
//!
//! The step is taken in a frame that turns with the contact point. What makes contact stiff acts along
//! the contact normal; in fixed axes that direction turns away from the Jacobian within a step, which
//! stops Newton's method long before accuracy would. Seen from the turning frame it stands still, and
//! steady whirl is a state at rest.

use super::frame::{Frame, back};
use super::lu::{Lu, MOST};
use super::pair::{Field, Origin, Pair, Rates};
use super::radau_tableau::{ERROR, NODES, PAIRS, POWERS, REAL, STAGES, T, T_INVERSE, WEIGHTS};
use crate::V2;
use crate::energy::Flows;
use crate::part::{Part, Weights};
use nalgebra::Complex;

/// Newton iterations tried before the step is called too long.
const ITERATIONS: usize = 10;
/// The iteration ends where what it leaves is below this part of the tolerance,
const LEFT: f64 = 1e-3;
/// and what it last changed below this one: the powers of the audit are those of the stages before the
/// last change, and where contact is stiff they feel more of it than the state does.
const MOVED: f64 = 1e-2;
/// Steps are sized for changes that fall by this factor from iteration to iteration. Measured on random
/// overdamped plants from 1e-2 to 1e-6, 0.02 and 0.1 take as many evaluations within 6 %; at 0.2 three
/// attempts for ten steps come to no end at 1e-2, at 0.05 one.
const RATE: f64 = 0.05;

/// One attempted step and its stages.
#[derive(Debug, Clone)]
pub(crate) struct Radau<Y, E> {
    /// Start, stages before the last change of the iteration (the last of them is at the end), end.
    evaluations: [E; STAGES + 2],
    /// Stage i less the start.
    z: [Y; STAGES],
    jacobian: Jacobian,
    factors: Factors,
    frame: Frame,
    /// The frame's turn at each stage.
    turns: [V2; STAGES],
    t_s: f64,
    start: Y,
    step_s: f64,
    /// Of the last attempt whose iteration came to an end.
    solved: Collocation<Y>,
    /// Factor from change to change of the last iteration, where it had two of them.
    rate: Option<f64>,
    /// θ/(1 − θ) with the last such factor θ.
    eta: f64,
}

impl<Y: Part, E: Rates<Y>> Radau<Y, E> {
    /// First guess: the last polynomial, where it starts or ends here. An attempt without an end leaves
    /// the one before it, which is as good for the next attempt.
    fn guess(&mut self) {
        let old = &self.solved;
        let ratio = self.step_s / old.step_s;
        let ahead = if self.t_s == old.t_s { 0.0 } else { 1.0 };
        let follows = self.t_s == old.t_s || self.t_s == old.t_s + old.step_s;
        for (i, z) in self.z.iter_mut().enumerate() {
            *z = Y::default();
            if follows && ratio < 6.0 {
                *z = old
                    .at(ahead + ratio * NODES[i])
                    .rotated(back(self.turns[i]));
                z.add_scaled(-1.0, &self.start);
            }
        }
    }

    /// Evaluates stage i; the rates in the turning frame.
    fn stage(&mut self, i: usize, field: &mut impl Field<Y, E>) -> Y {
        let mut y = self.start;
        y.add_scaled(1.0, &self.z[i]);
        let elapsed_s = NODES[i] * self.step_s;
        let out = self.turns[i];
        self.evaluations[i + 1] = field.at(self.t_s + elapsed_s, &y.rotated(out));
        let mut rates = self.evaluations[i + 1].rates().rotated(back(out));
        rates.add_scaled(-self.frame.rate_rad_s(elapsed_s), &y.perp());
        rates
    }

    /// Solves for the stages. False where the iteration does not come to an end.
    fn iterate(&mut self, weights: &Weights, field: &mut impl Field<Y, E>) -> bool {
        let h = self.step_s;
        let mut w: [Y; STAGES] = combine(&T_INVERSE, &self.z);
        let (mut before, mut ratio_before) = (0.0, 0.0);
        self.eta = self.eta.max(1e-16).powf(0.8);
        for iteration in 0..ITERATIONS {
            let mut f = [Y::default(); STAGES];
            for (i, f) in f.iter_mut().enumerate() {
                *f = self.stage(i, field);
            }
            let mut right: [Y; STAGES] = combine(&T_INVERSE, &f);
            right[0].add_scaled(-REAL / h, &w[0]);
            for (p, (a, b)) in PAIRS.iter().enumerate() {
                let (i, j) = (2 * p + 1, 2 * p + 2);
                let (u, v) = (w[i], w[j]);
                right[i].add_scaled(-a / h, &u);
                right[i].add_scaled(-b / h, &v);
                right[j].add_scaled(b / h, &u);
                right[j].add_scaled(-a / h, &v);
            }
            self.factors.solve(&mut right);
            for (w, change) in w.iter_mut().zip(&right) {
                w.add_scaled(1.0, change);
            }
            let change: [Y; STAGES] = combine(&T, &right);
            self.z = combine(&T, &w);
            let squares: f64 = change.iter().map(|c| c.weighed_square(weights)).sum();
            let size = (squares / (Y::STATES * STAGES) as f64).sqrt();
            if !size.is_finite() {
                return false;
            }
            if iteration > 0 {
                // What the Jacobian misses goes round between two kinds of error, so that large and small
                // ratios alternate; their mean tells, as in Hairer and Wanner's RADAU5.
                let ratio: f64 = size / before;
                let rate = match iteration {
                    1 => ratio,
                    _ => (ratio * ratio_before).sqrt(),
                };
                ratio_before = ratio;
                self.rate = Some(rate);
                if rate >= 0.9 {
                    return false;
                }
                self.eta = rate / (1.0 - rate);
                let left = (ITERATIONS - 1 - iteration) as i32;
                if self.eta * rate.powi(left) * size > LEFT {
                    return false;
                }
            }
            if self.eta * size <= LEFT && size <= MOVED {
                return true;
            }
            before = size;
        }
        false
    }
}

/// Matrix of numbers times a column of states.
fn combine<Y: Part>(matrix: &[[f64; STAGES]; STAGES], column: &[Y; STAGES]) -> [Y; STAGES] {
    matrix.map(|row| {
        let mut sum = Y::default();
        for (a, y) in row.iter().zip(column) {
            sum.add_scaled(*a, y);
        }
        sum
    })
}

impl<Y: Part, E: Rates<Y>> Pair<Y, E> for Radau<Y, E> {
    type Dense = Collocation<Y>;
    const ERROR_POWER: f64 = (STAGES + 1) as f64;
    const LONGEST: f64 = f64::INFINITY;
    const FIRST: f64 = 1.0;

    fn new() -> Self {
        const { assert!(Y::STATES <= MOST) };
        Self {
            evaluations: [E::default(); STAGES + 2],
            z: [Y::default(); STAGES],
            jacobian: [[0.0; MOST]; MOST],
            factors: Factors::new(),
            frame: Frame::default(),
            turns: [V2::zeros(); STAGES],
            t_s: f64::NAN,
            start: Y::default(),
            step_s: 0.0,
            solved: Collocation {
                t_s: f64::NAN,
                start: Y::default(),
                powers: [Y::default(); STAGES],
                frame: Frame::default(),
                step_s: 0.0,
            },
            rate: None,
            eta: 1.0,
        }
    }

    fn begin(&mut self, origin: &Origin<'_, Y, E>, field: &mut impl Field<Y, E>) {
        self.frame = field.frame(origin.y, origin.first);
        for i in 0..Y::STATES {
            let mut direction = [0.0; MOST];
            direction[i] = 1.0;
            let direction = Y::read(&direction);
            let mut column = field.along(origin.t_s, origin.y, &direction);
            column.add_scaled(-self.frame.turn_rad_s, &direction.perp());
            let mut out = [0.0; MOST];
            column.write(&mut out);
            for (row, value) in self.jacobian.iter_mut().zip(out) {
                row[i] = value;
            }
        }
    }

    fn step(
        &mut self,
        origin: &Origin<'_, Y, E>,
        step_s: f64,
        weights: &Weights,
        field: &mut impl Field<Y, E>,
    ) -> (Y, f64) {
        self.t_s = origin.t_s;
        self.start = *origin.y;
        self.step_s = step_s;
        self.turns = NODES.map(|node| self.frame.out(node * step_s));
        self.guess();
        self.evaluations[0] = *origin.first;
        field.factorised();
        self.rate = None;
        let regular = self.factors.factorise(&self.jacobian, step_s, Y::STATES);
        if !(regular && self.iterate(weights, field)) {
            self.eta = 1.0;
            return (self.start, f64::NAN);
        }
        self.solved = Collocation {
            t_s: self.t_s,
            start: self.start,
            powers: combine(&POWERS, &self.z),
            frame: self.frame,
            step_s,
        };
        let mut end = self.start;
        end.add_scaled(1.0, &self.z[STAGES - 1]);
        let end = end.rotated(self.turns[STAGES - 1]);
        // The quadrature that takes the start for one more node, less the method.
        let mut gap = Y::default();
        for (e, z) in ERROR.iter().zip(&self.z) {
            gap.add_scaled(REAL * e / step_s, z);
        }
        let estimate = |y: &Y, first: &E| {
            let mut error = gap;
            error.add_scaled(1.0, first.rates());
            error.add_scaled(-self.frame.turn_rad_s, &y.perp());
            solve_part(&self.factors.real, &mut error);
            (
                error,
                (error.weighed_square(weights) / Y::STATES as f64).sqrt(),
            )
        };
        let (error, mut size) = estimate(origin.y, origin.first);
        if size > 1.0 {
            // A fast decaying part is overrated; the field at the start and its error tells.
            let mut moved = self.start;
            moved.add_scaled(1.0, &error);
            size = estimate(&moved, &field.at(self.t_s, &moved)).1;
        }
        (end, size)
    }

    /// The factor from change to change grows between the second power of the step, from a Jacobian
    /// that drifts, and the fifth or higher, from a contact normal that leaves the frame; the cube root
    /// lies between. Gustafsson and Söderlind (SIAM J. Sci. Comput. 18, 1997) size steps in this way.
    fn reach(&self) -> Option<f64> {
        self.rate.map(|rate| (RATE / rate).cbrt())
    }

    fn set_end(&mut self, end: E) {
        self.evaluations[STAGES + 1] = end;
    }

    fn seen(&self) -> &[E] {
        &self.evaluations
    }

    fn dense(&mut self, _field: &mut impl Field<Y, E>) -> Collocation<Y> {
        self.solved
    }

    fn dense_at(dense: &Collocation<Y>, theta: f64) -> Y {
        dense.at(theta)
    }

    /// The method's own quadrature.
    fn flows(&mut self, _field: &mut impl Field<Y, E>) -> Flows {
        let mut flows = Flows::default();
        for (weight, stage) in WEIGHTS.iter().zip(&self.evaluations[1..=STAGES]) {
            flows.add_scaled(self.step_s * weight, &stage.powers());
        }
        flows
    }
}

/// The collocation polynomial of a step: start + Σ powers_k·θ^(k + 1), in its frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Collocation<Y> {
    t_s: f64,
    start: Y,
    powers: [Y; STAGES],
    frame: Frame,
    step_s: f64,
}

impl<Y: Part> Collocation<Y> {
    /// State in axes at rest, also beyond the step.
    fn at(&self, theta: f64) -> Y {
        let mut y = self.start;
        let mut factor = 1.0;
        for power in &self.powers {
            factor *= theta;
            y.add_scaled(factor, power);
        }
        y.rotated(self.frame.out(theta * self.step_s))
    }
}

type Jacobian = [[f64; MOST]; MOST];

/// Factors of λ/h − J for the real and one of each pair of complex λ.
#[derive(Debug, Clone)]
struct Factors {
    real: Lu<f64>,
    pairs: [Lu<Complex<f64>>; STAGES / 2],
}

impl Factors {
    fn new() -> Self {
        Self {
            real: Lu::new(),
            pairs: [Lu::new(); STAGES / 2],
        }
    }

    /// False where one of them is singular.
    fn factorise(&mut self, jacobian: &Jacobian, h: f64, n: usize) -> bool {
        let mut pairs = self.pairs.iter_mut().zip(PAIRS);
        self.real.factorise(jacobian, REAL / h, n)
            && pairs.all(|(lu, (a, b))| lu.factorise(jacobian, Complex::new(a / h, -b / h), n))
    }

    fn solve<Y: Part>(&self, right: &mut [Y; STAGES]) {
        solve_part(&self.real, &mut right[0]);
        for (p, lu) in self.pairs.iter().enumerate() {
            let (mut u, mut v) = ([0.0; MOST], [0.0; MOST]);
            right[2 * p + 1].write(&mut u);
            right[2 * p + 2].write(&mut v);
            let mut both = [Complex::new(0.0, 0.0); MOST];
            for (b, (u, v)) in both.iter_mut().zip(u.iter().zip(&v)) {
                *b = Complex::new(*u, *v);
            }
            lu.solve(&mut both);
            right[2 * p + 1] = Y::read(&both.map(|b| b.re));
            right[2 * p + 2] = Y::read(&both.map(|b| b.im));
        }
    }
}

/// (Diagonal·I − J)⁻¹·y in place.
fn solve_part<Y: Part>(factors: &Lu<f64>, y: &mut Y) {
    let mut b = [0.0; MOST];
    y.write(&mut b);
    factors.solve(&mut b);
    *y = Y::read(&b);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::dop853::tests::orders;
    use crate::part::Body;

    /// Local errors fall as h^10 (step) and h^6 (collocation polynomial), the estimate as h^6; in axes
    /// at rest and in axes that turn against the motion, faster and faster.
    #[test]
    fn orders_are_nine_and_five() {
        for (h, turn_rad_s) in [(2.0, 0.0), (1.0, -0.7)] {
            let ([step, dense, estimate], fine) = orders::<Radau<Body, Body>>(h, turn_rad_s);
            assert!((9.2..10.7).contains(&step), "step order {step}");
            assert!((5.2..6.7).contains(&dense), "dense order {dense}");
            assert!((5.2..6.7).contains(&estimate), "estimate {estimate}");
            assert!(fine[0] < 1e-8 && fine[1] < 1e-4, "{fine:?}");
        }
    }
}
