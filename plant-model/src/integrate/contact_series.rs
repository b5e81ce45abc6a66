//! Contact as a power series: inside one mode the equations are analytic, so the solution's Taylor
//! coefficients follow one from another by sums and products of series, to any order, and the guards
//! of the mode come out as polynomials on which no first root can be missed.
//!
//! All series run over θ = time / reference step; entry k holds the k-th coefficient times step^k.

use super::contact_step::Task;
use crate::V2;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::params::{LinearContact, SlidingFriction};
use crate::part::Body;
use crate::plane::{Bore, Raceway};
use crate::series::{INVERSE, Scalar, Series};
use crate::spin::Spin;
use crate::stator::{Rings, Stator};
use crate::system::{StateOf, System};
use crate::vector::perp;

/// Series of everything in contact over one step. Reused from step to step.
#[derive(Debug, Clone)]
pub(crate) struct ContactSeries<S: Stator> {
    pub(crate) step_s: f64,
    pub(crate) order: usize,
    pub(super) position: Series,
    pub(super) velocity: Series,
    pub(super) stator: S::Series,
    /// Delivered magnet force \[N\].
    pub(super) magnet: Series,
    /// Ω \[rad/s\].
    pub(super) spin: Scalar,
    /// Ω_i \[rad/s\] and R·Ω − R_i·Ω_i \[m/s\]; unused without a race.
    pub(super) race: Scalar,
    pub(super) surface: Scalar,
    /// Ω̇ \[rad/s²\] and Ω times the direction, where an unbalance asks for them.
    pub(super) spin_rate: Scalar,
    pub(super) turning: Series,
    /// Direction of the unbalance, and its force per mass \[m/s²\]; zero without one.
    pub(super) direction: Series,
    pub(super) unbalance: Series,
    /// Rotor against ring, and its velocity.
    pub(super) gap: Series,
    pub(super) gap_rate: Series,
    /// ρ, its rate, r̂.
    pub(super) distance: Scalar,
    pub(super) normal_speed: Scalar,
    pub(super) normal: Series,
    /// f_n and f_n·r̂.
    pub(super) force: Scalar,
    pub(super) push: Series,
    /// v_w, sliding and rolling part of the tangential force.
    pub(super) whirl_speed: Scalar,
    pub(super) sliding: Scalar,
    pub(super) rolling: Scalar,
    /// Their sum, where it is no multiple of f_n; and the force as a vector.
    pub(super) grip: Scalar,
    pub(super) tangential: Series,
    /// Friction that falls with speed: exponent and exponential.
    pub(super) exponent: Scalar,
    pub(super) exponential: Scalar,
    /// Constrained modes: v_w/ρ, free relative acceleration, and e_t/J.
    pub(super) whirl_rate: Scalar,
    pub(super) difference: Series,
    pub(super) eccentric: Scalar,
    /// The law that it is for: no other has a power series at the touch.
    pub(super) law: LinearContact,
}

impl<S: Stator> ContactSeries<S> {
    pub(crate) fn new(law: LinearContact) -> Self
    where
        S::Series: Default,
    {
        Self {
            step_s: 0.0,
            order: 0,
            position: Series::default(),
            velocity: Series::default(),
            stator: S::Series::default(),
            magnet: Series::default(),
            spin: Scalar::default(),
            race: Scalar::default(),
            surface: Scalar::default(),
            spin_rate: Scalar::default(),
            turning: Series::default(),
            direction: Series::default(),
            unbalance: Series::default(),
            gap: Series::default(),
            gap_rate: Series::default(),
            distance: Scalar::default(),
            normal_speed: Scalar::default(),
            normal: Series::default(),
            force: Scalar::default(),
            push: Series::default(),
            whirl_speed: Scalar::default(),
            sliding: Scalar::default(),
            rolling: Scalar::default(),
            grip: Scalar::default(),
            tangential: Series::default(),
            exponent: Scalar::default(),
            exponential: Scalar::default(),
            whirl_rate: Scalar::default(),
            difference: Series::default(),
            eccentric: Scalar::default(),
            law,
        }
    }
}

/// One step's context: what does not change from order to order.
struct Context<'a, S, W, M, B, R> {
    system: &'a System<S, W, M, B, R>,
    external_n: V2,
    slide: Slide,
    whirl: Whirl,
    step_s: f64,
    /// 1/step, 1/ρ at the start, 1/m.
    per_step: f64,
    inverse_distance: f64,
    inverse_m: f64,
    mobility: f64,
    inverse_j: f64,
    torque: f64,
    unbalanced: bool,
    /// Sliding and rolling part per normal force, where both are in proportion to it.
    proportions: Option<(f64, f64)>,
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    /// Fills `out` with the solution from `y` in the task's mode, up to the order at which there is `enough`,
    /// or to `highest`.
    pub(crate) fn contact_series(
        &self,
        out: &mut ContactSeries<S>,
        (t_s, y): (f64, &StateOf<S, W, M, R>),
        task: &Task<'_>,
        (step_s, highest): (f64, usize),
        mut enough: impl FnMut(&ContactSeries<S>, usize) -> bool,
    ) {
        let ring = y.stator.inner();
        out.gap.0[0] = y.rotor.position - ring.position;
        out.gap_rate.0[0] = y.rotor.velocity - ring.velocity;
        out.distance.0[0] = out.gap.0[0].norm();
        let context = Context {
            system: self,
            external_n: task.inputs.external_n,
            slide: task.mode.0,
            whirl: task.mode.1,
            step_s,
            per_step: 1.0 / step_s,
            inverse_distance: 1.0 / out.distance.0[0],
            inverse_m: 1.0 / self.rotor.mass_kg,
            mobility: 1.0 / self.rotor.mass_kg + self.stator.inverse_mass(),
            inverse_j: self.spin.inverse_inertia(),
            torque: self.spin.drive_torque_n_m(),
            unbalanced: self.rotor.eccentricity_m != 0.0,
            proportions: self.proportions(task.mode),
        };
        out.step_s = step_s;
        out.position.0[0] = y.rotor.position;
        out.velocity.0[0] = y.rotor.velocity;
        S::start_series(&mut out.stator, &y.stator);
        let magnet = (&y.force, task.inputs.command_n);
        (self.amplifier).series(&mut out.magnet, magnet, step_s, highest);
        out.spin.0[0] = self.spin.spin_rad_s(&y.spin);
        out.race.0[0] = R::spin_rad_s(&y.race);
        if context.unbalanced {
            let (sin, cos) = self.spin.phase_rad(&y.spin, t_s).sin_cos();
            out.direction.0[0] = V2::new(cos, sin);
        }
        let mut k = 0;
        loop {
            context.positions(out, k);
            context.forces(out, k);
            if k == highest || enough(out, k) {
                break;
            }
            context.velocities(out, k);
            k += 1;
        }
        out.order = k;
    }

    /// Tangential forces per normal force in a mode, if they are constant.
    fn proportions(&self, (slide, whirl): (Slide, Whirl)) -> Option<(f64, f64)> {
        let SlidingFriction::Constant { coefficient } = self.plane.friction.sliding else {
            return None;
        };
        (slide != Slide::Rolling && whirl != Whirl::Still).then(|| {
            let rolling = self.plane.friction.rolling_coefficient;
            (-slide.sign() * coefficient, -whirl.sign() * rolling)
        })
    }
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> Context<'_, S, W, M, B, R> {
    /// Coefficients k + 1 of the positions, which run one order ahead so that ρ̇ is the derivative of ρ.
    fn positions(&self, out: &mut ContactSeries<S>, k: usize) {
        let next = self.step_s * INVERSE[k + 1];
        out.position.0[k + 1] = next * out.velocity.0[k];
        self.system.stator.extend_position(&mut out.stator, k, next);
        out.gap.0[k + 1] = next * out.gap_rate.0[k];
        // ρ² = u·u: ρ_0·ρ_n = u_0·u_n + ½·Σ (u_i·u_(n−i) − ρ_i·ρ_(n−i)), 0 < i < n, by halves.
        let n = k + 1;
        let (half, odd) = (n / 2, n % 2 == 1);
        let (gap, distance) = (&out.gap.0, &out.distance.0);
        let mut products = V2::zeros();
        let mut squares = 0.0;
        let ends = gap[1..n].iter().zip(gap[1..n].iter().rev());
        let lengths = distance[1..n].iter().zip(distance[1..n].iter().rev());
        let pairs = if odd { half } else { half - 1 };
        for ((a, b), (p, q)) in ends.zip(lengths).take(pairs) {
            products += a.component_mul(b);
            squares += p * q;
        }
        let mut sum = products.x + products.y - squares;
        if !odd {
            sum += 0.5 * (gap[half].norm_squared() - distance[half] * distance[half]);
        }
        out.distance.0[n] = (gap[0].dot(&gap[n]) + sum) * self.inverse_distance;
        out.normal_speed.0[k] = out.distance.0[k + 1] * ((k + 1) as f64 * self.per_step);
    }

    /// Coefficients k + 1 of the velocities from coefficients k of the forces.
    fn velocities(&self, out: &mut ContactSeries<S>, k: usize) {
        let next = self.step_s * INVERSE[k + 1];
        let mut acceleration = (self.free_force(out, k) + out.tangential.0[k]) * self.inverse_m;
        if self.unbalanced {
            acceleration += out.unbalance.0[k];
        }
        out.velocity.0[k + 1] = next * acceleration;
        let on_ring = out.push.0[k] - out.tangential.0[k];
        (self.system.stator).extend_velocity(&mut out.stator, k, next, on_ring);
        let (_, ring_rate) = S::inner_coefficient(&out.stator, k + 1);
        out.gap_rate.0[k + 1] = out.velocity.0[k + 1] - ring_rate;
    }

    /// Everything that acts on the rotor but friction and unbalance.
    fn free_force(&self, out: &ContactSeries<S>, k: usize) -> V2 {
        let rotor = Body {
            position: out.position.0[k],
            velocity: out.velocity.0[k],
        };
        let force = (self.system.rotor).with_shaft_n(out.magnet.0[k], &rotor) - out.push.0[k];
        if k == 0 {
            force + self.external_n
        } else {
            force
        }
    }

    /// Coefficients k of normal force and friction, and k + 1 of the spins.
    fn forces(&self, out: &mut ContactSeries<S>, k: usize) {
        let contact = &self.system.plane.contact;
        let penetration = if k == 0 {
            out.distance.0[0] - contact.clearance_m
        } else {
            out.distance.0[k]
        };
        out.force.0[k] = out.law.normal_force_n(penetration, out.normal_speed.0[k]);
        // r̂·ρ = u, f_n·r̂ and v_w = ẇ·t̂ = r̂ × ẇ: their sums run over the same coefficients of r̂.
        let (mut mixed, mut push, mut cross) = (V2::zeros(), V2::zeros(), V2::zeros());
        let below = &out.normal.0[..k];
        let lengths = &out.distance.0[1..=k];
        let forces = &out.force.0[1..=k];
        let rates = &out.gap_rate.0[1..=k];
        for (i, n) in below.iter().enumerate() {
            let j = k - 1 - i;
            mixed += lengths[j] * n;
            push += forces[j] * n;
            cross += V2::new(n.x * rates[j].y, n.y * rates[j].x);
        }
        let normal = (out.gap.0[k] - mixed) * self.inverse_distance;
        out.normal.0[k] = normal;
        out.push.0[k] = push + out.force.0[0] * normal;
        out.whirl_speed.0[k] = cross.x - cross.y + normal.perp(&out.gap_rate.0[0]);
        if self.unbalanced {
            self.turn_unbalance(out, k);
        }
        if let Some(race) = self.system.plane.race.race() {
            let own = self.system.plane.radius_m * out.spin.0[k];
            out.surface.0[k] = own - race.radius_m * out.race.0[k];
        }

        if let Some((s, q)) = self.proportions {
            out.sliding.0[k] = s * out.force.0[k];
            out.rolling.0[k] = q * out.force.0[k];
            out.tangential.0[k] = (s + q) * perp(out.push.0[k]);
        } else {
            self.friction(out, k);
            out.grip.0[k] = out.sliding.0[k] + out.rolling.0[k];
            out.tangential.0[k] = perp(out.normal.times_coefficient(&out.grip, k));
        }
        self.spin_up(out, k);
    }

    /// Sliding and rolling part where they are not in proportion to the normal force.
    fn friction(&self, out: &mut ContactSeries<S>, k: usize) {
        let friction = &self.system.plane.friction;
        let radius = self.system.plane.radius_m;
        let first = |x: f64| if k == 0 { x } else { 0.0 };
        let constrained = self.slide == Slide::Rolling || self.whirl == Whirl::Still;
        // What turns the contact point without friction, and what the torque does to it.
        let base = if constrained {
            self.free_whirl_acceleration(out, k)
        } else {
            0.0
        };
        let eccentric = if constrained && self.unbalanced && self.inverse_j > 0.0 {
            // Tangential acceleration per unit of spin acceleration, over J.
            out.eccentric.0[k] = -self.system.rotor.eccentricity_m
                * self.inverse_j
                * out.direction.dot_coefficient(&out.normal, k);
            true
        } else {
            out.eccentric.0[k] = 0.0;
            false
        };
        if self.slide != Slide::Rolling {
            self.slip(out, k);
        }
        if self.whirl != Whirl::Still {
            out.rolling.0[k] = -self.whirl.sign() * friction.rolling_coefficient * out.force.0[k];
        }
        let m = self.mobility;
        match (self.slide, self.whirl) {
            (Slide::Rolling, Whirl::Still) => {
                if let Some(race) = self.system.plane.race.race() {
                    let parting = first(radius * self.inverse_j * self.torque)
                        + race.falling_back_m_s2(out.race.0[k]);
                    let s = -parting / (radius * radius * self.inverse_j + race.mobility());
                    out.sliding.0[k] = s;
                    let mut pushed = base + out.eccentric.0[k] * self.torque;
                    if eccentric {
                        pushed += radius * out.eccentric.product_coefficient(&out.sliding, k);
                    }
                    out.rolling.0[k] = -pushed / m - s;
                } else if self.inverse_j > 0.0 {
                    out.sliding.0[k] = first(-self.torque / radius);
                    out.rolling.0[k] = -base / m - out.sliding.0[k];
                } else {
                    let mu = friction.sliding.coefficient(0.0);
                    let share = mu / (mu + friction.rolling_coefficient).max(f64::MIN_POSITIVE);
                    out.sliding.0[k] = -base / m * share;
                    out.rolling.0[k] = -base / m * (1.0 - share);
                }
            }
            (Slide::Rolling, _) => {
                // (M + R·B)·s = −(base + B·t_d + M·q), B = (e_t + R)/J.
                let by_torque = out.eccentric.0[k] + first(radius * self.inverse_j);
                let mut right = -(base + by_torque * self.torque + m * out.rolling.0[k]);
                if eccentric {
                    right -= radius * out.eccentric.product_coefficient_below(&out.sliding, k);
                }
                let mut pivot = m + radius * (out.eccentric.0[0] + radius * self.inverse_j);
                if let Some(race) = self.system.plane.race.race() {
                    right -= race.falling_back_m_s2(out.race.0[k]);
                    pivot += race.mobility();
                }
                out.sliding.0[k] = right / pivot;
            }
            (_, Whirl::Still) => {
                let s = out.sliding.0[k];
                let mut right = base + m * s + out.eccentric.0[k] * self.torque;
                if eccentric {
                    right += radius * out.eccentric.product_coefficient(&out.sliding, k);
                }
                out.rolling.0[k] = -right / m;
            }
            _ => {}
        }
    }

    /// −σ·μ(v_rel)·f_n.
    fn slip(&self, out: &mut ContactSeries<S>, k: usize) {
        let sign = self.slide.sign();
        let (at_speed, fall, speed_scale) = match self.system.plane.friction.sliding {
            SlidingFriction::Constant { coefficient } => {
                out.sliding.0[k] = -sign * coefficient * out.force.0[k];
                return;
            }
            SlidingFriction::Falling {
                at_rest,
                at_speed,
                speed_scale_m_s,
            } => (at_speed, at_rest - at_speed, speed_scale_m_s),
        };
        // e = exp(a) with a = −σ·v_rel/v_0: e_k = Σ i·a_i·e_{k−i}/k.
        let surface = match self.system.plane.race.race() {
            Some(_) => out.surface.0[k],
            None => self.system.plane.radius_m * out.spin.0[k],
        };
        let v_rel = out.whirl_speed.0[k] + surface;
        out.exponent.0[k] = -sign * v_rel / speed_scale;
        out.exponential.0[k] = if k == 0 {
            out.exponent.0[0].exp()
        } else {
            let terms = (1..=k).map(|i| i as f64 * out.exponent.0[i] * out.exponential.0[k - i]);
            terms.sum::<f64>() / k as f64
        };
        let falling = fall * out.exponential.product_coefficient(&out.force, k);
        out.sliding.0[k] = -sign * (at_speed * out.force.0[k] + falling);
    }

    /// (a_rotor − a_ring)·t̂ − v_n·v_w/ρ without tangential force and without spin acceleration.
    fn free_whirl_acceleration(&self, out: &mut ContactSeries<S>, k: usize) -> f64 {
        let ring = (self.system.stator).inner_acceleration(&out.stator, k, out.push.0[k]);
        let mut difference = self.free_force(out, k) * self.inverse_m - ring;
        if self.unbalanced {
            difference += out.unbalance.0[k];
        }
        out.difference.0[k] = difference;
        let mixed = out.distance.product_coefficient_below(&out.whirl_rate, k);
        out.whirl_rate.0[k] = (out.whirl_speed.0[k] - mixed) * self.inverse_distance;
        out.normal.cross_coefficient(&out.difference, k)
            - out.normal_speed.product_coefficient(&out.whirl_rate, k)
    }

    /// Unbalance per mass at order k, by the square of the speed; direction at k + 1.
    fn turn_unbalance(&self, out: &mut ContactSeries<S>, k: usize) {
        let e = self.system.rotor.eccentricity_m;
        let next = self.step_s * INVERSE[k + 1];
        if self.inverse_j == 0.0 {
            let spin = out.spin.0[0];
            out.direction.0[k + 1] = next * spin * perp(out.direction.0[k]);
            out.unbalance.0[k] = e * spin * spin * out.direction.0[k];
            return;
        }
        // Ω·d, and Ω²·d = Ω·(Ω·d).
        out.turning.0[k] = out.direction.times_coefficient(&out.spin, k);
        out.direction.0[k + 1] = next * perp(out.turning.0[k]);
        out.unbalance.0[k] = e * out.turning.times_coefficient(&out.spin, k);
    }

    /// Spins at k + 1, and the unbalance's share by spin acceleration at k.
    fn spin_up(&self, out: &mut ContactSeries<S>, k: usize) {
        if let Some(race) = self.system.plane.race.race() {
            let acceleration = race.acceleration(out.race.0[k], out.sliding.0[k]);
            out.race.0[k + 1] = self.step_s * INVERSE[k + 1] * acceleration;
        }
        if self.inverse_j == 0.0 {
            return;
        }
        let torque = if k == 0 { self.torque } else { 0.0 };
        let next = self.step_s * INVERSE[k + 1];
        let radius = self.system.plane.radius_m;
        let acceleration = self.inverse_j * (torque + radius * out.sliding.0[k]);
        out.spin.0[k + 1] = next * acceleration;
        if self.unbalanced {
            out.spin_rate.0[k] = acceleration;
            let by_rate = perp(out.direction.times_coefficient(&out.spin_rate, k));
            out.unbalance.0[k] -= self.system.rotor.eccentricity_m * by_rate;
        }
    }
}
