//! Streams of samples: most go through every mode, with arbitrary bits in any field of some samples; in the others
//! every field of every sample has arbitrary bits.

use crate::rig;
use supervisor::{Config, CoreSample, PARAMETERS, Scalar, Status};

/// A fast random stream (xorshift), the same for the same seed.
#[derive(Debug, Default, Clone)]
pub struct Chance(u64);

impl Chance {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        let mut chance = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        for _ in 0..8 {
            chance.bits();
        }
        chance
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// In [0, 1).
    pub fn share(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }

    /// Once in so many.
    pub fn once_in(&mut self, n: u64) -> bool {
        (self.bits() >> 33).is_multiple_of(n)
    }

    /// Uniform between two limits.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.share()
    }
}

/// The configuration with what contradicts itself mended, or the bench's where ranges leave no room for that.
pub fn consistent(config: Config) -> Config {
    let mut config = config;
    for _ in 0..20 {
        let Err(error) = config.validate() else {
            return config;
        };
        let (Some(broken), Some(rule)) = (error.contradiction, error.rule()) else {
            break;
        };
        let p = &PARAMETERS[rule.index];
        let mut values = config.values();
        values[rule.index] = broken.limit.clamp(p.low, p.high);
        config = Config::from_values(values);
        // Mass makes a machine slow.
        if broken.limit < p.low && !rule.at_least || broken.limit > p.high && rule.at_least {
            config.mass_kg = (4.0 * config.mass_kg).min(1e6);
        }
    }
    match config.validate() {
        Ok(()) => config,
        Err(_) => rig::config(),
    }
}

/// A valid configuration: a bearing like the one on the bench, or, once in three, any value in the range of its
/// parameter; all of its magnitudes are as likely, and so is, once in eight, either end.
pub fn any_config(chance: &mut Chance) -> Config {
    if chance.once_in(3) {
        let mut values = PARAMETERS.iter().map(|p| {
            let low = p.low.max(p.high * 1e-9);
            let value = low * (p.high / low).powf(chance.share());
            // Stiffness has either sign, and what may be nothing sometimes is.
            match chance.bits() % 8 {
                0 => p.low,
                1 => p.high,
                2 | 3 if p.low < 0.0 => -value,
                2 | 3 if p.low == 0.0 => 0.0,
                _ => value.clamp(p.low, p.high),
            }
        });
        let values = [(); PARAMETERS.len()].map(|()| values.next().unwrap_or(1.0));
        return consistent(Config::from_values(values));
    }
    let mut factor = |low: f32, high: f32| low * (high / low).powf(chance.share());
    let bench = rig::config();
    consistent(Config {
        mass_kg: bench.mass_kg * factor(0.3, 3.0),
        force_max_n: 1000.0 * factor(0.1, 10.0),
        axis_force_max_n: 1000.0 * factor(0.1, 20.0),
        force_slew_n_s: 2e7 * factor(1e-3, 1e3),
        continuous_force_n: 1000.0 * factor(0.02, 20.0),
        thermal_time_s: factor(0.01, 1.0),
        amplifier_lag_s: factor(1e-6, 1e-3),
        delay_samples: factor(0.3, 7.0),
        friction_coefficient: factor(0.01, 0.5),
        observer_pole_flight: factor(0.2, 0.98),
        handover_dwell_s: factor(5e-5, 1e-3),
        severity_limit: factor(1e-3, 1e8),
        ..bench
    })
}

/// What the rotor does for some ticks.
#[derive(Debug, Default, Clone, Copy)]
enum Course {
    /// Near the centre.
    #[default]
    Levitates,
    /// Straight through the clearance, back from the wall.
    Bounces,
    /// Round on the wall.
    Whirls,
    /// On the wall.
    Lies,
}

/// Samples without end.
#[derive(Debug, Default, Clone)]
pub struct Storm {
    chance: Chance,
    course: Course,
    left: u32,
    position: [f32; 2],
    velocity: [f32; 2],
    angle: f32,
    angle_step: f32,
    sequence: u32,
    status: u32,
    spin: f32,
    /// Nothing but arbitrary bits.
    wild: bool,
}

impl Storm {
    /// From a seed; one in eight is wild.
    pub fn new(seed: u64) -> Self {
        let mut chance = Chance::new(seed);
        Self {
            wild: chance.once_in(8),
            chance,
            ..Self::default()
        }
    }

    fn turn(&mut self) {
        let chance = &mut self.chance;
        self.left = 20 + (chance.bits() >> 40) as u32 % 300;
        self.course = match chance.bits() >> 62 {
            0 => Course::Levitates,
            1 => Course::Bounces,
            2 => Course::Whirls,
            _ => Course::Lies,
        };
        self.velocity = [chance.between(-0.2, 0.2), chance.between(-0.2, 0.2)];
        self.angle_step = chance.between(-0.2, 0.2);
        self.spin = chance.between(-100.0, 100.0);
        // Mostly spin and bearing; other bits for as long as the course lasts.
        let bits = chance.bits() as u32;
        self.status = 3 | if chance.once_in(4) { bits & 0x7C } else { 0 };
    }

    /// Moves on by a tick.
    fn go(&mut self) {
        if self.left == 0 {
            self.turn();
        }
        self.left -= 1;
        self.angle += self.angle_step;
        if self.angle.abs() > 1e3 {
            self.angle = 0.0;
        }
        let radius = 1.01 + 0.005 * self.chance.share();
        let on_wall = |angle: f32| [radius * angle.cos(), radius * angle.sin()];
        match self.course {
            Course::Levitates => {
                self.position = [(); 2].map(|()| self.chance.between(-0.03, 0.03));
            }
            Course::Bounces => {
                for axis in 0..2 {
                    self.position[axis] += self.velocity[axis];
                }
                let [x, y] = self.position;
                let r = x.hypot(y);
                if r > 1.0 {
                    let along = (x * self.velocity[0] + y * self.velocity[1]) / r;
                    for axis in 0..2 {
                        let n = self.position[axis] / r;
                        self.velocity[axis] -= 1.7 * along.max(0.0) * n;
                        self.position[axis] = 1.01 * n;
                    }
                }
            }
            Course::Whirls => self.position = on_wall(self.angle),
            Course::Lies => self.position = on_wall(0.1 * (self.angle * 3.0).sin() - 1.5),
        }
    }
}

/// A number that can be made of any bits.
pub trait AnyBits: Scalar {
    /// From any bits.
    fn from_any_bits(bits: u64) -> Self;
    /// One unit in the last place of 1.
    const LAST_PLACE: f64;
    /// By how much a length that is found to be 1 may be longer.
    const TOO_LONG: f64;
    /// As `f64`, exactly.
    fn exact(self) -> f64;
}

/// What is odd among the numbers of floating point, once in sixteen.
fn odd(bits: u64) -> Option<f64> {
    const ODD: [f64; 8] = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f32::MAX as f64,
        f32::MIN_POSITIVE as f64,
        1e-40,
        0.0,
        -0.0,
    ];
    (bits >> 60 == 0).then_some(ODD[(bits >> 57) as usize % ODD.len()])
}

impl AnyBits for f32 {
    fn from_any_bits(bits: u64) -> Self {
        odd(bits).map_or(Self::from_bits(bits as u32), |x| x as Self)
    }
    const LAST_PLACE: f64 = f32::EPSILON as f64;
    const TOO_LONG: f64 = Self::LAST_PLACE;
    fn exact(self) -> f64 {
        f64::from(self)
    }
}

impl AnyBits for f64 {
    fn from_any_bits(bits: u64) -> Self {
        odd(bits).unwrap_or(Self::from_bits(bits))
    }
    const LAST_PLACE: f64 = f64::EPSILON;
    const TOO_LONG: f64 = Self::LAST_PLACE;
    fn exact(self) -> f64 {
        self
    }
}

impl AnyBits for supervisor::Q {
    fn from_any_bits(bits: u64) -> Self {
        Self::from_bits(bits as i32)
    }
    const LAST_PLACE: f64 = 1.0 / (1_u32 << 22) as f64;
    const TOO_LONG: f64 = 0.0;
    fn exact(self) -> f64 {
        f64::from(self.to_bits()) * Self::LAST_PLACE
    }
}

impl Storm {
    fn any_sample<S: AnyBits>(&mut self) -> CoreSample<S> {
        let mut bits = || self.chance.bits();
        CoreSample {
            sequence: bits() as u32,
            status: Status::from_bits_retain(bits() as u32),
            position: [(); 2].map(|()| S::from_any_bits(bits())),
            spin: S::from_any_bits(bits()),
            levitation: [(); 2].map(|()| S::from_any_bits(bits())),
            applied: [(); 2].map(|()| S::from_any_bits(bits())),
        }
    }

    /// The next sample: plausible, or, once in 16, with arbitrary bits in some of its fields; of a wild stream
    /// arbitrary bits in all of them.
    pub fn next_sample<S: AnyBits>(&mut self) -> CoreSample<S> {
        if self.wild {
            return self.any_sample();
        }
        self.go();
        self.sequence = self.sequence.wrapping_add(1);
        let chance = &mut self.chance;
        let mut forces = || [(); 2].map(|()| S::from_f32(chance.between(-1.2, 1.2)));
        let mut sample = CoreSample {
            sequence: self.sequence,
            status: Status::from_bits_retain(self.status),
            position: self.position.map(S::from_f32),
            spin: S::from_f32(self.spin),
            levitation: forces(),
            applied: forces(),
        };
        let odd = chance.bits();
        if odd >> 60 == 0 {
            let fields = odd as u16;
            let (at, spin) = (sample.position.iter_mut(), [&mut sample.spin]);
            let forces = sample.levitation.iter_mut().chain(&mut sample.applied);
            for (bit, number) in at.chain(spin).chain(forces).enumerate() {
                if fields & (1 << bit) != 0 {
                    *number = S::from_any_bits(chance.bits());
                }
            }
            if fields & 0x180 == 0x180 {
                sample.status = Status::from_bits_retain(chance.bits() as u32);
            }
            if fields & 0x600 == 0x600 {
                // Some ticks missed, or any number at all.
                let bits = chance.bits();
                let ahead = if bits >> 62 == 0 {
                    bits as u32
                } else {
                    bits as u32 % 8
                };
                self.sequence = self.sequence.wrapping_add(ahead);
                sample.sequence = self.sequence;
            }
        }
        sample
    }
}
