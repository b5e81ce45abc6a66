//! A levitation controller of the user's: a discrete state space from all readings to all forces.
//!
//! ```text
//! f_k = C·x_k + D·y_k,   x_{k+1} = A·x_k + B·y_k
//! ```
//!
//! y has x and y of every sensor \[m\], f those of every magnet \[N\], one station after the other.

use crate::device::actuator::limited_n;
use nalgebra::{DMatrix, DVector};
use plant_model::V2;

/// Its matrices, and where they act.
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpaceParams {
    /// A, n × n.
    pub a: DMatrix<f64>,
    /// B, n × readings.
    pub b: DMatrix<f64>,
    /// C, forces × n.
    pub c: DMatrix<f64>,
    /// D, forces × readings.
    pub d: DMatrix<f64>,
    /// Cap of each station's magnet \[N\]; none where it has no magnet.
    pub caps_n: Vec<Option<f64>>,
}

/// The controller. What an amplifier cuts off is not fed back to it.
#[derive(Debug, Clone)]
pub struct StateSpace {
    params: StateSpaceParams,
    state: DVector<f64>,
    next: DVector<f64>,
    readings: DVector<f64>,
    forces: DVector<f64>,
}

impl StateSpace {
    /// A controller at rest.
    pub fn new(params: StateSpaceParams) -> Self {
        let (states, readings, forces) = (params.a.nrows(), params.d.ncols(), params.d.nrows());
        Self {
            state: DVector::zeros(states),
            next: DVector::zeros(states),
            readings: DVector::zeros(readings),
            forces: DVector::zeros(forces),
            params,
        }
    }

    /// Forces of the stations \[N\] for what their sensors measure \[m\], each within its cap; a reading that is no number
    /// counts as the last.
    pub fn forces_n(&mut self, measured_m: impl Iterator<Item = V2>, forces_n: &mut [V2]) {
        let p = &self.params;
        let components = measured_m.flat_map(|reading| [reading.x, reading.y]);
        for (kept, new) in self.readings.iter_mut().zip(components) {
            if new.is_finite() {
                *kept = new;
            }
        }
        self.forces.gemv(1.0, &p.c, &self.state, 0.0);
        self.forces.gemv(1.0, &p.d, &self.readings, 1.0);
        self.next.gemv(1.0, &p.a, &self.state, 0.0);
        self.next.gemv(1.0, &p.b, &self.readings, 1.0);
        std::mem::swap(&mut self.state, &mut self.next);
        let mut asked = self.forces.as_slice().chunks_exact(2);
        for (cap_n, force_n) in p.caps_n.iter().zip(forces_n) {
            let wanted = cap_n.and_then(|cap_n| Some((cap_n, asked.next()?)));
            *force_n = wanted.map_or_else(V2::zeros, |(cap_n, f)| {
                limited_n(V2::new(f[0], f[1]), cap_n)
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lag of one sample on x, a gain on y.
    #[test]
    fn readings_go_through_the_matrices() {
        let mut controller = StateSpace::new(StateSpaceParams {
            a: DMatrix::from_element(1, 1, 0.5),
            b: DMatrix::from_row_slice(1, 2, &[2.0, 0.0]),
            c: DMatrix::from_column_slice(2, 1, &[3.0, 0.0]),
            d: DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, -4.0]),
            caps_n: vec![None, Some(100.0)],
        });
        let mut forces_n = [V2::repeat(9.0); 2];
        let mut step = |x: f64, y: f64| {
            controller.forces_n([V2::new(x, y)].into_iter(), &mut forces_n);
            forces_n
        };
        assert_eq!(step(1.0, 1.0), [V2::zeros(), V2::new(0.0, -4.0)]);
        assert_eq!(step(0.0, f64::NAN)[1], V2::new(6.0, -4.0));
        assert_eq!(step(0.0, 0.0)[1], V2::new(3.0, 0.0));
        // Within the cap, as a vector.
        assert!((step(0.0, 1e3)[1].norm() / 100.0 - 1.0).abs() < 1e-15);
    }
}
