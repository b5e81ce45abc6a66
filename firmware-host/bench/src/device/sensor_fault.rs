//! What goes wrong with the position sensor for a while.

use crate::device::axis::Axis;
use plant_model::V2;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardUniform};
use std::f64::consts::TAU;

/// What begins or ends within this share of a period after a sample counts as there at the sample. Sample
/// times are products of a count and a period and may come out one rounding short of a scene's time.
pub(crate) const ROUND_OFF_PERIODS: f64 = 1e-6;

/// Up to when a sample at `t_s` sees what begins and ends \[s\].
pub(crate) fn seen_until_s(t_s: f64, period_s: f64) -> f64 {
    t_s + ROUND_OFF_PERIODS * period_s
}

/// Kinds of sensor faults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FaultKind {
    /// Reads as not a number.
    Nan,
    /// Reads as infinity.
    Infinity,
    /// Reads as zero.
    Zero,
    /// Reads as the upper end of the range.
    Rail,
    /// Repeats the last value under new sequence numbers.
    Stuck,
    /// Reads too much by a length \[m\].
    Offset(f64),
    /// Reads a multiple.
    Gain(f64),
    /// Reads with the other sign.
    Inverted,
    /// Reads y as x and x as y.
    Swapped,
    /// Has a multiple of its noise.
    Noise(f64),
    /// Now and then reads a jump to either side.
    Spikes {
        /// Jumps a second \[Hz\].
        rate_hz: f64,
        /// Size \[m\].
        size_m: f64,
    },
    /// Gives no new samples: the last one stays under its sequence number.
    Dropout,
    /// Reads what was so many samples ago.
    Delay(usize),
    /// Has a converter of so many bits over the range.
    Bits(u32),
    /// Reads an oscillation on top.
    Oscillation {
        /// Frequency \[Hz\].
        frequency_hz: f64,
        /// Amplitude \[m\].
        amplitude_m: f64,
    },
}

impl FaultKind {
    /// Whether it concerns the pair of axes and never one of them.
    pub fn concerns_both(&self) -> bool {
        matches!(self, Self::Swapped | Self::Dropout | Self::Delay(_))
    }
}

/// A sensor fault for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    /// Beginning \[s\].
    pub start_s: f64,
    /// Duration \[s\].
    pub duration_s: f64,
    /// What goes wrong.
    pub kind: FaultKind,
    /// Where.
    pub axis: Axis,
}

impl Fault {
    /// End \[s\].
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// Whether it is there at one of the samples of a run.
    pub(crate) fn is_seen(&self, samples: Samples) -> bool {
        samples.any_within(self.start_s, self.end_s())
    }
}

/// The samples of a run, which begins with the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Samples {
    period_s: f64,
    count: f64,
}

impl Samples {
    /// Whole ones, to the nearest, one at least.
    pub(crate) fn new(duration_s: f64, sample_rate_hz: f64) -> Self {
        Self {
            period_s: 1.0 / sample_rate_hz,
            count: (duration_s * sample_rate_hz).round().max(1.0),
        }
    }

    /// How many.
    pub(crate) fn count(self) -> u64 {
        self.count as u64
    }

    /// End of the last one's period \[s\].
    pub(crate) fn end_s(self) -> f64 {
        self.count * self.period_s
    }

    /// Whether one of them sees what begins and ends then.
    pub(crate) fn any_within(self, start_s: f64, end_s: f64) -> bool {
        let first = (start_s / self.period_s - ROUND_OFF_PERIODS)
            .ceil()
            .max(0.0);
        first < self.count && seen_until_s(first * self.period_s, self.period_s) < end_s
    }
}

/// Faults of a run. Those of the analogue part come before the converter, the others after it.
#[derive(Debug, Clone)]
pub(crate) struct Faults {
    all: Vec<Fault>,
    period_s: f64,
    range_m: f64,
    /// A stream apart from the sensor's noise, which faults must not shift.
    chance: ChaCha8Rng,
}

impl Faults {
    pub(crate) fn new(
        all: &[Fault],
        period_s: f64,
        range_m: Option<f64>,
        chance: ChaCha8Rng,
    ) -> Self {
        Self {
            all: all.to_vec(),
            period_s,
            range_m: range_m.unwrap_or(f64::INFINITY),
            chance,
        }
    }

    /// Faults at a sample.
    fn at(&self, t_s: f64) -> impl Iterator<Item = &Fault> {
        let t_s = seen_until_s(t_s, self.period_s);
        (self.all.iter()).filter(move |f| f.start_s <= t_s && t_s < f.end_s())
    }

    /// Longest delay that any of them brings \[samples\].
    pub(crate) fn longest_delay(&self) -> usize {
        self.all.iter().fold(0, |longest, f| match f.kind {
            FaultKind::Delay(samples) => longest + samples,
            _ => longest,
        })
    }

    /// Delay that they bring at a sample \[samples\].
    pub(crate) fn delay(&self, t_s: f64) -> usize {
        self.at(t_s).fold(0, |sum, f| match f.kind {
            FaultKind::Delay(samples) => sum + samples,
            _ => sum,
        })
    }

    pub(crate) fn swapped(&self, t_s: f64) -> bool {
        let swaps = self.at(t_s).filter(|f| f.kind == FaultKind::Swapped);
        swaps.count() % 2 == 1
    }

    pub(crate) fn dropped(&self, t_s: f64) -> bool {
        self.at(t_s).any(|f| f.kind == FaultKind::Dropout)
    }

    /// Factor on the noise of both axes.
    pub(crate) fn noise(&self, t_s: f64) -> V2 {
        self.at(t_s).fold(V2::repeat(1.0), |sum, f| match f.kind {
            FaultKind::Noise(factor) => f.axis.map(sum, |x| factor * x),
            _ => sum,
        })
    }

    /// The analogue reading as the faults make it.
    pub(crate) fn analogue(&mut self, t_s: f64, reading_m: V2) -> V2 {
        let active: Vec<Fault> = self.at(t_s).copied().collect();
        active.iter().fold(reading_m, |reading, f| {
            f.axis.map(reading, |x| match f.kind {
                FaultKind::Offset(value_m) => x + value_m,
                FaultKind::Gain(factor) => factor * x,
                FaultKind::Inverted => -x,
                FaultKind::Spikes { rate_hz, size_m } => x + self.spike(rate_hz, size_m),
                FaultKind::Oscillation {
                    frequency_hz,
                    amplitude_m,
                } => x + amplitude_m * (TAU * frequency_hz * (t_s - f.start_s)).sin(),
                _ => x,
            })
        })
    }

    fn spike(&mut self, rate_hz: f64, size_m: f64) -> f64 {
        let mut draw = || -> f64 { StandardUniform.sample(&mut self.chance) };
        let (strikes, upwards) = (draw() < rate_hz * self.period_s, draw() < 0.5);
        match (strikes, upwards) {
            (true, true) => size_m,
            (true, false) => -size_m,
            (false, _) => 0.0,
        }
    }

    /// The converted reading as the faults make it, given the last one.
    pub(crate) fn digital(&self, t_s: f64, reading_m: V2, last_m: V2) -> V2 {
        self.at(t_s).fold(reading_m, |mut reading, f| {
            for i in [0, 1] {
                if !f.axis.has(i) {
                    continue;
                }
                let x = &mut reading[i];
                *x = match f.kind {
                    FaultKind::Nan => f64::NAN,
                    FaultKind::Infinity => f64::INFINITY,
                    FaultKind::Zero => 0.0,
                    FaultKind::Rail => self.range_m,
                    FaultKind::Stuck => last_m[i],
                    FaultKind::Bits(bits) => {
                        let step = 2.0 * self.range_m / 2f64.powi(bits as i32);
                        (*x / step).round() * step
                    }
                    _ => *x,
                };
            }
            reading
        })
    }
}
