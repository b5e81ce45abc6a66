//! The benchmark problems, written down a second time: smooth equations for each mode, guards that
//! end a mode, and what follows then. Nothing here comes from the project but the numbers.

/// One problem. The layout is shared with `cvode/peer.c`; SI units.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Problem {
    pub m: f64,
    pub k: f64,
    pub d: f64,
    pub clearance: f64,
    pub mu: f64,
    pub spin: f64,
    pub radius: f64,
    pub eccentricity: f64,
    pub k_c: f64,
    pub d_c: f64,
    /// Mass of the stator; 0 for a wall that does not move.
    pub m_s: f64,
    pub k_s: f64,
    pub d_s: f64,
    pub start_speed: f64,
    pub t_end: f64,
}

/// Speeds below this at a touch are checked for rolling at once \[m/s\].
const NO_SPEED: f64 = 1e-12;
/// Least (scaled) value of a guard where its mode begins. A guard that has just been armed is zero up
/// to rounding; read as positive there, it can only fall through zero, and no solver reports the
/// event it has just come from once more.
const ARMED: f64 = 1e-9;
/// Most guards that a mode has.
pub const GUARDS: usize = 3;

#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    Flight,
    SlipPositive,
    SlipNegative,
    Roll,
}

impl Mode {
    fn slip_sign(self) -> f64 {
        match self {
            Self::SlipPositive => 1.0,
            Self::SlipNegative => -1.0,
            Self::Flight | Self::Roll => 0.0,
        }
    }
}

type V2 = [f64; 2];

fn dot(a: V2, b: V2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn at(y: &[f64], i: usize) -> V2 {
    [y[i], y[i + 1]]
}

fn minus(a: V2, b: V2) -> V2 {
    [a[0] - b[0], a[1] - b[1]]
}

/// Rotor against stator at one point.
struct Contact {
    distance: f64,
    normal: V2,
    tangent: V2,
    normal_speed: f64,
    whirl_speed: f64,
    normal_force: f64,
}

impl Problem {
    pub fn bouncing(k_c: f64) -> Self {
        Self {
            m: 10.0,
            k: 4e5,
            d: 200.0,
            clearance: 3e-4,
            mu: 0.3,
            spin: 400.0,
            radius: 2.5e-3,
            eccentricity: 1e-5,
            k_c,
            d_c: 0.1 * (k_c * 10.0).sqrt(),
            m_s: 0.0,
            k_s: 0.0,
            d_s: 0.0,
            start_speed: 0.3,
            t_end: 0.2,
        }
    }

    pub fn in_stator(m_s: f64, d_c: f64) -> Self {
        Self {
            d_c,
            m_s,
            k_s: 2e7,
            d_s: 3000.0,
            t_end: 0.02,
            ..Self::bouncing(1e10)
        }
    }

    pub fn states(&self) -> usize {
        if self.m_s > 0.0 { 8 } else { 4 }
    }

    pub fn start(&self) -> Vec<f64> {
        let mut y = vec![0.0; self.states()];
        y[2] = self.start_speed;
        y
    }

    /// Absolute tolerances: the relative one of the clearance and of the start speed.
    pub fn atol(&self, rtol: f64) -> Vec<f64> {
        let scale = |i| {
            if i % 4 < 2 {
                self.clearance
            } else {
                self.start_speed
            }
        };
        (0..self.states()).map(|i| rtol * scale(i)).collect()
    }

    fn contact(&self, y: &[f64]) -> Contact {
        let (mut u, mut w) = (at(y, 0), at(y, 2));
        if self.m_s > 0.0 {
            (u, w) = (minus(u, at(y, 4)), minus(w, at(y, 6)));
        }
        let distance = dot(u, u).sqrt();
        // Concentric: far from contact, any direction will do.
        let normal = if distance > 0.0 {
            [u[0] / distance, u[1] / distance]
        } else {
            [1.0, 0.0]
        };
        let tangent = [-normal[1], normal[0]];
        let normal_speed = dot(w, normal);
        Contact {
            distance,
            normal,
            tangent,
            normal_speed,
            whirl_speed: dot(w, tangent),
            normal_force: self.k_c * (distance - self.clearance) + self.d_c * normal_speed,
        }
    }

    fn sliding_speed(&self, c: &Contact) -> f64 {
        self.spin * self.radius + c.whirl_speed
    }

    fn mobility(&self) -> f64 {
        1.0 / self.m + if self.m_s > 0.0 { 1.0 / self.m_s } else { 0.0 }
    }

    /// Accelerations of rotor and stator by springs and dampers to ground: linear in the state.
    fn linear(&self, y: &[f64]) -> (V2, V2) {
        let pull = |i: usize, k: f64, d: f64, m: f64| -> V2 {
            [
                -(k * y[i] + d * y[i + 2]) / m,
                -(k * y[i + 1] + d * y[i + 3]) / m,
            ]
        };
        let rotor = pull(0, self.k, self.d, self.m);
        if self.m_s > 0.0 {
            (rotor, pull(4, self.k_s, self.d_s, self.m_s))
        } else {
            (rotor, [0.0; 2])
        }
    }

    /// The same with the unbalance: everything but the contact.
    fn free(&self, t: f64, y: &[f64]) -> (V2, V2) {
        let (mut rotor, stator) = self.linear(y);
        let unbalance = self.eccentricity * self.spin * self.spin;
        let (sin, cos) = (self.spin * t).sin_cos();
        rotor[0] += unbalance * cos;
        rotor[1] += unbalance * sin;
        (rotor, stator)
    }

    /// Tangential force that keeps the sliding speed as it is.
    fn rolling_force(&self, t: f64, y: &[f64], c: &Contact) -> f64 {
        let (rotor, stator) = self.free(t, y);
        let turning = c.normal_speed * c.whirl_speed / c.distance;
        -(dot(minus(rotor, stator), c.tangent) - turning) / self.mobility()
    }

    /// Velocities and accelerations; `force` acts on the rotor and back on the stator.
    fn assemble(&self, y: &[f64], (rotor, stator): (V2, V2), force: V2, out: &mut [f64]) {
        for i in 0..2 {
            out[i] = y[2 + i];
            out[2 + i] = rotor[i] + force[i] / self.m;
        }
        if self.m_s > 0.0 {
            for i in 0..2 {
                out[4 + i] = y[6 + i];
                out[6 + i] = stator[i] - force[i] / self.m_s;
            }
        }
    }

    /// dy/dt of a mode.
    pub fn rhs(&self, mode: Mode, t: f64, y: &[f64], out: &mut [f64]) {
        let free = self.free(t, y);
        let force = if mode == Mode::Flight {
            [0.0; 2]
        } else {
            let c = self.contact(y);
            let tangential = match mode {
                Mode::Roll => self.rolling_force(t, y, &c),
                _ => -mode.slip_sign() * self.mu * c.normal_force,
            };
            let along = |i: usize| tangential * c.tangent[i] - c.normal_force * c.normal[i];
            [along(0), along(1)]
        };
        self.assemble(y, free, force, out);
    }

    /// Derivative of [`Self::rhs`] along `v`.
    pub fn tangent(&self, mode: Mode, t: f64, y: &[f64], v: &[f64], out: &mut [f64]) {
        let linear = self.linear(v);
        if mode == Mode::Flight {
            return self.assemble(v, linear, [0.0; 2], out);
        }
        let c = self.contact(y);
        let (n, tau) = (c.normal, c.tangent);
        let (mut du, mut dw) = (at(v, 0), at(v, 2));
        if self.m_s > 0.0 {
            (du, dw) = (minus(du, at(v, 4)), minus(dw, at(v, 6)));
        }
        let stretch = dot(n, du);
        let turn = dot(tau, du) / c.distance;
        let normal_speed = dot(dw, n) + c.whirl_speed * turn;
        let whirl_speed = dot(dw, tau) - c.normal_speed * turn;
        let normal_force = self.k_c * stretch + self.d_c * normal_speed;
        let (tangential, d_tangential) = if mode == Mode::Roll {
            let (rotor, stator) = self.free(t, y);
            let product = normal_speed * c.whirl_speed + c.normal_speed * whirl_speed
                - c.normal_speed * c.whirl_speed * stretch / c.distance;
            let base = dot(minus(linear.0, linear.1), tau)
                - turn * dot(minus(rotor, stator), n)
                - product / c.distance;
            (self.rolling_force(t, y, &c), -base / self.mobility())
        } else {
            let by_force = -mode.slip_sign() * self.mu;
            (by_force * c.normal_force, by_force * normal_force)
        };
        let along = |i: usize| {
            (d_tangential - c.normal_force * turn) * tau[i]
                - (normal_force + tangential * turn) * n[i]
        };
        self.assemble(v, linear, [along(0), along(1)], out);
    }

    /// Guards of a mode that began at `since`: positive while it holds, 1 where not used.
    pub fn guards(&self, mode: Mode, since: f64, t: f64, y: &[f64]) -> [f64; GUARDS] {
        let c = self.contact(y);
        let force_scale = self.k_c * self.clearance;
        let force = c.normal_force / force_scale;
        let mut guards = match mode {
            // Contact needs penetration and a pushing force: also after a separation that left the
            // wall dented.
            Mode::Flight => [-force.min(c.distance / self.clearance - 1.0), 1.0, 1.0],
            Mode::Roll => {
                let needed = self.rolling_force(t, y, &c) / force_scale;
                [force, self.mu * force - needed, self.mu * force + needed]
            }
            slip => [
                force,
                slip.slip_sign() * self.sliding_speed(&c) / (self.spin * self.radius),
                1.0,
            ],
        };
        if t == since {
            guards = guards.map(|g| g.max(ARMED));
        }
        guards
    }

    /// The mode after `guard` of `mode` has fallen to zero. Where that stops the sliding, what is
    /// left of its speed is taken out.
    pub fn next(&self, mode: Mode, guard: usize, t: f64, y: &mut [f64]) -> Mode {
        let c = self.contact(y);
        let speed = self.sliding_speed(&c);
        match (mode, guard) {
            (Mode::Flight, _) if speed.abs() > NO_SPEED => {
                return if speed > 0.0 {
                    Mode::SlipPositive
                } else {
                    Mode::SlipNegative
                };
            }
            (Mode::SlipPositive | Mode::SlipNegative | Mode::Roll, 0) => return Mode::Flight,
            _ => {}
        }
        let impulse = -speed / self.mobility();
        for i in 0..2 {
            y[2 + i] += impulse / self.m * c.tangent[i];
            if self.m_s > 0.0 {
                y[6 + i] -= impulse / self.m_s * c.tangent[i];
            }
        }
        let c = self.contact(y);
        let needed = self.rolling_force(t, y, &c);
        if mode != Mode::Roll && needed.abs() <= self.mu * c.normal_force {
            Mode::Roll
        } else if needed > 0.0 {
            // Friction cannot give all of what pulls the surface back.
            Mode::SlipNegative
        } else {
            Mode::SlipPositive
        }
    }
}
