//! What a closed loop moves: a rotor in its planes.

use crate::device::loads::Disturbance;
use crate::run::trace::AxisRow;
use crate::scene::Scene;
use plant_model::energy::Audit;
use plant_model::machine::params::MachineParams;
use plant_model::machine::{Machine, MachineInputs, MachineSnapshot, Warmth};
use plant_model::params::ParamError;
use plant_model::{Change, Meters, Method, Options, PlantError, Snapshot, V2};

/// A machine whose planes are seen each from the centre of its retainer bearing.
pub(crate) struct Rig<'a> {
    scene: &'a Scene,
    machine: Machine,
    inputs: MachineInputs,
    /// Which of the machine's places for loads that of the scene's are.
    places: Vec<usize>,
    /// Whether the first is the centre of mass, for a push …
    pushed: bool,
    /// … beside the loads of the scene \[N\].
    push_n: V2,
}

impl<'a> Rig<'a> {
    pub(crate) fn new(scene: &'a Scene, options: Options) -> Result<Self, ParamError> {
        let params = MachineParams {
            loads_m: scene.load_places_m(),
            ..scene.machine.clone()
        };
        let place = |load: Disturbance| {
            let at = params.loads_m.iter().position(|z| *z == load.position_m);
            at.unwrap_or_default()
        };
        let places = scene.loads().map(place).collect();
        let pushed = scene.takes_push();
        Ok(Self {
            places,
            pushed,
            machine: Machine::new(&params, &scene.start, options)?,
            inputs: MachineInputs {
                commands_n: vec![V2::zeros(); params.magnets.len()],
                loads_n: vec![V2::zeros(); params.loads_m.len()],
            },
            push_n: V2::zeros(),
            scene,
        })
    }

    /// Carries it to a time under a command of each plane and a load of each place that are held \[N\]; changes of mode are
    /// put down with their plane.
    pub(crate) fn advance(
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
        self.inputs.loads_n.fill(V2::zeros());
        if let (true, Some(at_centre_n)) = (self.pushed, self.inputs.loads_n.first_mut()) {
            *at_centre_n = self.push_n;
        }
        for (place, load_n) in self.places.iter().zip(loads_n) {
            self.inputs.loads_n[*place] += load_n;
        }
        let scene = self.scene;
        (self.machine).advance(to_s, &self.inputs, &mut |plane, now| {
            changes.extend(of_plane(scene, plane, now).map(|now| (plane, now)));
        })
    }

    /// What can be read off each plane now.
    pub(crate) fn read(&mut self, now: &mut Vec<Snapshot>) {
        let snapshot = self.machine.snapshot();
        now.clear();
        let planes = 0..self.scene.planes.len();
        now.extend(planes.filter_map(|plane| of_plane(self.scene, plane, &snapshot)));
    }

    /// Where the rotor is at the sensor of a plane, as seen from the centre of the magnets \[m\].
    pub(crate) fn sensed_m(&self, plane: usize) -> V2 {
        let probe = self.machine.probe(plane);
        probe.map_or_else(V2::zeros, |probe| probe.position)
    }

    /// Has a force act on the centre of mass beside the loads, from now on \[N\], where that [takes](Scene::takes_push) one.
    pub(crate) fn push(&mut self, force_n: V2) {
        self.push_n = force_n;
    }

    /// Parameters that are others from now on.
    pub(crate) fn change(&mut self, change: &Change) -> Result<(), ParamError> {
        self.machine.change(change)
    }

    pub(crate) fn meters(&self, plane: usize) -> Meters {
        self.machine.meters()[plane]
    }

    /// ∫ f_n dt of a plane \[N s\].
    pub(crate) fn normal_impulse_n_s(&self, plane: usize) -> f64 {
        self.machine.plane_flows()[plane].normal_impulse_n_s
    }

    pub(crate) fn audit(&self) -> Audit {
        self.machine.audit()
    }

    /// How warm the bearing of a plane is, where that is modelled.
    pub(crate) fn warmth(&self, plane: usize) -> Option<Warmth> {
        self.machine.warmth(plane)
    }

    pub(crate) fn method(&self) -> Method {
        self.machine.method()
    }

    /// Reads the axis and the motion of its bending modes.
    pub(crate) fn read_axis(&self, row: &mut AxisRow) {
        let modes = 0..self.scene.machine.rotor.bending().len();
        row.t_s = self.machine.t_s();
        row.axis = self.machine.axis();
        row.bending.clear();
        row.bending
            .extend(modes.filter_map(|mode| self.machine.bending(mode)));
    }
}

/// A plane of a machine as one that stands alone is read.
fn of_plane(scene: &Scene, plane: usize, now: &MachineSnapshot) -> Option<Snapshot> {
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
