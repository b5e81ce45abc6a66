//! What a contact series gives: state, guards, energy.

use super::contact_series::ContactSeries;
use crate::energy::Flows;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::part::{Body, Part, Weights};
use crate::series::Scalar;
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Inputs, NORMAL, SLIDE, SLIDE_LOW, State, StateOf, System, WHIRL, WHIRL_LOW};

impl<S: Stator> ContactSeries<S> {
    /// State at θ of a step that started at `y`.
    pub(crate) fn at<W: Spin, M: Amplifier>(
        &self,
        spin: &W,
        y: &StateOf<S, W, M>,
        theta: f64,
    ) -> StateOf<S, W, M> {
        let order = self.order;
        let mut spun = y.spin;
        spin.set_spin_rad_s(&mut spun, self.spin.at(theta, order));
        spin.turn(&mut spun, self.step_s * self.spin.integral(theta, order));
        State {
            rotor: Body {
                position: self.position.at(theta, order),
                velocity: self.velocity.at(theta, order),
            },
            stator: S::at(&self.stator, theta, order),
            spin: spun,
            force: M::at(&self.magnet, theta, order),
        }
    }

    /// Weighed size of the coefficients k.
    pub(crate) fn size(&self, k: usize, weights: &Weights) -> f64 {
        let rotor = Body {
            position: self.position.0[k],
            velocity: self.velocity.0[k],
        };
        let spin = self.spin.0[k] * weights.spin;
        let stator = S::coefficient(&self.stator, k).weighed_square(weights);
        let gap = self.gap.0[k].norm_squared() * weights.gap * weights.gap;
        (gap + rotor.weighed_square(weights) + stator + spin * spin).sqrt()
    }

    /// Guards of the mode as series; only those in use.
    pub(crate) fn guards<W: Spin, M: Amplifier>(
        &self,
        system: &System<S, W, M>,
        (slide, whirl): (Slide, Whirl),
    ) -> [Option<Scalar>; 5] {
        let order = self.order;
        let mut guards = [None; 5];
        guards[NORMAL] = Some(self.force);
        let radius = system.rotor.contact_radius_m;
        let mu = system.friction.sliding.coefficient(0.0);
        match slide {
            Slide::Rolling => {
                guards[SLIDE] = Some(self.force.combined(mu, &self.sliding, -1.0, order));
                guards[SLIDE_LOW] = Some(self.force.combined(mu, &self.sliding, 1.0, order));
            }
            _ if mu == 0.0 => {}
            _ => {
                let sign = slide.sign();
                guards[SLIDE] =
                    Some(
                        self.whirl_speed
                            .combined(sign, &self.spin, sign * radius, order),
                    );
            }
        }
        let mu_r = system.friction.rolling_coefficient;
        match whirl {
            Whirl::Ignored => {}
            Whirl::Still => {
                guards[WHIRL] = Some(self.force.combined(mu_r, &self.rolling, -1.0, order));
                guards[WHIRL_LOW] = Some(self.force.combined(mu_r, &self.rolling, 1.0, order));
            }
            _ => {
                guards[WHIRL] =
                    Some(
                        self.whirl_speed
                            .combined(whirl.sign(), &self.spin, 0.0, order),
                    );
            }
        }
        guards
    }

    /// Energy through each door from 0 to θ.
    pub(crate) fn flows<W: Spin, M: Amplifier>(
        &self,
        system: &System<S, W, M>,
        (start, end): (&Body, &Body),
        inputs: &Inputs,
        theta: f64,
    ) -> Flows {
        let (h, order) = (self.step_s, self.order);
        let path = end.position - start.position;
        let radius = system.rotor.contact_radius_m;
        let control = if M::LAGS {
            h * self.magnet.integral_of_dot(&self.velocity, theta, order)
        } else {
            inputs.command_n.dot(&path)
        };
        let free = system.spin.inverse_inertia() > 0.0;
        let spin_work = if free {
            self.sliding.integral_of_product(&self.spin, theta, order)
        } else {
            self.spin.0[0] * self.sliding.integral(theta, order)
        };
        let drive = if free {
            system.spin.drive_torque_n_m() * h * self.spin.integral(theta, order)
        } else {
            -radius * h * spin_work
        };
        let whirl_work = self
            .sliding
            .integral_of_product(&self.whirl_speed, theta, order);
        let damping = system.rotor.damping_n_s_m;
        let contact_damping = system.contact.damping_n_s_m;
        let unbalance = if system.rotor.eccentricity_m > 0.0 {
            system.rotor.mass_kg * h * self.unbalance.integral_of_dot(&self.velocity, theta, order)
        } else {
            0.0
        };
        let or_zero = |present: bool, value: &dyn Fn() -> f64| if present { value() } else { 0.0 };
        Flows {
            control,
            external: inputs.external_n.dot(&path),
            drive,
            unbalance,
            rotor_damping: or_zero(damping > 0.0, &|| {
                damping * h * self.velocity.integral_of_dot(&self.velocity, theta, order)
            }),
            stator_damping: h * system.stator.damping_integral_w(&self.stator, theta, order),
            contact_damping: or_zero(contact_damping > 0.0, &|| {
                let square =
                    self.normal_speed
                        .integral_of_product(&self.normal_speed, theta, order);
                contact_damping * h * square
            }),
            sliding_friction: -h * (whirl_work + radius * spin_work),
            rolling_friction: or_zero(system.friction.rolling_coefficient > 0.0, &|| {
                -h * self
                    .rolling
                    .integral_of_product(&self.whirl_speed, theta, order)
            }),
            normal_impulse_n_s: h * self.force.integral(theta, order),
        }
    }
}
