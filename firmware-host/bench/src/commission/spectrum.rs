//! Windows of a log in which a stimulus excites one axis of one plane, and the lines in them: what moves and what is commanded at the
//! frequencies of the stimulus, and beside them.

use crate::commission::log::Log;
use nalgebra::Complex;
use std::f64::consts::TAU;
use std::ops::Range;

pub(super) type Complex64 = Complex<f64>;

/// Shortest window \[ticks\], and its lines: as strong as this share of the strongest.
pub(super) const LEAST_TICKS: usize = 200;
const LEAST_SHARE: f64 = 0.3;
/// Bins above a line at which there is no stimulus.
const BESIDE: [f64; 4] = [8.0, 10.0, 12.0, 14.0];

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
    pub(super) command_n: Vec<[Complex64; 2]>,
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

/// A signal off its mean, under the square of Hann's window.
fn through(values: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let length = values.len() as f64;
    let mean = [0, 1].map(|axis| values.iter().map(|v| v[axis]).sum::<f64>() / length);
    let weighed = values.iter().enumerate().map(|(place, [x, y])| {
        let weight = hann(place as f64 / length).powi(2);
        [weight * (x - mean[0]), weight * (y - mean[1])]
    });
    weighed.collect()
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

fn of_window(logs: &[Log], number: usize, window: &Window) -> Vec<Line> {
    let Some(first) = logs.first() else {
        return Vec::new();
    };
    let period_s = first.period_s;
    let length = window.ticks.len() as f64;
    // Once for all lines: what is left of the mean, seen through the window.
    let all = |of: fn(&Log) -> &Vec<[f64; 2]>| -> Vec<Vec<[f64; 2]>> {
        let planes = logs.iter();
        planes
            .map(|log| through(&of(log)[window.ticks.clone()]))
            .collect()
    };
    let (positions, commands) = (all(|log| &log.position_m), all(|log| &log.command_n));
    let stimulus = through(&logs[window.plane].stimulus_n[window.ticks.clone()]);
    let spin = first.spin_rad_s.as_ref();
    let spin_rad_s = spin.map_or(0.0, |spin| {
        spin[window.ticks.clone()].iter().sum::<f64>() / length
    });
    // Every other bin: neighbours tell the same.
    let step = 2.0 * TAU / (length * period_s);
    let strength = |omega: f64| {
        let [x, y] = amplitude(&stimulus, omega * period_s);
        x.norm_sqr() + y.norm_sqr()
    };
    let bins: Vec<(f64, f64)> = (4..(length as usize / 8).min(200))
        .map(|bin| step * bin as f64)
        .map(|omega| (omega, strength(omega)))
        .collect();
    let strongest = bins.iter().fold(0.0_f64, |most, (_, s)| most.max(*s));
    let mut lines = Vec::new();
    for (omega, strength) in bins {
        if strength < LEAST_SHARE * LEAST_SHARE * strongest || strongest == 0.0 {
            continue;
        }
        let beside = BESIDE.map(|bins| (omega + 0.5 * step * bins, -1.0 / BESIDE.len() as f64));
        for (omega, weight) in std::iter::once((omega, 1.0)).chain(beside) {
            let turn_rad = omega * period_s;
            let at = |planes: &[Vec<[f64; 2]>]| -> Vec<[Complex64; 2]> {
                planes.iter().map(|of| amplitude(of, turn_rad)).collect()
            };
            let command_n = at(&commands).into_iter();
            lines.push(Line {
                window: number,
                plane: window.plane,
                axis: window.axis,
                weight,
                omega_rad_s: omega,
                spin_rad_s,
                position_m: at(&positions),
                command_n: command_n.map(|u| u.map(|u| u * held(turn_rad))).collect(),
            });
        }
    }
    lines
}
