//! What can be read off a machine that is being run.

use super::Machine;
use crate::V2;
use crate::energy::Audit;
use crate::machine::body::Port;
use crate::machine::params::{MAX_MAGNETS, MAX_PLANES};
use crate::machine::poles::MagnetLaw;
use crate::machine::readout::{AxisMotion, ContactMotion, MachineSnapshot, PlaneSnapshot};
use crate::machine::series::Step;
use crate::mode::Phase;
use crate::vector::Body;

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

    /// Puts the forces of this instant into the series.
    pub(super) fn look(&mut self) {
        const ORDER: usize = 1;
        let step = Step {
            system: &self.system,
            phases: &self.phases,
            forces: &self.forces,
            commands_n: &self.inputs.commands_n,
            step_s: self.system.moment_s(&self.y),
        };
        (self.stepper.series).fill(&step, &self.y, ORDER, &mut |_, _, _| false);
    }

    /// What can be read off now.
    pub fn snapshot(&mut self) -> MachineSnapshot {
        if (self.phases.iter()).any(|phase| matches!(phase, Phase::Contact(..))) {
            self.look();
        }
        let body = &self.system.body;
        let of_ring = |ring: &Option<Port>| {
            (ring.as_ref()).map_or_else(Body::default, |ring| self.y.motion_at(ring))
        };
        let mut planes = [None; MAX_PLANES];
        for (p, phase) in self.phases.iter().enumerate() {
            let motion = self.system.motion(p, &self.y);
            let series = &self.stepper.series.parts.planes[p];
            let touching = matches!(phase, Phase::Contact(..));
            let force = |x: f64| if touching { x } else { 0.0 };
            planes[p] = Some(PlaneSnapshot {
                rotor: self.y.motion_at(&body.at_planes[p]),
                ring: of_ring(&body.rings[p]),
                outer_ring: of_ring(&body.outer_rings[p]),
                mode: phase.mode(),
                penetration_m: motion.penetration_m,
                normal_force_n: force(series.force.0[0]).max(0.0),
                sliding_force_n: force(series.sliding_n_m.0[0] * motion.distance_m),
                rolling_force_n: force(series.rolling_n_m.0[0] * motion.distance_m),
                whirl_speed_m_s: motion.whirl_m_s,
                sliding_speed_m_s: motion.sliding_m_s,
                race_spin_rad_s: self.y.races_rad_s[p],
                whirl_angle_rad: self.meters[p].whirl_angle_rad,
            });
        }
        let mut delivered_n = [None; MAX_MAGNETS];
        for (m, force_n) in delivered_n.iter_mut().enumerate() {
            *force_n = self.delivered_n(m);
        }
        MachineSnapshot {
            t_s: self.t_s,
            spin_rad_s: self.y.spin_rad_s,
            phase_rad: self.y.phase_rad,
            planes,
            delivered_n,
        }
    }

    /// Number of scalar states that are integrated in contact.
    pub fn states(&self) -> usize {
        let system = &self.system;
        let free = system.inverse_inertia > 0.0;
        let spin = usize::from(free) + usize::from(free && system.body.unbalance.is_some());
        let races = system.planes.iter().flat_map(|plane| plane.race).count();
        let magnets = system.magnets.iter().map(MagnetLaw::states);
        4 * system.body.pairs + spin + races + magnets.sum::<usize>()
    }

    /// The rotor's axis now.
    pub fn axis(&self) -> AxisMotion {
        let body = &self.system.body;
        // Of the free shaft alone: what supports hold is theirs.
        let squares = |mode: &(Port, f64)| {
            let motion = self.y.motion_at(&mode.0);
            (mode.1 * motion.position).norm_squared() + motion.velocity.norm_squared()
        };
        AxisMotion {
            centre: self.y.motion_at(&body.centre),
            tilt: self.y.motion_at(&body.tilt),
            bending_j: 0.5 * self.system.mass_kg * body.bending.iter().map(squares).sum::<f64>(),
        }
    }

    /// Amplitude of a bending mode, times the displacement of its shape \[m\]; `None` where there is no such mode.
    pub fn bending(&self, mode: usize) -> Option<Body> {
        let (port, _) = self.system.body.bending.get(mode)?;
        Some(self.y.motion_at(port))
    }

    /// Motion at a probe, as they stand in the parameters; `None` where there is no such probe.
    pub fn probe(&self, index: usize) -> Option<Body> {
        let port = self.system.body.probes.get(index)?;
        Some(self.y.motion_at(port))
    }

    /// Force that a magnet delivers \[N\]; `None` where there is no such magnet.
    pub fn delivered_n(&self, magnet: usize) -> Option<V2> {
        Some(match self.system.magnets.get(magnet)?.is_held() {
            true => self.inputs.commands_n[magnet],
            false => self.system.magnet_n(magnet, &self.y),
        })
    }

    /// The energy audit of the machine so far.
    pub fn audit(&self) -> Audit {
        let mut flows = self.flows;
        flows.add_scaled(1.0, &self.map.works());
        Audit {
            flows,
            stored_at_start_j: self.stored_at_start_j,
            stored_j: self.system.stored_j(&self.y, &self.phases),
            stored_peak_j: self
                .stored_peak_j
                .max((self.stored_at_start_j - self.spare_j).abs()),
        }
    }
}
