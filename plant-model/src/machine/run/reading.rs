//! What can be read off a machine that is being run.

use super::Machine;
use crate::V2;
use crate::energy::Audit;
use crate::machine::params::MAX_PLANES;
use crate::machine::readout::{ContactMotion, MachineSnapshot, PlaneSnapshot};
use crate::machine::series::Step;
use crate::mode::Phase;
use crate::part::Body;

impl Machine {
    pub(crate) fn contact_motion(&self, plane: usize) -> ContactMotion {
        self.system.motion(plane, &self.y)
    }

    pub(crate) fn normals(&self) -> [V2; MAX_PLANES] {
        let mut normals = [V2::x(); MAX_PLANES];
        for (p, normal) in normals.iter_mut().enumerate().take(self.phases.len()) {
            *normal = self.contact_motion(p).normal;
        }
        normals
    }

    /// What can be read off now.
    pub fn snapshot(&mut self) -> MachineSnapshot {
        const ORDER: usize = 1;
        let step = Step {
            system: &self.system,
            phases: &self.phases,
            forces: &self.forces,
            commands_n: &self.inputs.commands_n,
            step_s: self.system.moment_s,
        };
        (self.stepper.series).fill(&step, &self.y, ORDER, |_, _| false);
        let body = &self.system.body;
        let mut planes = [None; MAX_PLANES];
        for (p, phase) in self.phases.iter().enumerate() {
            let motion = self.system.motion(p, &self.y);
            let series = &self.stepper.series.planes[p];
            let touching = matches!(phase, Phase::Contact(..));
            let force = |x: f64| if touching { x } else { 0.0 };
            planes[p] = Some(PlaneSnapshot {
                rotor: self.y.motion_at(&body.at_planes[p]),
                ring: (body.rings[p].as_ref())
                    .map_or_else(Body::default, |ring| self.y.motion_at(ring)),
                mode: phase.mode(),
                penetration_m: motion.penetration_m,
                normal_force_n: force(series.force.0[0]).max(0.0),
                sliding_force_n: force(series.sliding.0[0]),
                rolling_force_n: force(series.rolling.0[0]),
                whirl_speed_m_s: motion.whirl_m_s,
                sliding_speed_m_s: motion.sliding_m_s,
                race_spin_rad_s: self.y.races_rad_s[p],
            });
        }
        MachineSnapshot {
            t_s: self.t_s,
            spin_rad_s: self.y.spin_rad_s,
            phase_rad: self.y.phase_rad,
            planes,
        }
    }

    /// Motion at a probe, as they stand in the parameters; `None` where there is no such probe.
    pub fn probe(&self, index: usize) -> Option<Body> {
        let port = self.system.body.probes.get(index)?;
        Some(self.y.motion_at(port))
    }

    /// Force that a magnet delivers \[N\]; `None` where there is no such magnet.
    pub fn delivered_n(&self, magnet: usize) -> Option<V2> {
        Some(match (*self.system.magnet_rates.get(magnet)?).is_some() {
            true => self.y.magnets_n[magnet],
            false => self.inputs.commands_n[magnet],
        })
    }

    /// The energy audit of the machine so far. Dampers of rings are booked with the rotor's.
    pub fn audit(&self) -> Audit {
        Audit {
            flows: self.flows,
            stored_at_start_j: self.stored_at_start_j,
            stored_j: self.system.stored_j(&self.y, &self.phases),
            stored_peak_j: self
                .stored_peak_j
                .max((self.stored_at_start_j - self.spare_j).abs()),
        }
    }
}
