//! Flights of a rotor between contacts: linear motion under the magnet's force, a load, and the unbalance, fitted by least
//! squares to what the sensor said.

use crate::record::motion::Motion;
use nalgebra::{DMatrix, DVector, Dyn, RowDVector, linalg::Cholesky};
use plant_model::V2;

/// Ticks from one to another, both included, and the load that acts in them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Flight {
    /// First tick.
    pub(super) from: usize,
    /// Last tick.
    pub(super) to: usize,
    /// Number of the load.
    pub(super) load: usize,
}

/// Where a flight was and how fast, and by how much each unknown moves it.
pub(super) struct State {
    /// Position \[m\].
    pub(super) position_m: V2,
    /// Velocity \[m/s\].
    pub(super) velocity_m_s: V2,
    /// Derivatives of x, v_x, y, v_y.
    rows: [RowDVector<f64>; 4],
}

/// Flights as fitted.
pub(super) struct Fit<'m> {
    motion: &'m Motion,
    pub(super) flights: Vec<Flight>,
    paths: Vec<Path>,
    loads: usize,
    unbalance: bool,
    unknowns: DVector<f64>,
    inverse: DMatrix<f64>,
    /// Residual, root mean square \[m\].
    pub(super) noise_m: f64,
    /// Sum of the squares of all residuals \[m²\].
    pub(super) squares_m2: f64,
    /// Readings less unknowns.
    pub(super) freedom: usize,
}

/// Ticks by which a flight is gone on with beyond its ends.
pub(super) const BEYOND: usize = 48;
/// Columns of each axis: start at a distance, start at a speed, load, unbalance (twice), what is known.
const COLUMNS: usize = 6;
const KNOWN: usize = 5;
/// Unknowns of a flight: position and velocity along both axes.
const STARTS: usize = 4;

/// Position and speed by each column, on both axes.
type Basis = [[[f64; 2]; COLUMNS]; 2];

/// A flight's columns, and how far beyond its ends they go.
struct Path {
    begin: usize,
    at: Vec<Basis>,
}

/// Accelerations in a tick by each column.
fn inputs(motion: &Motion, tick: usize) -> [[f64; COLUMNS]; 2] {
    let instant = &motion.instants[tick];
    let spin = instant.spin_rad_s;
    let known = motion.known_m_s2(tick);
    let (sin, cos) = (instant.angle_rad + 0.5 * spin * motion.period_s).sin_cos();
    let (s, c) = (spin * spin * sin, spin * spin * cos);
    [
        [0.0, 0.0, 1.0, c, -s, known.x],
        [0.0, 0.0, 1.0, s, c, known.y],
    ]
}

fn moved(motion: &Motion, basis: &Basis, tick: usize, back: bool) -> Basis {
    let inputs = inputs(motion, tick);
    let mut next = *basis;
    for (axis, columns) in next.iter_mut().enumerate() {
        for (column, state) in columns.iter_mut().enumerate() {
            *state = motion.moved(*state, inputs[axis][column], back);
        }
    }
    next
}

impl Path {
    fn new(motion: &Motion, flight: &Flight) -> Self {
        let end = (flight.to + BEYOND).min(motion.instants.len() - 1);
        let begin = flight.from.saturating_sub(BEYOND);
        let mut start = Basis::default();
        for columns in &mut start {
            (columns[0], columns[1]) = ([1.0, 0.0], [0.0, 1.0]);
        }
        let mut at = vec![start];
        for tick in (begin..flight.from).rev() {
            let next = moved(motion, &at[at.len() - 1], tick, true);
            at.push(next);
        }
        at.reverse();
        for tick in flight.from..end {
            let next = moved(motion, &at[at.len() - 1], tick, false);
            at.push(next);
        }
        Self { begin, at }
    }

    /// At a time between ticks, of no reach beyond the ends.
    fn basis(&self, motion: &Motion, tick: f64) -> Basis {
        let last = self.at.len() - 1;
        let at = (tick - self.begin as f64).clamp(0.0, last as f64);
        let i = (at as usize).min(last.saturating_sub(1));
        let (part, step) = (at - i as f64, motion.period_s);
        let (before, after) = (&self.at[i], self.at.get(i + 1).unwrap_or(&self.at[i]));
        let mut basis = *before;
        // A cubic through position and speed at both ends.
        let [a, b, c, d] = [
            (1.0 + 2.0 * part) * (1.0 - part).powi(2),
            part * (1.0 - part).powi(2) * step,
            part.powi(2) * (3.0 - 2.0 * part),
            part.powi(2) * (part - 1.0) * step,
        ];
        for axis in 0..2 {
            for column in 0..COLUMNS {
                let ([x, v], [to_x, to_v]) = (before[axis][column], after[axis][column]);
                basis[axis][column] = [a * x + b * v + c * to_x + d * to_v, v + part * (to_v - v)];
            }
        }
        basis
    }
}

impl<'m> Fit<'m> {
    /// Fits all flights at once; `None` where there is none, or too few readings.
    pub(super) fn new(motion: &'m Motion, flights: &[Flight], unbalance: bool) -> Option<Self> {
        let loads = flights.iter().map(|f| f.load + 1).max()?;
        let mut fit = Self {
            motion,
            paths: flights.iter().map(|f| Path::new(motion, f)).collect(),
            flights: flights.to_vec(),
            loads,
            unbalance,
            unknowns: DVector::zeros(0),
            inverse: DMatrix::zeros(0, 0),
            noise_m: 0.0,
            squares_m2: 0.0,
            freedom: 0,
        };
        let count = fit.count();
        let mut normal: DMatrix<f64> = DMatrix::zeros(count, count);
        let mut right: DVector<f64> = DVector::zeros(count);
        let (mut total, mut readings) = (0.0, 0);
        for (number, flight) in flights.iter().enumerate() {
            for tick in flight.from..=flight.to {
                let instant = &motion.instants[tick];
                if !instant.good {
                    continue;
                }
                let basis = &fit.paths[number].at[tick - fit.paths[number].begin];
                for (axis, along) in basis.iter().enumerate() {
                    let columns = fit.columns(number, axis);
                    let rest = instant.position_m[axis] - along[KNOWN][0];
                    for (i, a) in &columns {
                        let a = along[*a][0];
                        right[*i] += a * rest;
                        for (j, b) in &columns {
                            normal[(*i, *j)] += a * along[*b][0];
                        }
                    }
                    total += rest * rest;
                    readings += 1;
                }
            }
        }
        fit.freedom = usize::try_from(readings - count as i64)
            .ok()
            .filter(|n| *n > 0)?;
        // What no machine has: it keeps an unknown that nothing is said of from being anything.
        let noise_m = f64::from(motion.config.sensor_step_m);
        let widest = |at: usize| fit.widest(at);
        for i in 0..count {
            normal[(i, i)] += (noise_m / widest(i)).powi(2);
        }
        let scale = DVector::from_fn(count, |i, _| 1.0 / normal[(i, i)].sqrt());
        let scaled = DMatrix::from_fn(count, count, |i, j| normal[(i, j)] * scale[i] * scale[j]);
        let inverse: DMatrix<f64> = Cholesky::<f64, Dyn>::new(scaled)?.inverse();
        fit.inverse = DMatrix::from_fn(count, count, |i, j| inverse[(i, j)] * scale[i] * scale[j]);
        fit.unknowns = &fit.inverse * &right;
        fit.squares_m2 = fit.residual();
        fit.noise_m = (fit.squares_m2 / fit.freedom as f64).sqrt();
        (total.is_finite() && fit.noise_m.is_finite()).then_some(fit)
    }

    fn count(&self) -> usize {
        STARTS * self.flights.len() + 2 * self.loads + 2 * usize::from(self.unbalance)
    }

    /// Place of the load's part along an axis, and of the unbalance's.
    fn load_at(&self, load: usize, axis: usize) -> usize {
        STARTS * self.flights.len() + 2 * load + axis
    }

    fn unbalance_at(&self, part: usize) -> usize {
        self.load_at(self.loads, part)
    }

    /// Unknowns that move a flight along an axis, each with its column.
    fn columns(&self, flight: usize, axis: usize) -> Vec<(usize, usize)> {
        let start = STARTS * flight + 2 * axis;
        let load = self.load_at(self.flights[flight].load, axis);
        let mut columns = vec![(start, 0), (start + 1, 1), (load, 2)];
        if self.unbalance {
            columns.extend([(self.unbalance_at(0), 3), (self.unbalance_at(1), 4)]);
        }
        columns
    }

    /// The widest that an unknown can be.
    fn widest(&self, at: usize) -> f64 {
        let config = &self.motion.config;
        if at >= self.unbalance_at(0) {
            return self.motion.clearance_m();
        }
        if at >= STARTS * self.flights.len() {
            return 100.0 * f64::from(config.force_max_n) / self.motion.mass_kg();
        }
        match at % 2 {
            0 => 100.0 * self.motion.clearance_m(),
            _ => 10.0 * f64::from(config.speed_max_m_s),
        }
    }

    /// The rest of every reading, squared and added \[m²\].
    fn residual(&self) -> f64 {
        let mut squares = 0.0;
        for (number, flight) in self.flights.iter().enumerate() {
            let path = &self.paths[number];
            for tick in flight.from..=flight.to {
                let instant = &self.motion.instants[tick];
                if !instant.good {
                    continue;
                }
                let basis = &path.at[tick - path.begin];
                for (axis, along) in basis.iter().enumerate() {
                    let by = |(i, column): &(usize, usize)| self.unknowns[*i] * along[*column][0];
                    let fitted: f64 = self.columns(number, axis).iter().map(by).sum();
                    let rest = instant.position_m[axis] - along[KNOWN][0] - fitted;
                    squares += rest * rest;
                }
            }
        }
        squares
    }

    /// A flight at a time \[ticks\], also some way beyond its ends.
    pub(super) fn state(&self, flight: usize, tick: f64) -> State {
        let basis = self.paths[flight].basis(self.motion, tick);
        let count = self.count();
        let mut rows = [(); 4].map(|()| RowDVector::zeros(count));
        let mut values = [0.0; 4];
        for (of, (row, value)) in rows.iter_mut().zip(&mut values).enumerate() {
            let (axis, part) = (of / 2, of % 2);
            for (i, column) in self.columns(flight, axis) {
                row[i] = basis[axis][column][part];
            }
            *value = basis[axis][KNOWN][part] + (&*row * &self.unknowns)[0];
        }
        let [x, v_x, y, v_y] = values;
        State {
            position_m: V2::new(x, y),
            velocity_m_s: V2::new(v_x, v_y),
            rows,
        }
    }

    /// Standard error of a sum of velocities of states, each along a direction \[m/s\].
    pub(super) fn error_m_s(&self, along: &[(&State, V2)]) -> f64 {
        let parts = along
            .iter()
            .map(|(state, n)| &state.rows[1] * n.x + &state.rows[3] * n.y);
        self.error(parts.fold(RowDVector::zeros(self.count()), |sum, row| sum + row))
    }

    /// Standard error of a position along a direction \[m\].
    pub(super) fn error_m(&self, state: &State, n: V2) -> f64 {
        self.error(&state.rows[0] * n.x + &state.rows[2] * n.y)
    }

    fn error(&self, row: RowDVector<f64>) -> f64 {
        self.noise_m * (&row * &self.inverse * row.transpose())[0].max(0.0).sqrt()
    }

    /// Load as an acceleration \[m/s²\], and its standard errors.
    pub(super) fn load(&self, load: usize) -> (V2, V2) {
        let [x, y] = [0, 1].map(|axis| self.load_at(load, axis));
        self.pair(x, y)
    }

    /// Distance of the mass centre at the angle 0 \[m\], and its standard errors; where it was fitted.
    pub(super) fn unbalance(&self) -> Option<(V2, V2)> {
        let [x, y] = [0, 1].map(|part| self.unbalance_at(part));
        self.unbalance.then(|| self.pair(x, y))
    }

    fn pair(&self, x: usize, y: usize) -> (V2, V2) {
        let error = |i: usize| self.noise_m * self.inverse[(i, i)].sqrt();
        let of = V2::new(self.unknowns[x], self.unknowns[y]);
        (of, V2::new(error(x), error(y)))
    }

    /// Acceleration in a tick by the magnet, springs at a position, the load and the unbalance \[m/s²\].
    pub(super) fn acceleration_m_s2(&self, load: usize, tick: usize, position_m: V2) -> V2 {
        let inputs = inputs(self.motion, tick);
        let (of_load, _) = self.load(load);
        let spring = f64::from(self.motion.config.stiffness_n_m) / self.motion.mass_kg();
        let turning = self.unbalance().map_or(V2::zeros(), |(u, _)| {
            let along = |axis: [f64; COLUMNS]| axis[3] * u.x + axis[4] * u.y;
            V2::new(along(inputs[0]), along(inputs[1]))
        });
        self.motion.known_m_s2(tick) + of_load + turning - spring * position_m
    }
}
