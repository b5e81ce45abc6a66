//! Flight, exact: the equations are linear, so a power series over a step short against the fastest
//! rate gives the solution to round-off, and the wall crossing is found on that solution.

use crate::V2;
use crate::energy::Flows;
use crate::magnet::Amplifier;
use crate::part::Body;
use crate::plane::{Bore, Raceway};
use crate::quadrature::{EIGHT, Nodes, SIX};
use crate::series::{INVERSE, MAX_PHASE, Series, order_for};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Inputs, State, StateOf, System};
use crate::vector::perp;

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

/// Exact solution over one step of flight. Filled again from step to step.
#[derive(Debug, Clone)]
pub(crate) struct Segment<S: Stator> {
    /// Fastest rate without unbalance \[1/s\].
    rate_rad_s: f64,
    pub(crate) step_s: f64,
    /// Step times the fastest rate.
    phase: f64,
    pub(crate) order: usize,
    position: Series,
    velocity: Series,
    /// Unbalance force \[N\] and its direction; unused without eccentricity.
    unbalance: Series,
    direction: Series,
    force: Series,
    pub(crate) stator: S::Series,
    /// Rotor against ring, and out of round squeezed so that the wall is a circle; else unused.
    gap: Series,
}

/// Velocity \[m/s\] and delivered force \[N\] at the nodes of a quadrature.
pub(crate) struct Values<const N: usize> {
    pub(crate) velocity: [V2; N],
    pub(crate) force: [V2; N],
}

impl<S: Stator> Segment<S> {
    pub(crate) fn new(rate_rad_s: f64) -> Self {
        Self {
            rate_rad_s,
            step_s: 0.0,
            phase: 0.0,
            order: 0,
            position: Series::default(),
            velocity: Series::default(),
            unbalance: Series::default(),
            direction: Series::default(),
            force: Series::default(),
            stator: S::Series::default(),
            gap: Series::default(),
        }
    }

    /// Rotor against ring.
    fn gap<B: Bore>(&self) -> &Series {
        match S::inner_series(&self.stator) {
            Some(_) => &self.gap,
            None if B::OUT_OF_ROUND => &self.gap,
            None => &self.position,
        }
    }
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    /// Fastest rate of rotor, rings and amplifier in flight \[1/s\].
    pub(crate) fn flight_rate_rad_s(&self) -> f64 {
        let rotor = (self.rotor.stiffness_n_m.abs() / self.rotor.mass_kg).sqrt()
            + self.rotor.damping_n_s_m / self.rotor.mass_kg;
        rotor
            .max(self.stator.fastest_rate_rad_s())
            .max(self.amplifier.fastest_rate_rad_s())
    }

    /// The same with the unbalance, for a step of up to `dt_s`.
    fn fastest_flight_rate(&self, rate_rad_s: f64, y: &StateOf<S, W, M, R>, dt_s: f64) -> f64 {
        let mut fastest = rate_rad_s;
        if self.rotor.eccentricity_m != 0.0 {
            // Phase Ω·t + α·t²/2: the second part alone is a series in √α·t.
            let gain = self.spin.drive_torque_n_m().abs() * self.spin.inverse_inertia();
            let turning = self.spin.spin_rad_s(&y.spin).abs() + gain * dt_s + gain.sqrt();
            fastest = fastest.max(turning);
        }
        // Without any dynamics (no stiffness, no damping, no lag) three terms are the solution.
        fastest.max(1e-6 / dt_s)
    }

    /// Solves the flight from `y` over at most `dt_s`: as far as the series converges to round-off
    /// within the orders kept.
    pub(crate) fn fly(
        &self,
        segment: &mut Segment<S>,
        (t_s, y): (f64, &StateOf<S, W, M, R>),
        inputs: &Inputs,
        dt_s: f64,
    ) {
        let rate = self.fastest_flight_rate(segment.rate_rad_s, y, dt_s);
        let mut step_s = dt_s;
        if dt_s * rate > MAX_PHASE {
            // A step that the clock can show.
            step_s = (t_s + MAX_PHASE / rate) - t_s;
        }
        let phase = step_s * rate;
        if phase != segment.phase {
            segment.order = order_for(phase);
        }
        (segment.step_s, segment.phase) = (step_s, phase);
        let order = segment.order;
        let force = (&y.force, inputs.command_n);
        (self.amplifier).series(&mut segment.force, force, step_s, order);
        let unbalanced = self.rotor.eccentricity_m != 0.0;
        if unbalanced {
            self.unbalance_series(segment, (t_s, y));
        }
        self.stator
            .series(&mut segment.stator, &y.stator, step_s, order);
        let (position, velocity) = (&mut segment.position.0, &mut segment.velocity.0);
        position[0] = y.rotor.position;
        velocity[0] = y.rotor.velocity;
        let inverse_m = 1.0 / self.rotor.mass_kg;
        let (k, d) = (
            self.rotor.stiffness_n_m * inverse_m,
            self.rotor.damping_n_s_m * inverse_m,
        );
        for i in 0..order {
            let scale = step_s * INVERSE[i + 1];
            let mut force = V2::zeros();
            if M::LAGS || i == 0 {
                force += segment.force.0[i];
            }
            if i == 0 {
                force += inputs.external_n;
            }
            if unbalanced {
                force += segment.unbalance.0[i];
            }
            position[i + 1] = scale * velocity[i];
            // Factors first: only two operations wait for the coefficient before.
            velocity[i + 1] =
                (scale * inverse_m) * force - (scale * k) * position[i] - (scale * d) * velocity[i];
        }
        if let Some(ellipse) = self.plane.bore.ellipse() {
            for (gap, x) in (segment.gap.0.iter_mut().zip(&segment.position.0)).take(order + 1) {
                *gap = ellipse.to_circle(*x, self.plane.contact.clearance_m);
            }
        }
        if let Some(ring) = S::inner_series(&segment.stator) {
            for (i, gap) in segment.gap.0[..=order].iter_mut().enumerate() {
                *gap = segment.position.0[i] - ring.0[i];
            }
        }
    }

    /// m·ε·(Ω̇·(sin σ, −cos σ) + Ω²·(cos σ, sin σ)) with Ω linear in time.
    fn unbalance_series(&self, segment: &mut Segment<S>, (t_s, y): (f64, &StateOf<S, W, M, R>)) {
        let (step_s, order) = (segment.step_s, segment.order);
        let spin = self.spin.spin_rad_s(&y.spin);
        let acceleration = self.spin.drive_torque_n_m() * self.spin.inverse_inertia();
        let gain = acceleration * step_s;
        let (sin, cos) = self.spin.phase_rad(&y.spin, t_s).sin_cos();
        // Direction (cos σ, sin σ); its quarter turn clockwise is (sin σ, −cos σ).
        let direction = &mut segment.direction.0;
        direction[0] = V2::new(cos, sin);
        for i in 0..order {
            let mut rate = spin * direction[i];
            if i > 0 {
                rate += gain * direction[i - 1];
            }
            direction[i + 1] = step_s * INVERSE[i + 1] * perp(rate);
        }
        let square = [spin * spin, 2.0 * spin * gain, gain * gain];
        let terms = if gain == 0.0 { 1 } else { 3 };
        for i in 0..=order {
            let mut a = -acceleration * perp(direction[i]);
            for (j, s) in square[..terms].iter().enumerate().take(i + 1) {
                a += *s * direction[i - j];
            }
            segment.unbalance.0[i] = self.rotor.mass_kg * self.rotor.eccentricity_m * a;
        }
    }

    /// State at θ of a segment that started at `y`.
    pub(crate) fn flown(
        &self,
        segment: &Segment<S>,
        y: &StateOf<S, W, M, R>,
        theta: f64,
    ) -> StateOf<S, W, M, R> {
        State {
            rotor: Body {
                position: segment.position.at(theta, segment.order),
                velocity: segment.velocity.at(theta, segment.order),
            },
            stator: S::at(&segment.stator, theta, segment.order),
            spin: self.spin.coast(&y.spin, theta * segment.step_s),
            race: self.plane.race.coast(&y.race, theta * segment.step_s),
            force: M::at(&segment.force, theta, segment.order),
        }
    }

    /// Energy through each door from 0 to θ, from `y` to `end`.
    pub(crate) fn flight_flows(
        &self,
        segment: &Segment<S>,
        y: &StateOf<S, W, M, R>,
        end: &StateOf<S, W, M, R>,
        inputs: &Inputs,
        theta: f64,
    ) -> Flows {
        let path = end.rotor.position - y.rotor.position;
        let drive = self.drive_work(&y.spin, &end.spin);
        let mut flows = Flows {
            external: inputs.external_n.dot(&path),
            drive,
            ..Flows::default()
        };
        if !M::LAGS {
            flows.control = inputs.command_n.dot(&path);
        }
        if segment.phase * theta <= 0.55 {
            self.add_flows_along(&mut flows, segment, &Nodes::stretched(&SIX, theta));
        } else {
            self.add_flows_along(&mut flows, segment, &Nodes::stretched(&EIGHT, theta));
        }
        if let Some(loss_j) = self.race_loss_j(&y.race, &end.race) {
            flows.stator_damping += loss_j;
        }
        flows
    }

    /// Work of the drive from spin to spin \[J\]: in flight nothing else turns the rotor.
    pub(crate) fn drive_work(&self, start: &W::State, end: &W::State) -> f64 {
        let inverse_j = self.spin.inverse_inertia();
        if inverse_j > 0.0 && self.spin.drive_torque_n_m() != 0.0 {
            let (a, b) = (self.spin.spin_rad_s(start), self.spin.spin_rad_s(end));
            0.5 * (b * b - a * a) / inverse_j
        } else {
            0.0
        }
    }

    /// Energy that the drag of a race takes from spin to spin \[J\]: in flight nothing else brakes it.
    #[inline]
    pub(crate) fn race_loss_j(&self, start: &R::State, end: &R::State) -> Option<f64> {
        let race = self.plane.race.race()?;
        Some(race.coasting_loss_j(R::spin_rad_s(start), R::spin_rad_s(end)))
    }

    /// What has to be integrated along the path. Products of two series with phase p are integrated by
    /// n nodes with a relative error below (n!)⁴/((2n + 1)·(2n)!³)·(2p)^2n: 6e-16 for six nodes at
    /// p = 0.55 and 1e-18 for eight at p = 1.
    fn add_flows_along<const N: usize>(
        &self,
        flows: &mut Flows,
        segment: &Segment<S>,
        nodes: &Nodes<N>,
    ) {
        let (h, order) = (segment.step_s, segment.order);
        if self.stator.is_damped() {
            let w = (self.stator).damping_integral_w(&segment.stator, nodes, order);
            flows.stator_damping = h * w;
        }
        let damping = self.rotor.damping_n_s_m;
        let unbalanced = self.rotor.eccentricity_m != 0.0;
        if !(M::LAGS || unbalanced || damping != 0.0) {
            return;
        }
        let v = segment.velocity.at_all(&nodes.theta, order);
        let with = |series: &Series| {
            let force = series.at_all(&nodes.theta, order);
            h * nodes.integral(|j| force[j].dot(&v[j]))
        };
        if M::LAGS {
            flows.control = with(&segment.force);
        }
        if unbalanced {
            flows.unbalance = with(&segment.unbalance);
        }
        if damping != 0.0 {
            flows.rotor_damping = h * damping * nodes.integral(|j| v[j].norm_squared());
        }
    }
}

impl<S: Stator> Segment<S> {
    /// First θ in [0, 1] at which the rotor reaches the wall from inside.
    ///
    /// Conservative advancement on G = |u|² − c²: with M an upper bound of |G̈| over the step, no root
    /// lies before the root of G + Ġ·τ + M·τ²/2. Each move is therefore safe, and near a simple root
    /// the moves converge as fast as Newton's. A start on the wall moving inwards counts as inside.
    pub(crate) fn wall_crossing<B: Bore>(&self, clearance_m: f64, just_left: bool) -> Crossing {
        // Most steps end far from the wall; this bound needs no roots.
        let reach = reach_of(self.gap::<B>(), self.order);
        if reach.x + reach.y < clearance_m {
            return Crossing::Nowhere;
        }
        let bound = |derivative: usize| {
            let mut sum = 0.0;
            for (k, c) in self.gap::<B>().0[..=self.order]
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
            let u = self.gap::<B>().at(theta, self.order);
            let rate = self.gap_rate::<B>(theta);
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

    /// Bound of the distance from the ring over the step, by axis; not squeezed.
    pub(crate) fn reach<B: Bore>(&self) -> V2 {
        let track = if B::OUT_OF_ROUND {
            &self.position
        } else {
            self.gap::<B>()
        };
        reach_of(track, self.order)
    }

    /// Velocity and delivered force at the nodes.
    pub(crate) fn values<const N: usize>(&self, nodes: &Nodes<N>) -> Values<N> {
        Values {
            velocity: self.velocity.at_all(&nodes.theta, self.order),
            force: self.force.at_all(&nodes.theta, self.order),
        }
    }

    fn gap_rate<B: Bore>(&self, theta: f64) -> V2 {
        let mut sum = V2::zeros();
        for k in (1..=self.order).rev() {
            sum = sum * theta + k as f64 * self.gap::<B>().0[k];
        }
        sum
    }
}

/// Bound of a series over the step, by axis.
#[inline]
fn reach_of(series: &Series, order: usize) -> V2 {
    let mut reach = V2::zeros();
    for c in &series.0[..=order] {
        reach += c.abs();
    }
    reach
}
