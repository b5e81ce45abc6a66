//! What a log tells without its stimulus: noise of the sensors, and the sense of the spin.

use crate::commission::log::Log;
use crate::commission::spectrum::{Complex64, hann};
use crate::commission::{Commissioned, Found, Missing};
use std::f64::consts::TAU;
use std::ops::Range;

/// Turns that the orbit of the unbalance is looked for over, and by how much it has to stand out.
const LEAST_TURNS: f64 = 8.0;
const STANDS_OUT: f64 = 4.0;

/// Second differences of what moves smoothly are noise alone, with six times its square.
pub(super) fn noise_m(positions_m: &[[f64; 2]]) -> f64 {
    let seconds = (positions_m.windows(3))
        .flat_map(|w| [0, 1].map(|axis| w[0][axis] - 2.0 * w[1][axis] + w[2][axis]));
    let rows = positions_m.len().saturating_sub(2).max(1) as f64;
    (seconds.map(|d| d * d).sum::<f64>() / (12.0 * rows)).sqrt()
}

impl Commissioned {
    /// Noise of a plane's sensor, under a name that begins so.
    pub(super) fn of_noise(&mut self, prefix: &str, positions_m: &[[f64; 2]]) {
        let rms = noise_m(positions_m);
        self.parameters.push(Found {
            name: format!("{prefix}sensor_noise_m"),
            unit: "m",
            value: rms,
            // It may not be white.
            low: 0.7 * rms,
            high: 1.3 * rms,
            from: "second differences of the position".to_owned(),
        });
    }

    /// Sense of the spin by the orbit of the unbalance, over rows without a stimulus.
    pub(super) fn of_spin(&mut self, log: &Log, quiet: Range<usize>) {
        let name = "spin_sense";
        let Some(spin) = &log.spin_rad_s else {
            return self.miss(
                name,
                "the log has no column spin_rad_s with a number in every row",
            );
        };
        let mean = spin[quiet.clone()].iter().sum::<f64>() / quiet.len().max(1) as f64;
        let turns = mean.abs() * quiet.len() as f64 * log.period_s / TAU;
        if turns < LEAST_TURNS {
            return self.miss(
                name,
                "the rotor turns less than eight times without a stimulus: record it at speed",
            );
        }
        let mut angle = 0.0;
        let mut lines = [Complex64::default(); 3];
        let length = quiet.len() as f64;
        for (place, tick) in quiet.enumerate() {
            let weight = hann(place as f64 / length);
            let [x, y] = log.position_m[tick];
            let z = Complex64::new(x, y) * weight;
            for (line, times) in lines.iter_mut().zip([1.0, -1.0, 0.37]) {
                *line += z * Complex64::from_polar(1.0, -times * angle);
            }
            angle += spin[tick] * log.period_s;
        }
        let [forward, backward, beside] = lines.map(|line| line.norm() * 2.0 / length);
        if forward.max(backward) < STANDS_OUT * beside {
            return self.miss(
                name,
                "no orbit of the unbalance stands out: record it faster",
            );
        }
        let value = if forward >= backward { 1.0 } else { -1.0 };
        self.parameters.push(Found {
            name: name.to_owned(),
            unit: "1",
            value,
            low: value,
            high: value,
            from: format!(
                "orbit at the spin: {:.2} µm forward, {:.2} µm backward",
                1e6 * forward,
                1e6 * backward
            ),
        });
    }

    pub(super) fn miss(&mut self, name: impl Into<String>, reason: impl Into<String>) {
        self.not_found.push(Missing {
            name: name.into(),
            reason: reason.into(),
        });
    }
}
