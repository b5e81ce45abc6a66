//! A rotor as a mass in one plane: ẍ + κ·x = G·f with τ·ḟ + f = u, G by rows, κ stiffness over mass, τ the time from a command to its force.

use crate::commission::fit::{
    Fit, Model, Problem, UNEXPLAINED, hidden, unexplained, without_outliers,
};
use crate::commission::spectrum::{Complex64, Line};
use crate::commission::{Commissioned, Found, Missing};
use crate::log_file::LogError;

/// Windows that intervals need, and that the fit of an axis takes up.
pub(super) const LEAST_WINDOWS: usize = 6;
const OF_FIT: f64 = 4.0;
/// The widest interval of the mass that is one, either way as a share.
const WIDEST: f64 = 0.25;
/// The longest time from a command to its force \[ticks\], and how finely it is looked for at first.
pub(super) const MOST_DELAY: f64 = 12.0;
const TRIED: usize = 48;

/// The model; its numbers are G by rows, κ and τ.
pub(super) struct OnePlane;

const TAU_S: usize = 5;

impl Model for OnePlane {
    fn residuals_m(&self, line: &Line, values: &[f64]) -> Vec<Complex64> {
        let [xx, xy, yx, yy, kappa, tau_s] = numbers(values);
        let square = line.omega_rad_s * line.omega_rad_s;
        let [u, v] = line.force_n(0, tau_s);
        let (position, acceleration) = (line.position_m[0], line.acceleration_m_s2[0]);
        let [x, y] = [0, 1].map(|axis| acceleration[axis] + position[axis] * kappa);
        vec![
            (x - u * xx - v * xy) / square,
            (y - u * yx - v * yy) / square,
        ]
    }

    fn step(&self, number: usize, values: &[f64]) -> f64 {
        let least = [1e-9, 1e-9, 1e-9, 1e-9, 1e-3, 1e-9][number];
        (values[number].abs() * 1e-6).max(least)
    }
}

fn numbers(values: &[f64]) -> [f64; 6] {
    std::array::from_fn(|i| values[i])
}

/// Of forces in newtons.
pub(super) fn mass_kg(matrix: &[f64]) -> f64 {
    1.0 / determinant(matrix).abs().sqrt()
}

pub(super) fn determinant(of: &[f64]) -> f64 {
    of[0] * of[3] - of[1] * of[2]
}

/// Angle, ratio of gains and sense of a matrix from commands to motion, under names that begin so.
pub(super) fn of_axes(fit: &Fit, prefix: &str, first: usize) -> [Found; 3] {
    let own = move |v: &[f64]| -> [f64; 4] { std::array::from_fn(|i| v[first + i]) };
    [
        fit.found(format!("{prefix}axes_turned_rad"), "rad", move |v| {
            let [xx, xy, yx, yy] = own(v);
            (yx - xy).atan2(xx + yy)
        }),
        fit.found(format!("{prefix}gain_of_y_over_x"), "1", move |v| {
            let [xx, xy, yx, yy] = own(v);
            xy.hypot(yy) / xx.hypot(yx)
        }),
        fit.found(format!("{prefix}axes_handedness"), "1", move |v| {
            determinant(&own(v)).signum()
        }),
    ]
}

/// The fit, without windows in which something else moves the rotor; and nothing of lines that it does not explain.
pub(super) fn fitted(lines: &[Line], period_s: f64) -> Result<(Fit, Vec<Line>), LogError> {
    let first = least(lines, period_s)?;
    let lines = without_outliers(&OnePlane, lines, &first, LEAST_WINDOWS);
    let values = least(&lines, period_s)?;
    let problem = Problem {
        model: &OnePlane,
        lines: &lines,
        free: &[0, 1, 2, 3, 4, TAU_S],
    };
    let fit = problem.known(values, OF_FIT).ok_or_else(unclear)?;
    let mass = fit.found("mass_kg", "kg", mass_kg);
    let narrow = mass.high - mass.low <= 2.0 * WIDEST * mass.value;
    match narrow && unexplained(&OnePlane, &lines, &fit.values) <= UNEXPLAINED {
        true => Ok((fit, lines)),
        false => Err(hidden()),
    }
}

fn unclear() -> LogError {
    LogError::new(
        "the rotor does not answer to the stimulus in a way that a mass, a stiffness and a delay explain",
        "let both axes be excited, at four frequencies at least; check that the columns are of one plane",
    )
}

/// For every delay what is linear; then all from the delay that is best.
fn least(lines: &[Line], period_s: f64) -> Result<Vec<f64>, LogError> {
    let linear = Problem {
        model: &OnePlane,
        lines,
        free: &[0, 1, 2, 3, 4],
    };
    let tried = (0..=TRIED).filter_map(|i| {
        let tau_s = period_s * MOST_DELAY * i as f64 / TRIED as f64;
        linear.stepped(&[0.0, 0.0, 0.0, 0.0, 0.0, tau_s], 0.0)
    });
    let costly = |a: &Vec<f64>, b: &Vec<f64>| linear.cost(a).total_cmp(&linear.cost(b));
    let best = tried.min_by(costly).ok_or_else(unclear)?;
    let all = Problem {
        free: &[0, 1, 2, 3, 4, TAU_S],
        ..linear
    };
    let values = all.least(best).ok_or_else(unclear)?;
    if values[TAU_S] >= 0.0 {
        return Ok(values);
    }
    // No force comes before its command.
    let none = [0.0; 6];
    linear.stepped(&none, 0.0).ok_or_else(unclear)
}

/// What the fit says.
pub(super) fn say(fit: &Fit, found: &mut Commissioned) {
    let mut own = fit.found("mass_kg", "kg", mass_kg);
    own.from += ", if forces are in newtons: mass and force factor show as one";
    found.parameters.push(own);
    let stiffness = fit.found("stiffness_n_m", "N/m", |v| v[4] * mass_kg(v));
    found.parameters.push(stiffness);
    let mut late = fit.found("time_to_force_s", "s", |v| v[TAU_S]);
    late.from += "; from a command in the log to its force, as a lag: delay and lag together";
    found.parameters.push(late);
    found.parameters.extend(of_axes(fit, "", 0));
    found.not_found.push(Missing {
        name: "amplifier_lag_s, delay_samples".to_owned(),
        reason: "only their sum shows: take one from the drive's data".to_owned(),
    });
}
