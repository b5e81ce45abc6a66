//! Both ends of one rotor: a supervisor for each, which know of each other what two ends of a rigid body do.

use crate::border::config::Config;
use crate::border::shaft::{Shaft, ShaftError};
use crate::border::signal::{CoreCommand, CoreSample, Sample};
use crate::number::words::{Cells, Words};
use crate::record::buffer::RecordBuffer;
use crate::record::publish::QueuedEvent;
use crate::record::recorder::Shared;
use crate::record::sections::Record;
use crate::rotor::ticker::{HalfTick, KeptShaft, MachineState, RotorCommand, RotorTicker};
use crate::supervisor::{Published, Reader, Supervisor};

/// Supervisor of a rotor in two radial bearings, with flight records of `RECORD` ticks (a power of two) for each.
///
/// ```
/// use supervisor::{Config, PlanePositions, RotorSupervisor, Sample, Shaft, Status};
///
/// let end = |retainer_m: f32| PlanePositions { retainer_m, sensor_m: 0.9 * retainer_m, magnet_m: 0.8 * retainer_m };
/// let shaft = Shaft {
///     mass_kg: 20.0,
///     transverse_inertia_kg_m2: 0.8,
///     polar_inertia_kg_m2: 0.3,
///     places: [end(-0.2), end(0.25)],
/// };
/// let mut rotor = RotorSupervisor::<512>::new(&shaft, &[Config::example(); 2])?;
/// let sample = Sample {
///     status: Status::SPIN_VALID | Status::BEARING_ON,
///     position_m: [1e-5, -2e-5],
///     spin_rad_s: 1000.0,
///     levitation_n: [-12.5, 25.0],
///     ..Sample::default()
/// };
/// let commands = rotor.tick(&[sample; 2]);
/// assert_eq!(commands.planes[1].force_n, [-12.5, 25.0]); // transparent while levitated
/// # Ok::<(), supervisor::ShaftError>(())
/// ```
#[derive(Debug, Clone)]
pub struct RotorSupervisor<const RECORD: usize = 512> {
    machine: RotorCore,
    planes: [Supervisor<RECORD>; 2],
}

/// A rotor without its planes, for memory that is made piece by piece: whoever has no stack for a whole [`RotorSupervisor`] makes this and
/// two supervisors in their places, and joins them.
#[derive(Debug, Clone)]
pub struct RotorCore {
    state: MachineState,
    kept_shaft: KeptShaft,
}

/// The half of a [`RotorSupervisor`] that reads; as a [`Reader`], of both planes. A plane is 0 or 1, and anything else the second.
#[derive(Debug)]
pub struct RotorReader<'a, const RECORD: usize = 512> {
    planes: [Reader<'a, f32, RECORD>; 2],
    kept_shaft: &'a KeptShaft,
}

impl<const RECORD: usize> RotorSupervisor<RECORD> {
    /// A supervisor that starts levitated. In each plane's configuration, mass and ratios are those that follow from the
    /// shaft; stiffness is that of the plane, as for one that stands alone.
    ///
    /// # Errors
    /// [`ShaftError`].
    pub fn new(shaft: &Shaft, [first, second]: &[Config; 2]) -> Result<Self, ShaftError> {
        Self::from_planes(shaft, &[shaft.plane(0, first), shaft.plane(1, second)])
    }

    /// The same with masses and ratios as the configurations say.
    ///
    /// # Errors
    /// [`ShaftError`].
    pub fn from_planes(shaft: &Shaft, configs: &[Config; 2]) -> Result<Self, ShaftError> {
        let machine = RotorCore::from_planes(shaft, configs)?;
        let [first, second] = configs;
        Ok(Self {
            machine,
            planes: [
                Supervisor::from_valid(first, [0, 2]),
                Supervisor::from_valid(second, [1, 2]),
            ],
        })
    }

    /// Takes another shaft and other configurations over, as [`Self::new`] does, to hold from the next tick on.
    ///
    /// # Errors
    /// [`ShaftError`]; then nothing has changed.
    pub fn reconfigure(
        &mut self,
        shaft: &Shaft,
        [first, second]: &[Config; 2],
    ) -> Result<(), ShaftError> {
        self.ticker().reconfigured(shaft, [first, second])
    }

    /// The half that ticks, by itself: for what counts its instructions.
    #[doc(hidden)]
    #[inline]
    pub fn ticker(&mut self) -> RotorTicker<'_, RECORD> {
        let [first, second] = &mut self.planes;
        self.machine.ticking([first, second])
    }

    /// Two halves for two priorities, as [`Supervisor::split`].
    pub fn split(&mut self) -> (RotorTicker<'_, RECORD>, RotorReader<'_, RECORD>) {
        let [first, second] = &mut self.planes;
        self.machine.join([first, second])
    }

    /// As [`RotorTicker::stimulus_n`].
    pub fn stimulus_n(&mut self) -> [[f32; 2]; 2] {
        self.ticker().stimulus_n()
    }

    /// One tick of both, in the control interrupt. Both samples carry the number of one counter.
    // One copy, whoever calls it: the self-test does, too.
    #[inline(never)]
    pub fn tick(&mut self, samples: &[Sample; 2]) -> RotorCommand {
        self.ticker().ticked(samples)
    }

    /// As [`RotorTicker::tick_first`].
    pub fn tick_first(&mut self, sample: &Sample) -> HalfTick {
        self.ticker().first_half(sample)
    }

    /// As [`RotorTicker::tick_second`].
    pub fn tick_second(&mut self, half: &HalfTick, sample: &Sample) -> RotorCommand {
        self.ticker().second_half(half, sample)
    }

    /// The same per unit of each plane, without the inputs of the whole machine: what a record is replayed with.
    pub fn tick_per_unit(&mut self, samples: &[CoreSample<f32>; 2]) -> [CoreCommand<f32>; 2] {
        self.ticker().per_unit(samples)
    }

    /// One that goes on from what another one remembered, as the records of both planes hold it; see [`crate::Core::resumed`].
    ///
    /// # Errors
    /// [`ShaftError`].
    pub fn resumed(
        shaft: &Shaft,
        configs: &[Config; 2],
        [first, second]: [&[u32]; 2],
    ) -> Result<Self, ShaftError> {
        let mut rotor = Self::from_planes(shaft, configs)?;
        for (plane, words) in rotor.planes.iter_mut().zip([first, second]) {
            plane.core.resume(words);
        }
        Ok(rotor)
    }

    /// The records of one event, in the background: where they have frozen, which both planes do at once, `write` gets
    /// them with the number of the plane, 0 or 1, and both wait for the next engagement.
    ///
    /// The tick has to be kept out meanwhile; a [`RotorReader`] reads with ticks between.
    pub fn collect(&mut self, mut write: impl FnMut(usize, &Record<'_, f32, RECORD>)) {
        let mut any = false;
        for end in [0, 1] {
            if let Some(record) = self.record(end) {
                write(end, &record);
                any = true;
            }
        }
        if any {
            self.rearm();
        }
    }

    /// The frozen record of a plane, 0 or 1 (anything else is the second), if there is one.
    pub fn record(&self, end: usize) -> Option<Record<'_, f32, RECORD>> {
        let planes = self.planes.each_ref().map(|plane| &plane.core.shared);
        record_of(planes, &self.machine.kept_shaft, end)
    }

    /// Discards frozen records; both planes wait for the next engagement.
    pub fn rearm(&mut self) {
        self.ticker().rearm();
    }

    /// Supervisor of a plane, for its report and events; 0 or 1, and for anything else the second. Its ticks, configuration and
    /// record are the rotor's: they go with those of the other plane.
    pub fn plane(&mut self, end: usize) -> &mut Supervisor<RECORD> {
        let [first, second] = &mut self.planes;
        if end == 0 { first } else { second }
    }
}

impl RotorCore {
    /// Of this shaft; and the configurations of its planes, with the masses and ratios that follow from it.
    ///
    /// # Errors
    /// [`ShaftError`].
    pub fn new(
        shaft: &Shaft,
        [first, second]: &[Config; 2],
    ) -> Result<(Self, [Config; 2]), ShaftError> {
        let configs = [shaft.plane(0, first), shaft.plane(1, second)];
        Ok((Self::from_planes(shaft, &configs)?, configs))
    }

    fn from_planes(shaft: &Shaft, configs: &[Config; 2]) -> Result<Self, ShaftError> {
        Ok(Self {
            state: MachineState::new(shaft, configs)?,
            kept_shaft: Cells::of(shaft.values().map(f32::to_bits)),
        })
    }

    #[inline]
    fn ticking<'a, const RECORD: usize>(
        &'a mut self,
        [first, second]: [&'a mut Supervisor<RECORD>; 2],
    ) -> RotorTicker<'a, RECORD> {
        let Supervisor { core: first, check } = first;
        let Supervisor {
            core: second,
            check: other,
        } = second;
        RotorTicker {
            machine: &mut self.state,
            planes: [&mut first.plane, &mut second.plane],
            checks: [check, other],
            shared: [&first.shared, &second.shared],
            kept_shaft: &self.kept_shaft,
        }
    }

    /// The halves of a rotor of these planes, made by [`Supervisor::of_rotor`]; as [`RotorSupervisor::split`].
    pub fn join<'a, const RECORD: usize>(
        &'a mut self,
        planes: [&'a mut Supervisor<RECORD>; 2],
    ) -> (RotorTicker<'a, RECORD>, RotorReader<'a, RECORD>) {
        let ticker = self.ticking(planes);
        ticker.publish(true);
        let reader = RotorReader {
            planes: ticker.shared.map(Reader::new),
            kept_shaft: ticker.kept_shaft,
        };
        (ticker, reader)
    }
}

/// The record of a plane, once both have frozen.
fn record_of<'a, const RECORD: usize>(
    [first, second]: [&'a Shared<RECORD>; 2],
    kept_shaft: &KeptShaft,
    end: usize,
) -> Option<Record<'a, f32, RECORD>> {
    let [first, second] = [Record::new(&first.buffer)?, Record::new(&second.buffer)?];
    let mut record = if end == 0 { first } else { second };
    record.shaft = Some(Words::decode(&mut kept_shaft.words()));
    Some(record)
}

impl<'a, const RECORD: usize> RotorReader<'a, RECORD> {
    fn plane(&mut self, end: usize) -> &mut Reader<'a, f32, RECORD> {
        let [first, second] = &mut self.planes;
        if end == 0 { first } else { second }
    }

    /// Next event of a plane, oldest first; as [`Reader::next_event`].
    pub fn next_event(&mut self, end: usize) -> Option<QueuedEvent> {
        self.plane(end).next_event()
    }

    /// The frozen record of a plane, once both have frozen, which they do at the same tick. It stays as it is until
    /// [`Self::rearm`].
    pub fn record(&self, end: usize) -> Option<Record<'_, f32, RECORD>> {
        let planes = self.planes.each_ref().map(Reader::shared);
        record_of(planes, self.kept_shaft, end)
    }

    pub(crate) fn tapes(&self) -> [&'a RecordBuffer<RECORD>; 2] {
        self.planes.each_ref().map(|plane| &plane.shared().buffer)
    }

    /// Gives frozen records back; with the next tick both planes wait for an engagement again. Without any nothing happens.
    pub fn rearm(&mut self) {
        self.planes.iter_mut().for_each(Reader::rearm);
    }

    /// For other tasks that want to know how a plane stands.
    pub fn published(&self, end: usize) -> Published<'a, f32, RECORD> {
        let [first, second] = &self.planes;
        if end == 0 { first } else { second }.published()
    }
}
