//! Flight, exact: the equations are linear, so a power series over a step short against the fastest
//! rate gives the solution to round-off, and the wall crossing is found on that solution.

use crate::V2;
use crate::energy::Flows;
use crate::magnet::Amplifier;
use crate::params::RotorParams;
use crate::part::Body;
use crate::series::{MAX_PHASE, Series, order_for, quadrature};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Inputs, State, StateOf, System};

/// Where a segment of flight meets the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Crossing {
    /// Nowhere in the segment.
    Nowhere,
    /// At this θ.
    At(f64),
    /// Not before this θ; what comes after was too close to grazing to decide in one go.
    ClearUntil(f64),
}

/// Exact solution over one step of flight.
pub(crate) struct Segment<S: Stator> {
    pub(crate) step_s: f64,
    /// Step times the fastest rate.
    phase: f64,
    order: usize,
    position: Series,
    velocity: Series,
    /// Unbalance force \[N\], if there is any.
    unbalance: Option<Series>,
    force: Series,
    stator: S::Series,
    /// Rotor against ring.
    gap: Series,
}

impl<S: Stator, W: Spin, M: Amplifier> System<S, W, M> {
    /// Longest step whose series converges to round-off within the orders kept.
    pub(crate) fn longest_flight_s(&self, y: &StateOf<S, W, M>, dt_s: f64) -> f64 {
        MAX_PHASE / self.fastest_flight_rate(y, dt_s)
    }

    fn fastest_flight_rate(&self, y: &StateOf<S, W, M>, dt_s: f64) -> f64 {
        let mut fastest = (self.rotor.stiffness_n_m.abs() / self.rotor.mass_kg).sqrt()
            + self.rotor.damping_n_s_m / self.rotor.mass_kg;
        fastest = fastest
            .max(self.stator.fastest_rate_rad_s())
            .max(self.amplifier.fastest_rate_rad_s());
        if self.rotor.eccentricity_m != 0.0 {
            // Phase Ω·t + α·t²/2: the second part alone is a series in √α·t.
            let gain = self.spin.drive_torque_n_m().abs() * self.spin.inverse_inertia();
            let turning = self.spin.spin_rad_s(&y.spin).abs() + gain * dt_s + gain.sqrt();
            fastest = fastest.max(turning);
        }
        // Without any dynamics (no stiffness, no damping, no lag) three terms are the solution.
        fastest.max(1e-6 / dt_s)
    }

    /// Solves the flight from `y` over `step_s`, at most [`System::longest_flight_s`].
    pub(crate) fn fly(
        &self,
        t_s: f64,
        y: &StateOf<S, W, M>,
        inputs: &Inputs,
        step_s: f64,
    ) -> Segment<S> {
        let phase = step_s * self.fastest_flight_rate(y, step_s);
        let order = order_for(phase);
        let force = self
            .amplifier
            .series(&y.force, inputs.command_n, step_s, order);
        let unbalance = (self.rotor.eccentricity_m != 0.0)
            .then(|| self.unbalance_series(t_s, y, step_s, order));
        let (mut position, mut velocity) = (
            Series::start(y.rotor.position),
            Series::start(y.rotor.velocity),
        );
        let RotorTerms { k, d, inverse_m } = RotorTerms::of(&self.rotor);
        for i in 0..order {
            let scale = step_s / (i + 1) as f64;
            let mut f = force.0[i] - k * position.0[i] - d * velocity.0[i];
            if i == 0 {
                f += inputs.external_n;
            }
            if let Some(unbalance) = &unbalance {
                f += unbalance.0[i];
            }
            position.0[i + 1] = scale * velocity.0[i];
            velocity.0[i + 1] = scale * inverse_m * f;
        }
        let stator = self.stator.series(&y.stator, step_s, order);
        let mut gap = position;
        if let Some(ring) = S::inner_series(&stator) {
            for (g, s) in gap.0[..=order].iter_mut().zip(&ring.0) {
                *g -= s;
            }
        }
        Segment {
            step_s,
            phase,
            order,
            position,
            velocity,
            unbalance,
            force,
            stator,
            gap,
        }
    }

    /// m·ε·(Ω̇·(sin σ, −cos σ) + Ω²·(cos σ, sin σ)) with Ω linear in time.
    fn unbalance_series(
        &self,
        t_s: f64,
        y: &StateOf<S, W, M>,
        step_s: f64,
        order: usize,
    ) -> Series {
        let spin = self.spin.spin_rad_s(&y.spin);
        let acceleration = self.spin.drive_torque_n_m() * self.spin.inverse_inertia();
        let gain = acceleration * step_s;
        let (sin, cos) = self.spin.phase_rad(&y.spin, t_s).sin_cos();
        // Direction (cos σ, sin σ); its quarter turn clockwise is (sin σ, −cos σ).
        let mut direction = Series::start(V2::new(cos, sin));
        let turned = |v: V2| V2::new(-v.y, v.x);
        for i in 0..order {
            let mut rate = spin * direction.0[i];
            if i > 0 {
                rate += gain * direction.0[i - 1];
            }
            direction.0[i + 1] = step_s / (i + 1) as f64 * turned(rate);
        }
        let square = [spin * spin, 2.0 * spin * gain, gain * gain];
        let mut force = Series::start(V2::zeros());
        for i in 0..=order {
            let mut a = -acceleration * turned(direction.0[i]);
            for (j, s) in square.iter().enumerate().take(i + 1) {
                a += *s * direction.0[i - j];
            }
            force.0[i] = self.rotor.mass_kg * self.rotor.eccentricity_m * a;
        }
        force
    }

    /// State at θ of a segment that started at `y`.
    pub(crate) fn flown(
        &self,
        segment: &Segment<S>,
        y: &StateOf<S, W, M>,
        theta: f64,
    ) -> StateOf<S, W, M> {
        State {
            rotor: Body {
                position: segment.position.at(theta, segment.order),
                velocity: segment.velocity.at(theta, segment.order),
            },
            stator: S::at(&segment.stator, theta, segment.order),
            spin: self.spin.coast(&y.spin, theta * segment.step_s),
            force: M::at(&segment.force, theta, segment.order),
        }
    }

    /// Energy through each door from 0 to θ, from `y` to `end`.
    pub(crate) fn flight_flows(
        &self,
        segment: &Segment<S>,
        y: &StateOf<S, W, M>,
        end: &StateOf<S, W, M>,
        inputs: &Inputs,
        theta: f64,
    ) -> Flows {
        let path = end.rotor.position - y.rotor.position;
        let inverse_j = self.spin.inverse_inertia();
        let drive = if inverse_j > 0.0 && self.spin.drive_torque_n_m() != 0.0 {
            let (a, b) = (
                self.spin.spin_rad_s(&y.spin),
                self.spin.spin_rad_s(&end.spin),
            );
            0.5 * (b * b - a * a) / inverse_j
        } else {
            0.0
        };
        let mut flows = Flows {
            external: inputs.external_n.dot(&path),
            drive,
            ..Flows::default()
        };
        if !M::LAGS {
            flows.control = inputs.command_n.dot(&path);
        }
        let order = segment.order;
        for (node, weight) in quadrature(segment.phase * theta) {
            let at = theta * node;
            let weight = theta * segment.step_s * weight;
            let v = segment.velocity.at(at, order);
            if M::LAGS {
                flows.control += weight * segment.force.at(at, order).dot(&v);
            }
            if let Some(unbalance) = &segment.unbalance {
                flows.unbalance += weight * unbalance.at(at, order).dot(&v);
            }
            flows.rotor_damping += weight * self.rotor.damping_n_s_m * v.norm_squared();
            let stator = S::at(&segment.stator, at, order);
            flows.stator_damping += weight * self.stator.damping_w(&stator);
        }
        flows
    }
}

struct RotorTerms {
    k: f64,
    d: f64,
    inverse_m: f64,
}

impl RotorTerms {
    fn of(rotor: &RotorParams) -> Self {
        Self {
            k: rotor.stiffness_n_m,
            d: rotor.damping_n_s_m,
            inverse_m: 1.0 / rotor.mass_kg,
        }
    }
}

impl<S: Stator> Segment<S> {
    /// First θ in [0, 1] at which the rotor reaches the wall from inside.
    ///
    /// Conservative advancement on G = |u|² − c²: with M an upper bound of |G̈| over the step, no root
    /// lies before the root of G + Ġ·τ + M·τ²/2. Each move is therefore safe, and near a simple root
    /// the moves converge as fast as Newton's. A start on the wall moving inwards counts as inside.
    pub(crate) fn wall_crossing(&self, clearance_m: f64, just_left: bool) -> Crossing {
        let bound = |derivative: usize| {
            let mut sum = 0.0;
            for (k, c) in self.gap.0[..=self.order]
                .iter()
                .enumerate()
                .skip(derivative)
            {
                let factor = match derivative {
                    0 => 1.0,
                    1 => k as f64,
                    _ => (k * (k - 1)) as f64,
                };
                sum += factor * c.norm();
            }
            sum
        };
        let farthest = bound(0);
        if farthest < clearance_m {
            return Crossing::Nowhere;
        }
        let speed = bound(1);
        let curvature = 2.0 * (speed * speed + farthest * bound(2));
        if curvature == 0.0 {
            // At rest on the wall, and nothing moves it.
            return Crossing::Nowhere;
        }
        let square = clearance_m * clearance_m;
        let tiny = 4.0 * f64::EPSILON * square;
        let value = |theta: f64| {
            let u = self.gap.at(theta, self.order);
            let rate = self.gap_rate(theta);
            (u.norm_squared() - square, 2.0 * u.dot(&rate))
        };
        // A rotor at rest on the wall moves at least this far before it is judged.
        let least = 1e-9 * (clearance_m / speed).min(1.0);
        let mut theta = 0.0;
        for _ in 0..200 {
            let (g, mut rate) = value(theta);
            if just_left && theta == 0.0 {
                // Whatever rounding says: the contact force has just fallen to zero.
                rate = rate.min(0.0);
            }
            if g >= -tiny && rate > 0.0 {
                return Crossing::At(theta);
            }
            let g = g.min(0.0);
            let mut advance = if rate > 0.0 {
                // Stable form of the positive root.
                -2.0 * g / (rate + (rate * rate - 2.0 * curvature * g).sqrt())
            } else {
                ((rate * rate - 2.0 * curvature * g).sqrt() - rate) / curvature
            };
            if g >= -tiny {
                advance = advance.max(least);
            }
            theta += advance;
            if theta > 1.0 {
                return Crossing::Nowhere;
            }
        }
        Crossing::ClearUntil(theta)
    }

    fn gap_rate(&self, theta: f64) -> V2 {
        let mut sum = V2::zeros();
        for k in (1..=self.order).rev() {
            sum = sum * theta + k as f64 * self.gap.0[k];
        }
        sum
    }
}
