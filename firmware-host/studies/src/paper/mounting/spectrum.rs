//! Full spectrum of a motion in the plane: x + iy, so that its sign tells forward from backward.

use plant_model::V2;
use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection};
use std::f64::consts::TAU;

/// Amplitudes of rotating components.
#[derive(Debug)]
pub(super) struct Spectrum {
    /// In order of frequency.
    pub(super) lines: Vec<Line>,
    /// Half width of a line \[Hz\]: two over the length of the record, by the window.
    pub(super) resolution_hz: f64,
}

/// A line of a spectrum.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Backward negative.
    pub(super) frequency_hz: f64,
    /// Of the circle.
    pub(super) amplitude: f64,
}

impl Spectrum {
    /// Of samples at equal distance, less their mean, under a Hann window, padded with zeros to at least
    /// four times their number.
    pub(super) fn of(samples: &[V2], sample_s: f64) -> Self {
        let n = samples.len().max(2);
        let mean = samples.iter().sum::<V2>() / n as f64;
        let size = (4 * n).next_power_of_two();
        let mut data = vec![Complex::new(0.0, 0.0); size];
        let mut weights = 0.0;
        for (i, (out, sample)) in data.iter_mut().zip(samples).enumerate() {
            let weight = 0.5 * (1.0 - (TAU * i as f64 / (n - 1) as f64).cos());
            let moved = (sample - mean) * weight;
            weights += weight;
            *out = Complex::new(moved.x, moved.y);
        }
        Radix4::new(size, FftDirection::Forward).process(&mut data);
        data.rotate_left(size / 2);
        let step_hz = 1.0 / (size as f64 * sample_s);
        let line = |(i, value): (usize, &Complex<f64>)| Line {
            frequency_hz: (i as f64 - (size / 2) as f64) * step_hz,
            amplitude: value.norm() / weights,
        };
        Self {
            lines: data.iter().enumerate().map(line).collect(),
            resolution_hz: 2.0 / (n as f64 * sample_s),
        }
    }

    /// The highest line among those wanted by their frequency \[Hz\].
    pub(super) fn highest(&self, wanted: impl Fn(f64) -> bool) -> Line {
        let none = Line {
            frequency_hz: f64::NAN,
            amplitude: 0.0,
        };
        let lines = self.lines.iter().filter(|line| wanted(line.frequency_hz));
        lines.fold(none, |best, line| {
            let higher = line.amplitude > best.amplitude;
            if higher { *line } else { best }
        })
    }

    /// Power of the lines wanted by their frequency \[Hz\] as a share of all.
    pub(super) fn power_share(&self, wanted: impl Fn(f64) -> bool) -> f64 {
        let power = |wanted: &dyn Fn(f64) -> bool| -> f64 {
            let lines = self.lines.iter().filter(|line| wanted(line.frequency_hz));
            lines.map(|line| line.amplitude * line.amplitude).sum()
        };
        power(&wanted) / power(&|_| true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A backward circle and a smaller forward one are told apart, with their amplitudes.
    #[test]
    fn backward_and_forward() {
        let samples: Vec<V2> = (0..2000)
            .map(|i| {
                let [a, b] = [-400.0, 50.0].map(|hz| TAU * hz * f64::from(i) * 5e-5);
                V2::new(a.cos() + 0.5 * b.cos() + 3.0, a.sin() + 0.5 * b.sin())
            })
            .collect();
        let spectrum = Spectrum::of(&samples, 5e-5);
        let back = spectrum.highest(|hz| hz < 0.0);
        let forth = spectrum.highest(|hz| hz > 0.0);
        assert!((back.frequency_hz + 400.0).abs() < 2.5 && (back.amplitude - 1.0).abs() < 0.02);
        assert!((forth.frequency_hz - 50.0).abs() < 2.5 && (forth.amplitude - 0.5).abs() < 0.02);
        assert!((spectrum.power_share(|hz| hz < 0.0) - 0.8).abs() < 0.01);
    }
}
