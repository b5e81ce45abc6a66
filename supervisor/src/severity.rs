//! How bad it was and will be: landings, severity index, the severity of an impact before it comes, and
//! the request to coast down.

use crate::coeffs::Coeffs;
use crate::detect::Findings;
use crate::estimate::Motion;
use crate::guard::Reading;
use crate::math::{Sum, max, min, sqrt};
use crate::signal::{Events, Limits, Mode, Report};
use crate::vec2::Vec2;

/// Largest severity and severity index that are reported.
const MOST_SEVERITY: f32 = 1e6;
const MOST_INDEX: f32 = 1e9;

/// Counters since the supervisor was made, per unit.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Severity {
    landings: u32,
    impacts: u32,
    contact_ticks: u32,
    impact_speed_max: f32,
    backward_speed_max: f32,
    index: Sum,
    /// The rotor has touched in this engagement.
    landed: bool,
    beyond_ticks: u32,
    coast_down: bool,
    /// Velocity at the last tick: what it was before an impact that the sample shows.
    before: Vec2,
}

/// What a tick has to report.
pub(crate) struct Assessment {
    /// Predicted backward speed over the whirl limit.
    pub(crate) severity: f32,
    pub(crate) limits: Limits,
    pub(crate) events: Events,
}

impl Severity {
    /// `force` is the one that acts \[caps\].
    pub(crate) fn assess(
        &mut self,
        mode: Mode,
        motion: &Motion,
        found: &Findings,
        reading: &Reading,
        force: Vec2,
        coeffs: &Coeffs,
    ) -> Assessment {
        let mut result = Assessment {
            severity: 0.0,
            limits: Limits::empty(),
            events: Events::empty(),
        };
        let before = core::mem::replace(&mut self.before, motion.velocity);
        if !reading.bearing_on {
            self.coast_down = false;
        }
        match mode {
            Mode::Levitated => {
                self.landed = false;
                self.beyond_ticks = 0;
                return result;
            }
            // What is not measured is not counted.
            Mode::SensorFault => return result,
            _ => {}
        }
        let in_contact = found.touching && reading.position.is_some();
        let backward = backward_speed(found.tangential_speed, reading.spin_sign);
        let index_before = self.index.value;
        if in_contact {
            self.contact(before, backward, found, motion, force, coeffs);
        }
        if found.unavoidable || found.touching {
            let coming = predicted(motion, found, reading.spin_sign, coeffs);
            result.severity = min(coming / coeffs.whirl_limit, MOST_SEVERITY);
        }

        let beyond = backward > coeffs.whirl_limit;
        if beyond && found.touching {
            result.limits |= Limits::BEYOND_WHIRL_LIMIT;
            self.beyond_ticks = self.beyond_ticks.saturating_add(1);
        } else if !beyond {
            // A rotor that leaves the wall for some ticks without losing speed has not been stopped.
            self.beyond_ticks = 0;
        }
        let passed =
            index_before <= coeffs.severity_limit && self.index.value > coeffs.severity_limit;
        if (passed || self.beyond_ticks > coeffs.coast_down_ticks) && !self.coast_down {
            self.coast_down = true;
            result.events |= Events::COAST_DOWN;
        }
        result
    }

    /// A tick in contact: impact and friction, as energies over ½·m.
    fn contact(
        &mut self,
        before: Vec2,
        backward: f32,
        found: &Findings,
        motion: &Motion,
        force: Vec2,
        coeffs: &Coeffs,
    ) {
        if !self.landed {
            self.landed = true;
            self.landings = self.landings.saturating_add(1);
        }
        self.contact_ticks = self.contact_ticks.saturating_add(1);
        self.backward_speed_max = max(self.backward_speed_max, backward);
        let mut energy = 0.0;
        if found.touched {
            self.impacts = self.impacts.saturating_add(1);
            let speed = max(before.dot(found.normal), 0.0);
            self.impact_speed_max = max(self.impact_speed_max, speed);
            energy += speed * speed;
        }
        // Normal force per mass that keeps the rotor on its circle against what pulls it off.
        let along = found.tangential_speed;
        let outward = (force * coeffs.force_gain + motion.load).dot(found.normal);
        let normal = max(along * along - coeffs.stiffness + outward, 0.0);
        let speed = max(along, -along);
        energy += 2.0 * coeffs.friction * normal * speed;
        if self.index.value < MOST_INDEX {
            let limit = coeffs.whirl_limit;
            // Both factors are bounded before they meet.
            self.index.add(min(energy / limit / limit, MOST_INDEX));
        }
    }

    pub(crate) fn report(&self, coeffs: &Coeffs) -> Report {
        Report {
            landings: self.landings,
            impacts: self.impacts,
            contact_ticks: self.contact_ticks,
            impact_speed_max_m_s: self.impact_speed_max * coeffs.speed_m_s,
            backward_speed_max_m_s: self.backward_speed_max * coeffs.speed_m_s,
            whirl_limit_m_s: coeffs.whirl_limit * coeffs.speed_m_s,
            severity_index: min(self.index.value, MOST_INDEX),
            coast_down: self.coast_down,
            ..Report::default()
        }
    }
}

/// Speed against the spin; with unknown spin every whirl counts, for friction will drive it.
fn backward_speed(along: f32, spin_sign: f32) -> f32 {
    if spin_sign != 0.0 {
        -spin_sign * along
    } else {
        max(along, -along)
    }
}

/// Backward speed after all the impacts to come, v_b + K·v_n, of the next one: on a straight way its
/// v_b is the angular momentum about the centre, and v_n what that leaves of the speed.
fn predicted(motion: &Motion, found: &Findings, spin_sign: f32, coeffs: &Coeffs) -> f32 {
    let (along, normal) = if found.touching {
        (found.tangential_speed, max(found.radial_speed, 0.0))
    } else {
        let along = motion.position.turned().dot(motion.velocity);
        let square = motion.velocity.length_squared() - along * along;
        (along, sqrt(max(square, 0.0)))
    };
    max(
        backward_speed(along, spin_sign) + coeffs.bounce_gain * normal,
        0.0,
    )
}
