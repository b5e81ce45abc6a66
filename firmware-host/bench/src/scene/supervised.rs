//! The supervisor of a whole rotor: of the two planes that have a magnet each, however many others there are.

use crate::scene::{PlaneScene, Scene};
use supervisor::{PlanePositions, RotorSupervisor, Shaft, ShaftError};

impl Scene {
    /// The planes of its supervisor: those that have a magnet, where they are two.
    pub fn supervised(&self) -> Option<[usize; 2]> {
        let planes = self.planes.iter().enumerate();
        let mut with_magnet = planes.filter_map(|(i, plane)| plane.magnet.map(|_| i));
        let both = [with_magnet.next()?, with_magnet.next()?];
        with_magnet.next().is_none().then_some(both)
    }

    /// Those planes.
    pub(crate) fn supervised_planes(&self) -> Option<[&PlaneScene; 2]> {
        Some(self.supervised()?.map(|plane| &self.planes[plane]))
    }

    /// The rotor as the supervisor is configured: rigid, in two planes that have a magnet each; `None` of another.
    pub fn shaft(&self) -> Option<Shaft> {
        let place = |plane: usize| {
            let magnet = self.machine.magnets.get(self.planes[plane].magnet?)?;
            Some(PlanePositions {
                retainer_m: self.machine.planes[plane].position_m as f32,
                sensor_m: self.machine.probes_m[plane] as f32,
                magnet_m: magnet.position_m as f32,
            })
        };
        let [first, second] = self.supervised()?;
        let rigid = self.machine.rotor.rigid();
        Some(Shaft {
            mass_kg: rigid.mass_kg as f32,
            transverse_inertia_kg_m2: rigid.transverse_inertia_kg_m2 as f32,
            polar_inertia_kg_m2: rigid.polar_inertia_kg_m2 as f32,
            places: [place(first)?, place(second)?],
        })
    }

    /// The supervisor of the whole rotor, where there is one for it.
    pub fn supervisor(&self) -> Option<RotorSupervisor> {
        self.supervisor_recording()
    }

    /// The same with so many ticks in a record.
    pub(crate) fn supervisor_recording<const TICKS: usize>(
        &self,
    ) -> Option<RotorSupervisor<TICKS>> {
        let [first, second] = self.supervised_planes()?;
        let configs = [first.supervisor?, second.supervisor?];
        let made = match &self.configured_shaft {
            Some(shaft) => RotorSupervisor::new(shaft, &configs),
            None => RotorSupervisor::from_planes(&self.shaft()?, &configs),
        };
        made.ok()
    }

    /// Why there is none, where both planes have a configuration; with the second of them.
    pub(super) fn refused_by_supervisor(&self) -> Option<(usize, ShaftError)> {
        let shaft = self.shaft()?;
        let [first, second] = self.supervised_planes()?;
        let configs = [first.supervisor?, second.supervisor?];
        let error = RotorSupervisor::<4>::from_planes(&shaft, &configs).err()?;
        Some((self.supervised()?[1], error))
    }
}
