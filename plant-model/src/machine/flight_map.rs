//! Flight of the linear body over a sample as one matrix. At a spin that stays and a step length that repeats, nothing of
//! it changes from sample to sample: state and inputs give the end, a bound of the way, and the energies.
//!
//! z = (ω·q, q̇, delivered forces of magnets that lag, direction of the spin, commands, loads, 1) obeys ż = A·z, with ω the
//! fastest rate, so that all entries of A are of one size.

use super::poles::MagnetLaw;
use super::readout::StepFlows;
use super::system::{MachineInputs, MachineState, MachineSystem};
use crate::V2;
use crate::energy::Flows;
use crate::quadrature::{EIGHT, Nodes};
use nalgebra::DMatrix;

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
    end: Vec<f64>,
    /// Bound of each plane's way, x and y.
    reach: Vec<f64>,
    /// Quadratic forms of the work: rotor damping, magnets that lag, unbalance, stiffness that goes round, dampers of rings; the upper
    /// triangle row by row, with what stands below added to it. Empty where there is none.
    works: [Vec<f64>; DOORS],
    /// Σ z·zᵀ over the samples flown, likewise: the forms are asked for by those who read the audit, not in every sample.
    moments: Vec<f64>,
    /// What they made of the samples under earlier maps.
    booked: Flows,
    z: Vec<f64>,
    size: Vec<f64>,
    out: Vec<f64>,
}

impl FlightMap {
    /// Carries a machine off all walls over a whole sample, if there is a map for it and the rotor stays clear; says so.
    pub(crate) fn fly(
        &mut self,
        system: &MachineSystem,
        y: &mut MachineState,
        inputs: &MachineInputs,
        dt_s: f64,
        path: &mut [V2],
    ) -> Option<StepFlows> {
        let turns = system.inverse_inertia > 0.0 && system.drive_torque_n_m != 0.0;
        if turns {
            return None;
        }
        let same = (dt_s - self.dt_s).abs() <= SAME * dt_s && y.spin_rad_s == self.spin_rad_s;
        if !same {
            self.forget();
            (self.dt_s, self.spin_rad_s) = (dt_s, y.spin_rad_s);
            return None;
        }
        if !self.made {
            self.repeats += 1;
            if self.repeats < REPEATS {
                return None;
            }
            self.make(system);
        }
        self.read(system, y, inputs);
        let (d, planes) = (self.z.len(), system.planes.len());
        for p in 0..planes {
            let along = |row: usize| dot(&self.reach[row * d..(row + 1) * d], &self.size);
            let centre = system.planes[p].centre_m.abs();
            let (x, y) = (along(2 * p) + centre.x, along(2 * p + 1) + centre.y);
            let clearance = system.planes[p].nearest_m();
            if x * x + y * y >= clearance * clearance {
                return None;
            }
        }
        let n = self.layout.n;
        for (row, out) in self.out.iter_mut().enumerate() {
            *out = dot(&self.end[row * d..(row + 1) * d], &self.z);
        }
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
        let machine = Flows {
            control,
            external,
            ..Flows::default()
        };
        y.phase_rad += y.spin_rad_s * dt_s;
        let mut flows = StepFlows::of_machine(machine);
        for (p, plane) in system.planes.iter().enumerate() {
            if let Some(race) = &plane.race {
                let before = y.races_rad_s[p];
                y.races_rad_s[p] = race.coasted_rad_s(before, dt_s);
                flows.planes[p].race_drag = race.coasting_loss_j(before, y.races_rad_s[p]);
                flows.machine.stator_damping += flows.planes[p].race_drag;
            }
        }
        Some(flows)
    }

    /// To be made anew: the machine is another from now on.
    pub(crate) fn forget(&mut self) {
        self.booked = self.works();
        self.moments.clear();
        (self.repeats, self.made) = (0, false);
    }

    fn add_moments(&mut self) {
        let mut rest = self.moments.as_mut_slice();
        for (i, z) in self.z.iter().enumerate() {
            let (row, after) = rest.split_at_mut(self.z.len() - i);
            rest = after;
            if *z != 0.0 {
                for (sum, other) in row.iter_mut().zip(&self.z[i..]) {
                    *sum += z * other;
                }
            }
        }
    }

    /// Work of rotor damping, lagging magnets and unbalance over all samples flown so far.
    pub(crate) fn works(&self) -> Flows {
        let work = |form: &Vec<f64>| dot(form, &self.moments);
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
        let put = |z: &mut [f64], at: usize, v: V2| (z[at], z[at + 1]) = (v.x, v.y);
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
        self.z[one] = 1.0;
        for (size, z) in self.size.iter_mut().zip(&self.z) {
            *size = z.abs();
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
        (self.z, self.size, self.out) = (vec![0.0; d], vec![0.0; d], vec![0.0; direction]);
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
        self.moments = vec![0.0; d * (d + 1) / 2];
        self.made = true;
    }

    /// ∫ z(θ)ᵀ·M·z(θ) dt as a form of z(0), for the power zᵀ·M·z through each door.
    fn make_works(&self, system: &MachineSystem, a: &DMatrix<f64>) -> [Vec<f64>; DOORS] {
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
            true => (0..d)
                .flat_map(|i| (i..d).map(move |j| (i, j)))
                .map(|(i, j)| match i == j {
                    true => work[(i, i)],
                    false => work[(i, j)] + work[(j, i)],
                })
                .collect(),
            false => vec![],
        })
    }
}

/// The first rows of a matrix, one after the other.
fn by_rows(a: &DMatrix<f64>, rows: usize) -> Vec<f64> {
    (a.row_iter().take(rows))
        .flat_map(|row| row.iter().copied().collect::<Vec<_>>())
        .collect()
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Four sums side by side: one alone would wait for each addition to finish before it began the next.
    let mut sums = [0.0; 4];
    let (front, other) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = front
        .remainder()
        .iter()
        .zip(other.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in front.zip(other) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
