//! A rotor with its magnets as a linear state space at a spin that is held, off the walls and with the rotor in the middle.
//!
//! ```text
//! ż = A·z + B·u,   y = C·z
//! ```

use super::body::{LinearBody, Port};
use super::linear::C;
use super::params::{MachineMagnet, MachineParams};
use crate::params::ParamError;
use nalgebra::{DMatrix, DVector};

/// The state space; positions are multiplied by a rate, which makes entries of one size.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearPlant {
    /// A, n × n.
    pub a: DMatrix<f64>,
    /// B, n × twice the magnets: x and y of what each magnet is commanded \[N\].
    pub b: DMatrix<f64>,
    /// C of the probes, twice their number × n: x and y of each \[m\].
    pub probes: DMatrix<f64>,
    /// The same of the rotor in its planes \[m\].
    pub planes: DMatrix<f64>,
    /// Force of the unbalance over Ω²·e^(jΩt), on the states.
    pub unbalance: DVector<C>,
    /// What each state is.
    pub states: Vec<LinearState>,
    /// How many of the first states are positions; as many velocities follow, in their order.
    positions: usize,
    /// What positions are multiplied by in the states, which makes entries of one size.
    rate_rad_s: f64,
}

/// A [`LinearPlant`] in the units of its states.
#[derive(Debug, Clone, PartialEq)]
pub struct PlantInUnits<'a> {
    /// A.
    pub a: DMatrix<f64>,
    /// B.
    pub b: DMatrix<f64>,
    /// C.
    pub c: DMatrix<f64>,
    /// What each state is.
    pub states: &'a [LinearState],
}

/// A state of a [`LinearPlant`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinearState {
    /// What it is, as `translation x` or `rate of bending 2 y`.
    pub name: String,
    /// Its unit in [`LinearPlant::in_units`].
    pub unit: &'static str,
}

/// How a magnet's force follows its command, about the middle.
enum Follower {
    /// At once.
    Held,
    /// ḟ = rate·(command − f) − back·v.
    First { rate_s: f64, back_n_m: f64 },
    /// f̈ = rate²·(command − f) − 2·ratio·rate·ḟ.
    Second { rate_s: f64, ratio: f64 },
}

impl Follower {
    fn new(magnet: &MachineMagnet) -> Self {
        let rate_s = 1.0 / magnet.lag_s;
        if let Some(poles) = &magnet.poles {
            // (6.8) with f = k_i·i: what the coil adds to the rate, and what the moving rotor induces.
            let per_ampere_n = magnet.force_max_n / poles.current_max_a;
            let (more_s, back_n_m) = poles.coil.map_or((0.0, 0.0), |coil| {
                (
                    coil.resistance_ohm / coil.inductance_h,
                    per_ampere_n * per_ampere_n / coil.inductance_h,
                )
            });
            return Self::First {
                rate_s: rate_s + more_s,
                back_n_m,
            };
        }
        match magnet.lag_damping_ratio {
            _ if magnet.lag_s <= 0.0 => Self::Held,
            Some(ratio) => Self::Second { rate_s, ratio },
            None => Self::First {
                rate_s,
                back_n_m: 0.0,
            },
        }
    }

    /// States of both axes.
    fn states(&self) -> usize {
        match self {
            Self::Held => 0,
            Self::First { .. } => 2,
            Self::Second { .. } => 4,
        }
    }
}

impl LinearPlant {
    /// Of a machine at a spin \[rad/s\].
    ///
    /// # Errors
    /// The first value that is out of range.
    pub fn new(params: &MachineParams, spin_rad_s: f64) -> Result<Self, ParamError> {
        let body = LinearBody::new(&params.linear_magnets())?;
        let rate_rad_s = body.undamped_rate_rad_s().max(1.0);
        let followers: Vec<Follower> = params.magnets.iter().map(Follower::new).collect();
        let of_body = 4 * body.pairs;
        let size = of_body + followers.iter().map(Follower::states).sum::<usize>();
        let mut a = DMatrix::zeros(size, size);
        a.view_mut((0, 0), (of_body, of_body))
            .copy_from(&body.generator(rate_rad_s, spin_rad_s));
        let mut b = DMatrix::zeros(size, 2 * followers.len());
        let mut states = body_states(params, &body);
        let mut at = of_body;
        for (magnet, follower) in followers.iter().enumerate() {
            let port = body.magnets[magnet].of_each();
            for axis in [0, 1] {
                let input = 2 * magnet + axis;
                let force = at + axis;
                for (pair, s) in port.iter().enumerate() {
                    let velocity = 2 * (body.pairs + pair) + axis;
                    match follower {
                        Follower::Held => b[(velocity, input)] = *s,
                        Follower::First { back_n_m, .. } => {
                            a[(velocity, force)] = *s;
                            a[(force, velocity)] = -back_n_m * s;
                        }
                        Follower::Second { .. } => a[(velocity, force)] = *s,
                    }
                }
                match *follower {
                    Follower::Held => {}
                    Follower::First { rate_s, .. } => {
                        a[(force, force)] = -rate_s;
                        b[(force, input)] = rate_s;
                    }
                    Follower::Second { rate_s, ratio } => {
                        // The rate of the force over that of the lag.
                        let slope = force + 2;
                        a[(force, slope)] = rate_s;
                        a[(slope, force)] = -rate_s;
                        a[(slope, slope)] = -2.0 * ratio * rate_s;
                        b[(slope, input)] = rate_s;
                    }
                }
            }
            let named = |what: &str, unit| {
                ["x", "y"].map(|axis| LinearState {
                    name: format!("{what} of magnet {} {axis}", magnet + 1),
                    unit,
                })
            };
            if follower.states() > 0 {
                states.extend(named("force", "N"));
            }
            if follower.states() > 2 {
                states.extend(named("rate of the force times the lag", "N"));
            }
            at += follower.states();
        }
        let mut unbalance = DVector::zeros(size);
        for (row, force) in body.unbalance_forces().into_iter().enumerate() {
            unbalance[2 * body.pairs + row] = force;
        }
        let rows = |ports: &[Port]| {
            DMatrix::from_fn(2 * ports.len(), size, |row, column| {
                let reads = column < 2 * body.pairs && row % 2 == column % 2;
                if reads {
                    ports[row / 2].of_each()[column / 2] / rate_rad_s
                } else {
                    0.0
                }
            })
        };
        Ok(Self {
            probes: rows(&body.probes),
            planes: rows(&body.at_planes),
            a,
            b,
            unbalance,
            states,
            positions: 2 * body.pairs,
            rate_rad_s,
        })
    }

    /// With these inputs and outputs in the units of the states: coordinates of unit mass, as the centre's position times the root
    /// of the mass.
    pub fn in_units(&self, b: &DMatrix<f64>, c: &DMatrix<f64>) -> PlantInUnits<'_> {
        let scale = |i: usize| {
            if i < self.positions {
                self.rate_rad_s
            } else {
                1.0
            }
        };
        let n = self.a.nrows();
        PlantInUnits {
            a: DMatrix::from_fn(n, n, |i, j| self.a[(i, j)] * scale(j) / scale(i)),
            b: DMatrix::from_fn(n, b.ncols(), |i, j| b[(i, j)] / scale(i)),
            c: DMatrix::from_fn(c.nrows(), n, |i, j| c[(i, j)] * scale(j)),
            states: &self.states,
        }
    }

    /// A and B of a period \[s\] in which the commands are held.
    pub fn sampled(&self, period_s: f64) -> (DMatrix<f64>, DMatrix<f64>) {
        let (n, inputs) = (self.a.nrows(), self.b.ncols());
        let mut whole = DMatrix::zeros(n + inputs, n + inputs);
        whole
            .view_mut((0, 0), (n, n))
            .copy_from(&(&self.a * period_s));
        whole
            .view_mut((0, n), (n, inputs))
            .copy_from(&(&self.b * period_s));
        let whole = whole.exp();
        (
            whole.view((0, 0), (n, n)).into_owned(),
            whole.view((0, n), (n, inputs)).into_owned(),
        )
    }

    /// Rate at which a motion turns \[rad/s\], by the velocities against the positions of its complex state: near enough to tell
    /// a mode from those that look the same at samples. `None` of a state without positions.
    pub fn turning_rad_s(&self, state: &[C]) -> Option<f64> {
        let n = self.positions;
        let size: f64 = state[..n].iter().map(C::norm_sqr).sum();
        let along: C = (0..n).map(|i| state[i].conj() * state[n + i]).sum();
        (size > 0.0).then(|| self.rate_rad_s * along.im / size)
    }
}

fn body_states(params: &MachineParams, body: &LinearBody) -> Vec<LinearState> {
    let rigid = params.rotor.rigid();
    let mut pairs = vec!["translation".to_owned()];
    if rigid.tilts() {
        pairs.push("tilt".to_owned());
    }
    pairs.extend((1..=params.rotor.bending().len()).map(|i| format!("bending {i}")));
    let rings = body.pairs - pairs.len();
    pairs.extend((1..=rings).map(|i| format!("housing {i}")));
    let of = |begin: &'static str, unit: &'static str| {
        let axes = |pair: String| {
            ["x", "y"].map(|axis| LinearState {
                name: format!("{begin}{pair} {axis}"),
                unit,
            })
        };
        (pairs.clone().into_iter())
            .flat_map(axes)
            .collect::<Vec<_>>()
    };
    [of("", "m √kg"), of("rate of ", "m √kg/s")].concat()
}
