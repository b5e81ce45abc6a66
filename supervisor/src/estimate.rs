//! Position and velocity, from samples and from the force that the magnet delivers.
//!
//! In flight the model is good (known force, stiffness, damping, and a slowly varying load), so the
//! observer may be slow and smooth. In contact it is blind for the contact force and must be quick.

use crate::coeffs::{Coeffs, MAX_DELAY};
use crate::guard::Actuator;
use crate::math::between;
use crate::vec2::Vec2;

/// Estimated motion, per unit and tick.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Motion {
    pub(crate) position: Vec2,
    pub(crate) velocity: Vec2,
    /// Acceleration by loads that the model does not know.
    pub(crate) load: Vec2,
    /// From one sample only: the velocity is not known yet.
    pub(crate) fresh: bool,
}

/// The observer.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Observer {
    motion: Motion,
    started: bool,
    /// Delivered force at the last tick.
    delivered: Vec2,
    /// Commands of the last ticks, newest at `newest`.
    commands: [Vec2; MAX_DELAY],
    newest: usize,
}

/// Estimates beyond this are held: the guard lets no sample pass that is farther out.
const FARTHEST: f32 = 1e4;

impl Observer {
    /// Carries the estimate over one tick and corrects it by the sample, if there is one.
    pub(crate) fn advance(
        &mut self,
        sample: Option<Vec2>,
        in_contact: bool,
        actuator: Actuator,
        coeffs: &Coeffs,
    ) -> Motion {
        let index = self.newest.wrapping_sub(coeffs.delay) & (MAX_DELAY - 1);
        let command = self.commands.get(index).copied().unwrap_or_default();
        let command = actuator.carried(command);
        let before = actuator.carried(self.delivered);
        let away = before - command;
        let (delivered, mean) = match actuator.applied {
            Some(now) => (now, now + (before - now) * coeffs.applied_weight),
            None => (
                command + away * (1.0 - coeffs.lag_step),
                command + away * coeffs.lag_mean,
            ),
        };
        self.delivered = delivered;

        if let Some(position) = sample
            && !self.started
        {
            self.started = true;
            self.motion = Motion {
                position,
                fresh: true,
                ..Motion::default()
            };
            return self.motion;
        }
        let m = &mut self.motion;
        let middle = m.position + m.velocity * 0.5;
        let mut acceleration =
            mean * coeffs.force_gain - middle * coeffs.stiffness - m.velocity * coeffs.damping;
        if !in_contact {
            acceleration = acceleration + m.load;
        }
        m.position = m.position + m.velocity + acceleration * 0.5;
        m.velocity = m.velocity + acceleration;
        if let Some(position) = sample {
            let error = position - m.position;
            let [on_position, on_velocity, on_load] = if in_contact && m.fresh {
                // Switched on into a contact: the first difference is worth more than rest.
                [1.0, 1.0, 0.0]
            } else if in_contact {
                let [p, v] = coeffs.contact_gains;
                [p, v, 0.0]
            } else {
                coeffs.flight_gains
            };
            m.position = m.position + error * on_position;
            m.velocity = m.velocity + error * on_velocity;
            m.load = m.load + error * on_load;
            m.fresh = false;
        }
        m.position = held(m.position);
        m.velocity = held(m.velocity);
        // A load larger than some caps is no load but a missed contact.
        let most = 4.0 * coeffs.force_gain;
        m.load = Vec2::new(
            between(m.load.x, -most, most),
            between(m.load.y, -most, most),
        );
        *m
    }

    /// Estimated velocity of the last tick.
    pub(crate) fn velocity(&self) -> Vec2 {
        self.motion.velocity
    }

    /// Starts anew at the next sample: without samples the model runs away.
    pub(crate) fn forget(&mut self) {
        self.started = false;
        self.motion = Motion::default();
    }

    /// Tells the observer what was commanded at this tick.
    pub(crate) fn commanded(&mut self, force: Vec2) {
        self.newest = self.newest.wrapping_add(1) & (MAX_DELAY - 1);
        if let Some(slot) = self.commands.get_mut(self.newest) {
            *slot = force;
        }
    }
}

fn held(v: Vec2) -> Vec2 {
    Vec2::new(
        between(v.x, -FARTHEST, FARTHEST),
        between(v.y, -FARTHEST, FARTHEST),
    )
}
