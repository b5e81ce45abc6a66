//! The explicit pair of order 8 with embedded orders 5 and 3 and dense output of order 7, by Dormand
//! and Prince (Hairer, Nørsett, Wanner: Solving Ordinary Differential Equations I, section II.10).
//! The coefficients are the published ones.

use super::pair::{Field, Origin, Pair, Rates};
use crate::energy::Flows;
use crate::part::{Part, Weights};

/// Stages of one step, the derivative at its end, and three more for dense output.
const STAGES: usize = 16;
/// Stages that a step itself needs.
const STEP_STAGES: usize = 12;
/// Index of the evaluation at the end of the step.
const END: usize = 12;

type Row = &'static [(usize, f64)];

#[rustfmt::skip]
#[allow(clippy::excessive_precision, reason = "published digits")]
const C: [f64; STAGES] = [
    0.0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726,
    0.3333333333333333, 0.25, 0.3076923076923077, 0.6512820512820513, 0.6, 0.8571428571428571,
    1.0, 1.0, 0.1, 0.2, 0.7777777777777778,
];

#[rustfmt::skip]
#[allow(clippy::excessive_precision, reason = "published digits")]
const A: [Row; STAGES] = [
    &[],
    &[(0, 0.05260015195876773)],
    &[(0, 0.0197250569845379), (1, 0.0591751709536137)],
    &[(0, 0.02958758547680685), (2, 0.08876275643042054)],
    &[(0, 0.2413651341592667), (2, -0.8845494793282861), (3, 0.924834003261792)],
    &[(0, 0.037037037037037035), (3, 0.17082860872947386), (4, 0.12546768756682242)],
    &[(0, 0.037109375), (3, 0.17025221101954405), (4, 0.06021653898045596), (5, -0.017578125)],
    &[(0, 0.03709200011850479), (3, 0.17038392571223998), (4, 0.10726203044637328), (5, -0.015319437748624402), (6, 0.008273789163814023)],
    &[(0, 0.6241109587160757), (3, -3.3608926294469414), (4, -0.868219346841726), (5, 27.59209969944671), (6, 20.154067550477894), (7, -43.48988418106996)],
    &[(0, 0.47766253643826434), (3, -2.4881146199716677), (4, -0.590290826836843), (5, 21.230051448181193), (6, 15.279233632882423), (7, -33.28821096898486), (8, -0.020331201708508627)],
    &[(0, -0.9371424300859873), (3, 5.186372428844064), (4, 1.0914373489967295), (5, -8.149787010746927), (6, -18.52006565999696), (7, 22.739487099350505), (8, 2.4936055526796523), (9, -3.0467644718982196)],
    &[(0, 2.273310147516538), (3, -10.53449546673725), (4, -2.0008720582248625), (5, -17.9589318631188), (6, 27.94888452941996), (7, -2.8589982771350235), (8, -8.87285693353063), (9, 12.360567175794303), (10, 0.6433927460157636)],
    &[(0, 0.054293734116568765), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585), (8, 0.3111643669578199), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.04471061572777259)],
    &[(0, 0.056167502283047954), (6, 0.25350021021662483), (7, -0.2462390374708025), (8, -0.12419142326381637), (9, 0.15329179827876568), (10, 0.00820105229563469), (11, 0.007567897660545699), (12, -0.008298)],
    &[(0, 0.03183464816350214), (5, 0.028300909672366776), (6, 0.053541988307438566), (7, -0.05492374857139099), (10, -0.00010834732869724932), (11, 0.0003825710908356584), (12, -0.00034046500868740456), (13, 0.1413124436746325)],
    &[(0, -0.42889630158379194), (5, -4.697621415361164), (6, 7.683421196062599), (7, 4.06898981839711), (8, 0.3567271874552811), (12, -0.0013990241651590145), (13, 2.9475147891527724), (14, -9.15095847217987)],
];

#[rustfmt::skip]
#[allow(clippy::excessive_precision, reason = "published digits")]
const B: Row = &[(0, 0.054293734116568765), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585), (8, 0.3111643669578199), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.04471061572777259)];

#[rustfmt::skip]
#[allow(clippy::excessive_precision, reason = "published digits")]
const E3: Row = &[(0, -0.18980075407240762), (5, 4.450312892752409), (6, 1.8915178993145003), (7, -5.801203960010585), (8, -0.4226823213237919), (9, -0.1521609496625161), (10, 0.20136540080403034), (11, 0.02265179219836082)];

#[rustfmt::skip]
#[allow(clippy::excessive_precision, reason = "published digits")]
const E5: Row = &[(0, 0.01312004499419488), (5, -1.2251564463762044), (6, -0.4957589496572502), (7, 1.6643771824549864), (8, -0.35032884874997366), (9, 0.3341791187130175), (10, 0.08192320648511571), (11, -0.022355307863886294)];

#[rustfmt::skip]
#[allow(clippy::excessive_precision, reason = "published digits")]
const D: [Row; 4] = [
    &[(0, -8.428938276109013), (5, 0.5667149535193777), (6, -3.0689499459498917), (7, 2.38466765651207), (8, 2.117034582445028), (9, -0.871391583777973), (10, 2.2404374302607883), (11, 0.6315787787694688), (12, -0.08899033645133331), (13, 18.148505520854727), (14, -9.194632392478356), (15, -4.436036387594894)],
    &[(0, 10.427508642579134), (5, 242.28349177525817), (6, 165.20045171727028), (7, -374.5467547226902), (8, -22.113666853125306), (9, 7.733432668472264), (10, -30.674084731089398), (11, -9.332130526430229), (12, 15.697238121770845), (13, -31.139403219565178), (14, -9.35292435884448), (15, 35.81684148639408)],
    &[(0, 19.985053242002433), (5, -387.0373087493518), (6, -189.17813819516758), (7, 527.8081592054236), (8, -11.57390253995963), (9, 6.8812326946963), (10, -1.0006050966910838), (11, 0.7777137798053443), (12, -2.778205752353508), (13, -60.19669523126412), (14, 84.32040550667716), (15, 11.99229113618279)],
    &[(0, -25.69393346270375), (5, -154.18974869023643), (6, -231.5293791760455), (7, 357.6391179106141), (8, 93.40532418362432), (9, -37.45832313645163), (10, 104.0996495089623), (11, 29.8402934266605), (12, -43.53345659001114), (13, 96.32455395918828), (14, -39.17726167561544), (15, -149.72683625798564)],
];

/// One attempted step and its stages; reused from step to step, so that no step allocates.
#[derive(Debug, Clone)]
pub(crate) struct Dop853<Y, E> {
    evaluations: [E; STAGES],
    t_s: f64,
    start: Y,
    end: Y,
    step_s: f64,
}

impl<Y: Part, E: Rates<Y>> Dop853<Y, E> {
    fn combine(&self, row: Row) -> Y {
        let mut sum = Y::default();
        for &(j, a) in row {
            sum.add_scaled(a, self.evaluations[j].rates());
        }
        sum
    }

    fn stage(&mut self, i: usize, field: &mut impl Field<Y, E>) {
        let mut y = self.start;
        let h = self.step_s;
        for &(j, a) in A[i] {
            y.add_scaled(h * a, self.evaluations[j].rates());
        }
        self.evaluations[i] = field.at(self.t_s + C[i] * h, &y);
    }
}

impl<Y: Part, E: Rates<Y>> Pair<Y, E> for Dop853<Y, E> {
    type Dense = Dense<Y>;
    const ERROR_POWER: f64 = 8.0;
    const LONGEST: f64 = 10.0;
    const FIRST: f64 = Self::LONGEST;

    fn new() -> Self {
        Self {
            evaluations: [E::default(); STAGES],
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
        for i in 1..STEP_STAGES {
            self.stage(i, field);
        }
        self.end = *origin.y;
        for &(j, b) in B {
            self.end.add_scaled(step_s * b, self.evaluations[j].rates());
        }
        let fifth = self.combine(E5).weighed_square(weights);
        let third = self.combine(E3).weighed_square(weights);
        let scale = (fifth + 0.01 * third) * Y::STATES as f64;
        let error = if scale > 0.0 {
            step_s * fifth / scale.sqrt()
        } else {
            0.0
        };
        (self.end, error)
    }

    fn set_end(&mut self, end: E) {
        self.evaluations[END] = end;
    }

    fn seen(&self) -> &[E] {
        &self.evaluations[..=END]
    }

    fn dense(&mut self, field: &mut impl Field<Y, E>) -> Dense<Y> {
        for i in END + 1..STAGES {
            self.stage(i, field);
        }
        let h = self.step_s;
        let mut difference = self.end;
        difference.add_scaled(-1.0, &self.start);
        let mut f = [Y::default(); 7];
        f[0] = difference;
        f[1].add_scaled(h, self.evaluations[0].rates());
        f[1].add_scaled(-1.0, &difference);
        f[2].add_scaled(2.0, &difference);
        f[2].add_scaled(-h, self.evaluations[END].rates());
        f[2].add_scaled(-h, self.evaluations[0].rates());
        for (f, row) in f[3..].iter_mut().zip(D) {
            f.add_scaled(h, &self.combine(row));
        }
        Dense {
            start: self.start,
            f,
        }
    }

    fn dense_at(dense: &Dense<Y>, theta: f64) -> Y {
        dense.at(theta)
    }

    /// The pair's own weights: powers are integrated like states that nothing depends on.
    fn flows(&mut self, _field: &mut impl Field<Y, E>) -> Flows {
        let mut flows = Flows::default();
        for &(j, b) in B {
            flows.add_scaled(self.step_s * b, &self.evaluations[j].powers());
        }
        flows
    }
}

/// Interpolant of order 7 over one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dense<Y> {
    start: Y,
    f: [Y; 7],
}

impl<Y: Part> Dense<Y> {
    /// State at θ in [0, 1].
    fn at(&self, theta: f64) -> Y {
        let mut y = self.start;
        let mut factor = 1.0;
        for (i, f) in self.f.iter().enumerate() {
            factor *= if i % 2 == 0 { theta } else { 1.0 - theta };
            y.add_scaled(factor, f);
        }
        y
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::V2;
    use crate::integrate::frame::Frame;
    use crate::part::Body;

    impl Rates<Body> for Body {
        fn rates(&self) -> &Body {
            self
        }
        fn powers(&self) -> Flows {
            Flows::default()
        }
    }

    /// Harmonic oscillator with circular orbit, and the rate of the frame in which a method may turn.
    struct Circle(f64);

    impl Field<Body, Body> for Circle {
        fn at(&mut self, _t_s: f64, y: &Body) -> Body {
            Body {
                position: y.velocity,
                velocity: -y.position,
            }
        }
        fn along(&mut self, t_s: f64, _y: &Body, dy: &Body) -> Body {
            self.at(t_s, dy)
        }
        fn frame(&self, _y: &Body, _first: &Body) -> Frame {
            Frame {
                turn_rad_s: self.0,
                turn_rad_s2: 0.3 * self.0,
            }
        }
    }

    /// Errors of end and dense output over one step.
    fn errors<P: Pair<Body, Body>>(h: f64, turn_rad_s: f64) -> [f64; 3] {
        let mut circle = Circle(turn_rad_s);
        let y = Body {
            position: V2::new(1.0, 0.0),
            velocity: V2::new(0.0, 1.0),
        };
        // Tight enough that no iteration inside ends above the errors to be seen.
        let tight = 1e9;
        let weights = Weights {
            position: tight,
            gap: tight,
            velocity: tight,
            spin: tight,
            phase: tight,
            force: tight,
        };
        let mut pair = P::new();
        let first = circle.at(0.0, &y);
        let origin = Origin {
            t_s: 0.0,
            y: &y,
            first: &first,
        };
        pair.begin(&origin, &mut circle);
        let (end, estimate) = pair.step(&origin, h, &weights, &mut circle);
        pair.set_end(circle.at(h, &end));
        let dense = pair.dense(&mut circle);
        let middle = P::dense_at(&dense, 0.3);
        let exact = |t: f64| V2::new(t.cos(), t.sin());
        [
            (end.position - exact(h)).norm(),
            (middle.position - exact(0.3 * h)).norm(),
            estimate,
        ]
    }

    /// Powers of the step with which the errors of end and dense output and the error estimate fall,
    /// from a step and its half in a frame that may turn \[rad/s\]; and those of the half.
    pub(crate) fn orders<P: Pair<Body, Body>>(h: f64, turn_rad_s: f64) -> ([f64; 3], [f64; 3]) {
        let (coarse, fine) = (errors::<P>(h, turn_rad_s), errors::<P>(0.5 * h, turn_rad_s));
        (std::array::from_fn(|i| (coarse[i] / fine[i]).log2()), fine)
    }

    /// Local errors fall as h^9 (step) and h^8 (dense output): a wrong digit in the tableau breaks this.
    #[test]
    fn orders_are_eight_and_seven() {
        let ([step, dense, _], fine) = orders::<Dop853<Body, Body>>(1.0, 0.0);
        assert!((8.5..9.7).contains(&step), "step order {step}");
        assert!((7.5..8.7).contains(&dense), "dense order {dense}");
        assert!(fine[0] < 1e-9 && fine[1] < 1e-8);
    }
}
