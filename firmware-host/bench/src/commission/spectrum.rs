//! Windows of a log in which a stimulus excites one axis of one plane, and the lines in them: what moves and what is commanded at the
//! frequencies of the stimulus, and beside them.
//!
//! A window with its line is a smooth test function φ that is nothing at both ends, with its derivatives: ∫φ·ẍ is ∫φ̈·x, so that rates and
//! accelerations follow from positions whatever the motion does within the window, a sine of another frequency among it.

use crate::commission::log::Log;
use crate::commission::orbit::{HARMONICS, without_orbit};
use nalgebra::Complex;
use std::f64::consts::TAU;
use std::ops::Range;

pub(super) type Complex64 = Complex<f64>;

/// Shortest window \[ticks\], and its lines: as strong as this share of the strongest.
pub(super) const LEAST_TICKS: usize = 200;
const LEAST_SHARE: f64 = 0.3;
/// Bins beside a line at which there is no stimulus.
const BESIDE: [f64; 4] = [8.0, 10.0, 12.0, 14.0];
/// Bins from the spin and its multiples within which a line is not used: what goes round is taken off, and some of the line with it.
const FROM_SPIN: f64 = 3.0;

/// Ticks without a break in which one axis of one plane is excited.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Window {
    pub(super) ticks: Range<usize>,
    pub(super) plane: usize,
    pub(super) axis: usize,
}

/// A line of the stimulus in a window: motion and commands of every plane, and where.
#[derive(Debug, Clone)]
pub(super) struct Line {
    /// Number of the window, and which plane and axis it excites.
    pub(super) window: usize,
    pub(super) plane: usize,
    pub(super) axis: usize,
    /// 1, or less than nothing of one beside the stimulus.
    pub(super) weight: f64,
    pub(super) omega_rad_s: f64,
    /// Mean spin in the window; 0 where it is not known.
    pub(super) spin_rad_s: f64,
    pub(super) position_m: Vec<[Complex64; 2]>,
    /// Of what is sensed, its first and its second derivative.
    pub(super) rate_m_s: Vec<[Complex64; 2]>,
    pub(super) acceleration_m_s2: Vec<[Complex64; 2]>,
    pub(super) command_n: Vec<[Complex64; 2]>,
    /// Commands through the slope of the window.
    pub(super) command_slope_n_s: Vec<[Complex64; 2]>,
}

impl Line {
    /// Force of a plane's magnet that follows its command with this lag: τ·ḟ + f = u through the window, the slope of which counts once.
    pub(super) fn force_n(&self, plane: usize, tau_s: f64) -> [Complex64; 2] {
        let late = Complex64::new(1.0, self.omega_rad_s * tau_s);
        let (command, slope) = (&self.command_n[plane], &self.command_slope_n_s[plane]);
        [0, 1].map(|axis| (command[axis] + slope[axis] * tau_s / late) / late)
    }
}

/// Windows of all planes, in order of time.
pub(super) fn windows(logs: &[Log]) -> Vec<Window> {
    let rows = logs.iter().map(|log| log.stimulus_n.len()).min();
    let rows = rows.unwrap_or(0);
    // Once in a while a sine is nothing: two ticks in a row it is not.
    let excited = |tick: usize| -> Option<(usize, usize)> {
        let near = tick.saturating_sub(1)..(tick + 2).min(rows);
        let at = |plane: usize, axis: usize| {
            (logs[plane].stimulus_n[near.clone()].iter()).any(|s| s[axis] != 0.0)
        };
        let mut all = (0..logs.len()).flat_map(|plane| [(plane, 0), (plane, 1)]);
        all.find(|(plane, axis)| at(*plane, *axis))
    };
    let mut windows = Vec::new();
    let mut from: Option<(usize, (usize, usize))> = None;
    for tick in 0..=rows {
        let now = if tick < rows { excited(tick) } else { None };
        if from.map(|(_, what)| what) != now {
            if let Some((begin, (plane, axis))) = from
                && tick - begin >= LEAST_TICKS
            {
                let ticks = begin..tick;
                windows.push(Window { ticks, plane, axis });
            }
            from = now.map(|what| (tick, what));
        }
    }
    windows
}

/// The longest ticks without a stimulus, of so many.
pub(super) fn quiet(rows: usize, windows: &[Window]) -> Range<usize> {
    let ends = windows.iter().map(|w| w.ticks.end);
    let begins = windows.iter().map(|w| w.ticks.start).chain([rows]);
    let gaps = std::iter::once(0).chain(ends).zip(begins);
    let longest = gaps.filter(|(a, b)| b > a).max_by_key(|(a, b)| b - a);
    longest.map_or(0..0, |(a, b)| a..b)
}

pub(super) fn hann(part: f64) -> f64 {
    0.5 * (1.0 - (TAU * part).cos())
}

/// What a command makes that is held from one tick to the next, over one that is there at the tick alone.
fn held(turn_rad: f64) -> Complex64 {
    let half = 0.5 * turn_rad;
    Complex64::from_polar(half.sin() / half, -half)
}

/// Names of the windows that a signal goes through: Hann's squared, its first and its second derivative by time.
const SHAPES: usize = 3;

/// A signal off its mean, through each shape of the window.
fn through(values: &[[f64; 2]], period_s: f64) -> [Vec<[f64; 2]>; SHAPES] {
    let length = values.len() as f64;
    let mean = [0, 1].map(|axis| values.iter().map(|v| v[axis]).sum::<f64>() / length);
    let turn_rad_s = TAU / (length * period_s);
    let shaped = |shape: fn(f64, f64) -> f64| {
        let weighed = values.iter().enumerate().map(|(place, [x, y])| {
            let weight = shape(TAU * place as f64 / length, turn_rad_s);
            [weight * (x - mean[0]), weight * (y - mean[1])]
        });
        weighed.collect()
    };
    // Of ¼·(1 − cos a)².
    [
        shaped(|a, _| 0.25 * (1.0 - a.cos()).powi(2)),
        shaped(|a, turn| 0.5 * turn * (1.0 - a.cos()) * a.sin()),
        shaped(|a, turn| 0.5 * turn * turn * (a.cos() - (2.0 * a).cos())),
    ]
}

/// Amplitude of what has gone through a window, at a frequency.
fn amplitude(weighed: &[[f64; 2]], turn_rad: f64) -> [Complex64; 2] {
    let mut sums = [Complex64::default(); 2];
    let turn = Complex64::from_polar(1.0, -turn_rad);
    let mut phase = Complex64::new(1.0, 0.0);
    for value in weighed {
        for (sum, value) in sums.iter_mut().zip(value) {
            *sum += phase * value;
        }
        phase *= turn;
    }
    sums.map(|sum| sum * (2.0 / weighed.len() as f64))
}

/// Lines of all windows, each with those beside it.
pub(super) fn lines(logs: &[Log], windows: &[Window]) -> Vec<Line> {
    let numbered = windows.iter().enumerate();
    numbered
        .flat_map(|(number, window)| of_window(logs, number, window))
        .collect()
}

/// Signals of all planes in a window.
struct Shaped {
    position: Vec<[Vec<[f64; 2]>; SHAPES]>,
    command: Vec<[Vec<[f64; 2]>; SHAPES]>,
    window: Window,
    number: usize,
    period_s: f64,
    spin_rad_s: f64,
}

impl Shaped {
    fn new(logs: &[Log], number: usize, window: &Window) -> Option<Self> {
        let first = logs.first()?;
        let period_s = first.period_s;
        let ticks = || window.ticks.clone();
        let length = window.ticks.len();
        let weights: Vec<f64> = (0..length)
            .map(|place| hann(place as f64 / length as f64).powi(2))
            .collect();
        let spin = first.spin_rad_s.as_ref();
        let mut sum = 0.0;
        let angles_rad: Vec<f64> = ticks()
            .map(|tick| {
                sum += spin.map_or(0.0, |spin| spin[tick]);
                sum * period_s
            })
            .collect();
        let all = |of: fn(&Log) -> &Vec<[f64; 2]>| {
            let own = |log| without_orbit(&of(log)[ticks()], &angles_rad, &weights);
            let planes = logs.iter();
            planes.map(|log| through(&own(log), period_s)).collect()
        };
        Some(Self {
            position: all(|log| &log.position_m),
            command: all(|log| &log.command_n),
            window: window.clone(),
            number,
            period_s,
            spin_rad_s: sum / window.ticks.len() as f64,
        })
    }

    /// Frequency of a bin, and of those that are apart so far.
    fn bin_rad_s(&self) -> f64 {
        TAU / (self.window.ticks.len() as f64 * self.period_s)
    }

    /// Whether an orbit that goes round with the rotor reaches into a line.
    fn at_spin(&self, omega_rad_s: f64) -> bool {
        let near = |times: f64| (omega_rad_s - times * self.spin_rad_s.abs()).abs();
        let reach = FROM_SPIN * self.bin_rad_s();
        self.spin_rad_s != 0.0 && HARMONICS.iter().any(|times| near(*times) < reach)
    }

    fn line(&self, omega_rad_s: f64, weight: f64) -> Line {
        let turn_rad = omega_rad_s * self.period_s;
        let at = |planes: &[[Vec<[f64; 2]>; SHAPES]], shape: usize| -> Vec<[Complex64; 2]> {
            let planes = planes.iter();
            planes.map(|of| amplitude(&of[shape], turn_rad)).collect()
        };
        let [position_m, slope, bend] = [0, 1, 2].map(|shape| at(&self.position, shape));
        let turn = Complex64::new(0.0, omega_rad_s);
        let pairs = |a: &[Complex64; 2],
                     b: &[Complex64; 2],
                     of: &dyn Fn(Complex64, Complex64) -> Complex64| {
            [of(a[0], b[0]), of(a[1], b[1])]
        };
        // ∫φ·ẋ is −∫φ̇·x, with φ = w·e^(−jωt).
        let rates = position_m.iter().zip(&slope);
        let rate_m_s: Vec<[Complex64; 2]> = rates
            .map(|(x, s)| pairs(x, s, &|x, s| turn * x - s))
            .collect();
        let bends = rate_m_s.iter().zip(&slope).zip(&bend);
        let acceleration_m_s2 = bends
            .map(|((v, s), b)| {
                let without = pairs(v, s, &|v, s| turn * (v - s));
                pairs(&without, b, &|a, b| a + b)
            })
            .collect();
        let of_hold = held(turn_rad);
        let command = |shape: usize| -> Vec<[Complex64; 2]> {
            let planes = at(&self.command, shape).into_iter();
            planes.map(|u| u.map(|u| u * of_hold)).collect()
        };
        Line {
            window: self.number,
            plane: self.window.plane,
            axis: self.window.axis,
            weight,
            omega_rad_s,
            spin_rad_s: self.spin_rad_s,
            position_m,
            rate_m_s,
            acceleration_m_s2,
            command_n: command(0),
            command_slope_n_s: command(1),
        }
    }
}

fn of_window(logs: &[Log], number: usize, window: &Window) -> Vec<Line> {
    let Some(shaped) = Shaped::new(logs, number, window) else {
        return Vec::new();
    };
    let period_s = shaped.period_s;
    let stimulus = &logs[window.plane].stimulus_n[window.ticks.clone()];
    let [stimulus, ..] = through(stimulus, period_s);
    // Every other bin: neighbours tell the same.
    let step = 2.0 * shaped.bin_rad_s();
    let strength = |omega: f64| {
        let [x, y] = amplitude(&stimulus, omega * period_s);
        x.norm_sqr() + y.norm_sqr()
    };
    let bins: Vec<(f64, f64)> = (4..(window.ticks.len() / 8).min(200))
        .map(|bin| step * bin as f64)
        .map(|omega| (omega, strength(omega)))
        .collect();
    let strongest = bins.iter().fold(0.0_f64, |most, (_, s)| most.max(*s));
    let mut lines = Vec::new();
    for (omega, strength) in bins {
        let weak = strength < LEAST_SHARE * LEAST_SHARE * strongest || strongest == 0.0;
        if weak || shaped.at_spin(omega) {
            continue;
        }
        let beside = BESIDE.map(|bins| omega + 0.5 * step * bins);
        let beside: Vec<f64> = beside.into_iter().filter(|o| !shaped.at_spin(*o)).collect();
        let weight = -1.0 / beside.len().max(1) as f64;
        lines.push(shaped.line(omega, 1.0));
        lines.extend(beside.into_iter().map(|omega| shaped.line(omega, weight)));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A decaying sine that is none of the window's lines: its derivatives come out as they are.
    #[test]
    fn derivatives_are_those_of_the_motion() {
        let period_s = 5e-5;
        let rows = 4_000;
        let (rate, omega) = (-3.0, 411.0);
        let motion = |t: f64| Complex64::new(rate, omega).scale(t).exp();
        let log = |of: &dyn Fn(f64) -> Complex64| Log {
            period_s,
            position_m: (0..rows)
                .map(|i| of(period_s * f64::from(i)))
                .map(|z| [1e-5 * z.re, 1e-5 * z.im])
                .collect(),
            command_n: vec![[0.0; 2]; rows as usize],
            stimulus_n: vec![[1.0, 0.0]; rows as usize],
            ..Log::default()
        };
        let window = Window {
            ticks: 0..rows as usize,
            plane: 0,
            axis: 0,
        };
        let of = |of: &dyn Fn(f64) -> Complex64| {
            let logs = [log(of)];
            Shaped::new(&logs, 0, &window).unwrap().line(440.0, 1.0)
        };
        let power = Complex64::new(rate, omega);
        let whole = of(&motion);
        let speeds = of(&|t| motion(t) * power);
        let turned = of(&|t| motion(t) * power * power);
        for axis in 0..2 {
            let close = |a: Complex64, b: Complex64| (a - b).norm() < 1e-4 * b.norm();
            assert!(close(whole.rate_m_s[0][axis], speeds.position_m[0][axis]));
            let acceleration = whole.acceleration_m_s2[0][axis];
            assert!(close(acceleration, turned.position_m[0][axis]));
        }
    }
}
