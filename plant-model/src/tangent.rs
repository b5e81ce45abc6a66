//! The derivative of the contact field along a direction: the analytic Jacobian, column by column.

use crate::V2;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::part::Body;
use crate::plane::{Bore, Raceway};
use crate::spin::Spin;
use crate::stator::{Rings, Stator};
use crate::system::{Inputs, State, StateOf, System};
use crate::vector::perp;

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    /// d/dε of the field at y + ε·change.
    ///
    /// Names follow [`System::contact`]; a leading d is the derivative.
    pub(crate) fn contact_tangent(
        &self,
        (t_s, y): (f64, &StateOf<S, W, M, R>),
        inputs: &Inputs,
        (slide, whirl): (Slide, Whirl),
        change: &StateOf<S, W, M, R>,
    ) -> StateOf<S, W, M, R> {
        let g = self.geometry(y);
        let (n, t, distance) = (g.normal, g.tangent, g.distance_m);
        let now = self.contact(t_s, y, inputs, (slide, whirl));
        let radius = self.plane.radius_m;
        let inverse_m = 1.0 / self.rotor.mass_kg;
        let (normal_n, sliding_n) = (now.touch.normal_n, now.touch.sliding_n);
        let tangential_n = sliding_n + now.touch.rolling_n;

        let d_ring = change.stator.inner();
        let d_gap = change.rotor.position - d_ring.position;
        let d_gap_rate = change.rotor.velocity - d_ring.velocity;
        let ring = y.stator.inner();
        let gap_rate = y.rotor.velocity - ring.velocity;
        let d_distance = n.dot(&d_gap);
        let d_n = (d_gap - n * d_distance) / distance;
        let d_t = perp(d_n);
        let d_normal_speed = d_gap_rate.dot(&n) + gap_rate.dot(&d_n);
        let d_whirl_speed = d_gap_rate.dot(&t) + gap_rate.dot(&d_t);
        let (d_spin, d_phase) = W::change(&change.spin);
        let mut d_sliding_speed = d_whirl_speed + radius * d_spin;
        // By how much the surfaces part through a race's drag, and how easily it gives way.
        let (mut d_falling_back, mut race_mobility) = (0.0, 0.0);
        if let Some(race) = self.plane.race.race() {
            let d_race = R::spin_rad_s(&change.race);
            d_sliding_speed -= race.radius_m * d_race;
            d_falling_back = race.falling_back_m_s2(d_race);
            race_mobility = race.mobility();
        }
        let law = (self.plane.contact.law).at(g.penetration_m, g.normal_speed_m_s);
        let d_normal = law.by_depth_n_m * d_distance + law.by_rate_n_s_m * d_normal_speed;
        let d_push = d_normal * n + normal_n * d_n;

        // Accelerations without friction.
        let magnet_n = self.amplifier.force_n(&y.force, inputs.command_n);
        let d_magnet = if M::LAGS {
            self.amplifier.force_n(&change.force, V2::zeros())
        } else {
            V2::zeros()
        };
        let free_n = (self.rotor).with_shaft_n(magnet_n + inputs.external_n, &y.rotor);
        let d_free = self.rotor.with_shaft_n(d_magnet, &change.rotor);
        let mut acceleration = (free_n - normal_n * n) * inverse_m;
        let mut d_acceleration = (d_free - d_push) * inverse_m;
        let (mut by_spin_up, mut d_by_spin_up) = (V2::zeros(), V2::zeros());
        if let Some((by_speed, by_acceleration)) = self.unbalance(t_s, y) {
            let spin = self.spin.spin_rad_s(&y.spin);
            acceleration += by_speed;
            d_acceleration += d_phase * perp(by_speed);
            if spin != 0.0 {
                d_acceleration += 2.0 * d_spin / spin * by_speed;
            }
            by_spin_up = by_acceleration;
            d_by_spin_up = d_phase * perp(by_acceleration);
        }
        let ring_acceleration = self.stator.rates(&y.stator, normal_n * n).inner().velocity;
        let d_ring_acceleration = self.stator.rates(&change.stator, d_push).inner().velocity;
        let (relative, d_relative) = (
            acceleration - ring_acceleration,
            d_acceleration - d_ring_acceleration,
        );
        let d_radius = match self.plane.bore.ellipse() {
            None => d_distance,
            // The normal turns by t·du/ρ, and the radius of curvature with it.
            Some(ellipse) => {
                let closest = ellipse.closest_point(y.rotor.position - ring.position);
                d_distance + closest.radius_change_m * d_n.dot(&t)
            }
        };
        let turning = g.normal_speed_m_s * g.whirl_speed_m_s / distance;
        let d_turning = (d_normal_speed * g.whirl_speed_m_s + g.normal_speed_m_s * d_whirl_speed
            - turning * d_radius)
            / distance;
        let d_base = d_relative.dot(&t) + relative.dot(&d_t) - d_turning;

        // Friction.
        let mobility = inverse_m + self.stator.inverse_mass();
        let inverse_j = self.spin.inverse_inertia();
        let torque = self.spin.drive_torque_n_m();
        let eccentric = by_spin_up.dot(&t) * inverse_j;
        let d_eccentric = (d_by_spin_up.dot(&t) + by_spin_up.dot(&d_t)) * inverse_j;
        let sign = slide.sign();
        let along = sign * g.sliding_speed_m_s;
        let mu = self.plane.friction.sliding.coefficient(along);
        let d_mu = self.plane.friction.sliding.slope(along) * sign * d_sliding_speed;
        let d_slip = -sign * (mu * d_normal + d_mu * normal_n);
        let mu_r = self.plane.friction.rolling_coefficient;
        let d_rolling = -whirl.sign() * mu_r * d_normal;
        let (d_sliding, d_rolling) = match (slide, whirl) {
            (Slide::Rolling, Whirl::Still) if race_mobility > 0.0 => {
                let d_s = -d_falling_back / (radius * radius * inverse_j + race_mobility);
                let d_pushed =
                    d_base + d_eccentric * (torque + radius * sliding_n) + eccentric * radius * d_s;
                (d_s, -d_pushed / mobility - d_s)
            }
            (Slide::Rolling, Whirl::Still) if inverse_j > 0.0 => (0.0, -d_base / mobility),
            (Slide::Rolling, Whirl::Still) => {
                let share = if mu + mu_r > 0.0 {
                    mu / (mu + mu_r)
                } else {
                    0.0
                };
                (
                    -d_base / mobility * share,
                    -d_base / mobility * (1.0 - share),
                )
            }
            (Slide::Rolling, _) => {
                let pivot = mobility + (eccentric + radius * inverse_j) * radius + race_mobility;
                let d_pivot = d_eccentric * radius;
                let d_right = d_base + d_eccentric * torque + mobility * d_rolling + d_falling_back;
                (-(d_right + sliding_n * d_pivot) / pivot, d_rolling)
            }
            (_, Whirl::Still) => {
                let d_pushed = d_base
                    + d_eccentric * (torque + radius * sliding_n)
                    + (eccentric * radius + mobility) * d_slip;
                (d_slip, -d_pushed / mobility)
            }
            _ => (d_slip, d_rolling),
        };
        let d_tangential = d_sliding + d_rolling;
        let d_friction = d_tangential * t + tangential_n * d_t;
        let spin_up = inverse_j * (torque + radius * sliding_n);
        let d_spin_up = inverse_j * radius * d_sliding;
        State {
            rotor: Body {
                position: change.rotor.velocity,
                velocity: d_acceleration
                    + d_friction * inverse_m
                    + d_spin_up * by_spin_up
                    + spin_up * d_by_spin_up,
            },
            stator: self.stator.rates(&change.stator, d_push - d_friction),
            spin: self.spin.rates(&change.spin, d_spin_up),
            race: self.plane.race.rates(&change.race, d_sliding),
            force: self.amplifier.rates(&change.force, V2::zeros()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ellipse::Ellipse;
    use crate::magnet::Lagged;
    use crate::params::*;
    use crate::part::Part;
    use crate::plane::Plane;
    use crate::plane::race::Race;
    use crate::spin::Phased;
    use crate::stator::{Rigid, TwoMass};

    const FREE: Phased = Phased {
        inverse_inertia: 20.0,
        drive_torque_n_m: 3.0,
    };
    const HELD: Phased = Phased {
        inverse_inertia: 0.0,
        drive_torque_n_m: 0.0,
    };
    const RACE: Race = Race {
        radius_m: 0.0502,
        inertia_kg_m2: 2e-3,
        drag_n_m_s: 0.04,
        start_spin_rad_s: 0.0,
    };

    #[test]
    fn columns_are_the_fields_differences() {
        let linear = LinearContact {
            stiffness_n_m: 1e8,
            damping_n_s_m: 5e3,
        };
        let hardening = HuntCrossley {
            stiffness_n_mn: 1e10,
            exponent: 1.5,
            damping_s_m: 0.7,
        };
        for law in [ContactLaw::from(linear), hardening.into()] {
            check(rings(), FREE, ((), ()), law);
            check(rings(), FREE, ((), RACE), law);
            check(rings(), HELD, ((), RACE), law);
            let ellipse = EllipseParams {
                ellipticity: 0.1,
                long_axis_rad: 0.3,
            };
            let ellipse = Ellipse::new(&ellipse, 2e-4);
            check(Rigid, FREE, (ellipse, ()), law);
        }
    }

    fn rings() -> TwoMass {
        let ring = |k: f64| RingParams {
            mass_kg: 7.0,
            stiffness_n_m: V2::new(k, 1.2 * k),
            damping_n_s_m: V2::new(2e4, 1e4),
        };
        TwoMass {
            inner: ring(8e8),
            outer: ring(3e9),
        }
    }

    /// Every column in every mode against central differences of the field.
    fn check<S: Stator, B: Bore, R: Raceway>(
        stator: S,
        spin: Phased,
        (bore, race): (B, R),
        law: ContactLaw,
    ) {
        let system = System {
            rotor: RotorParams {
                mass_kg: 10.0,
                stiffness_n_m: 4e5,
                damping_n_s_m: 200.0,
                eccentricity_m: 2e-5,
                contact_radius_m: 0.05,
            },
            plane: Plane {
                radius_m: 0.05,
                contact: ContactParams {
                    clearance_m: 2e-4,
                    law,
                },
                friction: FrictionParams {
                    sliding: SlidingFriction::Falling {
                        at_rest: 0.3,
                        at_speed: 0.1,
                        speed_scale_m_s: 2.0,
                    },
                    rolling_coefficient: 0.02,
                },
                bore,
                race,
            },
            stator,
            spin,
            amplifier: Lagged { lag_s: 1e-4 },
        };
        type Y<S, R> = StateOf<S, Phased, Lagged, R>;
        const LENGTH: usize = 17;
        const TWO_RINGS: usize = 8;
        let mut scales = vec![
            1e-4, 1e-4, 0.5, 0.5, 1e-5, 1e-5, 0.1, 0.1, 1e-5, 1e-5, 0.1, 0.1, 50.0, 1.0, 100.0,
            100.0,
        ];
        let mut shares = vec![
            1.9, 1.1, -0.4, 0.3, 0.2, -0.5, 0.7, -0.1, 0.3, 0.4, -0.2, 0.6, 0.9, 0.4, 0.5, -0.8,
        ];
        if system.plane.race.race().is_some() {
            scales.insert(14, 50.0);
            shares.insert(14, 0.3);
        }
        // A stator that does not move has no states.
        let rings = 4..4 + TWO_RINGS - S::State::STATES;
        scales.drain(rings.clone());
        shares.drain(rings);
        let states = Y::<S, R>::STATES;
        let point: Vec<f64> = shares.iter().zip(&scales).map(|(x, s)| x * s).collect();
        let inputs = Inputs {
            command_n: V2::new(30.0, -20.0),
            external_n: V2::new(5.0, 7.0),
        };
        let slides = [Slide::Positive, Slide::Negative, Slide::Rolling];
        for slide in slides {
            for whirl in [Whirl::Positive, Whirl::Negative, Whirl::Still] {
                for i in 0..states {
                    let mut direction = [0.0; LENGTH];
                    direction[i] = scales[i];
                    let moved = |h: f64| {
                        let mut at = point.clone();
                        at[i] += h * scales[i];
                        let mut out = [0.0; LENGTH];
                        let y = Y::<S, R>::read(&at);
                        let e = system.contact(0.0, &y, &inputs, (slide, whirl));
                        e.rates.write(&mut out[..states]);
                        out
                    };
                    let h = 1e-4;
                    let (up, down) = (moved(h), moved(-h));
                    let mut exact = [0.0; LENGTH];
                    system
                        .contact_tangent(
                            (0.0, &Y::<S, R>::read(&point)),
                            &inputs,
                            (slide, whirl),
                            &Y::<S, R>::read(&direction[..states]),
                        )
                        .write(&mut exact[..states]);
                    let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    for j in 0..states {
                        let difference = (up[j] - down[j]) / (2.0 * h);
                        assert!(
                            (difference - exact[j]).abs() < 1e-5 * size.max(1.0),
                            "{slide:?} {whirl:?} d{j}/d{i}: {difference:e} against {:e}",
                            exact[j]
                        );
                    }
                }
            }
        }
    }
}
