//! What a recorded run of commissioning tells of its machine: numbers with intervals, from the motion that a stimulus makes.
//!
//! Through windows over the stimulus go its lines, the motion X and the commands U. Least squares of
//! −ω²·X + κ·X = G·U/(1 + jωτ) over all lines, U as it is held from tick to tick, give G, force over mass along both axes, κ, stiffness
//! over mass, and τ, the time from a command to its force. Noise and loads that the loop answers to are in X and U alike and would draw the fit: what lines beside
//! those of the stimulus show of them is subtracted. Intervals are by the scatter from window to window, as Student's t has it.

pub mod log;
pub mod walk;

use crate::commission::log::Log;
use crate::log_file::LogError;
use nalgebra::{Complex, DMatrix, DVector};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

type Complex64 = Complex<f64>;

/// A number of the machine, between what it lies with 95 % probability, and what it rests on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// As the supervisor's parameter, or as what it is of.
    pub name: &'static str,
    /// Unit; "1" of a plain number.
    pub unit: &'static str,
    pub value: f64,
    pub low: f64,
    pub high: f64,
    /// What it rests on.
    pub from: String,
}

/// What could not be found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Missing {
    pub name: &'static str,
    /// Why, and which motion would show it.
    pub reason: String,
}

/// A number that is configured otherwise.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contradiction {
    pub name: &'static str,
    pub configured: f64,
    pub low: f64,
    pub high: f64,
}

/// What a log tells.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Commissioned {
    pub parameters: Vec<Found>,
    pub not_found: Vec<Missing>,
    pub contradictions: Vec<Contradiction>,
}

/// A line of the stimulus in a window: motion, commands, and where.
struct Line {
    window: usize,
    /// 1, or less than nothing of one beside the stimulus.
    weight: f64,
    omega: f64,
    position: [Complex64; 2],
    command: [Complex64; 2],
}

/// Shortest window \[ticks\], and its lines: as strong as this share of the strongest.
const LEAST_TICKS: usize = 200;
const LEAST_SHARE: f64 = 0.3;
/// Windows that the fit of an axis takes up.
const OF_FIT: f64 = 4.0;
/// The widest interval of the mass that is one, either way as a share.
const WIDEST: f64 = 0.25;
/// Windows whose misfit is so many times the usual are left out; and the largest share of the motion that the fit may leave.
const OUTLIER: f64 = 3.0;
const UNEXPLAINED: f64 = 0.15;
/// Bins above a line at which there is no stimulus.
const BESIDE: [f64; 4] = [8.0, 10.0, 12.0, 14.0];
/// Windows that intervals need.
const LEAST_WINDOWS: usize = 6;
/// The longest time from a command to its force \[ticks\].
const MOST_DELAY: f64 = 12.0;
const STEPS: usize = 240;

impl Commissioned {
    /// What a log tells.
    ///
    /// # Errors
    /// [`LogError`] where nothing can be found.
    pub fn of(log: &Log) -> Result<Self, LogError> {
        let windows = windows(log);
        if windows.len() < LEAST_WINDOWS {
            let message = format!(
                "a stimulus in {} windows of {LEAST_TICKS} ticks and more, {LEAST_WINDOWS} at least are needed",
                windows.len()
            );
            let help = "record the check of the supervisor from its beginning, with stimulus_x_n and stimulus_y_n";
            return Err(LogError::new(message, help));
        }
        let lines = lines(log, &windows);
        let fit = Fit::without_outliers(lines, log.period_s)?;
        let mut found = Self::default();
        fit.say(&mut found);
        found.of_noise(log);
        found.of_spin(log, &windows);
        for name in [
            "friction_coefficient",
            "restitution",
            "contact_stiffness_n_m",
        ] {
            found.not_found.push(Missing {
                name,
                reason: "shows in contact alone: review finds the first two in the record of a touch-down".to_owned(),
            });
        }
        Ok(found)
    }

    /// Compares with what is configured, of each the value and its name.
    pub fn compare(&mut self, configured: &[(&'static str, f64)]) {
        for found in &self.parameters {
            let own = configured.iter().find(|(name, _)| *name == found.name);
            if let Some((name, value)) = own
                && (*value < found.low || *value > found.high)
            {
                self.contradictions.push(Contradiction {
                    name,
                    configured: *value,
                    low: found.low,
                    high: found.high,
                });
            }
        }
        // What is farthest off first.
        let off = |c: &Contradiction| {
            let nearest = c.configured.clamp(c.low, c.high);
            (c.configured - nearest).abs() / nearest.abs().max(1e-12)
        };
        self.contradictions
            .sort_by(|a, b| off(b).total_cmp(&off(a)));
    }

    fn of_noise(&mut self, log: &Log) {
        let rms = noise_m(&log.position_m);
        self.parameters.push(Found {
            name: "sensor_noise_m",
            unit: "m",
            value: rms,
            // It may not be white.
            low: 0.7 * rms,
            high: 1.3 * rms,
            from: "second differences of the position".to_owned(),
        });
    }

    fn of_spin(&mut self, log: &Log, windows: &[Window]) {
        let name = "spin_sense";
        let missing = |reason: &str| Missing {
            name,
            reason: reason.to_owned(),
        };
        let Some(spin) = &log.spin_rad_s else {
            self.not_found.push(missing(
                "the log has no column spin_rad_s with a number in every row",
            ));
            return;
        };
        let quiet = quiet(log, windows);
        let mean = spin[quiet.clone()].iter().sum::<f64>() / quiet.len().max(1) as f64;
        let turns = mean.abs() * quiet.len() as f64 * log.period_s / TAU;
        if turns < 8.0 {
            self.not_found.push(missing(
                "the rotor turns less than eight times without a stimulus: record it at speed",
            ));
            return;
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
        if forward.max(backward) < 4.0 * beside {
            self.not_found.push(missing(
                "no orbit of the unbalance stands out: record it faster",
            ));
            return;
        }
        let value = if forward >= backward { 1.0 } else { -1.0 };
        self.parameters.push(Found {
            name,
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
}

/// Second differences of what moves smoothly are noise alone, with six times its square.
fn noise_m(positions_m: &[[f64; 2]]) -> f64 {
    let seconds = (positions_m.windows(3))
        .flat_map(|w| [0, 1].map(|axis| w[0][axis] - 2.0 * w[1][axis] + w[2][axis]));
    let rows = positions_m.len().saturating_sub(2).max(1) as f64;
    (seconds.map(|d| d * d).sum::<f64>() / (12.0 * rows)).sqrt()
}

/// What a command makes that is held from one tick to the next, over one that is there at the tick alone.
fn held(turn: f64) -> Complex64 {
    let half = 0.5 * turn;
    Complex64::from_polar(half.sin() / half, -half)
}

fn hann(part: f64) -> f64 {
    0.5 * (1.0 - (TAU * part).cos())
}

/// Ticks without a break in which one axis is excited.
type Window = std::ops::Range<usize>;

fn windows(log: &Log) -> Vec<Window> {
    // Once in a while a sine is nothing: two ticks in a row it is not.
    let axis = |tick: usize| -> Option<usize> {
        let near = tick.saturating_sub(1)..(tick + 2).min(log.stimulus_n.len());
        (0..2).find(|axis| log.stimulus_n[near.clone()].iter().any(|s| s[*axis] != 0.0))
    };
    let (mut windows, mut from): (Vec<Window>, Option<(usize, usize)>) = (Vec::new(), None);
    for tick in 0..=log.stimulus_n.len() {
        let now = if tick < log.stimulus_n.len() {
            axis(tick)
        } else {
            None
        };
        if from.map(|(_, axis)| axis) != now {
            if let Some((begin, _)) = from
                && tick - begin >= LEAST_TICKS
            {
                windows.push(begin..tick);
            }
            from = now.map(|axis| (tick, axis));
        }
    }
    windows
}

/// The longest ticks without a stimulus.
fn quiet(log: &Log, windows: &[Window]) -> Window {
    let ends = windows.iter().map(|w| w.end);
    let begins = windows
        .iter()
        .map(|w| w.start)
        .chain([log.stimulus_n.len()]);
    let gaps = std::iter::once(0).chain(ends).zip(begins);
    let longest = gaps.filter(|(a, b)| b > a).max_by_key(|(a, b)| b - a);
    longest.map_or(0..0, |(a, b)| a..b)
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

fn lines(log: &Log, windows: &[Window]) -> Vec<Line> {
    let mut lines = Vec::new();
    for (number, window) in windows.iter().enumerate() {
        let length = window.len() as f64;
        // Once for all lines: what is left of the mean, seen through the window.
        let [position, command, stimulus] = [&log.position_m, &log.command_n, &log.stimulus_n]
            .map(|all| through(&all[window.clone()]));
        let project = |weighed: &[[f64; 2]], omega: f64| {
            let mut sums = [Complex64::default(); 2];
            let turn = Complex64::from_polar(1.0, -omega * log.period_s);
            let mut phase = Complex64::new(1.0, 0.0);
            for value in weighed {
                for (sum, value) in sums.iter_mut().zip(value) {
                    *sum += phase * value;
                }
                phase *= turn;
            }
            sums.map(|sum| sum * (2.0 / length))
        };
        // Every other bin: neighbours tell the same.
        let step = 2.0 * TAU / (length * log.period_s);
        let strength = |omega: f64| {
            let [x, y] = project(&stimulus, omega);
            x.norm_sqr() + y.norm_sqr()
        };
        let bins: Vec<(f64, f64)> = (4..(length as usize / 8).min(200))
            .map(|bin| step * bin as f64)
            .map(|omega| (omega, strength(omega)))
            .collect();
        let strongest = bins.iter().fold(0.0_f64, |most, (_, s)| most.max(*s));
        for (omega, strength) in bins {
            if strength < LEAST_SHARE * LEAST_SHARE * strongest || strongest == 0.0 {
                continue;
            }
            let beside = BESIDE.map(|bins| (omega + 0.5 * step * bins, -1.0 / BESIDE.len() as f64));
            for (omega, weight) in std::iter::once((omega, 1.0)).chain(beside) {
                lines.push(Line {
                    window: number,
                    weight,
                    omega,
                    position: project(&position, omega),
                    command: (project(&command, omega)).map(|u| u * held(omega * log.period_s)),
                });
            }
        }
    }
    lines
}

/// Of forces in newtons.
fn mass_kg([xx, xy, yx, yy, ..]: &[f64; 6]) -> f64 {
    1.0 / (xx * yy - xy * yx).abs().sqrt()
}

fn own_cost(line: &Line, values: &[f64; 6]) -> f64 {
    residuals(line, values)
        .iter()
        .map(Complex64::norm_sqr)
        .sum()
}

/// G by rows, κ and τ, with their covariance.
struct Fit {
    values: [f64; 6],
    covariance: DMatrix<f64>,
    free: f64,
    windows: usize,
}

/// −ω²·X + κ·X − G·U/(1 + jωτ) of both axes, over ω².
fn residuals(line: &Line, [xx, xy, yx, yy, kappa, tau]: &[f64; 6]) -> [Complex64; 2] {
    let square = line.omega * line.omega;
    let [u, v] = line
        .command
        .map(|u| u / Complex64::new(1.0, line.omega * tau));
    let [x, y] = line.position.map(|x| x * (kappa - square));
    [
        (x - u * *xx - v * *xy) / square,
        (y - u * *yx - v * *yy) / square,
    ]
}

impl Fit {
    /// Without windows in which something else moves the rotor, a hum or a blow; and nothing of lines that the fit does not explain.
    fn without_outliers(mut lines: Vec<Line>, period_s: f64) -> Result<Self, LogError> {
        let first = Self::of(&lines, period_s)?;
        let windows = lines.iter().map(|line| line.window).max().unwrap_or(0) + 1;
        let mut costs = vec![0.0; windows];
        for line in lines.iter().filter(|line| line.weight > 0.0) {
            costs[line.window] += own_cost(line, &first.values);
        }
        let mut sorted = costs.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = sorted[windows / 2] * OUTLIER * OUTLIER;
        let kept = costs.iter().filter(|cost| **cost <= usual).count();
        let fit = if kept < windows && kept >= LEAST_WINDOWS {
            lines.retain(|line| costs[line.window] <= usual);
            Self::of(&lines, period_s)?
        } else {
            first
        };
        let of_lines = |values: &[f64; 6]| -> f64 {
            let alone = lines.iter().filter(|line| line.weight > 0.0);
            alone.map(|line| own_cost(line, values)).sum()
        };
        let mass = fit.mass();
        let narrow = mass.high - mass.low <= 2.0 * WIDEST * mass.value;
        if !narrow || of_lines(&fit.values) > UNEXPLAINED * of_lines(&[0.0; 6]) {
            return Err(LogError::new(
                "the motion at the lines of the stimulus is not one that its force explains well enough: noise, a hum or a load hides it",
                "record it with a larger stimulus, for longer, or at another spin",
            ));
        }
        Ok(fit)
    }

    fn of(lines: &[Line], period_s: f64) -> Result<Self, LogError> {
        let cost = |values: &[f64; 6]| -> f64 {
            let of = |line: &Line| line.weight * own_cost(line, values);
            lines.iter().map(of).sum()
        };
        // For every delay what is linear; then the delay that is best.
        let linear = |tau: f64| -> Option<[f64; 6]> {
            let zero = [0.0, 0.0, 0.0, 0.0, 0.0, tau];
            let (mut normal, mut right) = (DMatrix::<f64>::zeros(5, 5), DVector::<f64>::zeros(5));
            for line in lines {
                let at_zero = residuals(line, &zero);
                let rows: Vec<[Complex64; 2]> = (0..5)
                    .map(|i| {
                        let mut one = zero;
                        one[i] = 1.0;
                        let with = residuals(line, &one);
                        [with[0] - at_zero[0], with[1] - at_zero[1]]
                    })
                    .collect();
                for i in 0..5 {
                    for axis in 0..2 {
                        right[i] -= line.weight * (rows[i][axis].conj() * at_zero[axis]).re;
                        for j in 0..5 {
                            normal[(i, j)] +=
                                line.weight * (rows[i][axis].conj() * rows[j][axis]).re;
                        }
                    }
                }
            }
            let scale = DVector::from_fn(5, |i, _| 1.0 / f64::sqrt(normal[(i, i)].max(1e-300)));
            let scaled = DMatrix::from_fn(5, 5, |i, j| normal[(i, j)] * scale[i] * scale[j]);
            let solved = scaled
                .cholesky()?
                .solve(&right.component_mul(&scale))
                .component_mul(&scale);
            Some([solved[0], solved[1], solved[2], solved[3], solved[4], tau])
        };
        let tried =
            (0..=STEPS).filter_map(|i| linear(period_s * MOST_DELAY * i as f64 / STEPS as f64));
        let best = tried.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let unclear = || {
            LogError::new(
                "the rotor does not answer to the stimulus in a way that a mass, a stiffness and a delay explain",
                "let both axes be excited, at four frequencies at least; check that the columns are of one plane",
            )
        };
        let mut values = best.ok_or_else(unclear)?;
        let mut step = period_s * MOST_DELAY / STEPS as f64;
        for _ in 0..40 {
            for tau in [values[5] - step, values[5] + step] {
                if let Some(other) = linear(tau.max(0.0))
                    && cost(&other) < cost(&values)
                {
                    values = other;
                }
            }
            step *= 0.7;
        }
        let (covariance, windows) = covariance(lines, &values).ok_or_else(unclear)?;
        let free = windows as f64 - OF_FIT;
        Ok(Self {
            values,
            covariance,
            free,
            windows,
        })
    }

    /// A number that follows from the values, with its interval.
    fn found(
        &self,
        name: &'static str,
        unit: &'static str,
        of: impl Fn(&[f64; 6]) -> f64,
    ) -> Found {
        let value = of(&self.values);
        let gradient = DVector::from_fn(6, |i, _| {
            let by = self.covariance[(i, i)]
                .sqrt()
                .max(1e-12 * self.values[i].abs())
                * 1e-2;
            let (mut above, mut below) = (self.values, self.values);
            above[i] += by;
            below[i] -= by;
            if by > 0.0 {
                (of(&above) - of(&below)) / (2.0 * by)
            } else {
                0.0
            }
        });
        let spread = (gradient.transpose() * &self.covariance * &gradient)[(0, 0)]
            .max(0.0)
            .sqrt();
        let student = StudentsT::new(0.0, 1.0, self.free.max(1.0));
        let times = student.map_or(2.0, |t| t.inverse_cdf(0.975));
        Found {
            name,
            unit,
            value,
            low: value - times * spread,
            high: value + times * spread,
            from: format!("answer to the stimulus in {} windows", self.windows),
        }
    }

    fn mass(&self) -> Found {
        self.found("mass_kg", "kg", mass_kg)
    }

    fn say(&self, found: &mut Commissioned) {
        let mut own = self.mass();
        own.from += ", if forces are in newtons: mass and force factor show as one";
        found.parameters.push(own);
        found
            .parameters
            .push(self.found("stiffness_n_m", "N/m", |v| v[4] * mass_kg(v)));
        let mut late = self.found("time_to_force_s", "s", |v| v[5]);
        late.from += "; from a command in the log to its force, as a lag: delay and lag together";
        found.parameters.push(late);
        found.parameters.push(
            self.found("axes_turned_rad", "rad", |[xx, xy, yx, yy, ..]| {
                (yx - xy).atan2(xx + yy)
            }),
        );
        found
            .parameters
            .push(self.found("gain_of_y_over_x", "1", |[xx, xy, yx, yy, ..]| {
                xy.hypot(*yy) / xx.hypot(*yx)
            }));
        let handed = |[xx, xy, yx, yy, ..]: &[f64; 6]| (xx * yy - xy * yx).signum();
        found
            .parameters
            .push(self.found("axes_handedness", "1", handed));
        found.not_found.push(Missing {
            name: "amplifier_lag_s, delay_samples",
            reason: "only their sum shows: take one from the drive's data".to_owned(),
        });
    }
}

/// By the scatter of windows, which are independent of each other and their lines are not.
fn covariance(lines: &[Line], values: &[f64; 6]) -> Option<(DMatrix<f64>, usize)> {
    let steps = [0, 1, 2, 3, 4, 5]
        .map(|i| (values[i].abs() * 1e-6).max([1e-9, 1e-9, 1e-9, 1e-9, 1e-3, 1e-9][i]));
    let slopes = |line: &Line| -> Vec<[Complex64; 2]> {
        (0..6)
            .map(|i| {
                let (mut above, mut below) = (*values, *values);
                above[i] += steps[i];
                below[i] -= steps[i];
                let [a, b] = [residuals(line, &above), residuals(line, &below)];
                [0, 1].map(|axis| (a[axis] - b[axis]) / (2.0 * steps[i]))
            })
            .collect()
    };
    let mut normal = DMatrix::<f64>::zeros(6, 6);
    let mut scatter = DMatrix::<f64>::zeros(6, 6);
    let numbers: BTreeSet<usize> = lines.iter().map(|line| line.window).collect();
    let windows = numbers.len();
    for window in numbers {
        let mut score = DVector::<f64>::zeros(6);
        for line in lines.iter().filter(|line| line.window == window) {
            let (slopes, rest) = (slopes(line), residuals(line, values));
            for axis in 0..2 {
                for i in 0..6 {
                    score[i] += line.weight * (slopes[i][axis].conj() * rest[axis]).re;
                    for j in 0..6 {
                        normal[(i, j)] +=
                            line.weight * (slopes[i][axis].conj() * slopes[j][axis]).re;
                    }
                }
            }
        }
        scatter += &score * score.transpose();
    }
    let scale = DVector::from_fn(6, |i, _| 1.0 / normal[(i, i)].max(1e-300).sqrt());
    let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(6, 6, |i, j| m[(i, j)] * scale[i] * scale[j]);
    let inverse = scaled(&normal).try_inverse()?;
    let whole = &inverse * scaled(&scatter) * &inverse;
    // For the windows that went into the values.
    let few = windows as f64 / (windows as f64 - OF_FIT).max(1.0);
    Some((
        DMatrix::from_fn(6, 6, |i, j| few * whole[(i, j)] * scale[i] * scale[j]),
        windows,
    ))
}
