//! The rotor and the rings of its stators as one linear body with ports:
//!
//! ```text
//! q̈ + (D + Ω·G)·q̇ + K·q = Σ_p S_pᵀ·f_p
//! ```
//!
//! in coordinates of unit mass, so that the mobility between two ports is S_a·S_bᵀ. The first four are √m·(x, y) and
//! √I_t·(φ, ψ), the slopes of the axis; then a pair for each bending mode and a pair for each ring.

use super::params::{MachineError, MachineParams, MachinePlane, Rotor, Unbalance};
use crate::V2;
use crate::params::{RingParams, StatorParams};
use nalgebra::DMatrix;

/// A square matrix by its entries that are not zero.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sparse(Vec<(usize, usize, f64)>);

impl Sparse {
    fn from_dense(n: usize, dense: &[f64]) -> Self {
        let entries = dense.iter().enumerate().filter(|(_, a)| **a != 0.0);
        Self(entries.map(|(i, a)| (i / n, i % n, *a)).collect())
    }

    /// `out += factor · A·x`.
    #[inline]
    pub(crate) fn add_product(&self, out: &mut [f64], factor: f64, x: &[f64]) {
        for (row, column, a) in &self.0 {
            out[*row] += factor * a * x[*column];
        }
    }

    /// Row, column and value of each.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.0.iter().copied()
    }

    /// xᵀ·A·x.
    pub(crate) fn quadratic(&self, x: &[f64]) -> f64 {
        self.0
            .iter()
            .map(|(row, column, a)| x[*row] * a * x[*column])
            .sum()
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Bound of its norm: the largest sum of a row's sizes.
    pub(crate) fn norm(&self, n: usize) -> f64 {
        let mut rows = vec![0.0; n];
        for (row, _, a) in &self.0 {
            rows[*row] += a.abs();
        }
        rows.into_iter().fold(0.0, f64::max)
    }
}

/// Where something acts or is read: a position is S·q, a force pushes by Sᵀ·f.
#[derive(Debug, Clone)]
pub(crate) struct Port {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Port {
    fn zero(n: usize) -> Self {
        Self {
            x: vec![0.0; n],
            y: vec![0.0; n],
        }
    }

    /// S·q.
    #[inline]
    pub(crate) fn of(&self, q: &[f64]) -> V2 {
        let (mut x, mut y) = (0.0, 0.0);
        for (q, (a, b)) in q.iter().zip(self.x.iter().zip(&self.y)) {
            x += a * q;
            y += b * q;
        }
        V2::new(x, y)
    }

    /// `out += Sᵀ·f`.
    #[inline]
    pub(crate) fn push(&self, out: &mut [f64], f: V2) {
        for (o, (a, b)) in out.iter_mut().zip(self.x.iter().zip(&self.y)) {
            *o += a * f.x + b * f.y;
        }
    }

    /// What coordinate i moves here: column i of S.
    pub(crate) fn column(&self, i: usize) -> V2 {
        V2::new(self.x[i], self.y[i])
    }

    /// Mobility of the port along x, which is that in every direction but for rings of unequal mountings \[1/kg\].
    pub(crate) fn mobility(&self) -> f64 {
        self.mobility_with(self)
    }

    /// Mobility between two ports along x \[1/kg\].
    pub(crate) fn mobility_with(&self, other: &Self) -> f64 {
        self.x.iter().zip(&other.x).map(|(a, b)| a * b).sum()
    }

    fn subtract(&mut self, other: &Self) {
        for (a, b) in self.x.iter_mut().zip(&other.x) {
            *a -= b;
        }
        for (a, b) in self.y.iter_mut().zip(&other.y) {
            *a -= b;
        }
    }
}

/// The body.
#[derive(Debug, Clone)]
pub(crate) struct LinearBody {
    pub(crate) n: usize,
    rotor: Rotor,
    pub(crate) stiffness: Sparse,
    pub(crate) damping: Sparse,
    /// Per unit of spin.
    pub(crate) gyroscopic: Sparse,
    /// Force of gravity on the coordinates.
    pub(crate) gravity: Vec<f64>,
    /// Unbalance: columns that its acceleration per eccentricity is multiplied by.
    pub(crate) unbalance: Option<Port>,
    pub(crate) magnets: Vec<Port>,
    pub(crate) loads: Vec<Port>,
    pub(crate) probes: Vec<Port>,
    /// Rotor against what it touches.
    pub(crate) contacts: Vec<Port>,
    /// Rotor at the planes, the rings that it touches there, and those below them.
    pub(crate) at_planes: Vec<Port>,
    pub(crate) rings: Vec<Option<Port>>,
    pub(crate) outer_rings: Vec<Option<Port>>,
    /// Centre of mass and slope of the axis.
    pub(crate) centre: Port,
    pub(crate) tilt: Port,
    /// Amplitudes of the bending modes, and the rates of the free shaft \[rad/s\].
    pub(crate) bending: Vec<(Port, f64)>,
}

fn rings_of(plane: &MachinePlane) -> Vec<RingParams> {
    match plane.stator {
        StatorParams::Rigid | StatorParams::RigidEllipse(_) => vec![],
        StatorParams::OneMass(ring) => vec![ring],
        StatorParams::TwoMass { inner, outer } => vec![inner, outer],
    }
}

/// Adds what a spring (or damper) of port S gives, SᵀkS.
fn add_at_port(dense: &mut [f64], n: usize, port: &Port, k: V2) {
    for row in 0..n {
        for column in 0..n {
            dense[row * n + column] +=
                k.x * port.x[row] * port.x[column] + k.y * port.y[row] * port.y[column];
        }
    }
}

/// A place on the rotor of a body of n coordinates.
fn on_rotor(rotor: &Rotor, n: usize, position_m: f64) -> Port {
    let rigid = rotor.rigid();
    let per_mass = 1.0 / rigid.mass_kg.sqrt();
    let per_inertia = 1.0 / rigid.transverse_inertia_kg_m2.sqrt();
    let mut port = Port::zero(n);
    (port.x[0], port.y[1]) = (per_mass, per_mass);
    (port.x[2], port.y[3]) = (position_m * per_inertia, position_m * per_inertia);
    for (i, mode) in rotor.bending().iter().enumerate() {
        let phi = per_mass * mode.displacement(position_m);
        (port.x[4 + 2 * i], port.y[5 + 2 * i]) = (phi, phi);
    }
    port
}

impl LinearBody {
    /// Puts rotor, supports and rings of a machine together.
    pub(crate) fn new(params: &MachineParams) -> Result<Self, MachineError> {
        Self::with_walls(params, false)
    }

    /// The same; where `closed`, with the contact springs and dampers of all planes as if the rotor never left its walls.
    pub(crate) fn with_walls(params: &MachineParams, closed: bool) -> Result<Self, MachineError> {
        params.validate()?;
        let rigid = params.rotor.rigid();
        let bending = params.rotor.bending();
        let rotor = 4 + 2 * bending.len();
        let n = rotor
            + params
                .planes
                .iter()
                .map(|p| 2 * rings_of(p).len())
                .sum::<usize>();
        let per_mass = 1.0 / rigid.mass_kg.sqrt();
        let per_inertia = 1.0 / rigid.transverse_inertia_kg_m2.sqrt();
        let at = |position_m: f64| on_rotor(&params.rotor, n, position_m);

        let (mut stiffness, mut damping, mut gyroscopic) =
            (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
        for (i, mode) in bending.iter().enumerate() {
            for row in [4 + 2 * i, 5 + 2 * i] {
                stiffness[row * n + row] += mode.frequency_rad_s * mode.frequency_rad_s;
                damping[row * n + row] += 2.0 * mode.damping_ratio * mode.frequency_rad_s;
            }
        }
        // Coordinates of slopes in pairs (x, y): the tilt, then the bending modes; before them those of the centre.
        let scale = |i: usize| if i == 1 { per_inertia } else { per_mass };
        let (slopes, motions) = (1 + bending.len(), 2 + bending.len());
        for i in 0..slopes {
            for j in 0..slopes {
                let g = params.rotor.polar_kg_m2(i, j) * scale(i + 1) * scale(j + 1);
                let (row, column) = (2 + 2 * i, 2 + 2 * j);
                gyroscopic[row * n + column + 1] += g;
                gyroscopic[(row + 1) * n + column] -= g;
            }
        }
        for (at, value) in params.rotor.damping_n_s_m().iter().enumerate() {
            let (i, j) = (at / motions, at % motions);
            let d = value * scale(i) * scale(j);
            let (row, column) = (2 * i, 2 * j);
            damping[row * n + column] += d;
            damping[(row + 1) * n + column + 1] += d;
        }
        for support in &params.supports {
            let port = at(support.position_m);
            add_at_port(&mut stiffness, n, &port, support.stiffness_n_m);
            add_at_port(&mut damping, n, &port, support.damping_n_s_m);
        }

        let mut contacts = Vec::new();
        let (mut rings, mut outer_rings) = (Vec::new(), Vec::new());
        let mut next = rotor;
        for plane in &params.planes {
            let mut contact = at(plane.position_m);
            let (mut inner, mut outer): (Option<Port>, Option<Port>) = (None, None);
            let mut mounted = rings_of(plane)
                .into_iter()
                .map(|ring| {
                    let mut port = Port::zero(n);
                    let free = 1.0 / ring.mass_kg.sqrt();
                    (port.x[next], port.y[next + 1]) = (free, free);
                    next += 2;
                    (ring, port)
                })
                .collect::<Vec<_>>()
                .into_iter()
                .peekable();
            while let Some((ring, port)) = mounted.next() {
                let mut stretch = port.clone();
                if let Some((_, below)) = mounted.peek() {
                    stretch.subtract(below);
                }
                add_at_port(&mut stiffness, n, &stretch, ring.stiffness_n_m);
                add_at_port(&mut damping, n, &stretch, ring.damping_n_s_m);
                match inner.is_none() {
                    true => inner = Some(port),
                    false => outer = Some(port),
                }
            }
            if let Some(ring) = &inner {
                contact.subtract(ring);
            }
            if closed {
                let (depth_m, grip_n_m) =
                    (plane.contact.clearance_m, plane.contact.stiffness_n_m());
                let damper_n_s_m = plane.contact.law.by_rate_n_s_m(depth_m);
                add_at_port(&mut stiffness, n, &contact, V2::repeat(grip_n_m));
                add_at_port(&mut damping, n, &contact, V2::repeat(damper_n_s_m));
            }
            contacts.push(contact);
            rings.push(inner);
            outer_rings.push(outer);
        }
        let pair = |i: usize, scale: f64| {
            let mut port = Port::zero(n);
            (port.x[i], port.y[i + 1]) = (scale, scale);
            port
        };

        let mut gravity = vec![0.0; n];
        let mut weight = Port::zero(n);
        (weight.x[0], weight.y[1]) = (rigid.mass_kg.sqrt(), rigid.mass_kg.sqrt());
        weight.push(&mut gravity, params.gravity_m_s2);

        let ports = |places: &mut dyn Iterator<Item = f64>| places.map(at).collect::<Vec<_>>();
        let mut body = Self {
            n,
            rotor: params.rotor.clone(),
            stiffness: Sparse::from_dense(n, &stiffness),
            damping: Sparse::from_dense(n, &damping),
            gyroscopic: Sparse::from_dense(n, &gyroscopic),
            gravity,
            unbalance: None,
            magnets: ports(&mut params.magnets.iter().map(|m| m.position_m)),
            loads: ports(&mut params.loads_m.iter().copied()),
            probes: ports(&mut params.probes_m.iter().copied()),
            contacts,
            at_planes: ports(&mut params.planes.iter().map(|p| p.position_m)),
            rings,
            outer_rings,
            centre: pair(0, per_mass),
            tilt: pair(2, per_inertia),
            bending: (bending.iter().enumerate())
                .map(|(i, mode)| (pair(4 + 2 * i, per_mass), mode.frequency_rad_s))
                .collect(),
        };
        for unbalance in &params.unbalances {
            body.add_unbalance(unbalance);
        }
        Ok(body)
    }

    /// The rotor that it has.
    pub(crate) fn rotor(&self) -> &Rotor {
        &self.rotor
    }

    /// Puts an unbalance on the rotor, beside those that it has.
    pub(crate) fn add_unbalance(&mut self, unbalance: &Unbalance) {
        if unbalance.moment_kg_m <= 0.0 {
            return;
        }
        let all = (self.unbalance).get_or_insert_with(|| Port::zero(self.n));
        let (sin, cos) = unbalance.angle_rad.sin_cos();
        let (along, across) = (unbalance.moment_kg_m * cos, unbalance.moment_kg_m * sin);
        let port = on_rotor(&self.rotor, self.n, unbalance.position_m);
        for i in 0..self.n {
            all.x[i] += along * port.x[i] + across * port.y[i];
            all.y[i] += along * port.y[i] - across * port.x[i];
        }
    }

    /// A of ż = A·z for z = (ω·q, q̇) without forces at a spin \[rad/s\], ω a rate that makes all entries of one size.
    pub(crate) fn generator(&self, rate_rad_s: f64, spin_rad_s: f64) -> DMatrix<f64> {
        let n = self.n;
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = rate_rad_s;
        }
        for (row, column, k) in &self.stiffness.0 {
            a[(n + row, *column)] -= k / rate_rad_s;
        }
        for (row, column, d) in &self.damping.0 {
            a[(n + row, n + column)] -= d;
        }
        for (row, column, g) in &self.gyroscopic.0 {
            a[(n + row, n + column)] -= spin_rad_s * g;
        }
        a
    }

    /// Rate of the fastest undamped motion, by a bound \[rad/s\].
    pub(crate) fn undamped_rate_rad_s(&self) -> f64 {
        self.stiffness.norm(self.n).sqrt()
    }
}
