//! The plant's instruments as firmware sees them: a sampled position, and what is known of the spin.

use crate::device::sensor_fault::{Fault, Faults};
use plant_model::V2;
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::collections::VecDeque;

/// A position sensor with its converter: what it is always like. Runout, age, swapped axes, gain, offset, noise,
/// range and step apply in this order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorParams {
    /// Step of the converter \[m\]; 0 means none.
    pub quantum_m: f64,
    /// Noise, root mean square per axis \[m\].
    pub noise_rms_m: f64,
    /// Reading in the centre of the magnets \[m\].
    pub offset_m: V2,
    /// Reading per position.
    pub gain: V2,
    /// Age of the position that is read \[samples\].
    pub delay_samples: usize,
    /// Whether x reads y and y reads x.
    pub swapped: bool,
    /// Largest reading to either side \[m\]; `None`: no limit.
    pub range_m: Option<f64>,
    /// What the target adds to the reading once a turn: amplitude \[m\] …
    pub runout_m: f64,
    /// … and angle at the first reading \[rad\].
    pub runout_phase_rad: f64,
}

impl Default for SensorParams {
    fn default() -> Self {
        Self {
            quantum_m: 0.0,
            noise_rms_m: 0.0,
            offset_m: V2::zeros(),
            gain: V2::repeat(1.0),
            delay_samples: 0,
            swapped: false,
            range_m: None,
            runout_m: 0.0,
            runout_phase_rad: 0.0,
        }
    }
}

/// What is known of the spin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpinSensorParams {
    /// Whether the spin is marked valid.
    pub valid: bool,
    /// What is reported over what it is; negative with the wrong sign.
    pub gain: f64,
}

impl Default for SpinSensorParams {
    fn default() -> Self {
        Self {
            valid: true,
            gain: 1.0,
        }
    }
}

/// A position as it arrives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Counts new samples from 0; a sample that did not come repeats the last number.
    pub sequence: u32,
    /// Position \[m\]; anything, under a fault.
    pub position_m: V2,
}

/// A sensor with its own stream of noise. ChaCha is specified to the bit, so a seed means the same
/// noise for ever.
#[derive(Debug, Clone)]
pub struct Sensor {
    params: SensorParams,
    noise: ChaCha8Rng,
    /// Number of the next new sample.
    sequence: u32,
    /// What is needed beside noise and converter; `None` where nothing is.
    more: Option<Box<More>>,
}

/// A sensor's memory, and its faults.
#[derive(Debug, Clone)]
struct More {
    faults: Faults,
    /// Positions back to the longest delay, the newest first.
    past_m: VecDeque<V2>,
    longest_delay: usize,
    last: Option<Reading>,
    /// Angle of the runout, and time and spin of the reading that it is of.
    runout_rad: f64,
    turned: (f64, f64),
}

impl Sensor {
    /// A sensor that is read every `period_s`; the same seed gives the same noise.
    pub fn new(params: SensorParams, faults: &[Fault], period_s: f64, seed: u64) -> Self {
        let plain = SensorParams {
            quantum_m: params.quantum_m,
            noise_rms_m: params.noise_rms_m,
            ..SensorParams::default()
        };
        let more = (params != plain || !faults.is_empty()).then(|| {
            let mut chance = ChaCha8Rng::seed_from_u64(seed);
            chance.set_stream(1);
            let faults = Faults::new(faults, period_s, params.range_m, chance);
            Box::new(More {
                longest_delay: params.delay_samples + faults.longest_delay(),
                faults,
                past_m: VecDeque::new(),
                last: None,
                runout_rad: params.runout_phase_rad,
                turned: (0.0, 0.0),
            })
        });
        Self {
            params,
            noise: ChaCha8Rng::seed_from_u64(seed),
            sequence: 0,
            more,
        }
    }

    /// Reads the position of a rotor that spins so once.
    pub fn read(&mut self, t_s: f64, position_m: V2, spin_rad_s: f64) -> Reading {
        let p = &self.params;
        let (mut x, mut noise) = (position_m, V2::repeat(p.noise_rms_m));
        if let Some(more) = &mut self.more {
            let target_m = x + more.runout_m(p, t_s, spin_rad_s);
            x = more.analogue(p, t_s, target_m);
            noise = noise.component_mul(&more.faults.noise(t_s));
        }
        for i in [0, 1] {
            if p.noise_rms_m > 0.0 {
                let n: f64 = StandardNormal.sample(&mut self.noise);
                x[i] += noise[i] * n;
            }
            if let Some(range) = p.range_m {
                x[i] = x[i].clamp(-range, range);
            }
            if p.quantum_m > 0.0 {
                x[i] = (x[i] / p.quantum_m).round() * p.quantum_m;
            }
        }
        let fresh = Reading {
            sequence: self.sequence,
            position_m: x,
        };
        let reading = match &mut self.more {
            Some(more) => more.digital(t_s, fresh),
            None => fresh,
        };
        self.sequence = reading.sequence.wrapping_add(1);
        reading
    }
}

impl More {
    /// What the target adds. Between readings the spin changes little: its mean is as good as its course.
    fn runout_m(&mut self, p: &SensorParams, t_s: f64, spin_rad_s: f64) -> V2 {
        if p.runout_m == 0.0 {
            return V2::zeros();
        }
        let (last_s, last_rad_s) = self.turned;
        self.runout_rad += 0.5 * (spin_rad_s + last_rad_s) * (t_s - last_s);
        self.turned = (t_s, spin_rad_s);
        let (sin, cos) = self.runout_rad.sin_cos();
        p.runout_m * V2::new(cos, sin)
    }

    /// What reaches the converter, but for the noise. Before the run the rotor stood where it started.
    fn analogue(&mut self, p: &SensorParams, t_s: f64, position_m: V2) -> V2 {
        self.past_m.push_front(position_m);
        self.past_m.truncate(self.longest_delay + 1);
        let delay = p.delay_samples + self.faults.delay(t_s);
        let oldest = self.past_m.back().copied().unwrap_or(position_m);
        let mut x = self.past_m.get(delay).copied().unwrap_or(oldest);
        if p.swapped != self.faults.swapped(t_s) {
            x = V2::new(x.y, x.x);
        }
        x = x.component_mul(&p.gain) + p.offset_m;
        self.faults.analogue(t_s, x)
    }

    /// What leaves the converter.
    fn digital(&mut self, t_s: f64, fresh: Reading) -> Reading {
        let last = self.last.unwrap_or(fresh);
        let reading = if self.faults.dropped(t_s) {
            last
        } else {
            Reading {
                position_m: (self.faults).digital(t_s, fresh.position_m, last.position_m),
                ..fresh
            }
        };
        self.last = Some(reading);
        reading
    }
}
