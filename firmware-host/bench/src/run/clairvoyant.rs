//! The reference policy: true state, no noise, no delay, the same cap and amplifier. Its law has the shape
//! of the supervisor's, in double precision, with every weight free to be searched.

use crate::run::controller::{Controller, Force, Seen};
use plant_model::contact::restitution_of;
use plant_model::params::PlantParams;
use plant_model::{Snapshot, V2};

/// The free weights of the law.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClairvoyantLaw {
    /// Backward speed that counts for each unit of normal speed before an impact, K.
    pub flight_gain: f64,
    /// The same while touching and still moving outwards.
    pub contact_gain: f64,
    /// Inward part of the braking force in contact, per tangential part.
    pub tilt: f64,
    /// Share of the cap per lift-off speed: how slow it may get before the force gives way.
    pub damper: f64,
    /// Inward share of the cap at the wall, of what the rest leaves.
    pub restoring: f64,
}

/// The law on one plant.
#[derive(Debug, Clone, PartialEq)]
pub struct Clairvoyant {
    law: ClairvoyantLaw,
    clearance_m: f64,
    force_max_n: f64,
    /// Speed that the cap can lift off, √(F·c/m) \[m/s\].
    lift_off_m_s: f64,
    friction: f64,
    restitution: f64,
    /// Mean time from a command to its force \[s\].
    horizon_s: f64,
    lag_s: f64,
    half_period_s: f64,
}

/// Restitution of a plant's contact, as the law is configured.
pub fn restitution(plant: &PlantParams) -> f64 {
    // The catalogues' contacts are linear; a nonlinear one loses little at low speed.
    plant.contact.law.linear().map_or(1.0, |law| {
        let critical = 2.0 * (law.stiffness_n_m * plant.contact_mass_kg()).sqrt();
        restitution_of(law.damping_n_s_m / critical)
    })
}

impl Clairvoyant {
    /// Sets the law up.
    pub fn new(
        law: ClairvoyantLaw,
        plant: &PlantParams,
        restitution: f64,
        sample_rate_hz: f64,
    ) -> Self {
        let (force_max_n, lag_s) = plant
            .magnet
            .map_or((0.0, 0.0), |m| (m.force_max_n, m.lag_s));
        let c = plant.contact.clearance_m;
        let half_period_s = 0.5 / sample_rate_hz;
        Self {
            law,
            clearance_m: c,
            force_max_n,
            lift_off_m_s: (force_max_n * c / plant.rotor.mass_kg).sqrt(),
            friction: plant.friction.sliding.coefficient(0.0),
            restitution,
            horizon_s: lag_s + half_period_s,
            lag_s,
            half_period_s,
        }
    }

    /// Force for the true state \[N\].
    pub fn force_n(&self, now: &Snapshot) -> V2 {
        let mut sum = V2::zeros();
        for part in self.parts(now, now.velocity_m_s) {
            sum += part * largest_share(sum, part);
        }
        sum * self.force_max_n
    }

    /// What is wanted of the force, the most urgent first, as shares of the cap: braking, damping, restoring. Damping is
    /// against the velocity \[m/s\] that the rotor is expected to have when the force has come.
    pub(crate) fn parts(&self, now: &Snapshot, damped_m_s: V2) -> [V2; 3] {
        let (x, v) = (
            now.position_m / self.clearance_m,
            now.velocity_m_s / self.lift_off_m_s,
        );
        let sense = if now.spin_rad_s == 0.0 {
            let turning = x.perp(&v);
            if turning > 0.0 { 1.0 } else { -1.0 }
        } else {
            -now.spin_rad_s.signum()
        };
        let damping = damped_m_s / self.lift_off_m_s * -self.law.damper;
        if now.mode.in_contact() {
            [self.in_contact(x, v, sense), damping, V2::zeros()]
        } else {
            [
                self.in_flight(x, v, sense),
                damping,
                -x * self.law.restoring,
            ]
        }
    }

    /// Mean time from a command to its force \[s\].
    pub(crate) fn horizon_s(&self) -> f64 {
        self.horizon_s
    }

    /// Braking on the wall.
    fn in_contact(&self, x: V2, v: V2, sense: f64) -> V2 {
        let radius = x.norm();
        let n = x / radius;
        let b = quarter(n) * sense;
        let sum = v.dot(&b) + self.law.contact_gain * v.dot(&n).max(0.0);
        let strength = (sum.max(0.0) * self.law.damper).min(1.0);
        let aim = (b + n * self.law.tilt).normalize() * -strength;
        // The force turns with the contact: lag and half a period of hold are made up for.
        let rate = v.dot(&quarter(n)) / radius * self.lift_off_m_s / self.clearance_m;
        let lead = (rate * self.lag_s).atan() + rate * self.half_period_s;
        rotated(aim, lead)
    }

    /// Braking of the impact to come.
    fn in_flight(&self, x: V2, v: V2, sense: f64) -> V2 {
        let per_unit = self.clearance_m / self.lift_off_m_s;
        let (mut x, mut v) = (x, v);
        let Some(mut hit) = ahead(x, v) else {
            return V2::zeros();
        };
        let gain = self.law.flight_gain;
        let mut act_after = self.horizon_s / per_unit;
        if hit.0 < act_after {
            let n = hit.1;
            let lost = (1.0 + self.restitution) * v.dot(&n);
            v += quarter(n) * (sense * self.friction * lost) - n * lost;
            act_after -= hit.0;
            x = n * 0.999;
            match ahead(x, v) {
                Some(next) => hit = next,
                None => return V2::zeros(),
            }
            act_after = act_after.min(hit.0);
        }
        let at = x + v * act_after;
        let n = hit.1;
        let (v_n, v_b) = (v.dot(&n), v.dot(&quarter(n)) * sense);
        let sum = v_b + gain * v_n;
        let strength = (sum.max(0.0) * self.law.damper).min(1.0);
        let gradient = quarter(at) * (sense * (v_n - gain * v_b)) + v * gain;
        let size = gradient.norm();
        if size > 0.0 {
            gradient * (-strength / size)
        } else {
            V2::zeros()
        }
    }
}

impl Controller for Clairvoyant {
    fn command(&mut self, _seen: &Seen, truth: &Snapshot) -> Force {
        Force::AtOnce(self.force_n(truth))
    }
}

fn quarter(v: V2) -> V2 {
    V2::new(-v.y, v.x)
}

pub(crate) fn rotated(v: V2, angle: f64) -> V2 {
    let (s, c) = angle.sin_cos();
    V2::new(c * v.x - s * v.y, s * v.x + c * v.y)
}

/// Time and normal of the impact at the end of a straight flight, per unit.
fn ahead(x: V2, v: V2) -> Option<(f64, V2)> {
    let square = v.norm_squared();
    let room = 1.0 - x.norm_squared();
    if !(square > 1e-14 && room > 0.0) {
        return None;
    }
    let along = x.dot(&v);
    let time = ((along * along + square * room).sqrt() - along) / square;
    Some((time, x + v * time))
}

/// Largest s in [0, 1] with |sum + s·part| ≤ 1.
pub(crate) fn largest_share(sum: V2, part: V2) -> f64 {
    let square = part.norm_squared();
    if square <= 1e-18 {
        return 1.0;
    }
    let along = sum.dot(&part);
    let room = (1.0 - sum.norm_squared()).max(0.0);
    (((along * along + square * room).sqrt() - along) / square).clamp(0.0, 1.0)
}
