//! What acts on the rotor from outside and comes and goes: forces, the motion of the base,
//! and parameters that change.

use plant_model::{Change, V2};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Course over its interval.
#[derive(Debug, Clone, PartialEq, Default)]
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
    /// The amplitude along x and y times those of a file.
    Recorded(Arc<Course>),
}

/// A course that a file has: straight from point to point, and nothing before the first and after the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// The file.
    pub file: String,
    /// Times from the start of the interval on, rising, and values \[1\].
    points: Vec<(f64, V2)>,
}

impl Course {
    /// `None` where there are not two points, or times do not rise, or something is not finite.
    pub(crate) fn new(file: String, points: Vec<(f64, V2)>) -> Option<Self> {
        let rises = points.windows(2).all(|w| w[1].0 > w[0].0);
        let finite = |(t, v): &(f64, V2)| t.is_finite() && v.iter().all(|x| x.is_finite());
        (points.len() > 1 && rises && points.iter().all(finite)).then_some(Self { file, points })
    }

    /// The last of its times \[s\].
    pub(crate) fn end_s(&self) -> f64 {
        self.points.last().map_or(0.0, |(t_s, _)| *t_s)
    }

    /// Points from the last at or before a time on.
    fn points_from(&self, t_s: f64) -> &[(f64, V2)] {
        let after = self.points.partition_point(|(at_s, _)| *at_s <= t_s);
        &self.points[after.saturating_sub(1)..]
    }

    fn value(&self, t_s: f64) -> V2 {
        match self.points_from(t_s) {
            [(a_s, a), (b_s, b), ..] if *a_s <= t_s => a + (b - a) * ((t_s - a_s) / (b_s - a_s)),
            [(a_s, a)] if *a_s == t_s => *a,
            _ => V2::zeros(),
        }
    }

    /// What to hold over the two halves of a part: with its momentum and the first moment of that.
    fn halves(&self, from_s: f64, to_s: f64) -> [V2; 2] {
        let half_s = 0.5 * (to_s - from_s);
        if half_s <= 0.0 {
            return [self.value(from_s); 2];
        }
        let [mut momentum, mut moment] = [V2::zeros(); 2];
        for pair in self.points_from(from_s).windows(2) {
            let [(a_s, _), (b_s, _)] = [pair[0], pair[1]];
            if a_s >= to_s {
                break;
            }
            let (begin_s, end_s) = (a_s.max(from_s), b_s.min(to_s));
            let [begin, end] = [begin_s, end_s]
                .map(|t_s| pair[0].1 + (pair[1].1 - pair[0].1) * ((t_s - a_s) / (b_s - a_s)));
            let (p, q) = (begin_s - from_s, end_s - from_s);
            momentum += (begin + end) * (0.5 * (q - p));
            moment += (begin * (2.0 * p + q) + end * (p + 2.0 * q)) * ((q - p) / 6.0);
        }
        let (mean, slope) = (momentum / half_s, moment / (half_s * half_s));
        let second = slope - 0.5 * mean;
        [mean - second, second]
    }

    /// Parts as long as from point to point, on the average.
    fn parts(&self, stretch_s: f64) -> u32 {
        let intervals = (self.points.len() - 1) as f64;
        let first_s = self.points.first().map_or(0.0, |(t_s, _)| *t_s);
        (stretch_s * intervals / (self.end_s() - first_s))
            .ceil()
            .max(1.0) as u32
    }
}

/// What varies is held over the halves of parts of at most this phase \[rad\], at two forces that give a part its momentum and
/// the first moment of it exactly: a free mass is at the end of a part where it should be, and the amplitude of a motion is
/// wrong by (phase/2)⁴/60 at most, 2e-8.
const PART_RAD: f64 = 1.0 / 16.0;

impl Shape {
    /// Angular frequency and phase at the start; `None` for a constant.
    fn sine(&self, duration_s: f64) -> Option<(f64, f64)> {
        match *self {
            Self::Constant | Self::Recorded(_) => None,
            Self::HalfSine => Some((PI / duration_s, 0.0)),
            Self::Sine {
                frequency_hz,
                phase_rad,
            } => Some((TAU * frequency_hz, phase_rad)),
        }
    }

    /// What to hold over the two halves of a part of the interval, as shares of the amplitude along x and y.
    fn halves(&self, (start_s, duration_s): (f64, f64), (from_s, to_s): (f64, f64)) -> [V2; 2] {
        if let Self::Recorded(course) = self {
            return course.halves(from_s - start_s, to_s - start_s);
        }
        let Some((rate, phase)) = self.sine(duration_s) else {
            return [V2::repeat(1.0); 2];
        };
        let half = 0.5 * rate * (to_s - from_s);
        let (sin, cos) = (rate * (0.5 * (from_s + to_s) - start_s) + phase).sin_cos();
        // Series of sin x/x and of 2·(sin x − x·cos x)/x², with less than 1e-16 left over up to a tenth.
        let square = half * half;
        let mean = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0));
        let slope =
            half * (2.0 / 3.0 - square / 15.0 * (1.0 - square / 28.0 * (1.0 - square / 54.0)));
        [-1.0, 1.0].map(|sign| V2::repeat(mean * sin + sign * slope * cos))
    }

    /// Parts over which a stretch of the interval is held; `None` for a constant.
    fn parts(&self, duration_s: f64, stretch_s: f64) -> Option<u32> {
        if let Self::Recorded(course) = self {
            return Some(course.parts(stretch_s));
        }
        let (rate, _) = self.sine(duration_s)?;
        Some((rate.abs() * stretch_s / PART_RAD).ceil().max(1.0) as u32)
    }
}

/// A force on the rotor for a while.
#[derive(Debug, Clone, PartialEq, Default)]
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
#[derive(Debug, Clone, PartialEq)]
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
                .map(|share| share.component_mul(&self.force_n)),
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
            shape: self.shape.clone(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recorded_course_keeps_momentum_and_its_moment_over_any_part() {
        let points = [(0.1, [1.0, 0.0]), (0.2, [-3.0, 2.0]), (0.25, [0.5, 2.0])];
        let points = points.map(|(t, v)| (t, V2::from(v))).to_vec();
        let course = Course::new("f.csv".to_owned(), points).unwrap();
        // Within a piece, over corners, and from before the first to after the last point.
        for (from_s, to_s) in [(0.12, 0.13), (0.15, 0.24), (0.0, 0.5), (0.25, 0.3)] {
            let (mut momentum, mut moment, steps) = (V2::zeros(), V2::zeros(), 200_000);
            let step = (to_s - from_s) / f64::from(steps);
            for i in 0..steps {
                let after = (f64::from(i) + 0.5) * step;
                momentum += step * course.value(from_s + after);
                moment += step * after * course.value(from_s + after);
            }
            let half = 0.5 * (to_s - from_s);
            let [first, second] = course.halves(from_s, to_s);
            let held = [
                half * (first + second),
                half * half * (0.5 * first + 1.5 * second),
            ];
            assert!(
                (held[0] - momentum).norm() < 1e-5 * (to_s - from_s),
                "{from_s}"
            );
            assert!(
                (held[1] - moment).norm() < 1e-5 * (to_s - from_s),
                "{from_s}"
            );
        }
        assert_eq!(course.halves(0.2, 0.2), [V2::new(-3.0, 2.0); 2]);
        assert_eq!(course.halves(0.3, 0.4), [V2::zeros(); 2]);
        assert_eq!(course.parts(0.15), 2);
    }

    #[test]
    fn a_course_that_does_not_rise_is_none() {
        let two = |t: [f64; 2], x: f64| {
            let points = t.map(|t| (t, V2::repeat(x))).to_vec();
            Course::new(String::new(), points)
        };
        assert!(two([0.0, 1.0], 1.0).is_some());
        for none in [
            two([0.0, 0.0], 1.0),
            two([1.0, 0.0], 1.0),
            two([0.0, 1.0], f64::NAN),
        ] {
            assert!(none.is_none());
        }
        assert!(Course::new(String::new(), vec![(0.0, V2::zeros())]).is_none());
    }
}
