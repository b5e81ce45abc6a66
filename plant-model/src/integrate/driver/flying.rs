//! The rotor off the wall.

use super::{ON_WALL, Run, rests_on_wall};
use crate::bisection::bracket_until;
use crate::integrate::flight::Crossing;
use crate::magnet::Amplifier;
use crate::mode::{Phase, Slide, Whirl};
use crate::plane::{Bore, Raceway};
use crate::readout::HARD_IMPACT_M_S;
use crate::spin::Spin;
use crate::stator::Stator;

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> Run<S, W, M, B, R> {
    /// Says whether nothing came in the way of the flight's own step.
    pub(super) fn fly_inside(&mut self, t_end_s: f64) -> bool {
        let remaining = t_end_s - self.t_s;
        let here = (self.t_s, &self.y);
        (self.system).fly(&mut self.segment, here, &self.inputs, remaining);
        let last = self.segment.step_s >= remaining;
        let (theta, hit) = match self
            .segment
            .wall_crossing::<B>(self.system.plane.contact.clearance_m, self.just_left)
        {
            Crossing::Nowhere => (1.0, false),
            Crossing::At(theta) => (theta, true),
            Crossing::ClearUntil(theta) => (theta.min(1.0), false),
        };
        self.just_left = false;
        let rested = hit && self.t_s == 0.0 && rests_on_wall(&self.system, &self.y);
        self.fly(theta, last.then_some(t_end_s));
        if hit {
            let g = self.system.geometry(&self.y);
            // From rest on the wall and under a push a of ½·a·t² = ½·v·t: no farther away than rounding, so never off.
            let off_m = self.t_s * g.normal_speed_m_s;
            if rested && off_m <= 2.0 * ON_WALL * self.system.plane.contact.clearance_m {
                self.touch_down();
                return false;
            }
            self.meters.impacts += 1;
            self.meters.hard_impacts += u64::from(g.normal_speed_m_s > HARD_IMPACT_M_S);
            self.meters.peak_impact_speed_m_s =
                self.meters.peak_impact_speed_m_s.max(g.normal_speed_m_s);
            self.touch_down();
        }
        !hit && theta == 1.0
    }

    /// Takes the flight up to θ; a whole last segment ends exactly at `end_s`.
    fn fly(&mut self, theta: f64, end_s: Option<f64>) {
        let segment = &self.segment;
        let end = self.system.flown(segment, &self.y, theta);
        let flows = (self.system).flight_flows(segment, &self.y, &end, &self.inputs, theta);
        self.flows.add_scaled(1.0, &flows);
        self.y = end;
        self.t_s = match end_s {
            Some(end_s) if theta == 1.0 => end_s,
            _ => self.t_s + theta * segment.step_s,
        };
    }

    /// The wall is still dented but the force is gone. Short: the rotor leaves at impact speed.
    pub(super) fn fly_beyond(&mut self, t_end_s: f64) {
        const SCANS: u32 = 16;
        // Near θ = 0 neighbouring numbers are closer than anything that counts: sixty halvings of a scan.
        const FINEST: f64 = f64::EPSILON / 4096.0;
        let remaining = t_end_s - self.t_s;
        let g = self.system.geometry(&self.y);
        let leave_s = g.penetration_m / g.normal_speed_m_s.abs();
        let step = remaining.min((2.0 * leave_s).max(self.system.moment_s(&self.y)));
        let here = (self.t_s, &self.y);
        (self.system).fly(&mut self.segment, here, &self.inputs, step);
        let last = self.segment.step_s >= remaining;
        // Positive while beyond: (penetration, lack of force).
        let room = |theta: f64| {
            let g = self
                .system
                .geometry(&self.system.flown(&self.segment, &self.y, theta));
            (g.penetration_m, -self.normal_n(&g))
        };
        let mut theta = 1.0;
        let mut next = Phase::Beyond;
        let (mut valid, mut lack) = (0.0, room(0.0).1);
        for i in 1..=SCANS {
            let at = f64::from(i) / f64::from(SCANS);
            let (inside, force) = room(at);
            // A lift-off found a moment early leaves a force that is still falling.
            if inside <= 0.0 || (force < 0.0 && force < lack) {
                let leaves = inside <= 0.0;
                let hold = |th: f64| {
                    if leaves {
                        room(th).0 > 0.0
                    } else {
                        room(th).1 >= 0.0
                    }
                };
                (_, theta) = bracket_until((valid, at), |low, high| high - low <= FINEST, hold);
                next = if leaves {
                    Phase::Inside
                } else {
                    Phase::Contact(Slide::Rolling, Whirl::Still)
                };
                break;
            }
            (valid, lack) = (at, force);
        }
        self.fly(theta, last.then_some(t_end_s));
        if matches!(next, Phase::Contact(..)) {
            // The dent whose energy was written off at lift-off is felt again.
            let g = self.system.geometry(&self.y);
            self.flows.contact_damping -= self.system.plane.contact.law.stored_j(g.penetration_m);
            self.touch_down();
        } else {
            self.phase = next;
        }
    }
}
