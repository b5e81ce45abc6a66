//! Both ends of one rotor: a supervisor for each, which know of each other what two ends of a rigid body do.

use crate::beside::Tilting;
use crate::coeffs::Scaling;
use crate::config::Config;
use crate::record::Record;
use crate::shaft::{Place, Shaft, ShaftError};
use crate::signal::{Command, CoreCommand, CoreSample, Events, Sample, Status};
use crate::supervisor::Supervisor;
use crate::vec2::Vec2;

/// Couplings beyond this are of no rotor, and would leave the numbers.
const MOST_COUPLED: f32 = 1e3;

/// What couples a plane to the other, per unit.
#[derive(Debug, Clone, Copy)]
struct Coupling {
    /// Acceleration here per cap of the other magnet.
    per_cap: f32,
    /// z over the distance of the planes, times metres a second per unit of each plane's speed, here per unit.
    arm: [f32; 2],
    /// I_p/I_t.
    nutation: f32,
    /// A radian in a tick \[1/t₀\]: nothing that is sampled nutates faster.
    fastest: f32,
}

impl Coupling {
    /// Both, once everything is known to be in its range.
    fn of_checked(shaft: &Shaft, [first, second]: &[Config; 2]) -> Result<[Self; 2], ShaftError> {
        shaft.check()?;
        for (end, config) in [(0, first), (1, second)] {
            config
                .validate()
                .map_err(|error| ShaftError::Plane(end, error))?;
        }
        let [a, b] = shaft.places;
        let period_s = first.sample_period_s;
        let (first, second) = (first.scaling(), second.scaling());
        let gap_m = b.retainer_m - a.retainer_m;
        let of = |here: Place, there: Place, own: &Scaling, other: &Scaling| {
            let share = here.retainer_m / gap_m / own.speed_m_s();
            let acceleration = shaft.mobility(here.retainer_m, there.magnet_m) * other.force_n;
            Self {
                per_cap: acceleration * own.time_s * own.time_s / own.length_m,
                arm: [-share * first.speed_m_s(), share * second.speed_m_s()],
                nutation: shaft.polar_inertia_kg_m2 / shaft.transverse_inertia_kg_m2,
                fastest: own.time_s / period_s,
            }
        };
        let both = [of(a, b, &first, &second), of(b, a, &second, &first)];
        let held = |x: f32| x.abs() <= MOST_COUPLED;
        let usable = |c: &Self| held(c.per_cap) && c.arm.iter().all(|arm| held(*arm));
        if both.iter().all(usable) {
            Ok(both)
        } else {
            Err(ShaftError::Places)
        }
    }

    /// What the plane knows of the rest: from the velocities of both ends, and the force at the other.
    fn tilting(
        &self,
        [first, second]: [Vec2<f32>; 2],
        force: Vec2<f32>,
        spin: f32,
    ) -> Tilting<f32> {
        let rate = self.nutation * spin;
        Tilting {
            known: force * self.per_cap,
            velocity: first * self.arm[0] + second * self.arm[1],
            rate: if rate.abs() <= self.fastest {
                rate
            } else {
                0.0
            },
        }
    }
}

/// What both planes commanded at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RotorCommand {
    /// Each plane its own.
    pub planes: [Command; 2],
    /// For each plane, whether the other one has engaged since the records were read: hold back what would disturb now
    /// (excitation, a set-down, a reconfiguration).
    pub other_engaged: [bool; 2],
    /// One plane has asked for the machine to be run down. Stays until [`Rotor::new`].
    pub coast_down: bool,
}

/// Supervisor of a rotor in two radial bearings, with flight records of `RECORD` ticks (a power of two) for each.
///
/// ```
/// use supervisor::{Config, Place, Rotor, Sample, Shaft, Status};
///
/// let end = |retainer_m: f32| Place { retainer_m, sensor_m: 0.9 * retainer_m, magnet_m: 0.8 * retainer_m };
/// let shaft = Shaft {
///     mass_kg: 20.0,
///     transverse_inertia_kg_m2: 0.8,
///     polar_inertia_kg_m2: 0.3,
///     places: [end(-0.2), end(0.25)],
/// };
/// let mut rotor = Rotor::<512>::new(&shaft, &[Config::example(); 2])?;
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
pub struct Rotor<const RECORD: usize = 512> {
    shaft: Shaft,
    /// The shaft when the states of both planes were kept.
    kept_shaft: Shaft,
    planes: [Supervisor<RECORD>; 2],
    couplings: [Coupling; 2],
    /// Planes that have engaged since the records were read.
    engaged: [bool; 2],
    coast_down: bool,
}

impl<const RECORD: usize> Rotor<RECORD> {
    /// A supervisor that starts levitated. In each plane's configuration, mass and ratios are those that follow from the
    /// shaft; stiffness is that of the plane, as for one that stands alone.
    ///
    /// # Errors
    /// [`ShaftError`].
    pub fn new(shaft: &Shaft, [first, second]: &[Config; 2]) -> Result<Self, ShaftError> {
        Self::as_told(shaft, &[shaft.plane(0, first), shaft.plane(1, second)])
    }

    /// The same with masses and ratios as the configurations say.
    ///
    /// # Errors
    /// [`ShaftError`].
    pub fn as_told(shaft: &Shaft, configs: &[Config; 2]) -> Result<Self, ShaftError> {
        let couplings = Coupling::of_checked(shaft, configs)?;
        let [first, second] = configs;
        Ok(Self {
            shaft: *shaft,
            kept_shaft: *shaft,
            planes: [
                Supervisor::from_valid(first, [0, 2]),
                Supervisor::from_valid(second, [1, 2]),
            ],
            couplings,
            engaged: [false; 2],
            coast_down: false,
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
        let configs = [shaft.plane(0, first), shaft.plane(1, second)];
        self.couplings = Coupling::of_checked(shaft, &configs)?;
        self.shaft = *shaft;
        for (plane, config) in self.planes.iter_mut().zip(&configs) {
            // Checked above.
            let _ = plane.reconfigure(config);
        }
        Ok(())
    }

    /// One tick of both, in the control interrupt. Both samples carry the number of one counter.
    pub fn tick(&mut self, samples: &[Sample; 2]) -> RotorCommand {
        let [first, second] = &self.planes;
        let [at_first, at_second] = samples;
        let per_unit = [
            first.core.scaling().sample(at_first),
            second.core.scaling().sample(at_second),
        ];
        let [to_first, to_second] = self.tick_per_unit(&per_unit);
        let [first, second] = &self.planes;
        let planes = [
            first.in_newtons(at_first, &per_unit[0], &to_first),
            second.in_newtons(at_second, &per_unit[1], &to_second),
        ];
        for ((engaged, plane), command) in self.engaged.iter_mut().zip(&self.planes).zip(&planes) {
            let engages = command.mode.is_engaged();
            // Over, and nothing was worth a record.
            let leaves_nothing = !engages && plane.core.is_armed();
            *engaged = (*engaged || engages) && !leaves_nothing;
            self.coast_down |= command.events.contains(Events::COAST_DOWN);
        }
        let [first, second] = self.engaged;
        RotorCommand {
            planes,
            other_engaged: [second, first],
            coast_down: self.coast_down,
        }
    }

    /// The same per unit of each plane, without what the whole machine is told: what a record is replayed with.
    pub fn tick_per_unit(&mut self, samples: &[CoreSample<f32>; 2]) -> [CoreCommand<f32>; 2] {
        let [first, second] = &mut self.planes;
        let [at_first, at_second] = samples;
        let [to_first, to_second] = &self.couplings;
        // As they are before either tick. Where one end's velocity is not known nothing is known of the tilt.
        let known = first.core.velocity().zip(second.core.velocity());
        let (v1, v2) = known.unwrap_or_default();
        let forces = [first.core.delivered(), second.core.delivered()];
        let beside_first = to_first.tilting([v1, v2], forces[1], spin(at_first));
        let beside_second = to_second.tilting([v1, v2], forces[0], spin(at_second));
        let (to_first, first) = first.core.tick_beside(at_first, &beside_first);
        let (to_second, second) = second.core.tick_beside(at_second, &beside_second);
        // One event of one machine: both planes record it, over the same ticks.
        let (mut commands, seen) = ([to_first, to_second], first.or(second));
        for ((plane, command), sample) in self.planes.iter_mut().zip(&mut commands).zip(samples) {
            command.events |= plane.core.advance(seen, sample, command.mode);
        }
        // Both or none: a replay needs what both remembered before the same tick.
        if self.planes.iter().all(|plane| plane.core.may_keep()) {
            self.planes.iter_mut().for_each(|plane| plane.core.keep());
            self.kept_shaft = self.shaft;
        }
        commands
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
        let mut rotor = Self::as_told(shaft, configs)?;
        for (plane, words) in rotor.planes.iter_mut().zip([first, second]) {
            plane.core.resume(words);
        }
        Ok(rotor)
    }

    /// The records of one event, in the background: where they have frozen, which both planes do at once, `write` gets
    /// them with the number of the plane, 0 or 1, and both wait for the next engagement.
    ///
    /// The tick has to be kept out meanwhile; where writing takes too long for that, take the sections of [`Self::record`]
    /// one by one and [`Self::rearm`] at the end.
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
        let [first, second] = &self.planes;
        let mut record = if end == 0 { first } else { second }.record()?;
        record.shaft = Some(self.kept_shaft.values());
        Some(record)
    }

    /// Discards frozen records; both planes wait for the next engagement.
    pub fn rearm(&mut self) {
        self.planes.iter_mut().for_each(Supervisor::rearm);
        self.engaged = [false; 2];
    }

    /// Supervisor of a plane, for its report and events; 0 or 1, and for anything else the second. Its ticks, configuration and
    /// record are the rotor's: they go with those of the other plane.
    pub fn plane(&mut self, end: usize) -> &mut Supervisor<RECORD> {
        let [first, second] = &mut self.planes;
        if end == 0 { first } else { second }
    }
}

/// The spin where it is known \[1/t₀\], else 0: then nothing is known to turn the tilt.
fn spin(sample: &CoreSample<f32>) -> f32 {
    let known = sample.status.contains(Status::SPIN_VALID) && sample.spin.is_finite();
    if known { sample.spin } else { 0.0 }
}
