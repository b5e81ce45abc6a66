//! The coordinates' power series, for so many pairs as the compiler knows: a rotor of one or two pairs does not pay for one with many.

#![allow(
    clippy::needless_range_loop,
    reason = "iterators that end where the shorter of two does cost a third more here"
)]

use super::body::{Coupling, LinearBody, Port};
use super::params::{MAX_MAGNETS, MAX_MOTIONS, MAX_PLANES};
use super::plane_series::{PlaneSeries, State};
use crate::V2;
use crate::series::{INVERSE, LENGTH, Series};
use crate::vector::rotate;

/// Most pairs over which loops have a length of their own; beyond, they run over those that there are.
const UNROLLED: usize = 8;

/// What acts on the coordinates at one order, apart from what they do to each other.
#[derive(Clone, Copy)]
pub(super) struct Pushes<'a> {
    /// Held forces on the pairs; none but at the first order.
    pub(super) forces: &'a [V2],
    pub(super) magnets: &'a [Series],
    pub(super) planes: &'a [PlaneSeries],
    /// Acceleration of the unbalance per eccentricity.
    pub(super) unbalance: V2,
}

/// A matrix over the pairs, with what of it is zero.
#[derive(Debug, Clone)]
struct Matrix<const P: usize> {
    /// P rows; on the heap, as those of many pairs are large.
    entries: Vec<[V2; P]>,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Zero,
    Diagonal,
    Full,
}

impl<const P: usize> Matrix<P> {
    fn of<'a>(entries: impl Iterator<Item = &'a (usize, usize, V2)>) -> Self {
        let mut matrix = Self {
            entries: vec![[V2::zeros(); P]; P],
            kind: Kind::Zero,
        };
        for (row, column, a) in entries {
            matrix.entries[*row][*column] += a;
            matrix.kind = match (matrix.kind, row == column) {
                (Kind::Full, _) | (_, false) => Kind::Full,
                _ => Kind::Diagonal,
            };
        }
        matrix
    }

    /// `out −= A·x` over n pairs, with what `turn` makes of a pair of x.
    #[inline(always)]
    fn subtract(&self, out: &mut [V2; P], x: &[V2; P], n: usize, turn: impl Fn(V2) -> V2) {
        let Some(entries) = self.entries.first_chunk::<P>() else {
            return;
        };
        match self.kind {
            Kind::Zero => {}
            Kind::Diagonal => {
                for i in 0..n {
                    out[i] -= entries[i][i].component_mul(&turn(x[i]));
                }
            }
            Kind::Full => {
                for i in 0..n {
                    for j in 0..n {
                        out[i] -= entries[i][j].component_mul(&turn(x[j]));
                    }
                }
            }
        }
    }
}

/// What an axis has of the other one, for the entries (xy, yx).
#[inline(always)]
fn crossed(x: V2) -> V2 {
    V2::new(x.y, x.x)
}

/// Coefficients of all pairs, order by order, with what couples them.
#[derive(Debug, Clone)]
pub(super) struct Rows<const P: usize> {
    pairs: usize,
    rotor_pairs: usize,
    position: [[V2; P]; LENGTH],
    velocity: [[V2; P]; LENGTH],
    /// On the same axis, and across.
    stiffness: [Matrix<P>; 2],
    swirl: Matrix<P>,
    damping: [Matrix<P>; 2],
    gyroscopic: Matrix<P>,
    magnets: [[f64; P]; MAX_MAGNETS],
    contacts: [[f64; P]; MAX_PLANES],
    unbalance: Option<[V2; P]>,
}

/// Rows of as many pairs as there are, or somewhat more.
#[derive(Debug, Clone)]
pub(super) enum AnyRows {
    One(Box<Rows<1>>),
    Two(Box<Rows<2>>),
    Four(Box<Rows<4>>),
    Eight(Box<Rows<UNROLLED>>),
    Many(Box<Rows<MAX_MOTIONS>>),
}

/// The same call of whichever it is.
macro_rules! of_rows {
    ($any:expr, $rows:ident => $call:expr) => {
        match $any {
            AnyRows::One($rows) => $call,
            AnyRows::Two($rows) => $call,
            AnyRows::Four($rows) => $call,
            AnyRows::Eight($rows) => $call,
            AnyRows::Many($rows) => $call,
        }
    };
}
pub(super) use of_rows;

impl AnyRows {
    pub(super) fn new(body: &LinearBody) -> Self {
        match body.pairs {
            1 => Self::One(Rows::new(body)),
            2 => Self::Two(Rows::new(body)),
            3..=4 => Self::Four(Rows::new(body)),
            5..=UNROLLED => Self::Eight(Rows::new(body)),
            _ => Self::Many(Rows::new(body)),
        }
    }
}

#[inline(always)]
fn push<const P: usize>(out: &mut [V2; P], port: &[f64; P], n: usize, f: V2) {
    for i in 0..n {
        out[i] += port[i] * f;
    }
}

/// The same of an unbalance.
#[inline(always)]
fn turn<const P: usize>(out: &mut [V2; P], port: &[V2; P], n: usize, acceleration: V2) {
    for i in 0..n {
        out[i] += rotate(acceleration, port[i]);
    }
}

#[inline(always)]
fn read<const P: usize>(row: &[V2; P], port: &[f64; P], n: usize) -> V2 {
    let mut sum = row[0] * port[0];
    for i in 1..n {
        sum += port[i] * row[i];
    }
    sum
}

impl<const P: usize> Rows<P> {
    fn new(body: &LinearBody) -> Box<Self> {
        let along = |a: &Coupling| Matrix::of(a.along());
        let across = |a: &Coupling| Matrix::of(a.across());
        let port = |port: &Port| padded(port.of_each(), 0.0);
        let mut rows = Box::new(Self {
            pairs: body.pairs,
            rotor_pairs: body.rotor_pairs,
            position: [[V2::zeros(); P]; LENGTH],
            velocity: [[V2::zeros(); P]; LENGTH],
            stiffness: [along(&body.stiffness), across(&body.stiffness)],
            swirl: across(&body.swirl),
            damping: [along(&body.damping), across(&body.damping)],
            gyroscopic: across(&body.gyroscopic),
            magnets: [[0.0; P]; MAX_MAGNETS],
            contacts: [[0.0; P]; MAX_PLANES],
            unbalance: None,
        });
        for (row, of) in rows.magnets.iter_mut().zip(&body.magnets) {
            *row = port(of);
        }
        for (row, of) in rows.contacts.iter_mut().zip(&body.contacts) {
            *row = port(of);
        }
        rows.unbalance = body
            .unbalance
            .as_ref()
            .map(|u| padded(u.of_each(), V2::zeros()));
        rows
    }

    /// How far loops over the pairs go.
    #[inline(always)]
    fn n(&self) -> usize {
        if P <= UNROLLED { P } else { self.pairs }
    }

    /// Puts coefficients k.
    pub(super) fn set(&mut self, k: usize, position: &[V2], velocity: &[V2]) {
        self.position[k][..position.len()].copy_from_slice(position);
        self.velocity[k][..velocity.len()].copy_from_slice(velocity);
    }

    /// Coefficients k + 1 of positions.
    #[inline(always)]
    pub(super) fn extend_positions(&mut self, k: usize, next: f64) {
        let n = self.n();
        let (q, v) = (&mut self.position[k + 1], &self.velocity[k]);
        for i in 0..n {
            q[i] = next * v[i];
        }
    }

    /// Coefficients k + 1 of velocities. The spin is a number where it is held, a series up to k where it is free.
    #[inline(always)]
    pub(super) fn extend_velocities(
        &mut self,
        (k, next): (usize, f64),
        pushes: Pushes<'_>,
        spin: &[f64],
    ) {
        let n = self.n();
        let mut a = [V2::zeros(); P];
        for (a, f) in a.iter_mut().zip(pushes.forces) {
            *a = *f;
        }
        let (position, velocity) = (&self.position[k], &self.velocity[k]);
        self.stiffness[0].subtract(&mut a, position, n, |x| x);
        self.stiffness[1].subtract(&mut a, position, n, crossed);
        self.damping[0].subtract(&mut a, velocity, n, |x| x);
        self.damping[1].subtract(&mut a, velocity, n, crossed);
        if self.gyroscopic.kind != Kind::Zero {
            match spin {
                [held] => self
                    .gyroscopic
                    .subtract(&mut a, velocity, n, |x| *held * crossed(x)),
                free => {
                    // Coefficient k of the product of spin and speeds.
                    let mut spun = [V2::zeros(); P];
                    for (spin, row) in free[..=k].iter().rev().zip(&self.velocity) {
                        push_all(&mut spun, row, n, *spin);
                    }
                    self.gyroscopic.subtract(&mut a, &spun, n, crossed);
                }
            }
        }
        for (series, port) in pushes.magnets.iter().zip(&self.magnets) {
            push(&mut a, port, n, series.0[k]);
        }
        for (plane, port) in pushes.planes.iter().zip(&self.contacts) {
            if plane.state == State::Touched {
                push(&mut a, port, n, plane.reaction);
            }
        }
        if let Some(unbalance) = &self.unbalance {
            turn(&mut a, unbalance, n, pushes.unbalance);
        }
        let v = &mut self.velocity[k + 1];
        for i in 0..n {
            v[i] = next * a[i];
        }
    }

    /// Adds to the coefficients k of velocities what a force in a plane and the unbalance make of them.
    #[inline(always)]
    pub(super) fn add_to_velocities(
        &mut self,
        k: usize,
        (plane, force): (usize, V2),
        acceleration: V2,
    ) {
        let n = self.n();
        push(&mut self.velocity[k], &self.contacts[plane], n, force);
        if let Some(unbalance) = &self.unbalance {
            turn(&mut self.velocity[k], unbalance, n, acceleration);
        }
    }

    /// Coefficients k of the rates of gaps in planes that the rotor is not inside of.
    #[inline(always)]
    pub(super) fn read_rates(&self, planes: &mut [PlaneSeries], k: usize) {
        for (plane, port) in planes.iter_mut().zip(&self.contacts) {
            if plane.state != State::Inside {
                plane.gap_rate.0[k] = read(&self.velocity[k], port, self.n());
            }
        }
    }

    /// Coefficient k of a plane's gap rate, and of its gap without the offset of its bore.
    pub(super) fn gap_rate(&self, plane: usize, k: usize) -> V2 {
        read(&self.velocity[k], &self.contacts[plane], self.n())
    }

    pub(super) fn gap(&self, plane: usize, k: usize) -> V2 {
        read(&self.position[k], &self.contacts[plane], self.n())
    }

    /// Squares of the lengths of coefficients k: positions, velocities.
    #[inline(always)]
    pub(super) fn squares(&self, k: usize) -> (f64, f64) {
        let of = |row: &[V2; P]| {
            let mut sum = V2::zeros();
            for i in 0..self.n() {
                sum += row[i].component_mul(&row[i]);
            }
            sum.x + sum.y
        };
        (of(&self.position[k]), of(&self.velocity[k]))
    }

    /// Positions and velocities at θ.
    pub(super) fn at(&self, theta: f64, order: usize, position: &mut [V2], velocity: &mut [V2]) {
        for (rows, out) in [(&self.position, position), (&self.velocity, velocity)] {
            let n = out.len();
            let [sums] = self.values(rows, &[theta], order);
            out.copy_from_slice(&sums[..n]);
        }
    }

    /// Σ v·D·v at one velocity, of the rotor and of the rings, which share no damper.
    #[inline(always)]
    pub(super) fn damping_w(&self, velocity: &[V2; P]) -> [f64; 2] {
        let n = self.n();
        let mut force = [V2::zeros(); P];
        self.damping[0].subtract(&mut force, velocity, n, |x| x);
        self.damping[1].subtract(&mut force, velocity, n, crossed);
        let mut sums = [0.0; 2];
        for i in 0..n {
            sums[usize::from(i >= self.rotor_pairs)] -= velocity[i].dot(&force[i]);
        }
        sums
    }

    /// What stiffness that goes round gives at several θ: power at each node, or nothing.
    #[inline(always)]
    pub(super) fn swirl_w<const N: usize>(
        &self,
        (theta, order): (&[f64; N], usize),
        velocities: &[[V2; P]; N],
    ) -> Option<[f64; N]> {
        if self.swirl.kind == Kind::Zero {
            return None;
        }
        let positions = self.values(&self.position, theta, order);
        Some(std::array::from_fn(|j| {
            let mut force = [V2::zeros(); P];
            self.swirl
                .subtract(&mut force, &positions[j], self.n(), crossed);
            (0..self.n()).map(|i| velocities[j][i].dot(&force[i])).sum()
        }))
    }

    /// Velocity of a plane's contact, of a magnet and of the unbalance at one velocity of all.
    #[inline(always)]
    pub(super) fn contact_of(&self, plane: usize, velocity: &[V2; P]) -> V2 {
        read(velocity, &self.contacts[plane], self.n())
    }

    #[inline(always)]
    pub(super) fn magnet_of(&self, magnet: usize, velocity: &[V2; P]) -> V2 {
        read(velocity, &self.magnets[magnet], self.n())
    }

    #[inline(always)]
    pub(super) fn unbalance_of(&self, velocity: &[V2; P]) -> V2 {
        let Some(port) = &self.unbalance else {
            return V2::zeros();
        };
        let (mut along, mut across) = (V2::zeros(), V2::zeros());
        for i in 0..self.n() {
            let (u, v) = (&port[i], &velocity[i]);
            along += u.component_mul(v);
            across += V2::new(u.x * v.y, u.y * v.x);
        }
        V2::new(along.x + along.y, across.x - across.y)
    }

    /// Velocities at several θ.
    pub(super) fn velocities_at<const N: usize>(
        &self,
        theta: &[f64; N],
        order: usize,
    ) -> [[V2; P]; N] {
        self.values(&self.velocity, theta, order)
    }

    #[inline(always)]
    fn values<const N: usize>(
        &self,
        rows: &[[V2; P]; LENGTH],
        theta: &[f64; N],
        order: usize,
    ) -> [[V2; P]; N] {
        let n = self.n();
        let mut sums = [rows[order]; N];
        for row in rows[..order].iter().rev() {
            for (sum, theta) in sums.iter_mut().zip(theta) {
                for i in 0..n {
                    sum[i] = sum[i] * *theta + row[i];
                }
            }
        }
        sums
    }

    /// Positions as integrals of velocities, up to an order.
    pub(super) fn integrate(&mut self, order: usize, step_s: f64) {
        for k in 0..order {
            self.extend_positions(k, step_s * INVERSE[k + 1]);
        }
    }
}

#[inline(always)]
fn push_all<const P: usize>(out: &mut [V2; P], row: &[V2; P], n: usize, factor: f64) {
    for i in 0..n {
        out[i] += factor * row[i];
    }
}

fn padded<T: Copy, const P: usize>(values: &[T], rest: T) -> [T; P] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(rest))
}
