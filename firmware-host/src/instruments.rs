//! The plant's instruments as firmware sees them: a sampled, quantised, noisy position.

use plant_model::V2;
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// A position sensor with its converter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensorParams {
    /// Step of the converter \[m\]; 0 means none.
    pub quantum_m: f64,
    /// Noise, root mean square per axis \[m\].
    pub noise_rms_m: f64,
}

/// A sensor with its own stream of noise. ChaCha is specified to the bit, so a seed means the same
/// noise for ever.
#[derive(Debug, Clone)]
pub struct Sensor {
    params: SensorParams,
    noise: ChaCha8Rng,
}

impl Sensor {
    /// A sensor; the same seed gives the same noise.
    pub fn new(params: SensorParams, seed: u64) -> Self {
        Self {
            params,
            noise: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// Reads the position once.
    pub fn read(&mut self, position_m: V2) -> V2 {
        let SensorParams {
            quantum_m,
            noise_rms_m,
        } = self.params;
        position_m.map(|x| {
            let mut x = x;
            if noise_rms_m > 0.0 {
                let n: f64 = StandardNormal.sample(&mut self.noise);
                x += noise_rms_m * n;
            }
            if quantum_m > 0.0 {
                x = (x / quantum_m).round() * quantum_m;
            }
            x
        })
    }
}
