//! What a contact series gives: state, guards, energy, largest values.

use super::contact_series::ContactSeries;
use super::contact_step::{Task, turn_rad};
use crate::energy::Flows;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::part::{Body, Part, Weights};
use crate::plane::{Bore, Raceway};
use crate::quadrature::{EIGHT, Nodes, SIX};
use crate::readout::Peaks;
use crate::series::{Scalar, Series};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{NORMAL, SLIDE, SLIDE_LOW, State, StateOf, System, WHIRL, WHIRL_LOW};

impl<S: Stator> ContactSeries<S> {
    /// State at θ of a step that started at `y`.
    pub(crate) fn at<W: Spin, M: Amplifier, R: Raceway>(
        &self,
        spin: &W,
        y: &StateOf<S, W, M, R>,
        theta: f64,
    ) -> StateOf<S, W, M, R> {
        let order = self.order;
        let mut spun = y.spin;
        spin.set_spin_rad_s(&mut spun, self.spin.at(theta, order));
        spin.turn(&mut spun, self.step_s * self.spin.integral(theta, order));
        let mut race = y.race;
        if R::TURNS {
            R::set_spin_rad_s(&mut race, self.race.at(theta, order));
        }
        State {
            rotor: Body {
                position: self.position.at(theta, order),
                velocity: self.velocity.at(theta, order),
            },
            stator: S::at(&self.stator, theta, order),
            spin: spun,
            race,
            force: M::at(&self.magnet, theta, order),
        }
    }

    /// Weighed square of the coefficients k.
    #[inline]
    pub(crate) fn square<R: Raceway>(&self, k: usize, weights: &Weights) -> f64 {
        let rotor = Body {
            position: self.position.0[k],
            velocity: self.velocity.0[k],
        };
        let spin = self.spin.0[k] * weights.spin;
        let stator = S::coefficient(&self.stator, k).weighed_square(weights);
        let gap = self.gap.0[k].norm_squared() * weights.gap * weights.gap;
        let mut square = gap + rotor.weighed_square(weights) + stator + spin * spin;
        if R::TURNS {
            square += (self.race.0[k] * weights.spin).powi(2);
        }
        square
    }

    /// Fills `out` with a guard of the mode; false if the mode has no such guard.
    pub(crate) fn guard<W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &self,
        out: &mut Scalar,
        system: &System<S, W, M, B, R>,
        (slide, whirl): (Slide, Whirl),
        guard: usize,
    ) -> bool {
        let (slide_sign, whirl_sign) = (slide.sign(), whirl.sign());
        let mu = system.plane.friction.sliding.coefficient(0.0);
        let mu_r = system.plane.friction.rolling_coefficient;
        let by_spin = slide_sign * system.plane.radius_m;
        let (rolling, still) = (slide == Slide::Rolling, whirl == Whirl::Still);
        let (a, b) = match guard {
            NORMAL => ((1.0, &self.force), (0.0, &self.force)),
            SLIDE if rolling => ((mu, &self.force), (-1.0, &self.sliding)),
            SLIDE_LOW if rolling => ((mu, &self.force), (1.0, &self.sliding)),
            SLIDE if mu != 0.0 && system.plane.race.race().is_some() => {
                ((slide_sign, &self.whirl_speed), (slide_sign, &self.surface))
            }
            SLIDE if mu != 0.0 => ((slide_sign, &self.whirl_speed), (by_spin, &self.spin)),
            WHIRL if still => ((mu_r, &self.force), (-1.0, &self.rolling)),
            WHIRL_LOW if still => ((mu_r, &self.force), (1.0, &self.rolling)),
            WHIRL if whirl != Whirl::Ignored => {
                ((whirl_sign, &self.whirl_speed), (0.0, &self.spin))
            }
            _ => return false,
        };
        out.combine(a, b, self.order);
        true
    }

    /// Energy through each door from 0 to θ.
    pub(crate) fn flows<W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &self,
        system: &System<S, W, M, B, R>,
        ends: (&Body, &Body),
        task: &Task<'_>,
        theta: f64,
    ) -> Flows {
        // The coefficients of a product fall more slowly than those of its factors, but a rule is off
        // little for the first powers that it does not hold exactly.
        if self.order <= 12 {
            self.flows_by(system, ends, task, (theta, &Nodes::stretched(&SIX, theta)))
        } else {
            self.flows_by(
                system,
                ends,
                task,
                (theta, &Nodes::stretched(&EIGHT, theta)),
            )
        }
    }

    fn flows_by<W: Spin, M: Amplifier, B: Bore, R: Raceway, const N: usize>(
        &self,
        system: &System<S, W, M, B, R>,
        (start, end): (&Body, &Body),
        task: &Task<'_>,
        (theta, nodes): (f64, &Nodes<N>),
    ) -> Flows {
        let (h, order) = (self.step_s, self.order);
        let path = end.position - start.position;
        let radius = system.plane.radius_m;
        let free = system.spin.inverse_inertia() > 0.0;
        let torque = system.spin.drive_torque_n_m();
        let mut flows = Flows {
            control: task.inputs.command_n.dot(&path),
            external: task.inputs.external_n.dot(&path),
            normal_impulse_n_s: h * self.force.integral(theta, order),
            ..Flows::default()
        };
        if !free {
            flows.drive = -radius * h * self.spin.0[0] * self.sliding.integral(theta, order);
        } else if torque != 0.0 {
            flows.drive = torque * h * self.spin.integral(theta, order);
        }
        let damping = system.rotor.damping_n_s_m;
        let unbalanced = system.rotor.eccentricity_m > 0.0;
        if M::LAGS || unbalanced || damping > 0.0 {
            let v = self.velocity.at_all(&nodes.theta, order);
            let with = |force: &Series| {
                let force = force.at_all(&nodes.theta, order);
                h * nodes.integral(|j| force[j].dot(&v[j]))
            };
            if M::LAGS {
                flows.control = with(&self.magnet);
            }
            if unbalanced {
                flows.unbalance = system.rotor.mass_kg * with(&self.unbalance);
            }
            if damping > 0.0 {
                flows.rotor_damping = damping * h * nodes.integral(|j| v[j].norm_squared());
            }
        }
        if system.stator.is_damped() {
            let w = (system.stator).damping_integral_w(&self.stator, nodes, order);
            flows.stator_damping = h * w;
        }
        if let Some(race) = system.plane.race.race() {
            let spin = self.race.at_all(&nodes.theta, order);
            flows.stator_damping += h * nodes.integral(|j| race.drag_w(spin[j]));
        }
        if self.law.damping_n_s_m > 0.0 {
            let speed = self.normal_speed.at_all(&nodes.theta, order);
            let square = nodes.integral(|j| speed[j] * speed[j]);
            flows.contact_damping = self.law.damping_n_s_m * h * square;
        }
        let (slips, whirls) = (task.mode.0 != Slide::Rolling, task.mode.1 != Whirl::Still);
        let rolling = system.plane.friction.rolling_coefficient > 0.0 && whirls;
        if slips || rolling {
            let whirl = self.whirl_speed.at_all(&nodes.theta, order);
            if slips {
                let friction = self.sliding.at_all(&nodes.theta, order);
                let work = if system.plane.race.race().is_some() {
                    let surface = self.surface.at_all(&nodes.theta, order);
                    nodes.integral(|j| friction[j] * (whirl[j] + surface[j]))
                } else if free {
                    let spin = self.spin.at_all(&nodes.theta, order);
                    nodes.integral(|j| friction[j] * (whirl[j] + radius * spin[j]))
                } else {
                    let surface = radius * self.spin.0[0];
                    nodes.integral(|j| friction[j] * (whirl[j] + surface))
                };
                flows.sliding_friction = -h * work;
            }
            if rolling {
                let friction = self.rolling.at_all(&nodes.theta, order);
                flows.rolling_friction = -h * nodes.integral(|j| friction[j] * whirl[j]);
            }
        }
        flows
    }

    /// What holds at the end of the step, θ.
    pub(crate) fn end(&self, theta: f64) -> End {
        let order = self.order;
        End {
            theta,
            force: self.force.with_slope(theta, order),
            distance: self.distance.with_slope(theta, order),
            whirl_speed: self.whirl_speed.with_slope(theta, order),
        }
    }

    /// Largest values up to the end, v_w counted in the sense of backward whirl.
    pub(crate) fn peaks<W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &self,
        system: &System<S, W, M, B, R>,
        backward: f64,
        end: &End,
    ) -> Peaks {
        let (theta, order) = (end.theta, self.order);
        let up_to = |(series, sign): (&Scalar, f64), at_end: (f64, f64)| {
            let signed = |(value, slope): (f64, f64)| (sign * value, sign * slope);
            let of = |at: f64| signed(series.with_slope(at, order));
            highest(
                of,
                signed((series.0[0], series.0[1])),
                (theta, signed(at_end)),
            )
        };
        let (force_at, normal_n) = up_to((&self.force, 1.0), end.force);
        let (_, distance_m) = up_to((&self.distance, 1.0), end.distance);
        let (_, backward_m_s) = up_to((&self.whirl_speed, backward), end.whirl_speed);
        // A command or load that jumps may ask for more than friction holds: that is no force of the mode.
        let mu = system.plane.friction.sliding.coefficient(0.0);
        let within = |sliding: f64, force: f64| sliding.abs().min(mu * force.max(0.0));
        let at_start = within(self.sliding.0[0], self.force.0[0]);
        let at_end = within(self.sliding.at(theta, order), end.force.0);
        let at_top = if force_at == theta {
            at_end
        } else {
            within(self.sliding.at(force_at, order), normal_n)
        };
        Peaks {
            normal_n,
            penetration_m: distance_m - system.plane.contact.clearance_m,
            sliding_n: at_start.max(at_end).max(at_top),
            backward_m_s,
        }
    }

    /// Normal force at the end, and its rate.
    pub(crate) fn normal(&self, end: &End) -> (f64, f64) {
        let (force, slope) = end.force;
        (force, slope / self.step_s)
    }

    /// Angle by which the contact normal turns up to the end \[rad\].
    pub(crate) fn turn(&self, end: &End) -> f64 {
        let rate = end.whirl_speed.0 / end.distance.0;
        let start = self.whirl_speed.0[0] / self.distance.0[0];
        let normal = self.gap.at(end.theta, self.order);
        turn_rad(
            (self.gap.0[0], start),
            (normal, rate),
            end.theta * self.step_s,
        )
    }
}

/// End of a step: values, and slopes over θ, that several readouts need.
pub(crate) struct End {
    theta: f64,
    force: (f64, f64),
    distance: (f64, f64),
    whirl_speed: (f64, f64),
}

/// Highest value of what is told with its slope over [0, θ], and where. At loose tolerances a step may be a little longer than half
/// a vibration, its halves are not.
pub(crate) fn highest(
    of: impl Fn(f64) -> (f64, f64),
    start: (f64, f64),
    (theta, end): (f64, (f64, f64)),
) -> (f64, f64) {
    let point = |at: f64, (value, slope): (f64, f64)| (at, value, slope);
    let middle = point(0.5 * theta, of(0.5 * theta));
    let (a, b) = (
        top_between(&of, point(0.0, start), middle),
        top_between(&of, middle, point(theta, end)),
    );
    if a.1 > b.1 { a } else { b }
}

/// Highest value between two points (θ, value, slope), and where: what rises at the first and falls at
/// the second has one top in between.
fn top_between(
    of: impl Fn(f64) -> (f64, f64),
    (from, start, start_slope): (f64, f64, f64),
    (to, end, end_slope): (f64, f64, f64),
) -> (f64, f64) {
    if start_slope > 0.0 && end_slope < 0.0 {
        // Regula falsi on the slope, with the Illinois rule. The value is flat at the top.
        let (mut low, mut high) = ((from, start_slope), (to, end_slope));
        let mut top = (from, start.max(end));
        let mut rose = None;
        for _ in 0..6 {
            let at = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let (value, slope) = of(at);
            if value > top.1 {
                top = (at, value);
            }
            // No place between the two can be higher by more.
            if slope.abs() * (high.0 - low.0) <= 1e-12 * top.1.abs() {
                break;
            }
            let rises = slope > 0.0;
            let again = rose == Some(rises);
            if rises {
                low = (at, slope);
                high.1 *= if again { 0.5 } else { 1.0 };
            } else {
                high = (at, slope);
                low.1 *= if again { 0.5 } else { 1.0 };
            }
            rose = Some(rises);
        }
        top
    } else if start > end {
        (from, start)
    } else {
        (to, end)
    }
}
