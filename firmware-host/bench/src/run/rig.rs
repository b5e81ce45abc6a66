//! What a closed loop moves: a plant of one plane, or a whole rotor in several.

use crate::run::trace::AxisRow;
use crate::scene::Scene;
use crate::scene::machine::MachineScene;
use plant_model::energy::Audit;
use plant_model::machine::params::{MachineChange, MachineError, Unbalance};
use plant_model::machine::{Machine, MachineInputs, MachineSnapshot, Warmth};
use plant_model::params::ParamError;
use plant_model::{
    BuildError, Change, Inputs, Meters, Method, Options, Plant, PlantError, Snapshot, V2,
};
use std::f64::consts::PI;

/// Why a plant does not take a change.
#[derive(Debug)]
pub(crate) enum ChangeError {
    OnePlane(ParamError),
    Machine(MachineError),
}

impl From<ParamError> for ChangeError {
    fn from(error: ParamError) -> Self {
        Self::OnePlane(error)
    }
}

impl From<MachineError> for ChangeError {
    fn from(error: MachineError) -> Self {
        Self::Machine(error)
    }
}

/// A plant with planes, each seen from the centre of its retainer bearing.
pub(crate) trait Rig {
    /// Carries it to a time under a command of each plane and a load of each place that are held \[N\]; changes of mode are
    /// put down with their plane.
    fn advance(
        &mut self,
        to_s: f64,
        commands_n: &[V2],
        loads_n: &[V2],
        changes: &mut Vec<(usize, Snapshot)>,
    ) -> Result<(), PlantError>;

    /// What can be read off each plane now.
    fn read(&mut self, now: &mut Vec<Snapshot>);

    /// Where the rotor is at the sensor of a plane, as seen from the centre of the magnets \[m\].
    fn sensed_m(&self, plane: usize, now: &Snapshot) -> V2;

    /// Has a force act on the rotor beside the loads, from now on \[N\]; of a whole rotor, which has no place for it, none does.
    fn push(&mut self, _force_n: V2) {}

    /// Parameters that are others from now on, and of a whole rotor an unbalance that comes on top of what there is.
    fn change(&mut self, change: &Change, unbalance: Option<Unbalance>) -> Result<(), ChangeError>;
    fn meters(&self, plane: usize) -> Meters;
    /// ∫ f_n dt of a plane \[N s\].
    fn normal_impulse_n_s(&self, plane: usize) -> f64;
    fn audit(&self) -> Audit;
    fn method(&self) -> Method;

    /// How warm the bearing of a plane is, where that is modelled.
    fn warmth(&self, _plane: usize) -> Option<Warmth> {
        None
    }

    /// Reads the axis of a whole rotor and the motion of its bending modes; nothing of one plane.
    fn read_axis(&self, _row: &mut AxisRow) {}
}

/// One plane.
pub(crate) struct OnePlane<'a> {
    scene: &'a Scene,
    plant: Plant,
    push_n: V2,
}

impl<'a> OnePlane<'a> {
    pub(crate) fn new(scene: &'a Scene, options: Options) -> Result<Self, BuildError> {
        let plant = scene.build(options)?;
        Ok(Self {
            scene,
            plant,
            push_n: V2::zeros(),
        })
    }
}

impl Rig for OnePlane<'_> {
    fn advance(
        &mut self,
        to_s: f64,
        commands_n: &[V2],
        loads_n: &[V2],
        changes: &mut Vec<(usize, Snapshot)>,
    ) -> Result<(), PlantError> {
        let inputs = Inputs {
            command_n: commands_n[0],
            // Without a push the loads' own bits, the sign of a zero included.
            external_n: match self.push_n == V2::zeros() {
                true => loads_n[0],
                false => loads_n[0] + self.push_n,
            },
        };
        (self.plant).advance(to_s, &inputs, &mut |snapshot| changes.push((0, *snapshot)))
    }

    fn read(&mut self, now: &mut Vec<Snapshot>) {
        now.clear();
        now.push(self.plant.snapshot());
    }

    fn sensed_m(&self, _plane: usize, now: &Snapshot) -> V2 {
        self.scene.from_magnets_m(now.position_m)
    }

    fn push(&mut self, force_n: V2) {
        self.push_n = force_n;
    }

    fn change(
        &mut self,
        change: &Change,
        _unbalance: Option<Unbalance>,
    ) -> Result<(), ChangeError> {
        // A scene of one plane with an unbalance of a rotor is refused.
        Ok(self.plant.change(change)?)
    }

    fn meters(&self, _plane: usize) -> Meters {
        self.plant.meters()
    }

    fn normal_impulse_n_s(&self, _plane: usize) -> f64 {
        self.plant.audit().flows.normal_impulse_n_s
    }

    fn audit(&self) -> Audit {
        self.plant.audit()
    }

    fn method(&self) -> Method {
        self.plant.method()
    }
}

/// A whole rotor.
pub(crate) struct WholeRotor<'a> {
    scene: &'a MachineScene,
    machine: Machine,
    inputs: MachineInputs,
    /// Eccentricity of the centre of mass now, one of the unbalances \[m\].
    eccentricity_m: f64,
}

impl<'a> WholeRotor<'a> {
    pub(crate) fn new(scene: &'a MachineScene, options: Options) -> Result<Self, MachineError> {
        Ok(Self {
            machine: Machine::new(&scene.machine, &scene.start, options)?,
            inputs: MachineInputs {
                commands_n: vec![V2::zeros(); scene.machine.magnets.len()],
                loads_n: vec![V2::zeros(); scene.loads.len()],
            },
            eccentricity_m: scene.eccentricity_m,
            scene,
        })
    }
}

/// A plane of a machine as one that stands alone is read.
fn of_plane(scene: &MachineScene, plane: usize, now: &MachineSnapshot) -> Option<Snapshot> {
    let p = now.planes().nth(plane)?;
    let magnet = scene.planes[plane].magnet;
    Some(Snapshot {
        t_s: now.t_s,
        position_m: p.rotor.position - scene.machine.planes[plane].centre_m,
        velocity_m_s: p.rotor.velocity,
        inner_ring: p.ring,
        outer_ring: p.outer_ring,
        spin_rad_s: now.spin_rad_s,
        race_spin_rad_s: p.race_spin_rad_s,
        mode: p.mode,
        penetration_m: p.penetration_m,
        normal_force_n: p.normal_force_n,
        sliding_force_n: p.sliding_force_n,
        rolling_force_n: p.rolling_force_n,
        contact_tangential_speed_m_s: p.whirl_speed_m_s,
        sliding_speed_m_s: p.sliding_speed_m_s,
        delivered_n: (magnet.and_then(|m| now.delivered_n().nth(m))).unwrap_or_default(),
        whirl_angle_rad: p.whirl_angle_rad,
    })
}

impl Rig for WholeRotor<'_> {
    fn advance(
        &mut self,
        to_s: f64,
        commands_n: &[V2],
        loads_n: &[V2],
        changes: &mut Vec<(usize, Snapshot)>,
    ) -> Result<(), PlantError> {
        for (plane, command_n) in self.scene.planes.iter().zip(commands_n) {
            if let Some(magnet) = plane.magnet {
                self.inputs.commands_n[magnet] = *command_n;
            }
        }
        self.inputs.loads_n.copy_from_slice(loads_n);
        let scene = self.scene;
        (self.machine).advance(to_s, &self.inputs, &mut |plane, now| {
            changes.extend(of_plane(scene, plane, now).map(|now| (plane, now)));
        })
    }

    fn read(&mut self, now: &mut Vec<Snapshot>) {
        let snapshot = self.machine.snapshot();
        now.clear();
        let planes = 0..self.scene.planes.len();
        now.extend(planes.filter_map(|plane| of_plane(self.scene, plane, &snapshot)));
    }

    fn sensed_m(&self, plane: usize, _now: &Snapshot) -> V2 {
        let probe = self.machine.probe(plane);
        probe.map_or_else(V2::zeros, |probe| probe.position)
    }

    fn change(&mut self, change: &Change, unbalance: Option<Unbalance>) -> Result<(), ChangeError> {
        let eccentric = change.eccentricity_m.map(|eccentricity_m| {
            let more_m = eccentricity_m - self.eccentricity_m;
            self.eccentricity_m = eccentricity_m;
            Unbalance {
                position_m: 0.0,
                moment_kg_m: self.scene.machine.rotor.rigid().mass_kg * more_m.abs(),
                angle_rad: if more_m < 0.0 { PI } else { 0.0 },
            }
        });
        self.machine.change(&MachineChange {
            unbalance,
            friction_coefficient: change.friction_coefficient,
            drive_torque_n_m: change.drive_torque_n_m,
        })?;
        if eccentric.is_some() {
            self.machine.change(&MachineChange {
                unbalance: eccentric,
                ..MachineChange::default()
            })?;
        }
        Ok(())
    }

    fn meters(&self, plane: usize) -> Meters {
        self.machine.meters()[plane]
    }

    fn normal_impulse_n_s(&self, plane: usize) -> f64 {
        self.machine.plane_flows()[plane].normal_impulse_n_s
    }

    fn audit(&self) -> Audit {
        self.machine.audit()
    }

    fn warmth(&self, plane: usize) -> Option<Warmth> {
        self.machine.warmth(plane)
    }

    fn method(&self) -> Method {
        self.machine.method()
    }

    fn read_axis(&self, row: &mut AxisRow) {
        let modes = 0..self.scene.machine.rotor.bending().len();
        row.t_s = self.machine.t_s();
        row.axis = self.machine.axis();
        row.bending.clear();
        row.bending
            .extend(modes.filter_map(|mode| self.machine.bending(mode)));
    }
}
