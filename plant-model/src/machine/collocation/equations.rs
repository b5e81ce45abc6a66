//! The equations of motion at an instant.

use super::{Collocation, Touch};
use crate::V2;
use crate::machine::poles::MagnetLaw;
use crate::machine::series::Step;
use crate::machine::system::{Channel, holding_channels};
use crate::mode::{Phase, Slide, Whirl};
use crate::vector::perp;

impl Collocation {
    /// The equations of motion at a point.
    pub(super) fn evaluate(&mut self, step: &Step<'_>, i: usize) {
        self.evaluations += 1;
        let (system, instant) = (step.system, &mut self.instants[i]);
        let (body, y) = (&system.body, &instant.y);
        let a = &mut instant.acceleration;
        a.copy_from_slice(step.forces);
        body.stiffness.add_product(a, -1.0, &y.position);
        body.damping.add_product(a, -1.0, &y.velocity);
        body.gyroscopic.add_product(a, -y.spin_rad_s, &y.velocity);
        for (m, port) in body.magnets.iter().enumerate() {
            let (state, command_n) = (y.magnets[m], step.commands_n[m]);
            instant.magnet_rates[m] = match &system.magnets[m] {
                MagnetLaw::Held => continue,
                MagnetLaw::Lag(rate) => *rate * (command_n - state),
                MagnetLaw::SecondOrder(rate, ratio) => {
                    let slope = y.magnet_slopes[m];
                    instant.slope_rates[m] =
                        *rate * (*rate * (command_n - state) - 2.0 * ratio * slope);
                    slope
                }
                MagnetLaw::Poles(poles) => {
                    poles.current_rate(state, command_n, port.of(&y.velocity))
                }
            };
            instant.magnets_n[m] = system.magnet_n(m, y);
            port.push(a, instant.magnets_n[m]);
        }
        let mut torque = system.drive_torque_n_m;
        for (p, phase) in step.phases.iter().enumerate() {
            let (data, touch) = (&system.planes[p], &mut instant.touches[p]);
            *touch = Touch::default();
            if *phase == Phase::Inside {
                continue;
            }
            let motion = system.motion(p, y);
            touch.distance_m = motion.distance_m;
            touch.normal = motion.normal;
            touch.penetration_m = motion.penetration_m;
            touch.normal_m_s = motion.normal_m_s;
            let normal = data.law.at(motion.penetration_m, motion.normal_m_s);
            (touch.force_n, touch.normal_guard) = (normal.force_n, normal.guard);
            (touch.by_depth_n_m, touch.by_rate_n_s_m) = (normal.by_depth_n_m, normal.by_rate_n_s_m);
            let Phase::Contact(slide, whirl) = *phase else {
                continue;
            };
            touch.whirl_m_s = motion.whirl_m_s;
            touch.slip_m_s = motion.sliding_m_s;
            if slide != Slide::Rolling {
                let sign = slide.sign();
                let mu = data.friction.coefficient(sign * motion.sliding_m_s);
                touch.sliding_share = -sign * mu;
                touch.sliding_n = touch.sliding_share * touch.force_n;
            }
            if !matches!(whirl, Whirl::Still | Whirl::Ignored) {
                touch.rolling_share = -whirl.sign() * data.rolling;
                touch.rolling_n = touch.rolling_share * touch.force_n;
            }
            torque += data.radius_m * touch.sliding_n;
            let grip = touch.sliding_n + touch.rolling_n;
            let force = grip * perp(touch.normal) - touch.force_n * touch.normal;
            body.contacts[p].push(a, force);
        }
        instant.spin_rate = torque * system.inverse_inertia;
        for (p, rate) in instant.race_rates.iter_mut().enumerate() {
            let touch = &instant.touches[p];
            *rate = match step.phases[p] {
                Phase::Contact(..) => {
                    let loads = (touch.sliding_n, touch.force_n);
                    system.race_acceleration(p, y.races_rad_s[p], loads)
                }
                // It coasts.
                _ => 0.0,
            };
        }
        let direction = match &body.unbalance {
            None => V2::x(),
            Some(unbalance) => {
                let (sin, cos) = y.phase_rad.sin_cos();
                let direction = V2::new(cos, sin);
                instant.unbalance =
                    y.spin_rad_s * y.spin_rad_s * direction - instant.spin_rate * perp(direction);
                unbalance.push(a, instant.unbalance);
                direction
            }
        };
        self.hold(step, i, direction);
    }

    /// Adds the friction that holds speeds at zero: so that their rates are zero.
    fn hold(&mut self, step: &Step<'_>, i: usize, direction: V2) {
        let (system, instant) = (step.system, &mut self.instants[i]);
        let touches = &instant.touches;
        let channels = holding_channels(step.phases);
        (self.holding).set(system, channels, |p| touches[p].normal, direction);
        let friction_n = self.holding.against(|held| {
            let touch = &instant.touches[held.plane];
            let port = &system.body.contacts[held.plane];
            // The tangent turns by v_w/ρ.
            let turned = -touch.whirl_m_s / touch.distance_m * touch.normal_m_s;
            held.tangent.dot(&port.of(&instant.acceleration))
                + turned
                + system.surface_of(
                    held.plane,
                    held.channel,
                    instant.spin_rate,
                    instant.race_rates[held.plane],
                )
        });
        for (held, force_n) in self.holding.held().iter().zip(friction_n) {
            for (a, by) in instant.acceleration.iter_mut().zip(&held.accelerations) {
                *a += force_n * by;
            }
            instant.spin_rate += force_n * held.spin;
            instant.race_rates[held.plane] += force_n * held.race;
            instant.unbalance -= force_n * held.spin * perp(direction);
            let touch = &mut instant.touches[held.plane];
            match held.channel {
                Channel::Sliding => touch.sliding_n += force_n,
                Channel::Rolling => touch.rolling_n += force_n,
            }
        }
    }
}
