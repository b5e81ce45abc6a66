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

/// What varies is held over parts of at most this phase \[rad\]. Parts are held at their mean, so that
/// every part gives its momentum exactly; the amplitude of a motion is then wrong by phase²/12 at most,
/// 8e-5.
const PART_RAD: f64 = 1.0 / 32.0;

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

    /// Mean over a part of the interval, as a share of the amplitude.
    fn mean(&self, (start_s, duration_s): (f64, f64), (from_s, to_s): (f64, f64)) -> f64 {
        let Some((rate, phase)) = self.sine(duration_s) else {
            return 1.0;
        };
        let half = 0.5 * rate * (to_s - from_s);
        let middle = rate * (0.5 * (from_s + to_s) - start_s) + phase;
        let narrow = if half == 0.0 { 1.0 } else { half.sin() / half };
        middle.sin() * narrow
    }

    /// Parts in which a stretch of the interval is held.
    fn parts(&self, duration_s: f64, stretch_s: f64) -> u32 {
        let phase = self.sine(duration_s).map_or(0.0, |(rate, _)| rate);
        (phase.abs() * stretch_s / PART_RAD).ceil().max(1.0) as u32
    }
}

/// A force on the rotor for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
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
}

impl BaseMotion {
    /// End \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// The inertial force that a mass feels.
    pub fn on_mass(&self, mass_kg: f64) -> Disturbance {
        Disturbance {
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

/// Mean of all forces from one time to another, between which none begins or ends \[N\].
pub(crate) fn mean_n(
    loads: impl Iterator<Item = Disturbance>,
    constant_n: V2,
    (from_s, to_s): (f64, f64),
) -> V2 {
    let acting = |d: &Disturbance| d.start_s <= from_s && from_s < d.end_s();
    loads.filter(acting).fold(constant_n, |sum, d| {
        let share = (d.shape).mean((d.start_s, d.duration_s), (from_s, to_s));
        sum + share * d.force_n
    })
}

/// Parts in which the forces from one time to another are to be held.
pub fn parts(loads: impl Iterator<Item = Disturbance>, (from_s, to_s): (f64, f64)) -> u32 {
    let acting = |d: &Disturbance| d.start_s <= from_s && from_s < d.end_s();
    loads
        .filter(acting)
        .map(|d| d.shape.parts(d.duration_s, to_s - from_s))
        .max()
        .unwrap_or(1)
}

/// Ends of the parts into which a stretch is cut; the last is its end to the bit.
pub fn cuts((from_s, to_s): (f64, f64), parts: u32) -> impl Iterator<Item = f64> {
    (1..=parts).map(move |i| {
        if i == parts {
            to_s
        } else {
            from_s + (to_s - from_s) * f64::from(i) / f64::from(parts)
        }
    })
}
