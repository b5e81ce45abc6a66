//! An independent code for two planes: SI coordinates instead of modal ones, a step far below anything that moves, an
//! extrapolated midpoint rule of order eight, events by halving.

use plant_model::{Mode, V2};

/// A plane: place, centre of the bore, clearance, k_c, d_c, μ, radius of the rotor.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    pub(crate) z: f64,
    pub(crate) centre: V2,
    pub(crate) clearance: f64,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    pub(crate) radius: f64,
}

/// The rotor as the reference has it: SI coordinates, no matrices.
pub(crate) struct Reference {
    pub(crate) mass_kg: f64,
    pub(crate) transverse: f64,
    pub(crate) polar: f64,
    pub(crate) spin: f64,
    /// Place and moment.
    pub(crate) unbalance: (f64, f64),
    pub(crate) gravity: V2,
    /// Place, stiffness, damping.
    pub(crate) supports: Vec<(f64, f64, f64)>,
    pub(crate) planes: [Plane; 2],
    pub(crate) modes: Vec<Bending>,
}

/// A bending mode: natural frequency, damping ratio, shape.
pub(crate) type Bending = (f64, f64, Vec<(f64, f64)>);

/// Plane coordinates, two a degree of freedom.
pub(crate) const N: usize = 12;
/// Positions, then velocities.
pub(crate) type State = [f64; 2 * N];

#[derive(Clone, Copy, PartialEq, Debug)]
enum Touch {
    Off,
    Beyond,
    Slip(f64),
    Roll,
}

impl Touch {
    fn mode(self) -> Mode {
        match self {
            Touch::Off | Touch::Beyond => Mode::Flight,
            Touch::Roll => Mode::Roll,
            Touch::Slip(s) if s > 0.0 => Mode::SlipPositive,
            Touch::Slip(_) => Mode::SlipNegative,
        }
    }
}

fn at(shape: &[(f64, f64)], z: f64) -> f64 {
    let mut i = 1;
    while i + 1 < shape.len() && shape[i].0 < z {
        i += 1;
    }
    let (a, b) = (shape[i - 1], shape[i]);
    a.1 + (b.1 - a.1) * (z - a.0) / (b.0 - a.0)
}

impl Reference {
    fn weights(&self, z: f64) -> [f64; N / 2] {
        let mut w = [0.0; N / 2];
        (w[0], w[1]) = (1.0, z);
        for (i, m) in self.modes.iter().enumerate() {
            w[2 + i] = at(&m.2, z);
        }
        w
    }
    fn point(&self, y: &[f64], z: f64) -> V2 {
        let w = self.weights(z);
        let mut p = V2::zeros();
        for i in 0..2 + self.modes.len() {
            p += w[i] * V2::new(y[2 * i], y[2 * i + 1]);
        }
        p
    }
    fn inertia(&self, i: usize) -> f64 {
        if i == 1 {
            self.transverse
        } else {
            self.mass_kg
        }
    }
    fn mobility(&self, a: f64, b: f64) -> f64 {
        let (wa, wb) = (self.weights(a), self.weights(b));
        (0..2 + self.modes.len())
            .map(|i| wa[i] * wb[i] / self.inertia(i))
            .sum()
    }
    /// Rates, normal forces, friction, sliding speeds.
    fn rates(
        &self,
        t: f64,
        y: &State,
        touch: &[Touch; 2],
    ) -> (State, [f64; 2], [f64; 2], [f64; 2]) {
        let dof = 2 + self.modes.len();
        let mut q = [V2::zeros(); N / 2]; // generalised forces
        let push = |q: &mut [V2; N / 2], z: f64, f: V2| {
            let w = self.weights(z);
            for i in 0..dof {
                q[i] += w[i] * f;
            }
        };
        let (pos, vel) = y.split_at(N);
        for (z, k, d) in &self.supports {
            push(
                &mut q,
                *z,
                -*k * self.point(pos, *z) - *d * self.point(vel, *z),
            );
        }
        q[0] += self.mass_kg * self.gravity;
        let a = self.spin * t;
        push(
            &mut q,
            self.unbalance.0,
            self.unbalance.1 * self.spin * self.spin * V2::new(a.cos(), a.sin()),
        );
        q[1] += V2::new(
            -self.polar * self.spin * vel[3],
            self.polar * self.spin * vel[2],
        );
        for (i, m) in self.modes.iter().enumerate() {
            let j = 2 + i;
            q[j] -= self.mass_kg
                * (m.0 * m.0 * V2::new(pos[2 * j], pos[2 * j + 1])
                    + 2.0 * m.1 * m.0 * V2::new(vel[2 * j], vel[2 * j + 1]));
        }
        let mut forces = [0.0; 2];
        let mut slips = [0.0; 2];
        let mut tang = [V2::zeros(); 2];
        let mut curve = [0.0; 2];
        let mut s = [0.0; 2];
        for p in 0..2 {
            let Plane {
                z,
                centre,
                clearance: c,
                stiffness: k,
                damping: d,
                friction: mu,
                radius,
            } = self.planes[p];
            let u = self.point(pos, z) - centre;
            let w = self.point(vel, z);
            let rho = u.norm();
            let n = u / rho;
            tang[p] = V2::new(-n.y, n.x);
            forces[p] = k * (rho - c) + d * n.dot(&w);
            let vw = tang[p].dot(&w);
            slips[p] = vw + radius * self.spin;
            curve[p] = -vw * n.dot(&w) / rho;
            if matches!(touch[p], Touch::Slip(_) | Touch::Roll) {
                push(&mut q, z, -forces[p] * n);
            }
            if let Touch::Slip(sign) = touch[p] {
                s[p] = -sign * mu * forces[p];
                push(&mut q, z, s[p] * tang[p]);
            }
        }
        let rolls: Vec<usize> = (0..2).filter(|p| touch[*p] == Touch::Roll).collect();
        if !rolls.is_empty() {
            let wrong = |p: usize| {
                let w = self.weights(self.planes[p].z);
                let mut a = V2::zeros();
                for i in 0..dof {
                    a += w[i] / self.inertia(i) * q[i];
                }
                tang[p].dot(&a) + curve[p]
            };
            let g = |a: usize, b: usize| {
                tang[a].dot(&tang[b]) * self.mobility(self.planes[a].z, self.planes[b].z)
            };
            if rolls.len() == 1 {
                let p = rolls[0];
                s[p] = -wrong(p) / g(p, p);
            } else {
                let (a, b, d) = (g(0, 0), g(0, 1), g(1, 1));
                let det = a * d - b * b;
                let (x, y) = (-wrong(0), -wrong(1));
                s = [(x * d - b * y) / det, (a * y - b * x) / det];
            }
            for p in rolls {
                push(&mut q, self.planes[p].z, s[p] * tang[p]);
            }
        }
        let mut out = [0.0; 2 * N];
        out[..N].copy_from_slice(vel);
        for i in 0..dof {
            out[N + 2 * i] = q[i].x / self.inertia(i);
            out[N + 2 * i + 1] = q[i].y / self.inertia(i);
        }
        (out, forces, s, slips)
    }
    /// Modified midpoint rule extrapolated: order eight.
    fn step(&self, t: f64, y: &State, h: f64, touch: &[Touch; 2]) -> State {
        const PARTS: [usize; 4] = [2, 4, 6, 8];
        let mut table = [[0.0; 2 * N]; 4];
        for (row, parts) in PARTS.iter().enumerate() {
            let dt = h / *parts as f64;
            let (mut a, mut b) = (*y, *y);
            let r = self.rates(t, y, touch).0;
            for i in 0..2 * N {
                b[i] += dt * r[i];
            }
            for part in 1..*parts {
                let r = self.rates(t + part as f64 * dt, &b, touch).0;
                for i in 0..2 * N {
                    let next = a[i] + 2.0 * dt * r[i];
                    a[i] = b[i];
                    b[i] = next;
                }
            }
            let r = self.rates(t + h, &b, touch).0;
            for i in 0..2 * N {
                table[row][i] = 0.5 * (a[i] + b[i] + dt * r[i]);
            }
            for back in (0..row).rev() {
                let ratio = (*parts as f64 / PARTS[back] as f64).powi(2);
                let (front, rest) = table.split_at_mut(back + 1);
                for (a, b) in front[back].iter_mut().zip(&rest[0]) {
                    *a = b + (b - *a) / (ratio - 1.0);
                }
            }
        }
        table[0]
    }
    /// Least guard of each plane: below zero where its mode has ended.
    fn guard(&self, t: f64, y: &State, touch: &[Touch; 2]) -> [f64; 2] {
        let (_, f, s, slip) = self.rates(t, y, touch);
        core::array::from_fn(|p| {
            let Plane {
                z,
                centre,
                clearance: c,
                friction: mu,
                ..
            } = self.planes[p];
            let depth = (self.point(&y[..N], z) - centre).norm() - c;
            match touch[p] {
                Touch::Off => -depth / c,
                Touch::Beyond => (depth / c).min(-f[p]),
                Touch::Slip(sign) => (f[p] / 1e4).min(sign * slip[p]),
                Touch::Roll => (f[p] / 1e4).min((mu * f[p] - s[p].abs()) / 1e4),
            }
        })
    }
    /// Modes of both planes after each event, and where the rotor is at the end.
    pub(crate) fn run(&self, start: State, end: f64, h: f64) -> (Vec<[Mode; 2]>, [V2; 2]) {
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
                if over(&self.step(t, &y, middle, &touch), t + middle) {
                    high = middle;
                } else {
                    low = middle;
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
                let (_, f, s, slip) = self.rates(t, &y, &touch);
                let Plane {
                    z,
                    centre,
                    clearance: c,
                    friction: mu,
                    ..
                } = self.planes[p];
                let depth = (self.point(&y[..N], z) - centre).norm() - c;
                let before = touch[p].mode();
                touch[p] = match touch[p] {
                    Touch::Off => Touch::Slip(slip[p].signum()),
                    Touch::Beyond if depth < 0.0 => Touch::Off,
                    Touch::Beyond => Touch::Slip(slip[p].signum()),
                    Touch::Slip(_) | Touch::Roll if f[p] < 0.0 => {
                        if depth > 0.0 {
                            Touch::Beyond
                        } else {
                            Touch::Off
                        }
                    }
                    Touch::Slip(sign) => {
                        let mut rolling = touch;
                        rolling[p] = Touch::Roll;
                        let (_, f, s, _) = self.rates(t, &y, &rolling);
                        if s[p].abs() <= mu * f[p] {
                            Touch::Roll
                        } else {
                            Touch::Slip(-sign)
                        }
                    }
                    Touch::Roll => Touch::Slip(-s[p].signum()),
                };
                if touch[p].mode() != before {
                    changes.push((t, touch.map(Touch::mode)));
                }
            }
        }
        let ends = [0, 1].map(|p| self.point(&y[..N], self.planes[p].z));
        (settled(&changes), ends)
    }
}

/// Modes of both planes after each instant: what follows one another without time is one event.
pub(crate) fn settled(changes: &[(f64, [Mode; 2])]) -> Vec<[Mode; 2]> {
    let mut out: Vec<[Mode; 2]> = vec![];
    for (i, (t, modes)) in changes.iter().enumerate() {
        let last = changes.get(i + 1).is_none_or(|(next, _)| next - t > 1e-9);
        if last && out.last() != Some(modes) {
            out.push(*modes);
        }
    }
    out
}
