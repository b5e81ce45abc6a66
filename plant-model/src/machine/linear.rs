//! A whole rotor as a linear system at a spin that is held: modes, critical speeds, response to its unbalance, and how its
//! planes feel each other.

use super::body::{LinearBody, Port};
use super::params::MachineParams;
use crate::params::ParamError;
use nalgebra::{Complex, DMatrix, DVector, Schur};

/// Which way a mode goes round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// With a positive spin: counter-clockwise.
    Forward,
    /// Clockwise.
    Backward,
    /// To and fro, as on mountings that differ along x and y.
    Planar,
}

impl Direction {
    /// Of motions X, Y in x = Re(X·e^jωt) and y likewise, ω > 0, at some places: by where it moves most.
    pub fn of(motions: impl Iterator<Item = [C; 2]>) -> Self {
        let (mut forward, mut backward) = (0.0, 0.0);
        for motion in motions {
            forward = f64::max(forward, circular(motion, 1.0).norm());
            backward = f64::max(backward, circular(motion, -1.0).norm());
        }
        match (forward - backward) / forward.max(backward) {
            d if d > TOLD_APART => Self::Forward,
            d if d < -TOLD_APART => Self::Backward,
            _ => Self::Planar,
        }
    }

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Backward => "backward",
            Self::Planar => "planar",
        }
    }
}

/// A mode of the linear rotor: supports and rings included, magnets without command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineMode {
    /// Damped frequency \[rad/s\], ≥ 0.
    pub frequency_rad_s: f64,
    /// Rate of growth \[1/s\]; below zero it decays.
    pub growth_s: f64,
    /// −growth over the length of the eigenvalue, from −1 to 1; 0 for a rigid motion that nothing holds.
    pub damping_ratio: f64,
    /// By where the rotor moves most in the planes. Of two modes that are one mixture, as at standstill, one counts as each.
    pub direction: Direction,
}

/// What the walls do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Walls {
    /// Nothing: the rotor is off them.
    #[default]
    Off,
    /// Contact springs and dampers of all planes hold it, without friction and as if it never left.
    Closed,
}

/// A spin at which the unbalance turns as fast as a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalSpeed {
    /// Without damping \[rad/s\].
    pub spin_rad_s: f64,
    /// Which way the mode goes round there; an unbalance excites those that go forward.
    pub direction: Direction,
}

/// A linear machine.
#[derive(Debug, Clone)]
pub struct LinearMachine {
    pub(super) body: LinearBody,
    rate_rad_s: f64,
    /// Of each plane; none where they are closed and in the body already.
    pub(super) walls: Option<Vec<Wall>>,
}

/// What a plane is to whirl that slides or rolls there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wall {
    pub(super) clearance_m: f64,
    pub(super) stiffness_n_m: f64,
    /// Sliding friction at rest less rolling friction.
    pub(super) driving_friction: f64,
}

/// A complex number.
pub type C = Complex<f64>;

/// Share of the larger amplitude by which forward and backward must differ to be told apart.
const TOLD_APART: f64 = 1e-6;
/// Growth below this share of an eigenvalue is rounding.
const ROUNDING: f64 = 1e-12;
/// Rates within this share of each other are those of one mixture of modes.
const ALIKE: f64 = 1e-6;

impl LinearMachine {
    /// Of a machine.
    ///
    /// # Errors
    /// The first value that is out of range.
    pub fn new(params: &MachineParams, state: Walls) -> Result<Self, ParamError> {
        let body = LinearBody::with_walls(params, state == Walls::Closed)?;
        let rate_rad_s = body.undamped_rate_rad_s().max(1.0);
        let walls = params.planes.iter().map(|plane| Wall {
            clearance_m: plane.contact.clearance_m,
            stiffness_n_m: plane.contact.stiffness_n_m(),
            driving_friction: (plane.friction.sliding.coefficient(0.0)
                - plane.friction.rolling_coefficient)
                .max(0.0),
        });
        Ok(Self {
            walls: (state == Walls::Off).then(|| walls.collect()),
            body,
            rate_rad_s,
        })
    }

    /// Modes at a spin \[rad/s\], slowest first; a pair of eigenvalues counts once. The more modes bend, the longer it takes:
    /// the third power of their number. `None` where the search for eigenvalues does not end, as with rates too far apart.
    pub fn modes(&self, spin_rad_s: f64) -> Option<Vec<MachineMode>> {
        let a = self.body.generator(self.rate_rad_s, spin_rad_s);
        let values = eigenvalues(&a)?;
        let complex = a.map(|x| C::new(x, 0.0));
        let turning = values.iter().filter(|value| value.im >= 0.0);
        let modes = turning.map(|value| match value.im {
            0.0 => (*value, Direction::Planar),
            _ => (*value, self.direction(&complex, *value)),
        });
        let modes = modes_of(modes, self.rate_rad_s);
        Some(modes)
    }

    /// Critical speeds, slowest first: K·q = Ω²·(1 − jG)·q, of which a rotor that turns into a disc has no forward one. `None`
    /// as of [`Self::modes`].
    pub fn critical_speeds(&self) -> Option<Vec<CriticalSpeed>> {
        if self.body.stiffness.is_zero() {
            return Some(Vec::new());
        }
        let n = 2 * self.body.pairs;
        // 1 − jG as a real matrix on real and imaginary parts, K likewise; Ω² = 1/μ − s for the eigenvalues μ of
        // (K + s·B)⁻¹·B, which there are where B or K is singular, too.
        let mut b = DMatrix::identity(2 * n, 2 * n);
        for (row, column, g) in self.body.gyroscopic.entries() {
            b[(row, n + column)] += g;
            b[(n + row, column)] -= g;
        }
        let mut k = DMatrix::zeros(2 * n, 2 * n);
        for (row, column, value) in self.body.stiffness.entries() {
            k[(row, column)] += value;
            k[(n + row, n + column)] += value;
        }
        let shift = self.rate_rad_s * self.rate_rad_s * SHIFT;
        let inverse = (k + shift * &b).try_inverse()?;
        let mut speeds: Vec<f64> = eigenvalues(&(inverse * b))?
            .iter()
            .filter(|mu| mu.re.abs() * shift > 1e-10 && mu.im.abs() <= ALIKE * mu.re.abs())
            .map(|mu| 1.0 / mu.re - shift)
            .filter(|square| *square > ALIKE * shift)
            .map(f64::sqrt)
            .collect();
        speeds.sort_by(f64::total_cmp);
        // Real and imaginary part of one vector count twice.
        let mut speeds = speeds.into_iter().step_by(2).peekable();
        let mut all = Vec::new();
        while let Some(spin_rad_s) = speeds.next() {
            let twice = speeds.next_if(|next| (next - spin_rad_s).abs() <= ALIKE * spin_rad_s);
            let directions = match twice {
                // Any mixture of the two is a mode.
                Some(_) => vec![Direction::Backward, Direction::Forward],
                None => {
                    let a = self.undamped(spin_rad_s);
                    vec![self.direction(&a, C::new(0.0, spin_rad_s))]
                }
            };
            all.extend(directions.into_iter().map(|direction| CriticalSpeed {
                spin_rad_s,
                direction,
            }));
        }
        Some(all)
    }

    /// The generator at a spin without its damping.
    fn undamped(&self, spin_rad_s: f64) -> DMatrix<C> {
        let n = 2 * self.body.pairs;
        let mut a = self.body.generator(self.rate_rad_s, spin_rad_s);
        for (row, column, d) in self.body.damping.entries() {
            a[(n + row, n + column)] += d;
        }
        a.map(|x| C::new(x, 0.0))
    }

    /// Receptance at a frequency \[rad/s\] and a spin: motions x, y of plane after plane per force along x, y of plane after
    /// plane \[m/N\], of the rotor against what it touches there; `None` where an undamped mode is hit.
    pub fn receptance(&self, frequency_rad_s: f64, spin_rad_s: f64) -> Option<DMatrix<C>> {
        let ports = &self.body.contacts;
        let inverse = self
            .dynamic_stiffness(frequency_rad_s, spin_rad_s)
            .try_inverse()?;
        let rows = DMatrix::from_fn(2 * ports.len(), 2 * self.body.pairs, |row, i| {
            let s = ports[row / 2].of_each()[i / 2];
            C::new(if row % 2 == i % 2 { s } else { 0.0 }, 0.0)
        });
        Some(&rows * inverse * rows.transpose())
    }

    /// Steady response to the unbalance at a spin \[rad/s\]: largest distance from the middle, of the rotor in each plane \[m\],
    /// then at each probe; `None` where an undamped mode is hit.
    pub fn unbalance_response_m(&self, spin_rad_s: f64) -> Option<Vec<f64>> {
        let body = &self.body;
        let ports = || body.at_planes.iter().chain(&body.probes);
        if body.unbalance.is_none() {
            return Some(ports().map(|_| 0.0).collect());
        }
        let square = spin_rad_s * spin_rad_s;
        let force = DVector::from_vec(body.unbalance_forces()) * C::new(square, 0.0);
        let motion = self
            .dynamic_stiffness(spin_rad_s, spin_rad_s)
            .lu()
            .solve(&force)?;
        Some(
            ports()
                .map(|port| half_axis(motion_at(port, motion.as_slice())))
                .collect(),
        )
    }

    fn dynamic_stiffness(&self, frequency_rad_s: f64, spin_rad_s: f64) -> DMatrix<C> {
        let (body, omega) = (&self.body, frequency_rad_s);
        let mut a = DMatrix::from_diagonal_element(
            2 * body.pairs,
            2 * body.pairs,
            C::new(-omega * omega, 0.0),
        );
        for (row, column, k) in body.stiffness.entries() {
            a[(row, column)] += C::new(k, 0.0);
        }
        for (row, column, d) in body.damping.entries() {
            a[(row, column)] += C::new(0.0, omega * d);
        }
        for (row, column, g) in body.gyroscopic.entries() {
            a[(row, column)] += C::new(0.0, omega * spin_rad_s * g);
        }
        a
    }

    /// Mobility of the rotor between its planes \[1/kg\], row by row: velocity of one by an impulse on another, eq. (6.4). One
    /// over a number of the diagonal is the mass that a plane feels at an impact.
    pub fn mobility(&self) -> Vec<Vec<f64>> {
        let ports = &self.body.at_planes;
        ports
            .iter()
            .map(|a| ports.iter().map(|b| a.mobility_with(b)).collect())
            .collect()
    }

    /// Shapes of the modes of [`Self::modes`] that turn or swing, in their order: motion at each probe, as a complex number
    /// x ± j·y of its larger sense, largest 1. Of a mixture any one is given. `None` as of [`Self::modes`].
    pub fn shapes(&self, spin_rad_s: f64) -> Option<Vec<(MachineMode, Vec<C>)>> {
        let a = self.body.generator(self.rate_rad_s, spin_rad_s);
        let complex = a.map(|x| C::new(x, 0.0));
        let modes = self.modes(spin_rad_s)?.into_iter();
        let turning = modes.filter(|mode| mode.frequency_rad_s > 0.0);
        Some(
            turning
                .map(|mode| {
                    let value = C::new(mode.growth_s, mode.frequency_rad_s);
                    (mode, self.shape(&complex, value))
                })
                .collect(),
        )
    }

    fn shape(&self, a: &DMatrix<C>, value: C) -> Vec<C> {
        let Some(vector) = self.vector(a, value) else {
            return vec![C::new(0.0, 0.0); self.body.probes.len()];
        };
        let motion = vector_of(&vector, 2 * self.body.pairs);
        let probes = self.body.probes.iter();
        let motions: Vec<[C; 2]> = probes.map(|port| motion_at(port, motion)).collect();
        shape_of(&motions)
    }

    /// Which way the eigenvector goes round.
    fn direction(&self, a: &DMatrix<C>, value: C) -> Direction {
        let Some(vector) = self.vector(a, value) else {
            return Direction::Planar;
        };
        let ports = self.body.at_planes.iter().chain(&self.body.contacts);
        let moved = vector_of(&vector, 2 * self.body.pairs);
        Direction::of(ports.map(|port| motion_at(port, moved)))
    }

    fn vector(&self, a: &DMatrix<C>, value: C) -> Option<DVector<C>> {
        eigenvector(a, value, self.rate_rad_s.min(1e3 * value.norm()))
    }
}

/// Shape of motions X, Y in x = Re(X·e^jωt) and y likewise: each as a complex number x ± j·y of the larger sense of all, largest 1.
pub fn shape_of(motions: &[[C; 2]]) -> Vec<C> {
    let turning = |sign: f64| {
        let motions = motions.iter();
        motions
            .map(move |motion| circular(*motion, sign))
            .collect::<Vec<C>>()
    };
    let size = |shape: &[C]| shape.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let [ahead, back] = [1.0, -1.0].map(turning);
    let shape = if size(&ahead) >= size(&back) {
        ahead
    } else {
        back
    };
    let largest = shape
        .iter()
        .copied()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()));
    match largest.filter(|z| z.norm() > 0.0) {
        Some(largest) => shape.into_iter().map(|z| z / largest).collect(),
        None => shape,
    }
}

/// Modes of eigenvalues that turn forward in time or do not turn, slowest first. Of those whose rates differ by a small share of
/// the one given, two that follow each other are one mixture.
pub fn modes_of(values: impl Iterator<Item = (C, Direction)>, rate_rad_s: f64) -> Vec<MachineMode> {
    let mut modes: Vec<MachineMode> = values
        .map(|(value, direction)| MachineMode {
            frequency_rad_s: value.im,
            growth_s: value.re,
            damping_ratio: match value.norm() {
                size if value.re.abs() > ROUNDING * size => -value.re / size,
                _ => 0.0,
            },
            direction,
        })
        .collect();
    modes.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
    part_mixtures(&mut modes, rate_rad_s);
    modes
}

/// The eigenvector of an eigenvalue, from inverse iteration a little beside it: `beside` is the size by which eigenvalues differ.
pub fn eigenvector(a: &DMatrix<C>, value: C, beside: f64) -> Option<DVector<C>> {
    let n = a.nrows();
    let near = value + C::new(1e-9, 1e-9) * beside;
    // No mode is orthogonal to this by construction.
    let mut vector = DVector::from_fn(n, |i, _| {
        C::new(1.0 + 0.37 * (i as f64).sin(), 0.41 * (i as f64).cos())
    });
    let factors = (a - DMatrix::from_diagonal_element(n, n, near)).lu();
    for _ in 0..3 {
        let next = factors.solve(&vector)?;
        let size = next.norm();
        vector = next / C::new(size, 0.0);
    }
    Some(vector)
}

/// The positions of an eigenvector.
fn vector_of(vector: &DVector<C>, n: usize) -> &[C] {
    &vector.as_slice()[..n]
}

/// Eigenvalues by Schur's form; `None` where its iteration does not end.
///
/// The iteration has no exceptional shifts and may go round in circles, as it does with two like pairs. Seen from other axes the
/// same matrix ends; only then is less than rounding asked of it.
pub fn eigenvalues(a: &DMatrix<f64>) -> Option<DVector<C>> {
    const SWEEPS: usize = 100;
    const TURNS: usize = 4;
    let most = SWEEPS * a.nrows();
    let real = |eps: f64| {
        let mut seen = a.clone();
        (0..TURNS).find_map(|turn| {
            if turn > 0 {
                reflect(&mut seen, turn);
            }
            Schur::try_new(seen.clone(), eps, most).map(|schur| schur.complex_eigenvalues())
        })
    };
    let complex = |eps: f64| {
        let schur = Schur::try_new(a.map(|x| C::new(x, 0.0)), eps, most)?;
        // Of real ones rounding leaves an imaginary part.
        let values = schur.eigenvalues()?;
        let real = |z: C| {
            if z.im.abs() <= ALIKE * z.norm() {
                C::new(z.re, 0.0)
            } else {
                z
            }
        };
        Some(values.map(real))
    };
    let tolerances = [f64::EPSILON, 1e-14, 1e-12];
    (tolerances.into_iter().find_map(real)).or_else(|| tolerances.into_iter().find_map(complex))
}

/// The matrix seen in a mirror: (1 − 2vvᵀ)·A·(1 − 2vvᵀ).
fn reflect(a: &mut DMatrix<f64>, turn: usize) {
    let v = DVector::from_fn(a.nrows(), |i, _| {
        ((i + 1) as f64 * (0.7 + turn as f64)).sin()
    });
    let v = v.normalize();
    let row = v.transpose() * &*a;
    *a -= 2.0 * &v * row;
    let column = &*a * &v;
    *a -= 2.0 * column * v.transpose();
}

/// Where the pencil of the critical speeds is shifted to, of the largest square of a rate.
const SHIFT: f64 = 1e-8;

/// The part of a motion that goes forward (sign 1) or backward (−1), x = Re(X·e^jωt) and y likewise: (X ± jY)/2.
fn circular([x, y]: [C; 2], sign: f64) -> C {
    0.5 * (x + sign * C::i() * y)
}

/// Motion at a place.
fn motion_at(port: &Port, motion: &[C]) -> [C; 2] {
    let pairs = || port.of_each().iter().zip(motion.chunks_exact(2));
    [0, 1].map(|axis| pairs().map(|(s, z)| *s * z[axis]).sum())
}

/// The larger half axis of the ellipse of a motion X, Y in x = Re(X·e^jωt) and y likewise.
pub fn half_axis(motion: [C; 2]) -> f64 {
    circular(motion, 1.0).norm() + circular(motion, -1.0).norm()
}

/// Of two modes that are alike any mixture is one as well: one counts as forward, one as backward.
fn part_mixtures(modes: &mut [MachineMode], rate_rad_s: f64) {
    let mut i = 0;
    while i + 1 < modes.len() {
        let (a, b) = (modes[i], modes[i + 1]);
        let apart = (a.frequency_rad_s - b.frequency_rad_s).hypot(a.growth_s - b.growth_s);
        let alike =
            a.frequency_rad_s > 0.0 && apart <= ALIKE * a.frequency_rad_s.max(ALIKE * rate_rad_s);
        if alike {
            modes[i].direction = Direction::Backward;
            modes[i + 1].direction = Direction::Forward;
            i += 1;
        }
        i += 1;
    }
}
