//! What acts on the rotor from outside and comes and goes: forces, the motion of the base,
//! and parameters that change.

use plant_model::{Change, V2};
use std::f64::consts::{PI, TAU};

/// Course over its interval.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Shape {
    /// The amplitude all the time.
    #[default]
    Constant,
    /// Half a sine over the interval, the amplitude in its middle.
    HalfSine,
    /// amplitude·sin(2πf·(t − start) + phase).
    Sine {
        /// f \[Hz\].
        frequency_hz: f64,
        /// Phase at the start \[rad\].
        phase_rad: f64,
    },
}

/// What varies is held over the halves of parts of at most this phase \[rad\], at two forces that give a part its momentum and
/// the first moment of it exactly: a free mass is at the end of a part where it should be, and the amplitude of a motion is
/// wrong by (phase/2)⁴/60 at most, 2e-8.
const PART_RAD: f64 = 1.0 / 16.0;

impl Shape {
    /// Angular frequency and phase at the start; `None` for a constant.
    fn sine(&self, duration_s: f64) -> Option<(f64, f64)> {
        match *self {
            Self::Constant => None,
            Self::HalfSine => Some((PI / duration_s, 0.0)),
            Self::Sine {
                frequency_hz,
                phase_rad,
            } => Some((TAU * frequency_hz, phase_rad)),
        }
    }

    /// What to hold over the two halves of a part of the interval, as a share of the amplitude.
    fn halves(&self, (start_s, duration_s): (f64, f64), (from_s, to_s): (f64, f64)) -> [f64; 2] {
        let Some((rate, phase)) = self.sine(duration_s) else {
            return [1.0, 1.0];
        };
        let half = 0.5 * rate * (to_s - from_s);
        let (sin, cos) = (rate * (0.5 * (from_s + to_s) - start_s) + phase).sin_cos();
        // Series of sin x/x and of 2·(sin x − x·cos x)/x², with less than 1e-16 left over up to a tenth.
        let square = half * half;
        let mean = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0));
        let slope =
            half * (2.0 / 3.0 - square / 15.0 * (1.0 - square / 28.0 * (1.0 - square / 54.0)));
        [-1.0, 1.0].map(|sign| mean * sin + sign * slope * cos)
    }

    /// Parts over which a stretch of the interval is held; `None` for a constant.
    fn parts(&self, duration_s: f64, stretch_s: f64) -> Option<u32> {
        let (rate, _) = self.sine(duration_s)?;
        Some((rate.abs() * stretch_s / PART_RAD).ceil().max(1.0) as u32)
    }
}

/// A force on the rotor for a while.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Disturbance {
    /// Where along the axis, from the centre of mass \[m\].
    pub position_m: f64,
    /// Beginning \[s\].
    pub start_s: f64,
    /// Duration \[s\].
    pub duration_s: f64,
    /// Force \[N\]; the amplitude where it varies.
    pub force_n: V2,
    /// Its course.
    pub shape: Shape,
}

/// Motion of the housing that carries retainer bearing, magnets and sensors, felt by the rotor as an
/// inertial force. Only for a rigid stator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseMotion {
    /// Beginning \[s\].
    pub start_s: f64,
    /// Duration \[s\].
    pub duration_s: f64,
    /// Acceleration of the housing \[m/s²\]; the amplitude where it varies.
    pub acceleration_m_s2: V2,
    /// Its course.
    pub shape: Shape,
}

impl Disturbance {
    /// End \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    fn acts(&self, at_s: f64) -> bool {
        self.start_s <= at_s && at_s < self.end_s()
    }

    /// What to hold over the two halves of a part in which no load begins or ends \[N\].
    pub fn halves_n(&self, from_s: f64, to_s: f64) -> [V2; 2] {
        match self.acts(from_s) {
            true => (self.shape)
                .halves((self.start_s, self.duration_s), (from_s, to_s))
                .map(|share| share * self.force_n),
            false => [V2::zeros(); 2],
        }
    }

    /// Parts over which the force from one time to another is to be held; `None` where it does not vary.
    pub fn parts(&self, from_s: f64, to_s: f64) -> Option<u32> {
        match self.acts(from_s) {
            true => self.shape.parts(self.duration_s, to_s - from_s),
            false => None,
        }
    }
}

impl BaseMotion {
    /// End \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// The inertial force that a mass feels.
    pub(crate) fn on_mass(&self, mass_kg: f64) -> Disturbance {
        Disturbance {
            position_m: 0.0,
            start_s: self.start_s,
            duration_s: self.duration_s,
            force_n: -mass_kg * self.acceleration_m_s2,
            shape: self.shape,
        }
    }
}

/// Parameters of the plant that take other values at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedChange {
    /// When \[s\].
    pub at_s: f64,
    /// What.
    pub change: Change,
}

/// Beginning, middle and end of each of the parts into which a stretch is cut; the last end is that of the stretch to the bit.
pub fn cuts((from_s, to_s): (f64, f64), parts: u32) -> impl Iterator<Item = [f64; 3]> {
    let at = move |half: u32| match half {
        0 => from_s,
        half if half == 2 * parts => to_s,
        half => from_s + (to_s - from_s) * f64::from(half) / f64::from(2 * parts),
    };
    (0..parts).map(move |part| [0, 1, 2].map(|half| at(2 * part + half)))
}
