//! An independent code for two planes: SI coordinates instead of modal ones, a step far below anything that moves, an
//! extrapolated midpoint rule of order eight, events by halving.

use super::runs::direction;
use plant_model::machine::params::MachineParams;
use plant_model::params::SlidingFriction;
use plant_model::{ContactMode, V2};

/// A rotor with two planes of linear contact in rigid bores, with friction that is the same at every speed, and one unbalance.
pub(crate) struct Reference {
    params: MachineParams,
    pub(crate) spin: f64,
}

/// Translation, tilt and up to four bending modes.
const N: usize = 6;

/// Positions and velocities.
#[derive(Clone, Copy, Default)]
pub(crate) struct State {
    pub(crate) at: [V2; N],
    pub(crate) rate: [V2; N],
}

impl State {
    /// self + h·other
    fn plus(&self, h: f64, other: &Self) -> Self {
        Self {
            at: std::array::from_fn(|i| self.at[i] + h * other.at[i]),
            rate: std::array::from_fn(|i| self.rate[i] + h * other.rate[i]),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Touch {
    Off,
    Beyond,
    Slip(f64),
    Roll,
}

impl Touch {
    fn mode(self) -> ContactMode {
        match self {
            Touch::Off | Touch::Beyond => ContactMode::Flight,
            Touch::Roll => ContactMode::Roll,
            Touch::Slip(s) if s > 0.0 => ContactMode::SlipPositive,
            Touch::Slip(_) => ContactMode::SlipNegative,
        }
    }
}

/// A plane at an instant.
#[derive(Clone, Copy, Default)]
struct Contact {
    tangent: V2,
    depth: f64,
    normal: f64,
    along: f64,
    slip: f64,
    /// What the turning of the tangent adds to the acceleration along it.
    curve: f64,
}

fn shape_at(shape: &[(f64, f64)], z: f64) -> f64 {
    let mut i = 1;
    while i + 1 < shape.len() && shape[i].0 < z {
        i += 1;
    }
    let (a, b) = (shape[i - 1], shape[i]);
    a.1 + (b.1 - a.1) * (z - a.0) / (b.0 - a.0)
}

impl Reference {
    pub(crate) fn of(params: &MachineParams, spin: f64) -> Self {
        Self {
            params: params.clone(),
            spin,
        }
    }

    fn place(&self, p: usize) -> f64 {
        self.params.planes[p].position_m
    }

    fn friction(&self, p: usize) -> f64 {
        match self.params.planes[p].friction.sliding {
            SlidingFriction::Constant { coefficient } => coefficient,
            SlidingFriction::Falling { .. } => panic!("it falls"),
        }
    }

    fn weights(&self, z: f64) -> [f64; N] {
        let mut weights = [1.0, z, 0.0, 0.0, 0.0, 0.0];
        for (weight, mode) in weights[2..].iter_mut().zip(self.params.rotor.bending()) {
            *weight = shape_at(&mode.shape, z);
        }
        weights
    }

    fn point(&self, y: &[V2; N], z: f64) -> V2 {
        self.weights(z).iter().zip(y).map(|(w, y)| *w * y).sum()
    }

    fn inertia(&self, i: usize) -> f64 {
        let rigid = self.params.rotor.rigid();
        match i {
            1 => rigid.transverse_inertia_kg_m2,
            _ => rigid.mass_kg,
        }
    }

    fn mobility(&self, a: f64, b: f64) -> f64 {
        let (a, b) = (self.weights(a), self.weights(b));
        (0..N).map(|i| a[i] * b[i] / self.inertia(i)).sum()
    }

    /// Generalised forces of all that does not touch.
    fn without_contact(&self, t: f64, y: &State) -> [V2; N] {
        let mut forces = [V2::zeros(); N];
        for support in &self.params.supports {
            let [at, rate] = [&y.at, &y.rate].map(|y| self.point(y, support.position_m));
            let spring = support.stiffness_n_m.component_mul(&at);
            let damper = support.damping_n_s_m.component_mul(&rate);
            self.push(&mut forces, support.position_m, -spring - damper);
        }
        let (unbalance, rigid) = (self.params.unbalances[0], self.params.rotor.rigid());
        let turned = direction(self.spin * t + unbalance.angle_rad);
        let turning = unbalance.moment_kg_m * self.spin * self.spin * turned;
        self.push(&mut forces, unbalance.position_m, turning);
        forces[0] += rigid.mass_kg * self.params.gravity_m_s2;
        let gyroscopic = rigid.polar_inertia_kg_m2 * self.spin;
        forces[1] += gyroscopic * V2::new(-y.rate[1].y, y.rate[1].x);
        for (i, mode) in self.params.rotor.bending().iter().enumerate() {
            let (w, j) = (mode.frequency_rad_s, 2 + i);
            let damper = 2.0 * mode.damping_ratio * w * y.rate[j];
            forces[j] -= rigid.mass_kg * (w * w * y.at[j] + damper);
        }
        forces
    }

    fn push(&self, forces: &mut [V2; N], z: f64, force: V2) {
        for (sum, weight) in forces.iter_mut().zip(self.weights(z)) {
            *sum += weight * force;
        }
    }

    fn rates(&self, t: f64, y: &State, touch: &[Touch; 2]) -> (State, [Contact; 2]) {
        let mut forces = self.without_contact(t, y);
        let mut contacts = [Contact::default(); 2];
        for (p, contact) in contacts.iter_mut().enumerate() {
            let plane = &self.params.planes[p];
            let (z, law) = (plane.position_m, plane.contact.law.linear().unwrap());
            let u = self.point(&y.at, z) - plane.centre_m;
            let w = self.point(&y.rate, z);
            let n = u / u.norm();
            let tangent = V2::new(-n.y, n.x);
            let depth = u.norm() - plane.contact.clearance_m;
            let normal = law.stiffness_n_m * depth + law.damping_n_s_m * n.dot(&w);
            let whirl = tangent.dot(&w);
            *contact = Contact {
                tangent,
                depth,
                normal,
                along: 0.0,
                slip: whirl + plane.radius_m * self.spin,
                curve: -whirl * n.dot(&w) / u.norm(),
            };
            if matches!(touch[p], Touch::Slip(_) | Touch::Roll) {
                self.push(&mut forces, z, -normal * n);
            }
            if let Touch::Slip(sign) = touch[p] {
                contact.along = -sign * self.friction(p) * normal;
                self.push(&mut forces, z, contact.along * tangent);
            }
        }
        self.hold(&mut forces, &mut contacts, touch);
        let accelerations = std::array::from_fn(|i| forces[i] / self.inertia(i));
        let rates = State {
            at: y.rate,
            rate: accelerations,
        };
        (rates, contacts)
    }

    /// Friction where a plane rolls: such that the speed along the wall stays.
    fn hold(&self, forces: &mut [V2; N], contacts: &mut [Contact; 2], touch: &[Touch; 2]) {
        let missing = [0, 1].map(|p| {
            let weights = self.weights(self.place(p));
            let a: V2 = (0..N)
                .map(|i| weights[i] / self.inertia(i) * forces[i])
                .sum();
            -contacts[p].tangent.dot(&a) - contacts[p].curve
        });
        let mobility = |a: usize, b: usize| {
            let turned = contacts[a].tangent.dot(&contacts[b].tangent);
            turned * self.mobility(self.place(a), self.place(b))
        };
        let (a, b, d) = (mobility(0, 0), mobility(0, 1), mobility(1, 1));
        let [x, y] = missing;
        let along = match touch.map(|touch| touch == Touch::Roll) {
            [true, true] => [
                (x * d - b * y) / (a * d - b * b),
                (a * y - b * x) / (a * d - b * b),
            ],
            [true, false] => [x / a, 0.0],
            [false, true] => [0.0, y / d],
            [false, false] => return,
        };
        for p in (0..2).filter(|p| touch[*p] == Touch::Roll) {
            contacts[p].along = along[p];
            self.push(forces, self.place(p), along[p] * contacts[p].tangent);
        }
    }

    /// Modified midpoint rule extrapolated: order eight.
    fn step(&self, t: f64, y: &State, h: f64, touch: &[Touch; 2]) -> State {
        const PARTS: [usize; 4] = [2, 4, 6, 8];
        let mut table = [State::default(); 4];
        for (row, parts) in PARTS.iter().enumerate() {
            let dt = h / *parts as f64;
            let mut a = *y;
            let mut b = y.plus(dt, &self.rates(t, y, touch).0);
            for part in 1..*parts {
                let rates = self.rates(t + part as f64 * dt, &b, touch).0;
                (a, b) = (b, a.plus(2.0 * dt, &rates));
            }
            let last = b.plus(dt, &self.rates(t + h, &b, touch).0);
            table[row] = a.plus(1.0, &last).plus(-0.5, &a.plus(1.0, &last));
            for back in (0..row).rev() {
                let ratio = (*parts as f64 / PARTS[back] as f64).powi(2);
                let (fine, coarse) = (table[back + 1], table[back]);
                table[back] = fine.plus(1.0 / (ratio - 1.0), &fine.plus(-1.0, &coarse));
            }
        }
        table[0]
    }

    /// Least guard of each plane: below zero where its mode has ended.
    fn guard(&self, t: f64, y: &State, touch: &[Touch; 2]) -> [f64; 2] {
        let (_, contacts) = self.rates(t, y, touch);
        std::array::from_fn(|p| {
            let (at, c) = (&contacts[p], self.params.planes[p].contact.clearance_m);
            match touch[p] {
                Touch::Off => -at.depth / c,
                Touch::Beyond => (at.depth / c).min(-at.normal),
                Touch::Slip(sign) => (at.normal / 1e4).min(sign * at.slip),
                Touch::Roll => at.normal.min(self.friction(p) * at.normal - at.along.abs()) / 1e4,
            }
        })
    }

    /// What follows where the guard of a plane is below zero.
    fn next(&self, t: f64, y: &State, touch: &[Touch; 2], p: usize) -> Touch {
        let at = self.rates(t, y, touch).1[p];
        match touch[p] {
            Touch::Off => Touch::Slip(at.slip.signum()),
            Touch::Beyond if at.depth < 0.0 => Touch::Off,
            Touch::Beyond => Touch::Slip(at.slip.signum()),
            Touch::Slip(_) | Touch::Roll if at.normal < 0.0 => match at.depth > 0.0 {
                true => Touch::Beyond,
                false => Touch::Off,
            },
            Touch::Slip(sign) => {
                let mut rolling = *touch;
                rolling[p] = Touch::Roll;
                let rolls = self.rates(t, y, &rolling).1[p];
                match rolls.along.abs() <= self.friction(p) * rolls.normal {
                    true => Touch::Roll,
                    false => Touch::Slip(-sign),
                }
            }
            Touch::Roll => Touch::Slip(-at.along.signum()),
        }
    }

    /// Modes of both planes after each event, and where the rotor is at the end.
    pub(crate) fn run(&self, start: State, end: f64, h: f64) -> (Vec<[ContactMode; 2]>, [V2; 2]) {
        let (mut t, mut y, mut touch) = (0.0, start, [Touch::Off; 2]);
        let mut changes = vec![];
        while t < end {
            let h = h.min(end - t);
            let next = self.step(t, &y, h, &touch);
            let over = |y: &State, t: f64| self.guard(t, y, &touch).iter().any(|g| *g < 0.0);
            if !over(&next, t + h) {
                (t, y) = (t + h, next);
                continue;
            }
            let (mut low, mut high) = (0.0, h);
            for _ in 0..45 {
                let middle = 0.5 * (low + high);
                match over(&self.step(t, &y, middle, &touch), t + middle) {
                    true => high = middle,
                    false => low = middle,
                }
            }
            y = self.step(t, &y, high, &touch);
            t += high;
            // One change may at once ask for another.
            for _ in 0..10 {
                let guards = self.guard(t, &y, &touch);
                let Some(p) = (0..2).find(|p| guards[*p] < 0.0) else {
                    break;
                };
                let before = touch[p].mode();
                touch[p] = self.next(t, &y, &touch, p);
                if touch[p].mode() != before {
                    changes.push((t, touch.map(Touch::mode)));
                }
            }
        }
        let ends = [0, 1].map(|p| self.point(&y.at, self.place(p)));
        (settled(&changes), ends)
    }
}

/// Modes of both planes after each instant: what follows one another without time is one event.
pub(crate) fn settled(changes: &[(f64, [ContactMode; 2])]) -> Vec<[ContactMode; 2]> {
    let mut out: Vec<[ContactMode; 2]> = vec![];
    for (i, (t, modes)) in changes.iter().enumerate() {
        let last = changes.get(i + 1).is_none_or(|(next, _)| next - t > 1e-9);
        if last && out.last() != Some(modes) {
            out.push(*modes);
        }
    }
    out
}
