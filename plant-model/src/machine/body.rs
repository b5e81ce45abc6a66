//! The rotor and the rings of its stators as one linear body with ports:
//!
//! ```text
//! q̈ + (D + Ω·G)·q̇ + K·q = Σ_p S_pᵀ·f_p
//! ```
//!
//! in coordinates of unit mass, pairs (x, y), so that a port is a number for each pair and the mobility between two ports the sum of
//! their products. The first pairs are √m·(x, y) and √I_t·(φ, ψ), the slopes of the axis, unless it does not tilt; then one for each
//! bending mode and each ring.

use super::params::{MachineParams, MachinePlane, Rotor, Unbalance};
use crate::V2;
use crate::params::ParamError;
use crate::params::{RingParams, StatorParams};
use crate::vector::rotate;
use nalgebra::{Complex, DMatrix};
use std::f64::consts::PI;

/// A square matrix over the pairs by its entries that are not zero: what x does to x and y to y, and what each does to the other.
#[derive(Debug, Clone, Default)]
pub(crate) struct Coupling {
    along: Vec<(usize, usize, V2)>,
    across: Vec<(usize, usize, V2)>,
}

impl Coupling {
    fn add_to(list: &mut Vec<(usize, usize, V2)>, at: (usize, usize), value: V2) {
        if value == V2::zeros() {
            return;
        }
        match list
            .iter_mut()
            .find(|(row, column, _)| (*row, *column) == at)
        {
            Some((_, _, sum)) => *sum += value,
            None => list.push((at.0, at.1, value)),
        }
    }

    /// Adds (xx, yy) of a row and a column.
    fn add_along(&mut self, at: (usize, usize), value: V2) {
        Self::add_to(&mut self.along, at, value);
    }

    /// Adds (xy, yx).
    fn add_across(&mut self, at: (usize, usize), value: V2) {
        Self::add_to(&mut self.across, at, value);
    }

    /// Adds what a spring (or damper) of port S gives, SᵀkS.
    fn add_at_port(&mut self, port: &Port, k: V2) {
        port.each_two(|at, s| self.add_along(at, s * k));
    }

    /// The same with (xy, yx).
    fn add_across_at_port(&mut self, port: &Port, k: V2) {
        port.each_two(|at, s| self.add_across(at, s * k));
    }

    /// `out += factor · A·x`.
    #[inline]
    pub(crate) fn add_product(&self, out: &mut [V2], factor: f64, x: &[V2]) {
        for (row, column, a) in &self.along {
            out[*row] += factor * a.component_mul(&x[*column]);
        }
        for (row, column, a) in &self.across {
            let x = x[*column];
            out[*row] += factor * V2::new(a.x * x.y, a.y * x.x);
        }
    }

    /// Rows and columns of what stays on an axis, and of what goes to the other one.
    pub(crate) fn along(&self) -> impl Iterator<Item = &(usize, usize, V2)> {
        self.along.iter()
    }

    pub(crate) fn across(&self) -> impl Iterator<Item = &(usize, usize, V2)> {
        self.across.iter()
    }

    /// Without entries that have come to zero.
    fn tidied(mut self) -> Self {
        for list in [&mut self.along, &mut self.across] {
            list.retain(|(_, _, a)| *a != V2::zeros());
        }
        self
    }

    /// Row, column and value of each, the coordinates of a pair one after the other.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let along = self.along.iter().flat_map(|(row, column, a)| {
            let (row, column) = (2 * row, 2 * column);
            [(row, column, a.x), (row + 1, column + 1, a.y)]
        });
        let across = self.across.iter().flat_map(|(row, column, a)| {
            let (row, column) = (2 * row, 2 * column);
            [(row, column + 1, a.x), (row + 1, column, a.y)]
        });
        along.chain(across)
    }

    /// xᵀ·A·x.
    pub(crate) fn quadratic(&self, x: &[V2]) -> f64 {
        let along = self.along.iter();
        let along = along.map(|(row, column, a)| x[*row].dot(&a.component_mul(&x[*column])));
        let across = self.across.iter().map(|(row, column, a)| {
            let (r, c) = (x[*row], x[*column]);
            r.x * a.x * c.y + r.y * a.y * c.x
        });
        along.sum::<f64>() + across.sum::<f64>()
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.along.is_empty() && self.across.is_empty()
    }

    /// Bound of its norm: the largest sum of a row's sizes.
    fn norm(&self, pairs: usize) -> f64 {
        let mut rows = vec![0.0; 2 * pairs];
        for (row, _, a) in self.entries() {
            rows[row] += a.abs();
        }
        rows.into_iter().fold(0.0, f64::max)
    }
}

/// Where something acts or is read, as a number for each pair: a position is Σ s·q, a force pushes by s·f.
#[derive(Debug, Clone)]
pub(crate) struct Port(Vec<f64>);

impl Port {
    fn zero(pairs: usize) -> Self {
        Self(vec![0.0; pairs])
    }

    fn of_pair(pairs: usize, pair: usize, s: f64) -> Self {
        let mut port = Self::zero(pairs);
        port.0[pair] = s;
        port
    }

    /// Σ s·q.
    #[inline]
    pub(crate) fn of(&self, q: &[V2]) -> V2 {
        (self.0.iter().zip(q)).fold(V2::zeros(), |sum, (s, q)| sum + *s * q)
    }

    /// `out += s·f`.
    #[inline]
    pub(crate) fn push(&self, out: &mut [V2], f: V2) {
        for (o, s) in out.iter_mut().zip(&self.0) {
            *o += *s * f;
        }
    }

    /// What a pair moves here.
    pub(crate) fn of_each(&self) -> &[f64] {
        &self.0
    }

    /// Calls for each row and column of SᵀS.
    fn each_two(&self, mut call: impl FnMut((usize, usize), f64)) {
        for (row, a) in self.0.iter().enumerate() {
            for (column, b) in self.0.iter().enumerate() {
                call((row, column), a * b);
            }
        }
    }

    /// Mobility of the port \[1/kg\].
    pub(crate) fn mobility(&self) -> f64 {
        self.mobility_with(self)
    }

    /// Mobility between two ports \[1/kg\].
    pub(crate) fn mobility_with(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(a, b)| a * b).sum()
    }

    fn subtract(&mut self, other: &Self) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a -= b;
        }
    }
}

/// Where an unbalance acts: a port for each pair with the angle on the rotor, along it and across.
#[derive(Debug, Clone)]
pub(crate) struct UnbalancePort(Vec<V2>);

impl UnbalancePort {
    /// What it has of each pair.
    pub(crate) fn of_each(&self) -> &[V2] {
        &self.0
    }

    /// What the pairs move along the direction of the spin and across it.
    pub(crate) fn of(&self, q: &[V2]) -> V2 {
        let each = self.0.iter().zip(q);
        each.fold(V2::zeros(), |sum, (u, q)| {
            sum + V2::new(u.dot(q), u.perp(q))
        })
    }

    /// `out += u·a`, turned by the angle.
    #[inline]
    pub(crate) fn push(&self, out: &mut [V2], a: V2) {
        for (o, u) in out.iter_mut().zip(&self.0) {
            *o += rotate(a, *u);
        }
    }
}

/// The body.
#[derive(Debug, Clone)]
pub(crate) struct LinearBody {
    /// Number of pairs, and how many of them are the rotor's: the first ones.
    pub(crate) pairs: usize,
    pub(crate) rotor_pairs: usize,
    rotor: Rotor,
    eccentricity_m: f64,
    pub(crate) stiffness: Coupling,
    /// The part of the stiffness in which nothing is stored: what of it goes round.
    pub(crate) swirl: Coupling,
    pub(crate) damping: Coupling,
    /// Per unit of spin.
    pub(crate) gyroscopic: Coupling,
    /// Force of gravity on the coordinates.
    pub(crate) gravity: Vec<V2>,
    /// Unbalance: what its acceleration per eccentricity is multiplied by.
    pub(crate) unbalance: Option<UnbalancePort>,
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

/// A place on the rotor of a body of so many pairs.
fn on_rotor(rotor: &Rotor, pairs: usize, position_m: f64) -> Port {
    let rigid = rotor.rigid();
    let per_mass = 1.0 / rigid.mass_kg.sqrt();
    let mut port = Port::zero(pairs);
    port.0[0] = per_mass;
    if rigid.tilts() {
        port.0[1] = position_m / rigid.transverse_inertia_kg_m2.sqrt();
    }
    for (s, mode) in port.0.iter_mut().skip(2).zip(rotor.bending()) {
        *s = per_mass * mode.displacement(position_m);
    }
    port
}

impl LinearBody {
    /// Puts rotor, supports and rings of a machine together.
    pub(crate) fn new(params: &MachineParams) -> Result<Self, ParamError> {
        Self::with_walls(params, false)
    }

    /// The same; where `closed`, with the contact springs and dampers of all planes as if the rotor never left its walls.
    pub(crate) fn with_walls(params: &MachineParams, closed: bool) -> Result<Self, ParamError> {
        params.validate()?;
        let rigid = params.rotor.rigid();
        let bending = params.rotor.bending();
        let rotor = if rigid.tilts() { 2 } else { 1 } + bending.len();
        let pairs = rotor
            + params
                .planes
                .iter()
                .map(|p| rings_of(p).len())
                .sum::<usize>();
        let per_mass = 1.0 / rigid.mass_kg.sqrt();
        let per_inertia = 1.0 / rigid.transverse_inertia_kg_m2.sqrt();
        let at = |position_m: f64| on_rotor(&params.rotor, pairs, position_m);

        let (mut stiffness, mut swirl) = (Coupling::default(), Coupling::default());
        let (mut damping, mut gyroscopic) = (Coupling::default(), Coupling::default());
        for (i, mode) in bending.iter().enumerate() {
            let (pair, rate) = ((2 + i, 2 + i), mode.frequency_rad_s);
            stiffness.add_along(pair, V2::repeat(rate * rate));
            damping.add_along(pair, V2::repeat(2.0 * mode.damping_ratio * rate));
        }
        // Pairs of slopes: the tilt, then the bending modes; before them that of the centre.
        let scale = |i: usize| if i == 1 { per_inertia } else { per_mass };
        let (slopes, motions) = (1 + bending.len(), 2 + bending.len());
        for i in 0..slopes {
            for j in (0..slopes).filter(|_| rigid.tilts()) {
                let g = params.rotor.polar_kg_m2(i, j) * scale(i + 1) * scale(j + 1);
                gyroscopic.add_across((1 + i, 1 + j), V2::new(g, -g));
            }
        }
        for (at, value) in params.rotor.damping_n_s_m().iter().enumerate() {
            let (i, j) = (at / motions, at % motions);
            damping.add_along((i, j), V2::repeat(value * scale(i) * scale(j)));
        }
        for support in &params.supports {
            let port = at(support.position_m);
            stiffness.add_at_port(&port, support.stiffness_n_m);
            damping.add_at_port(&port, support.damping_n_s_m);
            stiffness.add_across_at_port(&port, support.cross_stiffness_n_m);
            damping.add_across_at_port(&port, support.cross_damping_n_s_m);
            let k = support.cross_stiffness_n_m;
            swirl.add_across_at_port(&port, 0.5 * V2::new(k.x - k.y, k.y - k.x));
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
                    let port = Port::of_pair(pairs, next, 1.0 / ring.mass_kg.sqrt());
                    next += 1;
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
                stiffness.add_at_port(&stretch, ring.stiffness_n_m);
                damping.add_at_port(&stretch, ring.damping_n_s_m);
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
                stiffness.add_at_port(&contact, V2::repeat(grip_n_m));
                damping.add_at_port(&contact, V2::repeat(damper_n_s_m));
            }
            contacts.push(contact);
            rings.push(inner);
            outer_rings.push(outer);
        }
        let pair = |i: usize, s: f64| Port::of_pair(pairs, i, s);
        let mut gravity = vec![V2::zeros(); pairs];
        gravity[0] = rigid.mass_kg.sqrt() * params.gravity_m_s2;

        let ports = |places: &mut dyn Iterator<Item = f64>| places.map(at).collect::<Vec<_>>();
        let mut body = Self {
            eccentricity_m: 0.0,
            pairs,
            rotor_pairs: rotor,
            rotor: params.rotor.clone(),
            stiffness: stiffness.tidied(),
            swirl: swirl.tidied(),
            damping: damping.tidied(),
            gyroscopic: gyroscopic.tidied(),
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
            tilt: match rigid.tilts() {
                true => pair(1, per_inertia),
                false => Port::zero(pairs),
            },
            bending: (bending.iter().enumerate())
                .map(|(i, mode)| (pair(2 + i, per_mass), mode.frequency_rad_s))
                .collect(),
        };
        for unbalance in &params.unbalances {
            body.add_unbalance(unbalance);
        }
        body.move_centre(params.eccentricity_m);
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
        let all =
            (self.unbalance).get_or_insert_with(|| UnbalancePort(vec![V2::zeros(); self.pairs]));
        let (sin, cos) = unbalance.angle_rad.sin_cos();
        let moment = unbalance.moment_kg_m * V2::new(cos, sin);
        let port = on_rotor(&self.rotor, self.pairs, unbalance.position_m);
        for (u, s) in all.0.iter_mut().zip(&port.0) {
            *u += *s * moment;
        }
    }

    /// Puts the centre of mass elsewhere; other unbalances stay as they are.
    pub(crate) fn move_centre(&mut self, eccentricity_m: f64) {
        let more_m = eccentricity_m - self.eccentricity_m;
        self.eccentricity_m = eccentricity_m;
        self.add_unbalance(&Unbalance {
            position_m: 0.0,
            moment_kg_m: self.rotor.rigid().mass_kg * more_m.abs(),
            angle_rad: if more_m < 0.0 { PI } else { 0.0 },
        });
    }

    /// Force of the unbalance on each coordinate over Ω²·e^(jΩt): Ω²·(U_x·cos σ + U_y·sin σ) = Re(Ω²·(U_x − j·U_y)·e^jΩt).
    pub(crate) fn unbalance_forces(&self) -> Vec<Complex<f64>> {
        let mut force = vec![Complex::new(0.0, 0.0); 2 * self.pairs];
        for (axis, factor) in [
            (V2::x(), Complex::new(1.0, 0.0)),
            (V2::y(), Complex::new(0.0, -1.0)),
        ] {
            let mut pushed = vec![V2::zeros(); self.pairs];
            if let Some(unbalance) = &self.unbalance {
                unbalance.push(&mut pushed, axis);
            }
            for (f, x) in force.iter_mut().zip(pushed.iter().flatten()) {
                *f += factor * *x;
            }
        }
        force
    }

    /// A of ż = A·z for z = (ω·q, q̇) without forces at a spin \[rad/s\], ω a rate that makes all entries of one size.
    pub(crate) fn generator(&self, rate_rad_s: f64, spin_rad_s: f64) -> DMatrix<f64> {
        let n = 2 * self.pairs;
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = rate_rad_s;
        }
        for (row, column, k) in self.stiffness.entries() {
            a[(n + row, column)] -= k / rate_rad_s;
        }
        for (row, column, d) in self.damping.entries() {
            a[(n + row, n + column)] -= d;
        }
        for (row, column, g) in self.gyroscopic.entries() {
            a[(n + row, n + column)] -= spin_rad_s * g;
        }
        a
    }

    /// Rate of the fastest decay, by a bound \[1/s\].
    pub(crate) fn damping_rate_s(&self) -> f64 {
        self.damping.norm(self.pairs)
    }

    /// Rate of the fastest undamped motion, by a bound \[rad/s\].
    pub(crate) fn undamped_rate_rad_s(&self) -> f64 {
        self.stiffness.norm(self.pairs).sqrt()
    }
}
