//! Heat of bearings, and clearances that follow it, from call to call.

use super::Machine;
use crate::mode::Phase;

/// How warm a bearing is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warmth {
    /// What the bearing has lost so far by friction, damping and drag \[J\].
    pub heat_j: f64,
    /// Rise of its temperature over the surroundings \[K\].
    pub rise_k: f64,
    /// Its clearance now \[m\].
    pub clearance_m: f64,
}

/// What has been made of a bearing's heat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Warming {
    rise_k: f64,
    taken_j: f64,
    taken_at_s: f64,
}

impl Warming {
    pub(super) fn new(start_rise_k: f64) -> Self {
        Self {
            rise_k: start_rise_k,
            taken_j: 0.0,
            taken_at_s: 0.0,
        }
    }
}

impl Machine {
    /// How warm a plane's bearing is, by losses up to the beginning of the last call; `None` where it has no heat.
    pub fn warmth(&self, plane: usize) -> Option<Warmth> {
        let data = self.system.planes.get(plane)?;
        data.heat?;
        Some(Warmth {
            heat_j: self.plane_flows[plane].losses_j(),
            rise_k: self.warmings[plane].rise_k,
            clearance_m: data.clearance_m,
        })
    }

    /// Takes losses since the last call into temperatures, and these into clearances. What a contact spring gains or loses by
    /// that is work from outside.
    pub(super) fn warm(&mut self) {
        for p in 0..self.phases.len() {
            let Some(heat) = self.system.planes[p].heat else {
                continue;
            };
            let (warming, losses_j) = (&mut self.warmings[p], self.plane_flows[p].losses_j());
            let (heat_j, dt_s) = (losses_j - warming.taken_j, self.t_s - warming.taken_at_s);
            warming.rise_k = heat.risen_k(warming.rise_k, heat_j, dt_s);
            (warming.taken_j, warming.taken_at_s) = (losses_j, self.t_s);
            let wanted_m = heat.clearance_m(self.system.planes[p].cold_m, warming.rise_k);
            let distance_m = self.contact_motion(p).distance_m;
            let before_j = self.spring_j(p);
            self.system.planes[p].clearance_m = match self.phases[p] {
                // A bore does not close on a rotor that is off its wall: the touch is an event of its own.
                Phase::Inside => wanted_m.max(distance_m),
                _ => wanted_m,
            };
            let motion = self.contact_motion(p);
            let law = self.system.planes[p].law;
            let force_n = law.normal_force_n(motion.penetration_m, motion.normal_m_s);
            if matches!(self.phases[p], Phase::Contact(..)) {
                self.flows.external += self.spring_j(p) - before_j;
                if force_n <= 0.0 {
                    self.lift_off(p);
                }
            }
        }
    }
}
