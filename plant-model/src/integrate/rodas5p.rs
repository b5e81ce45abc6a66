//! The linearly implicit pair of order 5(4), L-stable and stiffly accurate, with dense output of
//! order 4: Rodas5P by Steinebach (BIT Numerical Mathematics 63, 2023), in the form that solves
//! W·k_i = f(y + Σ a_ij·k_j) + Σ (c_ij/h)·k_j + h·d_i·∂f/∂t with W = 1/(γh) − J. The coefficients are the
//! published ones.

use super::pair::{Field, Origin, Pair, Rates};
use crate::energy::Flows;
use crate::part::{Part, Weights};
use nalgebra::{SMatrix, SVector};

/// Most scalar states that a plant has.
const MOST: usize = 16;
/// Stages of a step.
const STAGES: usize = 8;

type Matrix = SMatrix<f64, MOST, MOST>;
type Vector = SVector<f64, MOST>;

const GAMMA: f64 = 0.21193756319429014;

#[rustfmt::skip]
const A: [&[f64]; STAGES] = [
    &[],
    &[3.0],
    &[2.849394379747939, 0.45842242204463923],
    &[-6.954028509809101, 2.489845061869568, -10.358996098473584],
    &[2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641],
    &[-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946],
    // The last stages go on from the stage before them.
    &[-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946, 1.0],
    &[-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946, 1.0, 1.0],
];

#[rustfmt::skip]
const C: [&[f64]; STAGES] = [
    &[],
    &[-14.155112264123755],
    &[-17.97296035885952, -2.859693295451294],
    &[147.12150275711716, -1.41221402718213, 71.68940251302358],
    &[165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306],
    &[24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125, -0.6610691825249471],
    &[30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783, -19.097331116725623, -28.087943162872662],
    &[37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047, -40.06618937091002, -54.66780262877968, -9.48861652309627],
];

/// Nodes of the stages, and weights of the time derivative.
#[rustfmt::skip]
const NODE: [f64; STAGES] = [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1.0, 1.0, 1.0];
#[rustfmt::skip]
const D: [f64; STAGES] = [0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734, 2.325825639765069, 0.0, 0.0, 0.0];

#[rustfmt::skip]
const DENSE: [[f64; STAGES]; 3] = [
    [25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204, 0.524948541321073, 1.1241088310450404, 0.4272876194431874, -0.17202221070155493],
    [-9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796, 20.176138334709044, 15.98066361424651, -6.789040303419874, -6.710236069923372],
    [11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643, -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722],
];

/// Interior nodes of the Gauss–Lobatto rule with four points, and the weights of ends and nodes.
const LOBATTO_NODES: [f64; 2] = [0.27639320225002106, 0.7236067977499789];
const LOBATTO_WEIGHTS: [f64; 2] = [1.0 / 12.0, 5.0 / 12.0];

/// One attempted step and its stages.
#[derive(Debug, Clone)]
pub(crate) struct Rodas5p<Y, E> {
    /// Start, stages 2 to 8, end.
    evaluations: [E; STAGES + 1],
    increments: [Y; STAGES],
    jacobian: Matrix,
    /// ∂f/∂t.
    drift: Y,
    t_s: f64,
    start: Y,
    end: Y,
    step_s: f64,
}

impl<Y: Part, E: Rates<Y>> Rodas5p<Y, E> {
    fn take_jacobian(&mut self, origin: &Origin<'_, Y, E>, field: &mut impl Field<Y, E>) {
        self.jacobian = Matrix::zeros();
        for i in 0..Y::STATES {
            let mut direction = [0.0; MOST];
            direction[i] = 1.0;
            let column = field.along(origin.t_s, origin.y, &Y::read(&direction), 0.0);
            column.write(&mut self.jacobian.column_mut(i).as_mut_slice()[..Y::STATES]);
        }
        self.drift = field.along(origin.t_s, origin.y, &Y::default(), 1.0);
    }

    fn dense_of_step(&self) -> Dense<Y> {
        let mut k = [Y::default(); 3];
        for (k, row) in k.iter_mut().zip(&DENSE) {
            for (h, increment) in row.iter().zip(&self.increments) {
                k.add_scaled(*h, increment);
            }
        }
        Dense {
            start: self.start,
            end: self.end,
            k,
        }
    }
}

impl<Y: Part, E: Rates<Y>> Pair<Y, E> for Rodas5p<Y, E> {
    type Dense = Dense<Y>;
    const ERROR_POWER: f64 = 5.0;
    const LONGEST: f64 = f64::INFINITY;

    fn new() -> Self {
        Self {
            evaluations: [E::default(); STAGES + 1],
            increments: [Y::default(); STAGES],
            jacobian: Matrix::zeros(),
            drift: Y::default(),
            t_s: 0.0,
            start: Y::default(),
            end: Y::default(),
            step_s: 0.0,
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
        self.evaluations[0] = *origin.first;
        self.take_jacobian(origin, field);
        // Unused places hold the identity and solve to zero.
        let mut w = -self.jacobian;
        for i in 0..MOST {
            w[(i, i)] += if i < Y::STATES {
                1.0 / (GAMMA * step_s)
            } else {
                1.0
            };
        }
        let factors = w.lu();
        for i in 0..STAGES {
            let mut y = self.start;
            for (a, k) in A[i].iter().zip(&self.increments) {
                y.add_scaled(*a, k);
            }
            if i > 0 {
                self.evaluations[i] = field.at(self.t_s + NODE[i] * step_s, &y);
            }
            let mut right = *self.evaluations[i].rates();
            for (c, k) in C[i].iter().zip(&self.increments) {
                right.add_scaled(c / step_s, k);
            }
            right.add_scaled(step_s * D[i], &self.drift);
            let mut vector = Vector::zeros();
            right.write(&mut vector.as_mut_slice()[..Y::STATES]);
            if !factors.solve_mut(&mut vector) {
                return (self.start, f64::NAN);
            }
            self.increments[i] = Y::read(&vector.as_slice()[..Y::STATES]);
            self.end = y;
            self.end.add_scaled(1.0, &self.increments[i]);
        }
        let last = &self.increments[STAGES - 1];
        let error = (last.weighed_square(weights) / Y::STATES as f64).sqrt();
        (self.end, error)
    }

    fn set_end(&mut self, end: E) {
        self.evaluations[STAGES] = end;
    }

    fn seen(&self) -> &[E] {
        &self.evaluations
    }

    fn dense(&mut self, _field: &mut impl Field<Y, E>) -> Dense<Y> {
        self.dense_of_step()
    }

    fn dense_at(dense: &Dense<Y>, theta: f64) -> Y {
        dense.at(theta)
    }

    /// Powers on the dense output, by Gauss–Lobatto: exact to the order of the dense output.
    fn flows(&mut self, field: &mut impl Field<Y, E>) -> Flows {
        let dense = self.dense_of_step();
        let mut flows = Flows::default();
        let [at_ends, inside] = LOBATTO_WEIGHTS.map(|w| w * self.step_s);
        for end in [0, STAGES] {
            flows.add_scaled(at_ends, &self.evaluations[end].powers());
        }
        for node in LOBATTO_NODES {
            let e = field.at(self.t_s + node * self.step_s, &dense.at(node));
            flows.add_scaled(inside, &e.powers());
        }
        flows
    }
}

/// Interpolant of order 4 over one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dense<Y> {
    start: Y,
    end: Y,
    k: [Y; 3],
}

impl<Y: Part> Dense<Y> {
    fn at(&self, theta: f64) -> Y {
        let rest = 1.0 - theta;
        let mut y = Y::default();
        y.add_scaled(rest, &self.start);
        y.add_scaled(theta, &self.end);
        y.add_scaled(theta * rest, &self.k[0]);
        y.add_scaled(theta * theta * rest, &self.k[1]);
        y.add_scaled(theta * theta * theta * rest, &self.k[2]);
        y
    }
}

#[cfg(test)]
mod tests {
    use super::Rodas5p;
    use crate::integrate::dop853::tests::errors;
    use crate::part::Body;

    /// Local errors fall as h^6 (step; as h^7 where the equations are linear, as here) and h^5 (dense
    /// output).
    #[test]
    fn orders_are_five_and_four() {
        let (step_coarse, dense_coarse) = errors::<Rodas5p<Body, Body>>(0.5);
        let (step_fine, dense_fine) = errors::<Rodas5p<Body, Body>>(0.25);
        let (step, dense) = (
            (step_coarse / step_fine).log2(),
            (dense_coarse / dense_fine).log2(),
        );
        assert!((6.5..7.5).contains(&step), "step order {step}");
        assert!((4.5..5.7).contains(&dense), "dense order {dense}");
        assert!(step_coarse < 1e-4 && dense_coarse < 1e-3);
    }
}
