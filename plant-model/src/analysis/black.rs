//! Limits of sliding whirl: Black's condition of steady whirl, with friction, contact compliance and stability.
//!
//! Everything here is isotropic and without unbalance, so that steady whirl is a circle. Let it run backward
//! (clockwise for Ω > 0) at ω and write vectors as complex numbers times e^(−iωt). A body of mass m on a
//! spring k and a damper d answers a force with the receptance α = 1/(k − m·ω² − iωd). On the rotor act the
//! normal force −N and, clockwise, friction −iμN with μ = μ_slide − μ_r; on the ring the opposite. With u = r − s
//!
//! ```text
//! u = −(α_r + α_s)·(1 + iμ)·N      and      u = c + N/k_c, real: the normal is the direction of u
//! ⇒  Im[(α_r + α_s)·(1 + iμ)] = 0          N = c / (−Re[(α_r + α_s)·(1 + iμ)] − 1/k_c) > 0
//! ```
//!
//! A penetration along the normal alone therefore shifts no root; it decides which of them exist, and
//! contact damping has no part in it, since the penetration is constant. A contact that yields along the
//! tangent as well, by T = μN/k_t, has u = c + N/k_c + iμN/k_t, and the first equation becomes
//! Im[…] + μ/k_t = 0; with k_t = k_c that is arg(−(α_r + α_s + 1/k_c)) = −atan μ, Black's condition with
//! the contact spring counted to the stator. The equations of the plant have k_t = ∞.
//!
//! Between roots friction drives the whirl where it is larger than the Im α/(−Re α) that the whirl needs.
//! Rolling whirl fills what the roots bound: there N + iQ = −u/α with |u| = Ω·R_r/ω, and
//! Q/N is what the cone of friction must hold.
//!
//! Source: H. F. Black's theory of synchronous contact as the paper cites it (footnote 1); the derivation is the
//! one above.

use crate::bisection::bisect;
use crate::params::{PlantParams, RingParams, StatorParams};
use nalgebra::{Complex, DMatrix};

mod stability;

type C = Complex<f64>;

/// A mass on a spring and a damper.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Oscillator {
    mass_kg: f64,
    stiffness_n_m: f64,
    damping_n_s_m: f64,
}

impl Oscillator {
    /// Of a ring, where it is the same along x and y.
    fn from_ring(ring: &RingParams) -> Option<Self> {
        let [k, d] = [ring.stiffness_n_m, ring.damping_n_s_m];
        (k.x == k.y && d.x == d.y).then_some(Self {
            mass_kg: ring.mass_kg,
            stiffness_n_m: k.x,
            damping_n_s_m: d.x,
        })
    }

    /// k − iωd.
    fn mounting(&self, omega_rad_s: f64) -> C {
        C::new(self.stiffness_n_m, -omega_rad_s * self.damping_n_s_m)
    }

    fn inertia(&self, omega_rad_s: f64) -> C {
        C::new(self.mass_kg * omega_rad_s * omega_rad_s, 0.0)
    }
}

/// Rotor, stator and contact as steady whirl sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyWhirl {
    rotor: Oscillator,
    /// From the ring that the rotor touches outwards; none for a rigid stator.
    rings: Vec<Oscillator>,
    /// Clearance c \[m\].
    pub clearance_m: f64,
    /// 1/k_c \[m/N\]; 0 for contact without deformation.
    pub normal_compliance_m_n: f64,
    /// 1/k_t \[m/N\]; 0 in the equations of the plant.
    pub tangential_compliance_m_n: f64,
    /// d_c \[N s/m\]; matters for stability only.
    pub contact_damping_n_s_m: f64,
    /// μ − μ_r, the coefficient that drives backward whirl.
    pub driving_friction: f64,
}

/// How rotor and ring meet along the tangent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Surface {
    /// Friction at its limit, whatever the sliding speed.
    Sliding,
    /// No sliding: the contact point follows a surface speed that is held.
    Rolling,
}

/// Steady whirl in a circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Whirl rate ω \[rad/s\], backward positive.
    pub omega_rad_s: f64,
    /// Normal force N \[N\]; where it is not positive the circle does not exist.
    pub normal_force_n: f64,
    /// Tangential force on the rotor along the whirl, as a share of N.
    pub driving_share: f64,
    /// Distance |u| of rotor and ring \[m\].
    pub distance_m: f64,
    /// Friction drives below it and brakes above it, not the other way round.
    pub attracts: bool,
    /// Growth rate of the fastest small disturbance, the phase aside \[1/s\]; stable where negative.
    pub growth_rate_s: f64,
}

impl Circle {
    /// Whirl frequency \[Hz\], backward positive.
    pub fn frequency_hz(&self) -> f64 {
        self.omega_rad_s / std::f64::consts::TAU
    }

    /// There is a force that keeps it.
    pub fn exists(&self) -> bool {
        self.normal_force_n > 0.0 && self.distance_m > 0.0
    }
}

impl SteadyWhirl {
    /// Of a plant; `None` where ring or bore is not the same along x and y, where the contact is not linear, and with a
    /// race: a whirl that rolls on it has no speed of its own, since the race turns along. Sliding friction is taken at
    /// rest.
    pub fn from_params(params: &PlantParams) -> Option<Self> {
        if params.race.is_some() {
            return None;
        }
        let rings = match &params.stator {
            StatorParams::Rigid => vec![],
            StatorParams::RigidEllipse(bore) if bore.ellipticity == 0.0 => vec![],
            StatorParams::RigidEllipse(_) => return None,
            StatorParams::OneMass(ring) => vec![Oscillator::from_ring(ring)?],
            StatorParams::TwoMass { inner, outer } => {
                vec![Oscillator::from_ring(inner)?, Oscillator::from_ring(outer)?]
            }
        };
        let friction = &params.friction;
        let contact = params.contact.law.linear()?;
        Some(Self {
            rotor: Oscillator {
                mass_kg: params.rotor.mass_kg,
                stiffness_n_m: params.rotor.stiffness_n_m,
                damping_n_s_m: params.rotor.damping_n_s_m,
            },
            rings,
            clearance_m: params.contact.clearance_m,
            normal_compliance_m_n: 1.0 / contact.stiffness_n_m,
            tangential_compliance_m_n: 0.0,
            contact_damping_n_s_m: contact.damping_n_s_m,
            driving_friction: friction.sliding.coefficient(0.0) - friction.rolling_coefficient,
        })
    }

    /// α_r + α_s \[m/N\]: how far rotor and ring part under a unit of force between them.
    pub(crate) fn receptance_m_n(&self, omega_rad_s: f64) -> C {
        let w = omega_rad_s;
        let own = |o: &Oscillator| o.mounting(w) - o.inertia(w);
        // From the outside in: each ring's mounting in series with what carries it.
        let carried = self
            .rings
            .iter()
            .rev()
            .fold(None, |outer: Option<C>, ring| {
                let mounting = match outer {
                    None => ring.mounting(w),
                    Some(outer) => ring.mounting(w) * outer / (ring.mounting(w) + outer),
                };
                Some(mounting - ring.inertia(w))
            });
        own(&self.rotor).inv() + carried.map_or(C::new(0.0, 0.0), |dynamic| dynamic.inv())
    }

    /// Im[(α_r + α_s)·(1 + iμ)] + μ/k_t \[m/N\]: negative where friction drives.
    fn balance(&self, omega_rad_s: f64) -> f64 {
        let alpha = self.receptance_m_n(omega_rad_s);
        alpha.im + self.driving_friction * (alpha.re + self.tangential_compliance_m_n)
    }

    fn distance_per_force(&self, omega_rad_s: f64) -> f64 {
        let alpha = self.receptance_m_n(omega_rad_s);
        -alpha.re + self.driving_friction * alpha.im
    }

    /// Friction that sliding whirl at ω needs; `None` where no pressing contact can keep it.
    pub fn friction_needed(&self, omega_rad_s: f64) -> Option<f64> {
        let alpha = self.receptance_m_n(omega_rad_s);
        let apart = -(alpha.re + self.tangential_compliance_m_n);
        let mu = alpha.im / apart;
        let presses = -alpha.re + mu * alpha.im > self.normal_compliance_m_n;
        (apart > 0.0 && presses).then_some(mu)
    }

    /// Every steady sliding whirl, existing or not, from `low_hz` to `high_hz`, slowest first; sought in
    /// steps of 0.1 Hz.
    pub fn sliding(&self, low_hz: f64, high_hz: f64) -> Vec<Circle> {
        const STEP_HZ: f64 = 0.1;
        let steps = ((high_hz - low_hz) / STEP_HZ).ceil().max(0.0) as u32;
        let at = |i: u32| std::f64::consts::TAU * (low_hz + STEP_HZ * f64::from(i));
        (0..steps)
            .filter(|i| self.balance(at(*i)) * self.balance(at(i + 1)) < 0.0)
            .map(|i| self.sliding_at(zero_between(at(i), at(i + 1), |w| self.balance(w))))
            .collect()
    }

    fn sliding_at(&self, omega_rad_s: f64) -> Circle {
        let room = self.distance_per_force(omega_rad_s) - self.normal_compliance_m_n;
        let normal_force_n = self.clearance_m / room;
        let beside = omega_rad_s * 1e-6;
        let mut circle = Circle {
            omega_rad_s,
            normal_force_n,
            driving_share: self.driving_friction,
            distance_m: self.clearance_m + normal_force_n * self.normal_compliance_m_n,
            attracts: self.balance(omega_rad_s - beside) < self.balance(omega_rad_s + beside),
            growth_rate_s: f64::NAN,
        };
        circle.growth_rate_s = self.growth_rate_s(&circle, Surface::Sliding);
        circle
    }

    /// The slowest whirl that friction cannot hold back any more: the first root at which it starts to drive.
    pub fn onset(&self, high_hz: f64) -> Option<Circle> {
        (self.sliding(1.0, high_hz).into_iter()).find(|c| c.exists() && !c.attracts)
    }

    /// The upper whirl limit: the first root above the onset at which friction turns from driving to
    /// braking. `None` where it needs a pull: then nothing but rolling or a resonance ends the growth.
    pub fn upper_limit(&self, high_hz: f64) -> Option<Circle> {
        let onset = self.onset(high_hz)?.omega_rad_s;
        let first = (self.sliding(1.0, high_hz).into_iter())
            .find(|c| c.omega_rad_s > onset && c.attracts)?;
        first.exists().then_some(first)
    }

    /// Steady rolling whirl at ω: its force, and the spin Ω \[rad/s\] that it belongs to on a rotor of
    /// radius R_r.
    pub fn rolling_at(&self, omega_rad_s: f64, contact_radius_m: f64) -> (Circle, f64) {
        // u = −α·(N + iQ) and u = c + N/k_c.
        let force = -self.receptance_m_n(omega_rad_s).inv();
        let distance_m = self.clearance_m / (1.0 - force.re * self.normal_compliance_m_n);
        let mut circle = Circle {
            omega_rad_s,
            normal_force_n: force.re * distance_m,
            driving_share: force.im / force.re,
            distance_m,
            attracts: false,
            growth_rate_s: f64::NAN,
        };
        circle.growth_rate_s = self.growth_rate_s(&circle, Surface::Rolling);
        (circle, omega_rad_s * distance_m / contact_radius_m)
    }

    /// Every steady rolling whirl at a spin Ω \[rad/s\] from `low_hz` to `high_hz`, sought in steps of 0.1 Hz.
    pub fn rolling(
        &self,
        spin_rad_s: f64,
        contact_radius_m: f64,
        (low_hz, high_hz): (f64, f64),
    ) -> Vec<Circle> {
        const STEP_HZ: f64 = 0.1;
        let steps = ((high_hz - low_hz) / STEP_HZ).ceil().max(0.0) as u32;
        let at = |i: u32| std::f64::consts::TAU * (low_hz + STEP_HZ * f64::from(i));
        // Clearance over distance instead of the distance: no pole, and positive where there is a circle.
        let excess = |w: f64| {
            let force = -self.receptance_m_n(w).inv();
            let share = 1.0 - force.re * self.normal_compliance_m_n;
            share - w * self.clearance_m / (spin_rad_s * contact_radius_m)
        };
        (0..steps)
            .filter(|i| excess(at(*i)) * excess(at(i + 1)) < 0.0)
            .map(|i| zero_between(at(i), at(i + 1), excess))
            .map(|w| self.rolling_at(w, contact_radius_m).0)
            .filter(Circle::exists)
            .collect()
    }

    /// Smallest driving friction with which any steady sliding whirl from `low_hz` to `high_hz` exists, and
    /// its frequency \[Hz\]; sought in steps of 0.01 Hz. Below it friction never makes up for damping.
    pub fn least_friction(&self, low_hz: f64, high_hz: f64) -> Option<(f64, f64)> {
        const STEP_HZ: f64 = 0.01;
        let steps = ((high_hz - low_hz) / STEP_HZ).ceil().max(0.0) as u32;
        (0..=steps)
            .map(|i| low_hz + STEP_HZ * f64::from(i))
            .filter_map(|hz| Some((self.friction_needed(hz * std::f64::consts::TAU)?, hz)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Natural frequencies \[Hz\] without damping of rotor and stator joined in the contact: by k_c, or
    /// rigidly where contact does not deform. Slowest first.
    pub fn coupled_frequencies_hz(&self) -> Vec<f64> {
        let rigid = self.normal_compliance_m_n == 0.0 && !self.rings.is_empty();
        let mut masses = vec![self.rotor.mass_kg];
        masses.extend(self.rings.iter().map(|ring| ring.mass_kg));
        let n = masses.len();
        let mut k = DMatrix::<f64>::zeros(n, n);
        let mut join = |a: usize, b: Option<usize>, stiffness: f64| {
            k[(a, a)] += stiffness;
            if let Some(b) = b {
                k[(b, b)] += stiffness;
                k[(a, b)] -= stiffness;
                k[(b, a)] -= stiffness;
            }
        };
        join(0, None, self.rotor.stiffness_n_m);
        if self.normal_compliance_m_n > 0.0 {
            join(0, (n > 1).then_some(1), 1.0 / self.normal_compliance_m_n);
        }
        for (i, ring) in self.rings.iter().enumerate() {
            join(i + 1, (i + 2 < n).then_some(i + 2), ring.stiffness_n_m);
        }
        // Rigidly joined: rotor and inner ring move as one.
        let (masses, k) = if rigid {
            let join = DMatrix::from_fn(n, n - 1, |i, j| f64::from(u8::from(i.max(1) == j + 1)));
            masses[1] += masses[0];
            (masses.split_off(1), join.transpose() * k * join)
        } else {
            (masses, k)
        };
        let scaled = DMatrix::from_fn(masses.len(), masses.len(), |i, j| {
            k[(i, j)] / (masses[i] * masses[j]).sqrt()
        });
        let mut all: Vec<f64> = (scaled.symmetric_eigenvalues().iter())
            .map(|square| square.max(0.0).sqrt() / std::f64::consts::TAU)
            .collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

/// Zero of `f` between `low` and `high`, where it has different signs.
fn zero_between(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    bisect((low, high), |x| f(x).signum() == sign)
}

#[cfg(test)]
mod tests;
