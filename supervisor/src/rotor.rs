//! Both ends of one rotor: a supervisor for each, which know of each other what two ends of a rigid body do.

use crate::beside::Tilting;
use crate::coeffs::Scaling;
use crate::config::{Config, ConfigError};
use crate::recorder::Record;
use crate::signal::{Command, Events, Sample, Status};
use crate::supervisor::Supervisor;
use crate::vec2::Vec2;

/// Where a plane has what, along the axis from the centre of mass \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Retainer bearing.
    pub retainer_m: f32,
    /// Sensor.
    pub sensor_m: f32,
    /// Magnet.
    pub magnet_m: f32,
}

/// A rigid rotor, as a data sheet has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// Mass \[kg\], > 0.
    pub mass_kg: f32,
    /// Transverse moment of inertia I_t about the centre of mass \[kg m²\], > 0.
    pub transverse_inertia_kg_m2: f32,
    /// Polar moment of inertia I_p \[kg m²\], 0 to 2·I_t.
    pub polar_inertia_kg_m2: f32,
    /// Its two ends.
    pub places: [Place; 2],
}

/// Why there is no supervisor for a rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShaftError {
    /// A parameter of a plane, 0 or 1, is outside its range.
    Plane(usize, ConfigError),
    /// Mass or inertias are not what a body can have.
    Inertia,
    /// A position is no number, both retainer bearings stand at one place, or so far from each other or from the magnets that
    /// the ends move each other a thousand times as far as themselves.
    Places,
}

impl core::fmt::Display for ShaftError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Plane(plane, error) => write!(f, "plane {plane}: {error}"),
            Self::Inertia => f.write_str(
                "mass and transverse inertia are to be above 0, the polar one from 0 to twice the transverse one",
            ),
            Self::Places => f.write_str(
                "positions are to be numbers, those of the two retainer bearings to differ, and no other so far out",
            ),
        }
    }
}

impl core::error::Error for ShaftError {}

impl Shaft {
    /// Velocity at one place by an impulse at another, 1/m + z_i·z_j/I_t \[1/kg\].
    pub fn mobility(&self, at_m: f32, of_m: f32) -> f32 {
        1.0 / self.mass_kg + at_m * of_m / self.transverse_inertia_kg_m2
    }

    /// A plane's configuration with the mass that an impact there moves, and the ratios in which its sensor and its magnet
    /// move with it; 0 or 1, and for anything else the second.
    pub fn plane(&self, end: usize, config: &Config) -> Config {
        let [first, second] = self.places;
        let place = if end == 0 { first } else { second };
        let own = self.mobility(place.retainer_m, place.retainer_m);
        Config {
            mass_kg: 1.0 / own,
            retainer_plane_ratio: own / self.mobility(place.sensor_m, place.retainer_m),
            magnet_plane_ratio: self.mobility(place.magnet_m, place.retainer_m) / own,
            ..*config
        }
    }

    fn check(&self) -> Result<(), ShaftError> {
        let (transverse, polar) = (self.transverse_inertia_kg_m2, self.polar_inertia_kg_m2);
        let body = self.mass_kg > 0.0 && transverse > 0.0;
        let finite = self.mass_kg.is_finite() && transverse.is_finite();
        if !(body && finite && polar >= 0.0 && polar <= 2.0 * transverse) {
            return Err(ShaftError::Inertia);
        }
        let [first, second] = self.places;
        let place =
            |p: Place| p.retainer_m.is_finite() && p.sensor_m.is_finite() && p.magnet_m.is_finite();
        if place(first) && place(second) && first.retainer_m != second.retainer_m {
            Ok(())
        } else {
            Err(ShaftError::Places)
        }
    }
}

/// Couplings beyond this are of no rotor, and would leave the numbers.
const MOST_COUPLED: f32 = 1e3;

/// What couples a plane to the other, per unit.
#[derive(Debug, Clone, Copy)]
struct Coupling {
    /// Acceleration here per cap of the other magnet.
    per_cap: f32,
    /// z over the distance of the planes, times metres a second per unit of each plane's speed, here per unit.
    arm: [f32; 2],
    /// (I_p/I_t)·t₀.
    nutation_s: f32,
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
                nutation_s: shaft.polar_inertia_kg_m2 / shaft.transverse_inertia_kg_m2 * own.time_s,
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
        spin_rad_s: f32,
    ) -> Tilting<f32> {
        let rate = self.nutation_s * spin_rad_s;
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
            planes: [
                Supervisor::from_valid(first),
                Supervisor::from_valid(second),
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
        for (plane, config) in self.planes.iter_mut().zip(&configs) {
            // Checked above.
            let _ = plane.reconfigure(config);
        }
        Ok(())
    }

    /// One tick of both, in the control interrupt. Both samples carry the number of one counter.
    pub fn tick(&mut self, samples: &[Sample; 2]) -> RotorCommand {
        let [first, second] = &mut self.planes;
        let [at_first, at_second] = samples;
        let [to_first, to_second] = &self.couplings;
        // As they are before either tick. Where one end's velocity is not known nothing is known of the tilt.
        let known = first.core.velocity().zip(second.core.velocity());
        let (v1, v2) = known.unwrap_or_default();
        let forces = [first.core.delivered(), second.core.delivered()];
        let beside_first = to_first.tilting([v1, v2], forces[1], spin(at_first));
        let beside_second = to_second.tilting([v1, v2], forces[0], spin(at_second));
        let planes = [
            first.tick_beside(at_first, &beside_first),
            second.tick_beside(at_second, &beside_second),
        ];
        for ((engaged, plane), command) in self.engaged.iter_mut().zip(&self.planes).zip(&planes) {
            let engages = command.mode.is_engaged();
            // Over, and nothing was worth a record.
            let leaves_nothing = !engages && plane.core.recorder().is_armed();
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

    /// The records of one event, in the background: once every plane that engaged has frozen its own, `write` gets
    /// what there is with the number of its plane, 0 or 1, and both wait for the next engagement.
    ///
    /// The tick has to be kept out meanwhile; where writing takes too long for that, copy the entries of [`Self::record`]
    /// in pieces and [`Self::rearm`] at the end.
    pub fn collect(&mut self, mut write: impl FnMut(usize, &Record<'_, RECORD>)) {
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

    /// The frozen record of a plane, 0 or 1 (anything else is the second), if there is one and no other belongs to the
    /// same event that has still to freeze: a plane that engages while the other's record waits delays the reading, and
    /// is then in it.
    pub fn record(&self, end: usize) -> Option<Record<'_, RECORD>> {
        let mut planes = self.planes.iter();
        if planes.any(|plane| plane.core.recorder().is_recording()) {
            return None;
        }
        let [first, second] = &self.planes;
        if end == 0 { first } else { second }.record()
    }

    /// Discards frozen records; both planes wait for the next engagement.
    pub fn rearm(&mut self) {
        self.planes.iter_mut().for_each(Supervisor::rearm);
        self.engaged = [false; 2];
    }

    /// Supervisor of a plane, for its report, record and events; 0 or 1, and for anything else the second.
    pub fn plane(&mut self, end: usize) -> &mut Supervisor<RECORD> {
        let [first, second] = &mut self.planes;
        if end == 0 { first } else { second }
    }
}

/// The spin where it is known \[rad/s\], else 0: then nothing is known to turn the tilt.
fn spin(sample: &Sample) -> f32 {
    let known = sample.status.contains(Status::SPIN_VALID) && sample.spin_rad_s.is_finite();
    if known { sample.spin_rad_s } else { 0.0 }
}
