//! Sensitivity of the loop as ISO 14839-3 judges it: of each axis, with all others closed, the largest size over frequency of what
//! the controller takes per what is added to its reading.

use super::LinearLoop;
use nalgebra::{DMatrix, Hessenberg};
use plant_model::machine::linear::{C, MachineMode};
use serde::Serialize;
use std::f64::consts::TAU;

/// Zones of ISO 14839-3, by the peak of the sensitivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Zone {
    /// Below 3 (9.5 dB): as new machines are.
    A,
    /// Below 4 (12 dB): fit for long operation.
    B,
    /// Below 5 (14 dB): for a limited time.
    C,
    /// Above: may be damaged.
    D,
}

impl Zone {
    /// Of a peak.
    pub fn of(peak: f64) -> Self {
        match peak {
            p if p < 3.0 => Self::A,
            p if p < 4.0 => Self::B,
            p if p < 5.0 => Self::C,
            _ => Self::D,
        }
    }

    /// Its letter.
    pub fn name(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
            Self::D => "D",
        }
    }
}

/// Peak of the sensitivity of an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Name of the reading, as `drive end x`.
    pub axis: String,
    /// Largest |S| …
    pub peak: f64,
    /// … in decibels …
    pub peak_db: f64,
    /// … and where \[Hz\].
    pub frequency_hz: f64,
    /// By ISO 14839-3.
    pub zone: Zone,
}

/// Frequencies evenly by their logarithm, from this share of half the rate on …
const FREQUENCIES: u32 = 400;
const LOWEST_SHARE: f64 = 1e-5;
/// … and about each mode, in half widths of its resonance.
const ABOUT: [f64; 7] = [-2.0, -1.0, -0.4, 0.0, 0.4, 1.0, 2.0];
/// Cuts with which a peak between two frequencies is found.
const CUTS: u32 = 40;

/// The loop in a form in which a frequency costs the square of its size.
struct Response {
    h: DMatrix<f64>,
    b: DMatrix<C>,
    c: DMatrix<f64>,
    period_s: f64,
}

impl Response {
    /// |S| of each axis.
    fn sensitivity(&self, frequency_hz: f64) -> Vec<f64> {
        let z = C::new(0.0, TAU * frequency_hz * self.period_s).exp();
        let n = self.h.nrows();
        let mut m = DMatrix::from_fn(n, n, |i, j| {
            C::new(-self.h[(i, j)], 0.0) + if i == j { z } else { C::new(0.0, 0.0) }
        });
        let mut x = self.b.clone();
        // Below the diagonal there is one entry in each column.
        for i in 0..n.saturating_sub(1) {
            if m[(i + 1, i)].norm() > m[(i, i)].norm() {
                m.swap_rows(i, i + 1);
                x.swap_rows(i, i + 1);
            }
            let factor = m[(i + 1, i)] / m[(i, i)];
            if factor != C::new(0.0, 0.0) {
                for j in i..n {
                    let above = m[(i, j)];
                    m[(i + 1, j)] -= factor * above;
                }
                for j in 0..x.ncols() {
                    let above = x[(i, j)];
                    x[(i + 1, j)] -= factor * above;
                }
            }
        }
        for i in (0..n).rev() {
            for column in 0..x.ncols() {
                let rest: C = (i + 1..n).map(|j| m[(i, j)] * x[(j, column)]).sum();
                x[(i, column)] = (x[(i, column)] - rest) / m[(i, i)];
            }
        }
        (0..self.c.nrows())
            .map(|axis| {
                let read: C = (0..n).map(|j| x[(j, axis)] * self.c[(axis, j)]).sum();
                (read + 1.0).norm()
            })
            .collect()
    }
}

impl LinearLoop {
    fn response(&self) -> Response {
        // Without a second row there is nothing to reduce.
        let (q, h) = Hessenberg::new(self.a.clone()).unpack();
        Response {
            b: (q.transpose() * &self.b).map(|x| C::new(x, 0.0)),
            c: &self.c * q,
            h,
            period_s: self.period_s,
        }
    }

    /// |S| of each axis at frequencies up to half the rate \[Hz\].
    pub fn sensitivities(&self, frequencies_hz: &[f64]) -> Vec<Vec<f64>> {
        let response = self.response();
        let at = |hz: &f64| response.sensitivity(*hz);
        frequencies_hz.iter().map(at).collect()
    }

    /// Peaks of all axes, for a loop that is stable and has these modes.
    pub fn sensitivity_peaks(&self, modes: &[MachineMode]) -> Vec<Sensitivity> {
        let nyquist_hz = 0.5 / self.period_s;
        let response = self.response();
        let mut grid_hz: Vec<f64> = (0..=FREQUENCIES)
            .map(|i| {
                let share = f64::from(i) / f64::from(FREQUENCIES);
                nyquist_hz * LOWEST_SHARE.powf(1.0 - share)
            })
            .collect();
        grid_hz.extend(modes.iter().flat_map(|mode| {
            ABOUT.map(|widths| (mode.frequency_rad_s + widths * mode.growth_s.abs()) / TAU)
        }));
        grid_hz.retain(|hz| (0.0..=nyquist_hz).contains(hz) && *hz > 0.0);
        grid_hz.sort_by(f64::total_cmp);
        let sizes: Vec<Vec<f64>> = grid_hz.iter().map(|hz| response.sensitivity(*hz)).collect();
        let peak = |(axis, name): (usize, &String)| {
            let at = |i: usize| sizes[i][axis];
            let most = (0..sizes.len()).max_by(|a, b| at(*a).total_cmp(&at(*b)))?;
            let between = (
                grid_hz[most.saturating_sub(1)],
                grid_hz[(most + 1).min(grid_hz.len() - 1)],
            );
            let found = largest(between, |hz| response.sensitivity(hz)[axis]);
            let (frequency_hz, peak) = match found.1 > at(most) {
                true => found,
                false => (grid_hz[most], at(most)),
            };
            Some(Sensitivity {
                axis: name.clone(),
                peak,
                peak_db: 20.0 * peak.log10(),
                frequency_hz,
                zone: Zone::of(peak),
            })
        };
        self.axes.iter().enumerate().filter_map(peak).collect()
    }
}

/// The largest value between two places, by the golden section.
fn largest((mut low, mut high): (f64, f64), of: impl Fn(f64) -> f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let place = |low: f64, high: f64, share: f64| low + share * (high - low);
    let mut inner = [1.0 - GOLDEN, GOLDEN].map(|share| place(low, high, share));
    let mut values = inner.map(&of);
    for _ in 0..CUTS {
        if values[0] > values[1] {
            high = inner[1];
            (inner[1], values[1]) = (inner[0], values[0]);
            inner[0] = place(low, high, 1.0 - GOLDEN);
            values[0] = of(inner[0]);
        } else {
            low = inner[0];
            (inner[0], values[0]) = (inner[1], values[1]);
            inner[1] = place(low, high, GOLDEN);
            values[1] = of(inner[1]);
        }
    }
    match values[0] > values[1] {
        true => (inner[0], values[0]),
        false => (inner[1], values[1]),
    }
}
