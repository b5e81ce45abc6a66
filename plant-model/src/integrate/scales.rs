//! Against what the error of a step is weighed.

use crate::magnet::Amplifier;
use crate::params::ContactLaw;
use crate::part::Weights;
use crate::plane::{Bore, Raceway};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{StateOf, System};

/// Scales of the motion, against which errors are weighed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    rtol: f64,
    fastest_m_s: f64,
    /// Rate of the contact spring, and the largest of shaft and mountings \[1/s\].
    contact_rate: f64,
    slow_rate: f64,
}

impl Scales {
    pub(crate) fn new<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        rtol: f64,
        system: &System<S, W, M, B, R>,
        y: &StateOf<S, W, M, R>,
    ) -> Self {
        let shaft = (system.rotor.stiffness_n_m.abs() / system.rotor.mass_kg).sqrt();
        Self {
            rtol,
            fastest_m_s: y.rotor.velocity.norm(),
            contact_rate: system.undamped_contact_rate_rad_s(),
            slow_rate: shaft.max(system.stator.undamped_rate_rad_s()),
        }
    }

    /// Scales of the motion, by energy: speed of the rotor, the penetration in which the contact spring
    /// takes its energy up, and the displacement in which shaft and mountings do.
    pub(crate) fn weights<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway>(
        &mut self,
        system: &System<S, W, M, B, R>,
        y: &StateOf<S, W, M, R>,
    ) -> Weights {
        let now = y.rotor.velocity.norm();
        self.fastest_m_s = self.fastest_m_s.max(now);
        // A rotor that comes to rest is followed to a thousandth of its fastest motion; one that
        // never moved, to a thousandth of its weightless creep over the clearance.
        let floor = 1e-3
            * self
                .fastest_m_s
                .max(1e-3 * system.plane.contact.clearance_m * self.contact_rate);
        let speed = now.max(floor);
        let rate = match &system.plane.contact.law {
            ContactLaw::Linear(_) => self.contact_rate,
            // The spring takes the energy up in a depth that is not in proportion to the speed.
            ContactLaw::HuntCrossley(law) => {
                let mobility = 1.0 / system.rotor.mass_kg + system.stator.inverse_mass();
                speed / law.depth_m(speed, 1.0 / mobility)
            }
        };
        let clearance = system.plane.contact.clearance_m;
        let length = speed / self.slow_rate;
        // A race counts as much as the rotor's spin: both make the sliding speed.
        let mut spin =
            (speed / system.plane.radius_m).max(system.spin.spin_rad_s(&y.spin).abs() * 1e-2);
        if system.plane.race.race().is_some() {
            spin = spin.max(R::spin_rad_s(&y.race).abs() * 1e-2);
        }
        Weights {
            position: 1.0 / (self.rtol * length.min(clearance)),
            gap: 1.0 / (self.rtol * (speed / rate).min(clearance)),
            velocity: 1.0 / (self.rtol * speed),
            spin: 1.0 / (self.rtol * spin),
            phase: 1.0 / self.rtol,
            force: 1.0 / (self.rtol * system.rotor.mass_kg * speed * rate),
        }
    }
}
