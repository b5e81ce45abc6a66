//! Flight of the linear body over a sample as one matrix. At a spin that stays and a step length that repeats, nothing of
//! it changes from sample to sample: state and inputs give the end, a bound of the way, and the energies.
//!
//! z = (ω·q, q̇, delivered forces of magnets that lag, direction of the spin, commands, loads, 1) obeys ż = A·z, with ω the
//! fastest rate, so that all entries of A are of one size.

use super::poles::MagnetLaw;
use super::readout::PlaneFlows;
use super::system::{MachineInputs, MachineState, MachineSystem};
use crate::V2;
use crate::energy::Flows;
use crate::quadrature::{EIGHT, Nodes};
use nalgebra::DMatrix;
use std::cmp::Ordering;

/// Samples of the same length at the same spin from which on a map pays: it costs as much as hundreds of them.
const REPEATS: u32 = 256;
/// Ways in which work is done that the map books.
const DOORS: usize = 5;
/// Step lengths count as the same up to this share of themselves: it is the clock that rounds.
const SAME: f64 = 1e-9;

/// Where the parts of z begin.
#[derive(Debug, Clone, Copy, Default)]
struct Layout {
    n: usize,
    magnets: usize,
    direction: usize,
    commands: usize,
    loads: usize,
    one: usize,
}

/// The map, and whether it is worth making.
#[derive(Debug, Clone, Default)]
pub(crate) struct FlightMap {
    dt_s: f64,
    spin_rad_s: f64,
    repeats: u32,
    made: bool,
    layout: Layout,
    rate: f64,
    /// End of the coordinates, rates and delivered forces; rows of z.
    end: Vec<Block>,
    /// Bound of each plane's way, x and y.
    reach: Vec<Block>,
    /// Quadratic forms of the work: rotor damping, magnets that lag, unbalance, stiffness that goes round, dampers of rings, in
    /// tiles. Empty where there is none.
    works: [Vec<Tile>; DOORS],
    /// Σ z·zᵀ over the samples flown, likewise: the forms are asked for by those who read the audit, not in every sample.
    moments: Vec<Tile>,
    /// What they made of the samples under earlier maps.
    booked: Flows,
    /// In blocks, the last filled up with zeros.
    z: Vec<Block>,
    size: Vec<Block>,
    out: Vec<f64>,
}

/// So many numbers are worked on side by side.
const LANES: usize = 4;
type Block = [f64; LANES];
/// A square of a form.
type Tile = [Block; LANES];

impl FlightMap {
    /// Carries a machine off all walls over a whole sample, if there is a map for it and the rotor stays clear, and books the work
    /// of what is held and of the races; says whether it did.
    pub(crate) fn fly(
        &mut self,
        system: &MachineSystem,
        y: &mut MachineState,
        (inputs, dt_s): (&MachineInputs, f64),
        path: &mut [V2],
        (flows, plane_flows): (&mut Flows, &mut [PlaneFlows]),
    ) -> bool {
        let turns = system.inverse_inertia > 0.0 && system.drive_torque_n_m != 0.0;
        if turns {
            return false;
        }
        let same = (dt_s - self.dt_s).abs() <= SAME * dt_s && y.spin_rad_s == self.spin_rad_s;
        if !same {
            self.forget();
            (self.dt_s, self.spin_rad_s) = (dt_s, y.spin_rad_s);
            return false;
        }
        if !self.made {
            self.repeats += 1;
            if self.repeats < REPEATS {
                return false;
            }
            self.make(system);
        }
        self.read(system, y, inputs);
        for (p, plane) in system.planes.iter().enumerate() {
            let blocks = self.size.len();
            let along = |row: usize| dot(&self.reach[row * blocks..][..blocks], &self.size);
            let centre = plane.centre_m.abs();
            let (x, y) = (along(2 * p) + centre.x, along(2 * p + 1) + centre.y);
            let clearance = plane.nearest_m();
            if x * x + y * y >= clearance * clearance {
                return false;
            }
        }
        let n = self.layout.n;
        rows(&self.end, &self.z, &mut self.out);
        let per = 1.0 / self.rate;
        for (i, path) in path.iter_mut().enumerate() {
            let pair = |at: usize| V2::new(self.out[at + 2 * i], self.out[at + 2 * i + 1]);
            let q = per * pair(0);
            *path = q - y.position[i];
            (y.position[i], y.velocity[i]) = (q, pair(n));
        }
        let mut lagging = self.layout.magnets;
        for (force_n, law) in y.magnets.iter_mut().zip(&system.magnets) {
            if law.lag().is_some() {
                *force_n = V2::new(self.out[lagging], self.out[lagging + 1]);
                lagging += 2;
            }
        }
        let (control, external) = system.held_work_j(inputs, path);
        self.add_moments();
        flows.control += control;
        flows.external += external;
        y.phase_rad += y.spin_rad_s * dt_s;
        for (p, plane) in system.planes.iter().enumerate() {
            if let Some(race) = &plane.race {
                let before = y.races_rad_s[p];
                y.races_rad_s[p] = race.coasted_rad_s(before, dt_s);
                let lost_j = race.coasting_loss_j(before, y.races_rad_s[p]);
                plane_flows[p].race_drag += lost_j;
                flows.stator_damping += lost_j;
            }
        }
        true
    }

    /// To be made anew: the machine is another from now on.
    pub(crate) fn forget(&mut self) {
        self.booked = self.works();
        self.moments.clear();
        (self.repeats, self.made) = (0, false);
    }

    fn add_moments(&mut self) {
        let mut tiles = self.moments.iter_mut();
        for (i, of_rows) in self.z.iter().enumerate() {
            for (of_columns, tile) in self.z[i..].iter().zip(&mut tiles) {
                for (row, z) in tile.iter_mut().zip(of_rows) {
                    *row = std::array::from_fn(|lane| row[lane] + z * of_columns[lane]);
                }
            }
        }
    }

    /// Work of rotor damping, lagging magnets and unbalance over all samples flown so far.
    pub(crate) fn works(&self) -> Flows {
        let work = |form: &Vec<Tile>| dot(form.as_flattened(), self.moments.as_flattened());
        let [rotor_damping, control, unbalance, external, stator_damping] =
            [0, 1, 2, 3, 4].map(|w| work(&self.works[w]));
        let mut all = self.booked;
        all.add_scaled(
            1.0,
            &Flows {
                control,
                unbalance,
                rotor_damping,
                stator_damping,
                external,
                ..Flows::default()
            },
        );
        all
    }

    fn read(&mut self, system: &MachineSystem, y: &MachineState, inputs: &MachineInputs) {
        let Layout {
            n,
            magnets,
            direction,
            commands,
            loads,
            one,
        } = self.layout;
        // All parts begin at even places.
        let put = |z: &mut [Block], at: usize, v: V2| {
            let block = &mut z[at / LANES];
            (block[at % LANES], block[at % LANES + 1]) = (v.x, v.y);
        };
        for (i, (q, v)) in y.position.iter().zip(&y.velocity).enumerate() {
            put(&mut self.z, 2 * i, self.rate * q);
            put(&mut self.z, n + 2 * i, *v);
        }
        let mut lagging = magnets;
        for (m, law) in system.magnets.iter().enumerate() {
            if law.lag().is_some() {
                put(&mut self.z, lagging, y.magnets[m]);
                lagging += 2;
            }
            put(&mut self.z, commands + 2 * m, inputs.commands_n[m]);
        }
        if system.body.unbalance.is_some() {
            let (sin, cos) = y.phase_rad.sin_cos();
            put(&mut self.z, direction, V2::new(cos, sin));
        }
        for (l, load_n) in inputs.loads_n.iter().enumerate() {
            put(&mut self.z, loads + 2 * l, *load_n);
        }
        self.z[one / LANES][one % LANES] = 1.0;
        for (sizes, four) in self.size.iter_mut().zip(&self.z) {
            *sizes = four.map(f64::abs);
        }
    }

    /// A of ż = A·z.
    fn generator(&self, system: &MachineSystem) -> DMatrix<f64> {
        let Layout {
            n,
            magnets,
            direction,
            commands,
            loads,
            one,
        } = self.layout;
        let (body, rate, spin) = (&system.body, self.rate, self.spin_rad_s);
        let mut a = DMatrix::zeros(one + 1, one + 1);
        a.view_mut((0, 0), (2 * n, 2 * n))
            .copy_from(&body.generator(rate, spin));
        for (i, force) in body.gravity.iter().enumerate() {
            for axis in [0, 1] {
                a[(n + 2 * i + axis, one)] = force[axis];
            }
        }
        let mut column = vec![V2::zeros(); body.pairs];
        let mut pushes = |a: &mut DMatrix<f64>, at: usize, push: &dyn Fn(&mut [V2], V2)| {
            for (axis, unit) in [V2::x(), V2::y()].into_iter().enumerate() {
                column.fill(V2::zeros());
                push(&mut column, unit);
                for (row, value) in column.iter().flatten().enumerate() {
                    a[(n + row, at + axis)] = *value;
                }
            }
        };
        let mut lagging = magnets;
        for (m, law) in system.magnets.iter().enumerate() {
            match law.lag() {
                Some(lag) => {
                    pushes(&mut a, lagging, &|out, f| body.magnets[m].push(out, f));
                    for axis in [0, 1] {
                        a[(lagging + axis, lagging + axis)] = -lag;
                        a[(lagging + axis, commands + 2 * m + axis)] = lag;
                    }
                    lagging += 2;
                }
                None => pushes(&mut a, commands + 2 * m, &|out, f| {
                    body.magnets[m].push(out, f);
                }),
            }
        }
        for (l, port) in body.loads.iter().enumerate() {
            pushes(&mut a, loads + 2 * l, &|out, f| port.push(out, f));
        }
        if let Some(unbalance) = &body.unbalance {
            let square = spin * spin;
            pushes(&mut a, direction, &|out, f| unbalance.push(out, square * f));
            a[(direction, direction + 1)] = -spin;
            a[(direction + 1, direction)] = spin;
        }
        a
    }

    fn make(&mut self, system: &MachineSystem) {
        let body = &system.body;
        let n = 2 * body.pairs;
        let lagging = system.magnets.iter().filter_map(MagnetLaw::lag).count();
        let magnets = 2 * n;
        let direction = magnets + 2 * lagging;
        let commands = direction + if body.unbalance.is_some() { 2 } else { 0 };
        let loads = commands + 2 * body.magnets.len();
        let one = loads + 2 * body.loads.len();
        self.layout = Layout {
            n,
            magnets,
            direction,
            commands,
            loads,
            one,
        };
        self.rate = body.undamped_rate_rad_s().max(1.0 / self.dt_s);
        let d = one + 1;
        let zeros = vec![[0.0; LANES]; d.div_ceil(LANES)];
        (self.z, self.size, self.out) = (zeros.clone(), zeros, vec![0.0; direction]);
        let a = self.generator(system) * self.dt_s;
        let end = a.exp();
        self.end = by_rows(&end, direction);

        // Σ_k |S·A^k/k!|: on θ from 0 to 1 no power of it is larger.
        let mut ports = DMatrix::zeros(2 * body.contacts.len(), d);
        for (p, port) in body.contacts.iter().enumerate() {
            for (i, s) in port.of_each().iter().enumerate() {
                for axis in [0, 1] {
                    ports[(2 * p + axis, 2 * i + axis)] = s / self.rate;
                }
            }
        }
        let mut reach = ports.map(f64::abs);
        let mut term = ports;
        for k in 1..200 {
            term = term * &a / f64::from(k);
            let size = term.map(f64::abs);
            reach += &size;
            if size.max() <= 1e-18 * reach.max() {
                break;
            }
        }
        self.reach = by_rows(&reach, reach.nrows());
        self.works = self.make_works(system, &a);
        let blocks = self.z.len();
        self.moments = vec![[[0.0; LANES]; LANES]; blocks * (blocks + 1) / 2];
        self.made = true;
    }

    /// ∫ z(θ)ᵀ·M·z(θ) dt as a form of z(0), for the power zᵀ·M·z through each door.
    fn make_works(&self, system: &MachineSystem, a: &DMatrix<f64>) -> [Vec<Tile>; DOORS] {
        let (body, d) = (&system.body, a.nrows());
        let Layout {
            n,
            magnets,
            direction,
            ..
        } = self.layout;
        let mut powers = [(); DOORS].map(|()| DMatrix::zeros(d, d));
        for (row, column, value) in body.damping.entries() {
            // Of the rotor, or of a ring.
            let door = if row < 2 * body.rotor_pairs { 0 } else { 4 };
            powers[door][(n + row, n + column)] += value;
        }
        for (row, column, value) in body.swirl.entries() {
            powers[3][(n + row, column)] -= value / self.rate;
        }
        for i in 0..n {
            let mut x = vec![V2::zeros(); body.pairs];
            x[i / 2][i % 2] = 1.0;
            let mut lagging = magnets;
            for (port, law) in body.magnets.iter().zip(&system.magnets) {
                if law.lag().is_some() {
                    let at = port.of(&x);
                    (powers[1][(lagging, n + i)], powers[1][(lagging + 1, n + i)]) = (at.x, at.y);
                    lagging += 2;
                }
            }
            if let Some(unbalance) = &body.unbalance {
                let at = unbalance.of(&x) * self.spin_rad_s * self.spin_rad_s;
                (
                    powers[2][(direction, n + i)],
                    powers[2][(direction + 1, n + i)],
                ) = (at.x, at.y);
            }
        }
        // A rule of eight nodes on parts over which nothing turns by more than half a radian.
        let parts = (2.0 * a.amax()).ceil().max(1.0);
        let part = (a / parts).exp();
        let nodes = Nodes::stretched(&EIGHT, 1.0 / parts);
        let within = nodes.theta.map(|theta| (a * theta).exp());
        let mut from = DMatrix::identity(d, d);
        let mut works = [(); DOORS].map(|()| DMatrix::zeros(d, d));
        for _ in 0..parts as usize {
            for (j, inner) in within.iter().enumerate() {
                let at = inner * &from;
                let weight = self.dt_s * nodes.integral(|i| if i == j { 1.0 } else { 0.0 });
                for (work, power) in works.iter_mut().zip(&powers) {
                    if power.amax() > 0.0 {
                        *work += weight * at.tr_mul(&(power * &at));
                    }
                }
            }
            from = &part * from;
        }
        works.map(|work| match work.amax() > 0.0 {
            true => by_tiles(&work),
            false => vec![],
        })
    }
}

/// The tiles of a form from its diagonal on, row by row, with what stands below the diagonal added to what stands above.
fn by_tiles(form: &DMatrix<f64>) -> Vec<Tile> {
    let d = form.nrows();
    let value = |i: usize, j: usize| match i.cmp(&j) {
        _ if i >= d || j >= d => 0.0,
        Ordering::Less => form[(i, j)] + form[(j, i)],
        Ordering::Equal => form[(i, i)],
        Ordering::Greater => 0.0,
    };
    let block = |i: usize, at: usize| std::array::from_fn(|lane| value(i, LANES * at + lane));
    let blocks = d.div_ceil(LANES);
    (0..blocks)
        .flat_map(|row| (row..blocks).map(move |column| (row, column)))
        .map(|(row, column)| std::array::from_fn(|lane| block(LANES * row + lane, column)))
        .collect()
}

/// The first rows of a matrix, one after the other, each filled up to whole blocks.
fn by_rows(a: &DMatrix<f64>, rows: usize) -> Vec<Block> {
    let value = |i: usize, j: usize| if j < a.ncols() { a[(i, j)] } else { 0.0 };
    (0..rows)
        .flat_map(|i| (0..a.ncols().div_ceil(LANES)).map(move |block| (i, block)))
        .map(|(i, block)| std::array::from_fn(|lane| value(i, LANES * block + lane)))
        .collect()
}

/// Rows of a matrix times a vector; of a few blocks, as one plane has them, without a loop along the row.
fn rows(matrix: &[Block], z: &[Block], out: &mut [f64]) {
    match z.len() {
        2 => rows_of::<2>(matrix, z, out),
        3 => rows_of::<3>(matrix, z, out),
        4 => rows_of::<4>(matrix, z, out),
        blocks => {
            for (out, row) in out.iter_mut().zip(matrix.chunks_exact(blocks)) {
                *out = dot(row, z);
            }
        }
    }
}

/// The same of a number of blocks that the compiler knows.
fn rows_of<const BLOCKS: usize>(matrix: &[Block], z: &[Block], out: &mut [f64]) {
    if let Some(z) = z.first_chunk::<BLOCKS>() {
        let (rows, _) = matrix.as_chunks::<BLOCKS>();
        for (out, row) in out.iter_mut().zip(rows) {
            *out = dot(row, z);
        }
    }
}

#[inline(always)]
fn dot(a: &[Block], b: &[Block]) -> f64 {
    // Sums side by side: one alone would wait for each addition to finish before it began the next.
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        sums = std::array::from_fn(|lane| sums[lane] + a[lane] * b[lane]);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
